//! Grabbing: a hand's spring holds weights, does work that the balance knows, and is stable.

use crate::configurations::{Configuration, configurations, near, scene_of};
use crate::grids::bits;
use sinew::components::Precision;
use sinew::glam::DVec3;
use sinew::{Grab, GrabId, Grip, Options, Simulation, Snapshot};
use std::path::Path;

/// A cube of 1 kg that nothing holds.
fn cube(further: &str) -> String {
    format!(
        "(duration: 4, bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (2, 2, 2)), material: \"m\")}}, {further})"
    )
}

const STIFF: &str = "materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e5, poisson: 0.3))}";

fn start(run: &Configuration, scene: &str) -> Simulation {
    let options = Options { grabs: true, ..run.options.clone() };
    Simulation::new(&scene_of(scene, Path::new(".")), &options).unwrap_or_else(|error| panic!("{error}\n{scene}"))
}

/// Grabs the middle of the top.
fn grab(simulation: &mut Simulation, grip: &Grip) -> GrabId {
    let pick = simulation.pick(DVec3::new(0.05, 0.05, 1.0), -DVec3::Z).unwrap().unwrap();
    simulation.grab(&pick, grip).unwrap()
}

fn momentum(simulation: &mut Simulation) -> DVec3 {
    let numbers = simulation.node_numbers("b").unwrap();
    let all = simulation.nodes_numbered("b", &numbers).unwrap();
    simulation.node_state(&all).unwrap().iter().map(|node| node.mass * node.velocity).sum()
}

#[test]
fn the_force_at_rest_is_the_weight_that_it_holds() {
    let scene = cube(
        "materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e5, poisson: 0.3), damping: 20)},
        loads: [Gravity(acceleration: (0, 0, -1))]",
    );
    for run in configurations() {
        let mut simulation = start(&run, &scene);
        let hand = grab(&mut simulation, &Grip::default());
        let weight: f64 = simulation.masses("b").unwrap().iter().sum();
        near("it weighs", weight, 1.0, 1.0, 1e-6);
        simulation.advance_to(3.0).unwrap();
        let force = simulation.grab_force(hand).unwrap();
        near("the hand pulls", force.z, weight, weight, 1e-3);
        assert!(force.truncate().length() < 1e-3 * weight, "{}: beside: {force}", run.name);
        // and the point hangs below its target by the force over the stiffness
        let stiffness = simulation.grabs().next().unwrap().1.stiffness;
        let pick = simulation.pick(DVec3::new(0.05, 0.05, 1.0), -DVec3::Z).unwrap().unwrap();
        near("it hangs", 0.1 - pick.point.z, weight / stiffness, weight / stiffness, 0.05);
        // let go, it falls
        simulation.release(hand).unwrap();
        assert!(simulation.grab_force(hand).is_err());
        let before = momentum(&mut simulation).z;
        let steps = (0.05 / simulation.time_step()) as u64;
        simulation.advance(steps).unwrap();
        let fallen = momentum(&mut simulation).z - before;
        let time = steps as f64 * simulation.time_step();
        near("it falls", fallen, -(1.0 - (-20.0 * time).exp()) / 20.0, 0.03, 0.02);
    }
}

#[test]
fn the_work_of_a_hand_is_in_the_balance_and_ends_with_it() {
    for run in configurations() {
        let mut simulation =
            start(&run, &cube(&format!("{STIFF}, integration: (step: 0.001), output: (energies_every: 0.01)")));
        let hand = grab(&mut simulation, &Grip::default());
        let goal = DVec3::new(0.06, 0.05, 0.12);
        let told = |simulation: &mut Simulation| {
            let e = simulation.energies().unwrap();
            // from middle to middle of steps: exact but for rounding
            (e.load_work.unwrap(), e.kinetic + e.internal_work.unwrap() + e.damping_loss.unwrap())
        };
        // the target goes up and aside, as a mouse does it
        for place in 1..=40 {
            let from = DVec3::new(0.05, 0.05, 0.1);
            simulation.move_grab(hand, from + (goal - from) * f64::from(place) / 40.0).unwrap();
            simulation.advance(5).unwrap();
        }
        let (work, held) = told(&mut simulation);
        assert!(work > 1e-4, "{}: {work} J", run.name);
        near("the balance", held, work, work, run.bound(1e-9, 1e-3));
        simulation.release(hand).unwrap();
        let (before, _) = told(&mut simulation);
        simulation.advance(200).unwrap();
        let (work, held) = told(&mut simulation);
        assert_eq!(work, before, "{}: who let go does no work", run.name);
        near("the balance after", held, work, work, run.bound(1e-9, 1e-3));
    }
}

