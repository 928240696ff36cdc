//! Studies.

use crate::failure::{case_error, run_error};
use crate::run::{checked_threads, goes_on, listen};
use checkdam::output::OutputError;
use checkdam::study::{Study, StudyError, draw, plan, work_off};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::num::NonZero;
use std::path::{Path, PathBuf};

/// How far a study is: runs that have ended, runs in all, and what the last news were of.
struct News {
    finished: usize,
    total: usize,
    what: String,
}

/// Works off a study into a folder; whether every run has a row.
#[pyfunction]
#[pyo3(signature = (path, folder, threads=None, progress=None))]
pub fn study(
    py: Python<'_>,
    path: PathBuf,
    folder: PathBuf,
    threads: Option<i64>,
    progress: Option<Py<PyAny>>,
) -> PyResult<bool> {
    let threads = checked_threads(threads)?.and_then(NonZero::new);
    let threads = threads.or_else(|| std::thread::available_parallelism().ok()).unwrap_or(NonZero::<usize>::MIN);
    let worked = listen(
        py,
        |line| {
            let name = path.display().to_string();
            let beside = path.parent().unwrap_or(Path::new(""));
            let study = Study::load(&path)?;
            let plan = plan(&study, &name, &|case| std::fs::read_to_string(beside.join(case)))?;
            let text = std::fs::read_to_string(&path).unwrap_or_default();
            let mut notes = Vec::new();
            let mut tell = |p: &checkdam::study::Progress| {
                line.tell(News { finished: p.finished, total: p.total, what: p.run.what.clone() })
            };
            let (_, finished) = work_off(&plan, (&study, &text), &folder, threads, &mut tell, &mut notes)?;
            if finished.rows > finished.failed
                && let Some(asked) = &study.figure
            {
                draw(asked, &folder.join("runs.csv"), &folder.join("figure.svg"))?;
            }
            Ok(finished.is_complete() && finished.failed == 0)
        },
        |py, news: &News| {
            let Some(callback) = &progress else { return Ok(true) };
            let found = PyDict::new(py);
            found.set_item("finished", news.finished)?;
            found.set_item("total", news.total)?;
            found.set_item("run", &news.what)?;
            goes_on(callback, py, found)
        },
    )?;
    worked.map_err(|error: StudyError| {
        let text = error.to_string();
        match error {
            StudyError::Output(OutputError::InUse { .. } | OutputError::Foreign { .. }) => {
                case_error(py, &format!("error: {text}"))
            }
            StudyError::Output(_) | StudyError::Plot(_) => run_error(py, &format!("error: {text}")),
            _ => case_error(py, &text),
        }
    })
}
