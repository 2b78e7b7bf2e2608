//! While contact sleeps nodes of surfaces move with their patches, as if no body could meet another: with the same bits
//! as if they waited for it.

use crate::bits::{bits, start};
use crate::configurations::scene_of;
use sinew::components::{ContactForce, FirstInverted, InternalWork, Patches, Precision, ToolContacts, ToolTouch};
use sinew::glam::DVec3;
use sinew::prelude::*;
use sinew::systems::{Before, Cpu, ForceSlopes, NodeColumns, NodeSystem, NodesAtRest, SimdScalar, SurfaceContacts};
use std::path::Path;

/// How many nodes of surfaces move with their patches while contact sleeps, and how many patches there are.
fn deferred(simulation: &mut Simulation) -> (usize, usize) {
    let world = simulation.world_mut();
    let all: Vec<u32> = world.query::<&Patches>().iter(world).flat_map(|patches| patches.deferred.clone()).collect();
    (all.iter().map(|&nodes| nodes as usize).sum(), all.len())
}

/// Steps in which contact slept.
fn asleep(simulation: &Simulation) -> u64 {
    simulation.world().resource::<SurfaceContacts>().figures().asleep
}

/// Bits of what elements exert on the nodes of some bodies (N).
fn forces(simulation: &mut Simulation, bodies: &[&str]) -> Vec<u64> {
    let all = bodies.iter().flat_map(|body| simulation.internal_forces(body).unwrap());
    all.flat_map(|force| force.to_array().map(f64::to_bits)).collect()
}

