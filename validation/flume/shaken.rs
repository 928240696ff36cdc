//! Does a deposit that is shaken forget how it came to rest?
//!
//! At rest any force between the friction limits is in equilibrium, so the force is a history. Both measured forces are 0.42 to 0.48 of the weight
//! along the flume, as the pressure at rest of a level fill would be. Vibration could undo the history: the flume is shaken by a uniform
//! acceleration a sin(2 pi f t), along its bed or square to it, ever harder, and the force is read when all is still again.

use super::at_rest::measured;
use super::read_case;
use crate::record::Record;
use crate::scatter::Scatter;
use crate::watch::{WordsFn, side_by_side};
use crate::{Context, Failure, Validation};
use checkdam::case::Case;
use checkdam::check::{Check, Expected, Kind};
use checkdam::output::{Table, write_text};
use checkdam::plot::PlotError;
use checkdam::plot::curves::{self, Curve, Curves, panel};
use checkdam::run::scene;
use checkdam::simulation::Simulation;
use checkdam_verification::Outcome;
use checkdam_verification::report::number;
use std::f64::consts::PI;
use std::path::Path;

/// The analysis of the recorded runs.
pub const VALIDATION: Validation = Validation {
    name: "flume_shaken",
    title: "Deposits that are shaken: the force at rest at both angles and its ratio",
    study: "20 runs, about 2 minutes",
    run,
    draw,
    covers: &[],
};

/// What is run before the shaking. It has no record of its own.
const PLAN: Record =
    Record { name: "flume_shaken", study: include_str!("studies/shaken.toml"), read: read_case, runs: "" };
/// Forces read: written by [`make`].
const RECORDED: &str = include_str!("runs/shaken.csv");
const COLUMNS: &str = "case,replicate,direction,acceleration_over_g_1,force_n,share_of_weight_1,kinetic_j";

/// Accelerations, in this order, over that of gravity.
const ACCELERATIONS: [f64; 4] = [0.0, 0.1, 0.3, 1.0];
/// Frequency, Hz: two hundred steps of the sand and more.
const FREQUENCY: f64 = 30.0;
/// How long the flow, each shaking, and the stillness after it last, and the window at its end in which the force is read, s.
const FLOW: f64 = 4.0;
const SHAKING: f64 = 1.0;
const STILL: f64 = 0.6;
const WINDOW: f64 = 0.2;
/// Along the bed, and square to it.
const DIRECTIONS: [(&str, [f64; 2]); 2] = [("along the bed", [1.0, 0.0]), ("square to the bed", [0.0, 1.0])];

/// A run: its case, the number of its grid, the direction of the shaking.
struct Shaken {
    name: String,
    replicate: usize,
    case: Case,
    direction: usize,
}

/// Settles level for a second, tilts as the case does, settles again for a second, and opens the gate.
fn prepare(
    sim: &mut Simulation,
    case: &Case,
    words: &mut dyn FnMut(f64) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let (Some(settle), Some(tilt)) = (&case.stages.settle, &case.stages.tilt) else {
        return Err(Failure::Record("the case has no settling or no tilt".into()));
    };
    sim.set_damping(settle.damping_per_s);
    let (from, to) = (case.gravity.settle_inclination_or_default_deg(), case.gravity.inclination_deg);
    let end = 2.0 + tilt.duration_s;
    while sim.time() < end {
        let share = ((sim.time() - 1.0) / tilt.duration_s).clamp(0.0, 1.0);
        sim.set_gravity(scene::gravity(case, from + share * (to - from)));
        sim.step()?;
        words(sim.time())?;
    }
    sim.set_damping(0.0);
    sim.set_time(0.0);
    sim.release_gates();
    Ok(())
}

