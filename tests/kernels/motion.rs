//! `boundary`, `integrate`, and whole runs.

use super::kernel_worlds::Effects;
use super::pair::{Pair, UNIT, entities, run, run_all, run_kernels};
use bevy_ecs::prelude::*;
use sinew::BackendChoice;
use sinew::backend::gpu::gpu_or_reason;
use sinew::components::*;
use sinew::systems::Registry;

#[test]
fn prescribed_nodes_go_to_the_same_places() {
    for compensated in [false, true] {
        let effects = Effects { moved: true, compensated, ..Effects::default() };
        let Some(mut pair) = run("boundary", &effects, 500, lose_much) else { return };
        // three products of a gradient under 1 and an arm under 0.1 m, and a displacement: ten roundings
        pair.agree::<DisplacementIncrement>(|_, _, _| 10.0 * UNIT * 0.1);
        assert!(pair.changed::<DisplacementIncrement>() > 20);
    }
}

/// What rounding has left out, larger than it can ever be: it must not go under in the bound.
fn lose_much(world: &mut World) {
    for body in entities::<DisplacementCompensation>(world) {
        let mut compensation = world.get_mut::<DisplacementCompensation>(body).unwrap();
        (0..compensation.len()).for_each(|i| compensation.set(i, 1e-4 * (1.0 + i as f64 / 1e4)));
    }
}

#[test]
fn nodes_move_the_same_way() {
    for bits in 0..16 {
        let bit = |i: u32| bits >> i & 1 == 1;
        let (damping, loads, compensated, energies) = (bit(0), bit(1), bit(2), bit(3));
        let effects = Effects { damping, loads, compensated, energies, moved: true, ..Effects::default() };
        for step in [0, 3] {
            let Some(mut pair) = run("integrate", &effects, step, |_| {}) else { return };
            compare_motion(&mut pair, &effects, 0.0);
        }
    }
}

#[test]
fn nodes_relax_the_same_way() {
    for (loads, compensated) in [(false, true), (true, false), (true, true)] {
        let effects = Effects { at_rest: true, damping: true, loads, compensated, moved: true, ..Effects::default() };
        for step in [0, 3] {
            let damped = |world: &mut World| {
                let mut clock = world.resource_mut::<Clock>();
                let relaxation = clock.relaxation.as_mut().unwrap();
                (relaxation.damping, relaxation.force_scale) = (0.3, 1.7);
            };
            let Some(mut pair) = run("integrate", &effects, step, damped) else { return };
            compare_motion(&mut pair, &effects, 0.0);
        }
    }
}

/// As one after the other: kernels that several systems share give what the systems give by themselves on the host.
#[test]
fn systems_that_share_kernels_move_nodes_the_same_way() {
    for bits in 0..16 {
        let bit = |i: u32| bits >> i & 1 == 1;
        let (damping, loads, compensated, energies) = (bit(0), bit(1), bit(2), bit(3));
        let effects = Effects { damping, loads, compensated, energies, moved: true, ..Effects::default() };
        // displacements that pressure reads are compared in tests of whole runs: here loads are exact sums
        let systems = ["gather", "gravity", "nodal_force", "traction", "boundary", "integrate"];
        for step in [0, 3] {
            let Some(mut pair) = run_all(&systems, &effects, step, |_| {}) else { return };
            // eight corners of 0.01 N, in the same order
            pair.agree::<InternalForce>(|_, _, _| 50.0 * UNIT * 0.01);
            if loads {
                pair.agree::<ExternalForce>(|_, _, _| 8.0 * UNIT * 0.05);
            }
            // as in the test of boundary alone
            compare_motion(&mut pair, &effects, 10.0 * UNIT * 0.1);
        }
    }
}

