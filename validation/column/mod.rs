//! Columns of grains that collapse, on level ground and on slopes, against laboratories: flows on which nothing here was calibrated.
//!
//! Sand on level ground (Lube et al. 2005), glass beads on level ground (Lajeunesse et al. 2005), glass beads on rough slopes (Mangeney et
//! al. 2010); what was read of them, where and how, is in `published.csv`. What was fixed: Grains slide in simple shear at an angle midway
//! between those at which they come to rest and at which they start, and these two bound it (sand: its angle of repose). The bed is rough.
//! The gate is gone at once. The front is the tip of the wedge that the deposit ends in. The front's definition and the rough bed were
//! settled after first numbers had been seen, the rest before. Everything else is varied, and counts as uncertainty.

pub mod plan;

pub mod verdict;

mod judge;
#[cfg(test)]
mod tests;

use super::record::RecordedRun;
use super::{Context, Failure, Validation};
use checkdam::plot::PlotError;
use checkdam::plot::curves::{self, Curve, Curves, Panel};
use checkdam_verification::{FaultKind, Outcome};
use rayon::prelude::*;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// The recorded runs of [`plan::all`].
const RECORD: &str = include_str!("runs/columns.csv");

/// Level ground.
pub const LEVEL: Validation = Validation {
    name: "column_level",
    title: "Columns of sand and of glass beads collapse on level ground: run-out and height against two laboratories",
    study: "78 columns on three grids and with changed inputs, a quarter of an hour",
    run: |context| run(context, false),
    draw: |folder| draw("column_level", &LEVEL_FIGURES, folder),
    covers: &[(FaultKind::Gravity, 1.05), (FaultKind::Density, 1.05), (FaultKind::ContactForce, 1.03)],
};

/// Slopes.
pub const SLOPE: Validation = Validation {
    name: "column_slope",
    title: "Columns of glass beads collapse on rough slopes up to 19 degrees: run-out against a laboratory and its law",
    study: "the same 78 columns",
    run: |context| run(context, true),
    draw: |folder| draw("column_slope", &SLOPE_FIGURES, folder),
    covers: &[
        (FaultKind::Friction, 1.05),
        (FaultKind::Gravity, 1.05),
        (FaultKind::Density, 1.05),
        (FaultKind::ContactForce, 1.03),
    ],
};

const fn measured(column: &'static str, label: &'static str) -> Curve<'static> {
    Curve { column, label, exact: false }
}

const fn exact(column: &'static str, label: &'static str) -> Curve<'static> {
    Curve { column, label, exact: true }
}

