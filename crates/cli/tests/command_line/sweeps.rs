//! `sinew sweep`.

use crate::sinew::{SCENE, Workspace};
use std::collections::BTreeMap;
use std::fs;

/// Twelve variants, of which those with a load that no tissue bears break down.
const SWEEP: &str = r#"(
    scene: "block.ron",
    variants: Grid([
        ("materials.tissue.neo_hookean", ["Young(young: 3000, poisson: 0.45)", "Young(young: 9000, poisson: 0.3)"]),
        ("loads[0].acceleration", ["(0, 0, -9.81)", "(0, 0, -4e4)", "(1, 0, -3)"]),
        ("materials.tissue.damping", [5, 7.5]),
    ]),
    keep: ["top"],
    at: [0.05, 0.1],
)"#;

fn place() -> Workspace {
    let place = Workspace::with_scene(&SCENE.replace("duration: 0.2", "duration: 0.1"));
    fs::write(place.folder.path().join("sweep.ron"), SWEEP).unwrap();
    place
}

/// The header, and the lines by variant.
fn table(place: &Workspace, name: &str) -> (String, BTreeMap<u32, String>) {
    let text = place.read(name);
    let (header, lines) = text.split_once('\n').unwrap();
    let number = |line: &str| line.split(',').next().unwrap().parse().unwrap();
    (header.to_owned(), lines.lines().map(|line| (number(line), line.to_owned())).collect())
}

#[test]
fn parts_on_any_number_of_threads_are_the_whole_bit_for_bit_and_who_breaks_down_is_a_row() {
    let place = place();
    let told = place.done(&["sweep", "sweep.ron", "--threads", "2"]);
    assert!(told.contains("12 variants: 8 finished, 4 broke down"), "{told}");
    assert!(told.contains("out/sweep: rows.csv, manifest.jsonl"), "{told}");
    let (header, whole) = table(&place, "out/sweep/rows.csv");
    assert_eq!(
        header,
        "variant,materials.tissue.neo_hookean,loads[0].acceleration,materials.tissue.damping,ended,time (s),\
         top ux (m) at 0.05 s,top uy (m) at 0.05 s,top uz (m) at 0.05 s,top ux (m) at 0.1 s,top uy (m) at 0.1 s,\
         top uz (m) at 0.1 s"
    );
    assert_eq!(whole.len(), 12);
    let mut parts = BTreeMap::new();
    for part in ["1/5", "2/5", "3/5", "4/5", "5/5"] {
        place.done(&["sweep", "sweep.ron", "--part", part, "--threads", "1", "-o", "parts"]);
        let (its, rows) = table(&place, &format!("parts/rows_{}_of_5.csv", &part[..1]));
        assert_eq!(its, header);
        parts.extend(rows);
    }
    assert_eq!(parts, whole);
    // numbers are those of a run, and softer tissue sags more
    let sags = |number: u32| -> f64 { whole[&number].rsplit(',').next().unwrap().parse().unwrap() };
    place.done(&["run", "block.ron", "-o", "run", "--threads", "1"]);
    let run = place.table("run/probe_top.csv");
    assert_eq!(format!("{}", run.last().unwrap()[3]), format!("{}", sags(0)), "the first variant is the scene's");
    assert!(sags(0) < sags(6) && sags(6) < 0.0, "{} {}", sags(0), sags(6));
    let broken = whole.values().filter(|line| line.contains(",Unstable,"));
    assert!(broken.clone().all(|line| line.contains("-4e4")) && broken.count() == 4);
}

