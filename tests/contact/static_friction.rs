//! Friction between bodies: what sticks is held by the static coefficient, what slides by the kinetic one.

use crate::configurations::{cpu_and_long_gpu, near};

const G: f64 = 10.0;
const DAMPING: f64 = 40.0;
const SLIDING: f64 = 0.3;

/// How far (m) a rigid block slides until a time (s), once it is pulled by more than `held` times its weight: v̇ = g
/// (r(t) − μ) − c v.
fn slid(pull: impl Fn(f64) -> f64, held: f64, end: f64) -> f64 {
    let steps = 100_000;
    let (mut v, mut x, mut slides, step) = (0.0_f64, 0.0, false, end / f64::from(steps));
    for number in 0..steps {
        let ratio = pull(step * (f64::from(number) + 0.5));
        slides |= ratio > held;
        if slides {
            v = (v + step * (G * (ratio - SLIDING) - DAMPING * v)).max(0.0);
            x += v * step;
        }
    }
    x
}

/// A plate of one flat element on a slab of one that is held, so that the plate's four lower nodes alone are points: a
/// larger block begins to slide at its edges, and slides as a whole long before it is pulled by the larger coefficient.
/// It is pulled up to a share of its weight, and after .35 s less: what slides goes on by the kinetic coefficient where
/// what sticks would stay.
#[test]
fn a_block_on_a_block_sticks_up_to_the_static_coefficient_and_slides_by_the_kinetic_one() {
    let (side, height) = (0.02, 0.001);
    for run in cpu_and_long_gpu() {
        for (young, sticking, pull) in
            [(1e4, 0.6, 0.55), (1e4, 0.6, 0.65), (4e4, 0.45, 0.4), (4e4, 0.45, 0.5), (1e4, SLIDING, 0.55)]
        {
            let later = 0.5 * (SLIDING + sticking.min(pull));
            let mut simulation = run.start(&format!(
                "(duration: 0.5, bodies: {{
                    \"low\": (mesh: Box(size: (0.06, 0.04, 0.002), cells: (1, 1, 1), elements: Hex8), material: \"m\", translate: (-0.01, -0.01, -0.002)),
                    \"high\": (mesh: Box(size: ({side}, {side}, {height}), cells: (1, 1, 1), elements: Hex8), material: \"m\")}},
                materials: {{\"m\": (density: 1000, neo_hookean: Young(young: {young:?}, poisson: 0.45), damping: {DAMPING:?})}},
                constraints: [Fixed(body: \"low\", on: All)],
                loads: [Gravity(body: \"high\", acceleration: (0, 0, -{G:?}), curve: Smooth(end: 0.1)),
                    Gravity(body: \"high\", acceleration: ({G:?}, 0, 0),
                        curve: Table([(0, 0), (0.2, 0), (0.3, {pull:?}), (0.35, {pull:?}), (0.4, {later:?})]))],
                contacts: [Between(bodies: (\"low\", \"high\"), friction: {SLIDING:?}, static_friction: {sticking:?})],
                probes: {{\"foot\": (body: \"high\", what: Displacement, on: Set(\"z0\"))}})"
            ));
            let course = |time: f64| {
                if time < 0.3 {
                    pull * ((time - 0.2) / 0.1).max(0.0)
                } else {
                    pull + (later - pull) * ((time - 0.35) / 0.05).clamp(0.0, 1.0)
                }
            };
            let what = format!("{}, {young} Pa, {sticking} where it sticks, pulled at {pull}", run.name);
            simulation.advance_to(0.5).unwrap();
            let (moved, force) = (simulation.probe("foot").unwrap()[0], simulation.contact("high").unwrap().force);
            let weight = 1000.0 * side * side * height * G;
            near(&format!("{what}: weight"), force.z, weight, weight, 2e-3);
            near(&format!("{what}: aside"), force.y, 0.0, weight, 1e-4);
            if pull < sticking {
                near(&format!("{what}: held"), -force.x, later * weight, weight, 1e-4);
                assert!(moved.abs() < 1e-6, "{what}: {moved} m");
                continue;
            }
            // pulled above its foot it leans forward, its rear nodes bear r h/side less, and these go first
            let held = sticking / (1.0 + sticking * height / side);
            let expected = slid(course, held, 0.5);
            // and it rings as it lets go
            near(&format!("{what}: slides"), moved, expected, expected, 0.03);
            near(&format!("{what}: friction"), -force.x, SLIDING * force.z, weight, 1e-3);
        }
    }
}
