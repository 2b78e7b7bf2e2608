//! Inputs: what a program sets between steps acts as a curve of the same values would, and is recorded, replayed and
//! kept bit for bit.

use crate::configurations::{configurations, near, scene_of};
use crate::grids::bits;
use sinew::systems::Registry;
use sinew::{InputRecording, Options, Simulation, Snapshot};
use std::path::Path;

/// A cube that stands on a plate, with what the tests ask for.
pub fn cube(acts: &str, further: &str) -> String {
    format!(
        "(duration: 0.2, bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (3, 3, 3)), material: \"m\")}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45), damping: 20)}},
        {acts}, {further})"
    )
}

/// Loads and a motion that follow curves.
pub fn followed(push: &str, motion: &str) -> String {
    format!(
        "constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0)), Prescribed(on: Plane(normal: (0, 0, 1), at: 0.1),
            axes: [Z], displacement: (0, 0, -0.002), curve: {motion})],
        loads: [Pressure(on: Surface(normal: (1, 0, 0)), pressure: 200, curve: {push}),
            NodalForce(on: Plane(normal: (1, 0, 0), at: 0), force: (0.001, 0, 0), curve: {push})]"
    )
}

pub const TOOL: &str = "Input(name: \"tool\", initial: 0, rate: 16)";
pub const PUSH: &str = "Input(name: \"push\", initial: 0.25)";

/// How far the plate on top has gone (m).
fn plate(simulation: &mut Simulation) -> f64 {
    let rest = simulation.rest_positions("b").unwrap();
    let top = rest.iter().position(|x| x.z > 0.0999).unwrap();
    simulation.displacements("b").unwrap()[top].z
}

#[test]
fn an_input_gives_the_bits_of_a_curve_of_the_same_values() {
    // half way to 1 from the start, back from there; pushes jump at the same times
    let dt = 4.8828125e-4; // 2^-11 s: times of steps are exact
    let step = format!("integration: (step: {dt:?})");
    let tool = "Table([(0, 0), (0.03125, 0.5), (0.046875, 0.25)])";
    for run in configurations() {
        let mut told = run.start(&cube(&followed("Step(start: 0, end: 0.03125)", tool), &step));
        let mut set = run.start(&cube(&followed(PUSH, TOOL), &step));
        set.set_input("tool", 1.0).unwrap();
        set.set_input("push", 1.0).unwrap();
        set.advance(64).unwrap();
        set.set_input("tool", 17.0).unwrap();
        set.set_input("tool", 0.25).unwrap();
        set.set_input("push", 0.0).unwrap();
        set.advance(200).unwrap();
        told.advance(264).unwrap();
        assert!(bits(&mut set, "b") == bits(&mut told, "b"), "{}: other bits", run.name);
        near("the plate is", plate(&mut set), -0.0005, 0.0005, 1e-6);
    }
}

/// Of half a window of the old value and half of the new one, and not of the new one alone.
#[test]
fn a_load_acts_with_the_mean_over_its_step() {
    for run in configurations() {
        let acts = "loads: [Gravity(acceleration: (0, 0, 8), curve: Input(name: \"g\"))]";
        let mut simulation = run.start(&cube(acts, "integration: (step: 0.0009765625)"));
        simulation.advance(8).unwrap();
        simulation.set_input("g", 1.0).unwrap();
        simulation.advance(1).unwrap();
        let dt = simulation.time_step();
        let rise = simulation.displacements("b").unwrap()[0].z;
        // v⁺ = g Δt/2 where the damping of one step takes αΔt/2 of it
        near(run.name, rise, 0.5 * 8.0 * dt * dt / (1.0 + 0.5 * 20.0 * dt), 8.0 * dt * dt, 1e-6);
    }
}

