//! Going back, and going on for as long as there is time.

use crate::configurations::configurations;
use crate::grids::bits;
use sinew::{Ended, Options, Simulation};
use std::time::Duration;

/// With history in its material, elements that go, and an input.
fn scene() -> String {
    "(duration: 100, bodies: {\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (3, 3, 3)), material: \"m\", spin: (0.1, 0.2, 0.3))},
    materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45), damping: 2,
        prony: (terms: [(alpha: 0.3, tau: 0.05)]))},
    constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))],
    loads: [Gravity(acceleration: (0.3, 0, -1), curve: Input(name: \"g\", initial: 1, rate: 100))],
    removal: [(on: Box(min: (0.06, 0, 0), max: (0.1, 0.1, 0.1)), when: During(start: 0.005, end: 0.06))])"
        .into()
}

fn play(simulation: &mut Simulation) -> Vec<[u64; 3]> {
    simulation.advance(20).unwrap();
    simulation.set_input("g", -0.5).unwrap();
    simulation.advance(60).unwrap();
    bits(simulation, "b")
}

#[test]
fn reset_gives_the_first_run_again() {
    for run in configurations() {
        let mut simulation = run.start(&scene());
        let rest = bits(&mut simulation, "b");
        let first = play(&mut simulation);
        let removed = simulation.summary("").unwrap().removed_elements;
        assert!(removed > 0);
        simulation.set_input("g", 7.0).unwrap();
        simulation.reset().unwrap();
        assert_eq!((simulation.step_count(), simulation.inputs()[0].target), (0, 1.0));
        assert!(bits(&mut simulation, "b") == rest, "{}: another start", run.name);
        assert!(play(&mut simulation) == first, "{}: another run", run.name);
        assert_eq!(simulation.summary("").unwrap().removed_elements, removed);
    }
}

#[test]
fn a_start_that_was_not_kept_cannot_be_gone_back_to() {
    let run = &configurations()[0];
    let file = crate::configurations::scene_of(&scene(), std::path::Path::new("."));
    let options = Options { forgets_start: true, ..run.options.clone() };
    let mut simulation = Simulation::new(&file, &options).unwrap();
    simulation.advance(3).unwrap();
    assert!(simulation.reset().unwrap_err().to_string().contains("forgets_start"));
}

#[test]
fn rewinding_and_going_on_gives_the_same_bits_within_the_bytes_that_are_allowed() {
    for run in configurations() {
        let mut simulation = run.start(&scene());
        let one = simulation.snapshot().unwrap().size();
        assert!(simulation.keep_history(0.01, one / 2).unwrap_err().to_string().contains("one state has"));
        simulation.keep_history(0.01, 4 * one + one / 2).unwrap();
        simulation.advance_to(0.055).unwrap();
        simulation.set_input("g", -0.5).unwrap();
        simulation.advance_to(0.085).unwrap();
        let (steps, end) = (simulation.step_count(), bits(&mut simulation, "b"));
        // the oldest have gone: at most four are left
        let kept = simulation.history();
        assert!((3..=4).contains(&kept.len()) && kept[0] > 0.035, "{}: {kept:?}", run.name);
        let back = simulation.rewind(0.075).unwrap();
        assert!(back <= 0.075 && 0.075 - back < 0.01 + 2.0 * simulation.time_step(), "{}: {back}", run.name);
        assert_eq!((simulation.time(), simulation.history().last().copied()), (back, Some(back)));
        simulation.advance(steps - simulation.step_count()).unwrap();
        assert!(bits(&mut simulation, "b") == end, "{}: another way on", run.name);
        // what lies before the oldest is the start only
        assert_eq!(simulation.rewind(0.0).unwrap(), 0.0);
        assert_eq!((simulation.step_count(), simulation.history().len()), (0, 0));
        assert!(simulation.rewind(-1.0).unwrap_err().to_string().contains("no state at or before"));
    }
}

/// What was never so, since it was gone back, is not gone back to.
#[test]
fn going_back_forgets_what_came_later() {
    for run in configurations() {
        let mut simulation = run.start(&scene());
        let first = simulation.snapshot().unwrap();
        simulation.keep_history(0.01, 1 << 30).unwrap();
        simulation.advance_to(0.03).unwrap();
        simulation.set_input("g", -0.5).unwrap();
        simulation.advance_to(0.035).unwrap();
        let middle = simulation.snapshot().unwrap();
        simulation.advance_to(0.065).unwrap();
        let all = simulation.history();
        let past = all.iter().filter(|time| **time <= middle.time()).count();
        assert!(past > 2 && past < all.len(), "{all:?}");
        simulation.restore(&middle).unwrap();
        assert_eq!(simulation.history(), all[..past], "{}", run.name);
        // a state of another run is no past of this one
        let mut other = run.start(&scene());
        other.set_input("g", 0.25).unwrap();
        other.advance_to(0.02).unwrap();
        simulation.restore(&other.snapshot().unwrap()).unwrap();
        assert!(simulation.history().is_empty(), "{}: {:?}", run.name, simulation.history());
        simulation.advance_to(0.035).unwrap();
        assert_eq!(simulation.history().len(), 2);
        simulation.reset().unwrap();
        assert!(simulation.history().is_empty());
        // and the start is that before the first check, whoever took the first step
        let start = simulation.snapshot().unwrap();
        assert_eq!(start.differences(&first), Vec::<String>::new(), "{}", run.name);
    }
}

#[test]
fn a_run_that_began_from_equilibrium_is_reset_to_that() {
    let scene =
        scene().replace("(duration", "(start: Equilibrium(), duration").replace(", spin: (0.1, 0.2, 0.3)", "").replace(
            "removal: [(on: Box(min: (0.06, 0, 0), max: (0.1, 0.1, 0.1)), when: During(start: 0.005, end: 0.06))]",
            "",
        );
    for run in configurations() {
        let mut simulation = run.start(&scene);
        simulation.keep_history(0.005, 1 << 30).unwrap();
        let rest = bits(&mut simulation, "b");
        let first = play(&mut simulation);
        simulation.reset().unwrap();
        assert_eq!((simulation.step_count(), simulation.inputs()[0].target), (0, 1.0));
        assert!(bits(&mut simulation, "b") == rest, "{}: another start", run.name);
        assert_eq!(simulation.history(), [0.0]);
        assert!(play(&mut simulation) == first, "{}: another run", run.name);
    }
}

/// Where there is room for barely one state, states that have grown since are kept all the same, one at a time.
#[test]
fn the_newest_state_is_kept_whatever_it_takes() {
    let mut simulation = configurations()[0].start(&scene());
    let one = simulation.snapshot().unwrap().size();
    simulation.keep_history(0.01, one).unwrap();
    simulation.advance_to(0.055).unwrap();
    assert!(simulation.snapshot().unwrap().size() > one, "the state has not grown: nothing is shown");
    let kept = simulation.history();
    assert!(kept.len() == 1 && kept[0] > 0.045, "{kept:?}");
}

/// States more often than steps are states at every step.
#[test]
fn a_state_at_every_step() {
    let mut simulation = configurations()[0].start(&scene());
    simulation.keep_history(1e-9, 1 << 30).unwrap();
    simulation.advance(5).unwrap();
    assert_eq!(simulation.history().len(), 5);
}

#[test]
fn a_budget_takes_what_fits_and_one_step_at_least() {
    for run in configurations() {
        let mut simulation = run.start(&scene());
        let none = simulation.advance_for(Duration::ZERO, 1.0).unwrap();
        assert_eq!((none.steps, none.why), (1, Ended::Budget));
        let budget = Duration::from_millis(30);
        let some = simulation.advance_for(budget, f64::INFINITY).unwrap();
        assert_eq!((some.why, simulation.step_count()), (Ended::Budget, 1 + some.steps));
        // batches take half of what is left, as far as steps take what they took before: the first is not all of them
        let mut times = (0..20).map(|_| simulation.advance_for(budget, f64::INFINITY).unwrap());
        assert!(times.any(|some| some.longest_batch < some.took.mul_f64(0.75)), "{}: {some:?}", run.name);
        assert!(some.simulated > 0.0 && some.real_time_factor() > 0.0);
        // a time that is reached ends it, to the step
        let mut simulation = run.start(&scene());
        let until = 0.02;
        let all = simulation.advance_for(Duration::from_secs(3600), until).unwrap();
        assert_eq!(all.why, Ended::Reached);
        let mut other = run.start(&scene());
        other.advance_to(until).unwrap();
        assert_eq!((other.step_count(), other.time()), (all.steps, simulation.time()), "{}", run.name);
        assert!(bits(&mut other, "b") == bits(&mut simulation, "b"), "{}: other bits", run.name);
        assert!(simulation.advance_for(budget, f64::NAN).is_err());
    }
}
