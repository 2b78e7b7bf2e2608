//! What the engine tells, as plain dicts, lists and numbers.

use pyo3::prelude::*;
use serde::Serialize;

/// A structure as Python has it: fields by their names, as `summary.json` does.
pub fn dict<'py>(py: Python<'py>, told: &impl Serialize) -> PyResult<Bound<'py, PyAny>> {
    let text = serde_json::to_string(told).map_err(|error| crate::errors::bug(py, &error.to_string()))?;
    py.import("json")?.call_method1("loads", (text,))
}
