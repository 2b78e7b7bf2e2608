//! Forces that are only tried leave nothing: memories of viscous materials, what was removed, what guards have noted
//! and which elements were turned inside out are the same, bit for bit, however often and wherever forces are tried.

use crate::configurations::{configurations, near, scene_of};
use crate::implicit::{EFFECTS, cube, options};
use sinew::components::*;
use sinew::{BackendChoice, Options, Simulation};
use std::path::Path;

/// Columns that a solver writes over whenever it tries forces, and carries on itself.
struct Tried {
    displacement: Displacement,
    increment: DisplacementIncrement,
    forces: (InternalForce, ExternalForce),
}

/// Tries forces where the body is, where it is squeezed to a tenth, pulled to three times its length and turned inside
/// out, and near each of these; and puts back what the solver would. Whether an element was inside out there.
fn try_forces(simulation: &mut Simulation) -> bool {
    let body = simulation.body("b").unwrap();
    let world = simulation.world();
    let kept = Tried {
        displacement: Displacement(world.get::<Displacement>(body).unwrap().0.clone()),
        increment: DisplacementIncrement(world.get::<DisplacementIncrement>(body).unwrap().0.clone()),
        forces: (
            InternalForce(world.get::<InternalForce>(body).unwrap().0.clone()),
            ExternalForce(world.get::<ExternalForce>(body).unwrap().0.clone()),
        ),
    };
    let rest = world.get::<RestPosition>(body).unwrap().0.clone();
    let u: Vec<f64> = (0..3 * rest.len()).map(|axis| kept.displacement.get(axis)).collect();
    let motions: Vec<Vec<f64>> =
        [0.37, 1.91].map(|seed| (0..u.len()).map(|axis| (seed * (axis as f64 + 1.0)).sin()).collect()).into();
    simulation.world_mut().resource_mut::<TrialForces>().trying = true;
    let mut beyond = false;
    for stretch in [1.0, 0.1, 3.0, -1.0] {
        let place = |axis: usize| match axis % 3 {
            2 => stretch * (rest[axis / 3].z + u[axis]) - rest[axis / 3].z,
            _ => u[axis],
        };
        let w: Vec<f64> = (0..u.len()).map(place).collect();
        beyond |= simulation.stiffness_by_differences(&w, &motions).unwrap().is_empty();
    }
    let world = simulation.world_mut();
    *world.resource_mut::<TrialForces>() = TrialForces::default();
    let Tried { displacement, increment, forces: (internal, external) } = kept;
    world.entity_mut(body).insert((displacement, increment, internal, external));
    beyond
}

/// What is kept of elements: memories, and which were turned inside out.
fn kept(simulation: &mut Simulation) -> (Vec<f64>, Vec<u32>) {
    let world = simulation.world_mut();
    let mut blocks = world.query::<(Option<&ViscousMemory>, &FirstInverted)>();
    let mut all = (Vec::new(), Vec::new());
    for (memory, inverted) in blocks.iter(world) {
        all.0.extend(memory.iter().flat_map(|memory| (0..memory.len()).map(|place| memory.get(place))));
        all.1.extend_from_slice(&inverted.0);
    }
    all
}

/// A block whose top comes down, while its memories relax; elements go where they are squeezed.
const PRESSED: &str =
    "prony: (terms: [(alpha: 0.4, tau: 0.05), (alpha: 0.2, tau: 1)], volumetric: [(alpha: 0.1, tau: 0.1)]),
    stiffness_damping: 2e-3, fibres: (eta: 500, direction: Along(1, 2, 3)), damping: 5,
    neo_hookean: Young(young: 3e3, poisson: 0.3)";
/// The same of what may be turned inside out and recovers.
const RECOVERS: &str = "prony: (volumetric: [(alpha: 0.1, tau: 0.1)]), damping: 5,
    stable_neo_hookean: Young(young: 3e3, poisson: 0.3)";

fn pressed(material: &str, scheme: &str, options: &Options) -> Simulation {
    let scene = format!(
        "(duration: 1, solver: Implicit(scheme: {scheme}, step: 0.01),
        bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (3, 3, 3), elements: Hex8), material: \"m\")}},
        materials: {{\"m\": (density: 1000, {material})}},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0)), Prescribed(on: Plane(normal: (0, 0, 1), at: 0.1),
            displacement: (0.02, 0, -0.03), curve: Smooth(end: 0.25))],
        loads: [Gravity(acceleration: (0, 0, -1))],
        removal: [(when: VolumeRatioBelow(0.78))], guards: (every: 1, hourglass: 1e-3))"
    );
    Simulation::new(&scene_of(&scene, Path::new(".")), options).unwrap()
}

#[test]
fn what_is_kept_does_not_depend_on_where_forces_were_tried() {
    for run in configurations().iter().filter(|run| run.options.backend == BackendChoice::Cpu) {
        for (material, inversion, scheme) in
            [(PRESSED, "Remove", "Euler"), (PRESSED, "Stop", "GeneralizedAlpha()"), (RECOVERS, "Recover", "Euler")]
        {
            let material = format!("inversion: {inversion}, {material}");
            let [mut plain, mut tried] = [(); 2].map(|()| pressed(&material, scheme, &run.options));
            let mut beyond = 0;
            for step in 0..25 {
                beyond += u32::from(try_forces(&mut tried));
                plain.advance(1).unwrap();
                tried.advance(1).unwrap();
                assert!(kept(&mut plain) == kept(&mut tried), "{}, {scheme}, step {step}: other memories", run.name);
                let [one, other] = [&mut plain, &mut tried].map(|simulation| simulation.snapshot().unwrap());
                assert!(one == other, "{}, {scheme}, step {step}: another state", run.name);
            }
            let [one, other] = [&mut plain, &mut tried].map(|run| run.summary("").unwrap());
            assert_eq!(one.guards.warnings, other.guards.warnings);
            let gone = plain.fields("b").unwrap().alive.iter().filter(|&&alive| alive == 0).count();
            let largest = kept(&mut plain).0.iter().fold(0.0_f64, |largest, q| largest.max(q.abs()));
            let notices = one.guards.warnings.len();
            println!(
                "{}, {scheme}: {gone} gone, memories to {largest:e} Pa, {notices} notices, {beyond} beyond",
                run.name
            );
            assert!(gone > 0 && gone < 20 && largest > 1.0 && notices > 0, "there is nothing to be left as it is");
            assert_eq!(beyond > 0, inversion == "Stop", "elements that go or recover may be inside out");
        }
    }
}

/// One Newton iteration more, and products that are others, change digits of the answer only.
#[test]
fn what_steps_carry_on_does_not_depend_on_how_often_forces_were_tried() {
    let run = |tolerance: &str, preconditioner: &str| {
        let solver = format!("solver: Implicit(step: 0.01, tolerance: {tolerance}, preconditioner: {preconditioner}),");
        cube(&solver, "Tet4", EFFECTS, 0.2, &options(Precision::F64, 1))
    };
    let (few, one) = run("1e-9", "BlockJacobi");
    let (many, other) = run("1e-12", "Identity");
    let passes = [&one, &other].map(|simulation| simulation.implicit_steps().unwrap().passes);
    println!("{passes:?} passes: {few:e}, {many:e}");
    assert!(passes[1] > passes[0] + passes[0] / 2, "{passes:?}");
    near("top", few, many, many, 1e-6);
}