/// Blocks of several patches a metre apart, that are held, moved, pulled, pushed (N) and kept off by a tool.
fn far_apart(material: &str, push: f64, contacts: &str, more: &str) -> String {
    format!(
        "(duration: 10, bodies: {{
            \"a\": (mesh: Box(size: (1, 1, 1), cells: (9, 8, 9), elements: Tet4), material: \"m\"),
            \"b\": (mesh: Box(size: (1, 1, 1), cells: (9, 9, 9), elements: Hex8), material: \"m\",
                translate: (2, 0, 0))}},
        materials: {{\"m\": (density: 1000, damping: 0.5, {material})}},
        tools: {{\"table\": (shape: Plane())}},
        contacts: [Tool(tool: \"table\", body: \"b\", friction: 0.3), {contacts}],
        constraints: [
            Fixed(body: \"a\", on: Plane(normal: (0, 0, 1), at: 0)),
            Prescribed(body: \"a\", on: Plane(normal: (0, 0, 1), at: 1), displacement: (0.02, 0, -0.1),
                curve: Smooth(end: 0.2))],
        loads: [Gravity(body: \"a\", acceleration: (0, 1, -9.81)), Gravity(body: \"b\", acceleration: (0, 0, -9.81)),
            NodalForce(body: \"b\", on: Plane(normal: (0, 0, 1), at: 1), force: (0.05, 0.2, 0.1)),
            NodalForce(body: \"a\", on: Box(min: (0.9, 0.4, 0.4), max: (1, 0.6, 0.6)), force: (-{push}, 0, 0))],
        guards: (off: [Energy]), integration: (step: 0.001, when_unstable: Watch), {more})"
    )
}

const MEET: &str = "Between(bodies: (\"a\", \"b\"), friction: 0.2)";

#[test]
fn bodies_that_never_meet_go_where_they_go_without_contact() {
    let law = "neo_hookean: Young(young: 3e3, poisson: 0.45)";
    let energies = "output: (energies_every: 0.02)";
    for (precision, more) in [(Precision::F64, ""), (Precision::F32, ""), (Precision::F32, energies)] {
        let [mut with, mut without] =
            [MEET, ""].map(|contacts| start(&far_apart(law, 0.4, contacts, more), precision, 1));
        let (nodes, patches) = deferred(&mut with);
        assert!(patches == 8 && nodes > 400 && deferred(&mut without).0 == 0, "{nodes} nodes of {patches} patches");
        for _ in 0..4 {
            with.advance(20).unwrap();
            without.advance(20).unwrap();
            let all = ["a", "b"];
            assert!(bits(&mut with, &all) == bits(&mut without, &all), "{precision:?} {more}");
            assert!(forces(&mut with, &all) == forces(&mut without, &all), "{precision:?} {more}");
        }
        let farthest = with.displacements("a").unwrap().iter().map(|u| u.length()).fold(0.0, f64::max);
        let figures = with.world().resource::<SurfaceContacts>().figures();
        assert!(figures.asleep >= 79 && figures.builds < 10 && farthest > 1e-3, "{figures:?}, {farthest} m");
    }
}

/// Nodes of a patch with an element that is turned inside out are looked after apart, those of surfaces with them.
#[test]
fn nodes_of_torn_patches_go_where_they_go_without_contact() {
    let law = "stable_neo_hookean: Young(young: 3e3, poisson: 0.45)";
    for precision in [Precision::F64, Precision::F32] {
        let [mut with, mut without] =
            [MEET, ""].map(|contacts| start(&far_apart(law, 1e3, contacts, ""), precision, 1));
        with.advance(40).unwrap();
        without.advance(40).unwrap();
        let world = with.world_mut();
        let inverted = world.query::<&FirstInverted>().iter(world).filter(|first| first[0] != u32::MAX).count();
        assert!(inverted > 0 && asleep(&with) >= 39, "{inverted}, {}", asleep(&with));
        assert!(bits(&mut with, &["a", "b"]) == bits(&mut without, &["a", "b"]), "{precision:?}");
    }
}

/// A block that flies against another, bounces off and flies away.
fn bouncing(elements: [&str; 2], more: &str) -> String {
    let [low, high] = elements.map(|kind| {
        format!("mesh: Box(size: (0.02, 0.02, 0.02), cells: (9, 9, 8), elements: {kind}), material: \"m\"")
    });
    format!(
        "(duration: 1, bodies: {{\"low\": ({low}),
            \"high\": ({high}, rotate: (0, 0, 10), translate: (0.003, -0.001, 0.023), velocity: (0.1, 0, -0.4))}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e4, poisson: 0.45))}},
        constraints: [Fixed(body: \"low\", on: Set(\"z0\"))],
        contacts: [Between(bodies: (\"low\", \"high\"), friction: 0.3)], integration: (step: 4e-5), {more})"
    )
}

/// What there is of a run.
#[derive(PartialEq)]
struct Moment {
    /// Bits of displacements.
    displacements: Vec<u64>,
    /// Of forces of elements and of contact.
    forces: Vec<u64>,
    /// Of the work that guards go by.
    work: Vec<u32>,
}

/// A run as it is every 16 steps, and in how many steps of these contact slept; where it is woken, in none: it takes
/// what bodies bore in the last step for somebody else's, and looks for all that is near.
fn course(simulation: &mut Simulation, is_woken: bool) -> Vec<(Moment, u64)> {
    let all = ["low", "high"];
    let high = simulation.body("high").unwrap();
    let mut course = Vec::new();
    for _ in 0..64 {
        let before = asleep(simulation);
        for _ in 0..if is_woken { 16 } else { 1 } {
            if is_woken {
                simulation.world_mut().get_mut::<ContactForce>(high).unwrap().set_changed();
            }
            simulation.advance(if is_woken { 1 } else { 16 }).unwrap();
        }
        let (mut forces, mut work) = (forces(simulation, &all), Vec::new());
        for body in all {
            let body = simulation.body(body).unwrap();
            let body = simulation.world().entity(body);
            let force = &body.get::<ContactForce>().unwrap().0;
            forces.extend((0..force.len()).map(|number| force.get(number).to_bits()));
            work.extend(body.get::<InternalWork>().unwrap().iter().map(|sum| sum.to_bits()));
        }
        let moment = Moment { displacements: bits(simulation, &all), forces, work };
        course.push((moment, asleep(simulation) - before));
    }
    course
}

#[test]
#[ignore = "long"]
fn contact_that_sleeps_wakes_and_sleeps_again_is_what_it_is_awake() {
    for (precision, elements) in [(Precision::F32, ["Tet4", "Hex8"]), (Precision::F64, ["Hex8", "Tet4"])] {
        let text = bouncing(elements, "");
        let mut awake = start(&text, precision, 1);
        let wanted = course(&mut awake, true);
        let builds = awake.world().resource::<SurfaceContacts>().figures().builds;
        assert!(deferred(&mut awake).0 > 300 && builds == 1024, "{builds} times lists");
        let found = course(&mut start(&text, precision, 1), false);
        let sleeps: Vec<u64> = found.iter().map(|(_, asleep)| *asleep).collect();
        let touches: Vec<usize> = (0..64).filter(|&place| sleeps[place] == 0).collect();
        let is_there = sleeps[0] >= 14 && sleeps[63] == 16 && touches.len() > 10 && touches[0] > 2;
        assert!(is_there, "it does not sleep, touch, and sleep again: {sleeps:?}");
        let on_threads = course(&mut start(&text, precision, 3), false);
        for (what, found) in [("asleep", found), ("on three threads", on_threads)] {
            for (place, ((found, _), (wanted, _))) in found.iter().zip(&wanted).enumerate() {
                assert!(found.displacements == wanted.displacements, "{what}, {precision:?}: places at {place}");
                assert!(found.forces == wanted.forces, "{what}, {precision:?}: forces at {place}");
                assert!(found.work == wanted.work, "{what}, {precision:?}: work at {place}");
            }
        }
        let unfused = course(&mut start(&bouncing(elements, "fuse: false"), precision, 1), false);
        let same = |(found, wanted): (&(Moment, u64), &(Moment, u64))| found.0.displacements == wanted.0.displacements;
        assert!(unfused.iter().zip(&wanted).all(same), "unfused, {precision:?}");
    }
}

/// Puts a body elsewhere in a step, among the loads.
#[derive(Component, Clone, serde::Deserialize)]
#[serde(crate = "sinew::serde", deny_unknown_fields)]
struct Shift {
    /// When (s), how far along z (m), and of nodes from which height on (m).
    at: f64,
    by: f64,
    above: f64,
}

impl NodeSystem for Shift {
    type Columns = &'static mut Displacement;
    /// How far in this step (m).
    type Prepared = f64;

    fn prepare(&self, before: &Before<'_>) -> f64 {
        let since = before.clock.time() - self.at;
        if since.abs() < 0.5 * before.clock.time_step { self.by } else { 0.0 }
    }

    fn slopes(&self, _: &NodesAtRest<'_>) -> ForceSlopes {
        ForceSlopes::NONE
    }

    fn act<T: SimdScalar>(&self, by: &f64, _: &Cpu, nodes: &mut NodeColumns<'_, T>) {
        let above: Vec<bool> = nodes.rest.iter().map(|rest| rest.z > self.above).collect();
        let above = nodes.displacements_mut().chunks_exact_mut(3).zip(above).filter(|(_, above)| *above && *by != 0.0);
        above.for_each(|(u, _)| u[2] = T::from_f64(u[2].to_f64() + by));
    }
}

/// Whoever moves nodes between the place where contact could say that it sleeps and its own keeps it from that.
#[test]
fn what_moves_nodes_among_the_loads_is_seen_in_its_step() {
    let shift = System::of_nodes::<Shift>("shift", Phase::Loads, "puts a body elsewhere").on_each_body::<Shift>();
    let registry = Registry::default().with(shift);
    let schedule = "guards: (off: [Energy]), parameters: {\"shift\": (at: 4e-4, by: -0.003, above: 0.0225)},
        schedule: [\"boundary\", \"element_forces\", \"gather\", \"shift\", \"surface_contact\", \"integrate\",
            \"observe\"]";
    let ends = ["", ", fuse: false"].map(|fuse| {
        let scene = scene_of(&bouncing(["Hex8", "Hex8"], &format!("{schedule}{fuse}")), Path::new("."));
        let options = Options { backend: BackendChoice::Cpu, threads: 1, ..Options::default() };
        let mut simulation = Simulation::with_systems(&scene, &options, &registry).unwrap();
        simulation.advance(11).unwrap();
        let high = simulation.body("high").unwrap();
        let force = simulation.world().get::<ContactForce>(high).unwrap().vectors().sum::<DVec3>();
        (force.z > 0.0, bits(&mut simulation, &["low", "high"]))
    });
    assert!(ends[1].0, "they do not touch in that step");
    assert!(ends[0] == ends[1]);
}

/// Nodes of which none is near a tool are left alone together: with the same bits as if each were looked at.
#[test]
fn tools_that_come_touch_and_go_do_what_they_do_node_by_node() {
    let text =
        "(duration: 0.03, bodies: {\"b\": (mesh: Box(size: (0.03, 0.03, 0.02), cells: (9, 9, 7), elements: Hex8),
            material: \"m\")},
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))},
        constraints: [Fixed(on: Set(\"z0\"))], integration: (step: 2e-4),
        contacts: [Tool(tool: \"ball\", friction: 0.3), Tool(tool: \"plate\", friction: 0.2)],
        tools: {
            \"ball\": (shape: Sphere(radius: 0.008), path: [(t: 0, at: (0.01, 0.01, 0.05)),
                (t: 0.008, at: (0.012, 0.014, 0.0283)), (t: 0.014, at: (0.02, 0.015, 0.0278)),
                (t: 0.018, at: (0.02, 0.017, 0.0283)), (t: 0.024, at: (0.02, 0.02, 0.05))]),
            \"plate\": (shape: Plane(), path: [(t: 0, at: (0.05, 0, 0), TURNED), (t: 0.008, at: (0.0302, 0, 0), TURNED),
                (t: 0.013, at: (0.0298, 0, 0), TURNED), (t: 0.017, at: (0.0302, 0, 0), TURNED),
                (t: 0.024, at: (0.05, 0, 0), TURNED)])})"
            .replace("TURNED", "rotation: (0, -90, 0)");
    for precision in [Precision::F64, Precision::F32] {
        let mut touched = Vec::new();
        let ends = [true, false].map(|together| {
            let mut simulation = start(&text, precision, 1);
            let body = simulation.body("b").unwrap();
            if !together {
                simulation.world_mut().get_mut::<ToolContacts>(body).unwrap().boxes.clear();
            }
            let mut course = Vec::new();
            for _ in 0..15 {
                simulation.advance(10).unwrap();
                let touch = &simulation.world().get::<ToolTouch>(body).unwrap().0;
                course.push((0..touch.len()).map(|number| touch.get(number).to_bits()).collect::<Vec<u64>>());
                touched.push(["ball", "plate"].map(|tool| simulation.tool(tool).unwrap().force.length() > 0.0));
                course.push(bits(&mut simulation, &["b"]));
            }
            course
        });
        let of_each = [0, 1].map(|tool| touched.iter().filter(|touched| touched[tool]).count());
        assert!(of_each.iter().all(|count| *count > 1) && touched[0] == [false; 2] && touched[14] == [false; 2]);
        assert!(ends[0] == ends[1], "{precision:?}");
    }
}
