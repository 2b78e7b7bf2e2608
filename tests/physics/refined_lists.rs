//! Nodes by their numbers where elements are cut: what lies between them goes with them.

use crate::configurations::{ELEMENTS, configurations, scene_of};
use sinew::Simulation;
use std::path::Path;

fn beam(elements: &str, refine: u32, held: &str) -> String {
    format!(
        "(duration: 0.3, bodies: {{\"b\": (mesh: Box(size: (0.2, 0.1, 0.1), cells: (2, 2, 1), elements: {elements}), material: \"m\",
        refine: {refine})}}, materials: {{\"m\": (density: 1000, damping: 10, neo_hookean: Young(young: 3e3, poisson: 0.3))}},
        constraints: [Fixed(on: {held})], loads: [Gravity(acceleration: (0, 0, -2))],
        probes: {{\"tip\": (what: Displacement, on: Plane(normal: (1, 0, 0), at: 0.2)), \"held\": (what: Reaction, on: {held})}})"
    )
}

#[test]
fn nodes_named_by_number_hold_the_whole_face_between_them_however_often_it_is_cut() {
    let run = &configurations()[0];
    for elements in ELEMENTS {
        let coarse = run.start(&beam(elements, 0, "Set(\"x0\")")).rest_positions("b").unwrap();
        let numbers: Vec<usize> = (0..coarse.len()).filter(|&node| coarse[node].x < 1e-9).collect();
        for refine in [0, 1, 2] {
            let tip = |held: &str| {
                let mut simulation = run.start(&beam(elements, refine, held));
                simulation.finish().unwrap();
                (simulation.probe("tip").unwrap(), simulation.probe("held").unwrap())
            };
            // bit by bit
            assert_eq!(tip(&format!("Nodes({numbers:?})")), tip("Set(\"x0\")"), "{elements}, cut {refine} times");
        }
    }
}

/// How many nodes a selection has, from the force that each of them gets.
fn count(elements: &str, refine: u32, on: &str) -> f64 {
    let text = beam(elements, refine, "All")
        .replace("Gravity(acceleration: (0, 0, -2))", &format!("NodalForce(on: {on}, force: (1, 0, 0), share: Each)"));
    let mut simulation = Simulation::new(&scene_of(&text, Path::new(".")), &configurations()[0].options).unwrap();
    simulation.advance(1).unwrap();
    crate::columns::external_forces(&mut simulation, "b").iter().map(|force| force.x).sum()
}

#[test]
fn what_lies_between_named_nodes_is_named_and_nothing_else() {
    for elements in ["Hex8", "Hex8MeanDilatation"] {
        // 3 × 3 × 2 nodes, x fastest: an edge, two nodes without one, a face, a face and a node apart from it, an
        // element
        for (on, once, twice) in [
            ("Nodes([0, 1])", 3.0, 5.0),
            ("Nodes([0, 4])", 2.0, 2.0),
            ("Nodes([0, 1, 3, 4])", 9.0, 25.0),
            ("Nodes([0, 1, 3, 4, 17])", 10.0, 26.0),
            ("Nodes([7])", 1.0, 1.0),
            ("Or([Nodes([0, 1]), Nodes([1, 2])])", 5.0, 9.0),
            ("Or([Nodes([0]), Nodes([1])])", 2.0, 2.0),
        ] {
            assert_eq!((count(elements, 1, on), count(elements, 2, on)), (once, twice), "{elements}, {on}");
        }
    }
}

/// A set of a file has the same: of a face and a node apart from it the middle of the face, too.
#[test]
fn sets_of_nodes_keep_their_faces_beside_other_nodes() {
    let mut mesh =
        sinew::mesh::generators::box_mesh(glam::DVec3::ONE, (2, 2, 1), sinew::mesh::ElementKind::Hex8).unwrap();
    mesh.node_sets.insert("held".into(), vec![0, 1, 3, 4, 17]);
    mesh.refine(2).unwrap();
    assert_eq!(mesh.node_sets["held"].len(), 26);
}
