//! What the length of a step does to forces, front, energy and rest: the evidence for the default Courant number.

use super::read_case;
use super::rules::{Energy, judge};
use crate::record::Record;
use crate::runs::{self, Run};
use crate::scatter::Scatter;
use crate::{Context, Failure, Validation};
use checkdam::check::{Check, Kind};
use checkdam::plot::PlotError;
use checkdam_verification::Outcome;
use checkdam_verification::report::{number, quoted};
use std::path::Path;

/// The analysis of the recorded runs.
pub const VALIDATION: Validation = Validation {
    name: "flume_step_length",
    title: "The length of a step: force, front, energy and rest with Courant numbers of 0.15 to 0.9",
    study: "126 runs, about 8 minutes",
    run,
    draw: |_: &Path| -> Result<Vec<String>, PlotError> { Ok(Vec::new()) },
    covers: &[],
};

/// The study and its record.
pub const RECORD: Record = Record {
    name: "flume_step_length",
    study: include_str!("studies/step_length.toml"),
    read: read_case,
    runs: include_str!("runs/step_length.csv"),
};

/// What is shown: quantity, and its columns.
const SHOWN: [(&str, &str); 5] = [
    ("static_force_n", "static_force_n"),
    ("peak_20ms_n", "peak_20ms_n"),
    ("front_velocity_m_per_s", "front_velocity_m_per_s"),
    ("energy_residual_1", "energy_residual_1"),
    ("time_to_static_s", "time_to_static_s"),
];
/// Those that must not follow the length of a step.
const JUDGED: [&str; 2] = ["static_force_n", "front_velocity_m_per_s"];
/// Of the default, as the study has it.
const DEFAULT: (&str, &str) = ("base", "");

/// A set of runs alike but for grid and packing, at one angle.
fn of<'a>(rows: &'a [Run], case: &'a str, (factor, label): (&'a str, &'a str)) -> impl Iterator<Item = &'a Run> {
    rows.iter().filter(move |r| r.case == case && r.factor == factor && r.label == label && r.ended == "at rest")
}

fn run(context: &mut Context) -> Result<Outcome, Failure> {
    let rows = runs::rows(&RECORD.table(context)?, &[])?;
    let mut outcome = Outcome { checks: judge(&rows, Energy::Kinetic, &|_| true), ..Outcome::default() };
    let mut kinds: Vec<(&str, &str)> = Vec::new();
    for r in &rows {
        let kind = (r.factor.as_str(), r.label.as_str());
        if !kinds.contains(&kind) {
            kinds.push(kind);
        }
    }
    let columns = SHOWN.map(|(_, name)| format!("{name},{name}_deviation")).join(",");
    let mut text = format!("case,factor,cfl_1,{columns},runs\n");
    for case in ["40deg", "23deg"] {
        for &kind in &kinds {
            let own = SHOWN.map(|(quantity, _)| Scatter::of(of(&rows, case, kind).map(|r| r.get(quantity))));
            let numbers = own.iter().flat_map(|s| [s.mean, s.deviation]).map(number).collect::<Vec<_>>().join(",");
            let (factor, cfl) = if kind == DEFAULT { ("uGIMP", "0.3") } else { kind };
            text += &format!("{case},{},{cfl},{numbers},{}\n", quoted(factor), own[0].count);
            if kind == DEFAULT || factor != "uGIMP" {
                continue;
            }
            for quantity in JUDGED {
                let [now, known] = [kind, DEFAULT].map(|k| Scatter::of(of(&rows, case, k).map(|r| r.get(quantity))));
                let chance = 3.0 * now.standard_error().hypot(known.standard_error());
                outcome.check(
                    Check::at_most(
                        format!("{case}, {factor}, cfl = {cfl}: {quantity} less that of the default over it"),
                        (now.mean / known.mean - 1.0).abs(),
                        0.02 + chance / known.mean,
                        "1",
                    )
                    .because("2 %, the time step's own error in an impact, and three standard errors of the two means")
                    .from(Kind::Golden, "the same runs with cfl = 0.3"),
                );
            }
        }
    }
    outcome.tables.push(("flume_step_length_means".into(), text));
    Ok(outcome)
}
