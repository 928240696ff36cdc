//! Explicit and implicit steps of the barrier, long ones and short ones: do both give the same answer, and what does
//! the length of the step do?
//!
//! Runs come in pairs, on the same grid and with the same packing, so that the error of a difference is that of the
//! pairs. Explicit steps of a stiff barrier are short for the sand as well; the length of a step by itself changes what
//! the sand does at the contact. Both are taken apart: explicit and implicit in equal steps, and either in long and in
//! short ones. The stiffest of the barriers also runs in steps a third as long as the short ones: do the two get closer?

use super::records::{INTEGRATION, SHORT_STEPS};
use crate::balances::Balances;
use crate::runs::Run;
use crate::scatter::Scatter;
use crate::{Context, Failure, Validation};
use checkdam::check::{Check, Kind};
use checkdam::plot::PlotError;
use checkdam::plot::curves::{self, Curve, Curves, panel};
use checkdam_verification::Outcome;
use checkdam_verification::report::number;
use std::path::Path;

/// The analysis of the recorded runs.
pub const VALIDATION: Validation = Validation {
    name: "barrier_steps",
    title: "The barrier in explicit and in implicit steps, long ones and short ones",
    study: "118 runs, about half an hour",
    run,
    draw,
    covers: &[],
};

/// What is compared; the impulse is that of the 0.25 s to the end of these runs.
const QUANTITIES: [&str; 6] = [
    "peak_20ms_n",
    "impulse_half_second_n_s",
    "tip_max_m",
    "peak_step_n",
    "peak_barrier_velocity_m_per_s",
    "energy_residual_1",
];
/// Those that are smooth on the scale of a step, and judged.
const SMOOTH: [&str; 3] = ["peak_20ms_n", "impulse_half_second_n_s", "tip_max_m"];

