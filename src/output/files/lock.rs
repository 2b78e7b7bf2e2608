//! Who writes into an output folder: one process at a time. The system lets go of a lock when its process ends, however
//! it ends; nothing is left to be cleared away by hand.

use crate::output::OutputError;
use serde_json::{Value, json};
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, Read, Seek, Write};
use std::path::Path;
use web_time::{SystemTime, UNIX_EPOCH};

/// The lock of a run, hidden among its files.
const OF_A_RUN: &str = ".sinew.lock";
/// The lock of those that draw: pictures may be drawn of a run that is going on.
const OF_PICTURES: &str = ".sinew-pictures.lock";

/// Held as long as this lives.
#[derive(Debug)]
pub struct Lock {
    _file: File,
}

impl Lock {
    /// Locks a folder for all but pictures, for `what`: a scene.
    pub(super) fn of_a_run(folder: &Path, what: &str) -> Result<Lock, OutputError> {
        Self::take(folder, OF_A_RUN, what)
    }

    /// Locks the pictures of a folder, for `what`: who draws them.
    ///
    /// # Errors
    /// [`OutputError::Held`] says who has them; or the lock cannot be written.
    pub fn of_pictures(folder: &Path, what: &str) -> Result<Lock, OutputError> {
        Self::take(folder, OF_PICTURES, what)
    }

    fn take(folder: &Path, name: &str, what: &str) -> Result<Lock, OutputError> {
        let path = folder.join(name);
        let opened = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(&path);
        let mut file = opened.map_err(OutputError::system("create", &path))?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                let mut text = String::new();
                // where a locked file cannot be read either, it is not known who
                let _ = file.take(1 << 16).read_to_string(&mut text);
                return Err(OutputError::Held { path: folder.to_path_buf(), by: holder(&text) });
            }
            // a file system without locks: as good as it gets
            Err(TryLockError::Error(error)) if error.kind() == io::ErrorKind::Unsupported => {}
            Err(TryLockError::Error(error)) => return Err(OutputError::system("lock", &path)(error)),
        }
        let now = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
        #[allow(clippy::disallowed_methods, reason = "disallowed in a page, where there is no folder to lock")]
        let text = json!({ "pid": std::process::id(), "what": what, "since": now }).to_string();
        let written = file.set_len(0).and_then(|()| file.rewind()).and_then(|()| file.write_all(text.as_bytes()));
        written.map_err(OutputError::system("write", &path))?;
        Ok(Lock { _file: file })
    }
}

/// Who holds a lock, from what is written in it.
fn holder(text: &str) -> String {
    let Ok(Value::Object(found)) = serde_json::from_str(text) else { return "another process".to_owned() };
    let what = found.get("what").and_then(Value::as_str).unwrap_or_default();
    let pid = found.get("pid").and_then(Value::as_u64).map(|pid| format!("process {pid}"));
    let since = found.get("since").and_then(Value::as_u64).and_then(|since| {
        let since = UNIX_EPOCH.checked_add(std::time::Duration::from_secs(since))?;
        let seconds = SystemTime::now().duration_since(since).ok()?.as_secs();
        Some(match seconds {
            0..120 => format!("for {seconds} s"),
            120..7200 => format!("for {} min", seconds / 60),
            _ => format!("for {} h", seconds / 3600),
        })
    });
    let parts = [pid, since, Some(what.to_owned()).filter(|what| !what.is_empty())];
    parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
}
