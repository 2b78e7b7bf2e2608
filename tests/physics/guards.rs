//! The guards: samples see what energies and fields say, limits end a run and warn, and nothing that is no number is
//! found late or written.

use crate::configurations::{configurations, cpu_and_long_gpu, scene_of};
use crate::element_turns::with_elements;
use sinew::bevy_ecs::prelude::*;
use sinew::components::*;
use sinew::observation::{HOST_GUARD_STEPS, sample};
use sinew::output::Folder;
use sinew::systems::{Phase, Registry, System};
use sinew::{BackendChoice, Error, Instability, Simulation, Snapshot};
use std::path::Path;

fn scene(elements: &str, effects: &str, further: &str) -> String {
    format!(
        "(duration: 100, bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (3, 3, 5), elements: {elements}),
            material: \"m\", spin: (1, 2, 8))}},
        materials: {{\"m\": (density: 1000, {effects} neo_hookean: Young(young: 3e3, poisson: 0.45))}},
        {further} integration: (safety: 0.7))"
    )
}

/// A sample is the same as what is computed on the host in f64, one element after the other. f32: a part of 1e5 of the
/// energies by the rounding of strains of 1e-2.
#[test]
#[ignore = "long"]
fn samples_see_the_energies_and_the_most_squeezed_element() {
    let fibres = "fibres: (eta: 2000, direction: Around(center: (0.05, -0.1, 0), axis: (0, 0, 1))),
        exponential_fibres: [(k1: 500, k2: 0.5, direction: Along(1, 1, 0))],";
    for (run, elements) in with_elements(&configurations(), 1) {
        let gravity = "loads: [Gravity(acceleration: (0, 0, -9.81))], constraints: [Fixed(on: Set(\"z0\"))],
            removal: [(on: Sphere(center: (0.1, 0.1, 0.1), radius: 0.03), when: At(0.01))],";
        for (effects, further) in [("", ""), (fibres, gravity)] {
            let mut simulation = run.start(&scene(elements, effects, further));
            simulation.advance(60).unwrap();
            let energies = simulation.energies().unwrap();
            let fields = simulation.fields("b").unwrap();
            let seen = sample(simulation.world_mut()).unwrap();
            let name = format!("{}, {elements}", run.name);
            let sum =
                |of: fn(&sinew::backend::cpu::BlockSums) -> f64| seen.parts.iter().map(|(_, s)| of(s)).sum::<f64>();
            let scale = energies.kinetic + energies.strain;
            let near = |what: &str, a: f64, b: f64| {
                assert!((a - b).abs() <= run.bound(1e-12, 1e-5) * scale, "{name}: {what} {a:e} instead of {b:e}");
            };
            near("kinetic", seen.kinetic, energies.kinetic);
            near("strain", sum(|s| s.strain), energies.strain);
            near("hourglass", sum(|s| s.hourglass), energies.hourglass);
            assert!(energies.strain > 1e-3 * scale, "{name}: too little strain to say something");
            let fastest = fields.velocity.iter().map(|v| v.length()).fold(0.0, f64::max);
            assert!((seen.fastest.unwrap().2 / fastest - 1.0).abs() < 1e-5, "{name}: {:?}", seen.fastest);
            // J in the middle of the step and at points, against means at its end
            let least = seen.parts.iter().map(|(_, s)| s.least_volume_ratio).fold(f64::MAX, f64::min);
            let mean = fields.volume_ratio.iter().copied().fold(f64::MAX, f64::min);
            // points of elements of second order are farther from their means
            let below = if elements == "Tet10" { 0.4 } else { 0.2 };
            assert!(least < mean + 1e-2 && least > mean - below, "{name}: J {least}, {mean} at the end of the step");
        }
    }
}

/// The work that is always counted is the work that is counted in full where energies are asked for.
#[test]
fn work_against_internal_forces_is_counted_without_being_asked_for() {
    let moved =
        "Prescribed(on: Set(\"z1\"), displacement: (0.01, 0, 0.01), rotation: (0, 0, 20), curve: Smooth(end: 0.2)), ";
    for (run, moved) in cpu_and_long_gpu().iter().flat_map(|run| ["", moved].map(|moved| (run, moved))) {
        let of = |output: &str| {
            let further = format!(
                "loads: [Gravity(acceleration: (0, 0, -9.81))], constraints: [{moved} Fixed(on: Set(\"z0\"))], {output}"
            );
            let mut simulation = run.start(&scene("Hex8", "damping: 3,", &further));
            simulation.advance(300).unwrap();
            let done = sample(simulation.world_mut()).unwrap().internal_work;
            (done, simulation.energies().unwrap())
        };
        let ((done, plain), (asked, full)) = (of(""), of("output: (energies_every: 1),"));
        assert!(plain.internal_work.is_none() && full.internal_work == Some(asked));
        let error = (done / asked - 1.0).abs();
        println!("{}: {done:e} J, {asked:e} J: {error:e}", run.name);
        // kept in f32, the steps of prescribed nodes have 1e-7 of their digits
        let bound = run.bound(if moved.is_empty() { 1e-9 } else { 1e-6 }, 1e-5);
        assert!(error < bound, "{}: {done:e} instead of {asked:e}", run.name);
        assert!((full.strain + full.hourglass - asked).abs() < 0.02 * asked, "{full:?}");
    }
}

#[test]
fn a_sound_run_is_checked_and_warned_of_nothing() {
    for (run, elements) in configurations().iter().flat_map(|run| ["Tet4", "Hex8"].map(|elements| (run, elements))) {
        let further = "loads: [Gravity(acceleration: (0, 0, -9.81), curve: Smooth(end: 0.05))],
            constraints: [Fixed(on: Set(\"z0\"))], guards: (every: 50),";
        let mut simulation = run.start(&scene(elements, "", further).replace("spin: (1, 2, 8)", ""));
        simulation.advance(400).unwrap();
        let guards = simulation.guards();
        println!("{}, {elements}: {guards:?}", run.name);
        assert_eq!(guards.checks, 8);
        assert!(guards.imbalance.abs() < 0.01 && guards.imbalance != 0.0, "{guards:?}");
        assert!(guards.warnings.is_empty(), "{guards:?}");
        let least = guards.least_volume_ratio.unwrap();
        assert!(least.value < 1.0 && least.value > 0.5 && least.body == "b", "{least:?}");
    }
}

fn broken(result: Result<(), Error>) -> Box<Instability> {
    match result {
        Err(Error::Unstable(broken)) => broken,
        other => panic!("{other:?}"),
    }
}

/// Elements that hold more than work was ever done on them, because the sum was forged.
#[test]
fn energy_from_nothing_is_warned_of_and_ends_the_run_at_the_limits_of_the_scene() {
    let lenient = "guards: (every: 8, energy: (stop: 1e3)),";
    for run in cpu_and_long_gpu() {
        for (limits, ends) in [("", true), (lenient, false), ("guards: (off: [Energy]),", false)] {
            let mut simulation = run.start(&scene("Hex8", "", limits));
            simulation.advance(30).unwrap();
            let good = simulation.snapshot().unwrap();
            let forged = forged(&mut simulation, good);
            simulation.restore(&forged).unwrap();
            let ended = simulation.advance(600);
            let mut warned = simulation.guards().warnings;
            warned.retain(|notice| notice.criterion == "energy");
            if ends {
                let broken = broken(ended);
                assert_eq!(broken.criterion.name, "energy");
                assert!(broken.criterion.value > broken.criterion.limit && broken.criterion.limit == Some(0.05));
                assert!(broken.to_string().contains("guards.energy.stop"), "{broken}");
                assert_eq!(warned.len(), 1, "{warned:?}");
                assert!(simulation.failure().is_some());
            } else {
                ended.unwrap();
                assert_eq!(warned.len(), usize::from(!limits.contains("off")), "{limits}: {warned:?}");
            }
        }
    }
}

/// The snapshot with the accumulated work taken out of it.
fn forged(simulation: &mut Simulation, good: Snapshot) -> Snapshot {
    simulation.restore(&good).unwrap();
    let world = simulation.world_mut();
    let bodies: Vec<Entity> = world.query_filtered::<Entity, With<InternalWork>>().iter(world).collect();
    for body in bodies {
        world.get_mut::<InternalWork>(body).unwrap().fill(-1.0);
    }
    simulation.snapshot().unwrap()
}

/// H27: what a custom system writes is found within sixteen steps; the node is named.
#[test]
fn what_is_no_number_is_found_within_a_few_steps_with_the_first_node() {
    fn spoil_force(clock: Res<Clock>, mut bodies: Query<&mut ExternalForce>) {
        for mut force in bodies.iter_mut().filter(|_| clock.step == 40) {
            force.set(3 * 7 + 1, f64::NAN);
        }
    }
    fn spoil_mass(clock: Res<Clock>, mut bodies: Query<&mut Mass>) {
        for mut mass in bodies.iter_mut().filter(|_| clock.step == 40) {
            mass.set(7, f64::NAN);
        }
    }
    fn spoil_place(clock: Res<Clock>, mut bodies: Query<&mut Displacement>) {
        for mut u in bodies.iter_mut().filter(|_| clock.step == 40) {
            u.set(3 * 7, f64::INFINITY);
        }
    }
    let systems = [
        System::custom("spoil", Phase::Loads, "spoils", spoil_force),
        System::custom("spoil", Phase::Loads, "spoils", spoil_mass),
        System::custom("spoil", Phase::Loads, "spoils", spoil_place),
    ];
    let file = scene_of(
        &scene("Tet4", "", "schedule: [\"element_forces\", \"gather\", \"spoil\", \"integrate\", \"observe\"],"),
        Path::new("."),
    );
    for system in systems {
        let registry = Registry::default().with(system);
        for run in configurations() {
            let mut simulation = Simulation::with_systems(&file, &run.options, &registry).unwrap();
            let broken = broken(simulation.advance(200));
            assert!(broken.step > 40 && broken.step <= 40 + HOST_GUARD_STEPS, "{}: {broken}", run.name);
            assert_eq!(broken.criterion.name, "not_finite", "{}: {broken}", run.name);
            let body = simulation.body("b").unwrap();
            let node = simulation.world().get::<Authoring>(body).unwrap().node_id(7);
            // on the GPU the lowest row that was lost until then
            if run.options.backend == BackendChoice::Cpu {
                assert_eq!(broken.criterion.node, Some(node), "{}: {broken}", run.name);
            }
        }
    }
}

/// H19: a hundred times its weight at once. Either all goes on in balance, or the run stops and says where.
#[test]
#[ignore = "long"]
fn sudden_weight_ends_in_balance_or_with_a_reason() {
    for (run, elements) in configurations().iter().flat_map(|run| ["Tet4", "Hex8"].map(|elements| (run, elements))) {
        let mut simulation = run.start(&format!(
            "(duration: 0.05, bodies: {{\"b\": (mesh: Box(size: (0.1, 0.02, 0.02), cells: (10, 2, 2), elements: {elements}), material: \"m\")}},
            materials: {{\"m\": (density: 1000, neo_hookean: Moduli(shear: 1e4, bulk: 496667))}},
            constraints: [Fixed(on: Set(\"x0\"))], loads: [Gravity(acceleration: (0, 0, -981))])"
        ));
        match simulation.finish() {
            Ok(()) => {
                let guards = simulation.guards();
                assert!(guards.imbalance.abs() < 0.05, "{}, {elements}: {guards:?}", run.name);
            }
            Err(Error::Unstable(broken)) => {
                println!("{}, {elements}: {broken}", run.name);
                assert!(broken.criterion.element.is_some() || broken.criterion.name == "energy", "{broken:?}");
            }
            Err(other) => panic!("{other}"),
        }
    }
}

/// H24: an end that jumps by its whole length.
#[test]
fn a_jump_of_all_the_length_ends_the_run_and_asks_for_a_ramp() {
    for run in configurations() {
        for along in ["0.04", "-0.05"] {
            let mut simulation = run.start(&format!(
                "(duration: 0.1, bodies: {{\"b\": (mesh: Box(size: (0.04, 0.02, 0.02), cells: (2, 1, 1), elements: Hex8), material: \"m\")}},
                materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3000, poisson: 0.45))}},
                constraints: [Fixed(on: Set(\"x0\")), Prescribed(on: Set(\"x1\"), displacement: ({along}, 0, 0))])"
            ));
            let broken = broken(simulation.finish());
            println!("{}: {broken}", run.name);
            assert!(broken.cause.contains("use a ramp") && broken.cause.contains("jumps"), "{broken}");
        }
    }
}

/// The ends of a bar are pushed through their cells within one check, one after the other: the first is named,
/// whichever has the lower number.
#[test]
fn the_first_element_that_turns_inside_out_is_named() {
    for run in configurations() {
        for (first, [near, far]) in [(0, [0.0, 0.01]), (3, [0.01, 0.0])] {
            let mut simulation = run.start(&format!(
                "(duration: 1, bodies: {{\"b\": (mesh: Box(size: (0.1, 0.025, 0.025), cells: (4, 1, 1), elements: Hex8), material: \"m\")}},
                materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}},
                constraints: [Fixed(on: Box(min: (0.01, 0, 0), max: (0.09, 1, 1))),
                    Prescribed(on: Set(\"x0\"), displacement: (0.05, 0, 0), curve: Ramp(start: {near}, end: {})),
                    Prescribed(on: Set(\"x1\"), displacement: (-0.05, 0, 0), curve: Ramp(start: {far}, end: {}))],
                integration: (step: 1e-3, when_unstable: Watch), guards: (off: [Energy]))",
                near + 0.01,
                far + 0.01
            ));
            let broken = broken(simulation.finish());
            assert_eq!(broken.criterion.element, Some(first), "{}: {broken}", run.name);
        }
    }
}

#[test]
fn hourglass_energy_of_a_part_is_warned_of_once() {
    let reasons = [("Hex8", "elements with one point do not feel"), ("Tet10", "to which it is held; use a finer mesh")];
    for (run, (elements, reason)) in configurations().iter().flat_map(|run| reasons.map(|reason| (run, reason))) {
        let mut simulation = run.start(&format!(
            "(duration: 0.2, bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (2, 2, 2), elements: {elements}), material: \"m\")}},
            materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}},
            constraints: [Fixed(on: Set(\"z0\"))],
            loads: [NodalForce(on: Box(min: (0.1, 0.1, 0.1), max: (0.1, 0.1, 0.1)), force: (0, 0, -0.5), curve: Smooth(end: 0.1))],
            guards: (every: 20, hourglass: 0.05))"
        ));
        simulation.finish().unwrap();
        let guards = simulation.guards();
        println!("{}: {guards:?}", run.name);
        let of_hourglass = guards.warnings.iter().filter(|w| w.criterion == "hourglass").collect::<Vec<_>>();
        assert_eq!(of_hourglass.len(), 1, "{guards:?}");
        assert_eq!(of_hourglass[0].part, format!("b/m/{elements}"));
        assert!(of_hourglass[0].message.contains(reason), "{guards:?}");
        assert!(of_hourglass[0].value > 0.05 && guards.hourglass[&of_hourglass[0].part] >= of_hourglass[0].value);
    }
}

#[test]
fn last_states_before_a_breakdown_are_written_and_can_be_gone_on_from() {
    for run in configurations() {
        let text = "(duration: 1, bodies: {\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (2, 2, 2), elements: Tet4), material: \"m\")},
            materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))},
            constraints: [Fixed(on: Set(\"z0\"))],
            loads: [Gravity(acceleration: (0, 0, -2000), curve: Step(start: 0.6))], guards: (every: 4, window: 2))";
        let folder = tempfile::tempdir().unwrap();
        let mut simulation = run.start(text);
        simulation.write_into(&mut Folder::create(folder.path()).unwrap()).unwrap();
        let broken = broken(simulation.finish());
        let good = broken.last_good.as_ref().unwrap_or_else(|| panic!("{}: {broken}", run.name));
        assert!(good.step < broken.step && good.step > 0, "{broken}");
        let told = broken.to_string();
        let resume = told.split_once("--resume ").map(|(_, rest)| rest).unwrap_or_default();
        assert!(resume.contains(&good.snapshot), "{broken}");
        let series = std::fs::read_to_string(folder.path().join(&good.series)).unwrap();
        // on a GPU states are kept in every sixteenth check
        let few = if run.options.backend == BackendChoice::Gpu { 1 } else { 2 };
        assert!(series.matches("<DataSet").count() >= few, "{}: {series}", run.name);
        let kept = Snapshot::read(&folder.path().join(&good.snapshot)).unwrap();
        assert_eq!((kept.step(), kept.time()), (good.step, good.time));
        let mut again = run.start(text);
        again.restore(&kept).unwrap();
        let broken_again = match again.finish() {
            Err(Error::Unstable(broken)) => broken,
            other => panic!("{other:?}"),
        };
        assert_eq!((&broken_again.what, broken_again.step), (&broken.what, broken.step), "{}", run.name);
    }
}

/// Who begins inside is thrown out by springs, with energy that nobody had: told, once. Who comes to them from outside
/// gets back what it had, and a kinematic law has no springs.
#[test]
fn energy_that_springs_of_contact_make_is_told_of() {
    for run in cpu_and_long_gpu() {
        let warned = |law: &str, begins: f64, velocity: f64| {
            let text = format!(
                "(duration: 1, bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (2, 2, 2), elements: Hex8),
                    translate: (0, 0, {begins}), velocity: (0, 0, {velocity}), material: \"m\")}},
                materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e4, poisson: 0.3))}},
                tools: {{\"table\": (shape: Plane())}}, contacts: [Tool(tool: \"table\", law: {law})],
                guards: (every: 50), integration: (safety: 0.5))"
            );
            let mut simulation = run.start(&text);
            simulation.advance(400).unwrap();
            let warnings = simulation.guards().warnings;
            let told: Vec<_> = warnings.into_iter().filter(|warning| warning.criterion == "contact").collect();
            assert!(told.len() <= 1 && told.iter().all(|warning| warning.value > 0.01), "{}: {told:?}", run.name);
            !told.is_empty()
        };
        let springs = "Penalty(share: 0.1)";
        assert!(warned(springs, -2e-4, 0.0), "{}: pushed out", run.name);
        assert!(!warned(springs, 1e-4, -0.1), "{}: bounces", run.name);
        assert!(!warned("Kinematic", 1e-4, -0.1), "{}: stops", run.name);
    }
}

/// One sweep of contact cannot give more energy than its law says: it is looked for where somebody looks, nothing is
/// found in a collision, and what is forged ends the run by name.
#[test]
fn energy_that_contact_cannot_give_ends_the_run() {
    for run in configurations().into_iter().filter(|run| run.options.backend == BackendChoice::Cpu) {
        let cube = "mesh: Box(size: (0.02, 0.02, 0.02), cells: (3, 3, 3)), material: \"m\"";
        let mut simulation = run.start(&format!(
            "(duration: 1, bodies: {{\"a\": ({cube}),
                \"b\": ({cube}, rotate: (20, 35, 10), translate: (0.002, 0.008, 0.028), velocity: (-0.1, 0.02, -0.5))}},
            materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}}, guards: (every: 5),
            contacts: [Between(bodies: (\"a\", \"b\"), friction: 0.4)])"
        ));
        simulation.advance_to(0.04).unwrap();
        let gain = *simulation.world().resource::<ContactGain>();
        assert!(gain.steps > 3 && gain.energy == 0.0, "{}: {gain:?}", run.name);
        simulation.world_mut().resource_mut::<ContactGain>().energy = 1e-6;
        let broken = match simulation.advance(5) {
            Err(Error::Unstable(broken)) => broken,
            other => panic!("{}: {other:?}", run.name),
        };
        assert_eq!((broken.criterion.name, broken.criterion.value), ("contact", Some(1e-6)), "{}", run.name);
        assert!(broken.what.contains("1.000e-6 J"), "{}", broken.what);
    }
}
