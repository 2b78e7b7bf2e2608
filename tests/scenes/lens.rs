//! Both lenses: what is taken out is accounted for, and what is left gives way.

use super::{near, reference, run, scene};
use sinew::Simulation;
use sinew::mesh::Mesh;
use sinew::mesh::measure::tet_volume;

const SHORT: [&str; 4] = [
    "duration=0.1",
    "loads[0].curve=Smooth(end: 0.02)",
    "removal[0].when=During(start: 0.03, end: 0.08)",
    "output.energies_every=0.001",
];

#[test]
#[ignore = "long"]
fn the_mass_that_went_is_the_core_s_volume_times_its_density() {
    let mesh = Mesh::read(format!("{}/scenes/meshes/lens_814.msh", env!("CARGO_MANIFEST_DIR")), false).unwrap();
    let core = &mesh.element_sets["core"];
    let volume: f64 = core.iter().map(|&row| tet_volume(mesh.corners(row as usize).unwrap())).sum();
    let summary = run("lens_tets", &SHORT).summary("finished").unwrap();
    assert_eq!(summary.removed_elements, core.len());
    assert!(near(summary.removed_mass, 1000.0 * volume, 1e-9), "{} kg of {} kg", summary.removed_mass, 1000.0 * volume);
}

#[test]
#[ignore = "long"]
fn the_front_sinks_as_the_core_goes() {
    let mut simulation = Simulation::new(&scene("lens_tets", &SHORT), &reference()).unwrap();
    simulation.advance_to(0.03).unwrap();
    let full = simulation.probe("front").unwrap()[2];
    simulation.advance_to(0.1).unwrap();
    let hollow = simulation.probe("front").unwrap()[2];
    assert!(full < 0.0 && hollow < 1.5 * full, "{full} m with the core, {hollow} m without");
}

#[test]
#[ignore = "long"]
fn energies_of_the_lens_balance_to_two_percent() {
    let e = run("lens_tets", &SHORT).energies().unwrap();
    let (work, loss) = (e.load_work.unwrap() + e.constraint_work.unwrap(), e.damping_loss.unwrap());
    // what the forces inside have taken is stored, lost to viscosity, or went with the elements
    let done = e.kinetic + e.internal_work.unwrap() + loss;
    assert!(near(done, work, 0.02), "{done} J of {work} J: {e:?}");
}

#[test]
fn the_window_and_the_core_of_the_other_lens_have_the_volume_of_their_shapes() {
    let sets = [
        "duration=0.1",
        "loads[0].curve=Smooth(end: 0.02)",
        "removal[0].when=During(start: 0.02, end: 0.05)",
        "removal[1].when=During(start: 0.05, end: 0.08)",
    ];
    let summary = run("lens_hexes", &sets).summary("finished").unwrap();
    // a ball of 1.5 mm
    let core = 1000.0 * 4.0 / 3.0 * std::f64::consts::PI * 1.5e-3_f64.powi(3);
    // within it lies all of the core; the window adds up to a third of it
    assert!(
        summary.removed_mass > 0.9 * core && summary.removed_mass < 1.4 * core,
        "{} of {core} kg",
        summary.removed_mass
    );
    assert!(summary.removed_elements > 100, "{}", summary.removed_elements);
}

#[test]
fn an_emptied_lens_shows_the_walls_of_its_hollow() {
    let sets = ["duration=0.01", "removal[0].when=At(0.004)", "removal[1].when=At(0.006)"];
    let mut simulation = Simulation::new(&scene("lens_hexes", &sets), &reference()).unwrap();
    let area = |simulation: &mut Simulation| {
        let rest = simulation.rest_positions("lens").unwrap();
        let corner = |node: u32| rest[node as usize];
        let triangles = simulation.surface_triangles("lens").unwrap();
        let doubled = triangles.iter().map(|&[a, b, c]| (corner(b) - corner(a)).cross(corner(c) - corner(a)).length());
        doubled.sum::<f64>() / 2.0
    };
    let whole = area(&mut simulation);
    // two spherical caps of height h on a circle of radius a: 2π(a² + h²)
    let caps = 2.0 * std::f64::consts::PI * (4.5e-3_f64.powi(2) + 2e-3_f64.powi(2));
    assert!(near(whole, caps, 0.02), "{whole} m², not {caps} m²");
    simulation.finish().unwrap();
    assert!(area(&mut simulation) > 1.1 * whole);
}
