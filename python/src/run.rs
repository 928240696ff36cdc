//! A run, with the interpreter's lock released, heard by Ctrl-C.

use crate::case::Case;
use crate::failure::{case_error, run_error};
use checkdam::run::{Progress, files, run_claimed};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

/// Time between looks for Ctrl-C, and between calls of a callback.
const LOOK: Duration = Duration::from_millis(50);

/// What a worker tells of itself, and is told.
pub struct Line<T> {
    latest: Mutex<Option<T>>,
    stop: AtomicBool,
}

impl<T> Line<T> {
    fn new() -> Self {
        Self { latest: Mutex::new(None), stop: AtomicBool::new(false) }
    }

    /// Told by the worker; whether it should go on.
    pub fn tell(&self, news: T) -> bool {
        *self.latest.lock().unwrap_or_else(PoisonError::into_inner) = Some(news);
        !self.stop.load(Ordering::SeqCst)
    }
}

/// Does `work` on a thread of its own, without the interpreter's lock, while this thread listens for Ctrl-C and hands what the worker
/// tells to `progress`. An exception of either ends the work in order, and is raised then.
pub fn listen<T: Send, R: Send>(
    py: Python<'_>,
    work: impl FnOnce(&Line<T>) -> R + Send,
    mut progress: impl FnMut(Python<'_>, &T) -> PyResult<bool> + Send,
) -> PyResult<R> {
    let line = Line::new();
    let (raised, result) = py.detach(|| {
        std::thread::scope(|scope| {
            let (done, ended) = mpsc::channel();
            let worker = scope.spawn(|| {
                // Dropped at the end, however that is.
                let _done: Sender<()> = done;
                work(&line)
            });
            let mut raised = None;
            while ended.recv_timeout(LOOK) == Err(RecvTimeoutError::Timeout) {
                let news = line.latest.lock().unwrap_or_else(PoisonError::into_inner).take();
                let heard = Python::attach(|py| {
                    py.check_signals()?;
                    if raised.is_some() { Ok(true) } else { news.map_or(Ok(true), |news| progress(py, &news)) }
                });
                match heard {
                    Ok(true) => {}
                    Ok(false) => line.stop.store(true, Ordering::SeqCst),
                    Err(error) => {
                        line.stop.store(true, Ordering::SeqCst);
                        raised.get_or_insert(error);
                    }
                }
            }
            (raised, worker.join())
        })
    });
    match (raised, result) {
        (Some(error), _) => Err(error),
        (None, Ok(result)) => Ok(result),
        (None, Err(_)) => {
            Err(run_error(py, "error: the program broke; this is a defect of checkdam, please report it with the case"))
        }
    }
}

/// Works with so many threads, or with all that there are.
pub fn with_threads<R: Send>(threads: Option<usize>, work: impl FnOnce() -> R + Send) -> Result<R, String> {
    match threads {
        None => Ok(work()),
        Some(n) => {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(n).build();
            Ok(pool.map_err(|error| error.to_string())?.install(work))
        }
    }
}

/// Refuses numbers of threads that make no sense.
pub fn checked_threads(threads: Option<i64>) -> PyResult<Option<usize>> {
    match threads {
        None => Ok(None),
        Some(n @ 1..=1024) => Ok(Some(n as usize)),
        Some(n) => Err(PyValueError::new_err(format!(
            "threads = {n}: give a number from 1 to 1024, or None for all processors"
        ))),
    }
}

/// How far a run is, for a callback.
pub fn dictionary<'py>(py: Python<'py>, p: &Progress) -> PyResult<Bound<'py, PyDict>> {
    let found = PyDict::new(py);
    found.set_item("stage", p.stage.name())?;
    found.set_item("time_s", p.time)?;
    found.set_item("end_s", p.end)?;
    found.set_item("steps", p.steps)?;
    found.set_item("particles", p.particles)?;
    found.set_item("force_n", p.force)?;
    found.set_item("residual_1", p.residual)?;
    Ok(found)
}

/// What a callback answers: None and what is true go on.
pub fn goes_on(callback: &Py<PyAny>, py: Python<'_>, news: Bound<'_, PyDict>) -> PyResult<bool> {
    let answer = callback.call1(py, (news,))?;
    Ok(answer.is_none(py) || answer.is_truthy(py)?)
}

/// Runs a case into a folder; whether it was stopped by its callback.
#[pyfunction]
#[pyo3(signature = (case, folder, threads=None, force=false, progress=None))]
pub fn run(
    py: Python<'_>,
    case: &Case,
    folder: PathBuf,
    threads: Option<i64>,
    force: bool,
    progress: Option<Py<PyAny>>,
) -> PyResult<bool> {
    let case = case.checked(py)?.case;
    let threads = checked_threads(threads)?;
    let claim = files::Claim::new(&folder, force).map_err(|what| case_error(py, &format!("error: {what}")))?;
    let ended = listen(
        py,
        |line| {
            with_threads(threads, || {
                let mut stopped = false;
                let result = run_claimed(&case, claim, &mut |p| {
                    stopped = !line.tell(*p);
                    !stopped
                });
                result.map(|_| stopped).map_err(|error| error.to_string())
            })
            .and_then(|ended| ended)
        },
        |py, p| progress.as_ref().map_or(Ok(true), |callback| goes_on(callback, py, dictionary(py, p)?)),
    )?;
    ended.map_err(|error| {
        run_error(py, &format!("error: {error}\n  = folder: what was computed is in {}", folder.display()))
    })
}
