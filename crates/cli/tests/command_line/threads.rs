//! `--threads 1` means one: no pool of threads is made in set-up, steps, guards or output.
#![cfg(target_os = "linux")]

use crate::sinew::Workspace;
use std::process::Stdio;
use std::time::Duration;

/// What the machine's own pool would have, if something asked for it.
const POOL: usize = 23;

#[test]
fn one_thread_is_one_in_setup_and_output_too() {
    let place = Workspace::new();
    let long = ["--set", "duration=3", "--set", "output.fields_every=0.02", "--threads", "1", "--backend", "cpu"];
    let mut command = place.command(&[&["run", "block.ron"], &long[..]].concat());
    let command = command.env("RAYON_NUM_THREADS", POOL.to_string()).stdout(Stdio::null()).stderr(Stdio::null());
    let mut child = command.spawn().unwrap();
    let tasks = format!("/proc/{}/task", child.id());
    let (mut most, mut seen) = (0, 0);
    while child.try_wait().unwrap().is_none() {
        if let Ok(found) = std::fs::read_dir(&tasks) {
            (most, seen) = (most.max(found.count()), seen + 1);
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    assert!(child.wait().unwrap().success());
    println!("{most} threads at most in {seen} looks");
    assert!(seen > 20, "the run was too short to be looked at");
    // the program, a listener for Ctrl-C, a progress bar, one worker
    assert!(most < POOL, "{most} threads where one was asked for");
}
