//! Sweeps of contact and glue are what the plan of a step repeats: on a GPU their kernels are made once, and dispatched
//! as often as the plan says.

use crate::configurations::cpu_and_long_gpu;
use sinew::backend::device::Device;
use sinew::explain::Explanation;
use sinew::systems::Registry;
use sinew::{BackendChoice, Simulation};

const STEPS: u64 = 10;

/// Two blocks at rest, of which nothing moves any node.
fn blocks(more: &str) -> String {
    let block = |at: f64| {
        format!("(mesh: Box(size: (0.01, 0.01, 0.01), cells: (2, 2, 2)), material: \"m\", translate: (0, 0, {at}))")
    };
    format!(
        "(duration: 1, bodies: {{\"low\": {}, \"high\": {}}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.3))}}, {more})",
        block(0.0),
        block(0.01),
    )
}

/// Dispatches of some steps on a GPU.
fn dispatches(simulation: &mut Simulation) -> u64 {
    let count = |simulation: &mut Simulation| simulation.world_mut().resource_mut::<Device>().gpu().dispatches();
    let before = count(simulation);
    simulation.advance(STEPS).unwrap();
    count(simulation) - before
}

/// How often each kernel of a system is dispatched in a step, by its label.
fn listed(explained: &Explanation, system: &str) -> Vec<(String, usize)> {
    let of_system = explained.kernels.iter().filter(|kernel| kernel.system == system);
    of_system.map(|kernel| (kernel.label.clone(), kernel.times)).collect()
}

#[test]
fn sweeps_are_listed_once_and_dispatched_as_often_as_the_plan_says() {
    let apart = "contacts: [Between(bodies: (\"low\", \"high\"), sweeps: SWEEPS MORE)]";
    let glued = "attachments: [Glue(bodies: (\"low\", \"high\"), sweeps: SWEEPS)]";
    for (what, system, a_sweep) in [
        (apart.replace(" MORE", ""), "surface_contact", 2),
        (apart.replace(" MORE", ", friction: 0.4"), "surface_contact", 4),
        (apart.replace(" MORE", ", points: Faces, edges: true"), "surface_contact", 2),
        (glued.to_owned(), "glue", 2),
    ] {
        let text = |sweeps: usize| blocks(&what.replace("SWEEPS", &sweeps.to_string()));
        for run in cpu_and_long_gpu() {
            let mut simulations = [1, 5].map(|sweeps| run.start(&text(sweeps)));
            let on_gpu = run.options.backend == BackendChoice::Gpu;
            if on_gpu {
                let [once, often] = simulations.each_mut().map(dispatches);
                assert_eq!(often - once, STEPS * 4 * a_sweep as u64, "{once} and {often} of {what}");
            }
            let [once, often] =
                simulations.each_mut().map(|simulation| simulation.explain(&Registry::default()).unwrap());
            let repeat = |explained: &Explanation| {
                let found = explained.systems.iter().find(|found| found.name == system).unwrap();
                found.repeat.as_ref().map(|repeat| (repeat.times, repeat.what.len()))
            };
            assert_eq!((repeat(&once), repeat(&often)), (None, Some((5, a_sweep))), "{} {what}", run.name);
            if !on_gpu {
                continue;
            }
            let [once, often] = [once, often].map(|explained| listed(&explained, system));
            let labels = |of: &[(String, usize)]| of.iter().map(|(label, _)| label.clone()).collect::<Vec<_>>();
            assert_eq!(labels(&once), labels(&often), "{what}");
            assert!(once.iter().all(|(_, times)| *times == 1), "{once:?}");
            let repeated: Vec<&(String, usize)> = often.iter().filter(|(_, times)| *times == 5).collect();
            assert_eq!(repeated.len(), a_sweep, "{often:?}");
        }
    }
}
