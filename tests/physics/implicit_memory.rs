//! What implicit steps hold, by counted bytes: with the columns of the scene less than twice what explicit steps of
//! tetrahedra have, the dense matrices of the coarse level apart.

use crate::configurations::scene_of;
use crate::implicit::options;
use sinew::Simulation;
use sinew::components::Precision;
use sinew::systems::Registry;
use std::path::Path;

/// Bytes of columns, and of all that the solver holds but coarse matrices; with what each is.
fn bytes(solver: &str, elements: &str) -> (u64, u64, Vec<(&'static str, u64)>) {
    let scene = format!(
        "(duration: 1, solver: {solver},
        bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (14, 14, 14), elements: {elements}), material: \"m\")}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))],
        loads: [Gravity(acceleration: (0, 0, -2), curve: Smooth(end: 0.2))])"
    );
    let mut simulation = Simulation::new(&scene_of(&scene, Path::new(".")), &options(Precision::F32, 2)).unwrap();
    // all that is made when it is needed first is there then
    simulation.advance(2).unwrap();
    let told = simulation.explain(&Registry::default()).unwrap();
    let held = told.solver.map(|solver| solver.held).unwrap_or_default();
    let apart = |(name, _): &&(&str, u64)| !name.starts_with("coarse matrices");
    (told.host_bytes, held.iter().filter(apart).map(|(_, bytes)| bytes).sum(), held)
}

/// What is held does not depend on the elements: of hexahedra, of which there is one a node and not five, explicit
/// steps hold so much less that it is three times theirs.
#[test]
fn implicit_steps_of_tetrahedra_hold_less_than_twice_the_bytes_of_explicit_ones() {
    let (explicit, nothing, _) = bytes("Explicit", "Tet4");
    let (columns, held, all) = bytes("Implicit()", "Tet4");
    println!("{explicit} explicit, {columns} and {held} implicit: {all:?}");
    assert_eq!(nothing, 0);
    assert!(held > 0 && all.len() > 3, "{all:?}");
    assert!(columns + held < 2 * explicit, "{columns} and {held}, of {explicit} explicit: {all:?}");
    for elements in ["Hex8", "Hex8MeanDilatation"] {
        assert_eq!(bytes("Implicit()", elements).1, held, "{elements}");
    }
}
