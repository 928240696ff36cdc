//! `checkdam study`.

use super::console::{say, tell};
use super::progress::{Display, StudyDisplay};
use super::{BAD_INPUT, ENDED_EARLY, stop_on_ctrl_c};
use checkdam::case::Case;
use checkdam::output::OutputError;
use checkdam::study::{Finished, Folder, PlannedRun, Runs, Status, Study, StudyError, attempt, draw, finished, plan};
use checkdam_validation::{VALIDATIONS, Validation};
use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::Ordering;
use std::time::Duration;

/// What is done with a study.
#[derive(Debug, PartialEq, Eq)]
pub enum Task {
    /// It is looked over.
    Check,
    /// A command for each run is printed.
    List,
    /// One run is made, by its number from 1 or by its key.
    One(String),
    /// The table is made of what there is.
    Collect,
    /// All runs that are missing are made, so many at a time.
    All(Option<u16>),
}

pub fn study(path: &Path, out: Option<PathBuf>, task: &Task) -> ExitCode {
    let folder = out.unwrap_or_else(|| Path::new("out").join(path.file_stem().unwrap_or_default()));
    if let (Some(validation), Task::All(threads)) = (of_the_project(path), task) {
        super::use_threads(*threads);
        return super::validate::validate(&[validation.name.to_string()], true, &folder);
    }
    let done = Asked::new(path).and_then(|asked| match task {
        Task::Check => Ok(asked.look_over()),
        Task::List => asked.list(&folder),
        Task::One(which) => asked.one(&folder, which),
        Task::Collect => asked.collect(&folder),
        Task::All(threads) => asked.work_off(&folder, *threads),
    });
    match done {
        Ok(code) => code,
        Err(error) => {
            tell!("{}", in_words(&error));
            if of_the_project(path).is_some() {
                tell!(
                    "  the studies of a validation are made by its name alone; for this give one of their files, below validation/"
                );
            } else if matches!(error, StudyError::Unreadable { .. }) && !path.exists() {
                let known: Vec<_> = VALIDATIONS.iter().filter(|v| !v.study.is_empty()).map(|v| v.name).collect();
                tell!("  studies of the project: {}", known.join(", ").replace('_', "-"));
            }
            ExitCode::from(match &error {
                StudyError::Output(OutputError::InUse { .. } | OutputError::Foreign { .. }) => BAD_INPUT,
                StudyError::Output(_) | StudyError::Plot(_) => ENDED_EARLY,
                _ => BAD_INPUT,
            })
        }
    }
}

fn in_words(error: &StudyError) -> String {
    let text = error.to_string().trim_end().to_string();
    let bare = matches!(error, StudyError::Output(_) | StudyError::Plot(_));
    if bare { format!("error: {text}") } else { text }
}

/// The validation whose studies are asked for by its name, with hyphens or underscores; a file of that name goes first.
fn of_the_project(path: &Path) -> Option<&'static Validation> {
    let name = path.to_str()?.replace('-', "_");
    VALIDATIONS.iter().find(|v| !path.exists() && v.name == name && !v.study.is_empty())
}

/// So many runs are listed.
const LISTED: usize = 10;
/// Time between looks at a run that another process makes.
const PAUSE: Duration = Duration::from_millis(200);

/// A study that was read and planned.
struct Asked<'a> {
    path: &'a Path,
    text: String,
    study: Study,
    plan: Vec<PlannedRun>,
}

impl<'a> Asked<'a> {
    fn new(path: &'a Path) -> Result<Self, StudyError> {
        let name = path.display().to_string();
        let beside = path.parent().unwrap_or(Path::new(""));
        let study = Study::load(path)?;
        let plan = plan(&study, &name, &|case| std::fs::read_to_string(beside.join(case)))?;
        Ok(Self { path, text: std::fs::read_to_string(path).unwrap_or_default(), study, plan })
    }

    /// Says what would run.
    fn look_over(&self) -> ExitCode {
        let plan = &self.plan;
        say!("{}: {} is valid: {} runs", self.path.display(), self.study.title, plan.len());
        for run in plan.iter().take(LISTED) {
            say!("  {}", run.what);
        }
        if plan.len() > LISTED {
            say!("  and {} more", plan.len() - LISTED);
        }
        let steps = |case: &Case| case.stages.run.end_time_s / case.time_step_estimate_s();
        let work = |run: &PlannedRun| run.case.particle_count_estimate() * steps(&run.case);
        say!("  at most {:.1e} particle-steps in all, besides settling", plan.iter().map(work).sum::<f64>());
        ExitCode::SUCCESS
    }

    /// Prints the command of each run, and leaves the manifest in the folder.
    fn list(&self, at: &Path) -> Result<ExitCode, StudyError> {
        let mut notes = Vec::new();
        let folder = Folder::shared(at)?;
        let runs = folder.results(&self.plan, &self.study.columns(), &mut notes);
        folder.begin(&self.plan, &runs, &self.text, Status::Listed, &mut notes)?;
        notes.iter().for_each(|note| tell!("{note}"));
        let program = std::env::args().next().unwrap_or_else(|| "checkdam".into());
        let [program, study, at] =
            [&program, &self.path.display().to_string(), &at.display().to_string()].map(|text| quoted(text));
        for run in &self.plan {
            say!("{program} study {study} --out {at} --run {}", run.key);
        }
        Ok(ExitCode::SUCCESS)
    }

