//! Numbers of the engine as numpy arrays of their own, and back.

use bytemuck::NoUninit;
use glam::DVec3;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyByteArray, PyTuple};

/// A writable array of a shape with a copy of numbers.
pub fn array<'py, T: NoUninit>(
    py: Python<'py>,
    numbers: &[T],
    kind: &str,
    shape: &[usize],
) -> PyResult<Bound<'py, PyAny>> {
    let bytes = PyByteArray::new(py, bytemuck::cast_slice(numbers));
    py.import("numpy")?.getattr("ndarray")?.call1((PyTuple::new(py, shape)?, kind, bytes))
}

/// Vectors, one a row: float64, (n, 3).
pub fn vectors<'py>(py: Python<'py>, vectors: &[DVec3]) -> PyResult<Bound<'py, PyAny>> {
    let numbers: Vec<[f64; 3]> = vectors.iter().map(DVec3::to_array).collect();
    array(py, &numbers, "float64", &[vectors.len(), 3])
}

/// Numbers: float64, (n,).
pub fn numbers<'py>(py: Python<'py>, numbers: &[f64]) -> PyResult<Bound<'py, PyAny>> {
    array(py, numbers, "float64", &[numbers.len()])
}

/// Puts an array into one of the caller's, which is handed back; alone, it is handed back itself.
pub fn into<'py>(array: Bound<'py, PyAny>, out: Option<Bound<'py, PyAny>>) -> PyResult<Bound<'py, PyAny>> {
    let Some(out) = out else { return Ok(array) };
    let (has, wanted) = (out.getattr("shape")?, array.getattr("shape")?);
    if !has.eq(&wanted)? {
        return Err(PyValueError::new_err(format!("`out` has the shape {has}; it must be {wanted}")));
    }
    let py = array.py();
    py.import("numpy")?.call_method1("copyto", (&out, array))?;
    Ok(out)
}

/// Three numbers of whatever has three.
pub fn vector(values: [f64; 3]) -> DVec3 {
    DVec3::from_array(values)
}
