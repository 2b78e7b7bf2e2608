//! The viewer as it is in a page: scenes and files in memory, the text in the window, steps in its frames. By the words
//! on it, without a window or a graphics device.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use egui::{DroppedFile, Key, Modifiers, Role};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use sinew::driver::State;
use sinew::{BackendChoice, Options};
use sinew_view::{App, Bundle, Start};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

type Page = Harness<'static, Option<App>>;

const CUBE: &str = include_str!("../../../scenes/cube_under_gravity.ron");

fn cube() -> String {
    CUBE.replace("(10, 10, 10)", "(3, 3, 3)")
}

fn open(scenes: &[(&str, String)]) -> Page {
    let scenes = scenes.iter().map(|(name, text)| (name.to_string(), text.clone())).collect();
    let options = Options { backend: BackendChoice::Cpu, threads: 1, ..Options::default() };
    let start = Start { options, bundle: Some(Bundle { scenes, ..Bundle::default() }), ..Start::default() };
    let app = move |ui: &mut egui::Ui, app: &mut Option<App>| {
        app.get_or_insert_with(|| App::new(ui.ctx(), start.clone(), None)).show(ui);
    };
    let mut page = Harness::builder().with_size([1400.0, 800.0]).with_step_dt(0.02).build_ui_state(app, None);
    page.run_steps(3);
    page
}

fn state(page: &Page) -> &State {
    page.state().as_ref().unwrap().state()
}

fn mistakes(page: &Page) -> Vec<String> {
    page.state().as_ref().unwrap().mistakes()
}

fn wait(page: &mut Page, what: &str, done: impl Fn(&State) -> bool) {
    let started = Instant::now();
    while !done(state(page)) {
        assert!(started.elapsed() < Duration::from_secs(60), "waited for {what}: {:?}", state(page).refusal);
        std::thread::sleep(Duration::from_millis(5));
        page.step();
    }
}

fn type_text(page: &mut Page, text: &str) {
    page.get_by_role(Role::MultilineTextInput).set_text_value_accesskit(text);
    page.run_steps(3);
}

fn press(page: &mut Page, label: &str) {
    page.get_by_label(label).click();
    page.run_steps(3);
}

#[test]
fn steps_are_taken_in_the_frames_of_the_window() {
    let mut page = open(&[("cube.ron", cube())]);
    assert!(state(&page).loaded.is_some(), "{:?}", state(&page).refusal);
    press(&mut page, "Run");
    wait(&mut page, "time to pass", |state| state.running && state.time > 0.02);
    press(&mut page, "Pause");
    let step = state(&page).step;
    page.run_steps(3);
    assert!(!state(&page).running && state(&page).step == step);
    press(&mut page, "Step");
    assert_eq!(state(&page).step, step + 1);
    press(&mut page, "Reset");
    assert_eq!(state(&page).step, 0);
}

#[test]
fn mistakes_stand_in_the_text_while_the_old_scene_goes_on() {
    let mut page = open(&[("cube.ron", cube())]);
    press(&mut page, "Run");
    type_text(&mut page, &cube().replace("duration:", "durations:"));
    assert!(mistakes(&page)[0].starts_with("cube.ron:5:5: "), "{:?}", mistakes(&page));
    // in the list; on the text it is painted
    assert!(page.query_all_by_label_contains("durations").next().is_some());
    press(&mut page, "Load");
    assert_eq!(state(&page).loaded.as_ref().unwrap().number, 0);
    // what is known only when it is loaded
    type_text(&mut page, &cube().replace("\"z0\"", "\"z7\""));
    assert_eq!(mistakes(&page), [""; 0]);
    press(&mut page, "Load");
    assert!(mistakes(&page).iter().any(|line| line.contains("z7")), "{:?}", state(&page).refusal);
    let time = state(&page).time;
    wait(&mut page, "the old scene to go on", |state| state.running && state.time > time);
    type_text(&mut page, &cube().replace("(3, 3, 3)", "(2, 2, 2)"));
    assert_eq!(mistakes(&page), [""; 0]);
    page.key_press_modifiers(Modifiers::COMMAND, Key::Enter);
    page.run_steps(3);
    let state = state(&page);
    assert!(state.refusal.is_none() && state.loaded.as_ref().unwrap().number == 1);
    assert_eq!(state.bodies[0].positions.len(), 27);
}

