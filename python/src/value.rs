//! Values of TOML and of Python.

use crate::failure::run_error;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};
use std::path::PathBuf;
use toml::{Table, Value};

/// A table as a dictionary.
pub fn dictionary<'py>(py: Python<'py>, table: &Table) -> PyResult<Bound<'py, PyDict>> {
    let found = PyDict::new(py);
    for (key, value) in table {
        found.set_item(key, object(py, value)?)?;
    }
    Ok(found)
}

/// A value for Python.
pub fn object<'py>(py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
    Ok(match value {
        Value::String(text) => text.into_pyobject(py)?.into_any(),
        Value::Integer(number) => number.into_pyobject(py)?.into_any(),
        Value::Float(number) => number.into_pyobject(py)?.into_any(),
        Value::Boolean(truth) => truth.into_pyobject(py)?.to_owned().into_any(),
        Value::Datetime(time) => time.to_string().into_pyobject(py)?.into_any(),
        Value::Array(list) => {
            let items = list.iter().map(|item| object(py, item)).collect::<PyResult<Vec<_>>>()?;
            PyList::new(py, items)?.into_any()
        }
        Value::Table(table) => dictionary(py, table)?.into_any(),
    })
}

/// A value of Python for a case file. Numbers of numpy count as numbers, tuples and arrays as lists.
pub fn value(object: &Bound<'_, PyAny>) -> PyResult<Value> {
    if object.is_instance_of::<PyBool>() {
        return Ok(Value::Boolean(object.extract()?));
    }
    if object.is_instance_of::<PyString>() {
        return Ok(Value::String(object.extract()?));
    }
    if object.is_instance_of::<PyInt>() {
        let number: i64 =
            object.extract().map_err(|_| PyValueError::new_err(format!("{object} is too large for a case file")))?;
        return Ok(Value::Integer(number));
    }
    if object.is_instance_of::<PyFloat>() {
        return Ok(Value::Float(object.extract()?));
    }
    if let Ok(table) = object.cast::<PyDict>() {
        let mut found = Table::new();
        for (key, item) in table {
            found.insert(key.extract()?, value(&item)?);
        }
        return Ok(Value::Table(found));
    }
    if object.is_instance_of::<PyList>() || object.is_instance_of::<PyTuple>() {
        return Ok(Value::Array(object.try_iter()?.map(|item| value(&item?)).collect::<PyResult<_>>()?));
    }
    // Arrays and numbers of numpy.
    if object.hasattr("tolist")? {
        return value(&object.call_method0("tolist")?);
    }
    let kind = object.get_type().name()?;
    Err(PyTypeError::new_err(format!(
        "a case file has no value of type {kind}: give a number, text, bool, list or dict"
    )))
}

/// Reads a TOML file, such as `summary.toml`, as a dictionary.
#[pyfunction]
pub fn read_toml(py: Python<'_>, path: PathBuf) -> PyResult<Bound<'_, PyDict>> {
    let failed = |what: String| run_error(py, &format!("error: {} cannot be read: {what}", path.display()));
    let text = std::fs::read_to_string(&path).map_err(|error| failed(error.to_string()))?;
    dictionary(py, &text.parse::<Table>().map_err(|error| failed(error.to_string()))?)
}
