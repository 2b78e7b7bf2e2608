//! Systems that share a pass over the nodes give what they give by themselves: on the CPU the same bits; on a GPU,
//! where compilers may round sums otherwise, 1e-5 of the displacement after 200 steps.

use crate::configurations::{Configuration, configurations, scene_of};
use bevy_ecs::prelude::*;
use glam::DVec3;
use sinew::backend::device::{Device, bring_to_host, send_to_device};
use sinew::components::{
    Column, DisplacementIncrement, ExternalForce, InternalForce, InternalWork, Mass, Patches, Precision, RemovalStep,
    Scheme,
};
use sinew::systems::{Phase, Registry, System};
use sinew::{BackendChoice, Options, SceneFile, Simulation};
use std::path::Path;

fn scene(more: &str, loads: &str, fuse: bool) -> String {
    format!(
        "(duration: 10, bodies: {{
            \"a\": (mesh: Box(size: (1, 1, 1), cells: (3, 3, 3), elements: Tet4), material: \"m\"),
            \"b\": (mesh: Box(size: (1, 1, 1), cells: (3, 3, 3), elements: Hex8), material: \"m\", translate: (2, 0, 0))}},
        materials: {{\"m\": (density: 1000, damping: 0.5, neo_hookean: Young(young: 3e3, poisson: 0.45))}},
        constraints: [
            Fixed(body: \"a\", on: Plane(normal: (0, 0, 1), at: 0)),
            Prescribed(body: \"a\", on: Plane(normal: (0, 0, 1), at: 1), axes: [Z], displacement: (0, 0, -0.1), curve: Smooth(end: 1)),
            Prescribed(body: \"b\", on: Plane(normal: (0, 0, 1), at: 0), rotation: (0, 0, 20), curve: Smooth(end: 1))],
        loads: [Gravity(acceleration: (0, 1, -9.81)), {loads}
            NodalForce(body: \"a\", on: Plane(normal: (1, 0, 0), at: 1), force: (0.5, 0, 0)),
            NodalForce(body: \"a\", on: Plane(normal: (0, 1, 0), at: 1), force: (0, 0.7, 0)),
            Traction(body: \"b\", on: Surface(normal: (1, 0, 0)), traction: (30, 20, 10))],
        integration: (step: 0.002), fuse: {fuse}, {more})"
    )
}

const PRESSURE: &str = "Pressure(body: \"b\", on: Surface(normal: (0, 0, 1)), pressure: 100),";

fn end(run: &Configuration, text: &str) -> Vec<DVec3> {
    let mut simulation = run.start_in(text, Path::new("."));
    simulation.advance(200).unwrap_or_else(|error| panic!("{error}"));
    let bodies = ["a", "b"].map(|body| {
        let entity = simulation.body(body).unwrap();
        let mut all = simulation.displacements(body).unwrap();
        bring_to_host(simulation.world_mut(), |_, _| true).unwrap();
        all.extend(simulation.world().get::<ExternalForce>(entity).unwrap().vectors().map(|force| 1e-3 * force));
        if run.options.backend == BackendChoice::Cpu {
            all.extend(simulation.world().get::<InternalForce>(entity).unwrap().vectors());
        }
        all
    });
    bodies.concat()
}

#[test]
#[ignore = "long"]
fn a_shared_pass_changes_nothing() {
    for (more, loads) in [("", ""), ("output: (energies_every: 0.1)", ""), ("", PRESSURE)] {
        for run in configurations() {
            let (shared, apart) = (end(&run, &scene(more, loads, true)), end(&run, &scene(more, loads, false)));
            if run.options.backend == BackendChoice::Gpu {
                let largest = apart.iter().map(|u| u.length()).fold(0.0, f64::max);
                let off = shared.iter().zip(&apart).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
                assert!(off <= 1e-5 * largest, "{}: {off:e} of {largest:e}", run.name);
            } else {
                assert_eq!(shared, apart, "{} {loads}", run.name);
            }
        }
    }
}

/// Steps, dispatches and submissions of two small bodies on a GPU (one of more elements than invocations, one of more
/// nodes), where they are in the end, and the work against internal forces (J) that the guards go by.
fn small_bodies(run: &Configuration, effect: &str, output: &str, fuse: bool) -> ([u64; 3], Vec<DVec3>, [f64; 2]) {
    let text = format!(
        "(duration: 10, bodies: {{
            \"a\": (mesh: Box(size: (1, 1, 1), cells: (5, 4, 5), elements: Tet4), material: \"m\"),
            \"b\": (mesh: Box(size: (1, 1, 15), cells: (2, 2, 30), elements: Hex8), material: \"m\", translate: (2, 0, 0))}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45), {effect})}},
        constraints: [
            Prescribed(body: \"a\", on: Plane(normal: (0, 0, 1), at: 1), displacement: (0, 0, -0.1), rotation: (0, 0, 20), curve: Smooth(end: 0.5))],
        loads: [Gravity(body: \"b\", acceleration: (0, 1, -9.81)),
            NodalForce(body: \"b\", on: Plane(normal: (1, 0, 0), at: 3), force: (0.5, 0, 0), curve: Smooth(end: 0.3))],
        integration: (step: 0.002, compensated: false), guards: (every: 5000), {output} fuse: {fuse})"
    );
    let mut simulation = run.start_in(&text, Path::new("."));
    let counts = |simulation: &mut Simulation| {
        let steps = simulation.step_count();
        let mut device = simulation.world_mut().resource_mut::<Device>();
        [steps, device.gpu().dispatches(), device.gpu().submissions()]
    };
    let before = counts(&mut simulation);
    // submissions of one step, of a few, of many
    for steps in [1, 7, 292] {
        simulation.advance(steps).unwrap_or_else(|error| panic!("{error}"));
    }
    let after = counts(&mut simulation);
    let ends = ["a", "b"].map(|body| simulation.displacements(body).unwrap()).concat();
    bring_to_host(simulation.world_mut(), |_, _| true).unwrap();
    let done = ["a", "b"].map(|body| {
        let body = simulation.body(body).unwrap();
        let body = simulation.world().entity(body);
        body.get::<InternalWork>().map_or(0.0, InternalWork::total)
    });
    ([0, 1, 2].map(|i| after[i] - before[i]), ends, done)
}

/// The same operations in the same order, but compilers may contract them otherwise: see above.
#[test]
#[ignore = "long"]
fn small_bodies_take_many_steps_in_one_dispatch() {
    let Some(run) = configurations().into_iter().find(|run| run.options.backend == BackendChoice::Gpu) else { return };
    // where energies are observed, integrate counts them node by node, and invocations need not meet for that
    for (effect, output) in [("prony: (terms: [(alpha: 0.4, tau: 0.05)])", ""), ("", "output: (energies_every: 5),")] {
        let ([steps, dispatches, submissions], together, done) = small_bodies(&run, effect, output, true);
        let looks = u64::from(steps.ilog2()) + 1; // of guards after step 1, 2, 4 … 256, at nodes and elements of both
        assert_eq!((steps, dispatches), (300, 2 * (submissions - looks) + 4 * looks));
        assert!(submissions < 100, "{submissions}");
        let ([steps, dispatches, _], apart, done_apart) = small_bodies(&run, effect, output, false);
        // element forces, gather, boundary or two loads, integrate
        assert_eq!(dispatches, (4 + 5) * steps + 4 * looks);
        let largest = apart.iter().map(|u| u.length()).fold(0.0, f64::max);
        let off = together.iter().zip(&apart).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        assert!(off <= 1e-5 * largest && largest > 0.1, "{off:e} of {largest:e}");
        // forces along steps: off as displacements are
        for (done, apart) in done.into_iter().zip(done_apart) {
            assert!(
                (done - apart).abs() <= 1e-5 * apart.abs() && (apart > 1e-3) == output.is_empty(),
                "{done} J instead of {apart} J"
            );
        }
    }
}

fn who_shares(text: &str, registry: &Registry) -> Vec<(String, Vec<String>)> {
    let scene =
        SceneFile::from_text("pass.ron", text, Path::new("."), &[]).unwrap_or_else(|e| panic!("{}", e.render(false)));
    let options = Options { backend: BackendChoice::Cpu, ..Options::default() };
    let mut simulation = Simulation::with_systems(&scene, &options, registry).unwrap_or_else(|e| panic!("{e}"));
    let explained = simulation.explain(registry).unwrap();
    explained.systems.into_iter().map(|system| (system.name, system.shares_with)).collect()
}

fn shares(text: &str, registry: &Registry, one: &str, other: &str) -> bool {
    let all = who_shares(text, registry);
    let (_, with) = all.iter().find(|(name, _)| name == one).unwrap();
    with.iter().any(|name| name == other)
}

/// The plan says how the forces of each body are summed, and its system alone.
#[test]
fn how_forces_are_summed_is_told() {
    let scene = SceneFile::from_text("pass.ron", &scene("", "", true), Path::new("."), &[]).unwrap();
    for (scheme, word) in [(Scheme::Patches, "patch by patch"), (Scheme::TwoPass, "in two passes")] {
        let options = Options { backend: BackendChoice::Cpu, scheme: Some(scheme), ..Options::default() };
        let explained = Simulation::new(&scene, &options).unwrap().explain(&Registry::default()).unwrap();
        let told = explained.systems.iter().filter_map(|system| Some((system.name.as_str(), system.sums.as_ref()?)));
        let told: Vec<_> = told.collect();
        assert!(matches!(&told[..], [("element_forces", sums)] if sums.contains(word)), "{told:?}");
    }
}

/// Boundary waits for the nodes to move, unless somebody in between looks at the steps it writes.
#[test]
fn who_shares_a_pass_is_told_and_what_must_stay_apart_does() {
    fn looks(steps: Query<&DisplacementIncrement>) {
        let _ = steps.iter().count();
    }
    fn pushes(mut forces: Query<&mut ExternalForce>) {
        let _ = forces.iter_mut().count();
    }
    let registry = Registry::default()
        .with(System::custom("looks", Phase::ElementForces, "looks at steps", looks))
        .with(System::custom("pushes", Phase::Loads, "pushes", pushes));
    // without a schedule those that are added take part
    let none = Registry::default();
    let plain = scene("", "", true);
    assert!(shares(&plain, &none, "boundary", "integrate") && shares(&plain, &none, "gravity", "gather"));
    assert!(shares(&plain, &none, "element_forces", "integrate"));
    assert!(!shares(&scene("", "", false), &none, "gravity", "gather"));
    assert!(shares(&scene("", PRESSURE, true), &none, "pressure", "integrate"));
    assert!(!shares(&plain, &registry, "boundary", "integrate"));
    let with = |own: [&str; 2]| {
        let all = [
            "boundary",
            own[0],
            "element_forces",
            "gather",
            "gravity",
            own[1],
            "nodal_force",
            "traction",
            "integrate",
            "observe",
        ];
        let names: Vec<String> = all.iter().filter(|name| !name.is_empty()).map(|name| format!("\"{name}\"")).collect();
        scene(&format!("schedule: [{}]", names.join(", ")), "", true)
    };
    assert!(shares(&with(["", ""]), &registry, "boundary", "integrate"));
    assert!(!shares(&with(["looks", ""]), &registry, "boundary", "integrate"));
    assert!(shares(&with(["looks", ""]), &registry, "gravity", "integrate"));
    assert!(!shares(&with(["", "pushes"]), &registry, "gravity", "integrate"));
    assert!(!shares(&with(["", "pushes"]), &registry, "element_forces", "gather"));
}

/// A body of several blocks and patches, one corner of which is torn inside out.
fn torn(fuse: bool) -> String {
    format!(
        "(duration: 10, bodies: {{\"a\": (mesh: Box(size: (1, 1, 1), cells: (9, 9, 9), elements: Hex8), material: \"m\",
            regions: [(on: Sphere(center: (0, 0, 0), radius: 0.5), material: \"n\")])}},
        materials: {{
            \"m\": (density: 1000, inversion: Remove, neo_hookean: Young(young: 3e3, poisson: 0.45)),
            \"n\": (density: 900, inversion: Remove, neo_hookean: Young(young: 1e3, poisson: 0.4))}},
        constraints: [Prescribed(body: \"a\", on: Plane(normal: (0, 0, 1), at: 0), displacement: (0, 0, 0.02), curve: Smooth(end: 0.05))],
        loads: [Gravity(acceleration: (0, 1, -9.81)),
            NodalForce(body: \"a\", on: Box(min: (0, 0.9, 0.9), max: (0.1, 1, 1)), force: (400, -300, -600))],
        guards: (off: [Energy]), integration: (step: 0.001), fuse: {fuse})"
    )
}

/// The nodes inside patches move with their patch, those of patches with inverted elements after a check of them.
#[test]
fn nodes_inside_patches_go_where_they_go_with_all_others() {
    for run in configurations().into_iter().filter(|run| run.options.backend == BackendChoice::Cpu) {
        let ends = [true, false].map(|fuse| {
            let mut simulation = run.start_in(&torn(fuse), Path::new("."));
            let interior = |simulation: &mut Simulation| -> u32 {
                let world = simulation.world_mut();
                world.query::<&Patches>().iter(world).flat_map(|patches| patches.interior.clone()).sum()
            };
            assert!((300..900).contains(&interior(&mut simulation)), "{}: {}", run.name, interior(&mut simulation));
            simulation.advance(60).unwrap_or_else(|error| panic!("{}: {error}", run.name));
            let world = simulation.world_mut();
            let gone: Vec<u32> = world.query::<&RemovalStep>().iter(world).flat_map(|steps| steps.0.clone()).collect();
            assert!(gone.iter().any(|&step| step < 60), "{}: no element was inverted", run.name);
            (gone, simulation.displacements("a").unwrap())
        });
        assert!(ends[0] == ends[1], "{}", run.name);
    }
}

/// All forces in the world (N), of what a body exerts and of what acts on it.
fn forces(internal: Query<&InternalForce>, external: Query<&ExternalForce>) -> Vec<DVec3> {
    internal.iter().flat_map(|force| force.vectors()).chain(external.iter().flat_map(|force| force.vectors())).collect()
}

/// Between steps after which nobody looks they go nowhere; a system of one's own finds them in every step, whoever
/// takes steps after the last, and a probe when it is due.
#[test]
fn forces_are_there_for_whoever_looks() {
    #[derive(Resource, Default)]
    struct Seen(Vec<Vec<DVec3>>);
    fn looks(mut seen: ResMut<Seen>, internal: Query<&InternalForce>, external: Query<&ExternalForce>) {
        seen.0.push(forces(internal, external));
    }
    let registry = Registry::default().with(System::custom("looks", Phase::Observe, "looks at forces", looks));
    let probe =
        "probes: {\"floor\": (what: Reaction, body: \"a\", on: Plane(normal: (0, 0, 1), at: 0), every: 0.006)},";
    let schedule = "schedule: [\"boundary\", \"element_forces\", \"gather\", \"gravity\", \"nodal_force\", \"pressure\", \"traction\", \"integrate\", \"looks\", \"observe\"],";
    for options in configurations().into_iter().map(|run| run.options).filter(|o| o.backend == BackendChoice::Cpu) {
        let run = |fuse: bool, more: &str, count: u64| {
            let text = scene(&format!("{probe} {more}"), PRESSURE, fuse);
            let file = scene_of(&text, Path::new("."));
            let mut simulation = Simulation::with_systems(&file, &options, &registry).unwrap_or_else(|e| panic!("{e}"));
            simulation.world_mut().init_resource::<Seen>();
            let (mut ends, mut probed) = (Vec::new(), Vec::new());
            for _ in 0..42 / count {
                simulation.advance(count).unwrap_or_else(|error| panic!("{error}"));
                ends.push(simulation.world_mut().run_system_cached(forces).unwrap());
                probed.push(simulation.summary("").unwrap().probes);
            }
            (std::mem::take(&mut simulation.world_mut().resource_mut::<Seen>().0), ends, probed)
        };
        for (more, count) in [("", 1), ("", 7), (schedule, 42)] {
            assert!(run(true, more, count) == run(false, more, count), "{:?} in steps of {count}", options.precision);
        }
        assert_eq!(run(true, schedule, 42).0.len(), 42);
    }
}

/// What acts on none of the nodes inside a block's patches is not in their kernel, nor in that of the other nodes.
#[test]
fn kernels_of_patches_have_only_what_acts_on_nodes_inside_them() {
    let registry = Registry::default();
    let explained = |text: &str| {
        let options = Options { backend: BackendChoice::Cpu, precision: Precision::F32, ..Options::default() };
        let scene = scene_of(text, Path::new("."));
        let mut simulation = Simulation::with_systems(&scene, &options, &registry).unwrap_or_else(|e| panic!("{e}"));
        simulation.explain_on_gpu(&registry).unwrap()
    };
    // a pressure on nodes that patches share, only: none of the others moves before it has looked
    let corner = torn(true)
        .replace("Sphere(center: (0, 0, 0), radius: 0.5)", "Box(min: (0, 0, 0), max: (0.1, 0.1, 0.1))")
        .replace(
            "loads: [",
            "loads: [Pressure(body: \"a\", on: Box(min: (0, 0, 0), max: (0.12, 0.12, 0)), pressure: 100), ",
        );
    let told = &explained(&corner).dispatched[0];
    let because = "`pressure` reads other nodes than its own, which must not have moved";
    assert_eq!((told.interior, told.interior_because.as_str()), (0, because));
    let explained = explained(&torn(true));
    let found = explained.kernels.iter().filter(|kernel| ["patch_step", "node_pass"].contains(&kernel.entry));
    let found: Vec<(&str, u32)> = found.map(|kernel| (kernel.label.as_str(), kernel.threads)).collect();
    let shared = explained.nodes as u32 - explained.dispatched[0].interior;
    let expected = [
        ("element_forces + gather + gravity + nodal_force + boundary + integrate of a/m/Hex8", 4 * 128),
        ("element_forces + gather + gravity + boundary + integrate of a/n/Hex8", 128),
        ("gather + gravity + boundary + integrate", shared),
    ];
    assert_eq!(found, expected);
}

/// A cube of several patches under gravity, turned at one end and pushed at a side.
fn turned(elements: &str, material: &str, more: &str, fuse: bool) -> String {
    format!(
        "(duration: 10, bodies: {{\"a\": (mesh: Box(size: (1, 1, 1), cells: {elements}), material: \"m\")}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45), {material})}},
        constraints: [Prescribed(body: \"a\", on: Plane(normal: (0, 0, 1), at: 0), displacement: (0, 0, 0.05), rotation: (0, 0, 5), curve: Smooth(end: 0.1))],
        loads: [Gravity(acceleration: (0, 1, -9.81)),
            NodalForce(body: \"a\", on: Plane(normal: (0, 1, 0), at: 1), force: (0.5, 0, 0)),
            Traction(body: \"a\", on: Surface(normal: (1, 0, 0)), traction: (30, 20, 10))],
        guards: (every: 5000), integration: (step: 0.001), {more} fuse: {fuse})"
    )
}

/// What became of "a" on a GPU.
#[derive(PartialEq)]
struct Run {
    ends: Vec<DVec3>,
    /// Each step.
    dispatches: u64,
    /// Work against internal forces (J) as the guards have it.
    done: f64,
    /// In how many places that is counted, and in how many it should be.
    places: [usize; 2],
}

/// So many steps, in submissions of one, of a few and of the rest.
fn on_a_gpu(run: &Configuration, text: &str, steps: u64, fuse: bool) -> Run {
    let mut simulation = run.start_in(text, Path::new("."));
    let body = simulation.body("a").unwrap();
    let world = simulation.world_mut();
    let nodes = world.get::<Mass>(body).unwrap().len();
    // −0, which a sum of anything with it is not
    if let Some(mut work) = world.get_mut::<InternalWork>(body) {
        work.fill(-0.0);
    }
    send_to_device(world, |_, name| name == InternalWork::NAME).unwrap();
    // a place for each sixty-four nodes, and for each of the first two sixty-fours of invocations that a patch gives
    // nodes to
    let interior: Vec<u32> =
        world.query::<&Patches>().iter(world).flat_map(|patches| patches.interior.clone()).collect();
    let interior: Vec<usize> = interior.into_iter().filter(|_| fuse).map(|nodes| nodes as usize).collect();
    let of_patches: usize = interior.iter().map(|&nodes| nodes.div_ceil(64).min(2)).sum();
    let expected = of_patches + (nodes - interior.iter().sum::<usize>()).div_ceil(64);
    let dispatches = |simulation: &mut Simulation| simulation.world_mut().resource_mut::<Device>().gpu().dispatches();
    let before = dispatches(&mut simulation);
    for steps in [1, 5, steps - 6] {
        simulation.advance(steps).unwrap_or_else(|error| panic!("{}: {error}", run.name));
    }
    let dispatches = (dispatches(&mut simulation) - before) / steps;
    let ends = simulation.displacements("a").unwrap();
    bring_to_host(simulation.world_mut(), |_, _| true).unwrap();
    let work = simulation.world().get::<InternalWork>(body);
    let done = work.map_or(0.0, InternalWork::total);
    let touched = |sum: &&[f32]| sum[0].to_bits() != (-0.0_f32).to_bits();
    let touched = work.map_or(0, |work| work.chunks(2).filter(touched).count());
    let expected = if work.is_none() { 0 } else { expected };
    Run { ends, dispatches, done, places: [touched, expected] }
}

/// The same operations in the same order, but compilers may contract them otherwise: see above. What is counted is a
/// dispatch a block and one for the nodes that patches share, beside those of systems that stay apart.
#[test]
#[ignore = "long"]
fn on_a_gpu_nodes_inside_patches_go_where_they_go_with_all_others() {
    let Some(run) = configurations().into_iter().find(|run| run.options.backend == BackendChoice::Gpu) else { return };
    let viscous = "damping: 2, prony: (terms: [(alpha: 0.4, tau: 0.05)])";
    let plain = |elements: &'static str, material: &'static str, more: &'static str| {
        [true, false].map(|fuse| turned(elements, material, more, fuse))
    };
    for (dispatches, texts) in [
        ([2, 7], plain("(12, 12, 12), elements: Tet4", "", "")),
        ([2, 7], plain("(9, 8, 9), elements: Hex8", viscous, "")),
        // means of the volume around nodes come first, in two kernels; energies are counted node by node
        ([4, 9], plain("(9, 9, 9), elements: Tet4NodalPressure", "", "output: (energies_every: 5),")),
        // two blocks, in which inverted elements go: six kernels more
        ([9, 13], [true, false].map(torn)),
    ] {
        let [together, apart] = [0, 1].map(|i| on_a_gpu(&run, &texts[i], 60, i == 0));
        assert!(together.ends.iter().chain(&apart.ends).all(|u| u.is_finite()));
        let largest = apart.ends.iter().map(|u| u.length()).fold(0.0, f64::max);
        let off = together.ends.iter().zip(&apart.ends).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        assert!(off <= 1e-5 * largest && largest > 0.02, "{off:e} of {largest:e}");
        let (done, done_apart) = (together.done, apart.done);
        assert!((done - done_apart).abs() <= 1e-5 * done_apart.abs(), "{done} J instead of {done_apart} J");
        assert_eq!([together.dispatches, apart.dispatches], dispatches);
        for Run { places: [counted, expected], .. } in [&together, &apart] {
            assert_eq!(counted, expected);
        }
        assert!(on_a_gpu(&run, &texts[0], 60, true) == together, "not the same bits");
    }
}