#[test]
fn no_force_beyond_the_largest_and_momentum_as_it_says() {
    for run in configurations() {
        let mut simulation = start(&run, &cube(STIFF));
        let hand = grab(&mut simulation, &Grip { most_force: 0.02, ..Grip::default() });
        simulation.move_grab(hand, DVec3::new(0.05, 0.05, 50.0)).unwrap();
        near("it pulls", simulation.grab_force(hand).unwrap().z, 0.02, 0.02, 1e-6);
        simulation.advance(400).unwrap();
        let time = simulation.time() - 0.5 * simulation.time_step();
        near("momentum", momentum(&mut simulation).z, 0.02 * time, 0.02 * time, run.bound(1e-6, 1e-4));
    }
}

/// Who may grab and does not has the same bits, in as few passes.
#[test]
fn a_hand_that_holds_nothing_changes_nothing() {
    for run in configurations() {
        let scene = cube(&format!("{STIFF}, loads: [Gravity(acceleration: (0, 0, -9.81))]"));
        let mut with = start(&run, &scene);
        let mut without = run.start(&scene);
        with.advance(50).unwrap();
        without.advance(50).unwrap();
        assert!(bits(&mut with, "b") == bits(&mut without, "b"), "{}: other bits", run.name);
        let passes = |simulation: &mut Simulation| -> Vec<String> {
            simulation.summary("").unwrap().systems.iter().map(|system| system.name.clone()).collect()
        };
        let (with, without) = (passes(&mut with), passes(&mut without));
        assert_eq!(with.len(), without.len(), "{}: {with:?} {without:?}", run.name);
        assert!(with.iter().any(|pass| pass.contains("gravity + grab + integrate")), "{with:?}");
        // and who cannot grab has nothing of it
        assert!(!without.iter().any(|pass| pass.contains("grab")));
    }
}

#[test]
fn snapshots_keep_what_is_held() {
    for run in configurations() {
        let mut whole = start(&run, &cube(STIFF));
        let hand = grab(&mut whole, &Grip::default());
        whole.move_grab(hand, DVec3::new(0.05, 0.06, 0.12)).unwrap();
        whole.advance(30).unwrap();
        let kept = Snapshot::from_bytes(&whole.snapshot().unwrap().to_bytes().unwrap()).unwrap();
        let held: Vec<(GrabId, Grab)> = whole.grabs().map(|(id, grab)| (id, grab.clone())).collect();
        whole.advance(30).unwrap();
        let end = bits(&mut whole, "b");
        let mut other = start(&run, &cube(STIFF));
        other.restore(&kept).unwrap();
        assert!(other.grabs().eq(held.iter().map(|(id, grab)| (*id, grab))), "{}", run.name);
        other.advance(30).unwrap();
        assert!(bits(&mut other, "b") == end, "{}: another way on", run.name);
        whole.release(hand).unwrap();
        whole.restore(&kept).unwrap();
        whole.advance(30).unwrap();
        assert!(bits(&mut whole, "b") == end, "{}: no way back", run.name);
        whole.reset().unwrap();
        assert_eq!(whole.grabs().count(), 0);
    }
}