/// What is set anew before a step counts from where the input was, though steps were asked for meanwhile of which none
/// fitted; and so it is recorded.
#[test]
fn an_input_set_anew_before_a_step_has_the_bits_of_its_last_value() {
    for run in configurations() {
        let acts = "loads: [Gravity(acceleration: (0, 0, 8), curve: Input(name: \"g\"))]";
        let text = cube(acts, "integration: (step: 0.0009765625)");
        let of = |before: &[f64]| {
            let mut simulation = run.start(&text);
            simulation.record_inputs();
            simulation.advance(8).unwrap();
            for &value in before {
                simulation.set_input("g", value).unwrap();
                let within = simulation.time() + 0.5 * simulation.time_step();
                simulation.advance_short_of(within, 10).unwrap();
                assert_eq!(simulation.step_count(), 8);
            }
            simulation.set_input("g", 0.25).unwrap();
            simulation.advance(5).unwrap();
            simulation
        };
        let (mut once, anew) = (of(&[]), of(&[1.0, -2.0]));
        assert!(once.displacements("b").unwrap()[0].z > 1e-7, "{}: nothing rises", run.name);
        let recording = anew.recorded_inputs().cloned().unwrap();
        assert_eq!(recording.changes.len(), 1);
        let mut again = run.start(&text);
        again.replay_inputs(&recording).unwrap();
        again.advance(13).unwrap();
        let once = once.snapshot().unwrap();
        for mut other in [anew, again] {
            assert_eq!(other.snapshot().unwrap().differences(&once), Vec::<String>::new(), "{}", run.name);
        }
    }
}

#[test]
fn a_prescribed_motion_follows_no_faster_than_the_rate() {
    for run in configurations() {
        let mut simulation = run.start(&cube(&followed(PUSH, TOOL), ""));
        let (mut before, mut fastest) = (0.0, 0.0_f64);
        for goal in [1.0, -5.0, 3.0, 0.9, 1.0] {
            simulation.set_input("tool", goal).unwrap();
            for _ in 0..5 {
                simulation.advance(1).unwrap();
                let tool = &simulation.inputs()[0];
                assert_eq!((tool.name.as_str(), tool.target, tool.rate), ("tool", goal, Some(16.0)));
                let value = tool.value;
                near("the plate is", plate(&mut simulation), -0.002 * value, 0.002, run.bound(1e-9, 1e-6));
                fastest = fastest.max((value - before).abs() / simulation.time_step());
                before = value;
            }
        }
        near("fastest", fastest, 16.0, 16.0, 1e-6);
    }
}

/// Sets inputs at odd times and in odd pieces, as a hand would; where the run stands at the end.
fn played(simulation: &mut Simulation) {
    let mut dice = fastrand::Rng::with_seed(3);
    for place in 0..40 {
        let push = -1.5 * dice.f64();
        simulation.set_input("push", push).unwrap();
        if place % 3 == 0 {
            simulation.set_input("tool", 1.5 * dice.f64() * f64::from(place) / 40.0).unwrap();
        }
        match place % 2 {
            0 => simulation.advance(dice.u64(1..9)).unwrap(),
            _ => simulation.advance_to(simulation.time() + 2e-3 * dice.f64()).unwrap(),
        }
    }
}

#[test]
fn a_recording_replayed_gives_the_same_bits() {
    for run in configurations() {
        let text = cube(&followed(PUSH, TOOL), "");
        let mut hand = run.start(&text);
        hand.record_inputs();
        played(&mut hand);
        let recording = hand.stop_recording_inputs().unwrap();
        assert!(recording.changes.len() > 45, "{} changes", recording.changes.len());
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("touch.ron");
        recording.write(&path).unwrap();
        let json = serde_json::to_string(&recording).unwrap();
        assert!(serde_json::from_str::<InputRecording>(&json).unwrap() == recording, "JSON loses bits");
        let read = InputRecording::read(&path).unwrap();
        assert!(read == recording, "RON loses bits");

        let mut again = run.start(&text);
        again.replay_inputs(&read).unwrap();
        again.record_inputs();
        again.advance(hand.step_count()).unwrap();
        assert!(bits(&mut again, "b") == bits(&mut hand, "b"), "{}: other bits", run.name);
        assert_eq!((again.time(), again.time_step()), (hand.time(), hand.time_step()), "{}", run.name);
        assert!(again.recorded_inputs() == Some(&recording), "{}: another recording", run.name);
        // what is not replayed goes elsewhere
        let mut other = run.start(&text);
        other.advance(hand.step_count()).unwrap();
        assert!(bits(&mut other, "b") != bits(&mut hand, "b"));
    }
}

