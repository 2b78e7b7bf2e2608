//! At rest, by damping: closed form 5.
//!
//! Cantilever .1 × .01 × .01 m under F = 1e-5 N at its tip: w = F L³/(3 E I) + F L/(k G A) = 1.344633e-3 m. One cube
//! through the thickness gives .996 of it (see `hourglass`), bound .5 % around that. Column in 1-D strain: u = ρ g
//! L²/(2 (λ + 2μ)) = 4.310455e-3 m at g = 9.81 m/s² if the law were linear; exact at the nodes of linear elements. At
//! g/1000 strains are 1e-4, and so is the error; at 9.81 m/s² the law's own P(λ) = ρ g (L − X) is solved and
//! integrated: elements take it at their middles, which errs by h²/24 ∂³u/∂X³ ~ (1/20)²/24·(.09)² ~ 1e-6 of u.
//! Tetrahedra weigh on nodes of one height differently (corners have 1 to 6 of them): within a cell's height h they sag
//! by up to ρ g h²/(2M) = (h/L)² u = 2.5e-3 u more or less, which cancels over a layer but for second order: 1e-4 of u.

use crate::configurations::{configurations, cpu_and_long_gpu, near};
use crate::element_turns::with_elements;

#[test]
fn cantilever_bends_by_what_timoshenko_says() {
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(
            "(duration: 9, bodies: {\"b\": (mesh: Box(size: (0.1, 0.01, 0.01), cells: (10, 1, 1), elements: Hex8), material: \"m\")},
            materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45), damping: 3.5)},
            constraints: [Fixed(on: Plane(normal: (1, 0, 0), at: 0))],
            loads: [NodalForce(on: Plane(normal: (1, 0, 0), at: 0.1), force: (0, 0, -1e-5), share: Total)],
            probes: {\"tip\": (what: Displacement, on: Plane(normal: (1, 0, 0), at: 0.1))})",
        );
        let steps = simulation.planned_steps();
        simulation.advance(steps).unwrap();
        let tip = simulation.probe("tip").unwrap()[2];
        // critical damping at 2ω = 3.5/s leaves (1 + ωt) e^(−ωt) = 2e-6
        near(&format!("{}: deflection", run.name), -tip / 1.344633e-3, 0.996, 1.0, 0.005);
    }
}

const M: f64 = 3000.0 * 0.55 / (1.45 * 0.1);

/// P(λ) = μ (2/3)(λ^(1/3) − λ^(−5/3)) + κ (λ − 1): stress per rest area of the law in 1-D strain.
pub fn first_stress(stretch: f64) -> f64 {
    2.0 / 3.0 * (3000.0 / 2.9) * (stretch.cbrt() - stretch.powf(-5.0 / 3.0)) + 1e4 * (stretch - 1.0)
}

/// What the law's own column of 20 elements sags by (m).
pub fn sag_under_weight(gravity: f64) -> f64 {
    let mut sag = 0.0;
    for cell in 0..20 {
        let load = 1000.0 * gravity * 0.1 * (1.0 - (cell as f64 + 0.5) / 20.0);
        let (mut low, mut high) = (0.5, 1.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if first_stress(middle) > -load { high = middle } else { low = middle }
        }
        sag += 0.1 / 20.0 * (1.0 - low);
    }
    sag
}

#[test]
#[ignore = "long"]
fn column_sags_by_its_weight() {
    for (run, elements) in with_elements(&configurations(), 1) {
        for gravity in [9.81e-3, 9.81] {
            let mut simulation = run.start(&format!(
                "(duration: 0.4, bodies: {{\"b\": (mesh: Box(size: (0.01, 0.01, 0.1), cells: (2, 2, 20), elements: {elements}), material: \"m\")}},
                materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45), damping: 106)}},
                constraints: [Fixed(on: All, axes: [X, Y]), Fixed(on: Plane(normal: (0, 0, 1), at: 0))],
                loads: [Gravity(acceleration: (0, 0, {:?}))],
                probes: {{\"tip\": (what: Displacement, on: Plane(normal: (0, 0, 1), at: 0.1))}})",
                -gravity
            ));
            let steps = simulation.planned_steps();
            simulation.advance(steps).unwrap();
            let tip = -simulation.probe("tip").unwrap()[2];
            let what = format!("{}, {elements}, g = {gravity}", run.name);
            // weight goes with lumped masses, of which the corners of the column have more than their share of
            // stiffness: 5.5e-3 with one cell across, 1.1e-3 with two
            let [small, large] = if elements == "Tet10" { [1.5e-3; 2] } else { [1e-4; 2] };
            if gravity < 1.0 {
                near(&what, tip, 4.310455e-6, 4.310455e-6, run.bound(small, small + 1e-4));
            } else {
                let expected = sag_under_weight(gravity);
                // damped by e^(−53·.4) = 6e-10
                near(&what, tip, expected, expected, if elements == "Hex8" { run.bound(1e-6, 1e-4) } else { large });
            }
        }
    }
    near("the linear figure", 1000.0 * 9.81 * 0.01 / (2.0 * M), 4.310455e-3, 4.310455e-3, 1e-6);
}
