//! A case: its text, changed field by field, and checked as the command checks it.

use crate::failure::case_error;
use crate::simulation::Simulation;
use crate::value::{object, value};
use checkdam::case::{self, CaseError, LoadedCase};
use checkdam::study::Change;
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use std::path::{Path, PathBuf};
use toml::{Table, Value};

/// A case file, and what was changed in it.
#[pyclass(module = "checkdam._checkdam")]
#[derive(Clone)]
pub struct Case {
    /// The text as it stands in the file, as long as nothing was changed; else the text that was made of the changed values.
    text: String,
    /// What stands in it.
    table: Table,
    /// How the file is called in reports.
    name: String,
    /// Where the files that it names lie.
    folder: PathBuf,
}

/// Reads and checks a case file.
#[pyfunction]
pub fn load(py: Python<'_>, path: PathBuf) -> PyResult<Case> {
    case::load(&path).map_err(|error| case_error(py, &error.to_string()))?;
    let name = path.display().to_string();
    let read = || {
        let text = std::fs::read_to_string(&path).map_err(|error| error.to_string())?;
        let table = text.parse::<Table>().map_err(|error| error.to_string())?;
        Ok((text, table))
    };
    let (text, table) = read().map_err(|error: String| case_error(py, &format!("error: {error}\n --> {name}")))?;
    let folder = path.parent().unwrap_or(Path::new("")).to_path_buf();
    Ok(Case { text, table, name, folder })
}

impl Case {
    /// The case, if it can be run.
    pub fn checked(&self, py: Python<'_>) -> PyResult<LoadedCase> {
        self.parsed().map_err(|error| case_error(py, &error.to_string()))
    }

    fn parsed(&self) -> Result<LoadedCase, CaseError> {
        case::parse_beside(&self.text, &self.name, &self.folder)
    }

    /// Makes a change; refused if the result is no case at all: a key or a type that does not exist. Values are checked later, as some
    /// only fit together.
    fn change(&mut self, py: Python<'_>, path: &str, change: &Change) -> PyResult<()> {
        let mut changed = self.clone();
        let refuse = |what: &str| case_error(py, &format!("error: {what}\n --> {}", self.name));
        change.apply(&mut changed.table).map_err(|what| refuse(&what))?;
        changed.text = toml::to_string(&changed.table).map_err(|error| refuse(&error.to_string()))?;
        if !changed.name.ends_with(" (changed)") {
            changed.name += " (changed)";
        }
        match changed.parsed() {
            Err(CaseError::Malformed(report)) => {
                Err(case_error(py, &format!("{}\n  = set: `{path}`", report.trim_end())))
            }
            _ => {
                *self = changed;
                Ok(())
            }
        }
    }
}

#[pymethods]
impl Case {
    fn __getitem__<'py>(&self, py: Python<'py>, path: &str) -> PyResult<Bound<'py, PyAny>> {
        if let Some(found) = at(&self.table, path) {
            return object(py, found);
        }
        // What the file leaves out has a default, once the case can be run.
        let whole = self.checked(py)?.case.to_toml().map_err(|error| case_error(py, &error.to_string()))?;
        let whole: Table = whole.parse().map_err(|error: toml::de::Error| case_error(py, &error.to_string()))?;
        match at(&whole, path) {
            Some(found) => object(py, found),
            None => Err(PyKeyError::new_err(format!(
                "`{path}` is neither in the case nor has it a default; see docs/reference/case.md"
            ))),
        }
    }

    fn __setitem__(&mut self, py: Python<'_>, path: &str, new: &Bound<'_, PyAny>) -> PyResult<()> {
        self.change(py, path, &Change::field(path, value(new)?))
    }

    fn __delitem__(&mut self, py: Python<'_>, path: &str) -> PyResult<()> {
        self.change(py, path, &Change { unset: vec![path.to_string()], ..Change::default() })
    }

    fn __repr__(&self) -> String {
        format!("<checkdam.Case {}>", self.name)
    }

    /// Checks all values.
    fn check(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        Ok(self.checked(py)?.warnings)
    }

    /// The case with its defaults, as the text of a case file.
    fn to_toml(&self, py: Python<'_>) -> PyResult<String> {
        self.checked(py)?.case.to_toml().map_err(|error| case_error(py, &error.to_string()))
    }

    /// A case of its own with the same values.
    fn copy(&self) -> Self {
        self.clone()
    }

    /// A simulation of it, before its first step.
    fn simulation(&self, py: Python<'_>) -> PyResult<Simulation> {
        Ok(Simulation::new(&self.checked(py)?.case))
    }

    #[getter]
    fn name(&self) -> &str {
        &self.name
    }
}

/// What stands at a path; elements of lists are found by their `name`.
fn at<'a>(table: &'a Table, path: &str) -> Option<&'a Value> {
    let mut parts = path.split('.');
    let mut found = table.get(parts.next()?)?;
    for part in parts {
        found = match found {
            Value::Table(table) => table.get(part)?,
            Value::Array(list) => list.iter().find(|v| v.get("name").and_then(Value::as_str) == Some(part))?,
            _ => return None,
        };
    }
    Some(found)
}
