//! Every system on the host against its kernels on a GPU (lavapipe suffices), on random fields.
//!
//! Both compute the same formulas in f32 (u = 2⁻²⁴) but may contract products, sum in another order, and divide less
//! exactly (Vulkan allows 2.5 ulp). A value that is the sum of terms tᵢ, each the product of few factors, then differs by at
//! most n u Σ|tᵢ| with n the number of roundings on the longest way through the formula. Each test states Σ|tᵢ| from the
//! fields themselves and counts n; columns that are only copied or summed in a fixed order must agree to the bit.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod kernel_worlds;

use bevy_ecs::prelude::*;
use kernel_worlds::{ALONG, AROUND, Effects, randomize};
use sinew::BackendChoice;
use sinew::backend::device::{ColumnAccess, Device, bring_to_host};
use sinew::backend::gpu::{Gpu, gpu_or_reason};
use sinew::components::*;
use sinew::evaluation::{ElementState, lane_place, node_count, row_count};
use sinew::systems::Registry;

/// Half the distance from 1 to the next f32.
const UNIT: f64 = 1.0 / (1 << 24) as f64;

fn columns() -> Vec<ColumnAccess> {
    vec![
        ColumnAccess::of::<Displacement>(),
        ColumnAccess::of::<DisplacementStep>(),
        ColumnAccess::of::<DisplacementCompensation>(),
        ColumnAccess::of::<Mass>(),
        ColumnAccess::of::<DampingCoefficient>(),
        ColumnAccess::of::<InternalForce>(),
        ColumnAccess::of::<ExternalForce>(),
        ColumnAccess::of::<ConstrainedAxes>(),
        ColumnAccess::of::<Work>(),
        ColumnAccess::of::<ElementForce>(),
        ColumnAccess::of::<FirstNonFinite>(),
        ColumnAccess::of::<Connectivity>(),
        ColumnAccess::of::<RestShape>(),
        ColumnAccess::of::<FibreDirection>(),
        ColumnAccess::of::<ViscousMemory>(),
        ColumnAccess::of::<Alive>(),
        ColumnAccess::of::<RemovalStep>(),
        ColumnAccess::of::<RemovedEnergy>(),
        ColumnAccess::of::<FirstInverted>(),
    ]
}

/// The same world before and after one system, on the host and on a GPU.
struct Pair {
    before: sinew::Simulation,
    host: sinew::Simulation,
    device: sinew::Simulation,
}

/// Runs one system on random fields both ways, in the step of that number; `change` makes the fields special.
fn run(system: &str, effects: &Effects, step: u64, change: impl Fn(&mut World)) -> Option<Pair> {
    let gpu = gpu_or_reason()?;
    let world = || {
        let mut simulation = effects.simulation(BackendChoice::Cpu);
        let world = simulation.world_mut();
        randomize(world, 7);
        change(world);
        let mut clock = world.resource_mut::<Clock>();
        clock.step = step;
        let (now, next) = (step as f64 * clock.time_step, (step + 1) as f64 * clock.time_step);
        world.resource_mut::<Signals>().evaluate(now, next);
        simulation
    };
    let (before, mut host, mut device) = (world(), world(), world());
    let registry = Registry::default();
    let system = registry.get(system).unwrap();
    let on_host = host.world_mut();
    if system.phase > sinew::systems::Phase::Integrate {
        on_host.resource_mut::<Clock>().step += 1;
    }
    let mut body = (system.host)();
    body.initialize(on_host);
    body.run((), on_host).unwrap().unwrap();

    run_kernels(gpu, device.world_mut(), system.kernels.unwrap(), 1);
    Some(Pair { before, host, device })
}

type Describe = fn(&mut World, &mut dyn sinew::backend::Buffers) -> Vec<sinew::backend::kernel::Kernel>;

fn run_kernels(gpu: Gpu, world: &mut World, describe: Describe, times: u32) {
    world.insert_resource(Device::new(gpu, columns()));
    let kernels = Device::prepare(world, describe).unwrap_or_else(|error| panic!("{error}"));
    assert!(!kernels.is_empty());
    let record = sinew::backend::step::record(world.resource::<Clock>(), world.resource::<Signals>());
    let records = record.repeat(times as usize);
    world.resource_mut::<Device>().run(&kernels, &records, record.len(), times).unwrap();
    bring_to_host(world, |_, _| true).unwrap();
}

