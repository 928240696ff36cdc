//! The figures of a run, drawn from its tables.

use super::experiment::Experiment;
use super::gauges::{Barrier, suffix};
use super::summary::Summary;
use crate::case::Case;
use crate::output::Table;
use crate::plot::curves::{Curve, Curves};
use crate::plot::{self, PlotError, force_time::ReferenceLine};
use std::path::Path;

/// Force on a barrier that is a body: what contact gives, what the clamp takes, what is left as momentum.
const BARRIER_FORCES: Curves = Curves {
    x: "time_s",
    x_title: "time (s)",
    y_title: "force against the face (N)",
    curves: &[
        Curve { column: "contact_normal_n", label: "contact with the flow", exact: false },
        Curve { column: "clamp_normal_n", label: "clamp", exact: false },
        Curve { column: "inertia_normal_n", label: "rate of momentum", exact: false },
    ],
    ..Curves::LINEAR
};

/// [`BARRIER_FORCES`] in the unit in which forces of this size (N) are read: eight digits would meet the axis' title.
fn barrier_forces(largest: f64) -> Curves<'static> {
    let (y_title, y_times) = match largest {
        force if force >= 2e7 => ("force against the face (MN)", 1e-6),
        force if force >= 2e4 => ("force against the face (kN)", 1e-3),
        _ => (BARRIER_FORCES.y_title, BARRIER_FORCES.y_times),
    };
    Curves { y_title, y_times, ..BARRIER_FORCES }
}

/// The largest magnitude (N) in the columns of these curves.
fn largest(table: &Path, curves: &Curves) -> f64 {
    let Ok(table) = Table::load(table) else { return 0.0 };
    let columns = curves.curves.iter().filter_map(|curve| table.column(curve.column).ok());
    columns.flatten().filter(|force| force.is_finite()).fold(0.0, |most, force| most.max(force.abs()))
}

/// Its face, bent.
const PEAK_DEFLECTION: Curves = Curves {
    x: "deflection_m",
    x_title: "deflection at the largest force (m)",
    y_title: "height above the foot (m)",
    curves: &[Curve { column: "height_m", label: "", exact: false }],
    ..Curves::LINEAR
};

/// Draws all figures of a run from its tables, leaving out those whose table has no row yet. All of them are tried, also when one
/// fails.
pub(super) fn draw_figures(
    case: &Case,
    directory: &Path,
    experiment: &Experiment,
    summary: &Summary,
) -> Result<(), PlotError> {
    let at = |name: &str| directory.join(name);
    let has_rows = |name: &str| !Table::load(at(name)).is_ok_and(|table| table.rows() == 0);
    let mut results = Vec::new();
    for (k, barrier) in experiment.barriers().iter().enumerate() {
        results.extend(draw_barrier(
            directory,
            &suffix(barrier, k),
            barrier,
            if k == 0 { Some(summary) } else { None },
        ));
    }
    // Shares of the energy at release say nothing where more comes in.
    if summary.energy.initial_j > 0.0 && case.inflows.is_empty() && has_rows("energy.csv") {
        results.push(plot::energy_shares::draw(at("energy.csv"), at("energy_shares.svg")));
    }
    if at("field.csv").exists() && has_rows("field.csv") {
        let bends = experiment.barriers().iter().enumerate().find(|(_, b)| b.structure().is_some());
        let outline = bends.map(|(k, b)| at(&format!("barrier_outline{}.csv", suffix(b, k))));
        let (field, geometry, out) = (at("field.csv"), at("geometry.csv"), at("flow_snapshots.svg"));
        let (shown, inclination) = (&plot::flow_snapshots::Shown::SPEED, case.gravity.inclination_deg);
        let drawn =
            plot::flow_snapshots::draw_with_barrier(field, shown, geometry, outline.as_deref(), inclination, out);
        results.push(drawn);
    }
    results.into_iter().collect()
}

/// Draws the figures of a barrier from its tables. The force that it would take at least is known of the first, with its `summary`.
fn draw_barrier(
    directory: &Path,
    suffix: &str,
    barrier: &Barrier,
    summary: Option<&Summary>,
) -> Vec<Result<(), PlotError>> {
    let at = |name: &str, kind: &str| directory.join(format!("{name}{suffix}.{kind}"));
    let has_rows = |name: &str| !Table::load(at(name, "csv")).is_ok_and(|table| table.rows() == 0);
    let mut results = Vec::new();
    if barrier.structure().is_some() && has_rows("barrier") {
        let forces = barrier_forces(largest(&at("barrier", "csv"), &BARRIER_FORCES));
        results.push(plot::curves::draw(at("barrier", "csv"), &forces, at("barrier_forces", "svg")));
    }
    if !barrier.peak_profile().points.is_empty() {
        let (table, figure) = (at("barrier_profile_at_peak", "csv"), at("barrier_deflection", "svg"));
        results.push(plot::curves::draw(table, &PEAK_DEFLECTION, figure));
    }
    if has_rows("history") {
        let deposit = summary.and_then(|s| s.deposit.as_ref());
        let value = deposit.map(|d| d.theoretical_static_force_n).filter(|f| f.is_finite());
        let label = "weight less full base friction\nm g (sin \u{3b8} \u{2212} \u{3bc} cos \u{3b8})";
        let lines: Vec<_> = value.map(|v| ReferenceLine::new(label, v)).into_iter().collect();
        results.push(plot::force_time::draw(at("history", "csv"), &lines, at("force_time", "svg")));
    }
    if has_rows("pressure_profile") {
        let (table, figure) = (at("pressure_profile", "csv"), at("pressure_profile", "svg"));
        results.push(plot::pressure_profile::draw(table, figure));
    }
    results
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forces_are_drawn_in_the_unit_in_which_they_are_read() {
        for (force, unit, shown) in [(300.0, "(N)", 300.0), (5e4, "(kN)", 50.0), (4e7, "(MN)", 40.0)] {
            let what = barrier_forces(force);
            assert!(what.y_title.ends_with(unit) && (what.y_times * force - shown).abs() < 1e-9, "{what:?}");
        }
        let folder = tempfile::tempdir().expect("a folder");
        let table = folder.path().join("barrier.csv");
        std::fs::write(&table, "time_s,contact_normal_n,clamp_normal_n,inertia_normal_n\n0,1,-4e7,\n")
            .expect("written");
        assert_eq!(largest(&table, &BARRIER_FORCES), 4e7);
    }
}