const LEVEL_FIGURES: [(&str, Curves<'static>); 3] = [
    (
        "scaling",
        Curves {
            x: "aspect_ratio",
            x_title: "height over length of the column",
            y_title: "run-out over length",
            curves: &[
                measured("run_out_1", "computed"),
                exact("run_out_measured_1", "measured"),
                exact("run_out_high_1", "measured, upper"),
                exact("run_out_low_1", "measured, lower"),
            ],
            panels: &[
                Panel { title: "sand", only: &[("grains", "sand")] },
                Panel { title: "glass beads", only: &[("grains", "beads")] },
            ],
            ..Curves::LINEAR
        },
    ),
    (
        "grids",
        Curves {
            x: "cell_1",
            x_title: "cell size over length of the column",
            y_title: "run-out over length",
            curves: &[measured("run_out_tip_1", "tip")],
            split: &[("case", "")],
            ..Curves::LINEAR
        },
    ),
    (
        "front",
        Curves {
            x: "time_1",
            x_title: "time over sqrt(h0/g)",
            y_title: "run-out over length, coarsest grid",
            curves: &[measured("run_out_1", "computed")],
            split: &[("case", "")],
            ..Curves::LINEAR
        },
    ),
];

const SLOPE_FIGURES: [(&str, Curves<'static>); 4] = [
    (
        "scaling",
        Curves {
            x: "slope_deg",
            x_title: "slope, degrees",
            y_title: "run-out, m",
            curves: &[
                measured("run_out_m", "computed"),
                exact("run_out_law_m", "law fitted to experiments"),
                exact("run_out_dam_break_m", "dam break with friction, no experiment beyond"),
                exact("run_out_heap_m", "heap at the friction angle, none short of it"),
            ],
            ..Curves::LINEAR
        },
    ),
    LEVEL_FIGURES[1],
    LEVEL_FIGURES[2],
    (
        "profiles",
        Curves {
            x: "x_m",
            x_title: "place along the bed from the back wall, m",
            y_title: "depth of the deposit, m, coarsest grid",
            curves: &[measured("depth_m", "computed")],
            split: &[("case", "")],
            ..Curves::LINEAR
        },
    ),
];

fn draw(name: &str, figures: &[(&str, Curves<'static>)], folder: &Path) -> Result<Vec<String>, PlotError> {
    let one = |(stem, what): &(&str, Curves<'static>)| {
        let file = format!("{name}_{stem}_plot.svg");
        curves::draw(folder.join(format!("{name}_{stem}.csv")), what, folder.join(&file)).map(|()| file)
    };
    figures.iter().map(one).collect()
}

/// The record's text: as recorded, or made anew in the context's folder if studies are asked for.
fn record(context: &mut Context) -> Result<String, Failure> {
    if !context.studies {
        return Ok(RECORD.to_string());
    }
    let file = context.folder.join("columns.csv");
    if let Ok(text) = std::fs::read_to_string(&file) {
        return Ok(text);
    }
    let plan = plan::all();
    let (done, stopped) = (AtomicUsize::new(0), AtomicBool::new(false));
    let progress = std::sync::Mutex::new(&mut *context.progress);
    let fault = context.fault;
    let lines: Result<Vec<Option<String>>, Failure> = plan
        .par_iter()
        .with_max_len(1)
        .map(|run| {
            if stopped.load(Ordering::Relaxed) {
                return Ok(None);
            }
            let deposit = run.run(&fault)?;
            let done = 1 + done.fetch_add(1, Ordering::Relaxed);
            if let Ok(mut tell) = progress.lock()
                && !tell(&format!("column {done} of {}", plan.len()))
            {
                stopped.store(true, Ordering::Relaxed);
            }
            Ok(Some(plan::line(run, plan::numbers(&run.column, &deposit))))
        })
        .collect();
    let lines: Option<String> = lines?.into_iter().collect();
    let text = plan::header() + &lines.ok_or(Failure::Stopped)?;
    checkdam::output::write_text(file, &text)?;
    Ok(text)
}

/// The recorded runs one by one.
///
/// # Errors
/// The record is not as it should be.
pub fn rows() -> Result<Vec<RecordedRun>, Failure> {
    let recorded = verdict::recorded(RECORD).map_err(Failure::Record)?;
    let rows = plan::all().into_iter().zip(RECORD.lines().skip(1).zip(recorded)).map(|(planned, (line, numbers))| {
        let (what, recorded) = (line.splitn(4, ',').take(3).collect::<Vec<_>>().join(", "), line.to_string());
        let cost = planned.cost(numbers.get("rest_1"));
        let anew = move || {
            let deposit = planned.run(&checkdam_verification::Fault::NONE)?;
            Ok(plan::line(&planned, plan::numbers(&planned.column, &deposit)).trim_end().to_string())
        };
        RecordedRun { what, recorded, cost, anew: Box::new(anew) }
    });
    Ok(rows.collect())
}

fn run(context: &mut Context, inclined: bool) -> Result<Outcome, Failure> {
    let text = record(context)?;
    let rows = verdict::recorded(&text).map_err(Failure::Record)?;
    let fault = context.fault;
    let coarse: Vec<plan::Planned> =
        plan::coarse().into_iter().filter(|r| (r.case.grains == "slope") == inclined).collect();
    // What notices a fault is the force on the bed; one column is enough for that.
    let of = if fault == checkdam_verification::Fault::NONE { &coarse[..] } else { &coarse[..1] };
    let deposits: Result<Vec<_>, _> = of.par_iter().with_max_len(1).map(|r| r.run(&fault)).collect();
    let runs: Vec<_> = of.iter().zip(deposits?).collect();
    let mut outcome = Outcome::default();
    for (run, deposit) in &runs {
        judge::deposit(run, deposit, &rows, &mut outcome);
    }
    if inclined {
        judge::steep(&fault, &mut outcome)?;
    }
    if fault == checkdam_verification::Fault::NONE {
        let name = if inclined { SLOPE.name } else { LEVEL.name };
        judge::against_data(name, inclined, &rows, &mut outcome);
        judge::tables(name, inclined, &runs, &rows, &mut outcome);
    }
    Ok(outcome)
}
