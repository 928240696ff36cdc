//! Figures as SVG, drawn from tables that were written, never from live state: whoever has the tables can redraw them.
//!
//! The same table gives the same bytes. A figure names no file, date or font; text is set in the reader's `sans-serif`.

mod axes;
pub mod curves;
mod energy_layers;
pub mod energy_shares;
pub mod flow_snapshots;
pub mod force_time;
pub mod heat_map;
mod labels;
mod legend;
mod panels;
pub mod pressure_profile;
mod style;
pub mod tornado;

use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::output::{OutputError, Table};

/// Why a figure could not be drawn.
#[derive(Debug, Error)]
pub enum PlotError {
    /// A table could not be read or the figure could not be written.
    #[error(transparent)]
    File(#[from] OutputError),
    /// A table can be read but does not hold what the figure shows.
    #[error("{path}: {reason}")]
    Data {
        /// The table.
        path: PathBuf,
        /// What it lacks.
        reason: String,
    },
    /// A value handed to the figure makes no sense.
    #[error("figure: {0}")]
    Argument(String),
    /// The drawing library refused.
    #[error("figure: {0}")]
    Drawing(String),
}

impl PlotError {
    /// A table that does not hold what the figure shows.
    fn data(path: &Path, reason: impl Into<String>) -> Self {
        Self::Data { path: path.to_path_buf(), reason: reason.into() }
    }
}

/// Rows of a table grouped by their time, in order of time; rows without a time are left out.
fn by_time(table: &Table) -> Result<Vec<(f64, Vec<usize>)>, PlotError> {
    let time = table.column("time_s")?;
    let mut rows: Vec<usize> = (0..table.rows()).filter(|k| time[*k].is_finite()).collect();
    rows.sort_by(|a, b| time[*a].total_cmp(&time[*b]));
    let groups = rows.chunk_by(|a, b| time[*a] == time[*b]);
    Ok(groups.map(|group| (time[group[0]], group.to_vec())).collect())
}

/// Decimals, at most 3, that tell all these times apart from their rounded selves.
fn time_decimals(times: impl Iterator<Item = f64> + Clone) -> usize {
    let exact = |decimals: &usize| {
        let scale = 10f64.powi(*decimals as i32);
        times.clone().all(|t| ((t * scale).round() / scale - t).abs() < 2e-4)
    };
    (1..3).find(exact).unwrap_or(3)
}

#[cfg(test)]
mod tests;
