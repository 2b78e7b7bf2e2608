//! What touches for the first time: at rest it is held by the static coefficient, sliding by the kinetic one.

use crate::configurations::{Configuration, cpu_and_long_gpu, near};
use sinew::BackendChoice;

const TABLES: [(&str, &str); 2] = [
    ("a tool", "tools: {\"table\": (shape: Plane())}, contacts: [Tool(tool: \"table\", body: \"high\", FRICTION)],"),
    ("a body", "contacts: [Between(bodies: (\"low\", \"high\"), FRICTION)],"),
];

/// A plate of one flat element on a table, heavy from the beginning, with loads along it and an initial velocity (m/s).
/// Beside a tool the body below is far off.
fn plate(table: &str, law: &str, (along, speed): (f64, f64), solver: &str) -> String {
    let friction = format!("friction: 0.3, static_friction: 0.6{law}");
    let below = if table.contains("tools") { -0.1 } else { -0.03 };
    format!(
        "(duration: 0.3, {solver} bodies: {{
            \"low\": (mesh: Box(size: (0.3, 0.04, 0.03), cells: (1, 1, 1), elements: Hex8), material: \"m\", translate: (-0.01, -0.01, {below:?})),
            \"high\": (mesh: Box(size: (0.02, 0.02, 0.001), cells: (1, 1, 1), elements: Hex8), material: \"m\", velocity: ({speed:?}, 0, 0))}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e4, poisson: 0.45))}},
        constraints: [Fixed(body: \"low\", on: All)],
        loads: [Gravity(body: \"high\", acceleration: ({along:?}, 0, -10), curve: CURVE)], {}
        probes: {{\"foot\": (body: \"high\", what: Displacement, on: Set(\"z0\")), \"mean\": (body: \"high\", what: Velocity, on: All)}})",
        table.replace("FRICTION", &friction)
    )
}

/// On a slope between both angles of friction, at rest from the beginning: loads grow together, and it slides by less
/// than a bound (m).
fn stays(runs: Vec<Configuration>, law: &str, solver: &str, bound: f64) {
    for run in runs {
        for (of, table) in TABLES {
            let text = plate(table, law, (4.5, 0.0), solver).replace("CURVE", "Smooth(end: 0.1)");
            let mut simulation = run.start(&text);
            simulation.advance_to(0.3).unwrap();
            let moved = simulation.probe("foot").unwrap()[0];
            assert!(moved.abs() < bound, "{} on {of}: slid by {moved} m", run.name);
        }
    }
}

#[test]
fn a_block_at_rest_is_held_by_the_static_coefficient() {
    stays(cpu_and_long_gpu(), "", "", 1e-6);
}

/// The same in implicit steps, whose springs give way along the surface as across it.
#[test]
fn a_block_at_rest_is_held_in_implicit_steps() {
    let mut runs = cpu_and_long_gpu();
    runs.retain(|run| run.options.backend == BackendChoice::Cpu);
    stays(runs, ", law: Penalty(share: 10)", "solver: Implicit(step: 0.002, tolerance: 1e-6),", 1e-5);
}

/// It comes sliding: v = v₀ − μ g t.
#[test]
fn a_block_that_comes_sliding_is_slowed_by_the_kinetic_coefficient() {
    for run in cpu_and_long_gpu() {
        for (of, table) in TABLES {
            let text = plate(table, "", (0.0, 0.5), "").replace("CURVE", "Step()");
            let mut simulation = run.start(&text);
            simulation.advance_to(0.1).unwrap();
            let speed = simulation.probe("mean").unwrap()[0];
            near(&format!("{} on {of}: speed", run.name), speed, 0.2, 0.3, 0.03);
        }
    }
}
