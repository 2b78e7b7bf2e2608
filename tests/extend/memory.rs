//! A node system that is for nodes of its choice, keeps numbers of its own and tells what energy it holds: by public
//! API, on both backends, in the passes of the engine's own.

use super::bond;
use sinew::gpu_or_reason;
use sinew::prelude::*;
use sinew::scene::SceneFile;
use std::path::Path;

/// A cube that hangs by the nodes of its upper side, an eighth of its mass.
const SCENE: &str = r#"(
    duration: 1,
    bodies: {"cube": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (4, 4, 4)), material: "tissue")},
    materials: {"tissue": (density: 1000, neo_hookean: Young(young: 2e4, poisson: 0.3), damping: 60)},
    loads: [Gravity(acceleration: (0, 0, -9.81))],
    parameters: {"bond": (height: 0.0999, stiffness: 1e5, slip: 0.01)},
    output: (energies_every: 0.1),
)"#;

/// How far the upper side is below where it was, by mass, at rest (m): κ m/8 δ = m g.
const HANGS: f64 = 8.0 * 9.81 / 1e5;

fn begun(backend: BackendChoice, sets: &[&str]) -> Simulation {
    let sets: Vec<String> = sets.iter().map(ToString::to_string).collect();
    let scene = SceneFile::from_text("bond.ron", SCENE, Path::new("."), &sets)
        .unwrap_or_else(|wrong| panic!("{}", wrong.render(false)));
    let options = Options { backend, ..Options::default() };
    Simulation::with_systems(&scene, &options, &Registry::default().with(bond::system())).unwrap()
}

fn backends() -> impl Iterator<Item = BackendChoice> {
    std::iter::once(BackendChoice::Cpu).chain(gpu_or_reason().is_some().then_some(BackendChoice::Gpu))
}

/// Mass, displacement and height at rest of each node.
fn nodes(simulation: &mut Simulation) -> Vec<(f64, DVec3, f64)> {
    let mass = simulation.masses("cube").unwrap();
    let moved = simulation.displacements("cube").unwrap();
    let rest = simulation.rest_positions("cube").unwrap();
    mass.into_iter().zip(moved).zip(rest).map(|((mass, u), rest)| (mass, u, rest.z)).collect()
}

/// Of the nodes of the upper side by mass: how far they are down (m), and what springs of such lengths hold (J).
fn of_upper_side(nodes: &[(f64, DVec3, f64)]) -> (f64, f64) {
    let upper = || nodes.iter().filter(|node| node.2 > 0.0999);
    let mass: f64 = upper().map(|node| node.0).sum();
    let down = upper().map(|(mass, u, _)| -mass * u.z).sum::<f64>() / mass;
    (down, upper().map(|(mass, u, _)| 0.5 * 1e5 * mass * u.length_squared()).sum())
}

#[test]
fn a_cube_hangs_by_the_nodes_that_a_system_chooses() {
    for backend in backends() {
        let mut simulation = begun(backend, &[]);
        let summary = simulation.summary("begun").unwrap();
        let names: Vec<&str> = summary.systems.iter().map(|system| system.name.as_str()).collect();
        let shared = |name: &&&str| ["gather", "gravity", "bond", "integrate"].iter().all(|part| name.contains(part));
        assert!(names.iter().any(|name| shared(&name)), "{backend:?}: {names:?}");
        simulation.finish().unwrap();
        let nodes = nodes(&mut simulation);
        let (down, held) = of_upper_side(&nodes);
        assert!((down / HANGS - 1.0).abs() < 1e-3, "{backend:?}: {down} m, {HANGS} m expected");
        let told = simulation.energies().unwrap().held.unwrap();
        assert!((told / held - 1.0).abs() < 1e-4, "{backend:?}: {told} J of {held} J");
        // it has not slipped, and knows of no other nodes
        let own = simulation.own_numbers("bond", "cube").unwrap();
        assert!(own.len() == nodes.len() && own.iter().flatten().all(|number| *number == 0.0));
    }
}

