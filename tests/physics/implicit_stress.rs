//! Stress and forces that are told after an implicit step are those at its end, viscous as they were found: not those
//! of memories that have been carried on already.

use crate::configurations::{configurations, near};
use glam::DVec3;
use sinew::Simulation;

const VISCOUS: [&str; 3] = [
    "prony: (terms: [(alpha: 0.5, tau: 0.02)], volumetric: [(alpha: 0.3, tau: 0.05)])",
    "prony: (terms: [(alpha: 0.5, tau: 0.02)], integrator: BackwardEuler)",
    "stiffness_damping: 0.02",
];

/// A cube of which all nodes are moved as told, longer by a fifth and narrower by a tenth in .1 s.
fn cube(scheme: &str, viscous: &str) -> String {
    format!(
        "(duration: 0.1, solver: Implicit(scheme: {scheme}, step: 0.01),
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e4, poisson: 0.3), {viscous})}},
        bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (2, 2, 2)), material: \"m\")}},
        constraints: [Prescribed(on: All, gradient: ((0.2, 0, 0), (0, -0.1, 0), (0, 0, 0)), curve: Ramp(end: 0.1))],
        probes: {{\"stress\": (what: Stress, on: All), \"reaction\": (what: Reaction, on: Set(\"x1\"))}})"
    )
}

/// Stress times area of the face that is pulled (N), with the sum of forces of elements there.
fn told(simulation: &mut Simulation) -> [f64; 2] {
    let area = 0.01 * (1.0 - simulation.time());
    let at_face = simulation.rest_positions("b").unwrap().iter().map(|at| at.x > 0.099).collect::<Vec<bool>>();
    let forces = simulation.internal_forces("b").unwrap();
    let sum: DVec3 = forces.iter().zip(at_face).filter(|(_, at_face)| *at_face).map(|(force, _)| *force).sum();
    [simulation.probe("stress").unwrap()[0] * area, sum.x]
}

#[test]
fn stress_after_an_implicit_step_is_that_of_its_reactions() {
    for run in configurations() {
        for (scheme, viscous) in ["Euler", "GeneralizedAlpha()"].into_iter().flat_map(|s| VISCOUS.map(|v| (s, v))) {
            let what = format!("{}, {scheme}, {viscous}", run.name);
            let text = cube(scheme, viscous);
            let mut simulation = run.start(&text);
            let bound = run.bound(1e-9, 3e-5);
            for _ in 0..5 {
                simulation.advance(1).unwrap();
                let reaction = simulation.probe("reaction").unwrap()[0];
                let of_elements = told(&mut simulation);
                near(&format!("{what}: stress"), of_elements[0], reaction, reaction, bound);
                near(&format!("{what}: forces"), of_elements[1], reaction, reaction, bound);
            }
            let kept = simulation.snapshot().unwrap();
            let before = told(&mut simulation);
            let mut resumed = run.start(&text);
            resumed.restore(&kept).unwrap();
            assert_eq!(told(&mut resumed), before, "{what}: resumed");
            // steps of another length change nothing of the one that was taken
            resumed.set_time_step(0.005).unwrap();
            near(&format!("{what}: another step"), told(&mut resumed)[0], before[0], before[0], bound);
        }
    }
}
