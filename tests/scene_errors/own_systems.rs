//! Systems of the scene's own that are none: each misuse at its own line, in the scene or in the system's file.

use sinew::systems::{Phase, Registry, System};
use sinew::{SceneFile, Simulation};

/// A system that is sound.
const GOOD: &str = "struct Wind {
    speed: f32,
    drag: f32,
}
@group(0) @binding(0) var<uniform> parameters: Wind;

fn wind(node: Node) -> vec3<f32> {
    let past = node.curve * vec3<f32>(parameters.speed, 0.0, 0.0) - node.velocity;
    return parameters.drag * length(past) * past;
}
";
const SYSTEM: &str = r#""wind": (file: "wind.wgsl", parameters: {"speed": 12, "drag": 0.3})"#;

fn told_of(text: &str, systems: &str, more: &str, registry: &Registry) -> String {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("wind.wgsl"), text).unwrap();
    let scene = format!(
        r#"(duration: 0.1, materials: {{"tissue": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.4))}},
bodies: {{"cube": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (2, 2, 2)), material: "tissue")}},
constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))], {more}
systems: {{{systems}}})"#
    );
    let diagnostics = match SceneFile::from_text("cube.ron", &scene, folder.path(), &[]) {
        Err(diagnostics) => diagnostics,
        Ok(scene) => Simulation::check(&scene, registry),
    };
    let lines = diagnostics.lines();
    let told = lines.iter().zip(diagnostics.list()).map(|(line, complaint)| {
        let label = std::iter::once(complaint.label.clone()).filter(|label| !label.is_empty());
        label.chain(complaint.notes.clone()).fold(line.to_string(), |text, part| format!("{text} | {part}"))
    });
    told.collect::<Vec<_>>().join("\n")
}

fn brief(text: &str, systems: &str) -> String {
    told_of(text, systems, "", &Registry::default())
}

#[test]
fn a_sound_system_is_not_complained_about() {
    assert_eq!(brief(GOOD, SYSTEM), "");
}

/// Cases: a piece of the good text, what replaces it, and all that is said of the result.
#[test]
fn what_is_not_written_as_a_system_is_told_at_its_line() {
    for (old, new, expected) in [
        (
            "fn wind(",
            "fn wnd(",
            "wind.wgsl:7:4: error: the system has no function `wind` | is `wnd` meant to be it? | it must be: fn wind(node: Node) -> vec3<f32>",
        ),
        (
            "fn wind(node: Node) -> vec3<f32> {",
            "fn wind(node: Node) -> f32 {\n    return 1.0;\n}\nfn other(node: Node) -> vec3<f32> {",
            "wind.wgsl:7:4: error: `wind` takes and gives something else: (Node) -> f32 | it must be: fn wind(node: Node) -> vec3<f32>",
        ),
        ("node.velocity;", "node.speed;", "wind.wgsl:8:74: error: invalid field accessor `speed` | invalid accessor"),
        (
            "parameters: Wind;",
            "parameters: Wind;\n@group(0) @binding(1) var<storage, read_write> external_force: array<f32>;",
            "wind.wgsl:6:48: error: `external_force` is a storage buffer: a system has none | a force depends on the node and the parameters alone",
        ),
        (
            "parameters: Wind;",
            "parameters: Wind;\n@compute @workgroup_size(64) fn main() {}",
            "wind.wgsl:6:33: error: `main` is an entry point: a system has none | the kernel of nodes calls the system's function; leave out @compute and @workgroup_size",
        ),
        (
            "parameters: Wind;",
            "parameters: Wind;\nvar<workgroup> gusts: f32;",
            "wind.wgsl:6:16: error: `gusts` is a variable outside of all functions: a system has none | a force depends on the node and the parameters alone",
        ),
        (
            "parameters: Wind;",
            "parameters: Wind;\nstruct Node { x: f32 }",
            "wind.wgsl:6:8: error: `Node` is a name of sinew's own (shaders/node_state.wgsl) | choose another name",
        ),
        (
            "    speed: f32,",
            "    speed: f32,\n    gust: f32,",
            "cube.ron:4:51: error: the system needs the parameter `gust` | the parameters of wind.wgsl: speed, gust, drag",
        ),
        (
            "length(past) * past",
            "tan(past.x) * past",
            "wind.wgsl:9:30: error: this function is not there for a text of one's own | allowed: abs, all, any, clamp, cos, cross, determinant, distance, dot, exp, exp2, fma, inverseSqrt, length, log, log2, max, min, mix, normalize, outer, pow, saturate, select, sign, sin, sqrt, step, tanh, transpose",
        ),
    ] {
        assert!(GOOD.contains(old), "the good text has no {old}");
        assert_eq!(brief(&GOOD.replacen(old, new, 1), SYSTEM), *expected, "with {new}");
    }
    let told = brief(&GOOD.replace("length(past) * past", "normalize(node.velocity)"), SYSTEM);
    assert!(told.contains("wind.wgsl:7:4: error: `wind` gives (NaN, NaN, NaN) N on node "), "{told}");
}

