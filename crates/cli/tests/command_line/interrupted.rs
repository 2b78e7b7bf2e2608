//! Ctrl-C.
#![cfg(unix)]

use crate::sinew::{Ended, Workspace};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

#[test]
fn an_interrupted_run_ends_with_130_and_leaves_whole_outputs() {
    let place = Workspace::new();
    let long = ["--set", "duration=10000", "--set", "output.fields_every=0.5", "--set", "probes.top.every=0.01"];
    let mut command = place.command(&[&["run", "block.ron", "--backend", "cpu"], &long[..]].concat());
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let begun = Instant::now();
    while !place.path("out/block/fields_000003.vtu").exists() {
        assert!(begun.elapsed() < Duration::from_secs(60), "the run does not get going");
        std::thread::sleep(Duration::from_millis(20));
    }
    let asked = Instant::now();
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    while child.try_wait().unwrap().is_none() {
        if asked.elapsed() > Duration::from_secs(20) {
            child.kill().unwrap();
            panic!("the run does not hear that it is to end");
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    let ended = Ended::of(child.wait_with_output().unwrap());
    ended.wants(130, &["interrupted"]);
    assert!(ended.said.contains("ended") && ended.said.contains("sinew render out/block"), "{}", ended.said);
    let summary = place.json("out/block/summary.json");
    assert_eq!(summary["ended"], "interrupted");
    assert!(summary["steps"].as_u64() < summary["planned_steps"].as_u64());
    assert!(place.frames("out/block").len() >= 4);
    assert!(!place.table("out/block/probe_top.csv").is_empty());
    assert_eq!(place.table("out/block/nodes.csv").len(), 64);
}