fn entities<C: Component>(world: &mut World) -> Vec<Entity> {
    let mut all: Vec<Entity> = world.query_filtered::<Entity, With<C>>().iter(world).collect();
    all.sort();
    all
}

impl Pair {
    fn host(&self) -> &World {
        self.host.world()
    }
    fn before(&self) -> &World {
        self.before.world()
    }

    /// Compares a column of real numbers: `bound` gives, for a number of an entity, the difference that rounding explains.
    fn agree<C: Component + std::ops::Deref<Target = Reals>>(&mut self, bound: impl Fn(&Self, Entity, usize) -> f64) {
        let found = entities::<C>(self.host.world_mut());
        assert!(!found.is_empty(), "no {}", std::any::type_name::<C>());
        let mut closest = f64::INFINITY;
        for entity in found {
            let (host, device) = (self.host.world().get::<C>(entity), self.device.world().get::<C>(entity));
            let (host, device) = (host.unwrap(), device.unwrap());
            assert_eq!(host.len(), device.len());
            for i in 0..host.len() {
                let (a, b) = (host.get(i), device.get(i));
                let allowed = bound(self, entity, i);
                let name = std::any::type_name::<C>();
                assert!((a - b).abs() <= allowed, "{name} {i} of {entity}: host {a:e}, GPU {b:e}, allowed {allowed:e}");
                if a != b {
                    closest = closest.min(allowed / (a - b).abs());
                }
            }
        }
        eprintln!("{}: within 1/{closest:.1} of the bound", std::any::type_name::<C>());
    }

    /// Compares all columns of a kind to the bit.
    fn identical<C: Column>(&mut self) {
        for entity in entities::<C>(self.host.world_mut()) {
            let host = self.host.world().get::<C>(entity).unwrap().bytes();
            let device = self.device.world().get::<C>(entity).unwrap().bytes();
            let differing = host.chunks(4).zip(device.chunks(4)).filter(|(a, b)| a != b).count();
            assert_eq!(differing, 0, "numbers of {} of {entity} that differ", C::NAME);
        }
    }

    fn changed<C: Column>(&mut self) -> usize {
        let mut count = 0;
        for entity in entities::<C>(self.host.world_mut()) {
            let before = self.before.world().get::<C>(entity).unwrap().bytes();
            let device = self.device.world().get::<C>(entity).unwrap().bytes();
            count += before.chunks(4).zip(device.chunks(4)).filter(|(a, b)| a != b).count();
        }
        count
    }
}

/// Σ|tᵢ| of the forces on an element's corners and of its stress. With ∇u = h, stresses are sums of moduli times strains
/// h + hᵀ + hᵀh, times C⁻¹ and powers of J; rounding of O(1) intermediate values (C, J) counts with the moduli times
/// |h|, that of strains likewise. A force is V P g, in the hexahedron plus k q.
struct Magnitude {
    stress: f64,
    force: f64,
}

fn magnitude(world: &World, block: Entity, row: usize) -> Magnitude {
    let data = world.get::<Block>(block).unwrap();
    let shape = world.get::<RestShape>(block).unwrap();
    let displacement = world.get::<Displacement>(data.body).unwrap();
    let law = world.get::<sinew::backend::cpu::BlockLaw<f64>>(block).unwrap();
    let state = ElementState::of(data.kind, row, world.get::<Connectivity>(block).unwrap(), shape, displacement);
    let h = state.gradient.0.iter().flatten().map(|x| x.abs()).fold(0.0, f64::max);
    let number = |k: usize| shape.get(lane_place(row, row_count(data.kind), k));
    let nodes = node_count(data.kind);
    let gradients: f64 = (0..3 * (nodes - 1)).map(|k| number(k).abs()).fold(0.0, f64::max);
    let spread = state.displacements[..nodes].iter().flatten().map(|x| x.abs()).fold(0.0, f64::max);
    // terms of h itself cancel: a gradient is a sum of seven products at most
    let h = h.max(spread * gradients);
    let eta = law.fibres.as_ref().map_or(0.0, |(fibres, _)| fibres.eta);
    let moduli = 2.0 * law.neo_hookean.shear + law.neo_hookean.bulk + 2.0 * eta;
    let compressed = state.kinematics.j.min(1.0);
    let memory = world.get::<ViscousMemory>(block).map_or(0.0, |_| 400.0);
    let stress = moduli * h * (1.0 + h).powi(4) / compressed.powi(3) + memory;
    let hourglass = if nodes == 8 {
        // q is a sum of eight displacements, and folded back along the element's arms with its gradients
        number(22) * 8.0 * spread * 8.0
    } else {
        0.0
    };
    Magnitude { stress, force: state.volume * stress * (1.0 + h) * gradients * nodes as f64 + hourglass }
}

