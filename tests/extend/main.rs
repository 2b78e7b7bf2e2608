//! What is added from outside the crate, by its public API alone: a law, a load and a contact plane, each by its Rust
//! file and its WGSL file, or by one of them. They run on both backends.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod anchors;
mod bond;
mod gent;
mod hanger;
mod herd;
mod in_tree;
mod laws;
mod memory;
mod plane;
mod refused;
#[path = "../source/mod.rs"]
mod source;
mod takes_part;
mod wind;

use sinew::components::Precision;
use sinew::gpu_or_reason;
use sinew::prelude::*;
use std::path::Path;

/// A cube of tissue with a law of its own, a hand's breadth above a floor, in the wind.
const SCENE: &str = r#"(
    duration: 0.6,
    bodies: {"cube": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (4, 4, 4)), material: "tissue")},
    materials: {"tissue": (
        density: 1000,
        law: (file: "law.wgsl", parameters: {"mu": 2000, "b": 0.5, "bulk": 2e4}),
        damping: 60,
    )},
    loads: [Gravity(acceleration: (0, 0, -9.81))],
    parameters: {
        "wind": (acceleration: (0.5, 0, 0), height: 0.1),
        "plane": (height: -0.005, stiffness: 4e6, damping: 200),
    },
)"#;

fn scene(sets: &[&str]) -> SceneFile {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/extend");
    let sets: Vec<String> = sets.iter().map(ToString::to_string).collect();
    SceneFile::from_text("extended.ron", SCENE, &folder, &sets)
        .unwrap_or_else(|wrong| panic!("{}", wrong.render(false)))
}

fn begun(backend: BackendChoice, sets: &[&str]) -> Simulation {
    let registry = Registry::default().with(wind::system()).with(plane::system());
    let options = Options { backend, ..Options::default() };
    Simulation::with_systems(&scene(sets), &options, &registry).unwrap()
}

/// Lowest point (m), and how far the middle has been blown (m).
fn lowest_and_blown(simulation: &mut Simulation) -> (f64, f64) {
    let moved = simulation.displacements("cube").unwrap();
    let rest = simulation.rest_positions("cube").unwrap();
    let lowest = rest.iter().zip(&moved).map(|(rest, moved)| (*rest + *moved).z).fold(f64::INFINITY, f64::min);
    let blown = moved.iter().map(|u| u.x).sum::<f64>() / moved.len() as f64;
    (lowest, blown)
}

#[test]
fn a_law_a_load_and_a_contact_plane_from_outside_run_on_both_backends() {
    let mut host = begun(BackendChoice::Cpu, &[]);
    host.finish().unwrap();
    let (lowest, blown) = lowest_and_blown(&mut host);
    // the nodes below, an eighth of the mass, bear the weight: by mass they sink by 8 g/4e6 1/s² on the average, and
    // swing no more by then; corners, which have least mass, sink deeper
    let sunk = (-0.005 - lowest) / (8.0 * 9.81 / 4e6);
    assert!((1.0..4.0).contains(&sunk), "lowest at {lowest}: {sunk} times as deep as the average");
    // a s/c (t − (1 − exp(−c t))/c) with the share s = z/(2 h) of the middle: 1.215 mm at z = 50 mm, 1.094 mm at 45 mm,
    // where it is from .05 s on; columns of nodes are not all of the same mass
    assert!((1.06e-3..1.14e-3).contains(&blown), "blown by {blown}");
    if gpu_or_reason().is_none() {
        return;
    }
    let mut device = begun(BackendChoice::Gpu, &[]);
    device.finish().unwrap();
    let of_device = lowest_and_blown(&mut device);
    // f32 on both; where it touches first is a matter of the last digit, which damping forgets
    assert!((of_device.0 - lowest).abs() < 1e-6 && (of_device.1 - blown).abs() < 1e-4 * blown, "{of_device:?}");
}

#[test]
fn they_share_a_pass_with_the_engines_own() {
    let told = begun(BackendChoice::Cpu, &[]).summary("begun").unwrap();
    let names: Vec<&str> = told.systems.iter().map(|system| system.name.as_str()).collect();
    assert!(
        names.iter().any(|name| ["gravity", "wind", "plane", "integrate"].iter().all(|s| name.contains(s))),
        "{names:?}"
    );
}

#[test]
fn the_stable_step_knows_how_stiff_the_plane_is() {
    let step =
        |stiffness: &str| begun(BackendChoice::Cpu, &[&format!("parameters.plane.stiffness={stiffness}")]).time_step();
    let (soft, stiff) = (step("1"), step("4e8"));
    // ω² of the whole is at least that of the plane, and at most the sum
    assert!(stiff < 2.0 / 4e8f64.sqrt() && stiff > 0.4 * 2.0 / 4e8f64.sqrt(), "{stiff}");
    assert!(soft > 3.0 * stiff, "{soft} without, {stiff} with it");
}

/// On a GPU nodes inside patches move with the forces on them, and small bodies take many steps in a dispatch, as
/// without a system from outside. Each brings buffers of its own, of which a kernel may bind 16.
#[test]
fn fast_paths_stay_on_with_them() {
    for (cells, small) in [(4, true), (12, false)] {
        let told = |systems: &str| {
            let cells = format!("bodies.cube.mesh.cells=({cells}, {cells}, {cells})");
            let parameters = format!("parameters={{{systems}}}");
            let registry = Registry::default().with(wind::system()).with(plane::system());
            let options = Options { backend: BackendChoice::Cpu, precision: Precision::F32, ..Options::default() };
            let mut simulation = Simulation::with_systems(&scene(&[&cells, &parameters]), &options, &registry).unwrap();
            let told = simulation.explain_on_gpu(&registry).unwrap();
            let [body] = &told.dispatched[..] else { panic!("{} bodies", told.dispatched.len()) };
            println!("{}; {}", body.because, body.interior_because);
            (body.many_steps, body.interior)
        };
        let (alone, with) = (told(""), told("\"wind\": (acceleration: (0.5, 0, 0), height: 0.1)"));
        assert_eq!(alone, with, "{cells} cells: many steps in a dispatch, nodes inside patches");
        assert!(alone.0 == small && (small || alone.1 > 0), "{alone:?}");
    }
}
