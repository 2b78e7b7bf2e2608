//! Values of Python as a scene's words.

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};

/// `--set` texts of places and values: texts are RON as they stand, tuples and lists are lists of values.
pub fn sets(values: Option<&Bound<'_, PyDict>>) -> PyResult<Vec<String>> {
    let Some(values) = values else { return Ok(Vec::new()) };
    let set = |(place, value): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
        Ok(format!("{}={}", place.extract::<String>()?, ron(&value)?))
    };
    values.iter().map(set).collect()
}

/// A value as RON.
pub fn ron(value: &Bound<'_, PyAny>) -> PyResult<String> {
    if value.is_none() {
        return Ok("None".into());
    }
    if value.is_instance_of::<PyString>() {
        return value.extract();
    }
    if value.is_instance_of::<PyBool>() {
        return Ok(value.extract::<bool>()?.to_string());
    }
    if value.is_instance_of::<PyInt>() {
        return Ok(value.str()?.to_string());
    }
    if value.is_instance_of::<PyFloat>() {
        return Ok(format!("{:?}", value.extract::<f64>()?));
    }
    if value.is_instance_of::<PyList>() {
        return Ok(format!("[{}]", elements(value)?));
    }
    if value.is_instance_of::<PyTuple>() {
        return Ok(format!("({})", elements(value)?));
    }
    // numpy's numbers and arrays
    if value.hasattr("tolist")? {
        let plain = value.call_method0("tolist")?;
        return match plain.is_instance_of::<PyList>() {
            true => Ok(format!("({})", elements(&plain)?)),
            false => ron(&plain),
        };
    }
    let found = value.get_type().name()?;
    Err(PyTypeError::new_err(format!(
        "a value of a scene must be a number, bool, None, text in RON, or a tuple, list or array of such; this is of \
         type {found}"
    )))
}

fn elements(values: &Bound<'_, PyAny>) -> PyResult<String> {
    let texts: PyResult<Vec<String>> = values.try_iter()?.map(|value| ron(&value?)).collect();
    Ok(texts?.join(", "))
}