/// The longest way from displacements to a corner's force: a gradient (8 roundings), strains and J (8), a cube root (10),
/// two laws (20), viscosity (8), F S (6), a force and the sum of all (16).
const ROUNDINGS: f64 = 76.0;

fn compare_element_forces(effects: &Effects, change: impl Fn(&mut World)) {
    let Some(mut pair) = run("element_forces", effects, 3, change) else { return };
    // for every place of the body's column the bound of its element
    let mut bounds = std::collections::BTreeMap::new();
    let blocks = entities::<Block>(pair.host.world_mut());
    for block in blocks {
        let data = pair.before().get::<Block>(block).unwrap();
        let numbers = 3 * node_count(data.kind);
        for row in 0..data.count {
            let force = ROUNDINGS * UNIT * magnitude(pair.before(), block, row).force;
            (0..numbers).for_each(|k| {
                bounds.insert((data.body, data.force_offset + lane_place(row, numbers, k)), force);
            });
        }
    }
    // fill-up lanes: both leave or make them zero, so clear them here
    for body in entities::<ElementForce>(pair.host.world_mut()) {
        for simulation in [&mut pair.host, &mut pair.device] {
            let mut column = simulation.world_mut().get_mut::<ElementForce>(body).unwrap();
            (0..column.len()).filter(|i| !bounds.contains_key(&(body, *i))).for_each(|i| column.set(i, 0.0));
        }
    }
    pair.agree::<ElementForce>(|_, body, i| bounds.get(&(body, i)).copied().unwrap_or(0.0));
    if effects.prony > 0 {
        pair.agree::<ViscousMemory>(|pair, block, i| {
            let data = pair.before().get::<Block>(block).unwrap();
            let row = i / (16 * 6 * effects.prony) * 16 + i % 16;
            if row >= data.count {
                return f64::INFINITY;
            }
            // q + rate (aim S − q): four roundings of the history, and those of the stress in proportion
            let law = pair.before().get::<sinew::backend::cpu::BlockLaw<f64>>(block).unwrap();
            let part = law.prony.iter().map(|term| (term.rate * term.aim).abs()).fold(0.0, f64::max);
            UNIT * (4.0 * 200.0 + ROUNDINGS * part * magnitude(pair.before(), block, row).stress)
        });
    }
    pair.identical::<FirstInverted>();
}

#[test]
fn elements_exert_the_same_forces() {
    for fibres in [None, Some(ALONG), Some(AROUND)] {
        for (prony, tension_only, backward_euler) in
            [(0, false, false), (0, true, false), (1, false, true), (2, true, false)]
        {
            let effects = Effects { fibres, prony, tension_only, backward_euler, ..Effects::default() };
            compare_element_forces(&effects, |_| {});
        }
    }
}

/// Turns some displacements up until elements are squeezed to nothing and inside out.
fn crush(world: &mut World) {
    for body in entities::<Displacement>(world) {
        let mut u = world.get_mut::<Displacement>(body).unwrap();
        for i in 60..120 {
            let value = u.get(i);
            u.set(i, 12.0 * value);
        }
    }
}

#[test]
fn inverted_elements_are_found_and_make_no_nan() {
    let effects = Effects { fibres: Some(ALONG), ..Effects::default() };
    let Some(mut pair) = run("element_forces", &effects, 3, crush) else { return };
    pair.identical::<FirstInverted>();
    assert!(pair.changed::<FirstInverted>() >= 2);
    for body in entities::<ElementForce>(pair.device.world_mut()) {
        let force = pair.device.world().get::<ElementForce>(body).unwrap();
        assert!((0..force.len()).all(|i| force.get(i).is_finite()));
    }
}

#[test]
fn nodes_gather_the_same_bits() {
    for loads in [false, true] {
        let effects = Effects { loads, ..Effects::default() };
        let Some(mut pair) = run("gather", &effects, 3, |_| {}) else { return };
        pair.identical::<InternalForce>();
        pair.identical::<ExternalForce>();
        assert!(pair.changed::<InternalForce>() > 1000);
    }
}

