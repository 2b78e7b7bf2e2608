//! Forces of contact that grow from nothing: there all of a step against a face is rounding of steps far larger.

use crate::configurations::configurations;

/// A block on another on a table under a weight that grows smoothly, which the guard of contact's energy looks at after
/// steps in which that is below 1e-50 J.
#[test]
fn contact_that_begins_with_nothing_gives_no_energy() {
    for run in configurations() {
        for (elements, points) in [("Wedge6", "Nodes"), ("Hex8", "Nodes"), ("Tet4", "Faces")] {
            let mut simulation = run.start(&format!(
                "(duration: 0.03, bodies: {{
                    \"a\": (mesh: Box(size: (0.03, 0.03, 0.006), cells: (6, 6, 2), elements: Hex8MeanDilatation), material: \"t\"),
                    \"b\": (mesh: Box(size: (0.02, 0.02, 0.006), cells: (5, 5, 2), elements: {elements}), material: \"t\",
                        translate: (0.0051, 0.0049, 0.006))}},
                materials: {{\"t\": (density: 1000, neo_hookean: Young(young: 3e4, poisson: 0.4), damping: 30)}},
                tools: {{\"table\": (shape: Plane())}},
                contacts: [Tool(tool: \"table\", body: \"a\", friction: 0.5),
                    Between(bodies: (\"a\", \"b\"), friction: 0.3, points: {points})],
                loads: [Gravity(acceleration: (0, 0, -9.81), curve: Smooth(end: 0.05))], guards: (every: 2))"
            ));
            let ended = simulation.finish();
            assert!(ended.is_ok(), "{}, {elements}, {points}: {ended:?}", run.name);
        }
    }
}
