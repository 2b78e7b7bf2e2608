//! Scenes that once ended untruly; each stands in `tests/endings`.

use crate::configurations::{Configuration, configurations, cpu_and_long_gpu};
use sinew::{Error, SceneFile, Simulation};

fn scene(name: &str, sets: &[&str]) -> SceneFile {
    let path = format!("{}/tests/endings/{name}.ron", env!("CARGO_MANIFEST_DIR"));
    let sets: Vec<String> = sets.iter().map(ToString::to_string).collect();
    SceneFile::load(path, &sets).unwrap_or_else(|wrong| panic!("{}", wrong.render(false)))
}

fn run(name: &str, sets: &[&str], configuration: &Configuration) -> (Simulation, Result<(), Error>) {
    let mut simulation = Simulation::new(&scene(name, sets), &configuration.options).unwrap();
    let ended = simulation.observe().and_then(|()| simulation.finish());
    (simulation, ended)
}

#[test]
fn overflow_is_no_balance() {
    for configuration in configurations() {
        let (_, ended) = run("overflow_passes_the_balance", &[], &configuration);
        assert!(matches!(ended, Err(Error::Unstable(_))), "{}: {ended:?}", configuration.name);
    }
}

#[test]
fn element_inverted_in_the_last_step_is_noticed() {
    for configuration in configurations() {
        let (_, ended) = run("inverted_in_the_last_step", &[], &configuration);
        let Err(Error::Unstable(broken)) = ended else { panic!("{}: {ended:?}", configuration.name) };
        assert_eq!(broken.criterion.name, "inverted", "{}", configuration.name);
        assert!(broken.what.contains("turned inside out"), "{}", broken.what);
        assert_eq!(broken.good_until, 0.0, "nothing after the start was good");
    }
}

#[test]
fn exact_rigid_rotation_is_no_breakdown_and_no_warning() {
    for configuration in configurations() {
        let (simulation, ended) = run("rigid_rotation_breaks_down", &[], &configuration);
        ended.unwrap_or_else(|error| panic!("{}: {error}", configuration.name));
        let guards = simulation.guards();
        assert!(guards.warnings.is_empty(), "{}: {:?}", configuration.name, guards.warnings);
        // what rounding may have made is far below the energy of a strain of a thousandth: ½ E V ε² = 1.5e-6 J
        assert!(guards.rounding > 0.0 && guards.rounding < configuration.bound(1e-12, 1.5e-5), "{:e}", guards.rounding);
    }
}

/// Gravity by a trapezium of 100 m/s² with flanks of .01 s: an impulse of 10 m/s with its centre at .105 s, and free
/// flight.
#[test]
fn pulse_between_steps_is_not_lost() {
    let (velocity, centre) = (10.0, 0.105);
    let expected = velocity * (1.0 - centre);
    for configuration in configurations() {
        let (mut simulation, ended) = run("pulse_between_steps", &[], &configuration);
        ended.unwrap();
        let step = simulation.world().resource::<sinew::components::Clock>().time_step;
        let path = simulation.displacements(&simulation.scene().bodies.keys().next().unwrap().clone()).unwrap()[0].z;
        let error = (path - expected).abs();
        println!("{}: {path} of {expected}, step {step}", configuration.name);
        // the pulse acts at the beginning of a step or two: at most half a step from where it is
        assert!(error <= velocity * 0.5 * step, "{}: {path}, expected {expected}", configuration.name);
        assert!(path > 0.5 * expected);
        let warned = simulation.warnings().render(false);
        assert!(warned.contains("loads[0].curve") || warned.contains("the curve changes within"), "{warned}");
    }
}

/// A plate is pushed down through the whole block: what is flattened goes, the step follows, and the energy that goes
/// with it is counted.
#[test]
fn flattened_elements_are_removed_and_the_run_goes_on() {
    for configuration in cpu_and_long_gpu() {
        let (mut simulation, ended) = run("inversion_remove_breaks_down", &[], &configuration);
        ended.unwrap_or_else(|error| panic!("{}: {error}", configuration.name));
        let summary = simulation.summary("finished").unwrap();
        let (removed, energies) = (summary.removed_elements, summary.energies);
        println!("{}: {removed} removed, {} J, {} steps", configuration.name, energies.removed, summary.steps);
        assert!((10..48).contains(&removed), "{}: {removed} removed", configuration.name);
        assert!(energies.removed.is_finite() && energies.removed > 0.0 && energies.strain.is_finite());
        let warnings = &simulation.guards().warnings;
        let of_energy = warnings.iter().find(|warning| warning.criterion == "energy");
        assert!(of_energy.is_none(), "{}: {of_energy:?}", configuration.name);
    }
}
