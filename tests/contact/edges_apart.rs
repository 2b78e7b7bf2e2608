//! Lengths that contact goes by are those of the two bodies that meet, whatever else there is in a scene.

use crate::bits::bits;
use crate::configurations::configurations;
use sinew::{BackendChoice, Simulation};

/// A block of 12 mm that goes down (m/s) from a height (m) onto another, with edges of 6 mm, and if wanted a cube of .2
/// mm that never touches it: within the box around both, so that places are counted from the same point.
fn blocks(tiny: bool, (contact, solver): (&str, &str), [height, speed]: [f64; 2]) -> String {
    let [body, meets] = match tiny {
        true => [
            "\"tiny\": (mesh: Box(size: (2e-4, 2e-4, 2e-4), cells: (1, 1, 1)), material: \"soft\",
                translate: (0.0185, 0.0185, 0.016)),"
                .to_string(),
            format!(", Between(bodies: (\"low\", \"tiny\"){contact})"),
        ],
        false => [String::new(), String::new()],
    };
    format!(
        "(duration: 0.012, {solver} bodies: {{
            \"low\": (mesh: Box(size: (0.02, 0.02, 0.01), cells: (3, 3, 2), elements: Hex8MeanDilatation),
                material: \"tissue\"), {body}
            \"top\": (mesh: Box(size: (0.012, 0.012, 0.012), cells: (2, 2, 2), elements: Hex8MeanDilatation),
                material: \"tissue\", translate: (0.0043, 0.0037, {height}), velocity: (0, 0, -{speed}))}},
        materials: {{
            \"tissue\": (density: 1000, neo_hookean: Young(young: 2e4, poisson: 0.3), damping: 10),
            \"soft\": (density: 1000, neo_hookean: Young(young: 5, poisson: 0.3))}},
        constraints: [Fixed(body: \"low\", on: Plane(normal: (0, 0, 1), at: 0))],
        contacts: [Between(bodies: (\"low\", \"top\"){contact}){meets}])"
    )
}

/// How far the upper block has gone up in the mean (m).
fn risen(simulation: &mut Simulation) -> f64 {
    let u = simulation.displacements("top").unwrap();
    u.iter().map(|u| u.z).sum::<f64>() / u.len() as f64
}

/// Of two blocks that meet so fast that they sink in by millimetres, and of two that begin .5 mm in each other.
#[test]
fn a_small_cube_apart_changes_nothing_of_what_blocks_do() {
    let step = "integration: (step: 4e-4),";
    let (falls, begins_inside) = ([0.0101, 1.5], [0.0095, 0.0]);
    for run in configurations() {
        for (contact, from, up) in
            [("", falls, 1e-3), (", points: Faces, edges: true", falls, 1e-3), ("", begins_inside, 5e-4)]
        {
            let ends = [false, true].map(|tiny| {
                let mut simulation = run.start(&blocks(tiny, (contact, step), from));
                simulation.advance_to(0.012).unwrap();
                let risen = risen(&mut simulation);
                println!("{}{contact}, {from:?}: {:.4} mm", run.name, 1e3 * risen);
                assert!(risen > up, "{}{contact}: {risen} m, with the cube: {tiny}", run.name);
                bits(&mut simulation, &["low", "top"])
            });
            assert!(ends[0] == ends[1], "{}{contact}, {from:?}", run.name);
        }
    }
}

/// By implicit steps it comes back, too, where it went through the lower one.
#[test]
fn a_small_cube_apart_lets_no_block_through_in_implicit_steps() {
    let law = (", law: Penalty(share: 0.5)", "solver: Implicit(step: 4e-4),");
    for run in configurations().iter().filter(|run| run.options.backend == BackendChoice::Cpu) {
        for tiny in [false, true] {
            let mut simulation = run.start(&blocks(tiny, law, [0.0101, 1.5]));
            simulation.advance_to(0.012).unwrap();
            let risen = risen(&mut simulation);
            println!("{}: {:.4} mm", run.name, 1e3 * risen);
            assert!(risen > 1e-3, "{}: {risen} m, with the cube: {tiny}", run.name);
        }
    }
}
