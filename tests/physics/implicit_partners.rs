//! Implicit steps with a hand that grabs, with loads and motions that a program sets, and with elements of second
//! order, wedges and hexahedra with one point.

use crate::configurations::{Configuration, configurations, near, scene_of};
use crate::grids::bits;
use crate::implicit::options;
use glam::DVec3;
use sinew::components::Precision;
use sinew::{BackendChoice, GrabId, Grip, Options, Simulation};
use std::path::Path;

fn start(scene: &str, options: &Options) -> Simulation {
    let options = Options { grabs: true, ..options.clone() };
    Simulation::new(&scene_of(scene, Path::new(".")), &options).unwrap_or_else(|error| panic!("{error}\n{scene}"))
}

/// A cube of 1 kg that a hand takes hold of in the middle of its top, as stiff as 30 times its weight a metre.
fn held(solver: &str, options: &Options) -> (Simulation, GrabId) {
    let mut simulation = start(
        &format!(
            "(duration: 10, {solver}
            bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (2, 2, 2), elements: Hex8), material: \"m\")}},
            materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e4, poisson: 0.3), damping: 10)}},
            loads: [Gravity(acceleration: (0, 0, -1))])"
        ),
        options,
    );
    let pick = simulation.pick(DVec3::new(0.05, 0.05, 1.0), -DVec3::Z).unwrap().unwrap();
    let grip = Grip { stiffness: Some(30.0), damping: Some(1.0), ..Grip::default() };
    let hand = simulation.grab(&pick, &grip).unwrap();
    (simulation, hand)
}

/// Where the middle of the top is (m), and what the hand pulls with (N), as it goes up and aside: by and by, or all at
/// once before it begins.
fn pulled(solver: &str, at_once: bool, options: &Options) -> Vec<(DVec3, DVec3)> {
    let (mut simulation, hand) = held(solver, options);
    let rest = simulation.rest_positions("b").unwrap().to_vec();
    let top = (0..rest.len()).find(|&i| rest[i].distance(DVec3::new(0.05, 0.05, 0.1)) < 1e-6).unwrap();
    let mut way = Vec::new();
    for place in 1..=5 {
        let share = if at_once { 1.0 } else { f64::from(place) / 5.0 };
        simulation.move_grab(hand, DVec3::new(0.05 + 0.01 * share, 0.05, 0.1 + 0.02 * share)).unwrap();
        simulation.advance_to(0.048 * f64::from(place)).unwrap();
        let force = simulation.grab_force(hand).unwrap();
        way.push((rest[top] + simulation.displacements("b").unwrap()[top], force));
    }
    way
}

/// Of two ways the largest distance (m), and of the forces (N).
fn apart(one: &[(DVec3, DVec3)], other: &[(DVec3, DVec3)]) -> [f64; 2] {
    let largest = |of: fn(&(DVec3, DVec3)) -> DVec3| {
        one.iter().zip(other).map(|(a, b)| of(a).distance(of(b))).fold(0.0, f64::max)
    };
    [largest(|at| at.0), largest(|at| at.1)]
}

/// Beside explicit steps that are far shorter, what is off falls to a quarter with half the step. (The hand's damper
/// has the velocity of half an explicit step before, so that these are off in proportion to their length: what two
/// lengths lead to is taken.) f32 and a GPU take the
/// steps of f64 as the hand goes on, to 60 times the tolerance (see `implicit_device.rs`) of its way.
#[test]
fn a_hand_pulls_as_beside_explicit_steps() {
    let f64s = options(Precision::F64, 1);
    let solver = |step: f64, tolerance: f64| {
        format!("solver: Implicit(scheme: GeneralizedAlpha(), step: {step}, tolerance: {tolerance}),")
    };
    let [longer, shorter] = ["1e-4", "5e-5"].map(|step| pulled(&format!("integration: (step: {step}),"), true, &f64s));
    let exact: Vec<_> = longer.iter().zip(&shorter).map(|(a, b)| (2.0 * b.0 - a.0, 2.0 * b.1 - a.1)).collect();
    let [off, half] = [0.002, 0.001].map(|step| apart(&pulled(&solver(step, 1e-9), true, &f64s), &exact));
    println!("off by {off:?} m and N, then {half:?}; {exact:?}");
    for (off, half) in off.into_iter().zip(half) {
        near("an order", (off / half).log2(), 2.0, 1.0, 0.2);
    }
    let way = 0.01_f64.hypot(0.02);
    assert!(half[0] < 1e-3 * way && half[1] < 1e-3 * 30.0 * way, "{half:?}");
    let exact = pulled(&solver(0.008, 1e-9), false, &f64s);
    for run in configurations() {
        let [off, of_force] = apart(&pulled(&solver(0.008, 1e-5), false, &run.options), &exact);
        println!("{}: {off:e} m, {of_force:e} N", run.name);
        assert!(off < 60e-5 * way && of_force < 60e-5 * 30.0 * way, "{}: {off:e}, {of_force:e}", run.name);
    }
}

