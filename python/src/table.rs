//! Tables (CSV) that runs and studies leave.

use crate::failure::run_error;
use checkdam::output::{OutputError, Table};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;

/// Reads a table: its columns by name, numbers as float64 with nan where a cell is empty, and texts as lists of str.
#[pyfunction]
pub fn read_table(py: Python<'_>, path: PathBuf) -> PyResult<Bound<'_, PyDict>> {
    let failed = |error: OutputError| run_error(py, &format!("error: {error}"));
    let table = Table::load(path).map_err(failed)?;
    let found = PyDict::new(py);
    for name in table.names() {
        match table.column(name) {
            Ok(numbers) => found.set_item(name, PyArray1::from_slice(py, numbers))?,
            Err(_) => found.set_item(name, table.cells(name).map_err(failed)?)?,
        }
    }
    Ok(found)
}
