//! Does it matter that gravity is off on the barrier? The same barriers with and without their own weight.
//!
//! An upright cantilever that carries its own weight is softer against what bends it slowly by 1 - rho/rho_c, where
//! rho_c is the density at which it would buckle (Greenhill 1881). What happens within milliseconds does not see that.

use super::records::{SCATTER, WEIGHT, barrier, height, on_study_cells, young_of_one};
use crate::check::{Check, Expected, Kind, Tolerance};
use crate::plot::PlotError;
use crate::plot::curves::{self, Curve, Curves};
use crate::theory::barrier::buckling_density;
use crate::validation::flume::runs::Run;
use crate::validation::{Context, Failure, Validation};
use crate::verification::Outcome;
use crate::verification::report::number;
use std::path::Path;

/// The analysis of the recorded runs.
pub const VALIDATION: Validation = Validation {
    name: "barrier_weight",
    title: "Barriers with and without their own weight",
    study: "6 runs, about 2 minutes",
    run,
    draw,
    covers: &[],
};

fn run(context: &mut Context) -> Result<Outcome, Failure> {
    let mut outcome = Outcome::default();
    let case = WEIGHT.first_case()?;
    let density = case.materials["barrier"].density_kg_per_m3;
    let depth = barrier(&case).map_or(f64::NAN, |b| b.size_m()[0]);
    let section = depth * case.grid.thickness_m;
    let (runs, repeated) = (WEIGHT.by_stiffness(context)?, SCATTER.by_stiffness(context)?);
    let find = |n: f64, weightless: &str| -> Result<&Run, Failure> {
        let found = runs.iter().find(|(m, r)| *m == n && r.set["weightless"] == weightless);
        found.map(|r| &r.1).ok_or_else(|| Failure::Record(format!("no barrier of {n} with weightless = {weightless}")))
    };
    let mut text = String::from(
        "stiffness_1,softer_by_1,peak_weightless_n,peak_heavy_n,peak_ratio_1,tip_weightless_m,tip_heavy_m,tip_ratio_1\n",
    );
    for (n, light) in runs.iter().filter(|(_, r)| r.set["weightless"] == "true") {
        let heavy = find(*n, "false")?;
        let rigidity = n * young_of_one(&case) * section * depth * depth / 12.0;
        let critical = buckling_density(rigidity, height(&case), section, case.gravity.magnitude_m_per_s2);
        let softer = 1.0 - density / critical;
        let both = |name: &str| [light.get(name), heavy.get(name)];
        let ([peak, heavy_peak], [tip, heavy_tip]) = (both("peak_20ms_n"), both("tip_max_m"));
        let numbers =
            [*n, softer, peak, heavy_peak, heavy_peak / peak, tip, heavy_tip, heavy_tip / tip].map(number).join(",");
        text += &format!("{numbers}\n");
        // Two standard deviations of the ratio of two single runs.
        let chance = |name: &str| {
            let s = on_study_cells(repeated.iter().filter(|(m, _)| m == n).map(|(_, r)| r), name);
            2.0 * 2f64.sqrt() * s.deviation / s.mean
        };
        outcome.checks.push(
            Check::value(
                format!("n = {n}: force over 20 ms with weight over that without"),
                heavy_peak / peak,
                1.0,
                "1",
            )
            .within(
                Tolerance::Absolute(chance("peak_20ms_n")),
                "single runs: two standard deviations of the ratio, from the repeated ones",
            )
            .from(Kind::Analytic, "inertia, not stiffness, answers within milliseconds"),
        );
        let most = 1.0 / softer + chance("tip_max_m");
        outcome.checks.push(
            Check::new(
                format!("n = {n}: largest deflection with weight over that without"),
                heavy_tip / tip,
                Expected::Within(1.0 - chance("tip_max_m"), most),
                "1",
            )
            .because("at most that of a slow load, and two standard deviations of the ratio of single runs")
            .from(Kind::Analytic, "Greenhill 1881"),
        );
    }
    outcome.tables.push(("barrier_weight_ratios".into(), text));
    Ok(outcome)
}

const RATIOS: Curves = Curves {
    x: "stiffness_1",
    x_title: "normalised stiffness 3 EI/H\u{b3}",
    y_title: "with weight over without",
    curves: &[
        Curve { column: "peak_ratio_1", label: "largest force over 20 ms", exact: false },
        Curve { column: "tip_ratio_1", label: "largest deflection of the tip", exact: false },
    ],
    ..Curves::LINEAR
};

fn draw(folder: &Path) -> Result<Vec<String>, PlotError> {
    let name = "barrier_weight_plot.svg";
    curves::draw(folder.join("barrier_weight_ratios.csv"), &RATIOS, folder.join(name))?;
    Ok(vec![name.into()])
}