#[test]
fn what_is_done_is_not_done_again() {
    let place = place();
    place.done(&["sweep", "sweep.ron"]);
    let manifest = place.folder.path().join("out/sweep/manifest.jsonl");
    let (lines, rows) = (fs::read_to_string(&manifest).unwrap(), place.read("out/sweep/rows.csv"));
    assert_eq!(lines.lines().count(), 12);
    // two lines are lost, and one was cut off
    let kept: Vec<&str> = lines.lines().take(10).collect();
    fs::write(&manifest, format!("{}\n{}", kept[..9].join("\n"), &kept[9][..40])).unwrap();
    let told = place.done(&["sweep", "sweep.ron"]);
    assert!(told.contains("9 of them there already"), "{told}");
    assert_eq!(place.read("out/sweep/rows.csv"), rows, "the same rows");
    let told = place.done(&["sweep", "sweep.ron"]);
    assert!(told.contains("12 of them there already"), "{told}");
    // another scene, other numbers, other times: nothing is known of them
    let scene = place.read("block.ron").replace("density: 1000", "density: 1001");
    fs::write(place.folder.path().join("block.ron"), scene).unwrap();
    assert!(!place.done(&["sweep", "sweep.ron"]).contains("already"));
    assert!(!place.done(&["sweep", "sweep.ron", "--precision", "f64"]).contains("already"));
    fs::write(place.folder.path().join("sweep.ron"), SWEEP.replace("0.1]", "0.09]")).unwrap();
    assert!(!place.done(&["sweep", "sweep.ron", "--precision", "f64"]).contains("already"));
}

/// A sweep of the block, of one probe, `top`.
fn sweep_of(place: &Workspace, variants: &str, at: &str) -> String {
    let text = format!("(scene: \"block.ron\", variants: {variants}, keep: [\"top\"], at: [{at}])");
    fs::write(place.path("sweep.ron"), text).unwrap();
    place.done(&["sweep", "sweep.ron"])
}

/// Numbers of probes of a variant, all times one after the other.
fn numbers(line: &str) -> Vec<f64> {
    line.split(',').skip(4).map(|cell| cell.parse().unwrap()).collect()
}

#[test]
fn times_within_a_step_are_met_as_by_tables() {
    let scene = SCENE
        .replace("duration: 0.2", "duration: 0.1, solver: Implicit(step: 0.01)")
        .replace("every: 0.01) }", "every: 0.025), \"bar\": (what: ToolPose(tool: \"bar\"), every: 0.025) }")
        .replace(
            "    output:",
            "    tools: { \"bar\": (shape: Sphere(radius: 0.01), at: (0, 0, 1), \
             moves: [(rotation: (0, 0, 380), curve: Smooth(end: 0.06))]) },\n    output:",
        );
    let place = Workspace::with_scene(&scene);
    let times = [0.025, 0.03, 0.036, 0.038, 0.04, 0.05];
    let variants = "Grid([(\"materials.tissue.density\", [1000, 1100])])";
    let text = format!("(scene: \"block.ron\", variants: {variants}, keep: [\"top\", \"bar\"], at: {times:?})");
    fs::write(place.path("sweep.ron"), text).unwrap();
    place.done(&["sweep", "sweep.ron"]);
    let of_sweep = numbers(&table(&place, "out/sweep/rows.csv").1[&0]);
    let at: Vec<&[f64]> = of_sweep.chunks(9).collect();
    assert_eq!(at.len(), times.len());
    place.done(&["run", "block.ron", "-o", "run", "--threads", "1"]);
    let run = ["run/probe_top.csv", "run/probe_bar.csv"].map(|name| place.table(name));
    // the bar is beyond half a turn at the end of the step in which the first of them lies
    for (row, seen) in [(1, at[0]), (2, at[5])] {
        assert_eq!([&run[0][row][1..], &run[1][row][1..]].concat(), seen);
    }
    // two times in one step
    for (share, seen) in [(0.6, at[2]), (0.8, at[3])] {
        for ((first, last), seen) in at[1].iter().zip(at[4]).zip(seen).take(3) {
            assert!((first + share * (last - first) - seen).abs() < 1e-15, "{first} {seen} {last}");
        }
        assert!(seen[2] < at[1][2] && seen[2] > at[4][2]);
    }
}

#[test]
fn a_variant_that_ends_before_it_is_asked_is_a_row() {
    let place = Workspace::with_scene(&SCENE.replace("duration: 0.2", "duration: 0.1"));
    let told = sweep_of(&place, "Grid([(\"duration\", [0.1, 0.02])])", "0.01, 0.05");
    assert!(told.contains("1 finished, 1 with values that make no sense"), "{told}");
    assert!(told.contains("variant 1   at: 0.05 s is after the scene's end, 0.02 s"), "{told}");
}

