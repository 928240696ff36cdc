//! Recorded runs of a study: made anew when asked for, read otherwise.

use super::{Context, Failure};
use crate::output::Table;
use crate::study::{PlannedRun, Runs, Study, StudyError, plan, run};
use std::num::NonZero;

/// A study of the project and the record of its runs.
#[derive(Debug, Clone, Copy)]
pub struct Record {
    /// Name of the study, of its folder and of its record.
    pub name: &'static str,
    /// The text of the study.
    pub study: &'static str,
    /// Gives the text of a case that it names.
    pub read: fn(&str) -> std::io::Result<String>,
    /// The recorded table.
    pub runs: &'static str,
}

impl Record {
    /// The runs that the study asks for.
    ///
    /// # Errors
    /// The study or a case is not as it should be.
    pub fn plan(&self) -> Result<(Study, Vec<PlannedRun>), StudyError> {
        let study = Study::parse(self.study, self.name)?;
        let plan = plan(&study, self.name, &self.read)?;
        Ok((study, plan))
    }

    /// The table of the runs: recorded, or made anew in the context's folder if studies are asked for.
    ///
    /// # Errors
    /// The record does not belong to the study, or the study fails or is stopped.
    pub fn table(&self, context: &mut Context) -> Result<Table, Failure> {
        let (study, plan) = self.plan()?;
        let text = if context.studies { self.run(&study, &plan, context)? } else { self.runs.to_string() };
        let table = Table::parse(&text, format!("{}/runs.csv", self.name))?;
        if !table.cells("key")?.iter().eq(plan.iter().map(|r| &r.key)) {
            return Err(Failure::Record(format!(
                "the recorded runs are not those of the study `{}`: one of them, or a case, has changed since; make the record \
                 anew with `checkdam validate --studies {}` and put its runs.csv in its place",
                self.name, self.name
            )));
        }
        Ok(table)
    }

    fn run(&self, study: &Study, plan: &[PlannedRun], context: &mut Context) -> Result<String, Failure> {
        let folder = context.folder.join(self.name);
        std::fs::create_dir_all(&folder)
            .map_err(|source| crate::output::OutputError::Create { path: folder.clone(), source })?;
        let mut runs = Runs::open(&folder.join("runs.csv"), &study.columns());
        let progress = &mut *context.progress;
        let start = std::time::Instant::now();
        let finished = run(plan, &mut runs, processors(), &mut |p| {
            // Often, so that a stop is noticed; in words, only when a run has ended.
            if p.ended.is_none() {
                return progress("");
            }
            let done = (p.finished - p.earlier).max(1) as f64;
            let left = start.elapsed().as_secs_f64() / done * (p.total - p.finished) as f64;
            progress(&format!("{} of {} runs, about {:.0} min left", p.finished, p.total, (left / 60.0).ceil()))
        })?;
        if !finished.is_complete() {
            return Err(Failure::Stopped);
        }
        Ok(runs.csv(plan))
    }
}

/// How many runs go side by side.
pub fn processors() -> NonZero<usize> {
    std::thread::available_parallelism().unwrap_or(NonZero::<usize>::MIN)
}
