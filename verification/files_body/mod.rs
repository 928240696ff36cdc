//! From the text of a case to the files of its run, for barriers and bases that are bodies. Every number that `summary.toml`, the tables
//! and the VTK frames have of them is read back by name. It is held against a closed form, a balance, or another file.
//!
//! A block rests on a body and slides down it. A bar strikes a bar in four ways of reckoning, and a weight lies on a cantilever in two. Two
//! barriers are measured at once, and a wall is once a boundary and once a body. Scenes start from what a user writes, so an input that is
//! lost on its way shows: each is changed in the text, and a check has to notice (`inputs`). They end at what a user reads, so a column
//! that is wrong shows. Which numbers are closed is found out. A number is closed if 3 % more of it and 3 % less, in its file, both make a
//! check fail ([`keys`]).

mod balance;
mod barrier;
mod bars;
mod bend;
pub mod closed;
mod inputs;
mod inside;
pub mod keys;
mod line;
mod pulse;
mod shape;
mod sill;
mod two;
mod wall;

use super::report::named_csv;
use super::{Fault, FaultKind, Outcome, Rung, RungFailure};
use crate::figure::{Figure, curves, exact, measured};
use crate::from_file::Files;
use crate::{of_module, part};
use checkdam::check::Check;
use checkdam::plot::curves::{Curves, panel};

