//! The words beside the scene: how much is said, where scenes come from, completions, manual pages, tips.

use crate::sinew::{Ended, SCENE, Workspace};
use std::io::Write;
use std::process::Stdio;

const SHORT: [&str; 4] = ["--backend", "cpu", "--set", "duration=0.05"];

#[test]
fn quiet_says_nothing_but_warnings_and_errors() {
    let place = Workspace::new();
    let ended = place.sinew(&[&["-q", "run", "block.ron"], &SHORT[..]].concat());
    assert_eq!((ended.status, &*ended.said, &*ended.complained), (Some(0), "", ""));
    assert!(place.path("out/block/summary.json").exists());
    let ended = place.sinew(&[&["run", "block.ron", "-q", "--set", "output.fields_every=5"], &SHORT[..]].concat());
    ended.wants(0, &["warning", "`fields_every` is longer than the scene"]);
    // what is warned of on the way stands in the report, which is not wanted
    let warns = [&["run", "block.ron", "--set", "guards=(hourglass: 1e-6)"], &SHORT[..]].concat();
    let (report, quiet) = (place.sinew(&warns), place.sinew(&[&["-q"], &warns[..]].concat()));
    assert!(report.said.contains("warnings    from t = "), "{}", report.said);
    assert!(quiet.said.is_empty() && quiet.complained.starts_with("warning: from t = "), "{}", quiet.complained);
    place.sinew(&["run", "-q", "block.ron", "--set", "duration=-1"]).wants(2, &["must be above 0"]);
    place.sinew(&["run", "-q", "-v", "block.ron"]).wants(2, &["cannot be used with"]);
    assert!(place.done(&["explain", "-q", "block.ron"]).contains("element_forces"), "what is asked for is said");
}

#[test]
fn verbose_says_what_is_done_beside_the_report() {
    let place = Workspace::new();
    let ended = place.sinew(&[&["run", "-v", "block.ron"], &SHORT[..]].concat());
    ended.wants(
        0,
        &["read and built in", "systems: element_forces", "elements that set it", "writes into out/block: fields"],
    );
    let usual = place.sinew(&[&["run", "block.ron"], &SHORT[..]].concat());
    assert!(usual.complained.is_empty(), "{}", usual.complained);
    let headings = |text: &str| text.lines().filter_map(|line| line.get(..10).map(str::to_string)).collect::<Vec<_>>();
    assert_eq!(headings(&ended.said), headings(&usual.said));
}

#[test]
fn the_summary_is_all_that_stands_on_the_standard_output() {
    let place = Workspace::new();
    let said = place.done(&[&["run", "--json", "block.ron", "-o", "there"], &SHORT[..]].concat());
    let told: serde_json::Value = serde_json::from_str(&said).unwrap();
    assert_eq!(told, place.json("there/summary.json"));
    let quiet = place.done(&[&["run", "-q", "--json", "block.ron"], &SHORT[..]].concat());
    assert!(serde_json::from_str::<serde_json::Value>(&quiet).is_ok());
    // of a run that breaks down, too
    let set = ["--set", "loads=[NodalForce(on: Set(\"z1\"), force: (0, 0, -1e3))]"];
    let ended = place.sinew(&[&["run", "--json", "block.ron"], &SHORT[..], &set[..]].concat());
    ended.wants(1, &["the simulation broke down"]);
    let told: serde_json::Value = serde_json::from_str(&ended.said).unwrap();
    assert!(told["failure"]["what"].is_string(), "{told}");
    // and nothing of a scene that was not run
    let ended = place.sinew(&["run", "--json", "block.ron", "--set", "duration=-1"]);
    assert_eq!((ended.status, &*ended.said), (Some(2), ""));
}

#[test]
fn scenes_come_from_the_standard_input() {
    let place = Workspace::new();
    let from = |text: &str, arguments: &[&str]| {
        let mut command = place.command(arguments);
        let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        child.stdin.take().unwrap().write_all(text.as_bytes()).unwrap();
        Ended::of(child.wait_with_output().unwrap())
    };
    let ended = from(SCENE, &[&["run", "-"], &SHORT[..]].concat());
    ended.wants(0, &[]);
    assert!(ended.said.contains("sinew render out/stdin"), "{}", ended.said);
    assert_eq!(place.table("out/stdin/nodes.csv").len(), 64);
    from(SCENE, &["check", "-"]).wants(0, &[]);
    from(&SCENE.replace("density", "densty"), &["run", "-"])
        .wants(2, &["standard input:5:", "did you mean `density`?"]);
    from("", &["run", "-"]).wants(2, &["standard input"]);
    place.done(&["render", "out/stdin", "--no-animation"]);
}

#[test]
fn shells_and_man_know_all_words() {
    let place = Workspace::new();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let said = place.done(&["completions", shell]);
        for word in ["accuracy", "resume", "precision", "quiet"] {
            assert!(said.contains(word), "{shell}: no {word}");
        }
    }
    place.sinew(&["completions", "tcsh"]).wants(2, &["possible values", "bash"]);
    place.done(&["man", "here/man1"]);
    let page = place.read("here/man1/sinew-run.1");
    assert!(page.starts_with(".ie") && page.contains("resume") && page.contains("Exit status"), "{page}");
    assert!(place.path("here/man1/sinew.1").exists() && place.path("here/man1/sinew-bench.1").exists());
    std::fs::write(place.path("file"), "").unwrap();
    place.sinew(&["man", "file/man1"]).wants(3, &["file/man1"]);
}

#[test]
fn tips_can_be_followed() {
    let place = Workspace::new();
    std::fs::rename(place.path("block.ron"), place.path("my block.ron")).unwrap();
    let unknown = place.sinew(&["run", "my block.ron", "--cells", "3"]);
    unknown.wants(2, &["unexpected argument '--cells'"]);
    assert!(!unknown.complained.contains("-- --cells"), "{}", unknown.complained);
    place.sinew(&["run", "my block.ron", "--presicion", "f64"]).wants(2, &["'--precision'"]);
    place.sinew(&["my block.ron"]).wants(2, &["sinew run 'my block.ron'"]);
    let said = place.done(&[&["run", "my block.ron"], &SHORT[..]].concat());
    assert!(said.contains("sinew render 'out/my block'"), "{said}");
    // a run that breaks down late enough leaves a state to go on from, and says how
    let set =
        ["--set", "loads=[Gravity(acceleration: (0, 0, -9000), curve: Step(start: 0.1))]", "--set", "guards.every=4"];
    let ended = place.sinew(&[&["run", "my block.ron", "--backend", "cpu"], &set[..]].concat());
    ended.wants(1, &["--resume 'out/my block/snapshot_"]);
    let file = ended.complained.split("--resume '").nth(1).unwrap().split('\'').next().unwrap().to_string();
    assert!(place.path(&file).exists(), "{file}");
    let more = place.sinew(&[&["run", "my block.ron", "--backend", "cpu", "--resume", &file], &set[..]].concat());
    more.wants(1, &["the simulation broke down"]);
}
