//! Unloaded shapes of loaded ones: a known rest shape is loaded far, and found again from where it then stands.
//!
//! Cantilever 0.1 × 0.01 × 0.01 m under its own weight, E so that its tip sinks by 30 % of the length: a body bent so
//! far turns by some 23°, so that neither straightening it by −u(x̄) nor a linear analysis finds the rest shape. The
//! equilibrium is a smooth function of the rest shape, whose inverse is about the identity: rest nodes err by about
//! what loaded nodes do.

use crate::configurations::{Configuration, configurations, scene_of};
use glam::DVec3;
use sinew::mesh::{ElementKind, Mesh, generators};
use sinew::output::write_gmsh;
use sinew::{Error, SceneFile, Simulation, Unloading, UnloadingStep, unload};
use std::path::Path;

const LENGTH: f64 = 0.1;

fn scene(mesh: &str, further: &str) -> String {
    format!(
        "(duration: 0.05, {further}
        bodies: {{\"b\": (mesh: {mesh}, material: \"m\")}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 4.6e5, poisson: 0.45))}},
        constraints: [Fixed(on: Plane(normal: (1, 0, 0), at: 0))], loads: [Gravity(acceleration: (0, 0, -9.81))],
        probes: {{\"tip\": (what: Position, on: Set(\"x1\"))}})"
    )
}

fn rod() -> Mesh {
    generators::box_mesh(DVec3::new(LENGTH, 0.01, 0.01), (20, 2, 2), ElementKind::Hex8).unwrap()
}

fn f64_run() -> Configuration {
    configurations().into_iter().find(|run| run.name == "CPU f64").unwrap()
}

/// The rod where it stands under its weight, in a file of a folder; how far its tip has sunk (m).
fn scanned(folder: &Path) -> (SceneFile, f64) {
    let made = "Box(size: (0.1, 0.01, 0.01), cells: (20, 2, 2), elements: Hex8)";
    let mut loaded = f64_run().start(&scene(made, "analysis: Static(tolerance: 1e-8),"));
    loaded.finish().unwrap();
    let mut mesh = rod();
    let moved = loaded.displacements("b").unwrap();
    assert_eq!(moved.len(), mesh.points.len());
    mesh.points.iter_mut().zip(&moved).for_each(|(x, u)| *x += *u);
    write_gmsh(&folder.join("scan.msh"), &mesh).unwrap();
    let sunk = moved.iter().fold(0.0_f64, |least, u| least.min(u.z));
    (scene_of(&scene("File(path: \"scan.msh\")", "start: Equilibrium(tolerance: 1e-8),"), folder), -sunk)
}

fn found(file: &SceneFile, how: &Unloading) -> (Result<Vec<DVec3>, Error>, Vec<UnloadingStep>) {
    let mut steps = Vec::new();
    let unloaded = unload(file, &f64_run().options, how, |step| steps.push(*step));
    (unloaded.map(|unloaded| unloaded.rest["b"].clone()), steps)
}

#[test]
#[ignore = "long"]
fn rest_shape_of_a_rod_that_sinks_by_a_third_is_found_again() {
    let folder = tempfile::tempdir().unwrap();
    let (file, sunk) = scanned(folder.path());
    assert!((0.28..0.33).contains(&(sunk / LENGTH)), "the tip sinks by {} of the length", sunk / LENGTH);
    let how = Unloading { tolerance: 1e-5, ..Unloading::default() };
    let (rest, steps) = found(&file, &how);
    steps.iter().for_each(|step| println!("{step:?}"));
    let worst = rest.unwrap().iter().zip(&rod().points).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    println!("{} iterations, rest nodes within {:.1e} of the length", steps.len(), worst / LENGTH);
    assert!(worst <= 5e-5 * LENGTH, "rest nodes are {worst:e} m off");
    assert!(steps[0].largest > 0.1 * LENGTH, "loaded once more it would sink on: {:?}", steps[0]);
    assert!(steps.len() <= 12, "{} iterations", steps.len());
}

/// In every number type, on every backend: what begins there stands where the scan shows it.
#[test]
#[ignore = "long"]
fn motion_from_the_rest_shape_begins_and_stays_where_the_scan_is() {
    let folder = tempfile::tempdir().unwrap();
    let (file, _) = scanned(folder.path());
    let (rest, _) = found(&file, &Unloading::default());
    let mut mesh = rod();
    let scan = Mesh::read(folder.path().join("scan.msh"), false).unwrap();
    mesh.points = rest.unwrap();
    write_gmsh(&folder.path().join("unloaded.msh"), &mesh).unwrap();
    let text = scene("File(path: \"scan.msh\")", "start: Equilibrium(),")
        .replace("material: \"m\")", "material: \"m\", rest_shape: \"unloaded.msh\")");
    for run in configurations() {
        let mut simulation = run.start_in(&text, folder.path());
        let off = |simulation: &mut Simulation| {
            let (rest, moved) = (simulation.rest_positions("b").unwrap(), simulation.displacements("b").unwrap());
            let places = rest.iter().zip(&moved).map(|(x, u)| *x + *u);
            places.zip(&scan.points).map(|(x, at)| x.distance(*at)).fold(0.0, f64::max) / LENGTH
        };
        let start = off(&mut simulation);
        simulation.finish().unwrap();
        let end = off(&mut simulation);
        println!("{}: {start:.1e} and {end:.1e} of the length from the scan", run.name);
        assert!(start <= run.bound(1.5e-4, 5e-4) && end <= run.bound(3e-4, 1e-3), "{}: {start:e}, {end:e}", run.name);
    }
}

#[test]
#[ignore = "long"]
fn what_cannot_be_unloaded_is_refused_with_the_distance_reached() {
    let folder = tempfile::tempdir().unwrap();
    let (file, _) = scanned(folder.path());
    let (few, steps) = found(&file, &Unloading { tolerance: 1e-5, most: 2 });
    let Err(Error::NotUnloaded(few)) = few else { panic!("{few:?}") };
    assert!(few.iterations == 2 && steps.len() == 2 && few.largest == steps[1].largest.min(steps[0].largest), "{few}");
    assert!(few.to_string().contains("more iterations"), "{few}");
    // the scan of something much stiffer
    let mut soft = file.clone();
    let text = scene("File(path: \"scan.msh\")", "").replace("4.6e5", "2e3");
    soft.scene = scene_of(&text, folder.path()).scene;
    let (refused, _) = found(&soft, &Unloading { most: 12, ..Unloading::default() });
    let Err(Error::NotUnloaded(refused)) = refused else { panic!("{refused:?}") };
    println!("{refused}");
    assert!(refused.largest > refused.allowed);
}

#[test]
fn rest_shape_of_another_mesh_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    write_gmsh(&folder.path().join("scan.msh"), &rod()).unwrap();
    let other = generators::box_mesh(DVec3::ONE, (2, 2, 2), ElementKind::Hex8).unwrap();
    write_gmsh(&folder.path().join("other.msh"), &other).unwrap();
    let text = scene("File(path: \"scan.msh\")", "")
        .replace("material: \"m\")", "material: \"m\", rest_shape: \"other.msh\")");
    let file = scene_of(&text, folder.path());
    let error = Simulation::new(&file, &f64_run().options).err().unwrap().to_string();
    assert!(error.contains("the elements of other.msh are not those of the mesh"), "{error}");
}
