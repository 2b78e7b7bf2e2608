//! The engine's errors as exceptions of `sinew._errors`: each a text and a dict of what is known.

use pyo3::exceptions::{PyOSError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use sinew::scene::{Diagnostic, Diagnostics, Severity};
use sinew::{Error, Instability, NotConverged};
use std::any::Any;

/// An exception of the package.
pub fn exception(py: Python<'_>, name: &str, message: String, details: Bound<'_, PyDict>) -> PyErr {
    let made = || py.import("sinew._errors")?.getattr(name)?.call1((message, details));
    match made() {
        Ok(value) => PyErr::from_value(value),
        Err(error) => error,
    }
}

/// What the engine says.
pub fn of_engine(py: Python<'_>, error: &Error) -> PyErr {
    let message = error.to_string();
    let nothing = PyDict::new(py);
    match error {
        Error::Scene(diagnostics) => of_scene(py, diagnostics),
        Error::NoGpu(_) | Error::Gpu(_) => exception(py, "GpuError", message, nothing),
        Error::GpuFailed(failure) => {
            let filled = nothing
                .set_item("time", failure.time)
                .and_then(|()| nothing.set_item("step", failure.step))
                .and_then(|()| nothing.set_item("good_until", failure.good_until));
            filled.map_or_else(|error| error, |()| exception(py, "GpuError", message, nothing))
        }
        Error::Output(_) => PyOSError::new_err(message),
        Error::Unstable(broken) => match of_instability(py, broken) {
            Ok(details) => exception(py, "Unstable", message, details),
            Err(error) => error,
        },
        Error::NotConverged(found) => match of_residual(py, found) {
            Ok(details) => exception(py, "NotConverged", message, details),
            Err(error) => error,
        },
        Error::NotUnloaded(_) => exception(py, "NotConverged", message, nothing),
        Error::Snapshot(_) => exception(py, "SnapshotError", message, nothing),
        Error::Options(_) => PyValueError::new_err(message),
        Error::Broken(_) => exception(py, "Bug", message, nothing),
    }
}

/// A scene's mistakes: the engine's own picture of them, and a list.
pub fn of_scene(py: Python<'_>, diagnostics: &Diagnostics) -> PyErr {
    let details = PyDict::new(py);
    match list(py, diagnostics).and_then(|list| details.set_item("diagnostics", list)) {
        Ok(()) => exception(py, "SceneError", diagnostics.render(false), details),
        Err(error) => error,
    }
}

/// Each mistake as a dict: severity, message, file, line, column, label, notes.
pub fn list<'py>(py: Python<'py>, diagnostics: &Diagnostics) -> PyResult<Bound<'py, PyList>> {
    let list = PyList::empty(py);
    for (diagnostic, line) in diagnostics.list().into_iter().zip(diagnostics.lines()) {
        let known = PyDict::new(py);
        let severity = if diagnostic.severity == Severity::Error { "error" } else { "warning" };
        let (file, line, column) = place(diagnostic, severity, &line);
        known.set_item("severity", severity)?;
        known.set_item("message", &diagnostic.message)?;
        known.set_item("file", file)?;
        known.set_item("line", line)?;
        known.set_item("column", column)?;
        known.set_item("label", &diagnostic.label)?;
        known.set_item("notes", &diagnostic.notes)?;
        list.append(known)?;
    }
    Ok(list)
}

/// The place that a line for editors begins with: `cube.ron:3:15: error: ...`.
fn place(diagnostic: &Diagnostic, severity: &str, line: &str) -> (Option<String>, Option<u64>, Option<u64>) {
    let before = line.strip_suffix(&diagnostic.message).and_then(|rest| rest.strip_suffix(&format!(": {severity}: ")));
    let Some(before) = before else { return (None, None, None) };
    let mut parts = before.rsplitn(3, ':');
    let (column, line, file) = (parts.next(), parts.next(), parts.next());
    match (file, line.and_then(|line| line.parse().ok()), column.and_then(|column| column.parse().ok())) {
        (Some(file), Some(line), Some(column)) => (Some(file.into()), Some(line), Some(column)),
        _ => (Some(before.into()), None, None),
    }
}

fn of_instability<'py>(py: Python<'py>, broken: &Instability) -> PyResult<Bound<'py, PyDict>> {
    let details = PyDict::new(py);
    details.set_item("time", broken.time)?;
    details.set_item("step", broken.step)?;
    details.set_item("body", &broken.body)?;
    details.set_item("what", &broken.what)?;
    details.set_item("cause", &broken.cause)?;
    details.set_item("good_until", broken.good_until)?;
    details.set_item("criterion", broken.criterion.name)?;
    details.set_item("value", broken.criterion.value)?;
    details.set_item("limit", broken.criterion.limit)?;
    details.set_item("node", broken.criterion.node)?;
    details.set_item("element", broken.criterion.element)?;
    Ok(details)
}

fn of_residual<'py>(py: Python<'py>, found: &NotConverged) -> PyResult<Bound<'py, PyDict>> {
    let details = PyDict::new(py);
    details.set_item("steps", found.steps)?;
    details.set_item("residual", found.equilibrium.residual)?;
    details.set_item("tolerance", found.equilibrium.tolerance)?;
    let (body, node, force) = &found.equilibrium.worst;
    details.set_item("body", body)?;
    details.set_item("node", node)?;
    details.set_item("force", force)?;
    Ok(details)
}

/// A panic of the engine: what it said.
pub fn said(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    let text = text.or_else(|| panic.downcast_ref::<String>().cloned());
    text.unwrap_or_else(|| "it did not say why".into())
}

/// A mistake of sinew's own.
pub fn bug(py: Python<'_>, what: &str) -> PyErr {
    let message = format!("a mistake of sinew's own: {what}; please report it with the scene");
    exception(py, "Bug", message, PyDict::new(py))
}