/// `prescribed`: by how much steps along constrained axes may differ (m).
fn compare_motion(pair: &mut Pair, effects: &Effects, prescribed: f64) {
    // d ← ((1 − a) d + Δt² (R − F)/m)/(1 + a): twelve roundings of the old step, the push and the new step
    let step_bound = |pair: &Pair, body: Entity, i: usize| {
        let dt = pair.before().resource::<Clock>().time_step;
        let inertial = pair.before().get::<InertialMass>(body).map(|mass| 0.5 * mass.get(i / 3));
        let mass = inertial.unwrap_or_else(|| pair.before().get::<Mass>(body).unwrap().get(i / 3));
        let old = pair.before().get::<DisplacementIncrement>(body).unwrap().get(i).abs();
        let push = if mass > 0.0 { dt * dt * 0.02 / mass } else { 0.0 };
        let constrained = pair.before().get::<ConstrainedAxes>(body).unwrap()[i / 3] >> (i % 3) & 1 == 1;
        12.0 * UNIT * (old + push) + if constrained { prescribed } else { 0.0 }
    };
    pair.agree::<DisplacementIncrement>(step_bound);
    let at = |pair: &Pair, body: Entity, i: usize| pair.before().get::<Displacement>(body).unwrap().get(i).abs();
    // one rounding each, to either side: an ulp of the displacement
    pair.agree::<Displacement>(|pair, body, i| step_bound(pair, body, i) + 2.0 * UNIT * at(pair, body, i).max(1e-3));
    if effects.compensated {
        for body in entities::<DisplacementCompensation>(pair.host.world_mut()) {
            for i in 0..pair.host().get::<Displacement>(body).unwrap().len() {
                // u less what was lost is the exact sum, but for the rounding of what was lost
                let sum = |world: &World| {
                    let compensation = world.get::<DisplacementCompensation>(body).unwrap();
                    let compensation = compensation.get(i);
                    (world.get::<Displacement>(body).unwrap().get(i) - compensation, compensation)
                };
                let ((host, compensation), (device, _)) = (sum(pair.host()), sum(pair.device.world()));
                let allowed = step_bound(pair, body, i) + 2.0 * UNIT * compensation.abs().max(1e-9);
                assert!((host - device).abs() <= allowed, "{i} of {body}: host {host:e}, GPU {device:e}");
            }
        }
    }
    if effects.energies {
        let dt = pair.before().resource::<Clock>().time_step;
        pair.agree::<Work>(|pair, body, i| {
            let old = pair.before().get::<Work>(body).unwrap().get(i).abs();
            let node = i / WORK_NUMBERS;
            let damping = pair.before().get::<DampingCoefficient>(body).map_or(0.0, |c| c.get(node));
            let moved = |world: &World, axis: usize| {
                world.get::<DisplacementIncrement>(body).unwrap().get(3 * node + axis).abs()
            };
            let kept = |axis: usize| pair.before().get::<Work>(body).unwrap().get(WORK_NUMBERS * node + 4 + axis).abs();
            let steps: f64 =
                (0..3).map(|axis| moved(pair.before(), axis) + kept(axis) + moved(pair.host(), axis)).sum();
            // forces under 0.01 N along the steps, six products and their sums, each step with its own twelve roundings
            let held = pair.before().get::<ConstrainedAxes>(body).unwrap()[node] != 0;
            let prescribed = if held { prescribed * (1.0 + damping / dt * steps) } else { 0.0 };
            24.0 * UNIT * (old + 0.02 * steps + damping / dt * steps * steps) + prescribed
        });
    }
    compare_noticed(pair);
    assert!(pair.changed::<Displacement>() > 1000);
}

/// The first lost node, and sums of work against internal forces.
fn compare_noticed(pair: &mut Pair) {
    for body in entities::<FirstNonFinite>(pair.host.world_mut()) {
        let first = |world: &World| world.get::<FirstNonFinite>(body).unwrap()[0];
        assert_eq!(first(pair.host()), first(pair.device.world()));
        let work = |world: &World| world.get::<InternalWork>(body).map(|work| work.0.clone());
        let (Some(host), Some(device)) = (work(pair.host()), work(pair.device.world())) else { continue };
        let moved = |world: &World, node: usize| {
            world.get::<DisplacementIncrement>(body).unwrap().vector(node).abs().element_sum()
        };
        let count = pair.host().get::<Mass>(body).unwrap().len();
        assert_eq!(host.len(), device.len());
        for group in (0..count).step_by(64) {
            let at = 2 * group / GROUP_ROWS;
            let [a, b] = [&host, &device].map(|work| f64::from(work[at]) + f64::from(work[at + 1]));
            let nodes = group..count.min(group + 64);
            let steps: f64 = nodes.map(|node| moved(pair.before(), node) + moved(pair.host(), node)).sum();
            // forces under 0.01 N along both steps, each with its own twelve roundings, and sums of 64
            let allowed = 40.0 * UNIT * 0.01 * steps;
            assert!((a - b).abs() <= allowed, "{group} of {body}: host {a:e}, GPU {b:e}, allowed {allowed:e}");
            assert!(a != 0.0, "nothing is counted");
        }
    }
}

