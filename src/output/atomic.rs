//! Whole files that appear at once or not at all.

use super::OutputError;
use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::Path;

/// Writes a file under the name `NAME.partial` beside its own and renames it when it is complete: whoever looks at
/// `path` sees the old file or the new one, never a part. A failed attempt takes its part away again.
pub fn replace(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> Result<(), OutputError>,
) -> Result<(), OutputError> {
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(".partial");
    let partial = path.with_file_name(name);
    let file = File::create(&partial).map_err(OutputError::system("create", path))?;
    let mut writer = BufWriter::with_capacity(1 << 16, file);
    let done = write(&mut writer).and_then(|()| writer.flush().map_err(OutputError::system("write", path)));
    // closes the file, which some systems want before they rename it, and drops what a failed write left in the buffer
    drop(writer.into_parts());
    let done = done.and_then(|()| fs::rename(&partial, path).map_err(OutputError::system("write", path)));
    if done.is_err() {
        let _ = fs::remove_file(&partial);
    }
    done
}

#[cfg(test)]
mod tests;
