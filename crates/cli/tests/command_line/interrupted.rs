//! Ctrl-C.
#![cfg(unix)]

use crate::sinew::{Ended, SCENE, Workspace};
use std::fs::File;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Runs the command, and interrupts it soon after it is seen to be on its way.
fn interrupted(place: &Workspace, arguments: &[&str], is_on_its_way: impl Fn() -> bool) -> Ended {
    let complaints = File::create(place.path("complaints")).unwrap();
    let mut child = place.command(arguments).stdout(Stdio::piped()).stderr(complaints).spawn().unwrap();
    let begun = Instant::now();
    while !is_on_its_way() {
        assert!(begun.elapsed() < Duration::from_secs(60), "the run does not get going");
        std::thread::sleep(Duration::from_millis(20));
    }
    std::thread::sleep(Duration::from_millis(100));
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
    Ended { complained: place.read("complaints"), ..ended }
}

#[test]
fn an_interrupted_run_ends_with_130_and_leaves_whole_outputs() {
    let place = Workspace::new();
    let long = ["--set", "duration=10000", "--set", "output.fields_every=0.5", "--set", "probes.top.every=0.01"];
    let arguments = [&["run", "block.ron", "--backend", "cpu"], &long[..]].concat();
    let ended = interrupted(&place, &arguments, || place.path("out/block/fields_000003.vtu").exists());
    ended.wants(130, &["interrupted"]);
    assert!(ended.said.contains("ended") && ended.said.contains("sinew render out/block"), "{}", ended.said);
    let summary = place.json("out/block/summary.json");
    assert_eq!(summary["ended"], "interrupted");
    assert!(summary["steps"].as_u64() < summary["planned_steps"].as_u64());
    assert!(place.frames("out/block").len() >= 4);
    assert!(!place.table("out/block/probe_top.csv").is_empty());
    assert_eq!(place.table("out/block/nodes.csv").len(), 64);
}

/// The block with so many elements that it takes long to come to rest, and a field more.
fn slow(field: &str) -> Workspace {
    let scene =
        SCENE.replace("(3, 3, 3)", "(24, 24, 24)").replace("duration: 0.2,", &format!("duration: 0.2, {field},"));
    Workspace::with_scene(&scene)
}

const SLOWLY: [&str; 6] = ["run", "block.ron", "--backend", "cpu", "--precision", "f64"];

/// Where bodies are on the way to rest is no equilibrium.
#[test]
fn an_interrupted_search_for_rest_leaves_no_nodes() {
    let place = slow("analysis: Static()");
    let ended = interrupted(&place, &SLOWLY, || place.path("out/block/convergence.csv").exists());
    ended.wants(130, &["interrupted"]);
    assert_eq!(place.json("out/block/summary.json")["ended"], "interrupted");
    assert!(!place.path("out/block/nodes.csv").exists(), "{}", ended.said);
}

/// While rest is sought for the start of a motion nothing is written yet; of an input it is told just before.
#[test]
fn a_search_for_rest_at_the_start_hears_that_it_is_to_end() {
    let input = "start: Equilibrium(), tools: {\"t\": (shape: Sphere(radius: 0.01), at: (0.05, 0.05, 0.2),
        moves: [(displacement: (0, 0, -1), curve: Input(name: \"depth\"))])}, contacts: [Tool(tool: \"t\")]";
    let place = slow(input);
    let is_told = || place.read("complaints").contains("depth stays at");
    let ended = interrupted(&place, &SLOWLY, is_told);
    ended.wants(130, &["interrupted"]);
    assert!(!place.path("out").exists() && ended.said.is_empty(), "{}", ended.said);
}
