//! The forces of two runs over time, one over the other.

use crate::folder::Run;
use checkdam::output::Table;
use checkdam::plot::curves::{self, Curve, Curves};
use std::fmt::Write as _;
use std::path::Path;

const FORCES: Curves = Curves {
    x: "time_s",
    x_title: "time (s)",
    y_title: "normal force on the first barrier (N)",
    curves: &[Curve { column: "force_normal_n", label: "", exact: false }],
    split: &[("run", "")],
    ..Curves::LINEAR
};

/// Draws the force on the first barrier of both.
///
/// # Errors
/// A run has no such force, or the figure cannot be written.
pub fn draw(runs: [&Run; 2], out: &Path) -> Result<(), String> {
    let mut rows = String::from("run,time_s,force_normal_n\n");
    let mut largest = 0.0f64;
    for (run, letter) in runs.into_iter().zip(["A", "B"]) {
        let history = run.table("history.csv")?;
        let column = |name: &str| history.column(name).map_err(|error| error.to_string());
        let label: String =
            run.path.display().to_string().chars().map(|c| if matches!(c, ',' | '"') { ' ' } else { c }).collect();
        for (time, force) in
            column("time_s")?.iter().zip(column("force_normal_n")?).filter(|(_, force)| force.is_finite())
        {
            largest = largest.max(force.abs());
            let _ = writeln!(rows, "{letter}: {label},{time},{force}");
        }
    }
    // A figure is drawn from a table; this one is nobody's result.
    let table = out.with_extension("overlay.tmp");
    let (y_title, y_times) = match largest {
        force if force >= 2e7 => ("normal force on the first barrier (MN)", 1e-6),
        force if force >= 2e4 => ("normal force on the first barrier (kN)", 1e-3),
        _ => (FORCES.y_title, FORCES.y_times),
    };
    let what = &Curves { y_title, y_times, ..FORCES };
    Table::parse(&rows, &table).map_err(|error| error.to_string())?;
    std::fs::write(&table, &rows).map_err(|error| format!("cannot write beside {}: {error}", out.display()))?;
    let drawn = curves::draw(&table, what, out).map_err(|error| error.to_string());
    let _ = std::fs::remove_file(&table);
    drawn
}
