//! `summary.json`: what happened in a run, for people and programs.

use super::{OutputError, finite, replace};
use serde::Serialize;
use serde_json::Value;
use std::io::Write;
use std::path::Path;

/// Writes a summary; the file appears when it is complete.
///
/// # Errors
/// As [`text`]; that it cannot be written.
pub fn write<T: Serialize>(path: &Path, summary: &T) -> Result<(), OutputError> {
    let text = text(summary).map_err(|reason| OutputError::Format { path: path.to_path_buf(), reason })?;
    replace(path, |file| writeln!(file, "{text}").map_err(OutputError::system("write", path)))
}

/// A summary as JSON.
///
/// JSON has no NaN and no infinity. A number that is not finite becomes `null`, and the key `not_finite` of the
/// outermost object says which ones and what they were: a run that broke still tells how.
///
/// # Errors
/// What cannot stand in JSON.
pub fn text<T: Serialize>(summary: &T) -> Result<String, String> {
    let mut value = serde_json::to_value(summary).map_err(|error| error.to_string())?;
    let found = finite::not_finite(summary);
    if !found.is_empty() {
        let reasons = found.into_iter().map(|(key, number)| (key, Value::from(number.to_string()))).collect();
        match &mut value {
            Value::Object(entries) => entries.insert("not_finite".into(), Value::Object(reasons)),
            other => {
                return Err(format!("{other} holds numbers that are not finite and is no object that could say so"));
            }
        };
    }
    serde_json::to_string_pretty(&value).map_err(|error| error.to_string())
}