#[test]
fn what_only_loading_finds_is_told_when_somebody_else_takes_the_steps_later() {
    let mut page = open(&[("cube.ron", cube())]);
    let steps = page.state().as_ref().unwrap().steps().unwrap();
    type_text(&mut page, &cube().replace("\"z0\"", "\"z7\""));
    press(&mut page, "Load");
    page.run_steps(5);
    assert!(state(&page).refusal.is_none() && mistakes(&page).is_empty());
    steps.take();
    page.step();
    assert!(mistakes(&page).iter().any(|line| line.contains("z7")), "{:?}", state(&page).refusal);
}

#[test]
fn a_mistake_in_the_list_leads_to_its_place() {
    let mut page = open(&[("cube.ron", cube().replace("density:", "densities:"))]);
    assert!(state(&page).loaded.is_none());
    let line = mistakes(&page)[0].clone();
    press(&mut page, &line);
    assert!(page.get_by_role(Role::MultilineTextInput).is_focused());
    page.get_by_role(Role::MultilineTextInput).replace_selected_text_accesskit("X");
    page.run_steps(3);
    let text = page.get_by_role(Role::MultilineTextInput).value().unwrap();
    assert!(text.contains("Xdensities:"), "{text}");
}

#[test]
fn another_scene_is_chosen_from_the_list() {
    let mut page = open(&[("cube.ron", cube()), ("long.ron", cube().replace("duration: 1,", "duration: 7,"))]);
    page.get_by_role_and_label(Role::ComboBox, "scene").click();
    page.run_steps(3);
    press(&mut page, "long.ron");
    assert_eq!(state(&page).loaded.as_ref().unwrap().scene.scene.duration, 7.0);
    press(&mut page, "Scene");
    assert!(page.query_by_role(Role::MultilineTextInput).is_none(), "its text is put away");
}

#[derive(Debug)]
struct File(PathBuf, String);

impl DroppedFile for File {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        Ok(self.1.clone().into_bytes())
    }
}

#[test]
fn what_is_dropped_is_read_from_memory() {
    let mut page = open(&[("cube.ron", cube())]);
    let (from, to) = (cube().find("materials:").unwrap(), cube().find("constraints:").unwrap());
    let mut whole = cube();
    whole.replace_range(from..to, "parts: {\"a\": (scene: \"soft.ron\")},\n    ");
    let whole = whole.replace("\"tissue\"", "\"a.tissue\"");
    page.input_mut().dropped_files.push(Arc::new(File("/some/where/whole.ron".into(), whole)));
    page.run_steps(3);
    assert!(mistakes(&page).iter().any(|line| line.starts_with("whole.ron:") && line.contains("soft.ron")));
    assert_eq!(state(&page).loaded.as_ref().unwrap().scene.path, Path::new("cube.ron"));
    let part = "(materials: {\"tissue\": (density: 700, neo_hookean: Young(young: 3000, poisson: 0.45))})";
    page.input_mut().dropped_files.push(Arc::new(File("soft.ron".into(), part.into())));
    page.run_steps(3);
    page.get_by_label("Files (1)");
    assert_eq!(mistakes(&page), [""; 0]);
    press(&mut page, "Load");
    let scene = &state(&page).loaded.as_ref().unwrap().scene;
    assert_eq!(scene.path, Path::new("whole.ron"), "{:?}", state(&page).refusal);
    assert_eq!(scene.scene.materials["a.tissue"].density, 700.0);
}
