//! Edges that cross between their nodes.

use crate::configurations::{configurations, cpu_and_long_gpu, near};
use glam::DVec3;
use sinew::Simulation;
use sinew::components::DisplacementIncrement;

/// Where the middles of the two ridges are that cross, one above the other, both between two nodes: how far they are
/// apart (m).
fn between_ridges(simulation: &mut Simulation, ridges: &[(&str, Vec<usize>); 2]) -> f64 {
    let [low, high] = ridges.each_ref().map(|(body, nodes)| {
        let (rest, u) = (simulation.rest_positions(body).unwrap(), simulation.displacements(body).unwrap());
        nodes.iter().map(|&node| (rest[node] + u[node]).z).sum::<f64>() / nodes.len() as f64
    });
    high - low
}

/// The two nodes of a body that are nearest to a place.
fn nearest(simulation: &mut Simulation, body: &str, at: DVec3) -> Vec<usize> {
    let rest = simulation.rest_positions(body).unwrap();
    let mut nodes: Vec<usize> = (0..rest.len()).collect();
    nodes.sort_by(|&a, &b| rest[a].distance(at).total_cmp(&rest[b].distance(at)));
    nodes.truncate(2);
    nodes
}

fn momentum(simulation: &mut Simulation, body: &str) -> DVec3 {
    let masses = simulation.masses(body).unwrap();
    let rate = 1.0 / simulation.time_step();
    let view = simulation.column::<DisplacementIncrement>(body).unwrap();
    let steps: Vec<DVec3> = view.node_rows().iter().map(|&row| view.values().vector(row as usize)).collect();
    masses.iter().zip(steps).map(|(mass, step)| step * rate * *mass).sum()
}

/// Two bars that lie on their edges, one across the other: where nodes alone are what touches, their ridges pass each
/// other; with edges they stay outside, momentum is kept, no energy is made, and they part again.
#[test]
fn bars_that_meet_crosswise_with_their_edges_do_not_pass() {
    for run in cpu_and_long_gpu() {
        for (edges, friction) in [("false", 0.0), ("true", 0.0), ("true", 0.3)] {
            let top = 0.02 * 2.0_f64.sqrt();
            let mut simulation = run.start(&format!(
                "(duration: 0.08, bodies: {{
                    \"low\": (mesh: Box(size: (0.06, 0.02, 0.02), cells: (3, 2, 2)), material: \"m\", rotate: (45, 0, 0)),
                    \"high\": (mesh: Box(size: (0.02, 0.06, 0.02), cells: (2, 3, 2)), material: \"m\", rotate: (0, -45, 0),
                        translate: (0.03, -0.03, {}), velocity: (0, 0, -0.1))}},
                materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}},
                contacts: [Between(bodies: (\"low\", \"high\"), edges: {edges}, friction: {friction})], output: (energies_every: 0.01))",
                top + 1e-4
            ));
            let what = format!("{}, edges: {edges}, friction: {friction}", run.name);
            let crossing = DVec3::new(0.03, 0.0, top);
            let ridges = ["low", "high"].map(|body| (body, nearest(&mut simulation, body, crossing)));
            near(&what, between_ridges(&mut simulation, &ridges), 1e-4, 1e-4, run.bound(1e-9, 1e-3));
            let before = momentum(&mut simulation, "high");
            let energy = simulation.energies().unwrap().kinetic;
            let (mut deepest, mut highest) = (f64::INFINITY, 0.0_f64);
            while simulation.time() < 0.08 {
                simulation.advance(3).unwrap();
                deepest = deepest.min(between_ridges(&mut simulation, &ridges));
                let now = simulation.energies().unwrap();
                highest = highest.max((now.kinetic + now.internal_work.unwrap()) / energy);
            }
            println!("{what}: {deepest:.3e} m, at most {highest} of the energy");
            if edges == "false" {
                assert!(deepest < -2e-3, "{what}: what edges are for: {deepest} m");
                continue;
            }
            // a hundredth of a face's edge
            assert!(deepest > -1e-4, "{what}: {deepest} m");
            assert!(highest <= 1.0 + run.bound(1e-9, 1e-5), "{what}: {highest} of the energy");
            let [low, high] = ["low", "high"].map(|body| momentum(&mut simulation, body));
            near(&what, (low + high - before).length(), 0.0, before.length(), run.bound(1e-10, 1e-5));
            assert!(low.z < high.z, "{what}: they part: {low} and {high}");
            assert!(simulation.energies().unwrap().contact_loss.unwrap() >= 0.0, "{what}");
        }
    }
}

