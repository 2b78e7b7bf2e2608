//! The preconditioner of two levels: how many iterations it leaves, and that turning bodies and taking elements out
//! keeps it what it is.

use crate::configurations::{near, scene_of};
use crate::implicit::options;
use sinew::Simulation;
use sinew::components::Precision;
use sinew::systems::Registry;
use std::path::Path;

/// Iterations of conjugate gradients of the first, linearised step of a scene that has `SOLVER` in it.
fn iterations(scene: &str, folder: &str, solver: &str) -> u64 {
    let scene = scene.replace("SOLVER", &format!("solver: Implicit(newton: 1, {solver}),"));
    let mut simulation = Simulation::new(&scene_of(&scene, Path::new(folder)), &options(Precision::F64, 1)).unwrap();
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

/// A prototype of the same preconditioner (float64, assembled matrices) took these, within a fifth.
#[test]
fn a_pressed_lens_takes_the_iterations_that_were_foreseen() {
    let expected = [("0.1", 14), ("1e-2", 21), ("1e-3", 29), ("1e-5", 46)];
    let scene = lens(814);
    for (tolerance, expected) in expected {
        let found = iterations(&scene, "scenes", &format!("step: 0.01, tolerance: {tolerance}"));
        let blocks =
            iterations(&scene, "scenes", &format!("step: 0.01, tolerance: {tolerance}, preconditioner: BlockJacobi"));
        println!("to {tolerance}: {found} iterations, {expected} foreseen; with blocks alone {blocks}");
        near("iterations", found as f64, expected as f64, expected as f64, 0.2);
        assert!(2 * found < blocks + 8, "{found} and {blocks}");
    }
}

#[test]
#[ignore = "long"]
fn a_larger_lens_takes_hardly_more() {
    let scene = lens(7880);
    for (tolerance, most) in [("0.1", 23), ("1e-2", 37), ("1e-3", 51), ("1e-5", 79)] {
        let found = iterations(&scene, "scenes", &format!("step: 0.01, tolerance: {tolerance}"));
        println!("to {tolerance}: {found} iterations, where aggregates of 120 nodes took {most}");
        assert!(found as f64 <= 1.2 * most as f64, "{found}");
    }
}

/// A free block under a pressure on one face, which turns with it; turned as it stands at the start.
fn block(gradient: &str) -> String {
    format!(
        "(duration: 1, SOLVER
        bodies: {{\"b\": (mesh: Box(size: (0.2, 0.03, 0.03), cells: (16, 3, 3), elements: Tet4), material: \"m\", start: Affine(gradient: {gradient}))}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}},
        loads: [Pressure(on: Surface(normal: (0, 0, 1)), pressure: 5)])"
    )
}

#[test]
fn a_body_that_has_turned_takes_as_many_iterations_as_it_did() {
    let solver = |preconditioner: &str| format!("step: 0.1, tolerance: 1e-4, preconditioner: {preconditioner}");
    // none, and 120 degrees about (1, 1, 1): R − I
    let (rest, turned) = ("((0, 0, 0), (0, 0, 0), (0, 0, 0))", "((-1, 0, 1), (1, -1, 0), (0, 1, -1))");
    let [two, two_turned] = [rest, turned].map(|start| iterations(&block(start), ".", &solver("TwoLevel")));
    let [one, one_turned] = [rest, turned].map(|start| iterations(&block(start), ".", &solver("BlockJacobi")));
    println!("two levels: {two}, turned {two_turned}; blocks: {one}, turned {one_turned}");
    assert!(two.abs_diff(two_turned) <= 1, "{two}, turned {two_turned}");
    assert!(2 * two < one, "{two} and {one}");
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