/// Stability checks come at the same steps however steps are asked for, beside a load that quickens later.
#[test]
fn a_recording_of_steps_towards_times_is_replayed_by_their_number() {
    for run in configurations() {
        let later = "loads: [Gravity(acceleration: (0, 0, -3), curve: Smooth(start: 0.06, end: 0.12)),";
        let text = cube(&followed(PUSH, TOOL).replace("loads: [", later), "");
        let mut hand = run.start(&text);
        hand.record_inputs();
        for place in 1..=60 {
            // as fast as it will ever be at first: what comes later only moves it
            let (push, tool) = if place == 1 { (-2.0, 1.0) } else { (-2.0 + 0.02 * f64::from(place), 0.5) };
            hand.set_input("push", push).unwrap();
            hand.set_input("tool", tool).unwrap();
            hand.advance_to(0.0021 * f64::from(place)).unwrap();
        }
        // a time that lay within a step took none: what was set before is taken up by now
        hand.advance(1).unwrap();
        let recording = hand.stop_recording_inputs().unwrap();
        let mut again = run.start(&text);
        again.replay_inputs(&recording).unwrap();
        again.advance(hand.step_count()).unwrap();
        let (hand, again) = (hand.snapshot().unwrap(), again.snapshot().unwrap());
        assert_eq!(again.differences(&hand), Vec::<String>::new(), "{}", run.name);
    }
}

/// A snapshot of another run, even of the same step, is nothing that the recording leads to.
#[test]
fn a_recording_does_not_go_on_from_another_run() {
    let run = &configurations()[0];
    let text = cube(&followed(PUSH, TOOL), "");
    let pushed = |push: f64| {
        let mut simulation = run.start(&text);
        simulation.record_inputs();
        simulation.advance(5).unwrap();
        simulation.set_input("push", push).unwrap();
        simulation.advance(15).unwrap();
        simulation
    };
    let (mut one, mut other) = (pushed(1.0), pushed(0.5));
    let (own, foreign) = (one.snapshot().unwrap(), other.snapshot().unwrap());
    one.advance(10).unwrap();
    one.restore(&own).unwrap();
    assert_eq!((one.recorded_inputs().unwrap().from, one.recorded_inputs().unwrap().changes.len()), (0, 1));
    one.advance(10).unwrap();
    one.restore(&foreign).unwrap();
    assert_eq!((one.recorded_inputs().unwrap().from, one.recorded_inputs().unwrap().changes.len()), (20, 0));
    // going back ends what is replayed
    let recording = other.stop_recording_inputs().unwrap();
    let mut again = run.start(&text);
    again.replay_inputs(&recording).unwrap();
    again.advance(2).unwrap();
    again.reset().unwrap();
    again.advance(20).unwrap();
    assert_eq!(again.inputs()[1].target, 0.25);
}

#[test]
fn snapshots_keep_inputs() {
    for run in configurations() {
        let text = cube(&followed(PUSH, TOOL), "");
        let mut whole = run.start(&text);
        whole.record_inputs();
        whole.advance(5).unwrap();
        whole.set_input("tool", 1.0).unwrap();
        whole.set_input("push", -1.0).unwrap();
        // on its way, and with a value that no step has taken up yet
        whole.advance(4).unwrap();
        whole.set_input("push", 0.75).unwrap();
        let kept = Snapshot::from_bytes(&whole.snapshot().unwrap().to_bytes().unwrap()).unwrap();
        let inputs = whole.inputs();
        assert!(inputs[0].value > 0.0 && inputs[0].value < 1.0, "{inputs:?}");
        whole.advance(100).unwrap();
        let (end, recorded) = (bits(&mut whole, "b"), whole.recorded_inputs().cloned());

        let mut other = run.start(&text);
        other.set_input("push", 9.0).unwrap();
        other.restore(&kept).unwrap();
        assert_eq!(other.inputs(), inputs);
        other.advance(100).unwrap();
        assert!(bits(&mut other, "b") == end, "{}: another way on", run.name);
        // back in the same one: what was recorded since is recorded anew
        whole.restore(&kept).unwrap();
        whole.advance(100).unwrap();
        assert!(bits(&mut whole, "b") == end, "{}: no way back", run.name);
        assert_eq!(whole.recorded_inputs().cloned(), recorded);
        assert_eq!(recorded.unwrap().changes.iter().map(|change| change.step).collect::<Vec<_>>(), [5, 5, 9]);
    }
}

