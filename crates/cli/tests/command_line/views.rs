//! `sinew view` starts the viewer beside it, or says how to get it.
#![cfg(unix)]

use std::io::ErrorKind;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Command, Output};
use std::time::Duration;

/// A copy of the command in a folder, where nothing else is found.
fn view(folder: &Path) -> Output {
    let own = folder.join("sinew");
    std::fs::copy(env!("CARGO_BIN_EXE_sinew"), &own).unwrap();
    let mut command = Command::new(own);
    command.args(["view", "cube.ron", "--run"]).env("PATH", folder.join("nothing"));
    // a test beside this one may just have begun a program, which has what was written open until it runs
    loop {
        match command.output() {
            Err(error) if error.kind() == ErrorKind::ExecutableFileBusy => {
                std::thread::sleep(Duration::from_millis(20))
            }
            ended => return ended.unwrap(),
        }
    }
}

#[test]
fn the_viewer_gets_the_words_and_gives_the_status() {
    let folder = tempfile::tempdir().unwrap();
    let viewer = folder.path().join("sinew-view");
    std::fs::write(&viewer, "#!/bin/sh\necho \"shown: $*\"\nexit 7\n").unwrap();
    std::fs::set_permissions(&viewer, std::fs::Permissions::from_mode(0o755)).unwrap();
    let ended = view(folder.path());
    assert_eq!(String::from_utf8_lossy(&ended.stdout), "shown: cube.ron --run\n");
    assert_eq!(ended.status.code(), Some(7));
}

#[test]
fn who_has_no_viewer_is_told_how_to_get_it() {
    let folder = tempfile::tempdir().unwrap();
    let ended = view(folder.path());
    let told = String::from_utf8_lossy(&ended.stderr);
    assert!(told.contains("cargo install --path crates/view") && ended.status.code() == Some(2), "{told}");
}
