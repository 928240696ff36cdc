//! `checkdam study`.

use super::console::{say, tell};
use super::progress::StudyDisplay;
use super::{BAD_INPUT, ENDED_EARLY, stop_on_ctrl_c};
use checkdam::case::Case;
use checkdam::output::write_text;
use checkdam::study::{PlannedRun, Runs, Study, StudyError, draw, plan, run};
use checkdam_validation::{VALIDATIONS, Validation};
use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::Ordering;

pub fn study(path: &Path, out: Option<PathBuf>, threads: Option<u16>, check: bool) -> ExitCode {
    let folder = out.unwrap_or_else(|| Path::new("out").join(path.file_stem().unwrap_or_default()));
    if let Some(validation) = of_the_project(path).filter(|_| !check) {
        super::use_threads(threads);
        return super::validate::validate(&[validation.name.to_string()], true, &folder);
    }
    let done = if check { look_over(path) } else { work_off(path, &folder, threads) };
    match done {
        Ok(code) => code,
        Err(error) => {
            tell!("{}", error.to_string().trim_end());
            if matches!(error, StudyError::Unreadable { .. }) && !path.exists() {
                let known: Vec<_> = VALIDATIONS.iter().filter(|v| !v.study.is_empty()).map(|v| v.name).collect();
                tell!("  studies of the project: {}", known.join(", ").replace('_', "-"));
            }
            ExitCode::from(BAD_INPUT)
        }
    }
}

/// The validation whose studies are asked for by its name, with hyphens or underscores; a file of that name goes first.
fn of_the_project(path: &Path) -> Option<&'static Validation> {
    let name = path.to_str()?.replace('-', "_");
    VALIDATIONS.iter().find(|v| !path.exists() && v.name == name && !v.study.is_empty())
}

/// So many runs are listed.
const LISTED: usize = 10;

/// Checks a study and every case that it makes, and says what would run.
fn look_over(path: &Path) -> Result<ExitCode, StudyError> {
    let study = Study::load(path)?;
    let plan = planned(&study, path)?;
    say!("{}: {} is valid: {} runs", path.display(), study.title, plan.len());
    for run in plan.iter().take(LISTED) {
        say!("  {}", run.what);
    }
    if plan.len() > LISTED {
        say!("  and {} more", plan.len() - LISTED);
    }
    let steps = |case: &Case| case.stages.run.end_time_s / case.time_step_estimate_s();
    let work = |run: &PlannedRun| run.case.particle_count_estimate() * steps(&run.case);
    say!("  at most {:.1e} particle-steps in all, besides settling", plan.iter().map(work).sum::<f64>());
    Ok(ExitCode::SUCCESS)
}

fn planned(study: &Study, path: &Path) -> Result<Vec<PlannedRun>, StudyError> {
    let beside = path.parent().unwrap_or(Path::new(""));
    plan(study, &path.display().to_string(), &|name| std::fs::read_to_string(beside.join(name)))
}

fn work_off(path: &Path, folder: &Path, threads: Option<u16>) -> Result<ExitCode, StudyError> {
    let study = Study::load(path)?;
    let plan = planned(&study, path)?;
    std::fs::create_dir_all(folder)
        .map_err(|source| checkdam::output::OutputError::Create { path: folder.to_path_buf(), source })?;
    let table = folder.join("runs.csv");
    let mut runs = Runs::open(&table, &study.columns());
    let threads = threads.and_then(|n| NonZero::new(usize::from(n)));
    let threads = threads.or_else(|| std::thread::available_parallelism().ok()).unwrap_or(NonZero::<usize>::MIN);
    say!("{}: {} runs on {threads} processors", study.title, plan.len());
    // What was asked stands beside what came out.
    if let Ok(text) = std::fs::read_to_string(path) {
        write_text(folder.join("study.toml"), &text)?;
    }

    let stop = stop_on_ctrl_c("stopping: runs that have ended are kept (Ctrl-C again to quit at once)");
    let mut display = StudyDisplay::new(plan.len());
    let finished = run(&plan, &mut runs, threads, &mut |p| {
        display.show(p);
        !stop.load(Ordering::SeqCst)
    });
    display.clear();
    let finished = finished?;
    if let Some(aside) = runs.aside() {
        say!(
            "runs that stood there and that another build made, or that the study has no more, are kept in {}",
            aside.display()
        );
    }
    say!("{} of {} runs are in {}", finished.rows, finished.total, table.display());
    if !finished.is_complete() {
        say!("the same command goes on where it stopped");
        return Ok(ExitCode::from(ENDED_EARLY));
    }
    let doubted = plan.iter().filter(|run| runs.get(run).is_some_and(|row| row.trusted == "false")).count();
    if doubted > 0 {
        say!("{doubted} of them are not to be trusted; the column `trusted` says which, and a run of its own says why");
    }
    if finished.rows > finished.failed
        && let Some(figure) = &study.figure
    {
        draw(figure, &table, &folder.join("figure.svg"))?;
    }
    if finished.failed > 0 {
        say!("{} runs failed; the column `ended` says why", finished.failed);
        return Ok(ExitCode::from(ENDED_EARLY));
    }
    Ok(ExitCode::SUCCESS)
}
