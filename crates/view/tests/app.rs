//! The whole viewer but its picture, by the words on it: no window, no graphics device.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use egui::{Event, Key, Modifiers, PointerButton, Pos2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use sinew::driver::State;
use sinew::{BackendChoice, Folder, Options, SceneFile, Simulation};
use sinew_view::{App, Start};
use std::path::PathBuf;
use std::time::{Duration, Instant};

struct Place {
    folder: tempfile::TempDir,
    scene: PathBuf,
}

const CUBE: &str = include_str!("../../../scenes/cube_under_gravity.ron");

impl Place {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let scene = folder.path().join("cube.ron");
        let place = Self { folder, scene };
        place.write("(10, 10, 10)", "(3, 3, 3)");
        place
    }

    /// What `sinew run` leaves of it.
    fn run(&self, more: &str) -> PathBuf {
        self.write("output: (fields_every: 0.02)", more);
        let scene = SceneFile::load(&self.scene, &[]).unwrap();
        let options = Options { backend: BackendChoice::Cpu, threads: 1, ..Options::default() };
        let mut simulation = Simulation::new(&scene, &options).unwrap();
        let path = self.folder.path().join("out");
        let mut folder = Folder::create(&path).unwrap();
        std::fs::write(folder.claim("scene.ron").unwrap(), scene.text()).unwrap();
        simulation.write_into(&mut folder).unwrap();
        simulation.observe().unwrap();
        simulation.finish().unwrap();
        simulation.write_nodes(&mut folder).unwrap();
        path
    }

    fn write(&self, from: &str, to: &str) {
        assert!(self.folder.path().exists());
        std::fs::write(&self.scene, CUBE.replace("(10, 10, 10)", "(3, 3, 3)").replace(from, to)).unwrap();
    }

    fn open(&self) -> Harness<'static, Option<App>> {
        self.open_path(self.scene.clone())
    }

    fn open_path(&self, path: PathBuf) -> Harness<'static, Option<App>> {
        self.open_with(Start { scene: Some(path), ..Start::default() })
    }

    fn open_with(&self, start: Start) -> Harness<'static, Option<App>> {
        let options = Options { backend: BackendChoice::Cpu, threads: 1, ..Options::default() };
        let start = Start { options, ..start };
        let app = move |ui: &mut egui::Ui, app: &mut Option<App>| {
            app.get_or_insert_with(|| App::new(ui.ctx(), start.clone(), None)).show(ui);
        };
        let mut harness = Harness::builder().with_size([1100.0, 700.0]).with_step_dt(0.02).build_ui_state(app, None);
        wait(&mut harness, "a scene", |state| state.loaded.is_some() && !state.bodies.is_empty());
        // the camera goes to where all is seen
        harness.step();
        harness
    }
}

fn state<'a>(harness: &'a Harness<'static, Option<App>>) -> &'a State {
    harness.state().as_ref().unwrap().state()
}

fn wait(harness: &mut Harness<'static, Option<App>>, what: &str, done: impl Fn(&State) -> bool) {
    let started = Instant::now();
    loop {
        harness.step();
        if done(state(harness)) {
            return;
        }
        assert!(started.elapsed() < Duration::from_secs(60), "waited for {what}: {:?}", state(harness).refusal);
        std::thread::sleep(Duration::from_millis(5));
    }
}

fn press(harness: &mut Harness<'static, Option<App>>, label: &str) {
    harness.get_by_label(label).click();
    harness.step();
}

#[test]
fn it_runs_pauses_steps_and_goes_back_by_its_buttons() {
    let place = Place::new();
    let mut harness = place.open();
    press(&mut harness, "Run");
    wait(&mut harness, "time to pass", |state| state.running && state.time > 0.02);
    press(&mut harness, "Pause");
    wait(&mut harness, "it to stand", |state| !state.running);
    let step = state(&harness).step;
    press(&mut harness, "Step");
    wait(&mut harness, "one step", |state| state.step == step + 1);
    press(&mut harness, "Reset");
    wait(&mut harness, "the start", |state| state.step == 0);
    press(&mut harness, "Plots");
    harness.get_by_label("energies (J)");
}

