//! Several mistakes at once, and how they are shown.

use crate::good::{GOOD, brief, complaints, with};
use sinew::scene::{SceneFile, validate};
use std::path::Path;

#[test]
fn a_good_scene_raises_no_complaint() {
    assert_eq!(brief(GOOD, &[]), "");
}

#[test]
fn wrong_words_wrong_values_and_wrong_sets_are_told_in_one_go() {
    let text = GOOD
        .replace("density: 1060", "densty: 1060")
        .replace("Hex8", "Hex20")
        .replace("    duration: 0.5,\n", "")
        .replace("(0, 0, -9.81), curve", "(0, -9.81), curv")
        .replace("material: \"tissue\"", "material: \"tisue\", scale: 0");
    let shown = complaints(&text, &["output.fields_every=soon"]).render(false);
    assert_eq!(shown, crate::good::listed(EXPECTED), "{shown}");
}

const EXPECTED: &str = r#"error: the field `duration` is missing in the scene
  ┌─ cube.ron:1:1
  │
1 │ (
  │ ^ Scene needs `duration`
  │
  = duration: Simulated time (s); the time whose loads and motions a static analysis takes. A file without it may be a part of a scene: see `parts`.

error: `fields_every` must be a number
  ┌─ --set:1:21
  │
1 │ output.fields_every=soon
  │                     ^^^^ found a word

error: unknown field `densty`
  ┌─ cube.ron:4:20
  │
4 │         "tissue": (densty: 1060, neo_hookean: Young(young: 3e3, poisson: 0.45)),
  │                    ^^^^^^ not a field of Material
  │
  = did you mean `density`?
  = allowed: density, {laws}, fibres, exponential_fibres, prony, damping, stiffness_damping, inversion

error: `elements` cannot be `Hex20`
  ┌─ cube.ron:8:74
  │
8 │             mesh: Box(size: (0.1, 0.1, 0.1), cells: (4, 4, 4), elements: Hex20),
  │                                                                          ^^^^^ unknown word
  │
  = allowed: {elements}

error: there is no material `tisue`
  ┌─ cube.ron:9:23
  │
9 │             material: "tisue", scale: 0,
  │                       ^^^^^^^
  │
  = did you mean `tissue`?
  = allowed: tissue

error: `scale` must be above 0, found 0
  ┌─ cube.ron:9:39
  │
9 │             material: "tisue", scale: 0,
  │                                       ^

error: `acceleration` must have 3 values, found 2
   ┌─ cube.ron:16:31
   │
16 │         Gravity(acceleration: (0, -9.81), curv: Smooth(end: 0.1)),
   │                               ^^^^^^^^^^ 3 values belong here

error: unknown field `curv`
   ┌─ cube.ron:16:43
   │
16 │         Gravity(acceleration: (0, -9.81), curv: Smooth(end: 0.1)),
   │                                           ^^^^ not a field of Gravity
   │
   = did you mean `curve`?
   = allowed: body, acceleration, per_copy, curve

"#;

#[test]
fn what_others_find_is_placed_by_its_path() {
    let scene = SceneFile::from_text("cube.ron", GOOD, Path::new(""), &["duration=2".to_string()]).unwrap();
    let mut found = scene.diagnostics();
    found.error_at("loads[0].curve.end", "a value");
    found.error_at("integration.safety", "a default: what should hold it");
    found.error_at("constraints[0].on.tolerance", "a default deep inside");
    found.warn_at("bodies.cube", "something long: its beginning");
    found.error_at("duration", "from the command line").label("here").note("smaller");
    found.error("nowhere");
    let lines = [
        "error: nowhere",
        "cube.ron:1:1: error: a default: what should hold it",
        "--set:1:10: error: from the command line",
        "cube.ron:8:17: warning: something long: its beginning",
        "cube.ron:14:19: error: a default deep inside",
        "cube.ron:17:65: error: a value",
    ];
    assert_eq!(found.lines(), lines);
}

#[test]
fn colour_is_for_terminals_only() {
    let wrong = complaints(&with("0.45", "0.5"), &[]);
    assert!(wrong.render(true).contains("\u{1b}["));
    assert!(!wrong.render(false).contains('\u{1b}'));
    assert_eq!(wrong.to_string(), wrong.render(false));
}

#[test]
fn files_are_looked_for_beside_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cube.ron");
    for name in ["liver.msh", "kidney.vtu", "notes.txt"] {
        std::fs::write(folder.path().join(name), "").unwrap();
    }
    let mesh = "mesh: Box(size: (0.1, 0.1, 0.1), cells: (4, 4, 4), elements: Hex8)";
    let told = |file: &str| {
        std::fs::write(&path, with(mesh, &format!("mesh: File(path: \"{file}\")"))).unwrap();
        let scene = SceneFile::load(&path, &[]).unwrap();
        let mut found = scene.diagnostics();
        validate(&scene, &mut found);
        found.list().first().map(|first| format!("{} | {}", first.message, first.notes.join(" | "))).unwrap_or_default()
    };
    assert_eq!(told("liver.msh"), "");
    assert_eq!(
        told("livr.msh"),
        "there is no file `livr.msh` | did you mean `liver.msh`? | there are: kidney.vtu, liver.msh"
    );
}

#[test]
fn a_file_that_is_no_scene_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cube.ron");
    let missing = SceneFile::load(&path, &[]).unwrap_err().to_string();
    assert!(missing.starts_with("error: cannot read the scene ") && missing.contains("cube.ron: No such"), "{missing}");
    std::fs::write(&path, b"(title: \"\xff\")").unwrap();
    let binary = SceneFile::load(&path, &[]).unwrap_err().to_string();
    assert!(binary.contains("is not a text in UTF-8 (byte 9)"), "{binary}");
    std::fs::write(&path, "").unwrap();
    let empty = SceneFile::load(&path, &[]).unwrap_err().to_string();
    assert!(empty.starts_with("error: the file is empty"), "{empty}");
    // some editors put a byte order mark first
    std::fs::write(&path, format!("\u{feff}{GOOD}")).unwrap();
    assert!(SceneFile::load(&path, &[]).is_ok());
}
