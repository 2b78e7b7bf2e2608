//! Held nodes while other things happen to them: elements that go, policies that act on bodies, batches, threads,
//! snapshots that do not fit.

use crate::configurations::{Configuration, configurations, near, scene_of};
use crate::grids::bits;
use sinew::components::Precision;
use sinew::glam::DVec3;
use sinew::{BackendChoice, GrabId, Grip, Options, Simulation};
use std::path::Path;

/// A cube of 1 kg that nothing holds, of so many cells along an edge.
fn cube(cells: usize, further: &str) -> String {
    format!(
        "(duration: 4, bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: ({cells}, {cells}, {cells})), material: \"m\")}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e5, poisson: 0.3))}}, {further})"
    )
}

fn start(run: &Configuration, scene: &str) -> Simulation {
    let options = Options { grabs: true, ..run.options.clone() };
    Simulation::new(&scene_of(scene, Path::new(".")), &options).unwrap_or_else(|error| panic!("{error}\n{scene}"))
}

/// The node at the middle of the top.
fn top(simulation: &mut Simulation) -> usize {
    let rest = simulation.rest_positions("b").unwrap();
    rest.iter().position(|x| x.distance(DVec3::new(0.05, 0.05, 0.1)) < 1e-6).unwrap()
}

/// A grip of that node alone so stiff that its κ is so many times the highest ω² of the body.
fn grip(simulation: &mut Simulation, times: f64) -> Grip {
    let node = top(simulation);
    let mass = simulation.masses("b").unwrap()[node];
    let square = 4.0 / simulation.stable_limit().unwrap().unwrap().powi(2);
    Grip { stiffness: Some(times * square * mass), damping: Some(0.0), ..Grip::default() }
}

fn farthest(simulation: &mut Simulation) -> f64 {
    simulation.displacements("b").unwrap().iter().fold(0.0_f64, |far, u| far.max(u.length()))
}

/// Most elements at the node go with their mass: the spring over what is left would be so many times as stiff.
#[test]
fn elements_that_go_around_a_held_node_leave_it_stable() {
    let scene = cube(
        2,
        "removal: [(on: Box(min: (0.05, 0, 0.05), max: (0.1, 0.1, 0.1)), when: During(start: 0.02, end: 0.021)),
            (on: Box(min: (0, 0.05, 0.05), max: (0.05, 0.1, 0.1)), when: During(start: 0.02, end: 0.021))]",
    );
    for run in configurations() {
        let mut simulation = start(&run, &scene);
        let (node, stiff) = (top(&mut simulation), grip(&mut simulation, 10.0));
        let hand = simulation.grab_nodes("b", &[(node, 1.0)], &stiff).unwrap();
        simulation.move_grab(hand, DVec3::new(0.05, 0.05, 0.1001)).unwrap();
        let before = simulation.masses("b").unwrap()[node];
        simulation.advance_to(0.1).unwrap_or_else(|error| panic!("{}: {error}", run.name));
        let left = simulation.masses("b").unwrap()[node] / before;
        assert!((0.1..0.6).contains(&left), "{left} of the mass is left");
        // the node swings about its target, with what is left of the spring
        let far = farthest(&mut simulation);
        assert!(far < 0.01, "{}: {far} m", run.name);
        let state = simulation.nodes_at("b", &[node]).unwrap();
        let state = simulation.node_state(&state).unwrap()[0];
        let force = simulation.grab_force(hand).unwrap();
        let expected = left * stiff.stiffness.unwrap() * (1e-4 - state.displacement.z);
        near("and it pulls with that", force.z, expected, stiff.stiffness.unwrap() * 1e-4, 1e-3);
    }
}