#[test]
fn it_begins_with_a_state_that_was_kept() {
    let place = Place::new();
    let options = Options { backend: BackendChoice::Cpu, threads: 1, grabs: true, ..Options::default() };
    let mut simulation = Simulation::new(&SceneFile::load(&place.scene, &[]).unwrap(), &options).unwrap();
    simulation.advance(60).unwrap();
    let resume = Some(Box::new(simulation.snapshot().unwrap()));
    let mut harness = place.open_with(Start { scene: Some(place.scene.clone()), resume, ..Start::default() });
    wait(&mut harness, "the state", |state| state.step == 60);
    let places = simulation.positions("cube").unwrap();
    assert_eq!(state(&harness).bodies[0].positions, places.iter().map(|p| p.as_vec3().to_array()).collect::<Vec<_>>());
    press(&mut harness, "Reset");
    wait(&mut harness, "the start of the scene", |state| state.step == 0);
}

#[test]
fn keys_and_boxes_change_what_is_seen() {
    let place = Place::new();
    let mut harness = place.open();
    let settings = |harness: &Harness<'static, Option<App>>| harness.state().as_ref().unwrap().settings().clone();
    press(&mut harness, "Elements");
    assert!(settings(&harness).wireframe);
    harness.key_press(Key::W);
    harness.step();
    assert!(!settings(&harness).wireframe);
    press(&mut harness, "Nodes");
    assert!(settings(&harness).nodes);
    harness.key_press(Key::N);
    harness.step();
    assert!(!settings(&harness).nodes);
    press(&mut harness, "Cut open");
    assert!(settings(&harness).cut);
    press(&mut harness, "Dark");
    harness.step();
    harness.get_by_label("Light");
    press(&mut harness, "Keys");
    harness.step();
    harness.get_by_label("pull at the tissue");
    harness.key_press(Key::T);
    harness.step();
    assert_eq!(settings(&harness).field.map(|field| field.array()), Some("von_mises"));
    wait(&mut harness, "values", |state| state.bodies[0].values.len() == 27);
}

/// Each event is a frame of its own.
fn pointer(harness: &mut Harness<'static, Option<App>>, at: Pos2, pressed: Option<bool>, modifiers: Modifiers) {
    harness.event(Event::ModifiersChanged(modifiers));
    harness.event(Event::PointerMoved(at));
    if let Some(pressed) = pressed {
        harness.event(Event::PointerButton { pos: at, button: PointerButton::Primary, pressed, modifiers });
    }
    harness.step();
}

#[test]
fn the_mouse_picks_and_with_ctrl_it_pulls() {
    let place = Place::new();
    let mut harness = place.open();
    let middle = harness.get_by_label("Picture of the scene").rect().center();
    pointer(&mut harness, middle, Some(true), Modifiers::NONE);
    pointer(&mut harness, middle, Some(false), Modifiers::NONE);
    wait(&mut harness, "a pick", |state| state.picked.is_some());
    harness.step();
    let picked = state(&harness).picked.clone().unwrap();
    harness.get_by_label(&format!("cube, node {}", picked.node_number));
    assert!(picked.step.is_some_and(|step| step > 0.0));
    assert!(harness.query_all_by_label_contains("the element's stable step: ").next().is_some());
    assert!(harness.query_all_by_label_contains("in the sets ").next().is_some(), "what is seen is on a side");
    pointer(&mut harness, middle, Some(true), Modifiers::CTRL);
    pointer(&mut harness, middle + egui::vec2(12.0, 0.0), None, Modifiers::CTRL);
    wait(&mut harness, "a hold", |state| !state.held.is_empty());
    for way in 1..=5u8 {
        pointer(&mut harness, middle + egui::vec2(12.0 + 8.0 * f32::from(way), 0.0), None, Modifiers::CTRL);
    }
    wait(&mut harness, "a force", |state| state.held.first().is_some_and(|held| held.force.length() > 1e-3));
    pointer(&mut harness, middle + egui::vec2(60.0, 0.0), Some(false), Modifiers::NONE);
    wait(&mut harness, "letting go", |state| state.held.is_empty());
}

#[test]
fn a_file_that_changes_is_read_again_and_a_wrong_one_tells_why_while_the_old_goes_on() {
    let place = Place::new();
    let mut harness = place.open();
    press(&mut harness, "Run");
    let later = |seconds: u64| {
        let file = std::fs::File::options().append(true).open(&place.scene).unwrap();
        file.set_modified(std::time::SystemTime::now() + Duration::from_secs(seconds)).unwrap();
    };
    place.write("material: \"tissue\"", "material: \"issue\"");
    later(10);
    wait(&mut harness, "a refusal", |state| state.refusal.as_ref().is_some_and(|told| told.reason.contains("issue")));
    let time = state(&harness).time;
    wait(&mut harness, "the old scene to go on", |state| state.running && state.time > time);
    assert!(harness.query_all_by_label_contains("issue").next().is_some(), "its text is seen");
    place.write("(3, 3, 3)", "(2, 2, 2)");
    later(20);
    wait(&mut harness, "the new scene", |state| state.refusal.is_none() && state.bodies[0].positions.len() == 27);
    place.write("duration: 1,", "durations: 1,");
    later(30);
    let started = Instant::now();
    while harness.query_all_by_label_contains("durations").next().is_none() {
        assert!(started.elapsed() < Duration::from_secs(30), "a word that is none is told");
        std::thread::sleep(Duration::from_millis(20));
        harness.step();
    }
}

