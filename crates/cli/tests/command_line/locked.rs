//! One run at a time writes into a folder.

use crate::sinew::{Ended, Workspace};
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

/// A run that lasts until it is killed.
struct Running(Child);

impl Running {
    fn begin(place: &Workspace) -> Self {
        let long = ["--set", "duration=10000", "--set", "output.fields_every=0.5"];
        let mut command = place.command(&[&["run", "block.ron", "--backend", "cpu"], &long[..]].concat());
        let child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        let (running, begun) = (Self(child), Instant::now());
        while !place.path("out/block/fields_000001.vtu").exists() {
            assert!(begun.elapsed() < Duration::from_secs(60), "the run does not get going");
            std::thread::sleep(Duration::from_millis(20));
        }
        running
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        self.0.kill().unwrap();
        self.0.wait().unwrap();
    }
}

fn second(place: &Workspace) -> Ended {
    place.sinew(&["run", "block.ron", "--backend", "cpu"])
}

#[test]
fn a_folder_that_is_being_written_is_refused_with_3_and_who_has_it() {
    let place = Workspace::new();
    let running = Running::begin(&place);
    let scene = place.read("out/block/scene.ron");
    let pid = format!("process {}", running.0.id());
    second(&place)
        .wants(3, &["out/block is being written by another sinew", &pid, "block.ron", " s, ", "name another"]);
    assert_eq!(place.read("out/block/scene.ron"), scene, "the second run has written");
    assert!(place.path("out/block/fields_000001.vtu").exists(), "the second run has cleared");
    place.done(&["run", "block.ron", "--backend", "cpu", "--out", "elsewhere"]);
    // what is there so far can be looked at
    place.done(&["render", "out/block", "--no-animation"]);
    drop(running);
    // killed, it has left nothing that is in the way
    let ended = second(&place);
    assert_eq!(ended.status, Some(0), "{}", ended.complained);
    assert_eq!(place.json("out/block/summary.json")["ended"], "finished");
    assert!(!place.path("out/block/fields_000100.vtu").exists());
}

#[test]
fn of_many_runs_begun_at_once_one_writes_and_the_others_say_so() {
    let place = Workspace::new();
    let long = ["--set", "duration=2"];
    let arguments = [&["run", "block.ron", "--backend", "cpu", "--threads", "1"], &long[..]].concat();
    let begin = || place.command(&arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let all: Vec<Child> = (0..4).map(|_| begin()).collect();
    let ended: Vec<Ended> = all.into_iter().map(|child| Ended::of(child.wait_with_output().unwrap())).collect();
    let done = ended.iter().filter(|ended| ended.status == Some(0)).count();
    assert!(done >= 1);
    for refused in ended.iter().filter(|ended| ended.status != Some(0)) {
        refused.wants(3, &["out/block is being written by another sinew"]);
    }
    assert_eq!(place.json("out/block/summary.json")["ended"], "finished");
    // steps that followed what is stable add up to that
    let last = *place.frames("out/block").last().unwrap();
    assert!((last - 2.0).abs() < 1e-12, "{last}");
}
