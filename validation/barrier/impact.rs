//! The flume at 60 degrees against four barriers on coarse cells, run as the command does it: what must hold at every moment, whatever
//! the barrier.

use super::close_up::BARRIERS;
use super::records::{LITERAL, RIGIDITY};
use crate::balances::{Balances, largest};
use crate::watch::watched;
use crate::{Context, Failure, Validation};
use checkdam::check::Check;
use checkdam::gauge::StructureSample;
use checkdam::plot::PlotError;
use checkdam::run::{Records, Summary, run_in_memory};
use checkdam::study::quantities::{QUANTITIES, measure};
use checkdam_verification::Outcome;
use checkdam_verification::report::number;
use std::path::Path;

/// The runs.
pub const VALIDATION: Validation = Validation {
    name: "barrier_impact",
    title: "Four barriers on cells of 20 mm: the force on them read in three ways, and all balances",
    study: "",
    run,
    draw: |_: &Path| -> Result<Vec<String>, PlotError> { Ok(Vec::new()) },
    covers: &[],
};

/// Cell size, m, and end of the runs, s after release.
const CELL: f64 = 0.02;
const END: f64 = 0.7;

fn run(context: &mut Context) -> Result<Outcome, Failure> {
    let mut outcome = Outcome::default();
    let mut text = String::from("quantity");
    let mut columns: Vec<Vec<f64>> = Vec::new();
    let mut forces =
        String::from("barrier,contact_impulse_n_s,clamp_and_inertia_n_s,layer1_n_s,layer2_n_s,layer3_n_s\n");
    // One barrier shows a fault.
    let barriers = if checkdam::seeded::active().is_none() { &BARRIERS[..] } else { &BARRIERS[..1] };
    for &(name, stiffness) in barriers {
        let mut case = RIGIDITY.planned(LITERAL, stiffness)?.case;
        (case.grid.spacing_m, case.stages.run.end_time_s) = (CELL, END);
        let (_, records, summary) = watched(name, context.progress, |p| run_in_memory(&case, p))?;
        outcome.checks.extend(checks(name, &records, &summary));
        forces += &three_ways(name, &records);
        text += &format!(",{name}");
        columns.push(measure(&summary));
    }
    text.push('\n');
    for (k, q) in QUANTITIES.iter().enumerate() {
        // Round-off differs with the order of sums; its size is judged by the checks.
        if q.name.starts_with("momentum_closure") || q.name.starts_with("imbalance") {
            continue;
        }
        let cells: Vec<String> =
            columns.iter().map(|c| if c[k].is_finite() { number(c[k]) } else { String::new() }).collect();
        text += &format!("{},{}\n", q.name, cells.join(","));
    }
    outcome.tables.push(("barrier_impact_quantities".into(), text));
    outcome.tables.push(("barrier_impact_three_ways".into(), forces));
    Ok(outcome)
}

/// Contact less clamp and inertia over the sum of their magnitudes.
fn imbalance(s: &StructureSample) -> f64 {
    let left = [
        s.contact.normal - s.clamp.normal - s.inertia.normal,
        s.contact.tangential - s.clamp.tangential - s.inertia.tangential,
    ];
    let size = |n: f64, t: f64| n.hypot(t);
    let sum = size(s.contact.normal, s.contact.tangential)
        + size(s.clamp.normal, s.clamp.tangential)
        + size(s.inertia.normal, s.inertia.tangential);
    if sum > 0.0 { size(left[0], left[1]) / sum } else { 0.0 }
}

fn checks(name: &str, records: &Records, summary: &Summary) -> Vec<Check> {
    // Samples without force have nothing to compare but round-off.
    let loaded = records.structure.iter().filter(|(_, s)| s.contact.normal.abs() > 1.0);
    let worst = largest(loaded.map(|(_, s)| imbalance(s)));
    Balances::of(summary, Some(worst)).checks(&format!("{name}: "), "ledgers and gauges of the run")
}

/// Impulse against the face by contact, by clamp and inertia, and by the stress of one, two and three layers of points.
fn three_ways(name: &str, records: &Records) -> String {
    let mut sums = [0.0; 5];
    for (pair, row) in records.structure.windows(2).zip(&records.history[1..]) {
        let (dt, s) = (pair[1].0 - pair[0].0, &pair[1].1);
        let forces = [s.contact.normal, s.clamp.normal + s.inertia.normal, row.layers[0], row.layers[1], row.layers[2]];
        sums.iter_mut().zip(forces).for_each(|(sum, f)| *sum += f * dt);
    }
    format!("{name},{}\n", sums.map(number).join(","))
}
