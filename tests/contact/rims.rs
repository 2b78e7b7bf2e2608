//! What is in front of a face near a rim is not behind the wall that falls off there.

use crate::configurations::cpu_and_long_gpu;

/// A block that slides over another with all of its lower face on it: nodes of the lower block that are well behind the
/// upper one's walls are before its lower face, whose bent rim lies a little in front of theirs.
#[test]
fn a_sliding_block_is_no_deeper_in_than_it_sinks() {
    for run in cpu_and_long_gpu() {
        for points in ["Nodes", "Faces"] {
            let mut simulation = run.start(&format!(
                "(duration: 0.05, bodies: {{
                    \"low\": (mesh: Box(size: (0.04, 0.02, 0.01), cells: (8, 4, 2)), material: \"m\"),
                    \"top\": (mesh: Box(size: (0.012, 0.012, 0.01), cells: (3, 3, 2)), material: \"m\",
                        translate: (0.0041, 0.0037, 0.01), velocity: (0.2, 0, 0))}},
                materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e4, poisson: 0.45))}},
                constraints: [Fixed(body: \"low\", on: Plane(normal: (0, 0, 1), at: 0))],
                loads: [Gravity(acceleration: (0, 0, -9.81))],
                contacts: [Between(bodies: (\"low\", \"top\"), friction: 0.2, points: {points})])"
            ));
            simulation.advance_to(0.05).unwrap();
            let found = simulation.summary("").unwrap().surface_contact.unwrap();
            if let Some(deepest) = found.deepest {
                println!("{}, {points}: {deepest:.3e} m", run.name);
                // a hundredth of an edge
                assert!(deepest > 0.0 && deepest < 4e-5, "{}, {points}: {deepest} m", run.name);
            } else {
                assert!(run.name.contains("GPU"), "{}", run.name);
            }
        }
    }
}