/// No element is blamed for the step that a load makes small.
#[test]
fn a_load_that_makes_the_step_small_is_told_of() {
    let told = brief(&GOOD.replace("length(past) * past", "-1e8 * node.displacement"), SYSTEM);
    assert!(told.starts_with("cube.ron:4:10: warning: forces on nodes make "), "{told}");
    assert!(!told.contains("element"), "{told}");
}

#[test]
fn what_the_scene_says_wrong_is_told_in_the_scene() {
    for (old, new, expected) in [
        (
            "\"wind.wgsl\"",
            "\"wnid.wgsl\"",
            "cube.ron:4:26: error: there is no file `wnid.wgsl` | paths are relative to the scene file",
        ),
        (
            "\"drag\"",
            "\"drug\"",
            "cube.ron:4:51: error: the system needs the parameter `drag` | the parameters of wind.wgsl: speed, drag\n\
             cube.ron:4:73: error: the system has no parameter `drug` | did you mean `drag`? | the parameters of wind.wgsl: speed, drag",
        ),
        (
            "file:",
            "body: \"cub\", file:",
            "cube.ron:4:26: error: there is no body `cub` | did you mean `cube`? | allowed: cube",
        ),
        (
            "\"wind\"",
            "\"a wind\"",
            "cube.ron:4:21: error: the system `a wind` needs another name: a function in its file is called so | letters, digits and _, with a letter first",
        ),
    ] {
        assert_eq!(brief(GOOD, &SYSTEM.replacen(old, new, 1)), *expected, "with {new}");
    }
    let told = brief(GOOD, &SYSTEM.replace("file:", "on: Sphere(center: (5, 0, 0), radius: 0.1), file:"));
    assert!(told.starts_with("cube.ron:4:24: error: no node is here"), "{told}");
}

#[test]
fn a_name_is_had_by_one_system_only() {
    let gravity = SYSTEM.replace("\"wind\"", "\"gravity\"");
    let told = brief(&GOOD.replace("fn wind", "fn gravity"), &gravity);
    assert!(told.contains("error: `gravity` is a system of sinew's own: adds mass times acceleration"), "{told}");
    let registry = Registry::default().with(System::custom("wind", Phase::Loads, "blows", || ()));
    let told = told_of(GOOD, SYSTEM, "", &registry);
    assert!(told.contains("error: `wind` is a system of the program's own: blows"), "{told}");
}

/// A schedule that is written out has the scene's systems like all others.
#[test]
fn a_schedule_names_the_systems_of_the_scene() {
    let with = |names: &str, more: &str| {
        let schedule = format!("schedule: [\"boundary\", \"element_forces\", \"gather\", {names} \"observe\"], {more}");
        told_of(GOOD, SYSTEM, &schedule, &Registry::default())
    };
    assert_eq!(with("\"wind\", \"integrate\",", ""), "");
    let told = with("\"integrate\",", "");
    assert!(told.contains("no scheduled system serves what `wind` is for: wind.wgsl, drag 0.3, speed 12"), "{told}");
    let told = with("\"wnd\", \"integrate\",", "");
    assert!(told.contains("there is no system named `wnd` | did you mean `wind`?"), "{told}");
    let told = with("\"integrate\", \"wind\",", "");
    assert!(told.contains("`wind` must stand before `integrate`"), "{told}");
    let told = with("\"wind\", \"integrate\",", "parameters: {\"wind\": (speed: 3)},");
    assert!(told.contains("`wind` is a system of the scene's own: it has no parameters here"), "{told}");
}

#[test]
fn a_curve_that_nobody_looks_at_is_warned_of() {
    let curved = SYSTEM.replace("file:", "curve: Ramp(end: 0.1), file:");
    assert_eq!(brief(GOOD, &curved), "");
    assert_eq!(
        brief(&GOOD.replace("node.curve * ", ""), &curved),
        "wind.wgsl:7:4: warning: `wind` does not read `node.curve`: the scene's `curve` changes nothing | multiply by `node.curve` what is to have this course in time"
    );
}