/// What is lost of the stable step lies within what a step leaves free: it stays, however many nodes are held, and all
/// grips are the same.
#[test]
fn a_grip_that_is_not_told_cannot_be_noticed() {
    for run in configurations() {
        let mut simulation = start(&run, &cube(2, "integration: (bound: Iterated)"));
        let (first, limit) = (simulation.time_step(), simulation.stable_limit().unwrap().unwrap());
        let nodes = [0, 2, 6, 8];
        for node in nodes {
            simulation.grab_nodes("b", &[(node, 1.0)], &Grip::default()).unwrap();
            simulation.advance(100).unwrap();
        }
        assert_eq!(simulation.time_step(), first, "{}: another step", run.name);
        let with = simulation.stable_limit().unwrap().unwrap();
        assert!(with > 0.97 * limit && with < 0.98 * limit, "{}: {with} of {limit}", run.name);
        // ωΔt is the same for all
        let masses = simulation.masses("b").unwrap();
        for ((_, grab), node) in simulation.grabs().zip(nodes) {
            let expected = masses[node] * (0.05 / first).powi(2);
            near("stiffness", grab.stiffness, expected, expected, 1e-6);
        }
    }
}

/// Heavier or fewer elements do not make a grip softer: what is too stiff is refused, what is not leaves bodies alone.
#[test]
fn policies_that_change_bodies_do_so_for_no_grip() {
    for policy in ["Remove", "ScaleMass(most: 0.5)"] {
        for run in configurations() {
            let mut simulation = start(&run, &cube(2, &format!("integration: (when_unstable: {policy})")));
            let (node, step) = (top(&mut simulation), simulation.time_step());
            let mass = simulation.masses("b").unwrap()[node];
            let limit = simulation.stable_limit().unwrap().unwrap();
            // stable, with less left than that at which something is done
            let stiffness = mass * 4.0 * ((0.97 / step).powi(2) - 1.0 / limit.powi(2));
            let tight = Grip { stiffness: Some(stiffness), damping: Some(0.0), ..Grip::default() };
            let refused = simulation.grab_nodes("b", &[(node, 1.0)], &tight).unwrap_err().to_string();
            assert!(refused.contains("so stiff a grip"), "{refused}");
            let hand = simulation.grab_nodes("b", &[(node, 1.0)], &Grip::default()).unwrap();
            simulation.move_grab(hand, DVec3::new(0.05, 0.05, 0.101)).unwrap();
            simulation.advance(600).unwrap();
            let history = *simulation.step_history().unwrap();
            assert!(history.checks > 3 && history.beyond_since.is_none(), "{policy}, {}: {history:?}", run.name);
            assert_eq!((history.removed, history.added_mass), (0, 0.0), "{policy}, {}", run.name);
        }
    }
}

#[test]
fn a_number_that_was_let_go_is_never_that_of_another_grab() {
    let run = &configurations()[0];
    let mut simulation = start(run, &cube(2, ""));
    let grab = |simulation: &mut Simulation| simulation.grab_nodes("b", &[(0, 1.0)], &Grip::default()).unwrap();
    let first = grab(&mut simulation);
    let kept = simulation.snapshot().unwrap();
    simulation.release(first).unwrap();
    let second = grab(&mut simulation);
    assert!(second != first && simulation.grab_force(first).is_err());
    simulation.restore(&kept).unwrap();
    let held: Vec<GrabId> = simulation.grabs().map(|(id, _)| id).collect();
    assert_eq!(held, [first]);
    let third = grab(&mut simulation);
    assert!(third != first && third != second);
    simulation.reset().unwrap();
    assert!(![first, second, third].contains(&grab(&mut simulation)));
    assert!(simulation.release(third).is_err());
    // in another simulation, too
    let mut other = start(run, &cube(2, ""));
    other.restore(&kept).unwrap();
    assert!(grab(&mut other) != first);
}

/// The same hand on the CPU in f64 is what it is measured by: rounding of two hundred steps.
#[test]
fn a_hand_that_moves_between_batches_moves_the_body_as_in_f64() {
    let moved = |run: &Configuration| {
        let mut simulation = start(run, &cube(3, "integration: (step: 0.0005)"));
        let hand = simulation.grab_nodes("b", &[(0, 0.25), (1, 0.5), (4, 0.25)], &Grip::default()).unwrap();
        let from = simulation.grabs().next().unwrap().1.from;
        for place in 1..=20 {
            simulation.move_grab(hand, from + DVec3::new(2e-4, -1e-4, 3e-4) * f64::from(place)).unwrap();
            simulation.advance(10).unwrap();
        }
        (simulation.displacements("b").unwrap(), simulation.grab_force(hand).unwrap())
    };
    let all = configurations();
    let (expected, force) = moved(&all[0]);
    let largest = expected.iter().fold(0.0_f64, |most, u| most.max(u.length()));
    assert!(largest > 1e-3, "{largest} m");
    for run in &all[1..] {
        let (found, pull) = moved(run);
        let error = found.iter().zip(&expected).fold(0.0_f64, |most, (a, b)| most.max(a.distance(*b)));
        assert!(error < 1e-4 * largest, "{}: {error:e} m of {largest:e} m", run.name);
        near(run.name, pull.distance(force), 0.0, force.length(), 1e-3);
    }
}

