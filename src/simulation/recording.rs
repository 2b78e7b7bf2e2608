//! What programs and hands did in a run: kept, and read back.

use super::PoseChange;
use crate::error::Error;
use crate::output::{OutputError, replace};
use serde::{Deserialize, Serialize};
use std::io::Write;
use std::path::Path;

/// Every change of the inputs of a run and all that hands did, with the step that began with it. Replayed on a
/// simulation that is where this one was, it gives the same bits. Serialised as RON, JSON or anything else that keeps
/// numbers to the last bit.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct InputRecording {
    /// Steps taken before it began.
    pub from: u64,
    /// In the order of steps.
    #[serde(default)]
    pub changes: Vec<InputChange>,
    /// Where devices of hands were, in the order of steps.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub poses: Vec<PoseChange>,
}

/// One change of an input.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct InputChange {
    /// Steps taken before it.
    pub step: u64,
    /// The input.
    pub name: String,
    /// What it was set to.
    pub value: f64,
}

impl InputRecording {
    /// As RON.
    ///
    /// # Errors
    /// What RON cannot hold.
    pub fn to_ron(&self) -> Result<String, Error> {
        let pretty = ron::ser::PrettyConfig::new().depth_limit(2);
        ron::ser::to_string_pretty(self, pretty).map_err(|error| Error::Options(format!("the recording: {error}")))
    }

    /// From RON.
    ///
    /// # Errors
    /// What is no recording, with line and column.
    pub fn from_ron(text: &str) -> Result<Self, Error> {
        ron::from_str(text).map_err(|error| Error::Options(format!("this is no recording of inputs: {error}")))
    }

    /// Writes it as RON; the file appears when it is complete.
    ///
    /// # Errors
    /// Files that cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), Error> {
        let text = self.to_ron()?;
        Ok(replace(path, |file| file.write_all(text.as_bytes()).map_err(OutputError::system("write", path)))?)
    }

    /// Reads one.
    ///
    /// # Errors
    /// As [`InputRecording::from_ron`], and files that cannot be read.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let text = std::fs::read_to_string(path).map_err(OutputError::system("read", path))?;
        Self::from_ron(&text)
    }
}
