//! `checkdam study`.

use super::console::{say, tell};
use super::progress::StudyDisplay;
use super::{BAD_INPUT, ENDED_EARLY, stop_on_ctrl_c};
use checkdam::output::write_text;
use checkdam::study::{Runs, Study, StudyError, draw, plan, run};
use checkdam_validation::{VALIDATIONS, Validation};
use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::Ordering;

pub fn study(path: &Path, out: Option<PathBuf>, threads: Option<u16>) -> ExitCode {
    let folder = out.unwrap_or_else(|| Path::new("out").join(path.file_stem().unwrap_or_default()));
    if let Some(validation) = of_the_project(path) {
        super::use_threads(threads);
        return super::validate::validate(&[validation.name.to_string()], true, &folder);
    }
    match work_off(path, &folder, threads) {
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

fn work_off(path: &Path, folder: &Path, threads: Option<u16>) -> Result<ExitCode, StudyError> {
    let study = Study::load(path)?;
    let beside = path.parent().unwrap_or(Path::new(""));
    let plan = plan(&study, &path.display().to_string(), &|name| std::fs::read_to_string(beside.join(name)))?;
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
    say!("{} of {} runs are in {}", finished.rows, finished.total, table.display());
    if !finished.is_complete() {
        say!("the same command goes on where it stopped");
        return Ok(ExitCode::from(ENDED_EARLY));
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