#[test]
fn loads_add_the_same_forces() {
    for removal in [false, true] {
        // with removal: some elements behind the faces are gone
        let effects = Effects { loads: true, removal, ..Effects::default() };
        for (system, factors) in [("gravity", 2.0), ("nodal_force", 2.0), ("pressure", 60.0), ("traction", 20.0)] {
            let Some(mut pair) = run(system, &effects, 3, remove_some) else { return };
            // 0.01 N were there; a load on a node adds less than 0.05 N, of a pressure by products of edges and sums of
            // up to eight faces
            let largest = 0.06;
            pair.agree::<ExternalForce>(|_, _, _| factors * UNIT * largest);
            assert!(pair.changed::<ExternalForce>() > 20, "{system}");
        }
    }
}

/// A loaded node without mass, and every third element of each block gone, also in what loads know of their faces.
fn remove_some(world: &mut World) {
    for load in entities::<NodalForce>(world) {
        let (row, body) = (world.get::<NodalForce>(load).unwrap().rows[1], world.get::<OfBody>(load).unwrap().0);
        world.get_mut::<Mass>(body).unwrap().set(row as usize, 0.0);
    }
    for block in entities::<Alive>(world) {
        let mut alive = world.get_mut::<Alive>(block).unwrap();
        alive.iter_mut().step_by(3).for_each(|alive| *alive = 0);
    }
    let removed = |world: &World, body: Entity, (place, row): (u32, u32)| {
        let block = world.get::<Authoring>(body).unwrap().blocks[place as usize];
        world.get::<Alive>(block).map_or(1, |alive| alive[row as usize])
    };
    for load in entities::<OfBody>(world) {
        let body = world.get::<OfBody>(load).unwrap().0;
        if let Some(faces) = world.get::<Pressure>(load).map(|p| p.faces.elements.clone()) {
            let alive = faces.iter().map(|&e| removed(world, body, e)).collect();
            world.get_mut::<Pressure>(load).unwrap().faces.alive = alive;
        }
        if let Some(faces) = world.get::<Traction>(load).map(|t| t.faces.elements.clone()) {
            let alive = faces.iter().map(|&e| removed(world, body, e)).collect();
            world.get_mut::<Traction>(load).unwrap().faces.alive = alive;
        }
    }
}

#[test]
fn prescribed_nodes_go_to_the_same_places() {
    for compensated in [false, true] {
        let effects = Effects { moved: true, compensated, ..Effects::default() };
        let Some(mut pair) = run("boundary", &effects, 500, lose_much) else { return };
        // three products of a gradient under 1 and an arm under 0.1 m, and a displacement: ten roundings
        pair.agree::<DisplacementStep>(|_, _, _| 10.0 * UNIT * 0.1);
        assert!(pair.changed::<DisplacementStep>() > 20);
    }
}

/// What rounding has left out, larger than it can ever be: it must not go under in the bound.
fn lose_much(world: &mut World) {
    for body in entities::<DisplacementCompensation>(world) {
        let mut lost = world.get_mut::<DisplacementCompensation>(body).unwrap();
        (0..lost.len()).for_each(|i| lost.set(i, 1e-4 * (1.0 + i as f64 / 1e4)));
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
            compare_motion(&mut pair, &effects);
        }
    }
}

