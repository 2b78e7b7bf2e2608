//! Hostile input: whatever a file holds, it is read or refused, with no panic, no endless wait, and no memory out of
//! proportion to it.
//!
//! Inputs are mutants of sound files and of those in `corpus/`, which broke something once or come close to a limit.
//! The variable `SINEW_FUZZ` says how many (a million takes an hour), `SINEW_FUZZ_SEED` where to begin; the same
//! numbers give the same inputs. What breaks something is kept in the folder `sinew-fuzz` of the system's temporary
//! files.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod dice;
mod ended;
mod generate;
mod materials;
mod memory;
mod mutate;
mod pairs;
#[path = "../meshes/samples.rs"]
#[allow(dead_code)]
mod samples;
#[path = "../meshes/samples_vtk.rs"]
#[allow(dead_code)]
mod samples_vtk;
mod seeds;
mod solvers;
mod sound;
mod surgery;
mod targets;
mod whole;

use std::collections::BTreeMap;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::time::Duration;
use targets::{TARGETS, Target};

/// Inputs of the everyday test.
const EVERYDAY: usize = 6_000;
/// What takes so long hangs (s): sound inputs of this size take milliseconds.
const HANGS: u64 = 120;

/// Where the last panic was, and what it said.
static PANIC: Mutex<String> = Mutex::new(String::new());
/// Inputs tried so far.
static TRIED: AtomicU64 = AtomicU64::new(0);

fn number(variable: &str, otherwise: usize) -> usize {
    std::env::var(variable).ok().and_then(|text| text.parse().ok()).unwrap_or(otherwise)
}

/// The folder of inputs that are being tried, and of those that broke something.
fn place() -> PathBuf {
    let place = std::env::temp_dir().join("sinew-fuzz");
    std::fs::create_dir_all(&place).unwrap();
    place
}

/// Ends the process when an input takes for ever.
fn catch_panics() {
    std::thread::spawn(|| {
        let mut before = u64::MAX;
        loop {
            std::thread::sleep(Duration::from_secs(HANGS));
            let now = TRIED.load(Relaxed);
            if now == before {
                eprintln!("an input hangs; it is in {}", place().display());
                std::process::abort();
            }
            before = now;
        }
    });
}

/// What goes wrong with an input, if anything. The input is in a file before it is tried: not even a crash loses it.
fn attempt(target: &Target, input: &[u8], folder: &Path) -> Result<(), String> {
    let path = folder.join(target.file);
    std::fs::write(&path, input).unwrap();
    let mut panicked = false;
    let held = memory::most_held(|| {
        panicked = catch_unwind(AssertUnwindSafe(|| (target.attempt)(input, &path))).is_err();
    });
    TRIED.fetch_add(1, Relaxed);
    if panicked {
        return Err(PANIC.lock().map(|text| text.clone()).unwrap_or_default());
    }
    let (least, each) = target.memory;
    let most = least + each * input.len();
    if held > most { Err(format!("takes more than {most} bytes of memory")) } else { Ok(()) }
}

/// Tries inputs; gives what went wrong, each kind once, with the file that shows it.
fn try_all(target: &Target, inputs: impl Iterator<Item = Vec<u8>>) -> (usize, BTreeMap<String, PathBuf>) {
    let folder = tempfile::Builder::new()
        .prefix(&format!("{}-", target.name))
        .disable_cleanup(true)
        .tempdir_in(place())
        .unwrap();
    let (mut tried, mut wrong) = (0, BTreeMap::new());
    for input in inputs {
        tried += 1;
        if let Err(what) = attempt(target, &input, folder.path()) {
            let mut hash = DefaultHasher::new();
            input.hash(&mut hash);
            let kept = place().join(format!("{:x}-{}", hash.finish(), target.file));
            std::fs::write(&kept, &input).unwrap();
            wrong.entry(what).or_insert(kept);
        }
    }
    std::fs::remove_dir_all(folder.path()).unwrap();
    (tried, wrong)
}

#[test]
#[ignore = "long"]
fn hostile_files_are_read_or_refused() {
    std::panic::set_hook(Box::new(|panic| {
        let said = panic.payload_as_str().unwrap_or("").chars().take(300).collect::<String>();
        let place = panic.location().map(|place| place.to_string()).unwrap_or_default();
        if let Ok(mut last) = PANIC.lock() {
            *last = format!("panics at {place}: {said}");
        }
    }));
    catch_panics();
    let all = number("SINEW_FUZZ", EVERYDAY);
    let only = std::env::var("SINEW_FUZZ_ONLY").unwrap_or_default();
    let mut found = BTreeMap::new();
    for (place, target) in TARGETS.iter().enumerate().filter(|(_, target)| target.name.contains(&only)) {
        let (corpus, kept) = seeds::of(target.name);
        let mut rng = fastrand::Rng::with_seed((number("SINEW_FUZZ_SEED", 0) * TARGETS.len() + place) as u64);
        let mutants = (0..all * target.share / 100).map(|_| mutate::mutant(&mut rng, &corpus));
        let (tried, wrong) = try_all(target, kept.into_iter().chain(mutants));
        println!("{}: {tried} inputs from {} seeds, {} findings", target.name, corpus.len(), wrong.len());
        found.extend(wrong);
    }
    let _ = std::panic::take_hook();
    let list: Vec<String> = found.iter().map(|(what, file)| format!("{}: {what}", file.display())).collect();
    assert!(list.is_empty(), "{}", list.join("\n"));
}