/// The rung.
pub const RUNG: Rung = Rung {
    name: of_module(module_path!()),
    title: "From a case to its files, barriers that are bodies: a block on a sill, a bar on a bar, a weight on a cantilever, two barriers, a wall twice",
    goal: "Every number in the files of a run that belongs to a barrier that is a body: closed forms, balances, one file against another",
    source: "Coulomb 1785; Saint-Venant 1867; Timoshenko 1921; Newton's second and third law",
    sketch: r"
    ___                                      |-|
   |___|->   [bar]-> [bar   |clamp    weight | |     [ ]-> .    |
   -------                                   | |     [ ]->|     |
    sill      rho c v A/2                   =====     two barriers
",
    run,
    covers: &[
        (FaultKind::Friction, 1.03),
        (FaultKind::Modulus, 1.03),
        (FaultKind::Gravity, 1.03),
        (FaultKind::Density, 1.03),
    ],
    under_fault: "the sliding block (friction); the weight on an implicit plate (modulus); the block at rest (all others)",
    figures: FIGURES,
};

/// Its figures.
const FIGURES: &[Figure] = &[
    curves(
        "files_body_pulse",
        "files_body_pulse_plot",
        Curves {
            x: "time_s",
            x_title: "time since the bars touch (s)",
            y_title: "force over rho c v A/2",
            curves: &[measured("force_over_exact", ""), exact("exact_1", "characteristics")],
            panels: &[panel("on the face", &[("of", "face")]), panel("on the clamp", &[("of", "clamp")])],
            split: &[("barrier", "")],
            ..Curves::LINEAR
        },
    ),
    curves(
        "files_body_bend",
        "files_body_bend_plot",
        Curves {
            x: "height_m",
            x_title: "height (m)",
            y_title: "deflection of the face (mm)",
            y_times: 1e3,
            curves: &[
                measured("deflection_m", "in the file"),
                exact("deflection_exact_m", "Timoshenko, pressure in the file"),
            ],
            panels: &[
                panel("by its mesh, weightless", &[("plate", "mesh")]),
                panel("implicit, with its weight", &[("plate", "implicit")]),
            ],
            ..Curves::LINEAR
        },
    ),
];

/// Something that is run and judged.
struct Scene {
    name: &'static str,
    texts: fn(&Fault) -> Vec<String>,
    judge: fn(&[Files]) -> Vec<Check>,
}

const REST: usize = 0;
const SLIDE: usize = 1;
const PULSE: usize = 2;
const BEND: usize = 6;

const SCENES: [Scene; 12] = [
    Scene { name: "a block at rest", texts: |f| vec![sill::text(&sill::REST, f)], judge: |f| sill::rest(&f[0]) },
    Scene { name: "a block that slides", texts: |f| vec![sill::text(&sill::SLIDE, f)], judge: |f| sill::slide(&f[0]) },
    Scene {
        name: "a bar strikes a bar",
        texts: |f| vec![bars::text(&bars::SETTINGS[0], f)],
        judge: |f| pulse::judge(&bars::SETTINGS[0], &f[0]),
    },
    Scene {
        name: "a bar by its mesh",
        texts: |f| vec![bars::text(&bars::SETTINGS[1], f)],
        judge: |f| pulse::judge(&bars::SETTINGS[1], &f[0]),
    },
    Scene {
        name: "an implicit bar",
        texts: |f| vec![bars::text(&bars::SETTINGS[2], f)],
        judge: |f| pulse::judge(&bars::SETTINGS[2], &f[0]),
    },
    Scene {
        name: "a turned bar",
        texts: |f| vec![bars::text(&bars::SETTINGS[3], f)],
        judge: |f| pulse::judge(&bars::SETTINGS[3], &f[0]),
    },
    Scene {
        name: "a weight on a plate by its mesh",
        texts: |f| vec![bend::text(&bend::SETTINGS[0], f)],
        judge: |f| bend::judge(&bend::SETTINGS[0], &f[0]),
    },
    Scene {
        name: "a weight on an implicit plate",
        texts: |f| vec![bend::text(&bend::SETTINGS[1], f)],
        judge: |f| bend::judge(&bend::SETTINGS[1], &f[0]),
    },
    Scene {
        name: "two barriers",
        texts: |f| vec![two::text(&two::SETTINGS[0], f)],
        judge: |f| two::judge(&two::SETTINGS[0], &f[0]),
    },
    Scene {
        name: "two barriers, step by step",
        texts: |f| vec![two::text(&two::SETTINGS[1], f)],
        judge: |f| two::judge(&two::SETTINGS[1], &f[0]),
    },
    Scene { name: "a wall twice", texts: |f| wall::texts(f).into(), judge: wall::judge },
    Scene { name: "PIC by time and by steps", texts: |f| bars::pic_texts(f).into(), judge: pulse::pic },
];

impl Scene {
    /// Its checks, by its name.
    fn checks(&self, files: &[Files]) -> Vec<Check> {
        let checks = (self.judge)(files).into_iter();
        checks.map(|check| Check { what: format!("{}: {}", self.name, check.what), ..check }).collect()
    }

    fn run(&self, fault: &Fault) -> Result<Vec<Files>, RungFailure> {
        (self.texts)(fault).iter().map(|text| Files::run(text)).collect()
    }
}

fn run(fault: &Fault) -> Result<Outcome, RungFailure> {
    let mut outcome = Outcome::default();
    if *fault != Fault::NONE {
        let scene = match () {
            () if fault.friction != 1.0 => SLIDE,
            () if fault.modulus != 1.0 => BEND + 1,
            () => REST,
        };
        let files = SCENES[scene].run(fault)?;
        outcome.checks = SCENES[scene].checks(&files);
        return Ok(outcome);
    }
    if !part::is_whole() {
        for scene in SCENES.iter().filter(|s| part::is_asked(s.name)) {
            outcome.checks.extend(scene.checks(&scene.run(fault)?));
        }
        return Ok(outcome);
    }
    let runs: Vec<Vec<Files>> = SCENES.iter().map(|s| s.run(fault)).collect::<Result<_, _>>()?;
    for (scene, files) in SCENES.iter().zip(&runs) {
        outcome.checks.extend(scene.checks(files));
    }
    tables(&runs, &mut outcome);
    keys::run(&runs, &mut outcome);
    inputs::run(&mut outcome);
    Ok(outcome)
}

/// What the figures show.
fn tables(runs: &[Vec<Files>], outcome: &mut Outcome) {
    let names = bars::SETTINGS.each_ref().map(|s| s.name);
    let rows = bars::SETTINGS.iter().enumerate().flat_map(|(k, s)| {
        let rows = pulse::forces(s, &runs[PULSE + k][0]);
        rows.into_iter().map(move |r| vec![k as f64, r[0], r[1], r[2], r[3]])
    });
    let header = ["barrier", "of", "time_s", "force_over_exact", "exact_1"];
    let codes: [(&str, &[&str]); 2] = [("barrier", &names), ("of", &["face", "clamp"])];
    outcome.tables.push(("files_body_pulse".into(), named_csv(&header, &codes, rows)));
    let rows = bend::SETTINGS.iter().enumerate().flat_map(|(k, s)| {
        let rows = bend::profile(&runs[BEND + k][0], s);
        rows.into_iter().map(move |r| vec![k as f64, r[0], r[1], r[2]])
    });
    let header = ["plate", "height_m", "deflection_m", "deflection_exact_m"];
    let codes: [(&str, &[&str]); 1] = [("plate", &["mesh", "implicit"])];
    outcome.tables.push(("files_body_bend".into(), named_csv(&header, &codes, rows)));
}
