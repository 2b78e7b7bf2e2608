//! What is sewn, tied and glued of bodies with a rest shape is so where their meshes have them, as scans do: a bar of
//! 5 cm that is held at one end and bends under its weight, and a block of 1 cm³ on it or above it. Rest shapes are
//! those that `unload` finds; with them bodies are at the start where their meshes are, to 1e-4 of 6 cm.

use crate::configurations::{Configuration, configurations, cpu_and_long_gpu, near, scene_of};
use glam::DVec3;
use sinew::{SceneFile, Simulation, Unloading, unload};
use std::path::Path;

/// The bar and a block at a height (m), with constraints, loads and attachments.
fn scene(young: &str, height: f64, constraints: &str, loads: &str, attachments: &str) -> SceneFile {
    let made =
        |size: &str, cells: &str| format!("mesh: Box(size: {size}, cells: {cells}, elements: Hex8MeanDilatation)");
    let text = format!(
        "(duration: 0.01, start: Equilibrium(), bodies: {{
            \"bar\": ({}, material: \"s\"), \"block\": ({}, material: \"t\", translate: (0.04, 0, {height}))}},
        materials: {{\"s\": (density: 1000, neo_hookean: Young(young: {young}, poisson: 0.3)),
            \"t\": (density: 1000, neo_hookean: Young(young: 2e4, poisson: 0.3))}},
        constraints: [Fixed(body: \"bar\", on: Set(\"x0\")), {constraints}], loads: [{loads}],
        attachments: [{attachments}])",
        made("(0.05, 0.01, 0.01)", "(10, 2, 2)"),
        made("(0.01, 0.01, 0.01)", "(2, 2, 2)"),
    );
    scene_of(&text, Path::new("."))
}

/// The scene with the rest shapes that its loads have made of them what its meshes show.
fn unloaded(file: &SceneFile) -> SceneFile {
    let found = unload(file, &configurations()[0].options, &Unloading::default(), |_| ());
    let mut file = file.clone();
    file.rest_shapes = found.unwrap_or_else(|error| panic!("{error}")).rest;
    file
}

/// At rest before the first step; how far a node of a body is from where its mesh has it at most (m).
fn settled(run: &Configuration, file: &SceneFile, bodies: [&str; 2]) -> (Simulation, f64) {
    let mut simulation = Simulation::new(file, &run.options).unwrap_or_else(|error| panic!("{}: {error}", run.name));
    simulation.settle().unwrap();
    let mut scanned = file.clone();
    scanned.rest_shapes.clear();
    let mut scanned = Simulation::new(&scanned, &configurations()[0].options).unwrap();
    let mut most = 0.0_f64;
    for body in bodies {
        let (rest, moved) = (simulation.rest_positions(body).unwrap(), simulation.displacements(body).unwrap());
        let mesh = scanned.rest_positions(body).unwrap();
        let places = rest.iter().zip(&moved).map(|(x, u)| *x + *u);
        most = places.zip(&mesh).map(|(x, at)| x.distance(*at)).fold(most, f64::max);
    }
    (simulation, most)
}

const WEIGHT: &str = "Gravity(body: \"bar\", acceleration: (0, 0, -9.81))";

/// A thread of 1 N/m from the bar to a fixed block 1 cm above bears k (l − l₀) of that centimetre. Its end was looked
/// up in the rest shape, which is raised by some mm, and so was below in the tissue: it was 12.6 and 16.5 mm long.
#[test]
fn a_suture_ends_where_the_scan_has_its_place() {
    let thread = |length: &str| {
        format!(
            "Suture(name: \"s\", from: (body: \"bar\", at: (0.045, 0.005, 0.01)),
                to: (body: \"block\", at: (0.045, 0.005, 0.02)), stiffness: 1, {length})"
        )
    };
    for (young, length) in [("2e5", "length: 0.005"), ("6e4", "tighten: 0.005")] {
        let file = unloaded(&scene(young, 0.02, "Fixed(body: \"block\", on: All)", WEIGHT, &thread(length)));
        for run in cpu_and_long_gpu() {
            let (mut simulation, off) = settled(&run, &file, ["bar", "block"]);
            let what = format!("{}, {young} Pa", run.name);
            near(&format!("{what}: nodes"), off, 0.0, 0.05, run.bound(3e-4, 1e-3));
            simulation.advance(1).unwrap();
            let reading = simulation.attachment("s").unwrap();
            near(&format!("{what}: length"), reading.length, 0.01, 0.01, 2e-3);
            near(&format!("{what}: force"), reading.force.length(), 5e-3, 5e-3, 5e-3);
        }
    }
}

/// A block that lies on the bar, tied at three points or glued: they bear its weight, and unloading finds a rest shape.
/// Places were looked up in rest shapes on the way, which were off the bar.
#[test]
fn ties_and_glue_hold_what_touches_in_the_scan() {
    let tie = |place: &str| format!("Tie(from: (body: \"block\", at: {place}), to: (body: \"bar\", at: {place})),");
    let ties: String = ["(0.045, 0.005, 0.01)", "(0.04, 0, 0.01)", "(0.04, 0.01, 0.01)"].map(tie).concat();
    for (attachments, count) in [(ties.as_str(), 3), ("Glue(bodies: (\"block\", \"bar\"))", 1)] {
        let file = unloaded(&scene("2e5", 0.01, "", "Gravity(acceleration: (0, 0, -9.81))", attachments));
        for run in cpu_and_long_gpu() {
            let (mut simulation, off) = settled(&run, &file, ["bar", "block"]);
            let what = format!("{}, {attachments}", run.name);
            near(&format!("{what}: nodes"), off, 0.0, 0.05, run.bound(3e-4, 1e-3));
            simulation.advance(1).unwrap();
            let forces = (0..count).map(|number: usize| simulation.attachment(&number.to_string()).unwrap().force);
            let force: DVec3 = forces.sum();
            near(&format!("{what}: weight"), force.z, 9.81e-3, 9.81e-3, 5e-3);
        }
    }
}

/// A motion that begins in the rest shape holds what is near there; one that begins where the mesh is and whose rest
/// shapes have it far apart is refused.
#[test]
fn what_rest_shapes_have_apart_is_told() {
    let tie = "Tie(from: (body: \"block\", at: (0.045, 0.005, 0.01)), to: (body: \"bar\", at: (0.045, 0.005, 0.01)))";
    let file = scene("2e5", 0.01, "", WEIGHT, tie);
    let options = &configurations()[0].options;
    let mut meshes = Simulation::new(&file, options).unwrap();
    let block = meshes.rest_positions("block").unwrap();
    let of = |by: f64, at_rest: bool| {
        let mut file = file.clone();
        file.rest_shapes.insert("block".into(), block.iter().map(|x| *x + DVec3::Z * by).collect());
        if !at_rest {
            file.scene.start = Default::default();
        }
        Simulation::new(&file, options)
    };
    let told = of(0.02, true).err().unwrap().to_string();
    assert!(told.contains("rest shapes have what is to be tied 2.000e-2 m apart"), "{told}");
    let told = of(0.02, false).err().unwrap().to_string();
    assert!(told.contains("what is to be tied is 2.000e-2 m apart") && told.contains("`rest_shape`"), "{told}");
    assert!(of(0.004, true).is_ok() && of(0.004, false).is_ok());
}
