//! What viscosity does to the pressure: its own relaxation, and the false pressure of past stress.

use crate::configurations::{Configuration, configurations, near};
use crate::element_turns::with_elements;
use sinew::Simulation;
use sinew::materials::{Elastic, Kinematics, NeoHookean, PronyTerm};
use sinew::math::Mat3;

const SHEAR: f64 = 3000.0 / 2.9;
const BULK: f64 = 1e4;

fn cube(run: &Configuration, elements: &str, material: &str, told: &str) -> Simulation {
    run.start(&format!(
        "(duration: 10, integration: (step: 0.005),
        bodies: {{\"b\": (mesh: Box(size: (1, 1, 1), cells: (1, 1, 1), elements: {elements}), material: \"m\")}},
        materials: {{\"m\": (density: 1000, {material})}},
        constraints: [Prescribed(on: All, {told})],
        probes: {{\"stress\": (what: Stress, on: All), \"right\": (what: Reaction, on: Plane(normal: (1, 0, 0), at: 1))}})"
    ))
}

/// Blown up to λ = 1.1 in all directions in the first step, p = p₀ (1 − Σα + Σ α φ e^(−nh)), n steps after that one, to
/// rounding: 1e-12 of p₀ in f64. In f32 an increment below half an ulp is lost, which with h = .1 and .0025 costs
/// 3e-8/h of the memory. Isochoric terms change nothing: there is no isochoric stress.
#[test]
#[ignore = "long"]
fn pressure_relaxes_as_its_terms_say() {
    let (step, terms) = (0.005, [(0.3, 0.05), (0.2, 2.0)]);
    let prony = "prony: (terms: [(alpha: 0.4, tau: 0.1)], volumetric: [(alpha: 0.3, tau: 0.05), (alpha: 0.2, tau: 2)])";
    let told = "gradient: ((0.1, 0, 0), (0, 0.1, 0), (0, 0, 0.1))";
    for (law, theta, area) in [("neo_hookean", 1.1_f64.powi(3) - 1.0, 1.21), ("linear", 0.3, 1.0)] {
        let material = format!("{law}: Young(young: 3e3, poisson: 0.45), {prony}");
        let expected = |n: i32| {
            let rest = |(alpha, tau): (f64, f64)| {
                let h: f64 = step / tau;
                alpha * (1.0 + (-h).exp_m1() / h * (-h * f64::from(n)).exp())
            };
            BULK * theta * (1.0 - terms.into_iter().map(rest).sum::<f64>())
        };
        for (run, elements) in with_elements(&configurations(), 0) {
            let mut simulation = cube(run, elements, &material, told);
            let bound = run.bound(1e-12, 1e-5);
            for steps in [2, 12, 100] {
                simulation.advance_to(f64::from(steps) * step).unwrap();
                let what = |name: &str| format!("{law}, {}, {elements}, {steps} steps: {name}", run.name);
                let stress = simulation.probe("stress").unwrap();
                for i in 0..3 {
                    near(&what("σ"), stress[i], expected(steps - 1), BULK * theta, bound);
                }
                let reaction = simulation.probe("right").unwrap()[0];
                near(&what("P"), reaction, area * expected(steps - 2), BULK * theta, bound);
            }
        }
    }
}

/// μ, λ = 1.5 held until all has relaxed, then 0.8: −289 Pa; at constant volume p = −α S₁:C₂/3.
#[test]
fn relaxed_stress_makes_the_false_pressure_that_is_stated() {
    let uniaxial = |stretch: f64| {
        let across = stretch.sqrt().recip();
        Mat3([[stretch - 1.0, 0.0, 0.0], [0.0, across - 1.0, 0.0], [0.0, 0.0, across - 1.0]])
    };
    let law = NeoHookean { shear: SHEAR, bulk: BULK };
    let [past, now] = [1.5, 0.8].map(|stretch| Kinematics::new(&uniaxial(stretch)));
    let term = PronyTerm::exact(0.5, 0.58, 1e-9);
    let mut memory = law.isochoric(&past).scaled(0.0);
    let relaxed_long_ago = PronyTerm::exact(0.5, 0.58, 1e3);
    memory = relaxed_long_ago.carried_on(&law.isochoric(&past), &memory);
    // what e^(−h) of the long step leaves is nothing, and its φ is put right
    memory = memory.scaled(term.aim / relaxed_long_ago.aim);
    let stress = law.isochoric(&now).plus(&term.relaxed(&law.isochoric(&now), &memory).scaled(-1.0));
    let pressure = |s: &sinew::math::Sym3<f64>| (s.trace() + 2.0 * s.contracted(&now.green_strain)) / 3.0;
    near("false pressure", -pressure(&stress), -289.5, 289.5, 1e-3);
    near("none", pressure(&now.without_pressure(&stress)), 0.0, SHEAR, 1e-13);
    // a stress that is no pressure stays as it is
    let kept = now.without_pressure(&law.isochoric(&now));
    for i in 0..6 {
        near("kept", kept.0[i], law.isochoric(&now).0[i], SHEAR, 1e-14);
    }
}

/// F = 1 + c G, c = −2.5 held for 40 τ, then within one step c = 1 at constant volume. n steps later
/// Υ = α (S₂ − φ e^(−nh) (S₂ − S₁)), so that p = −α φ e^(−nh) S₁:C₂/3, and none with `reproject`. Bounds: f64 1e-9 of
/// μ, for b of G is given to so many digits; f32 rounds J − 1 to 1e-7, times κ.
#[test]
fn reprojection_frees_relaxed_stress_of_its_false_pressure() {
    let (alpha, tau, step, b) = (0.5, 0.05, 0.005, 0.8_f64.sqrt().recip() - 1.0);
    let gradient = |c: f64| Mat3([[-0.2 * c, 0.0, 0.0], [0.0, b * c, 0.0], [0.0, 0.0, b * c]]);
    let law = NeoHookean { shear: SHEAR, bulk: BULK };
    let past = law.isochoric(&Kinematics::new(&gradient(-2.5)));
    let now = Kinematics::new(&gradient(1.0));
    let whole = (past.trace() + 2.0 * past.contracted(&now.green_strain)) / 3.0;
    let told = format!(
        "gradient: ((-0.2, 0, 0), (0, {b:?}, 0), (0, 0, {b:?})), curve: Table([(0, -2.5), (2.001, -2.5), (2.004, 1)])"
    );
    for reproject in [false, true] {
        let material = format!(
            "neo_hookean: Young(young: 3e3, poisson: 0.45),
            prony: (terms: [(alpha: {alpha}, tau: {tau})], reproject: {reproject})"
        );
        for (run, elements) in configurations().iter().flat_map(|run| ["Tet4", "Hex8MeanDilatation"].map(|e| (run, e)))
        {
            let mut simulation = cube(run, elements, &material, &told);
            for n in [0, 10] {
                simulation.advance_to(f64::from(401 + n) * step).unwrap();
                let h: f64 = step / tau;
                let phi = -(-h).exp_m1() / h;
                let false_pressure = -alpha * phi * (-h * f64::from(n)).exp() * whole;
                let expected = if reproject { 0.0 } else { false_pressure };
                let stress = simulation.probe("stress").unwrap();
                let what = format!("{}, {elements}, n = {n}, {reproject}", run.name);
                near(&what, stress[..3].iter().sum::<f64>() / 3.0, expected, SHEAR, run.bound(1e-9, 2e-5));
                // the kernel's force is that of the stress a step earlier
                let before = stress[0];
                simulation.advance(1).unwrap();
                let reaction = simulation.probe("right").unwrap()[0];
                near(&format!("{what}: P"), reaction, before / 0.8, SHEAR, run.bound(1e-9, 5e-5));
            }
        }
    }
}
