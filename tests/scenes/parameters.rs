//! Parameters of custom systems, and what is said when they do not fit.

use super::reference;
use sinew::bevy_ecs::prelude::*;
use sinew::systems::{Phase, Registry, System};
use sinew::{SceneFile, Simulation};
use std::path::Path;

#[derive(Resource, serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Wind {
    speed: f64,
    #[serde(default)]
    gusts: Vec<f64>,
}

#[derive(Resource, Default)]
struct Calls(Vec<f64>);

fn wind(wind: Res<Wind>, mut calls: ResMut<Calls>) {
    calls.0.push(wind.speed + wind.gusts.iter().sum::<f64>());
}

fn registry() -> Registry {
    let wind = System::custom("wind", Phase::Removal, "blows", wind).with_parameters::<Wind>();
    let plain = System::custom("plain", Phase::Removal, "does nothing", || ());
    Registry::default().with(wind).with(plain)
}

fn text(schedule: &str, parameters: &str) -> SceneFile {
    let text = format!(
        r#"(duration: 0.1, integration: (step: 0.01, beyond_stable_step: true),
        bodies: {{"cube": (mesh: Box(size: (1, 1, 1), cells: (1, 1, 1)), material: "gel")}},
        materials: {{"gel": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.3))}},
        schedule: ["element_forces", "gather", "integrate"{schedule}, "observe"],
        parameters: {{{parameters}}})"#
    );
    SceneFile::from_text("wind", &text, Path::new("."), &[]).unwrap_or_else(|wrong| panic!("{}", wrong.render(false)))
}

fn calls(parameters: &str) -> Vec<f64> {
    let mut simulation = Simulation::with_systems(&text(r#", "wind""#, parameters), &reference(), &registry()).unwrap();
    simulation.world_mut().init_resource::<Calls>();
    simulation.advance(10).unwrap();
    simulation.world().resource::<Calls>().0.clone()
}

fn complaint(schedule: &str, parameters: &str) -> String {
    Simulation::check(&text(schedule, parameters), &registry()).render(false)
}

#[test]
fn a_system_finds_its_parameters_as_a_resource() {
    assert_eq!(calls(r#""wind": (speed: 3)"#), [3.0; 10]);
    assert_eq!(calls(r#""wind": (speed: 3, gusts: [1, 0.5])"#), [4.5; 10]);
}

#[test]
fn every_is_a_time_between_two_runs() {
    assert_eq!(calls(r#""wind": (speed: 3, every: 0.05)"#).len(), 2);
    assert_eq!(calls(r#""wind": (every: 1e-9, speed: 3)"#).len(), 10, "at most once a step");
}

#[test]
fn parameters_that_do_not_fit_are_errors_that_say_where_and_why() {
    let wind = r#", "wind""#;
    for (parameters, said) in [
        (r#""wind": (sped: 3)"#, "`sped`"),
        (r#""wind": (gusts: [])"#, "`speed`"),
        (r#""wind": (speed: "fast")"#, "fast"),
        (r#""wind": 3"#, "have names"),
        (r#""wind": (speed: 3, every: 0)"#, "above 0"),
        (r#""wind": (speed: 3, every: "day")"#, "above 0"),
        (r#""wind": (speed: 3), "wund": (speed: 3)"#, "did you mean `wind`"),
        (r#""wind": (speed: 3), "gravity": (speed: 3)"#, "the built-in system `gravity` has no parameters"),
    ] {
        let found = complaint(wind, parameters);
        assert!(
            found.starts_with("error") && found.contains(said) && found.contains("wind:"),
            "{parameters}:\n{found}"
        );
    }
    let found = complaint(wind, "");
    assert!(found.contains("`speed`"), "missing altogether:\n{found}");
    let found = complaint(r#", "wind", "plain""#, r#""wind": (speed: 3), "plain": (colour: "red")"#);
    assert!(found.contains("it has no `colour`; allowed: every"), "{found}");
}

#[test]
fn parameters_for_a_system_that_is_not_scheduled_are_a_warning() {
    let found = complaint("", r#""wind": (speed: 3)"#);
    assert!(found.starts_with("warning") && found.contains("not in the schedule"), "{found}");
}
