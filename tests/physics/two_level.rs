//! The preconditioner of two levels: how many iterations it leaves, and that turning bodies and taking elements out
//! keeps it what it is.

use crate::configurations::{near, scene_of};
use crate::implicit::options;
use glam::{DMat3, DVec3};
use sinew::Simulation;
use sinew::components::{Authoring, Displacement, Precision};
use sinew::systems::Registry;
use std::path::Path;

fn start(scene: &str, folder: &str, solver: &str) -> Simulation {
    let scene = scene.replace("SOLVER", &format!("solver: Implicit(newton: 1, {solver}),"));
    Simulation::new(&scene_of(&scene, Path::new(folder)), &options(Precision::F64, 1)).unwrap()
}

/// Iterations of conjugate gradients of the first, linearised step of a scene that has `SOLVER` in it.
fn iterations(scene: &str, folder: &str, solver: &str) -> u64 {
    let mut simulation = start(scene, folder, solver);
    simulation.advance(1).unwrap();
    simulation.implicit_steps().unwrap().linear_iterations
}

/// A lens of `scenes/meshes`, pressed at once, at rest before; neo-Hookean.
fn lens(nodes: usize) -> String {
    format!(
        "(duration: 1, SOLVER
        bodies: {{\"lens\": (mesh: File(path: \"meshes/lens_{nodes}.msh\"), material: \"m\")}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3000, poisson: 0.45), damping: 20)}},
        constraints: [Fixed(on: Set(\"rim\"))], loads: [Pressure(on: Set(\"front\"), pressure: 100)])"
    )
}

const TOLERANCES: [&str; 4] = ["0.1", "1e-2", "1e-3", "1e-5"];

/// Of a prototype (float64, assembled matrices) by preconditioner and step, to each of [`TOLERANCES`].
const FORESEEN: [(&str, f64, [u64; 4]); 5] = [
    ("TwoLevel", 0.01, [14, 21, 29, 46]),
    ("BlockJacobi", 0.01, [30, 51, 71, 110]),
    ("Identity", 0.01, [37, 64, 84, 136]),
    ("BlockJacobi", 0.001, [18, 29, 44, 72]),
    ("Identity", 0.001, [24, 36, 55, 82]),
];

/// A prototype of the same preconditioners took these, within a fifth.
#[test]
fn a_pressed_lens_takes_the_iterations_that_were_foreseen() {
    let scene = lens(814);
    for (preconditioner, step, all) in FORESEEN {
        for (tolerance, expected) in TOLERANCES.into_iter().zip(all) {
            let solver = format!("step: {step}, tolerance: {tolerance}, preconditioner: {preconditioner}");
            let found = iterations(&scene, "scenes", &solver);
            near(&solver, found as f64, expected as f64, expected as f64, 0.2);
        }
    }
}

/// The same, of aggregates that are larger than those of the prototype, which took no more by aggregates of 120 nodes.
#[test]
#[ignore = "long"]
fn a_larger_lens_takes_hardly_more() {
    let scene = lens(7880);
    let iterations = |preconditioner: &str, tolerance: &str| {
        let solver = format!("step: 0.01, tolerance: {tolerance}, preconditioner: {preconditioner}");
        iterations(&scene, "scenes", &solver) as f64
    };
    for (preconditioner, all) in [("BlockJacobi", [67, 89, 149, 245]), ("Identity", [95, 123, 202, 309])] {
        for (tolerance, expected) in TOLERANCES.into_iter().zip(all.map(f64::from)) {
            near(preconditioner, iterations(preconditioner, tolerance), expected, expected, 0.2);
        }
    }
    for (tolerance, most) in TOLERANCES.into_iter().zip([23.0, 37.0, 51.0, 79.0]) {
        let found = iterations("TwoLevel", tolerance);
        println!("to {tolerance}: {found} iterations, where aggregates of 120 nodes took {most}");
        assert!(found <= 1.2 * most, "{found}");
    }
}

/// A free block under a pressure on one face, which turns with it.
const BLOCK: &str = "(duration: 1, SOLVER
    bodies: {\"b\": (mesh: Box(size: (0.2, 0.03, 0.03), cells: (16, 3, 3), elements: Tet4), material: \"m\")},
    materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))},
    loads: [Pressure(on: Surface(normal: (0, 0, 1)), pressure: 5)])";

/// Iterations of its first step of a length (s), where it begins on an arc of so many radians, turned.
fn of_block((arc, step): (f64, f64), turn: DMat3, preconditioner: &str) -> u64 {
    let mut simulation = start(BLOCK, ".", &format!("step: {step}, tolerance: 1e-5, preconditioner: {preconditioner}"));
    let rest = simulation.rest_positions("b").unwrap().to_vec();
    let entity = simulation.body("b").unwrap();
    let rows = simulation.world().get::<Authoring>(entity).unwrap().node_rows.clone();
    let mut u = simulation.world_mut().get_mut::<Displacement>(entity).unwrap();
    for (x, row) in rest.iter().zip(&rows) {
        let mut at = *x;
        if arc > 0.0 {
            let (radius, (sin, cos)) = (0.2 / arc, (arc * x.x / 0.2).sin_cos());
            let out = radius - (x.z - 0.015);
            at = DVec3::new(out * sin, x.y, 0.015 + radius - out * cos);
        }
        u.set_vector(*row as usize, turn * at - *x);
    }
    simulation.advance(1).unwrap();
    let took = simulation.implicit_steps().unwrap();
    assert_eq!(took.negative_curvatures, 0, "a solve that ends early says nothing");
    took.linear_iterations
}

/// Turned about no axis of the mesh, at rest and bent to an arc of .8 rad, its tip .4 of its length aside. (Blocks are
/// those of nodes at rest, which are not turned.)
#[test]
fn a_body_that_has_turned_takes_as_many_iterations_as_it_did() {
    let turn = DMat3::from_axis_angle(DVec3::new(1.0, -2.0, 0.7).normalize(), 2.1);
    for arc in [(0.0, 0.1), (0.8, 0.015)] {
        let [two, two_turned] = [DMat3::IDENTITY, turn].map(|turn| of_block(arc, turn, "TwoLevel"));
        let [one, one_turned] = [DMat3::IDENTITY, turn].map(|turn| of_block(arc, turn, "BlockJacobi"));
        println!("arc and step {arc:?}: two levels {two}, turned {two_turned}; blocks {one}, turned {one_turned}");
        assert!(two.abs_diff(two_turned) <= 1, "{arc:?}: {two}, turned {two_turned}");
        assert!(2 * two < one, "{arc:?}: {two} and {one}");
    }
}

/// Elements go, and with them what held two halves together.
#[test]
fn taking_elements_out_keeps_it_valid() {
    let run = |preconditioner: &str| {
        let scene = format!(
            "(duration: 1, solver: Implicit(step: 0.02, tolerance: 1e-8, preconditioner: {preconditioner}),
            bodies: {{\"b\": (mesh: Box(size: (0.1, 0.03, 0.03), cells: (10, 3, 3), elements: Tet4), material: \"m\")}},
            materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}},
            constraints: [Fixed(on: Plane(normal: (1, 0, 0), at: 0))],
            loads: [Gravity(acceleration: (0, 0, -0.5))],
            removal: [(on: Box(min: (0.055, -1, -1), max: (0.065, 1, 0.015)), when: At(0.05)), (on: Box(min: (0.055, -1, -1), max: (0.065, 1, 1)), when: At(0.11))])"
        );
        let mut simulation = Simulation::new(&scene_of(&scene, Path::new(".")), &options(Precision::F64, 1)).unwrap();
        simulation.advance_to(0.2).unwrap();
        let end = simulation.displacements("b").unwrap();
        (end, simulation.implicit_steps().unwrap())
    };
    let (two, took) = run("TwoLevel");
    let (one, of_blocks) = run("BlockJacobi");
    println!("{took:?}\n{of_blocks:?}");
    let largest = one.iter().map(|u| u.length()).fold(0.0, f64::max);
    let apart = two.iter().zip(&one).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    near("displacements", apart, 0.0, largest, 1e-5);
    assert!(took.linear_iterations < of_blocks.linear_iterations && took.unsolved == 0, "{took:?}");
}

/// Of the lens: n aggregates have a symmetric matrix of 6 n unknowns and a factor, rows of f64 up to the diagonal.
#[test]
fn what_it_holds_is_told_before_a_run_and_after() {
    let scene = lens(814).replace("SOLVER", "solver: Implicit(budget: 40),");
    let mut simulation = Simulation::new(&scene_of(&scene, Path::new("scenes")), &options(Precision::F32, 1)).unwrap();
    let told = simulation.explain(&Registry::default()).unwrap();
    println!("{told}");
    let step = told.time_step.unwrap();
    assert!(step.contains("times what explicit steps") && step.contains("at most 0.7 of it a step"), "{step}");
    let solver = told.solver.unwrap();
    let line = solver.of.iter().find(|line| line.contains("aggregates")).unwrap();
    let number = line.split(" aggregates").next().unwrap().rsplit(' ').next().unwrap();
    let unknowns = 6 * number.parse::<u64>().unwrap();
    assert!((20 * 6..=128 * 6).contains(&unknowns), "{line}");
    let bytes = |of: &str| solver.held.iter().find(|(name, _)| name.contains(of)).unwrap().1;
    let triangle = unknowns * (unknowns + 1) / 2;
    assert_eq!(bytes("coarse matrices"), 8 * (2 * triangle + unknowns));
    let of_preconditioner: u64 = ["blocks of nodes", "aggregates", "coarse"].into_iter().map(bytes).sum();
    simulation.advance(1).unwrap();
    let summary = simulation.summary("interrupted").unwrap();
    assert_eq!(summary.implicit.unwrap().preconditioner_bytes, of_preconditioner);
}