#[test]
fn a_bond_that_slips_remembers_where_it_holds_on_both_backends() {
    let slip = 0.3 * HANGS;
    let mut ends = Vec::new();
    for backend in backends() {
        let mut simulation = begun(backend, &[&format!("parameters.bond.slip={slip}"), "duration=0.2"]);
        simulation.advance(simulation.planned_steps() - 1).unwrap();
        // the bond of the last step is that of the places at its beginning
        let before = nodes(&mut simulation);
        simulation.advance(1).unwrap();
        let own = simulation.own_numbers("bond", "cube").unwrap();
        for ((_, u, height), own) in before.into_iter().zip(&own) {
            let held = DVec3::from_slice(own);
            if height > 0.0999 {
                let drawn = (u - held).length() / slip;
                assert!(held.z < -slip && (drawn - 1.0).abs() < 1e-4, "{backend:?}: {drawn}, {held} m");
            } else {
                assert_eq!(held, DVec3::ZERO, "{backend:?}");
            }
        }
        ends.push(of_upper_side(&nodes(&mut simulation)).0);
    }
    assert!(ends.iter().all(|end| (end / ends[0] - 1.0).abs() < 1e-3), "{ends:?}");
}

#[test]
fn nodes_that_a_system_is_for_can_be_chosen_while_it_runs() {
    for backend in backends() {
        // steps of one length, and a bond that does not slip
        let sets = ["materials.tissue.damping=0", "parameters.bond=(height: 0.0999, stiffness: 1e4, slip: 1)"];
        let sets = [&sets[..], &["integration=(when_unstable: Watch)"]].concat();
        let mut simulation = begun(backend, &sets);
        simulation.advance(50).unwrap();
        let kept = simulation.snapshot().unwrap();
        let mean = |simulation: &mut Simulation| {
            let nodes = nodes(simulation);
            let mass: f64 = nodes.iter().map(|node| node.0).sum();
            nodes.iter().map(|(mass, u, _)| mass * u.z).sum::<f64>() / mass
        };
        // u⁺ − 2u + u⁻ = Δt² a(u): with u
        let acceleration = |simulation: &mut Simulation| {
            let places = [0; 3].map(|_| {
                simulation.advance(1).unwrap();
                mean(simulation)
            });
            ((places[2] - 2.0 * places[1] + places[0]) / simulation.time_step().powi(2), places[1])
        };
        let (bound, _) = acceleration(&mut simulation);
        let none = simulation.nodes_at("cube", &[]).unwrap();
        simulation.choose_nodes("bond", &none).unwrap();
        simulation.advance(1).unwrap();
        let (free, _) = acceleration(&mut simulation);
        let all: Vec<usize> = (0..simulation.masses("cube").unwrap().len()).collect();
        let all = simulation.nodes_at("cube", &all).unwrap();
        simulation.choose_nodes("bond", &all).unwrap();
        simulation.advance(1).unwrap();
        let (by_all, u) = acceleration(&mut simulation);
        // what rounding makes of means of f32, over Δt²
        let slack = 2e-7 * u.abs() / simulation.time_step().powi(2);
        let expected = -9.81 - 1e4 * u;
        println!("{backend:?}: {bound} m/s², {free}, {by_all} of {expected}, each within {slack}");
        assert!((free + 9.81).abs() < slack, "{backend:?}: {free} m/s² without, within {slack}");
        assert!(bound - free > 10.0 * slack, "{backend:?}: {bound} m/s² with it");
        assert!((by_all - expected).abs() < slack, "{backend:?}: {by_all}, {expected}, within {slack}");
        // a snapshot has what was chosen then
        let chosen_again = |simulation: &mut Simulation| {
            simulation.restore(&kept).unwrap();
            simulation.advance(20).unwrap();
            simulation.displacements("cube").unwrap()
        };
        let again = chosen_again(&mut simulation);
        let mut other = begun(backend, &sets);
        assert!(chosen_again(&mut other) == again, "{backend:?}: other bits");
        other.reset().unwrap();
        other.advance(70).unwrap();
        assert!(other.displacements("cube").unwrap() == again, "{backend:?}: other bits from the start");
    }
}

#[test]
fn what_cannot_be_chosen_is_refused() {
    let mut simulation = begun(BackendChoice::Cpu, &[]);
    let nodes = simulation.nodes_at("cube", &[0]).unwrap();
    let refused = simulation.choose_nodes("gravity", &nodes).unwrap_err().to_string();
    assert!(refused.contains("`gravity` is for all nodes"), "{refused}");
    let refused = simulation.choose_nodes("bund", &nodes).unwrap_err().to_string();
    assert!(refused.contains("no node system named \"bund\"") && refused.contains("bond"), "{refused}");
    let refused = simulation.own_numbers("gravity", "cube").unwrap_err().to_string();
    assert!(refused.contains("keeps no numbers"), "{refused}");
}
