//! `include/sinew.h` is what cbindgen makes of the source. `SINEW_CBINDGEN` is the program; `tests/run` sees to it.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::path::Path;
use std::process::Command;

#[test]
fn the_header_is_that_of_the_source() {
    let Some(cbindgen) = std::env::var_os("SINEW_CBINDGEN") else {
        println!("left out: SINEW_CBINDGEN is not set");
        return;
    };
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let output = Command::new(cbindgen).arg(root).arg("--quiet").current_dir(root).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let made = String::from_utf8(output.stdout).unwrap();
    let path = root.join("include/sinew.h");
    if std::env::var_os("SINEW_BLESS").is_some() {
        std::fs::write(&path, &made).unwrap();
    }
    assert!(made.contains("sinew_simulation_new") && made.contains("SINEW_ABI_VERSION"));
    assert_eq!(std::fs::read_to_string(&path).unwrap(), made, "make it anew: SINEW_BLESS=1 crates/c/tests/run");
}

/// The names of functions: what is exported, and what the header declares.
#[test]
fn every_function_of_the_source_is_in_the_header() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let header = std::fs::read_to_string(root.join("include/sinew.h")).unwrap();
    let mut functions = 0;
    for entry in std::fs::read_dir(root.join("src")).unwrap() {
        let source = std::fs::read_to_string(entry.unwrap().path()).unwrap();
        let names = source.split("extern \"C\" fn ").skip(1).map(|rest| rest.split('(').next().unwrap().to_string());
        for name in names {
            functions += 1;
            assert!(header.contains(&format!("{name}(")), "{name} is not in the header");
        }
    }
    assert!(functions > 30, "{functions} functions");
}
