//! The same passes as before: what a step of each shipped scene consists of on the CPU and on a GPU, kept in
//! `passes.ron`.
//!
//! A change that is not meant to regroup systems changes none of it; a commit that does says why, and writes it anew:
//! `SINEW_GOLDEN=write cargo test --test scenes passes`. No GPU is needed.

use super::scene;
use super::shipped::SCENES;
use serde::{Deserialize, Serialize};
use sinew::components::Precision;
use sinew::systems::Registry;
use sinew::{BackendChoice, Options, Simulation};
use std::collections::BTreeMap;

#[derive(Debug, Default, Deserialize, Serialize, PartialEq)]
struct Passes {
    /// Systems that share a pass, in their order.
    cpu: Vec<String>,
    /// Kernels with the systems that they are of, how many dispatches of them a step takes, and how bodies are taken
    /// through a step.
    gpu: Vec<String>,
}

fn passes(simulation: &mut Simulation) -> Passes {
    let registry = Registry::default();
    let mut cpu: Vec<String> = Vec::new();
    for system in simulation.explain(&registry).unwrap().systems {
        let is_first = cpu.iter().all(|pass| !pass.split(" + ").any(|name| name == system.name));
        let repeated = system.repeat.map_or(String::new(), |repeat| format!(" ({} times)", repeat.times));
        if is_first {
            let shared = system.shares_with.into_iter();
            cpu.push(std::iter::once(system.name).chain(shared).collect::<Vec<_>>().join(" + ") + &repeated);
        }
    }
    let on_gpu = simulation.explain_on_gpu(&registry).unwrap();
    let kernels = on_gpu.kernels.iter().map(|of| format!("{}: {} × {}", of.system, of.entry, of.times));
    let gpu = kernels
        .chain(on_gpu.dispatched.iter().map(|of| {
            let parted = of.node_kernels.iter().filter(|kernel| !kernel.because.is_empty());
            let parted: String =
                parted.map(|of| format!("; after {}: {}", of.systems.join(" + "), of.because)).collect();
            format!(
                "{}: {}; {} nodes inside patches, {}{parted}",
                of.body, of.because, of.interior, of.interior_because
            )
        }))
        .collect();
    Passes { cpu, gpu }
}

#[test]
fn passes_of_shipped_scenes() {
    let path = format!("{}/tests/scenes/passes.ron", env!("CARGO_MANIFEST_DIR"));
    let mut now: BTreeMap<String, Passes> = BTreeMap::new();
    for (name, sets) in SCENES {
        let options =
            Options { backend: BackendChoice::Cpu, precision: Precision::F32, threads: 1, ..Options::default() };
        now.insert(name.into(), passes(&mut Simulation::new(&scene(name, sets), &options).unwrap()));
    }
    if std::env::var("SINEW_GOLDEN").is_ok_and(|what| what == "write") {
        let pretty = ron::ser::PrettyConfig::default();
        std::fs::write(&path, ron::ser::to_string_pretty(&now, pretty).unwrap() + "\n").unwrap();
    }
    let kept: BTreeMap<String, Passes> = ron::from_str(&std::fs::read_to_string(&path).unwrap_or("{}".into())).unwrap();
    for (name, passes) in &now {
        assert_eq!(Some(passes), kept.get(name), "{name}");
    }
    assert_eq!(now.len(), kept.len());
}

/// Threads are drawn before elements find their forces, and what observes may write all columns: which systems run at
/// trial displacements follows from what they make for others in the step, and from nothing else.
#[test]
fn trial_displacements_run_what_finds_forces_and_no_more() {
    let sutured = scene("hard/h62_suture", &["solver=Implicit(step: 0.01)"]);
    let options = Options { backend: BackendChoice::Cpu, threads: 1, ..Options::default() };
    let explained = Simulation::new(&sutured, &options).unwrap().explain(&Registry::default()).unwrap();
    let said = explained.solver.unwrap().of;
    let wanted = "a pass is suture_tension, element_forces, gather + suture, at trial displacements";
    assert!(said.iter().any(|line| line.starts_with(wanted)), "{said:#?}");
}
