//! The driver: commands in, states out, whatever becomes of the simulation.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use sinew::driver::{Command, Driver, FrameDriver, Session, State};
use sinew::glam::DVec3;
use sinew::scene::schema::OutputField;
use sinew::{BackendChoice, Options, SceneFile, Simulation};
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

const FRAME: Duration = Duration::from_millis(16);
/// More than any frame of these scenes takes, on a busy machine too.
const AMPLE: Duration = Duration::from_secs(20);

fn scene(further: &str) -> Box<SceneFile> {
    held("", further)
}

/// The same of eight elements.
fn coarse(further: &str) -> Box<SceneFile> {
    let cells = ["bodies.b.mesh.cells=(2, 2, 2)".to_string()];
    Box::new(SceneFile::from_text("test.ron", scene(further).text(), Path::new(""), &cells).unwrap())
}

/// Held below, and by more constraints.
fn held(more: &str, further: &str) -> Box<SceneFile> {
    let text = format!(
        "(duration: 2, bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (3, 3, 3), elements: Hex8), material: \"m\")}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}},
        constraints: [Fixed(on: Set(\"z0\")){more}], {further})"
    );
    Box::new(SceneFile::from_text("test.ron", &text, Path::new(""), &[]).unwrap())
}

/// Gravity by an input, which is 1 at first, with what makes energies counted and a probe.
const FALL: &str = "loads: [Gravity(acceleration: (0, 0, -9.81), curve: Input(name: \"weight\", initial: 1))],
    integration: (step: 1e-3), output: (energies_every: 0.01),
    probes: {\"top\": (what: Displacement, on: Set(\"z1\"), every: 0.01)}";

fn options() -> Options {
    Options { backend: BackendChoice::Cpu, threads: 1, ..Options::default() }
}

fn session(further: &str) -> Session {
    let mut session = Session::new(options());
    session.command(Command::Load(scene(further)));
    session
}

fn bits(state: &State) -> Vec<u32> {
    state.bodies.iter().flat_map(|body| body.positions.as_flattened()).map(|number| number.to_bits()).collect()
}

#[test]
fn commands_go_in_and_states_come_out_of_a_thread() {
    let driver = Driver::start(options(), || ());
    assert!(driver.state().loaded.is_none());
    let done = |driver: &Driver| -> Arc<State> {
        let started = Instant::now();
        while driver.is_behind() {
            assert!(started.elapsed() < AMPLE && !driver.has_ended(), "the thread does not answer");
            std::thread::sleep(Duration::from_millis(1));
        }
        driver.state()
    };
    driver.send(Command::Step(1));
    assert!(done(&driver).refusal.as_ref().unwrap().reason.contains("no scene"));
    driver.send(Command::Load(scene(FALL)));
    driver.send(Command::Field(Some(OutputField::VonMises)));
    driver.send(Command::Step(20));
    let state = done(&driver);
    let loaded = state.loaded.as_ref().unwrap();
    assert_eq!((state.step, state.running, loaded.bodies[0].rest.len()), (20, false, 64));
    assert_eq!((state.bodies[0].values.len(), state.bodies[0].components), (27, 1));
    assert!(state.bodies[0].values.iter().any(|stress| *stress > 0.0));
    assert!(state.probes[0][2] < 0.0 && state.energies.kinetic > 0.0);
    assert_eq!(loaded.bodies[0].constrained.iter().filter(|axes| **axes == 7).count(), 16);
    driver.send(Command::Run);
    let started = Instant::now();
    while driver.state().time < 0.05 {
        assert!(started.elapsed() < AMPLE);
        std::thread::sleep(Duration::from_millis(2));
    }
    driver.send(Command::Pause);
    assert!(!done(&driver).running);
}

#[test]
fn a_pause_keeps_the_bits_and_back_at_the_start_they_are_those_of_the_first_run() {
    let mut session = session(FALL);
    session.command(Command::Step(30));
    let (before, first) = (bits(&session.state()), session.state().bodies[0].topology);
    session.command(Command::Run);
    session.command(Command::Pause);
    for _ in 0..3 {
        session.advance(FRAME, AMPLE);
    }
    assert_eq!((bits(&session.state()), session.state().bodies[0].topology), (before.clone(), first));
    session.command(Command::Input { name: "weight".into(), value: -3.0 });
    session.command(Command::Step(30));
    assert_ne!(bits(&session.state()), before);
    session.command(Command::Reset);
    assert_eq!((session.state().step, session.state().inputs[0].value), (0, 1.0));
    session.command(Command::Step(30));
    assert_eq!(bits(&session.state()), before);
    // states are kept each hundredth of a second
    session.command(Command::Step(30));
    let state = session.state();
    assert!(state.history.len() > 4, "{:?}", state.history);
    session.command(Command::Rewind(0.0301));
    assert!((session.state().time - 0.03).abs() < 1e-9, "{}", session.state().time);
    assert_eq!(bits(&session.state()), before);
}

#[test]
fn a_state_that_was_kept_elsewhere_is_gone_on_from() {
    let mut session = session(FALL);
    session.command(Command::Step(40));
    let kept = session.simulation().unwrap().snapshot().unwrap();
    session.command(Command::Step(10));
    let wanted = bits(&session.state());
    let (origin, direction) = (DVec3::new(0.05, 0.05, 1.0), DVec3::NEG_Z);
    let mut other = Session::new(options());
    other.command(Command::Load(scene(FALL)));
    other.command(Command::Grab { hand: 1, origin, direction });
    other.command(Command::Restore(Box::new(kept.clone())));
    assert!(other.state().refusal.is_none() && other.state().held.is_empty());
    assert_eq!((other.state().step, other.state().time), (40, kept.time()));
    other.command(Command::Step(10));
    assert_eq!(bits(&other.state()), wanted);
    // what has no columns for hands is gone on from without
    let mut plain = Simulation::new(&scene(FALL), &options()).unwrap();
    plain.advance(40).unwrap();
    other.command(Command::Restore(Box::new(plain.snapshot().unwrap())));
    other.command(Command::Step(10));
    assert_eq!((other.state().refusal, bits(&other.state())), (None, wanted));
    other.command(Command::Load(coarse(FALL)));
    other.command(Command::Restore(Box::new(kept)));
    let state = other.state();
    assert_eq!((state.refusal.map(|refusal| refusal.command), state.step), (Some("restore"), 0));
}

#[test]
fn time_goes_as_fast_as_on_the_wall_or_as_asked() {
    let mut session = session(FALL);
    session.command(Command::Run);
    for speed in [1.0, 0.25] {
        session.command(Command::Speed(speed));
        let before = session.state().time;
        (0..30).for_each(|_| session.advance(FRAME, AMPLE));
        let gone = session.state().time - before;
        // the last step of a frame may begin before it ends
        assert!((gone - speed * 0.48).abs() < 2e-3, "{speed}: {gone} s");
    }
    for wrong in [0.0, -1.0, f64::NAN] {
        session.command(Command::Speed(wrong));
        assert_eq!(session.state().refusal.map(|refusal| refusal.command), Some("speed"));
        assert_eq!(session.state().speed, 0.25);
    }
    session.command(Command::Speed(f64::INFINITY));
    assert!(session.state().refusal.is_none());
    (0..1000).for_each(|_| session.advance(FRAME, AMPLE));
    let state = session.state();
    assert!(
        state.finished && !state.running && (state.time - 2.0).abs() < 2e-3,
        "it pauses at the end: {}",
        state.time
    );
    session.command(Command::Run);
    session.advance(FRAME, Duration::from_millis(1));
    assert!(session.state().time > 2.0 + 1e-4 && session.state().running, "asked again it goes on");
}

#[test]
fn a_hand_is_not_left_standing_at_the_end_of_a_scene() {
    let from_above = |session: &mut Session, hand: u32| {
        let (origin, direction) = (DVec3::new(0.05, 0.05, 1.0), DVec3::NEG_Z);
        session.command(Command::Grab { hand, origin, direction });
    };
    let to_end = |session: &mut Session| {
        session.command(Command::Speed(100.0));
        session.command(Command::Run);
        (0..3).for_each(|_| session.advance(FRAME, AMPLE));
    };
    let mut session = session(FALL);
    from_above(&mut session, 0);
    to_end(&mut session);
    let state = session.state();
    assert!(state.running && state.time > 3.0, "what is held goes on: {} s", state.time);
    session.command(Command::Reset);
    session.command(Command::Pause);
    to_end(&mut session);
    let state = session.state();
    assert!(state.finished && !state.running && state.time < 2.01, "what is not held pauses: {} s", state.time);
    let missed = Command::Grab { hand: 1, origin: DVec3::new(5.0, 5.0, 1.0), direction: DVec3::NEG_Z };
    session.command(missed);
    assert!(!session.state().running, "who takes hold of nothing changes nothing");
    from_above(&mut session, 1);
    session.command(Command::MoveGrab { hand: 1, target: DVec3::new(0.05, 0.05, 0.12) });
    let before = session.state().time;
    session.advance(FRAME, AMPLE);
    let state = session.state();
    assert!(state.running && state.time > before && state.held[0].force.length() > 1e-3, "who takes hold then pulls");
    session.command(Command::Pause);
    from_above(&mut session, 2);
    let held = session.state().held.len();
    assert!(!session.state().running && held > 0, "who pauses it has it paused");
    session.command(Command::Grab { hand: 1, origin: DVec3::ZERO, direction: DVec3::ZERO });
    let state = session.state();
    assert!(state.refusal.is_some() && state.held.len() == held, "a ray that leads nowhere lets go of nothing");
}

#[test]
fn a_breakdown_is_a_state_and_what_comes_after_it_goes_on() {
    // its upper side goes through its lower one
    let mut session = Session::new(options());
    let crushed = ", Prescribed(on: Set(\"z1\"), displacement: (0, 0, -0.3), curve: Ramp(end: 0.3))";
    session.command(Command::Load(held(crushed, "")));
    session.command(Command::Run);
    (0..200).for_each(|_| session.advance(FRAME, AMPLE));
    let state = session.state();
    assert_eq!(state.refusal, None);
    let broken = state.breakdown.expect("it breaks down");
    assert!(broken.body == "b" && !state.running && broken.to_string().contains("broke down"));
    session.command(Command::Run);
    session.advance(FRAME, AMPLE);
    assert_eq!(session.state().refusal.map(|refusal| refusal.command), Some("run"));
    session.command(Command::Load(scene(FALL)));
    session.command(Command::Step(3));
    let state = session.state();
    assert!(state.breakdown.is_none() && state.step == 3);
}

#[test]
fn frames_take_the_steps_that_are_due_by_the_clock() {
    let mut driver = FrameDriver::new(options());
    driver.send(Command::Load(scene(FALL)));
    assert!(driver.is_behind() && driver.state().loaded.is_none());
    assert!(!driver.frame(AMPLE) && !driver.is_behind() && driver.state().loaded.is_some());
    driver.send(Command::Run);
    // no time has passed for the first one
    assert!(driver.frame(AMPLE));
    assert_eq!(driver.state().step, 0);
    std::thread::sleep(Duration::from_millis(20));
    assert!(driver.frame(AMPLE));
    let state = driver.state();
    // steps of 1 ms; a frame makes good .1 s at most
    assert!((20..=101).contains(&state.step), "{}", state.step);
    let mut alone = session(FALL);
    alone.command(Command::Step(state.step));
    assert_eq!(bits(&alone.state()), bits(&state));
    // one step without any time to take it in
    std::thread::sleep(Duration::from_millis(20));
    assert!(driver.frame(Duration::ZERO));
    assert_eq!(driver.state().step, state.step + 1);
    driver.send(Command::Pause);
    assert!(driver.is_behind() && !driver.frame(AMPLE));
    assert!(!driver.state().running && driver.state().step == state.step + 1);
    // what passed meanwhile is not made good
    std::thread::sleep(Duration::from_millis(20));
    driver.send(Command::Run);
    assert!(driver.frame(AMPLE));
    assert_eq!(driver.state().step, state.step + 1);
}

#[test]
fn mistakes_of_a_scene_say_where_they_are() {
    let mut session = session("");
    let wrong = scene("loads: [Gravity(body: \"nobody\", acceleration: (0, 0, -9.81))]");
    let text = wrong.text().to_string();
    session.command(Command::Load(wrong));
    let mistakes = session.state().refusal.unwrap().mistakes;
    let [mistake] = mistakes.as_slice() else { panic!("{mistakes:?}") };
    assert_eq!((mistake.text.as_str(), &text[mistake.bytes.clone()]), ("test.ron", "\"nobody\""));
    assert!(mistake.place.starts_with("test.ron:3:"), "{}", mistake.place);
    session.command(Command::Speed(-1.0));
    assert_eq!(session.state().refusal.unwrap().mistakes, []);
}

#[test]
fn why_there_is_no_scene_stands_until_one_is_loaded() {
    let mut session = Session::new(options());
    session.command(Command::Run);
    assert!(session.state().refusal.unwrap().reason.contains("there is no scene yet"));
    let wrong = scene("").text().replace("\"z0\"", "\"z7\"");
    session.command(Command::Load(Box::new(SceneFile::from_text("test.ron", &wrong, Path::new(""), &[]).unwrap())));
    session.command(Command::Run);
    session.command(Command::Step(1));
    let refusal = session.state().refusal.unwrap();
    assert!(refusal.command == "load" && refusal.reason.contains("z7"), "{refusal:?}");
    session.command(Command::Load(scene("")));
    assert!(session.state().refusal.is_none());
}

#[test]
fn a_wrong_scene_leaves_the_old_one_running() {
    let mut session = session(FALL);
    session.command(Command::Run);
    session.advance(FRAME, AMPLE);
    session.command(Command::Load(scene("loads: [Gravity(body: \"nobody\", acceleration: (0, 0, -9.81))]")));
    let state = session.state();
    let refusal = state.refusal.expect("it is refused");
    assert!(refusal.command == "load" && refusal.reason.contains("nobody"), "{}", refusal.reason);
    assert!(state.running && state.loaded.unwrap().number == 0);
    let before = state.time;
    session.advance(FRAME, AMPLE);
    assert!(session.state().time > before);
    session.command(Command::Set(vec!["materials.m.neo_hookean=Young(young: -1, poisson: 0.45)".into()]));
    assert_eq!(session.state().refusal.map(|refusal| refusal.command), Some("set"));
    session.command(Command::Load(scene(FALL)));
    assert_eq!(session.state().loaded.unwrap().number, 1);
}

#[test]
fn a_hand_pulls_until_it_lets_go_and_its_work_is_in_the_balance() {
    let mut session = session(FALL);
    let ray = (DVec3::new(0.05, 0.05, 1.0), DVec3::NEG_Z);
    session.command(Command::Pick { origin: ray.0, direction: ray.1 });
    let picked = session.state().picked.expect("the upper side");
    assert!(picked.pick.body == "b" && picked.material == "m" && picked.element >= 18);
    assert_eq!(picked.pick.element, picked.element as u64);
    session.command(Command::Grab { hand: 1, origin: ray.0, direction: ray.1 });
    for step in 1..=20 {
        let target = picked.pick.point + DVec3::new(0.002, 0.0, 0.002) * f64::from(step);
        session.command(Command::MoveGrab { hand: 1, target });
        session.command(Command::Step(5));
    }
    let state = session.state();
    let held = &state.held[0];
    let along = (held.target - held.point).normalize();
    assert!(held.hand == 1 && held.force.length() > 0.01 && held.force.normalize().dot(along) > 0.8, "{held:?}");
    session.command(Command::Release { hand: 1 });
    assert!(session.state().held.is_empty());
    session.command(Command::Step(50));
    let e = session.state().energies;
    let work = e.load_work.unwrap();
    let taken = e.kinetic + e.internal_work.unwrap() + e.damping_loss.unwrap();
    // the bound of f32 runs in tests/physics/grab.rs
    assert!(work.abs() > 1e-4 && (taken - work).abs() < 1e-3 * work.abs(), "{taken} J of {work} J");
    // a hand beside the body holds nothing
    session.command(Command::Grab { hand: 2, origin: DVec3::new(5.0, 5.0, 1.0), direction: DVec3::NEG_Z });
    assert!(session.state().held.is_empty() && session.state().refusal.is_none());
}

#[test]
fn a_point_that_was_picked_elsewhere_is_told_and_held_as_one_that_a_ray_meets() {
    let mut session = session(FALL);
    session.command(Command::Pick { origin: DVec3::new(0.05, 0.05, 1.0), direction: DVec3::NEG_Z });
    let picked = session.state().picked.expect("the upper side");
    session.command(Command::PickAt(None));
    assert_eq!(session.state().picked, None);
    session.command(Command::PickAt(Some(Box::new(picked.pick.clone()))));
    assert_eq!(session.state().picked.as_ref(), Some(&picked));
    session.command(Command::GrabAt { hand: 3, pick: Box::new(picked.pick.clone()) });
    let state = session.state();
    assert!(state.held.len() == 1 && state.held[0].hand == 3, "{:?}", state.refusal);
    assert!(state.held[0].point.distance(picked.pick.point) < 1e-6);
    // a node that there is not, and a body
    let wrong = sinew::Pick { nodes: [9999; 3], ..picked.pick.clone() };
    session.command(Command::PickAt(Some(Box::new(wrong.clone()))));
    assert_eq!(session.state().picked, None);
    session.command(Command::GrabAt { hand: 3, pick: Box::new(wrong) });
    assert_eq!(session.state().refusal.map(|told| told.command), Some("grab"));
    let nobody = sinew::Pick { body: "nobody".into(), ..picked.pick };
    session.command(Command::PickAt(Some(Box::new(nobody))));
    assert!(session.state().refusal.is_some_and(|told| told.command == "pick" && told.reason.contains("nobody")));
}

#[test]
fn states_have_arrows_materials_sets_and_the_elements_that_set_the_step() {
    let mut session = session(FALL);
    session.command(Command::Arrows(Some(OutputField::Reaction)));
    session.command(Command::Step(30));
    let state = session.state();
    let (loaded, body) = (state.loaded.as_ref().unwrap(), &state.bodies[0]);
    let about = &loaded.bodies[0];
    assert_eq!(body.arrows.len(), about.rest.len());
    // what bears it stands at the nodes that are held
    for (arrow, axes) in body.arrows.iter().zip(&about.constrained) {
        assert_eq!(arrow[2] != 0.0, *axes != 0, "{arrow:?}");
    }
    let held: Vec<u32> = (0..).zip(&about.constrained).filter(|(_, axes)| **axes != 0).map(|(node, _)| node).collect();
    assert_eq!(about.sets["z0"], held);
    assert_eq!((about.materials.as_slice(), about.element_materials.len()), (&["m".to_string()][..], 27));
    assert!((1..=10).contains(&loaded.critical.len()));
    assert!(loaded.critical.iter().all(|critical| critical.body == "b" && critical.bound >= 1e-3));
    // of so few elements all are listed, that which is picked among them
    session.command(Command::Load(coarse(FALL)));
    session.command(Command::Pick { origin: DVec3::new(0.03, 0.03, 1.0), direction: DVec3::NEG_Z });
    let state = session.state();
    let (picked, critical) = (state.picked.unwrap(), &state.loaded.as_ref().unwrap().critical);
    let listed = critical.iter().find(|critical| critical.element == picked.pick.element).unwrap();
    assert_eq!((critical.len(), picked.step), (8, Some(listed.bound)));
    session.command(Command::Arrows(Some(OutputField::VonMises)));
    assert!(session.state().refusal.unwrap().reason.contains("von_mises has no vectors of nodes"));
}