/// Runs one case; a line for each reading.
fn shake(run: &Shaken, words: &mut WordsFn) -> Result<String, Failure> {
    let case = &run.case;
    let mut sim = Simulation::new(scene::build(case));
    let mut told = 0u64;
    let mut tell = |time: f64| {
        told += 1;
        let go_on = !told.is_multiple_of(500) || words(&format!("{}: {time:.2} s", run.name));
        if go_on { Ok(()) } else { Err(Failure::Stopped) }
    };
    prepare(&mut sim, case, &mut tell)?;
    let barrier = case.boundaries.iter().position(|b| b.name == "barrier");
    let barrier = barrier.ok_or_else(|| Failure::Record("the case has no barrier".into()))?;
    let gravity = sim.gravity();
    let (direction, axis) = DIRECTIONS[run.direction];
    let mut text = String::new();
    let mut end = 0.0;
    for acceleration in ACCELERATIONS {
        let (start, shaking) = (end, if acceleration == 0.0 { FLOW } else { SHAKING });
        end = start + shaking + STILL;
        let (mut impulse, mut time) = (0.0, 0.0);
        while sim.time() < end {
            let now = sim.time() - start;
            let a = if now < shaking { acceleration * case.gravity.magnitude_m_per_s2 } else { 0.0 };
            let a = a * libm::sin(2.0 * PI * FREQUENCY * now);
            sim.set_gravity([gravity[0] + a * axis[0], gravity[1] + a * axis[1]]);
            let before = sim.time();
            sim.step()?;
            if before >= end - WINDOW {
                // What the wall, square to the bed, gives the sand against the flow.
                impulse -= sim.step_tallies()[barrier].impulse[0];
                time += sim.time() - before;
            }
            tell(sim.time())?;
        }
        let force = impulse / time;
        let share = force / (sim.mass() * gravity[0]);
        let mass = sim.bodies()[0].point_mass;
        let kinetic = sim.particles().map(|(_, p)| 0.5 * mass * (p.v[0] * p.v[0] + p.v[1] * p.v[1])).sum::<f64>();
        let numbers = [acceleration, force, share, kinetic].map(number).join(",");
        text += &format!("{},{},{direction},{numbers}\n", run.name, run.replicate);
    }
    Ok(text)
}

/// Makes the record anew.
fn make(context: &mut Context) -> Result<String, Failure> {
    let plan = PLAN.plan()?.1;
    let one = |direction: usize| {
        plan.iter().map(move |p| Shaken {
            name: p.case_name.clone(),
            replicate: p.replicate,
            case: p.case.clone(),
            direction,
        })
    };
    let runs: Vec<Shaken> = (0..DIRECTIONS.len()).flat_map(one).collect();
    let lines = side_by_side(&runs, context.progress, shake)?;
    Ok(format!("{COLUMNS}\n{}", lines.concat()))
}

