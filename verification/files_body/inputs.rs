//! Inputs that are lost or changed on their way from the case: each is changed in the text, and the checks of its scene, which know what it
//! should be, have to notice.

use super::SCENES;
use crate::from_file::Files;
use crate::report::quoted;
use crate::{Fault, Outcome};
use checkdam::check::{Check, Kind};

/// Number of the scene, what stands in its text, and what does instead.
const CHANGED: &[(usize, &str, &str)] = &[
    (0, "magnitude_m_per_s2 = 10", "magnitude_m_per_s2 = 10.3"),
    (0, "inclination_deg = 20", "inclination_deg = 20.6"),
    (0, "density_kg_per_m3 = 2000", "density_kg_per_m3 = 2060"),
    (0, "density_kg_per_m3 = 1500", "density_kg_per_m3 = 1545"),
    (0, "thickness_m = 0.2", "thickness_m = 0.206"),
    (1, "friction = 0.3", "friction = 0.309"),
    (1, "inclination_deg = 30", "inclination_deg = 30.9"),
    (2, "velocity_m_per_s = [0.3, 0]", "velocity_m_per_s = [0.309, 0]"),
    (
        2,
        "materials.bar = { law = \"linear_elastic\", density_kg_per_m3 = 1000, young_pa = 1000000",
        "materials.bar = { law = \"linear_elastic\", density_kg_per_m3 = 1000, young_pa = 1030000",
    ),
    (
        2,
        "materials.bar = { law = \"linear_elastic\", density_kg_per_m3 = 1000",
        "materials.bar = { law = \"linear_elastic\", density_kg_per_m3 = 1030",
    ),
    (2, "point_m = [0.8, 0]", "point_m = [0.84, 0]"),
    (4, "poisson = 0.3", "poisson = 0.309"),
    (5, "particles_per_cell = 9", "particles_per_cell = 4"),
    (5, "rotation_deg = 30, particles_per_cell", "rotation_deg = 29.1, particles_per_cell"),
    (6, ", weightless = true", ""),
    (6, "kinematics = \"total_lagrangian\", ", ""),
    (6, "young_pa = 10000000", "young_pa = 10300000"),
    (6, "cfl = 0.5", "cfl = 0.515"),
    (7, "integration = \"implicit\"", "integration = \"explicit\""),
    (
        7,
        "law = \"linear_elastic\", density_kg_per_m3 = 1000, young_pa = 10000000",
        "law = \"neo_hookean\", density_kg_per_m3 = 1000, young_pa = 10000000",
    ),
    (7, "young_pa = 10000000, poisson = 0", "young_pa = 10000000, poisson = 0.2"),
    (7, "density_kg_per_m3 = 1000, young_pa = 10000000", "density_kg_per_m3 = 1030, young_pa = 10000000"),
    (8, "barriers = [\"first\", \"second\"]", "barriers = [\"second\", \"first\"]"),
    (8, ", particles_per_cell = 16", ""),
    (9, "sample_rate_hz = 100000", "sample_rate_hz = 1000"),
    (11, "pic_rate_per_s = 5", "pic_rate_per_s = 5.15"),
    (11, "numerics.pic_rate_per_s = 5\n", ""),
];

/// Tries them all: how many go unseen, and a table.
pub fn run(outcome: &mut Outcome) {
    let mut table = String::from("scene,input,instead,failing_checks\n");
    let mut unseen = 0;
    for &(scene, what, instead) in CHANGED {
        let scene = &SCENES[scene];
        let texts = (scene.texts)(&Fault::NONE);
        let there = texts.first().is_some_and(|text| text.contains(what));
        let changed = texts.iter().enumerate().map(|(k, text)| match k {
            0 => Files::run(&text.replacen(what, instead, 1)),
            _ => Files::run(text),
        });
        // A run that breaks down shows nothing.
        let failing = changed.collect::<Result<Vec<_>, _>>().map_or(0, |files| {
            let checks = (scene.judge)(&files).into_iter();
            checks.filter(|check| !check.passes() && check.measured.is_finite()).count()
        });
        unseen += usize::from(!there || failing == 0);
        table.push_str(&format!(
            "{},{},{},{failing}\n",
            quoted(scene.name),
            quoted(what.trim()),
            quoted(instead.trim())
        ));
    }
    outcome.check(
        Check::at_most("inputs changed by 3 % or lost on their way that no check notices", unseen as f64, 0.0, "1")
            .because("a whole number")
            .from(Kind::Conservation, "the texts of the cases, changed one by one"),
    );
    outcome.tables.push(("files_body_inputs".into(), table));
}