#[test]
fn an_input_of_a_static_analysis_is_set_before_it_begins() {
    let acts = |curve: &str| {
        format!(
            "analysis: Static(), constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))],
            loads: [Gravity(acceleration: (0, 0, -4), curve: {curve})]"
        )
    };
    for run in configurations() {
        let mut told = run.start(&cube(&acts("Table([(0, 0.75)])"), ""));
        let mut set = run.start(&cube(&acts("Input(name: \"g\", rate: 0.001)"), ""));
        set.set_input("g", 0.75).unwrap();
        told.finish().unwrap();
        set.finish().unwrap();
        assert!(bits(&mut set, "b") == bits(&mut told, "b"), "{}: another rest", run.name);
        assert!(set.set_input("g", 1.0).unwrap_err().to_string().contains("before its first step"));
        let later = "(from: 0, changes: [(step: 0, name: \"g\", value: 0.75), (step: 3, name: \"g\", value: 1)])";
        let mut replayed = run.start(&cube(&acts("Input(name: \"g\")"), ""));
        let refused = replayed.replay_inputs(&InputRecording::from_ron(later).unwrap()).unwrap_err().to_string();
        assert!(refused.contains("at step 3: a static analysis"), "{refused}");
    }
}

#[test]
fn what_cannot_be_set_or_replayed_says_why() {
    let file = scene_of(&cube(&followed(PUSH, TOOL), ""), Path::new("."));
    let mut simulation = Simulation::new(&file, &Options::default()).unwrap();
    let told = |result: Result<(), sinew::Error>| result.unwrap_err().to_string();
    let unknown = told(simulation.set_input("tol", 1.0));
    assert_eq!(unknown, "there is no input named \"tol\"; there is tool, push");
    for value in [f64::NAN, f64::INFINITY, 1e39, -1e308] {
        assert!(told(simulation.set_input("tool", value)).contains("must be a finite number"));
    }
    let wrong = |text: &str| InputRecording::from_ron(text).unwrap();
    let refused = |simulation: &mut Simulation, text: &str| told(simulation.replay_inputs(&wrong(text)));
    let unknown = refused(&mut simulation, "(from: 0, changes: [(step: 1, name: \"x\", value: 1)])");
    assert!(unknown.contains("tool, push"), "{unknown}");
    let back = "(from: 0, changes: [(step: 3, name: \"tool\", value: 1), (step: 2, name: \"tool\", value: 2)])";
    assert!(refused(&mut simulation, back).contains("at step 2"));
    let later = refused(&mut simulation, "(from: 4, changes: [(step: 4, name: \"tool\", value: 1)])");
    assert!(later.contains("began after 4 steps"), "{later}");
    assert!(InputRecording::from_ron("(from: 0, changs: [])").unwrap_err().to_string().contains("changs"));
    // of several changes at one step the last counts
    let twice = "(from: 0, changes: [(step: 0, name: \"tool\", value: 3), (step: 0, name: \"push\", value: 1),
        (step: 0, name: \"tool\", value: 0.5)])";
    simulation.replay_inputs(&wrong(twice)).unwrap();
    simulation.advance(1).unwrap();
    assert_eq!(simulation.inputs()[0].target, 0.5);
    assert_eq!(simulation.inputs()[1].target, 1.0);
    // uses tell what is multiplied
    let uses: Vec<_> = simulation.inputs().into_iter().flat_map(|input| input.uses).map(|u| (u.path, u.unit)).collect();
    let expected = [("constraints[1].curve", "m"), ("loads[0].curve", "Pa"), ("loads[1].curve", "N")];
    assert_eq!(uses, expected.map(|(path, unit)| (path.to_string(), Some(unit))));
    // and a scene without inputs says how there would be one
    let file = scene_of(&cube("loads: []", ""), Path::new("."));
    let mut none = Simulation::new(&file, &Options::default()).unwrap();
    assert!(told(none.set_input("tool", 1.0)).contains("curve: Input(name: \"tool\")"));
}

/// What tools and threads follow is told as what loads and motions do.
#[test]
fn inputs_of_tools_and_threads_tell_what_they_multiply() {
    let acts = "tools: {\"t\": (shape: Tube(length: 0.05, inner: 0.01, outer: 0.012), at: (0.05, 0.05, 0.11))},
        suction: [(tool: \"t\", pressure: 100, reach: 0.02, curve: Input(name: \"i\"))],
        removal: [(on: Elements([0]), when: InTool(tool: \"t\", reach: 0.02, rate: 1e-9, curve: Input(name: \"i\"))),
            (on: Elements([1]),
                when: InTool(tool: \"t\", reach: 0.02, threshold: StretchAbove(2), curve: Input(name: \"i\")))],
        attachments: [Grasp(tool: \"t\", on: Nodes([0]), closed: Input(name: \"i\")),
            Suture(from: (at: (0, 0, 0)), to: (at: (0.1, 0.1, 0.1)), stiffness: 1, tighten: 1e-3,
                curve: Input(name: \"i\"))]";
    let simulation = Simulation::new(&scene_of(&cube(acts, ""), Path::new(".")), &Options::default()).unwrap();
    let uses: Vec<_> =
        simulation.inputs().into_iter().flat_map(|input| input.uses).map(|u| (u.path, u.of, u.unit)).collect();
    let expected = [
        ("removal[0].when.curve", "rate", "m³/s"),
        ("removal[1].when.curve", "threshold", "1"),
        ("suction[0].curve", "pressure", "Pa"),
        ("attachments[0].closed", "closed", "1"),
        ("attachments[1].curve", "tighten", "m"),
    ];
    assert_eq!(uses, expected.map(|(path, of, unit)| (path.to_string(), of, Some(unit))));
}

/// The same name is the same input; a rate is above 0; a motion that may jump is warned of.
#[test]
fn wrong_inputs_are_told_with_what_is_allowed() {
    let told = |push: &str, motion: &str| {
        let file = scene_of(&cube(&followed(push, motion), ""), Path::new("."));
        Simulation::check(&file, &Registry::default()).render(false)
    };
    assert!(!told(PUSH, TOOL).contains("input"));
    for (push, motion, expected) in [
        ("Input(name: \"tool\", initial: 1, rate: 16)", TOOL, "`initial` must be 0, as before, found 1"),
        ("Input(name: \"tool\", rate: 5)", TOOL, "`rate` must be 16, as before, found 5"),
        ("Input(name: \"tool\")", TOOL, "`rate` must be 16, as before, found none"),
        ("Input(name: \"\")", TOOL, "an input needs a name"),
        ("Input(name: \"a\", rate: -1)", TOOL, "`rate` must be above 0, found -1"),
        (PUSH, "Input(name: \"b\")", "an input without `rate` moves nodes all at once"),
        (PUSH, "Input(name: \"b\", initial: 1, rate: 3)", "an input that is not 0 at first"),
    ] {
        let found = told(push, motion);
        assert!(found.contains(expected), "{push}, {motion}: {found}");
    }
    // who begins there is not moved there
    let at_rest = cube(&followed(PUSH, "Input(name: \"b\", initial: 1, rate: 3)"), "start: Equilibrium()");
    let file = scene_of(&at_rest, Path::new("."));
    assert!(!Simulation::check(&file, &Registry::default()).render(false).contains("an input that"));
}