fn run(context: &mut Context) -> Result<Outcome, Failure> {
    let text = if context.studies { make(context)? } else { RECORDED.to_string() };
    if context.studies {
        write_text(context.folder.join("flume_shaken_runs.csv"), &text)?;
    }
    let table = Table::parse(&text, "flume/runs/shaken.csv")?;
    let (cases, directions) = (table.cells("case")?, table.cells("direction")?);
    let (accelerations, forces) = (table.column("acceleration_over_g_1")?, table.column("force_n")?);
    let (shares, kinetic) = (table.column("share_of_weight_1")?, table.column("kinetic_j")?);
    let of = |values: &[f64], case: &str, direction: &str, acceleration: f64| {
        let own = |k: &usize| cases[*k] == case && directions[*k] == direction && accelerations[*k] == acceleration;
        Scatter::of((0..table.rows()).filter(own).map(|k| values[k]))
    };
    let mut outcome = Outcome::default();
    let mut least = f64::INFINITY;
    let mut shown = String::from(
        "direction,acceleration_over_g_1,force_40_n,deviation_40_n,share_40_1,force_23_n,deviation_23_n,share_23_1,runs,ratio_1,ratio_error_1\n",
    );
    for (direction, _) in DIRECTIONS {
        for acceleration in ACCELERATIONS {
            let [steep, flat] = ["40deg", "23deg"].map(|case| of(forces, case, direction, acceleration));
            let share = ["40deg", "23deg"].map(|case| of(shares, case, direction, acceleration).mean);
            let ratio = steep.mean / flat.mean;
            let error = ratio * (steep.standard_error() / steep.mean).hypot(flat.standard_error() / flat.mean);
            least = least.min(ratio - 2.0 * error);
            let numbers = [
                [acceleration, steep.mean, steep.deviation, share[0]].map(number).join(","),
                [flat.mean, flat.deviation, share[1]].map(number).join(","),
            ];
            shown +=
                &format!("{direction},{},{},{},{}\n", numbers.join(","), steep.count, number(ratio), number(error));
        }
    }
    let [low, high] = measured();
    outcome.check(
        Check::new("force at 40 over that at 23 degrees, least less two errors", least, Expected::AtLeast(high), "1")
            .because("a conclusion, not a demand: were it less, what the README says of the ratio would be wrong")
            .from(Kind::Measured, "Ng et al.: 79 N, and 55 N computed or measured"),
    );
    // Rest as the command has it, with what a fall along 1 m of the bed releases.
    let released = |k: usize| forces[k] / shares[k];
    let worst = (0..table.rows()).map(|k| kinetic[k] / released(k)).fold(0.0, f64::max);
    outcome.check(
        Check::at_most(
            "kinetic energy after the stillness over that of a fall along 1 m of the bed, largest",
            worst,
            1e-4,
            "1",
        )
        .because("a force at rest is one of sand that rests; the command's limit")
        .from(Kind::Conservation, "energy"),
    );
    // The same runs without shaking, by the gauges of the command.
    let at_rest = Table::parse(super::at_rest::RECORD.runs, "flume/runs/at_rest.csv")?;
    let (names, factors) = (at_rest.cells("case")?, at_rest.cells("factor")?);
    for case in ["40deg", "23deg"] {
        let own = (0..at_rest.rows()).filter(|&k| names[k] == case && factors[k] == "base");
        let column = at_rest.column("static_force_n")?;
        let known = Scatter::of(own.map(|k| column[k]));
        let here = of(forces, case, DIRECTIONS[0].0, 0.0);
        let chance = 3.0 * here.standard_error().hypot(known.standard_error());
        outcome.check(
            Check::new(
                format!("{case}: force before the shaking"),
                here.mean,
                Expected::Within(known.mean - chance, known.mean + chance),
                "N",
            )
            .because("three standard errors of the difference of two means; settling and windows differ")
            .from(Kind::Golden, "the same case as the command runs it, flume/runs/at_rest.csv"),
        );
    }
    outcome.tables.push(("flume_shaken_forces".into(), shown));
    let bounds = [("measured, least", low), ("measured, greatest", high)];
    let bounds = bounds.map(|(what, ratio)| format!("\"{what}\",{}\n", number(ratio))).concat();
    outcome.tables.push(("flume_shaken_ratios".into(), format!("what,ratio_1\n{bounds}")));
    Ok(outcome)
}

const FORCES: Curves = Curves {
    x: "acceleration_over_g_1",
    x_title: "acceleration of the shaking over gravity",
    y_title: "force at rest (N)",
    curves: &[
        Curve { column: "force_40_n", label: "40 degrees", exact: false },
        Curve { column: "force_23_n", label: "23 degrees", exact: false },
    ],
    panels: &[
        panel("along the bed", &[("direction", "along the bed")]),
        panel("square to the bed", &[("direction", "square to the bed")]),
    ],
    ..Curves::LINEAR
};

fn draw(folder: &Path) -> Result<Vec<String>, PlotError> {
    let name = "flume_shaken_plot.svg";
    curves::draw(folder.join("flume_shaken_forces.csv"), &FORCES, folder.join(name))?;
    Ok(vec![name.into()])
}
