//! Meshes of other people, in the folder that the variable `SINEW_MESHES` names: each is simulated, or refused for a
//! good reason. Without the variable nothing is looked at, and the test says so.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use sinew::components::Precision;
use sinew::scene::Allowed;
use sinew::{BackendChoice, Options, SceneFile, Simulation};
use std::path::{Path, PathBuf};

/// What a file is refused for, in words that its message holds; all others are simulated.
const REFUSED: [(&str, &str); 2] = [("6_tetra_bad.msh", "inverted"), ("liver.vtk", "surface mesh")];

fn meshes() -> Vec<PathBuf> {
    let Some(folder) = std::env::var_os("SINEW_MESHES") else {
        println!("left out: SINEW_MESHES names no folder of meshes to try");
        return Vec::new();
    };
    let files = std::fs::read_dir(&folder).unwrap_or_else(|wrong| panic!("SINEW_MESHES={folder:?}: {wrong}"));
    let mut files: Vec<PathBuf> = files.map(|file| file.unwrap().path()).collect();
    files.retain(|file| file.extension().is_some_and(|e| e == "msh" || e == "vtk" || e == "vtu"));
    files.sort();
    files
}

fn scene(mesh: &Path) -> SceneFile {
    let text = format!(
        "(duration: 1000,
          bodies: {{\"body\": (mesh: File(path: {:?}), material: \"tissue\")}},
          materials: {{\"tissue\": (density: 1000, neo_hookean: Young(young: 3000, poisson: 0.45), damping: 1)}},
          loads: [Gravity(acceleration: (0, 0, -9.81)), Pressure(on: Surface(), pressure: 1)])",
        mesh.to_str().unwrap()
    );
    let allowed = Allowed::files_anywhere();
    SceneFile::from_text_allowing("shared mesh", &text, Path::new(""), &[], allowed)
        .unwrap_or_else(|wrong| panic!("{wrong}"))
}

#[test]
fn every_shared_mesh_is_simulated_or_refused_for_a_good_reason() {
    for file in meshes() {
        let name = file.file_name().unwrap().to_str().unwrap().to_string();
        let options = Options { backend: BackendChoice::Cpu, precision: Precision::F64, ..Options::default() };
        let made = Simulation::new(&scene(&file), &options);
        if let Some((_, reason)) = REFUSED.iter().find(|(refused, _)| *refused == name) {
            let told = made.err().unwrap_or_else(|| panic!("{name} was taken")).to_string();
            assert!(told.contains(reason), "{name}: {told}");
            println!("{name}: refused\n{told}");
            continue;
        }
        let mut simulation = made.unwrap_or_else(|wrong| panic!("{name}: {wrong}"));
        simulation.advance(200).unwrap_or_else(|wrong| panic!("{name}: {wrong}"));
        // a free body under a closed pressure falls as a point would: its centre of mass, weighed by nodal masses
        let mass = simulation.summary("").unwrap().mass;
        let fall = center_of_mass_displacement(&mut simulation);
        let exact = -0.5 * 9.81 * falling_distance(&simulation);
        assert!((fall - exact).abs() < 1e-3 * exact.abs(), "{name}: fell {fall} m, a point {exact} m");
        println!("{name}: simulated, {mass:.3e} kg, Δt {:.3e} s", simulation.time_step());
    }
}

/// Mean vertical displacement (m), by mass.
fn center_of_mass_displacement(simulation: &mut Simulation) -> f64 {
    use sinew::components::{Displacement, Mass};
    let body = simulation.body("body").unwrap();
    let (mass, u) =
        (simulation.world().get::<Mass>(body).unwrap(), simulation.world().get::<Displacement>(body).unwrap());
    let total: f64 = (0..mass.len()).map(|row| mass.get(row)).sum();
    (0..mass.len()).map(|row| mass.get(row) * u.vector(row).z).sum::<f64>() / total
}

/// t² of a fall with damping rate c = 1/s: 2 (t − (1 − e^(−ct))/c)/c.
fn falling_distance(simulation: &Simulation) -> f64 {
    let t = simulation.time();
    2.0 * (t + (-t).exp_m1())
}