/// To some tens of the tolerance, as what presses on a step's residual is the weight itself.
#[test]
fn a_hand_holds_the_weight() {
    for run in configurations() {
        let (mut simulation, hand) = held("solver: Implicit(step: 0.05, tolerance: 1e-5),", &run.options);
        simulation.advance_to(3.0).unwrap();
        let weight: f64 = simulation.masses("b").unwrap().iter().sum();
        let force = simulation.grab_force(hand).unwrap();
        near("the hand pulls", force.z, weight, weight, 3e-4);
        assert!(force.truncate().length() < 3e-4 * weight, "{}: beside: {force}", run.name);
        let pick = simulation.pick(DVec3::new(0.05, 0.05, 1.0), -DVec3::Z).unwrap().unwrap();
        near("it hangs", 0.1 - pick.point.z, weight / 30.0, weight / 30.0, 1e-3);
        simulation.release(hand).unwrap();
        simulation.advance_to(3.1).unwrap();
    }
}

/// A cube that stands on a plate, under pressures and forces and a plate that follow curves.
fn driven(scheme: &str, push: &str, motion: &str) -> String {
    format!(
        "(duration: 0.5, solver: Implicit(scheme: {scheme}, step: 0.0078125, tolerance: 1e-5),
        bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (3, 3, 3), elements: Tet4), material: \"m\")}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45), damping: 20)}},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0)), Prescribed(on: Plane(normal: (0, 0, 1), at: 0.1),
            axes: [Z], displacement: (0, 0, -0.002), curve: {motion})],
        loads: [Pressure(on: Surface(normal: (1, 0, 0)), pressure: 200, curve: {push}),
            NodalForce(on: Plane(normal: (1, 0, 0), at: 0), force: (0.001, 0, 0), curve: {push})])"
    )
}

/// Loads of a step are those at its end, so that a curve that jumps within the step after which a program sets an input
/// has the same; motions go as fast as they may, from step to step.
#[test]
fn an_input_gives_the_bits_of_a_curve_of_the_same_values() {
    let push = "Table([(0, 1), (0.034, 1), (0.035, 0)])";
    let tool = "Table([(0, 0), (0.03125, 0.5), (0.046875, 0.25)])";
    let inputs = ["Input(name: \"push\", initial: 0.25)", "Input(name: \"tool\", initial: 0, rate: 16)"];
    for run in configurations() {
        for scheme in ["Euler", "GeneralizedAlpha()"] {
            let mut told = start(&driven(scheme, push, tool), &run.options);
            let mut set = start(&driven(scheme, inputs[0], inputs[1]), &run.options);
            set.set_input("tool", 1.0).unwrap();
            set.set_input("push", 1.0).unwrap();
            set.advance(4).unwrap();
            told.advance(4).unwrap();
            let pushed = bits(&mut told, "b");
            assert!(bits(&mut set, "b") == pushed, "{}, {scheme}: other bits", run.name);
            set.set_input("tool", 0.25).unwrap();
            set.set_input("push", 0.0).unwrap();
            set.advance(8).unwrap();
            told.advance(8).unwrap();
            assert!(bits(&mut set, "b") == bits(&mut told, "b"), "{}, {scheme}: other bits", run.name);
            assert!(bits(&mut told, "b") != pushed);
            let rest = set.rest_positions("b").unwrap().to_vec();
            let top = rest.iter().position(|x| x.z > 0.0999).unwrap();
            near("the plate is", set.displacements("b").unwrap()[top].z, -0.0005, 0.0005, 1e-6);
        }
    }
}

/// A bar that sags, of elements that are not the usual ones.
fn bar(elements: &str, solver: &str) -> String {
    let cells = if elements == "Tet10" { "(4, 1, 1)" } else { "(8, 2, 2)" };
    format!(
        "(duration: 6, {solver}
        bodies: {{\"b\": (mesh: Box(size: (0.1, 0.025, 0.025), cells: {cells}, elements: {elements}), material: \"m\")}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e4, poisson: 0.45), damping: 10)}},
        constraints: [Fixed(on: Plane(normal: (1, 0, 0), at: 0))],
        loads: [Gravity(acceleration: (0, 0.3, -1))], output: (energies_every: 6))"
    )
}

fn at_end(scene: &str, run: &Configuration) -> (Vec<DVec3>, [f64; 2]) {
    let mut simulation = run.start(scene);
    simulation.finish().unwrap();
    let energies = simulation.energies().unwrap();
    (simulation.displacements("b").unwrap(), [energies.strain, energies.hourglass])
}

/// Where Newton's iterations for rest in f64 have them, to residuals of 1e-10. Steps leave 1e-6 of all forces, in f32
/// what rounding makes of them: 3 τ of the displacement (see `implicit_device.rs`).
#[test]
#[ignore = "long"]
fn elements_of_second_order_wedges_and_one_point_hexahedra_come_to_rest_where_statics_has_them() {
    let all = configurations();
    for elements in ["Tet10", "Wedge6", "Hex8"] {
        let (exact, energies) = at_end(&bar(elements, "analysis: Static(method: Newton),"), &all[0]);
        let far = exact.iter().map(|u| u.length()).fold(0.0, f64::max);
        println!("{elements}: {far:e} m, {energies:?} J");
        assert_eq!(energies[1] > 1e-3 * energies[0], elements != "Wedge6", "{energies:?}");
        for run in &all {
            let solver = "solver: Implicit(step: 0.2, tolerance: 1e-6),";
            let (u, _) = at_end(&bar(elements, solver), run);
            let apart = u.iter().zip(&exact).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max) / far;
            println!("{elements}, {}: {apart:e}", run.name);
            let bound = match run.options.backend {
                BackendChoice::Gpu => 6e-5,
                _ => run.bound(3e-6, 6e-5),
            };
            assert!(apart < bound, "{elements}, {}: {apart:e}", run.name);
        }
    }
}