#[test]
fn a_node_without_a_mass_that_is_a_number_is_not_inactive_in_silence() {
    for bits in [0x7fc0_0000_u32, 0xffc0_0000, 0x7f80_0000] {
        let Some(pair) = run("integrate", &Effects::default(), 3, |world| {
            for body in entities::<Mass>(world) {
                world.get_mut::<Mass>(body).unwrap().slice_mut::<f32>()[17] = f32::from_bits(bits);
            }
        }) else {
            return;
        };
        let mut pair = pair;
        // an infinite mass stays where it is, as it should
        let compensation = if bits == 0x7f80_0000 { u32::MAX } else { 17 };
        for body in entities::<FirstNonFinite>(pair.device.world_mut()) {
            assert_eq!(pair.device.world().get::<FirstNonFinite>(body).unwrap()[0], compensation, "{bits:x}");
            assert_eq!(pair.host().get::<FirstNonFinite>(body).unwrap()[0], compensation, "{bits:x}");
        }
    }
}

#[test]
fn a_lost_node_is_found() {
    let Some(mut pair) = run("integrate", &Effects::default(), 3, |world| {
        for body in entities::<InternalForce>(world) {
            let mut force = world.get_mut::<InternalForce>(body).unwrap();
            force.set(3 * 31 + 1, f64::NAN);
            force.set(3 * 17 + 2, f64::INFINITY);
        }
    }) else {
        return;
    };
    for body in entities::<FirstNonFinite>(pair.device.world_mut()) {
        assert_eq!(pair.device.world().get::<FirstNonFinite>(body).unwrap()[0], 17);
    }
    for body in entities::<FirstNonFinite>(pair.host.world_mut()) {
        assert_eq!(pair.host().get::<FirstNonFinite>(body).unwrap()[0], 17);
    }
}

#[test]
fn compensated_sums_keep_what_f32_would_lose() {
    let Some(gpu) = gpu_or_reason() else { return };
    let mut simulation = Effects { compensated: true, ..Effects::default() }.simulation(BackendChoice::Cpu);
    let world = simulation.world_mut();
    let bodies = entities::<Displacement>(world);
    let step = 1.234_567_9e-9_f32;
    for &body in &bodies {
        let mut u = world.get_mut::<Displacement>(body).unwrap();
        (0..u.len()).for_each(|i| u.set(i, 0.01));
        let mut steps = world.get_mut::<DisplacementIncrement>(body).unwrap();
        (0..steps.len()).for_each(|i| steps.set(i, f64::from(step)));
    }
    world.resource_mut::<Clock>().step = 1;
    const TIMES: u32 = 20_000;
    let exact = f64::from(0.01_f32) + f64::from(TIMES) * f64::from(step);
    let plain = (0..TIMES).fold(0.01_f32, |u, _| u + step);
    let integrate = Registry::default().get("integrate").unwrap().device.clone();
    run_kernels(gpu, world, |world, buffers| integrate.kernels(world, buffers), TIMES);
    // the plain sum rounds every step by up to half an ulp of u: a step of 1.3 ulp becomes one of 1 ulp
    assert!((f64::from(plain) / exact - 1.0).abs() > 1e-4);
    for body in bodies {
        let u = simulation.world().get::<Displacement>(body).unwrap();
        // the step itself is carried exactly (no force, no damping): what remains is one rounding of u
        let worst = (0..u.len()).map(|i| (u.get(i) / exact - 1.0).abs()).fold(0.0, f64::max);
        assert!(worst <= 2.0 * UNIT, "{worst:e}");
    }
}

#[test]
fn gpu_runs_repeat_to_the_bit_and_follow_the_cpu() {
    if gpu_or_reason().is_none() {
        return;
    }
    let effects = Effects { removal: false, ..Effects::all() };
    let end = |backend| {
        let mut simulation = effects.simulation(backend);
        simulation.advance(200).unwrap_or_else(|error| panic!("{error}"));
        ["tets", "hexes"].map(|body| simulation.displacements(body).unwrap())
    };
    let (one, two, cpu) = (end(BackendChoice::Gpu), end(BackendChoice::Gpu), end(BackendChoice::Cpu));
    assert_eq!(one, two);
    let largest = cpu.iter().flatten().map(|u| u.length()).fold(0.0, f64::max);
    let apart = one.iter().flatten().zip(cpu.iter().flatten()).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    assert!(apart < 1e-4 * largest, "{apart:e} of {largest:e}");
}
