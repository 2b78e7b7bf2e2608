//! `summary.json`: what happened in a run, for people and programs.

use super::{OutputError, finite, replace};
use serde::Serialize;
use serde_json::Value;
use std::io::Write;
use std::path::Path;

/// Writes a summary; the file appears when it is complete.
///
/// JSON has no NaN and no infinity. A number that is not finite becomes `null`, and the key `not_finite` of the outermost
/// object says which ones and what they were: a run that broke still tells how.
pub fn write<T: Serialize>(path: &Path, summary: &T) -> Result<(), OutputError> {
    let refused =
        |error: serde_json::Error| OutputError::Format { path: path.to_path_buf(), reason: error.to_string() };
    let mut value = serde_json::to_value(summary).map_err(refused)?;
    let found = finite::not_finite(summary);
    if !found.is_empty() {
        let reasons = found.into_iter().map(|(key, number)| (key, Value::from(number.to_string()))).collect();
        match &mut value {
            Value::Object(entries) => entries.insert("not_finite".into(), Value::Object(reasons)),
            other => {
                let reason = format!("{other} holds numbers that are not finite and is no object that could say so");
                return Err(OutputError::Format { path: path.to_path_buf(), reason });
            }
        };
    }
    let text = serde_json::to_string_pretty(&value).map_err(refused)?;
    replace(path, |file| writeln!(file, "{text}").map_err(OutputError::system("write", path)))
}
