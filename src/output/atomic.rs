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
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
    use super::*;

    #[test]
    fn a_failed_write_leaves_the_old_file_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("summary.json");
        fs::write(&path, "old").unwrap();
        let refused = replace(&path, |file| {
            file.write_all(b"half of the ne").unwrap();
            Err(OutputError::Format { path: path.clone(), reason: "no".into() })
        });
        assert!(refused.is_err());
        assert_eq!(fs::read_to_string(&path).unwrap(), "old");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_disk_is_told_with_path_and_reason() {
        // /dev/full takes no byte; renaming is never reached
        let path = Path::new("/dev/full");
        let mut writer = BufWriter::new(fs::OpenOptions::new().write(true).open(path).unwrap());
        writer.write_all(b"x").unwrap();
        let error = writer.flush().map_err(OutputError::system("write", path)).unwrap_err().to_string();
        assert!(error.starts_with("cannot write /dev/full: No space left on device"), "{error}");
    }
}
