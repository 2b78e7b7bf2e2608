//! What touches or is tied to rounding, where nothing else acts: forces are those of the last digits of places, and
//! less than these is not to be had.

use crate::bits::start;
use crate::configurations::near;
use sinew::Simulation;
use sinew::components::Precision;

const BOTH: [Precision; 2] = [Precision::F64, Precision::F32];

/// Two cubes, one on the other, that are so far out (m), and stay where they are.
fn joined(attachment: &str, search: &str, x: f64) -> String {
    format!(
        "(duration: 0.05, {search}
        bodies: {{
            \"low\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (4, 4, 4)), material: \"m\", translate: ({x:?}, 0, 0)),
            \"high\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (3, 3, 3)), material: \"m\",
                translate: ({x:?}, 0, 0.02))}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 5e3, poisson: 0.4), damping: 10)}},
        attachments: [{attachment}],
        constraints: [Fixed(body: \"low\", on: Set(\"z0\"))])"
    )
}

#[test]
fn what_is_tied_or_glued_and_has_no_load_is_at_rest() {
    for x in [0.0, 10.0] {
        let point = format!("({:?}, 0.01, 0.02)", x + 0.01);
        let tie = format!("Tie(from: (body: \"high\", at: {point}), to: (body: \"low\", at: {point}))");
        for attachment in [tie.as_str(), "Glue(bodies: (\"high\", \"low\"))"] {
            for search in ["analysis: Static(),", "analysis: Static(method: Newton),", "start: Equilibrium(),"] {
                for precision in BOTH {
                    let mut simulation = start(&joined(attachment, search, x), precision, 1);
                    let what = format!("{attachment}, {search} {precision:?}, {x} m");
                    // of a motion the start alone is sought
                    let found = if search.contains("start") { simulation.settle() } else { simulation.finish() };
                    found.unwrap_or_else(|error| panic!("{what}: {error}"));
                    for body in ["low", "high"] {
                        let u = simulation.displacements(body).unwrap();
                        // what is no number is not near
                        assert!(!u.is_empty() && u.iter().all(|u| u.length() < 1e-12), "{what}: {body} has moved");
                    }
                }
            }
        }
    }
}

/// A ball that touches the middle of a block, so deep at first, waits, and goes 2 mm down.
fn pressed(depth: f64, precision: Precision) -> Simulation {
    let text = format!(
        "(duration: 0.05, solver: Implicit(step: 0.005),
        bodies: {{\"b\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (4, 4, 4)), material: \"m\")}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 5e3, poisson: 0.4), damping: 10)}},
        constraints: [Fixed(on: Set(\"z0\"))],
        tools: {{\"ball\": (shape: Sphere(radius: 0.004), at: (0.01, 0.01, {:?}),
            moves: [(displacement: (0, 0, -0.002), curve: Smooth(start: 0.02, end: 0.05))])}},
        contacts: [Tool(tool: \"ball\", law: Penalty(share: 1), thin: true)])",
        0.024 - depth
    );
    let mut simulation = start(&text, precision, 1);
    simulation.advance_to(0.05).unwrap_or_else(|error| panic!("{depth} m, {precision:?}: {error}"));
    simulation
}

#[test]
fn an_implicit_step_that_begins_with_a_touch_to_rounding_ends() {
    for precision in BOTH {
        let wanted = pressed(0.0, precision).tool("ball").unwrap().force.z;
        assert!(wanted > 0.03, "{wanted} N");
        for depth in [1e-17, 1e-16, 1e-15, 1e-14, 1e-13, 1e-12] {
            let force = pressed(depth, precision).tool("ball").unwrap().force.z;
            near(&format!("{precision:?}, {depth} m deep at first: force"), force, wanted, wanted, 1e-2);
        }
    }
}
