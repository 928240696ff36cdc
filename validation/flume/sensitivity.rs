//! One thing at a time: what the inputs that the paper does not state, and those that it states, are worth.

use super::baseline;
use super::read_case;
use super::rules::{Energy, judge};
use crate::record::Record;
use crate::runs::{self, Run};
use crate::scatter::Scatter;
use crate::{Context, Failure, Validation};
use checkdam::output::Table;
use checkdam::plot::PlotError;
use checkdam::plot::tornado::{self, Tornado};
use checkdam::study::quantities::QUANTITIES;
use checkdam_verification::Outcome;
use checkdam_verification::report::{number, quoted};
use std::path::Path;

/// The analysis of the recorded runs.
pub const VALIDATION: Validation = Validation {
    name: "flume_sensitivity",
    title: "The flume with one thing changed at a time: forces, front, depth, energy, time to rest",
    study: "108 runs, about 20 minutes",
    run,
    draw,
    covers: &[],
};

/// The study and its record.
pub const RECORD: Record = Record {
    name: "flume_sensitivity",
    study: include_str!("studies/sensitivity.toml"),
    read: read_case,
    runs: include_str!("runs/sensitivity.csv"),
};

/// What the table and the figures show.
pub const SHOWN: [&str; 9] = [
    "static_force_n",
    "peak_20ms_n",
    "front_velocity_m_per_s",
    "barrier_velocity_m_per_s",
    "front_depth_m",
    "arrival_s",
    "dissipated_1",
    "time_to_static_s",
    "end_s",
];
/// Those that get a figure.
const FIGURES: [&str; 7] = [
    "static_force_n",
    "peak_20ms_n",
    "front_velocity_m_per_s",
    "barrier_velocity_m_per_s",
    "front_depth_m",
    "dissipated_1",
    "end_s",
];

/// The rows of the record.
///
/// # Errors
/// The record is not as it should be, or the study is stopped.
pub fn recorded(context: &mut Context) -> Result<Vec<Run>, Failure> {
    Ok(runs::rows(&RECORD.table(context)?, &[])?)
}

fn run(context: &mut Context) -> Result<Outcome, Failure> {
    let rows = recorded(context)?;
    let repetitions = runs::rows(&Table::parse(baseline::RECORD.runs, "flume/runs/baseline.csv")?, &["cell_m"])?;
    let mut outcome = Outcome {
        // Side walls hold a part; a base that is a body and a rough one keep no account of their friction.
        checks: judge(&rows, Energy::Released, &|r| {
            !["side walls", "base model"].contains(&r.factor.as_str()) && r.label != "rough"
        }),
        ..Outcome::default()
    };
    let mut text = String::from("case,factor,label,ended");
    for quantity in SHOWN {
        text += &format!(",{quantity},{quantity}_change_percent");
    }
    text.push('\n');
    for case in ["40deg", "23deg"] {
        let own: Vec<&Run> = rows.iter().filter(|r| r.case == case).collect();
        let Some(base) = own.iter().find(|r| r.factor == "base") else { continue };
        let mut line = |factor: &str, label: &str, ended: &str, of: &dyn Fn(&str) -> f64| {
            text += &[case, factor, label, ended].map(quoted).join(",");
            for quantity in SHOWN {
                let value = of(quantity);
                let change = 100.0 * (value / base.get(quantity) - 1.0);
                let cells = if value.is_finite() { format!(",{},{change:.1}", number(value)) } else { ",,".into() };
                text += &cells.replace("-0.0", "0.0");
            }
            text.push('\n');
        };
        for r in &own {
            line(&r.factor, &r.label, &r.ended, &|q| r.get(q));
        }
        for sign in [-2.0, 2.0] {
            line("noise", &format!("{sign} standard deviations"), "", &|q| {
                let at = repetitions.iter().filter(|r| r.case == case && r.set["cell_m"] == "0.01");
                base.get(q) + sign * Scatter::of(at.map(|r| r.get(q))).deviation
            });
        }
    }
    outcome.tables.push(("flume_sensitivity_table".into(), text));
    Ok(outcome)
}

fn draw(folder: &Path) -> Result<Vec<String>, PlotError> {
    let mut names = Vec::new();
    for column in FIGURES {
        let title = QUANTITIES.iter().find(|q| q.name == column).map_or(column, |q| q.title);
        let at_rest = ["static_force_n", "end_s"].contains(&column);
        let title = if column == "end_s" { "time to rest (s)" } else { title };
        let what = Tornado { panels: &[("40deg", "40 degrees"), ("23deg", "23 degrees")], column, title, at_rest };
        let name = format!("flume_sensitivity_{column}.svg");
        tornado::draw(folder.join("flume_sensitivity_table.csv"), &what, folder.join(&name))?;
        names.push(name);
    }
    Ok(names)
}
