//! The engine is compiled once for the command and the viewer: of the crates below it both ask for the same features.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::collections::BTreeSet;
use std::process::Command;

/// Crates with their features: of packages, by kinds of edges.
fn tree(packages: &[&str], edges: &str, format: &str) -> BTreeSet<String> {
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["tree", "--offline", "--prefix", "none", "--no-dedupe", "--format", format, "--edges", edges]);
    cargo.args(packages.iter().flat_map(|package| ["--package", package]));
    let output = cargo.current_dir(env!("CARGO_MANIFEST_DIR")).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap().lines().map(|line| line.trim_end().to_string()).collect()
}

#[test]
fn the_viewer_uses_the_engine_that_the_command_was_built_with() {
    let below = tree(&["sinew"], "normal,build", "{p}");
    let usual = ["sinew", "sinew-cli", "sinew-pictures", "sinew-studies"];
    let built = tree(&usual, "normal,build,dev", "{p}|{f}");
    let viewers = tree(&["sinew-view"], "normal,build,dev", "{p}|{f}");
    assert!(below.len() > 100 && viewers.len() > below.len());
    let lacks = |line: &&String| below.contains(line.split('|').next().unwrap()) && !viewers.contains(*line);
    let others: Vec<&String> = built.iter().filter(lacks).collect();
    assert!(others.is_empty(), "with other features for the viewer (pin those in Cargo.toml): {others:?}");
}