fn compare_motion(pair: &mut Pair, effects: &Effects) {
    // d ← ((1 − a) d + Δt² (R − F)/m)/(1 + a): twelve roundings of the old step, the push and the new step
    let step_bound = |pair: &Pair, body: Entity, i: usize| {
        let dt = pair.before().resource::<Clock>().time_step;
        let mass = pair.before().get::<Mass>(body).unwrap().get(i / 3);
        let old = pair.before().get::<DisplacementStep>(body).unwrap().get(i).abs();
        let push = if mass > 0.0 { dt * dt * 0.02 / mass } else { 0.0 };
        12.0 * UNIT * (old + push)
    };
    pair.agree::<DisplacementStep>(step_bound);
    let at = |pair: &Pair, body: Entity, i: usize| pair.before().get::<Displacement>(body).unwrap().get(i).abs();
    // one rounding each, to either side: an ulp of the displacement
    pair.agree::<Displacement>(|pair, body, i| step_bound(pair, body, i) + 2.0 * UNIT * at(pair, body, i).max(1e-3));
    if effects.compensated {
        for body in entities::<DisplacementCompensation>(pair.host.world_mut()) {
            for i in 0..pair.host().get::<Displacement>(body).unwrap().len() {
                // u less what was lost is the exact sum, but for the rounding of what was lost
                let sum = |world: &World| {
                    let lost = world.get::<DisplacementCompensation>(body).unwrap().get(i);
                    (world.get::<Displacement>(body).unwrap().get(i) - lost, lost)
                };
                let ((host, lost), (device, _)) = (sum(pair.host()), sum(pair.device.world()));
                let allowed = step_bound(pair, body, i) + 2.0 * UNIT * lost.abs().max(1e-9);
                assert!((host - device).abs() <= allowed, "{i} of {body}: host {host:e}, GPU {device:e}");
            }
        }
    }
    if effects.energies {
        let dt = pair.before().resource::<Clock>().time_step;
        pair.agree::<Work>(|pair, body, i| {
            let old = pair.before().get::<Work>(body).unwrap().get(i).abs();
            let damping = pair.before().get::<DampingCoefficient>(body).map_or(0.0, |c| c.get(i / 4));
            let moved =
                |world: &World, axis: usize| world.get::<DisplacementStep>(body).unwrap().get(3 * (i / 4) + axis).abs();
            let steps: f64 = (0..3).map(|axis| moved(pair.before(), axis) + moved(pair.host(), axis)).sum();
            // forces under 0.01 N along the steps, six products and their sums, each step with its own twelve roundings
            24.0 * UNIT * (old + 0.02 * steps + damping / dt * steps * steps)
        });
    }
    pair.identical::<FirstNonFinite>();
    assert!(pair.changed::<Displacement>() > 1000);
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
    pair.identical::<FirstNonFinite>();
}

#[test]
fn the_same_elements_are_removed() {
    for effects in
        [Effects { removal: true, damping: true, fibres: Some(AROUND), ..Effects::default() }, Effects::all()]
    {
        for step in [0, 9] {
            let Some(mut pair) = run("element_removal", &effects, step, |_| {}) else { return };
            pair.identical::<Alive>();
            pair.identical::<RestShape>();
            // some by time; of the criteria of every tenth step far more
            let removed = pair.changed::<Alive>();
            assert!((if step == 9 { 100 } else { 10 }..1500).contains(&removed), "{removed} removed in step {step}");
            pair.agree::<RemovedEnergy>(|pair, block, i| {
                let data = pair.before().get::<Block>(block).unwrap();
                if i >= data.count {
                    return 0.0;
                }
                let magnitude = magnitude(pair.before(), block, i);
                // a stress along a strain, plus forces along displacements, plus 300 kg/m³ under 10 cm³ at 1 m/s
                ROUNDINGS * UNIT * (magnitude.force * 0.01 + 1e-5)
            });
            // sums of up to 24 shares
            pair.agree::<Mass>(|pair, body, i| 24.0 * UNIT * pair.host().get::<Mass>(body).unwrap().get(i));
            pair.agree::<DampingCoefficient>(|pair, body, i| {
                26.0 * UNIT * pair.host().get::<DampingCoefficient>(body).unwrap().get(i)
            });
        }
    }
}

#[test]
fn each_criterion_alone_finds_the_same_elements() {
    for criterion in
        ["StretchAbove(1.07)", "VolumeRatioAbove(1.02)", "VolumeRatioBelow(0.98)", "EnergyDensityAbove(120)"]
    {
        let effects = Effects { criterion: Some(criterion), fibres: Some(ALONG), ..Effects::default() };
        let Some(mut pair) = run("element_removal", &effects, 9, |_| {}) else { return };
        pair.identical::<Alive>();
        let removed = pair.changed::<Alive>();
        assert!((200..1300).contains(&removed), "{removed} by {criterion}");
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
        let mut steps = world.get_mut::<DisplacementStep>(body).unwrap();
        (0..steps.len()).for_each(|i| steps.set(i, f64::from(step)));
    }
    world.resource_mut::<Clock>().step = 1;
    const TIMES: u32 = 20_000;
    let exact = f64::from(0.01_f32) + f64::from(TIMES) * f64::from(step);
    let plain = (0..TIMES).fold(0.01_f32, |u, _| u + step);
    let registry = Registry::default();
    run_kernels(gpu, world, registry.get("integrate").unwrap().kernels.unwrap(), TIMES);
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