/// Sixteen hundred times as stiff as the gentle one: ω Δt = 2 by itself, beyond the stable step with the body's own.
#[test]
fn a_stiff_hand_is_stable_where_the_step_follows_and_refused_where_it_does_not() {
    for run in configurations() {
        let mut simulation = start(&run, &cube(STIFF));
        let first = simulation.time_step();
        let gentle = grab(&mut simulation, &Grip::default());
        let stiffness = 1600.0 * simulation.grabs().next().unwrap().1.stiffness;
        simulation.release(gentle).unwrap();
        let stiff = Grip { stiffness: Some(stiffness), ..Grip::default() };
        let hand = grab(&mut simulation, &stiff);
        for place in 1..=50 {
            simulation.move_grab(hand, DVec3::new(0.05, 0.05, 0.1 + 1e-4 * f64::from(place))).unwrap();
            simulation.advance_to(0.005 * f64::from(place)).unwrap();
        }
        simulation.advance_to(0.5).unwrap();
        assert!(simulation.time_step() < 0.8 * first, "{}: {} of {first}", run.name, simulation.time_step());
        let far = simulation.displacements("b").unwrap().iter().fold(0.0_f64, |far, u| far.max(u.length()));
        assert!(far < 0.02, "{}: {far} m", run.name);

        let mut held = start(&run, &cube(&format!("{STIFF}, integration: (when_unstable: Watch)")));
        let pick = held.pick(DVec3::new(0.05, 0.05, 1.0), -DVec3::Z).unwrap().unwrap();
        let stiff = Grip { stiffness: Some(10.0 * stiffness), ..stiff };
        let refused = held.grab(&pick, &stiff).unwrap_err().to_string();
        assert!(refused.contains("so stiff a grip"), "{refused}");
        assert_eq!(held.grabs().count(), 0);
        held.advance(10).unwrap();
    }
}

/// A step that had become shorter for a stiff grip is as long as before when the hand has let go.
#[test]
fn the_step_grows_again_when_a_stiff_hand_lets_go() {
    for run in configurations() {
        let mut simulation = start(&run, &cube(STIFF));
        let first = simulation.time_step();
        let gentle = grab(&mut simulation, &Grip::default());
        let stiffness = simulation.grabs().next().unwrap().1.stiffness;
        simulation.release(gentle).unwrap();
        for times in [600.0, 1600.0, 20000.0] {
            let hand = grab(&mut simulation, &Grip { stiffness: Some(times * stiffness), ..Grip::default() });
            simulation.advance_to(simulation.time() + 0.05).unwrap();
            let held = simulation.time_step();
            assert!(held < 0.92 * first, "{}: {held} of {first}", run.name);
            simulation.release(hand).unwrap();
            simulation.advance_to(simulation.time() + 0.2).unwrap();
            let after = simulation.time_step();
            assert!(after > 0.94 * first, "{}, {times}: {held}, then {after} of {first}", run.name);
        }
    }
}

#[test]
fn what_cannot_be_held_says_why() {
    let run = &configurations()[0];
    assert_eq!(run.options.precision, Precision::F64);
    let mut none = run.start(&cube(STIFF));
    let pick = none.pick(DVec3::new(0.05, 0.05, 1.0), -DVec3::Z).unwrap().unwrap();
    let told = |result: Result<GrabId, sinew::Error>| result.unwrap_err().to_string();
    assert!(told(none.grab(&pick, &Grip::default())).contains("grabs: true"));
    let mut simulation = start(run, &cube(STIFF));
    for grip in [
        Grip { stiffness: Some(f64::NAN), ..Grip::default() },
        Grip { stiffness: Some(0.0), ..Grip::default() },
        Grip { damping: Some(-1.0), ..Grip::default() },
        Grip { most_force: 0.0, ..Grip::default() },
    ] {
        assert!(told(simulation.grab(&pick, &grip)).contains("must be above 0"), "{grip:?}");
    }
    // no step is left with that
    let stiff = told(simulation.grab(&pick, &Grip { stiffness: Some(1e30), ..Grip::default() }));
    assert!(stiff.contains("so stiff a grip") && stiff.contains("hold more softly"), "{stiff}");
    simulation.advance(3).unwrap();
    assert!(told(simulation.grab_nodes("b", &[(99, 1.0)], &Grip::default())).contains("99"));
    assert!(told(simulation.grab_nodes("b", &[(0, -1.0)], &Grip::default())).contains("0 or above"));
    let edge = [(0, 0.5), (1, 0.5)];
    let hands: Vec<GrabId> = (0..32).map(|_| simulation.grab_nodes("b", &edge, &Grip::default()).unwrap()).collect();
    assert!(told(simulation.grab(&pick, &Grip::default())).contains("at most 64 nodes"));
    assert!(simulation.move_grab(hands[0], DVec3::NAN).is_err());
    hands.into_iter().for_each(|hand| simulation.release(hand).unwrap());
    simulation.grab(&pick, &Grip::default()).unwrap();
}