/// A cube whose corner meets another, turned.
const TURNED: &str = "(duration: 0.04, bodies: {
        \"a\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (CELLS, CELLS, CELLS)), material: \"m\"),
        \"b\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (5, 5, 5)), material: \"m\", rotate: (20, 35, 10),
            translate: (0.012, 0.008, 0.032), velocity: (-0.1, 0.02, -0.8))},
    materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))},
    contacts: [Between(bodies: (\"a\", \"b\"), friction: 0.3, points: Faces, edges: true)])";

/// Whenever lists are made, as by how many steps are submitted at once. Against the CPU a point that rounding lets
/// touch a step earlier or later changes what its body gets by one part in some hundred steps, of a dozen points and
/// more.
#[test]
#[ignore = "long"]
fn edges_and_faces_on_a_gpu_do_as_on_the_cpu_and_the_same_every_time() {
    let scene = TURNED.replace("CELLS", "4");
    let all = configurations();
    let [on_cpu, on_gpu] = ["CPU f32", "GPU f32"].map(|name| all.iter().find(|run| run.name == name));
    let (Some(on_cpu), Some(on_gpu)) = (on_cpu, on_gpu) else { return };
    let [mut one, mut other, mut cpu] = [on_gpu, on_gpu, on_cpu].map(|run| run.start(&scene));
    let end = one.step_count() + 150;
    while one.step_count() < end {
        one.advance(7.min(end - one.step_count())).unwrap();
    }
    other.advance(end).unwrap();
    let bodies = ["a", "b"];
    let bits = |simulation: &mut Simulation| crate::bits::bits(simulation, &bodies);
    assert!(bits(&mut one) == bits(&mut other), "the same bits");
    cpu.advance(end).unwrap();
    for body in bodies {
        let [here, there] = [&mut cpu, &mut one].map(|run| momentum(run, body));
        near(body, (here - there).length(), 0.0, here.length(), 1e-3);
        let [here, there] = [&mut cpu, &mut one].map(|run| run.contact(body).unwrap().loss.unwrap());
        assert!(here.abs() > 1e-5, "{body}: they touched");
        near(body, there, here, here, 1e-3);
    }
}

/// The same bits whatever the threads, the lists, and the pauses.
#[test]
#[ignore = "long"]
fn bits_of_edges_and_faces_do_not_depend_on_threads_lists_or_pauses() {
    let scene = &TURNED.replace("CELLS", "6");
    for precision in [sinew::components::Precision::F32, sinew::components::Precision::F64] {
        let start = |threads: usize| crate::bits::start(scene, precision, threads);
        let bits = |simulation: &mut Simulation| crate::bits::bits(simulation, &["a", "b"]);
        let mut one = start(1);
        while one.contact("b").unwrap().points == 0 {
            assert!(one.time() < 0.04, "they never touch");
            one.advance(1).unwrap();
        }
        one.advance(30).unwrap();
        assert!(one.contact("b").unwrap().loss.unwrap() != 0.0, "they touched");
        let steps = one.step_count();
        let wanted = bits(&mut one);
        let mut other = start(3);
        other.advance(steps).unwrap();
        assert!(bits(&mut other) == wanted, "3 threads, {precision:?}");
        for skin in [1e-9, 3.0] {
            let mut other = start(1);
            other.world_mut().resource_mut::<sinew::systems::SurfaceContacts>().skin = skin;
            other.advance(steps).unwrap();
            assert!(bits(&mut other) == wanted, "skin {skin}, {precision:?}");
        }
        let mut paused = start(1);
        paused.advance(steps - 25).unwrap();
        let kept = paused.snapshot().unwrap();
        let mut resumed = start(1);
        resumed.restore(&kept).unwrap();
        resumed.advance(25).unwrap();
        assert!(bits(&mut resumed) == wanted, "resumed, {precision:?}");
    }
}
