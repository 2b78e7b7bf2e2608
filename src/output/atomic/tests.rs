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