#[test]
fn a_finished_run_is_seen_at_all_of_its_times() {
    let place = Place::new();
    let folder = place.run("output: (fields_every: 0.1, energies_every: 0.1, fields: [Displacement, VonMises])");
    let mut harness = place.open_path(folder);
    assert_eq!(state(&harness).time, 0.0);
    harness.get_by_label("a finished run, 11 frames");
    assert!(state(&harness).bodies[0].positions.iter().all(|place| place[2] >= 0.0));
    let lowest = |state: &State| state.bodies[0].positions.iter().map(|place| place[2]).fold(0.0f32, f32::max);
    let top = lowest(state(&harness));
    press(&mut harness, "Step");
    wait(&mut harness, "the second frame", |state| state.step == 1 && (0.1..0.11).contains(&state.time));
    assert!(lowest(state(&harness)) < top, "it sags");
    harness.get_by_label("frame 2");
    press(&mut harness, "Run");
    wait(&mut harness, "its end", |state| state.finished && !state.running);
    // what is due is written at the end of a step
    assert!((0.99..1.01).contains(&state(&harness).time), "{}", state(&harness).time);
    press(&mut harness, "Reset");
    wait(&mut harness, "its start", |state| state.time == 0.0);
    harness.key_press(Key::T);
    wait(&mut harness, "its stresses", |state| state.bodies[0].values.len() == 27);
    let middle = harness.get_by_label("Picture of the scene").rect().center();
    pointer(&mut harness, middle, Some(true), Modifiers::NONE);
    pointer(&mut harness, middle, Some(false), Modifiers::NONE);
    wait(&mut harness, "a pick", |state| state.picked.as_ref().is_some_and(|picked| picked.material == "tissue"));
    // what it did not write is told
    harness.key_press(Key::L);
    wait(&mut harness, "a refusal", |state| state.refusal.is_some());
    harness.step();
    assert!(harness.query_all_by_label_contains("did not write external_force").next().is_some());
    press(&mut harness, "Plots");
    harness.get_by_label("top");
}

#[test]
fn numbers_of_the_scene_change_while_it_runs_and_what_cannot_begins_anew() {
    let place = Place::new();
    let mut harness = place.open();
    press(&mut harness, "Numbers of the scene");
    harness.step();
    harness.step();
    let set = |harness: &mut Harness<'static, Option<App>>, label: &str, value: f64| {
        harness.get_by_role_and_label(egui::Role::SpinButton, label).set_value_accesskit(value);
        harness.step();
        harness.step();
    };
    set(&mut harness, "[0].acceleration[2]", -3.0);
    let commands = state(&harness).commands;
    press(&mut harness, "Step");
    // the load is what it was told to be: a third of the usual weight pulls at the cube
    wait(&mut harness, "a step", |state| state.step == 1 && state.commands > commands && state.refusal.is_none());
    set(&mut harness, "tissue.density", 900.0);
    wait(&mut harness, "a refusal", |state| state.refusal.as_ref().is_some_and(|told| told.command == "set"));
    // until what is told has its place
    harness.run_steps(4);
    press(&mut harness, "Start anew with it");
    wait(&mut harness, "the scene anew", |state| {
        let scene = state.loaded.as_ref().map(|loaded| loaded.scene.scene.clone());
        scene.is_some_and(|scene| scene.materials["tissue"].density == 900.0)
    });
}

#[test]
fn the_elements_that_set_the_step_are_listed_and_the_eye_goes_there() {
    let place = Place::new();
    let mut harness = place.open();
    press(&mut harness, "What sets the step");
    harness.step();
    harness.step();
    let critical = state(&harness).loaded.as_ref().unwrap().critical.clone();
    assert!(!critical.is_empty() && critical.len() <= 10);
    let name = format!("{} {}", critical[0].body, critical[0].element);
    harness.get_by_label(&name).scroll_to_me();
    harness.step();
    harness.step();
    press(&mut harness, &name);
    assert!(harness.state().as_ref().unwrap().settings().critical);
}
