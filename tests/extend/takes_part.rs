//! When a program's system takes part in a scene that writes no `schedule`, and where in the step it then stands.

use sinew::components::ConstrainedAxes;
use sinew::prelude::*;
use std::path::Path;

/// What the scene says under `parameters`.
#[derive(Resource, serde::Deserialize)]
#[serde(crate = "sinew::serde", deny_unknown_fields)]
struct Given {
    #[serde(rename = "number")]
    _number: f64,
}

fn scene(more: &str) -> SceneFile {
    let text = format!(
        r#"(
    duration: 1,
    bodies: {{"cube": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (2, 2, 2)), material: "tissue")}},
    materials: {{"tissue": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.3))}},
    loads: [Gravity(acceleration: (0, 0, -9.81))],
    {more}
)"#
    );
    SceneFile::from_text("scene.ron", &text, Path::new("."), &[]).unwrap()
}

/// One that takes nothing, two that take parameters, and two that ask for something else.
fn registry() -> Registry {
    let custom = |name: &str, phase| System::custom(name, phase, "does nothing", || {});
    let held = |world: &mut World| {
        let held = |axes: &ConstrainedAxes| axes.0.iter().any(|bits| *bits != 0);
        world.query::<&ConstrainedAxes>().iter(world).any(held).then(|| "nodes are held".to_owned())
    };
    Registry::default()
        .with(custom("last", Phase::Observe))
        .with(custom("plain", Phase::Loads))
        .with(custom("given", Phase::Loads).with_parameters::<Given>())
        .with(super::wind::system())
        .with(custom("held", Phase::Boundary).when("a constraint", held))
        .with(custom("both", Phase::Loads).when("a constraint", held).with_parameters::<Given>())
}

/// Systems, and what is told of each.
type Told = Vec<(String, String)>;

/// What takes part and why, in the order of a step, and what does not.
fn told(more: &str) -> (Told, Told, Simulation) {
    let options = Options { backend: BackendChoice::Cpu, ..Options::default() };
    let mut simulation = Simulation::with_systems(&scene(more), &options, &registry()).unwrap();
    let told = simulation.explain(&registry()).unwrap();
    let on = told.systems.into_iter().map(|system| (system.name, system.because)).collect();
    let off = told.systems_off.into_iter().map(|system| (system.name, system.turned_on_by)).collect();
    (on, off, simulation)
}

fn names(all: &[(String, String)]) -> Vec<&str> {
    all.iter().map(|(name, _)| name.as_str()).collect()
}

fn of<'a>(name: &str, all: &'a [(String, String)]) -> Option<&'a str> {
    all.iter().find(|(known, _)| known == name).map(|(_, told)| told.as_str())
}

#[test]
fn a_system_without_parameters_takes_part_in_every_scene() {
    let (on, off, mut simulation) = told("");
    assert_eq!(names(&on), ["element_forces", "gather", "gravity", "plain", "integrate", "observe", "last"]);
    assert_eq!(of("plain", &on), Some("the program has added it"));
    assert_eq!(of("given", &off), Some("its `parameters`"));
    assert_eq!(of("wind", &off), Some("its `parameters`"));
    assert_eq!(of("held", &off), Some("a constraint"));
    simulation.advance(3).unwrap();
}

#[test]
fn parameters_call_for_a_system_and_what_it_asks_for_besides() {
    let parameters = r#"parameters: {
        "wind": (acceleration: (0.5, 0, 0), height: 0.1), "given": (number: 1), "both": (number: 1),
    },"#;
    let (on, off, mut simulation) = told(parameters);
    let order = ["element_forces", "gather", "gravity", "plain", "given", "wind", "integrate", "observe", "last"];
    assert_eq!(names(&on), order);
    assert_eq!(of("given", &on), Some("the scene gives its `parameters`"));
    assert_eq!(of("wind", &on), Some("1 body with its `parameters`"));
    assert!(of("both", &off).is_some());
    simulation.advance(3).unwrap();
    // the blowing is seen
    assert!(simulation.displacements("cube").unwrap().iter().any(|u| u.x > 0.0));
    let (on, ..) = told(&format!(r#"{parameters} constraints: [Fixed(on: Set("z0"))],"#));
    // `boundary`, before it in the step, waits until nodes move
    assert_eq!(names(&on)[..2], ["held", "element_forces"]);
    assert_eq!(of("held", &on), Some("nodes are held"));
    assert!(of("both", &on).is_some());
}

#[test]
fn a_schedule_that_is_written_out_says_which_take_part() {
    let schedule = r#"schedule: ["element_forces", "gather", "given", "gravity", "integrate", "observe"],
        parameters: {"given": (number: 1)},"#;
    let (on, off, _) = told(schedule);
    assert_eq!(names(&on), ["element_forces", "gather", "given", "gravity", "integrate", "observe"]);
    assert_eq!(of("given", &on), Some("the scene's schedule names it"));
    assert!(of("plain", &off).is_some());
}

#[test]
fn parameters_that_do_not_fit_are_an_error_without_a_schedule_too() {
    let told = Simulation::check(&scene(r#"parameters: {"given": (nomber: 1)},"#), &registry()).render(false);
    assert!(told.contains("error") && told.contains("`nomber`") && told.contains("scene.ron:6"), "{told}");
}

/// What pushes goes on pushing, or the snapshot is not taken up; what only looks on may be left out.
#[test]
fn a_snapshot_knows_which_of_a_programs_systems_act() {
    fn acts(mut forces: Query<&mut ExternalForce>) {
        for mut all in &mut forces {
            let pushed = all.get(2) + 1e-3;
            all.set(2, pushed);
        }
    }
    fn looks(places: Query<&Displacement>) {
        assert!(places.iter().next().is_some());
    }
    let options = Options { backend: BackendChoice::Cpu, ..Options::default() };
    let simulation = |registry: &Registry| Simulation::with_systems(&scene(""), &options, registry).unwrap();
    let pushed = Registry::default().with(System::custom("pushes", Phase::Loads, "pushes", acts));
    let mut began = simulation(&pushed);
    began.advance(3).unwrap();
    let kept = began.snapshot().unwrap();
    let without = simulation(&Registry::default()).restore(&kept);
    assert!(without.unwrap_err().to_string().contains("systems of the program"));
    let watched = pushed.with(System::custom("looks", Phase::Observe, "looks on", looks));
    let mut gone_on = simulation(&watched);
    gone_on.restore(&kept).unwrap();
    for simulation in [&mut began, &mut gone_on] {
        simulation.advance(3).unwrap();
    }
    assert_eq!(began.displacements("cube").unwrap(), gone_on.displacements("cube").unwrap());
}

/// Whether a body is warned of that flies off: not where a program's system may hold it.
#[test]
fn what_a_programs_system_may_hold_is_not_warned_of() {
    let told = |registry: &Registry| Simulation::check(&scene(""), registry).render(false);
    assert!(told(&Registry::default()).contains("flies off"));
    assert!(!told(&registry()).contains("flies off"));
}