/// How the barrier moves, and the longest step, as the study writes them.
type Way = [&'static str; 2];
const LONG: &str = "0.001";
const SHORT: &str = "1.5e-5";
const SHORTER: &str = "5e-6";
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

/// What is compared for the stiffest, with the shorter steps, on the grids and packings of the runs in those.
const SHORTER_COMPARED: [(&str, Way, Way, Option<f64>); 4] = [
    (
        "implicit less explicit in short steps where there are shorter ones",
        ["implicit", SHORT],
        ["explicit", SHORT],
        None,
    ),
    ("implicit less explicit in shorter steps", ["implicit", SHORTER], ["explicit", SHORTER], Some(EQUAL)),
    ("shorter less short implicit steps", ["implicit", SHORTER], ["implicit", SHORT], None),
    ("shorter less short explicit steps", ["explicit", SHORTER], ["explicit", SHORT], None),
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

    /// What `way` gives more than `other`.
    fn difference(&self, stiffness: f64, way: Way, other: Way, quantity: &str) -> Difference {
        let same = |own: &Run| self.of(stiffness, other).find(|r| r.replicate == own.replicate);
        let both: Vec<[f64; 2]> =
            self.of(stiffness, way).filter_map(|own| Some([own.get(quantity), same(own)?.get(quantity)])).collect();
        let pairs = Scatter::of(both.iter().map(|[own, other]| own - other));
        let of = Scatter::of(both.iter().map(|[_, other]| *other)).mean;
        Difference { percent: 100.0 * pairs.mean / of, error: 100.0 * pairs.standard_error() / of, pairs: pairs.count }
    }
}

/// A mean difference of pairs of runs and its standard error, percent of the mean of those it is taken from.
struct Difference {
    percent: f64,
    error: f64,
    pairs: usize,
}

fn run(context: &mut Context) -> Result<Outcome, Failure> {
    let mut runs = Runs(INTEGRATION.by_stiffness(context)?);
    let mut stiffnesses: Vec<(f64, String)> = runs.0.iter().map(|(n, r)| (*n, r.set["stiffness_1"].clone())).collect();
    stiffnesses.dedup();
    let shorter = SHORT_STEPS.by_stiffness(context)?;
    let stiffest = shorter.first().ok_or_else(|| Failure::Record("no runs in shorter steps".into()))?.0;
    let same: Vec<String> = shorter.iter().map(|(_, r)| r.replicate.clone()).collect();
    runs.0.extend(shorter);
    let alike = Runs(runs.0.iter().filter(|(n, r)| *n == stiffest && same.contains(&r.replicate)).cloned().collect());
    let mut outcome = Outcome::default();
    let mut means =
        format!("stiffness_1,quantity,{},runs\n", WAYS.map(|w| format!("{0},{0}_deviation", w.1)).join(","));
    let mut differences = String::from("stiffness_1,quantity,difference,percent,error_percent,pairs,resolved\n");
    let mut shown = String::from("log10_stiffness_1,quantity,equal,equal_less_error,equal_plus_error,as_run\n");
    for &(n, ref cell) in &stiffnesses {
        for quantity in QUANTITIES {
            let scatter = WAYS.map(|(way, _)| runs.mean(n, way, quantity));
            let numbers = scatter.iter().flat_map(|s| [s.mean, s.deviation]).map(number).collect::<Vec<_>>();
            means += &format!("{cell},{quantity},{},{}\n", numbers.join(","), scatter[0].count);
            let [equal, as_run] = [0, 1].map(|k| runs.difference(n, COMPARED[k].1, COMPARED[k].2, quantity));
            let values = [equal.percent, equal.percent - equal.error, equal.percent + equal.error, as_run.percent];
            shown += &format!("{},{quantity},{}\n", number(libm::log10(n)), values.map(number).join(","));
            let of_stiffest = SHORTER_COMPARED.iter().filter(|_| n == stiffest).map(|c| (&alike, c));
            for (runs, &(what, way, other, most)) in COMPARED.iter().map(|c| (&runs, c)).chain(of_stiffest) {
                let Difference { percent, error, pairs } = runs.difference(n, way, other, quantity);
                let most = most.filter(|_| SMOOTH.contains(&quantity));
                // A bound on a difference says something where the error is no more than what is allowed.
                let resolved = most.map_or("", |most| if error <= most { "true" } else { "false" });
                differences +=
                    &format!("{cell},{quantity},{what},{},{},{pairs},{resolved}\n", number(percent), number(error));
                let Some(most) = most else { continue };
                let unsure = if resolved == "true" { "" } else { "; not resolved" };
                let name = format!("n = {cell}: {quantity}, {what}{unsure}");
                outcome.checks.push(
                    Check::at_most(name, percent.abs(), most + 2.0 * error, "%")
                        .because(format!("{most} %, as in the unit test, and two standard errors of {pairs} pairs"))
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
    outcome.tables.push(("barrier_steps_shown".into(), shown));
    Ok(outcome)
}

const DIFFERENCES: Curves = Curves {
    x: "log10_stiffness_1",
    x_title: "power of ten of n",
    y_title: "implicit less explicit, %",
    curves: &[
        Curve { column: "equal", label: "in equal steps of 15 \u{b5}s", exact: false },
        Curve { column: "as_run", label: "in steps as long as they may be", exact: false },
        Curve { column: "equal_less_error", label: "equal steps, one standard error", exact: true },
        Curve { column: "equal_plus_error", label: "equal steps, one standard error", exact: true },
    ],
    panels: &[
        panel("force over 20 ms", &[("quantity", "peak_20ms_n")]),
        panel("impulse", &[("quantity", "impulse_half_second_n_s")]),
        panel("deflection of the tip", &[("quantity", "tip_max_m")]),
    ],
    ..Curves::LINEAR
};

fn draw(folder: &Path) -> Result<Vec<String>, PlotError> {
    let name = "barrier_steps_plot.svg";
    curves::draw(folder.join("barrier_steps_shown.csv"), &DIFFERENCES, folder.join(name))?;
    Ok(vec![name.into()])
}