/// Spans of rows end somewhere among nodes that are held all over the body.
#[test]
fn held_nodes_have_the_same_bits_whatever_the_number_of_threads() {
    for precision in [Precision::F64, Precision::F32] {
        let end = |threads: usize| {
            let options =
                Options { grabs: true, threads, precision, backend: BackendChoice::Cpu, ..Options::default() };
            let file = scene_of(&cube(14, ""), Path::new("."));
            let mut simulation = Simulation::new(&file, &options).unwrap();
            let nodes: Vec<(usize, f64)> =
                (0..64).map(|place| (place * 3374 / 63, 1.0 + f64::from(place as u32))).collect();
            let hand = simulation.grab_nodes("b", &nodes, &Grip::default()).unwrap();
            let from = simulation.grabs().next().unwrap().1.from;
            simulation.move_grab(hand, from + DVec3::new(0.01, 0.0, 0.02)).unwrap();
            simulation.advance(40).unwrap();
            assert!(farthest(&mut simulation) > 1e-6);
            bits(&mut simulation, "b")
        };
        let one = end(1);
        assert!(end(3) == one && end(4) == one, "{precision:?}: other bits");
    }
}

#[test]
fn a_snapshot_that_cannot_be_gone_on_from_changes_nothing() {
    for run in configurations() {
        let mut holding = start(&run, &cube(2, ""));
        let nothing_held = holding.snapshot().unwrap();
        let node = top(&mut holding);
        let hand = holding.grab_nodes("b", &[(node, 1.0)], &Grip::default()).unwrap();
        holding.move_grab(hand, DVec3::new(0.05, 0.05, 0.12)).unwrap();
        holding.advance(20).unwrap();
        let kept = holding.snapshot().unwrap();
        assert!(Simulation::can_grab_in(&kept).unwrap() && Simulation::can_grab_in(&nothing_held).unwrap());

        let mut other = run.start(&cube(2, ""));
        other.advance(7).unwrap();
        let before = other.snapshot().unwrap();
        assert!(!Simulation::can_grab_in(&before).unwrap());
        let refused = other.restore(&kept).unwrap_err().to_string();
        assert!(refused.contains("something is held") && refused.contains("grabs: true"), "{refused}");
        assert_eq!(other.snapshot().unwrap().differences(&before), Vec::<String>::new(), "{}", run.name);

        // an input that the other scene does not have
        let with_input = |name: &str| {
            cube(2, &format!("loads: [Gravity(acceleration: (0, 0, -1), curve: Input(name: \"{name}\", initial: 1))]"))
        };
        let mut first = run.start(&with_input("g"));
        first.advance(5).unwrap();
        let state = first.snapshot().unwrap().to_bytes().unwrap();
        let mut second = run.start(&with_input("h"));
        second.advance(9).unwrap();
        let before = second.snapshot().unwrap();
        assert!(second.restore(&sinew::Snapshot::from_bytes(&state).unwrap()).is_err());
        assert_eq!(second.snapshot().unwrap().differences(&before), Vec::<String>::new(), "{}", run.name);
    }
}

#[test]
fn a_body_that_can_only_be_held_says_so() {
    let mut simulation = start(&configurations()[0], &cube(2, ""));
    let explained = simulation.explain(&sinew::systems::Registry::default()).unwrap();
    let effects = explained.parts.iter().flat_map(|part| &part.effects);
    let forces: Vec<_> = effects.filter(|effect| effect.name == "external forces").map(|effect| &effect.on).collect();
    assert_eq!(forces, [&Some("those of what a program grabs".to_string())]);
}
