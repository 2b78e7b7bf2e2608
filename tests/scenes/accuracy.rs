//! The scenes of the accuracy record (docs/accuracy.md): sound, written so that one word changes elements and mesh, and
//! the thick cylinder against the differential equation of its radius.

use super::{run, scene};
use sinew::Simulation;
use sinew::mesh::ElementKind;
use sinew::scene::schema::AccuracyReference;
use sinew::systems::Registry;

/// The scenes, their bodies, and a coarse mesh.
const SCENES: [(&str, &str, &str); 9] = [
    ("anisotropic_bar", "bar", "(10, 2, 2)"),
    ("cantilever", "bar", "(10, 2, 2)"),
    ("cook", "panel", "(4, 4, 2)"),
    ("gravity_bar", "bar", "(10, 2, 2)"),
    ("squeezed_cube", "cube", "(4, 4, 4)"),
    ("thick_cylinder", "tube", "(4, 8, 1)"),
    ("thick_cylinder_moved", "tube", "(4, 8, 1)"),
    ("twisted_column", "column", "(4, 4, 8)"),
    ("viscous_relaxation", "block", "(1, 1, 1)"),
];

#[test]
fn every_scene_of_the_record_is_sound_for_every_element_and_a_coarser_mesh() {
    let folder = format!("{}/scenes/accuracy", env!("CARGO_MANIFEST_DIR"));
    let found = std::fs::read_dir(folder).unwrap().count();
    assert_eq!(found, SCENES.len(), "a scene of the folder is not tested here");
    for (name, body, cells) in SCENES {
        for kind in ElementKind::ALL {
            let sets = [format!("bodies.{body}.mesh.elements={kind:?}"), format!("bodies.{body}.mesh.cells={cells}")];
            let scene = scene(&format!("accuracy/{name}"), &[&sets[0], &sets[1]]);
            let complaints = Simulation::check(&scene, &Registry::default());
            assert!(complaints.is_empty(), "{name} of {kind:?}: {}", complaints.render(false));
            let reference = &scene.scene.accuracy.reference;
            assert!(
                matches!(reference, AccuracyReference::Values(_)),
                "{name} has a reference of its own: {reference:?}"
            );
        }
    }
}

/// The wall of 8 × 16 cells moved from 10 to 14 mm: 376.688488584 Pa, from radial equilibrium in plane strain by
/// collocation (tests/cross_check/thick_cylinder.py). The force on the node at 45 degrees is that of a regular polygon,
/// pressure · radius · height · sin(angle of a cell).
#[test]
fn thick_cylinder_of_mean_dilatation_has_the_pressure_of_the_differential_equation() {
    let mut simulation = run("accuracy/thick_cylinder_moved", &["bodies.tube.mesh.cells=(8, 16, 1)"]);
    let cell = f64::to_radians(90.0 / 16.0);
    let pressure = simulation.probe("wall").unwrap()[0] / (0.014 * 0.005 * cell.sin() * f64::to_radians(45.0).cos());
    assert!((pressure / 376.688488584 - 1.0).abs() < 0.003, "{pressure} Pa");
    let outside = simulation.probe("outside").unwrap()[0];
    assert!((outside / 0.0023005937 - 1.0).abs() < 0.003, "{outside} m");
}
