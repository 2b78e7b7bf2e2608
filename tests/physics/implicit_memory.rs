//! What implicit steps hold, by counted bytes: with the columns of the scene less than twice what explicit steps of the
//! same elements have, the dense matrices of the coarse level apart.

use crate::configurations::scene_of;
use crate::implicit::options;
use sinew::Simulation;
use sinew::components::Precision;
use sinew::systems::Registry;
use std::path::Path;

/// What holds a cube: its foot, and its top that is moved as told.
#[derive(Clone, Copy, Debug)]
enum Held {
    Nowhere,
    AtItsFoot,
    AndMoved,
}

/// Bytes of columns, and of all that the solver holds but coarse matrices; with what each is. A cube of so many cells
/// along each axis.
fn bytes(solver: &str, elements: &str, cells: u32, held: Held) -> (u64, u64, Vec<(&'static str, u64)>) {
    let fixed = match held {
        Held::Nowhere => "",
        Held::AtItsFoot => "Fixed(on: Plane(normal: (0, 0, 1), at: 0))",
        Held::AndMoved => {
            "Fixed(on: Plane(normal: (0, 0, 1), at: 0)), Prescribed(on: Plane(normal: (0, 0, 1), at: 0.1),
                displacement: (0.01, 0, 0), curve: Smooth(end: 0.2))"
        }
    };
    let scene = format!(
        "(duration: 1, solver: {solver},
        bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: ({cells}, {cells}, {cells}), elements: {elements}), material: \"m\")}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}},
        constraints: [{fixed}],
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

/// What is held does not depend on the elements but by how many nodes aggregates have. Explicit steps of hexahedra with
/// one point hold least, as there is one a node and not five: 210 bytes a node, against 452 of linear tetrahedra. Those
/// of generalised-α hold accelerations as well, and those that move nodes as told a list of their axes.
#[test]
fn implicit_steps_hold_less_than_twice_the_bytes_of_explicit_ones() {
    let linear = ["Tet4", "Hex8", "Hex8MeanDilatation", "Wedge6"].map(|elements| (elements, 14, Held::AtItsFoot));
    let all = linear.into_iter().chain([
        ("Tet10", 7, Held::AtItsFoot),
        ("Hex8", 14, Held::Nowhere),
        ("Hex8", 14, Held::AndMoved),
    ]);
    for ((elements, cells, held), scheme) in
        all.flat_map(|of| ["Euler", "GeneralizedAlpha()"].map(|scheme| (of, scheme)))
    {
        let (explicit, nothing, _) = bytes("Explicit", elements, cells, held);
        let (columns, own, all) = bytes(&format!("Implicit(scheme: {scheme})"), elements, cells, held);
        let nodes = (if elements == "Tet10" { 2 * cells + 1 } else { cells + 1 }).pow(3);
        let each = |bytes: u64| bytes as f64 / f64::from(nodes);
        println!(
            "{elements}, {held:?}: {:.1} bytes a node explicit, {:.1} and {:.1} by {scheme}, {:.3} times: {all:?}",
            each(explicit),
            each(columns),
            each(own),
            (columns + own) as f64 / explicit as f64
        );
        assert_eq!(nothing, 0);
        assert!(own > 0 && all.len() > 3, "{all:?}");
        assert!(columns + own < 2 * explicit, "{columns} and {own}, of {explicit} explicit: {all:?}");
    }
}
