//! What is in front of a face near a rim is not behind the wall that falls off there.

use crate::attachments::{mass, momentum};
use crate::configurations::{Configuration, cpu_and_long_gpu, near};

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

/// A block of 10 mm that slides over a finer slab, 18 mm far: what it keeps of 300 mm/s.
fn keeps(run: &Configuration, fixed: &str, elements: &str, (contact, solver): (&str, &str)) -> f64 {
    let mut simulation = run.start(&format!(
        "(duration: 0.06, {solver} bodies: {{
            \"slab\": (mesh: Box(size: (0.06, 0.02, 0.01), cells: (24, 8, 2), elements: {elements}), material: \"m\"),
            \"block\": (mesh: Box(size: (0.01, 0.01, 0.01), cells: (2, 2, 2), elements: {elements}), material: \"m\",
                translate: (0.007, 0.005, 0.01), velocity: (0.3, 0, 0))}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e5, poisson: 0.3), stiffness_damping: 1e-4)}},
        constraints: [Fixed(body: \"slab\", on: {fixed})],
        loads: [Gravity(acceleration: (0, 0, -9.81), body: \"block\")],
        contacts: [Between(bodies: (\"slab\", \"block\"), {contact})])"
    ));
    simulation.advance_to(0.06).unwrap();
    momentum(&mut simulation, &["block"]).x / (0.3 * mass(&mut simulation, &["block"]))
}

/// Without friction all of it, with friction all but μ g t; by every law, over a slab that does not deform and one that
/// does. What sinks in by micrometres is before the block's front wall, as high as that above its rim.
#[test]
fn what_slides_is_braked_by_friction_alone() {
    let [step, spring] = ["solver: Implicit(step: 1e-3),", "law: Penalty(share: 0.5)"];
    let laws =
        [("", ""), ("points: Faces", ""), ("sweeps: 16", ""), (spring, ""), (spring, step), ("friction: 0.3", "")];
    let implicit = format!("friction: 0.3, {spring}");
    let slabs = [("All", "Hex8MeanDilatation"), ("Plane(normal: (0, 0, 1), at: 0)", "Tet4")];
    for run in cpu_and_long_gpu() {
        // a software device takes its time
        let gpu = run.name.contains("GPU");
        for law in laws.into_iter().chain([(&*implicit, step)]).filter(|law| !gpu || law.1.is_empty()) {
            let expected = if law.0.contains("friction") { 1.0 - 0.3 * 9.81 * 0.06 / 0.3 } else { 1.0 };
            for (fixed, elements) in slabs.into_iter().take(if gpu { 1 } else { 2 }) {
                let kept = keeps(&run, fixed, elements, law);
                near(&format!("{}: {law:?}, {fixed}", run.name), kept, expected, 1.0, 2e-3);
            }
        }
    }
}