#[test]
fn what_guards_warn_of_is_kept_and_told() {
    let place = Workspace::with_scene(&SCENE.replace("duration: 0.2", "duration: 0.1"));
    let variants = "Grid([(\"guards.energy.warn\", [0.01, 1e-12])])";
    for _again in 0..2 {
        let told = sweep_of(&place, variants, "");
        assert!(told.contains("2 variants: 2 finished") && told.contains("1 of them warned of"), "{told}");
        assert!(told.contains("variant 1   warning: from t = 0.1 s: ") && told.contains("came from nothing"), "{told}");
    }
    let lines = place.read("out/sweep/manifest.jsonl");
    let warnings = lines.lines().map(|line| {
        let line: serde_json::Value = serde_json::from_str(line).unwrap();
        (line["number"].as_u64().unwrap(), line["warnings"].as_array().unwrap().len())
    });
    assert_eq!(warnings.collect::<BTreeMap<_, _>>(), BTreeMap::from([(0, 0), (1, 1)]));
}

#[test]
fn a_law_in_another_file_text_makes_other_rows() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let [scene, law] = ["own_law.ron", "own_law.wgsl"].map(|name| fs::read_to_string(root.join(name)).unwrap());
    let place = Workspace::with_scene(&scene);
    let write = |text: &str| fs::write(place.path("own_law.wgsl"), text).unwrap();
    write(&law);
    let sweep = r#"(scene: "block.ron", variants: Grid([("materials.skin.density", [1100, 1200])]), keep: ["grip"],
        at: [0.01])"#;
    fs::write(place.path("sweep.ron"), sweep).unwrap();
    place.done(&["sweep", "sweep.ron"]);
    let rows = place.read("out/sweep/rows.csv");
    assert!(place.done(&["sweep", "sweep.ron"]).contains("2 of them there already"));
    let stiffer = law.replace("elastic.mu", "(1.5 * elastic.mu)");
    assert_ne!(stiffer, law);
    write(&stiffer);
    assert!(!place.done(&["sweep", "sweep.ron"]).contains("already"));
    assert_ne!(place.read("out/sweep/rows.csv"), rows);
    write(&law);
    assert!(!place.done(&["sweep", "sweep.ron"]).contains("already"));
    assert_eq!(place.read("out/sweep/rows.csv"), rows);
}

#[test]
fn mistakes_are_told_before_anything_runs() {
    let place = place();
    let path = place.folder.path().join("sweep.ron");
    let with = |from: &str, to: &str| {
        assert!(SWEEP.contains(from));
        fs::write(&path, SWEEP.replace(from, to)).unwrap();
        place.sinew(&["sweep", "sweep.ron"])
    };
    with("keep: [\"top\"]", "keep: [\"tip\"]").wants(2, &["no probe \"tip\"", "it has top"]);
    with("at: [0.05, 0.1]", "at: [0.05, 0.3]").wants(2, &["0.3 s is after the scene's end, 0.1 s"]);
    with("Grid([", "Grit([").wants(2, &["sweep.ron:3:", "Grid"]);
    with("scene: \"block.ron\"", "scene: \"brick.ron\"").wants(2, &["brick.ron"]);
    with("materials.tissue.damping", "materials.tissue.dampening").wants(2, &["no variant make sense", "dampening"]);
    place.sinew(&["sweep", "none.ron"]).wants(3, &["none.ron"]);
    place.sinew(&["sweep", "sweep.ron", "--part", "4/3"]).wants(2, &["such as 3/16"]);
    assert!(
        !place.folder.path().join("out/sweep/rows.csv").exists()
            || place.read("out/sweep/rows.csv").contains("SceneError")
    );
}

#[test]
fn the_example_is_what_the_page_shows() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let (page, example) =
        ["docs/sweeps.md", "examples/sweep.ron"].map(|path| fs::read_to_string(root.join(path)).unwrap()).into();
    assert!(page.contains(&example));
    let place = Workspace::new();
    let file = root.join("examples/sweep.ron");
    let told = place.done(&["sweep", file.to_str().unwrap(), "--part", "2/3", "-o", "part"]);
    assert!(told.contains("2 variants: 2 finished"), "{told}");
    assert!(place.read("part/rows_2_of_3.csv").contains("\n4,1100,\"(0, 0, -9.81)\",Finished,1"), "{told}");
}

#[test]
fn check_of_a_sweep_says_who_runs_it() {
    place().sinew(&["check", "sweep.ron"]).wants(2, &["unknown field `variants`", "run by `sinew sweep`"]);
}
