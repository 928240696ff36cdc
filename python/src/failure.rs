//! Errors, as the classes of `checkdam.errors`.

use pyo3::prelude::*;

/// An error of the class `class`, made of the report for the user.
pub fn failure(py: Python<'_>, class: &str, report: &str) -> PyErr {
    let made = || py.import("checkdam.errors")?.getattr(class)?.call1((report,));
    match made() {
        Ok(error) => PyErr::from_value(error),
        Err(error) => error,
    }
}

/// The input is at fault.
pub fn case_error(py: Python<'_>, report: &str) -> PyErr {
    failure(py, "CaseError", report)
}

/// A run or a study failed, or its results could not be written or read.
pub fn run_error(py: Python<'_>, report: &str) -> PyErr {
    failure(py, "RunError", report)
}
