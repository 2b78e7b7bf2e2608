//! Budgets of implicit steps: no step takes many more passes, whatever it meets, and what is left is told of.

use crate::configurations::scene_of;
use crate::implicit::{cube, options};
use sinew::Simulation;
use sinew::components::Precision;
use std::path::Path;

#[test]
fn budgets_bound_passes_and_tell_what_is_left() {
    let (_, mut simulation) = cube(
        "solver: Implicit(step: 0.02, budget: 3, preconditioner: Identity),",
        "Tet4",
        "",
        0.2,
        &options(Precision::F32, 1),
    );
    let counts = simulation.implicit_steps().unwrap();
    println!("{counts:?}");
    assert!(counts.most_passes <= 5 && counts.largest_residual_left > 0.5, "{counts:?}");
    let summary = simulation.summary("finished").unwrap();
    assert!(summary.guards.warnings.iter().any(|notice| notice.criterion == "implicit_step"), "{:?}", summary.guards);
}

/// A cube that falls on stiff springs is searched for along its way by dozens of looks; with a budget there are no
/// more passes for that than for the rest. What is left is told of, and the cube stays whole.
#[test]
fn budgets_bound_the_search_along_a_way_too() {
    let passes = |budget: &str| {
        let scene = format!(
            "(duration: 0.1, solver: Implicit(step: 5e-3, scheme: GeneralizedAlpha(), {budget}),
            bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (3, 3, 3), elements: Tet4), material: \"m\",
                velocity: (0, 0, -2), translate: (0, 0, 0.02))}},
            materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e4, poisson: 0.45), damping: 5)}},
            tools: {{\"table\": (shape: Plane())}}, contacts: [Tool(tool: \"table\", law: Penalty(share: 100))])"
        );
        let scene = scene_of(&scene, Path::new("."));
        let mut simulation = Simulation::new(&scene, &options(Precision::F64, 1)).unwrap();
        simulation.finish().unwrap();
        let counts = simulation.implicit_steps().unwrap();
        println!("{budget}: {counts:?}");
        let u = simulation.displacements("b").unwrap();
        assert!(counts.halvings > 0 && u.iter().all(|u| u.length() < 0.3), "{u:?}");
        counts.most_passes
    };
    let (free, bounded) = (passes(""), passes("budget: 12"));
    assert!(free > 30, "{free}");
    assert!(bounded <= 14, "{bounded}");
}
