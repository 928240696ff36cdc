//! Explicit and implicit steps of the barrier, long ones and short ones: do both give the same answer, and what does
//! the length of the step do?
//!
//! Runs come in pairs, on the same grid and with the same packing, so that the error of a difference is that of the
//! pairs. Explicit steps of a stiff barrier are short for the sand as well; the length of a step by itself changes what
//! the sand does at the contact. Both are taken apart: explicit and implicit in equal steps, and either in long and in
//! short ones.

use super::balances::Balances;
use super::records::INTEGRATION;
use crate::check::{Check, Kind};
use crate::plot::PlotError;
use crate::plot::curves::{self, Curve, Curves, panel};
use crate::validation::flume::runs::Run;
use crate::validation::flume::scatter::Scatter;
use crate::validation::{Context, Failure, Validation};
use crate::verification::Outcome;
use crate::verification::report::number;
use std::path::Path;

/// The analysis of the recorded runs.
pub const VALIDATION: Validation = Validation {
    name: "barrier_steps",
    title: "The barrier in explicit and in implicit steps, long ones and short ones",
    study: "108 runs, about half an hour",
    run,
    draw,
    covers: &[],
};

/// What is compared; the impulse is that of the 0.25 s to the end of these runs.
const QUANTITIES: [&str; 5] =
    ["peak_20ms_n", "impulse_half_second_n_s", "tip_max_m", "peak_step_n", "energy_residual_1"];
/// Those that are smooth on the scale of a step, and judged.
const SMOOTH: [&str; 3] = ["peak_20ms_n", "impulse_half_second_n_s", "tip_max_m"];

/// How the barrier moves, and the longest step, as the study writes them.
type Way = [&'static str; 2];
const LONG: &str = "0.001";
const SHORT: &str = "1.5e-5";
/// All ways, with their column.
const WAYS: [(Way, &str); 4] = [
    (["explicit", LONG], "explicit_long"),
    (["explicit", SHORT], "explicit_short"),
    (["implicit", LONG], "implicit_long"),
    (["implicit", SHORT], "implicit_short"),
];

/// Cell size of all runs, m.
const CELL: f64 = 0.02;

/// What equal steps may differ by, percent: as in the unit test of an impact on a wall.
const EQUAL: f64 = 2.0;
/// What steps of the sand's own length may be off by, percent: as in the unit test of an impact on a stiff wall.
const LENGTH: f64 = 8.0;

/// What is compared with what, and what the difference may be, percent.
const COMPARED: [(&str, Way, Way, Option<f64>); 4] = [
    ("implicit less explicit in short steps", ["implicit", SHORT], ["explicit", SHORT], Some(EQUAL)),
    ("implicit less explicit in steps as long as they may be", ["implicit", LONG], ["explicit", LONG], None),
    ("long less short implicit steps", ["implicit", LONG], ["implicit", SHORT], Some(LENGTH)),
    ("long less short explicit steps", ["explicit", LONG], ["explicit", SHORT], Some(LENGTH)),
];

/// All runs, by stiffness.
struct Runs(Vec<(f64, Run)>);

impl Runs {
    fn of(&self, stiffness: f64, [integration, step]: Way) -> impl Iterator<Item = &Run> {
        let own = self.0.iter().filter(move |(n, _)| *n == stiffness).map(|(_, r)| r);
        own.filter(move |r| r.set["integration"] == integration && r.set["longest_step_s"] == step)
    }

    fn mean(&self, stiffness: f64, way: Way, quantity: &str) -> Scatter {
        Scatter::of(self.of(stiffness, way).map(|r| r.get(quantity)))
    }

    /// What `way` gives more than `other`, and the standard error of the pairs, percent.
    fn difference(&self, stiffness: f64, way: Way, other: Way, quantity: &str) -> [f64; 2] {
        let pairs = Scatter::of(self.of(stiffness, way).map(|own| {
            let same = self.of(stiffness, other).find(|r| r.replicate == own.replicate);
            own.get(quantity) - same.map_or(f64::NAN, |r| r.get(quantity))
        }));
        let of = self.mean(stiffness, other, quantity).mean;
        [100.0 * pairs.mean / of, 100.0 * pairs.standard_error() / of]
    }
}

fn run(context: &mut Context) -> Result<Outcome, Failure> {
    let runs = Runs(INTEGRATION.by_stiffness(context)?);
    let mut stiffnesses: Vec<(f64, &str)> = runs.0.iter().map(|(n, r)| (*n, r.set["stiffness_1"].as_str())).collect();
    stiffnesses.dedup();
    let mut outcome = Outcome::default();
    let mut means =
        format!("stiffness_1,quantity,{},runs\n", WAYS.map(|w| format!("{0},{0}_deviation", w.1)).join(","));
    let mut differences = String::from("stiffness_1,quantity,difference,percent,error_percent\n");
    for &(n, cell) in &stiffnesses {
        for quantity in QUANTITIES {
            let all = WAYS.map(|(way, _)| runs.mean(n, way, quantity));
            let numbers = all.iter().flat_map(|s| [s.mean, s.deviation]).map(number).collect::<Vec<_>>();
            means += &format!("{cell},{quantity},{},{}\n", numbers.join(","), all[0].count);
            if !SMOOTH.contains(&quantity) {
                continue;
            }
            for (what, way, other, most) in COMPARED {
                let [percent, error] = runs.difference(n, way, other, quantity);
                differences += &format!("{cell},{quantity},{what},{},{}\n", number(percent), number(error));
                let Some(most) = most else { continue };
                let name = format!("n = {cell}: {quantity}, {what}");
                outcome.checks.push(
                    Check::at_most(name, percent.abs(), most + 2.0 * error, "%")
                        .because(format!("{most} %, as in the unit test, and two standard errors of nine pairs"))
                        .from(Kind::Golden, "the same barrier in other steps"),
                );
            }
        }
    }
    for integration in ["explicit", "implicit"] {
        let own = runs.0.iter().map(|(_, r)| r).filter(|r| r.set["integration"] == integration);
        let balances = Balances::over(own, |_| CELL);
        outcome.checks.extend(balances.checks(&format!("{integration} steps: "), "ledgers and gauges of all runs"));
    }
    outcome.tables.push(("barrier_steps_means".into(), means));
    outcome.tables.push(("barrier_steps_differences".into(), differences));
    Ok(outcome)
}

const MEANS: Curves = Curves {
    x: "stiffness_1",
    x_title: "normalised stiffness 3 EI/H\u{b3}",
    y_title: "",
    curves: &[
        Curve { column: "explicit_long", label: "explicit, as long as may be", exact: false },
        Curve { column: "explicit_short", label: "explicit, 15 \u{b5}s", exact: false },
        Curve { column: "implicit_long", label: "implicit, the sand's own", exact: false },
        Curve { column: "implicit_short", label: "implicit, 15 \u{b5}s", exact: false },
    ],
    panels: &[
        panel("force over 20 ms (N)", &[("quantity", "peak_20ms_n")]),
        panel("impulse (N s)", &[("quantity", "impulse_half_second_n_s")]),
        panel("deflection of the tip (m)", &[("quantity", "tip_max_m")]),
        panel("energy not accounted for (share of E\u{2080})", &[("quantity", "energy_residual_1")]),
    ],
    ..Curves::LOGARITHMIC
};

fn draw(folder: &Path) -> Result<Vec<String>, PlotError> {
    let name = "barrier_steps_plot.svg";
    curves::draw(folder.join("barrier_steps_means.csv"), &MEANS, folder.join(name))?;
    Ok(vec![name.into()])
}
