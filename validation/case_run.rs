//! A case that was run, with all that its gauges recorded.

use crate::watch::watched;
use crate::{Context, Failure};
use checkdam::boundary::Friction;
use checkdam::case::Case;
use checkdam::run::{Experiment, Records, Summary, files, run_in_memory};
use checkdam::study::quantities::{QUANTITIES, measure};
use std::path::Path;

/// A case that was run.
pub struct CaseRun {
    /// Its name.
    pub name: &'static str,
    /// How it ended.
    pub experiment: Experiment,
    /// What was recorded.
    pub records: Records,
    /// What follows from it.
    pub summary: Summary,
}

impl CaseRun {
    /// Runs a case into `folder`, which is emptied, or in memory.
    ///
    /// # Errors
    /// The run fails or is stopped, or the folder cannot be written.
    pub fn new(name: &'static str, case: &Case, folder: Option<&Path>, context: &mut Context) -> Result<Self, Failure> {
        if let Some(folder) = folder {
            clear(folder)?;
        }
        let (experiment, records, summary) = watched(name, context.progress, |p| match folder {
            None => run_in_memory(case, p),
            Some(folder) => rayon::scope(|_| files::run_into(case, folder, p)),
        })?;
        Ok(Self { name, experiment, records, summary })
    }

    /// A quantity by its name in the tables of studies; NaN where there is none.
    pub fn get(&self, quantity: &str) -> f64 {
        let values = measure(&self.summary);
        QUANTITIES.iter().position(|q| q.name == quantity).map_or(f64::NAN, |k| values[k])
    }
}

/// Friction coefficient of the base of a case.
pub fn base_friction(case: &Case) -> f64 {
    let base = case.boundaries.iter().find(|b| Some(b.name.as_str()) == case.gauges.base_names().next());
    match base.and_then(|b| b.contact_law()) {
        Some(Friction::Coulomb(friction)) => friction,
        _ => f64::NAN,
    }
}

/// An empty folder.
///
/// # Errors
/// It cannot be emptied or made.
pub fn clear(folder: &Path) -> Result<(), Failure> {
    let fail = |source| checkdam::output::OutputError::Create { path: folder.to_path_buf(), source };
    if folder.is_dir() {
        std::fs::remove_dir_all(folder).map_err(fail)?;
    }
    Ok(std::fs::create_dir_all(folder).map_err(fail)?)
}