    /// The run that is asked for by its number from 1 or by its key.
    fn find(&self, which: &str, folder: &Folder) -> Result<&PlannedRun, StudyError> {
        let changed =
            "the study or one of its cases was changed since the runs were listed: list them again with --list";
        let refuse = |what: String| {
            Err(StudyError::Invalid(format!("error: --run {which}: {what}\n --> {}", self.path.display())))
        };
        if let Some(run) = self.plan.iter().find(|run| run.key == which) {
            return Ok(run);
        }
        let runs = self.plan.len();
        match which.parse::<usize>().ok().and_then(|k| Some((k, self.plan.get(k.checked_sub(1)?)?))) {
            Some((k, run)) if folder.listed(k).is_none_or(|key| key == run.key) => Ok(run),
            Some(_) => refuse(changed.into()),
            None if which.len() == 16 => refuse(format!("there is no run of this key; {changed}")),
            None => refuse(format!("there are runs 1 to {runs}, or their keys as --list prints them")),
        }
    }

    /// Makes one run and keeps its result; nothing is left to do if it is there.
    fn one(&self, at: &Path, which: &str) -> Result<ExitCode, StudyError> {
        let folder = Folder::shared(at)?;
        let run = self.find(which, &folder)?;
        if let Some(Err(what)) = folder.result(run) {
            tell!("a result is not taken: {what}; the run is made again");
        }
        let stop = stop_on_ctrl_c("stopping: nothing of this run is kept (Ctrl-C again to quit at once)");
        let mut display = Display::new();
        let mut waits = false;
        let row = loop {
            let made = attempt(run, Some(&folder), &mut |p| {
                display.show(p);
                !stop.load(Ordering::SeqCst)
            });
            match made {
                Err(OutputError::InUse { holder, .. }) if !stop.load(Ordering::SeqCst) => {
                    if !waits {
                        tell!("waiting: {holder} makes the same run");
                    }
                    waits = true;
                    std::thread::sleep(PAUSE);
                }
                Err(OutputError::InUse { .. }) => break None,
                made => break made?,
            }
        };
        display.clear();
        let name = format!("run {} of {}, {}", run.number + 1, self.plan.len(), run.what);
        let Some(row) = row else {
            say!("{name}: stopped; the same command begins it again");
            return Ok(ExitCode::from(ENDED_EARLY));
        };
        say!("{name}: {}", row.ended);
        if row.trusted == "false" {
            say!("it is not to be trusted; a run of its own says why");
        }
        Ok(if row.is_complete() { ExitCode::SUCCESS } else { ExitCode::from(ENDED_EARLY) })
    }

    /// Makes table and figure of what is there, and names what is missing.
    fn collect(&self, at: &Path) -> Result<ExitCode, StudyError> {
        let mut notes = Vec::new();
        let folder = Folder::shared(at)?;
        let runs = folder.results(&self.plan, &self.study.columns(), &mut notes);
        folder.begin(&self.plan, &runs, &self.text, Status::Ended, &mut notes)?;
        notes.iter().for_each(|note| say!("{note}"));
        self.conclude(&folder.table(), &folder.figure(), &runs, finished(&self.plan, &runs))
    }

    fn work_off(&self, at: &Path, threads: Option<u16>) -> Result<ExitCode, StudyError> {
        let threads = threads.and_then(|n| NonZero::new(usize::from(n)));
        let threads = threads.or_else(|| std::thread::available_parallelism().ok()).unwrap_or(NonZero::<usize>::MIN);
        let stop = stop_on_ctrl_c("stopping: runs that have ended are kept (Ctrl-C again to quit at once)");
        let mut notes = Vec::new();
        let mut display = StudyDisplay::new(self.plan.len());
        say!("{}: {} runs on {threads} processors", self.study.title, self.plan.len());
        let study = (&self.study, self.text.as_str());
        let worked = checkdam::study::work_off(
            &self.plan,
            study,
            at,
            threads,
            &mut |p| {
                display.show(p);
                !stop.load(Ordering::SeqCst)
            },
            &mut notes,
        );
        display.clear();
        notes.iter().for_each(|note| say!("{note}"));
        let (runs, finished) = worked?;
        self.conclude(&at.join("runs.csv"), &at.join("figure.svg"), &runs, finished)
    }

    /// Draws the figure, and says what there is and what is missing.
    fn conclude(&self, table: &Path, figure: &Path, runs: &Runs, finished: Finished) -> Result<ExitCode, StudyError> {
        say!("{} of {} runs are in {}", finished.rows, finished.total, table.display());
        if !finished.is_complete() {
            let missing: Vec<_> = self.plan.iter().filter(|run| runs.get(run).is_none()).collect();
            say!("INCOMPLETE, these are missing:");
            for run in missing.iter().take(LISTED) {
                say!("  {} (--run {}): {}", run.number + 1, run.key, run.what);
            }
            if missing.len() > LISTED {
                say!("  and {} more, which are in manifest.csv and not in runs.csv", missing.len() - LISTED);
            }
            say!("the same study goes on where it stopped");
        }
        let doubted = self.plan.iter().filter(|run| runs.get(run).is_some_and(|row| row.trusted == "false")).count();
        if doubted > 0 {
            say!(
                "{doubted} of them are not to be trusted; the column `trusted` says which, and a run of its own says why"
            );
        }
        if finished.failed > 0 {
            say!("{} runs failed; the column `ended` says why", finished.failed);
        }
        if finished.rows > finished.failed
            && let Some(asked) = &self.study.figure
        {
            draw(asked, table, figure)?;
        }
        let done = finished.is_complete() && finished.failed == 0;
        Ok(if done { ExitCode::SUCCESS } else { ExitCode::from(ENDED_EARLY) })
    }
}

/// A word of a command, for a shell.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./+=:,@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) { word.into() } else { format!("'{}'", word.replace('\'', "'\\''")) }
}
