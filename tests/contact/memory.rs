//! How many bytes contact keeps for a face of the surfaces that meet.

use crate::bits::start;
use crate::configurations::ELEMENTS;
use sinew::components::Precision;
use sinew::systems::Registry;

/// Bytes that `surface_contact` keeps for each face of two blocks, after some steps: columns of contact between
/// surfaces, trees, lists and what is kept from step to step. Either they are far from each other, or a sixth of the
/// surface of each lies on the other.
fn bytes_a_face(elements: &str, cells: u32, contact: &str, far: bool) -> f64 {
    let block = |at: f64, cells: u32| {
        format!(
            "(mesh: Box(size: (0.02, 0.02, 0.02), cells: ({cells}, {cells}, {cells}), elements: {elements}), material: \"m\", translate: (0, 0, {at}))"
        )
    };
    let text = format!(
        "(duration: 1, bodies: {{\"low\": {}, \"high\": {}}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.3), damping: 20)}},
        constraints: [Fixed(body: \"low\", on: Set(\"z0\"))], loads: [Gravity(body: \"high\", acceleration: (0, 0, -9.81))],
        contacts: [Between(bodies: (\"low\", \"high\"), {contact})])",
        block(0.0, cells),
        block(if far { 0.06 } else { 0.02 }, cells - 1),
    );
    let mut simulation = start(&text, Precision::F32, 1);
    simulation.advance(40).unwrap();
    assert_eq!(simulation.contact("high").unwrap().points == 0, far);
    let explained = simulation.explain(&Registry::default()).unwrap();
    explained.contacts.iter().find(|found| found.system == "surface_contact").unwrap().bytes_a_face
}

/// 400 bytes a face with `Nodes` and 1000 with `Faces` are aimed at, where a sixth of the surface touches: some half of
/// that where nothing is near.
fn keeps_few(elements: &[&str], cells: &[u32]) {
    for (points, far, bound) in
        [("Nodes", true, 265.0), ("Faces", true, 525.0), ("Nodes", false, 400.0), ("Faces", false, 1000.0)]
    {
        for elements in elements {
            for &cells in cells {
                let found = bytes_a_face(elements, cells, &format!("points: {points}, friction: 0.3"), far);
                let what = format!("{elements}, {cells} cells, {points}, {}", if far { "far" } else { "near" });
                println!("{what}: {found:.0} bytes a face of {bound}");
                assert!(found > 0.4 * bound && found < bound, "{what}: {found:.0} bytes a face");
            }
        }
    }
}

#[test]
fn contact_keeps_few_bytes_a_face() {
    keeps_few(&["Tet4", "Hex8"], &[6]);
}

#[test]
#[ignore = "long"]
fn contact_keeps_few_bytes_a_face_of_any_element_and_mesh() {
    keeps_few(&ELEMENTS, &[8, 12]);
}
