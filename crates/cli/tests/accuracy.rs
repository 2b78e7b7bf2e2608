//! `sinew accuracy` on a scene so small that a study of it takes a second or two.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::fs;
use std::path::PathBuf;
use std::process::{Command, Stdio};

const SCENE: &str = r#"(
    title: "Small block",
    duration: 0.05,
    bodies: { "block": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (2, 2, 2), elements: Hex8), material: "tissue") },
    materials: { "tissue": (density: 1000, neo_hookean: Young(young: 3000, poisson: 0.45), damping: 5) },
    constraints: [Fixed(on: Set("z0"))],
    loads: [Gravity(acceleration: (0, 0, -9.81))],
    probes: { "top": (what: Displacement, on: Set("z1")) },
)"#;

struct Workspace(tempfile::TempDir);

impl Workspace {
    fn new() -> Self {
        let place = Workspace(tempfile::tempdir().unwrap());
        fs::write(place.path("block.ron"), SCENE).unwrap();
        place
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    /// Status, stdout, stderr of `sinew accuracy block.ron --backend cpu` with more arguments.
    fn study(&self, more: &[&str]) -> (i32, String, String) {
        let all = [&["accuracy", "block.ron", "--backend", "cpu"], more].concat();
        self.sinew(&all)
    }

    fn sinew(&self, arguments: &[&str]) -> (i32, String, String) {
        let mut command = Command::new(env!("CARGO_BIN_EXE_sinew"));
        let output = command.args(arguments).current_dir(self.0.path()).stdin(Stdio::null()).output().unwrap();
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        (output.status.code().unwrap(), text(output.stdout), text(output.stderr))
    }
}

#[test]
fn a_study_tells_its_plan_ranks_and_writes_everything() {
    let place = Workspace::new();
    let (status, said, aside) = place.study(&["--budget", "2min", "--finest", "2", "--effects"]);
    assert_eq!(status, 0, "{said}{aside}");
    for words in ["plan: ", "of at most 120 s", "as written", "for the reference"] {
        assert!(aside.contains(words), "{words:?} is not in\n{aside}");
    }
    for words in [
        "Small block",
        "answer",
        "as written: off by",
        "at most",
        "advice",
        "order",
        "effects",
        "gravity",
        "damping",
        "target",
        "as written",
    ] {
        assert!(said.contains(words), "{words:?} is not in\n{said}");
    }
    let json: serde_json::Value = serde_json::from_str(&place.read("out/block-accuracy/accuracy.json")).unwrap();
    let written = &json["rows"][0];
    assert_eq!(written["label"], "as written");
    assert!(written["errors"]["displacement"]["error"].as_f64().unwrap() > 0.0, "{written}");
    assert!(written["errors"]["reaction.Rz"]["error"].as_f64().is_some(), "reactions of constraints are quantities");
    let csv = place.read("out/block-accuracy/accuracy.csv");
    assert!(csv.lines().count() > 10 && csv.starts_with("configuration,part,varied"), "{csv}");
    for name in ["accuracy.md", "accuracy.svg", "accuracy.png", "effects.csv", "scene.ron", "sinew.json"] {
        assert!(fs::metadata(place.path("out/block-accuracy").join(name)).unwrap().len() > 50, "{name}");
    }
    // a second study takes the folder again
    let (status, ..) = place.study(&["--budget", "1e-9"]);
    assert_eq!(status, 0);
    assert!(!place.path("out/block-accuracy/effects.csv").exists(), "a table of another study is left");
}

#[test]
fn the_status_says_whether_the_target_is_met() {
    let place = Workspace::new();
    let exactly = |value: &str| format!("accuracy=(reference: Values({{\"top.uz\": {value}}}))");
    let study = |value: &str, target: &[&str]| {
        place.study(&[&["--budget", "60", "--finest", "1", "--set", &exactly(value)], target].concat())
    };
    // the block sags by some millimetres, whatever the mesh
    assert_eq!(study("-1", &["--target", "1%"]).0, 5);
    assert_eq!(study("-1", &["--target", "200%"]).0, 0);
    assert_eq!(study("-1", &["--target", "5 %"]).0, 5);
    assert_eq!(study("-1", &[]).0, 0, "nobody asked for a target");
    let (status, said, _) = place.study(&["--budget", "1e-9", "--target", "1%"]);
    assert_eq!(status, 6, "{said}");
    assert!(said.contains("left out: predicted"), "{said}");
}

#[test]
#[ignore = "long"]
fn a_softer_material_is_found_out_by_a_run_of_the_harder_one() {
    let place = Workspace::new();
    let rest = ["--set", "analysis=Static()"];
    let finer = ["--set", "bodies.block.mesh.cells=(8, 8, 8)", "--precision", "f64", rest[0], rest[1]];
    // on coarser meshes the error of the mesh hides part of the law's
    let meshed = ["--set", "bodies.block.mesh.cells=(4, 4, 4)"];
    let (status, ..) = place.sinew(&[&["run", "block.ron", "--backend", "cpu", "--out", "hard"], &finer[..]].concat());
    assert_eq!(status, 0);
    let softer = "materials.tissue.neo_hookean=Young(young: 2400, poisson: 0.45)";
    let more = [
        "--budget",
        "60",
        "--finest",
        "2",
        "--reference",
        "hard",
        "--by",
        "top.uz",
        "--set",
        softer,
        "--target",
        "1%",
        rest[0],
        rest[1],
    ];
    let (status, said, aside) = place.study(&[&more[..], &meshed[..]].concat());
    assert_eq!(status, 5, "{said}{aside}");
    assert!(said.contains("does not fall with the mesh"), "{said}");
    // nothing is simulated in time
    assert!(!said.contains("a second") && !said.contains("Δt"), "{said}");
}

#[test]
fn mistakes_end_with_2_before_anything_runs() {
    let place = Workspace::new();
    for (more, words) in [
        (&["--set", "duration=-1"][..], "`duration` must be above 0"),
        (&["--target", "none"], "such as 1% or 0.01"),
        (&["--budget", "0"], "a number above 0 is wanted"),
        (&["--budget", "0s"], "a time above 0 is wanted, such as 60s, 10min or 2h"),
        (&["--budget", "60 days"], "a time above 0 is wanted"),
        (&["--budget", "1e308h"], "a time above 0 is wanted"),
        (&["--target", "5"], "5 would be 500 %: for 5 % write 5% or 0.05, else 500%"),
        (&["--by", "top.uy.speed"], "no quantity `top.uy.speed`"),
        (&["--reference", "nowhere.csv"], "nowhere.csv"),
        (&["--set", "accuracy=(reference: Values({\"tap.uz\": 1}))"], "no quantity `tap.uz`"),
        (&["--set", "accuracy=(reference: Values({}))"], "nothing to measure errors against"),
    ] {
        let (status, said, aside) = place.study(more);
        assert_eq!(status, 2, "{more:?}: {said}{aside}");
        assert!(aside.contains(words), "{words:?} is not in\n{aside}");
    }
}

/// Steps become smaller where the rod stretches: what is seen is still seen at the scene's times, the last at its end.
#[test]
fn what_is_seen_is_of_the_scenes_times_where_steps_change() {
    let place = Workspace::new();
    let scene = SCENE
        .replace("duration: 0.05", "duration: 0.3")
        .replace("size: (0.1, 0.1, 0.1), cells: (2, 2, 2)", "size: (0.1, 0.02, 0.02), cells: (8, 2, 2)")
        .replace("young: 3000", "young: 20000")
        .replace("Set(\"z0\")", "Set(\"x0\")")
        .replace("Set(\"z1\")", "Set(\"x1\")");
    fs::write(place.path("rod.ron"), scene).unwrap();
    let (status, said, aside) = place.sinew(&["run", "rod.ron", "-q", "--backend", "cpu"]);
    assert_eq!(status, 0, "{said}{aside}");
    let summary: serde_json::Value = serde_json::from_str(&place.read("out/rod/summary.json")).unwrap();
    assert!(summary["step_history"]["changes"].as_u64().unwrap() > 0, "the step does not change: {summary}");
    let table = place.read("out/rod/probe_top.csv");
    let numbers: Vec<f64> = table.lines().last().unwrap().split(',').map(|text| text.parse().unwrap()).collect();
    assert_eq!(numbers[0], 0.3);
    let (status, said, aside) =
        place.sinew(&["accuracy", "rod.ron", "--backend", "cpu", "--finest", "1", "--budget", "20s", "--out", "study"]);
    assert_eq!(status, 0, "{said}{aside}");
    let study: serde_json::Value = serde_json::from_str(&place.read("study/accuracy.json")).unwrap();
    let estimates = study["estimates"].as_array().unwrap();
    let found = estimates.iter().find(|one| one["quantity"] == "top.uz").unwrap();
    let seen = found["value"][0].as_f64().unwrap();
    assert!((seen / numbers[3] - 1.0).abs() < 1e-3, "{seen} m in the study, {} m in the run", numbers[3]);
}
