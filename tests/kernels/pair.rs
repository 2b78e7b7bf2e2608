//! One system run both ways, and how to compare what it made.

use super::kernel_worlds::{Effects, randomize, shared_kernels};
use bevy_ecs::prelude::*;
use sinew::BackendChoice;
use sinew::backend::device::{Device, bring_to_host};
use sinew::backend::gpu::{Gpu, gpu_or_reason};
use sinew::components::*;
use sinew::systems::Registry;

/// Half the distance from 1 to the next f32.
pub const UNIT: f64 = 1.0 / (1 << 24) as f64;

/// The same world before and after one system, on the host and on a GPU.
pub struct Pair {
    pub before: sinew::Simulation,
    pub host: sinew::Simulation,
    pub device: sinew::Simulation,
}

/// Runs one system on random fields both ways, in the step of that number; `change` makes the fields special.
pub fn run(system: &str, effects: &Effects, step: u64, change: impl Fn(&mut World)) -> Option<Pair> {
    run_all(&[system], effects, step, change)
}

/// The same with several systems of nodes, which share kernels on the GPU; those that the scene does not call for are
/// left out.
pub fn run_all(systems: &[&str], effects: &Effects, step: u64, change: impl Fn(&mut World)) -> Option<Pair> {
    let gpu = gpu_or_reason()?;
    let world = || {
        let mut simulation = effects.simulation(BackendChoice::Cpu);
        let world = simulation.world_mut();
        randomize(world, 7);
        change(world);
        let mut clock = world.resource_mut::<Clock>();
        clock.step = step;
        let (window, times) = (clock.window_at(step), [step, step + 1].map(|step| step as f64 * clock.time_step));
        world.resource_mut::<Signals>().evaluate(window, times);
        simulation
    };
    let (before, mut host, mut device) = (world(), world(), world());
    let registry = Registry::default();
    for system in systems.iter().map(|name| registry.get(name).unwrap()) {
        let on_host = host.world_mut();
        if systems.len() > 1 && (system.because)(on_host).is_none() {
            continue;
        }
        if system.phase > sinew::systems::Phase::Integrate {
            on_host.resource_mut::<Clock>().step += 1;
        }
        let mut body = system.host.alone(&system.name, on_host);
        body.initialize(on_host);
        body.run((), on_host).unwrap().unwrap();
    }
    let describe = |world: &mut World, buffers: &mut dyn sinew::backend::Buffers| match systems {
        [one] => registry.get(one).unwrap().kernels(world, buffers),
        several => shared_kernels(several, world, buffers),
    };
    run_kernels(gpu, device.world_mut(), describe, 1);
    Some(Pair { before, host, device })
}

/// One system both ways, each time on a world that is made anew.
pub fn run_in(system: &str, world: impl Fn() -> sinew::Simulation) -> Option<Pair> {
    let gpu = gpu_or_reason()?;
    let [before, mut host, mut device] = [(); 3].map(|()| world());
    let registry = Registry::default();
    let system = registry.get(system).unwrap();
    let on_host = host.world_mut();
    let mut body = system.host.alone(&system.name, on_host);
    body.initialize(on_host);
    body.run((), on_host).unwrap().unwrap();
    run_kernels(gpu, device.world_mut(), |world, buffers| system.kernels(world, buffers), 1);
    Some(Pair { before, host, device })
}

pub fn run_kernels(
    gpu: Gpu,
    world: &mut World,
    describe: impl FnOnce(&mut World, &mut dyn sinew::backend::Buffers) -> Vec<sinew::backend::kernel::Kernel>,
    times: u32,
) {
    world.insert_resource(Device::new(gpu));
    let kernels = Device::prepare(world, describe).unwrap_or_else(|error| panic!("{error}"));
    assert!(!kernels.is_empty());
    let record = sinew::backend::step::record(world.resource::<Clock>(), world.resource::<Signals>(), true);
    let records = record.repeat(times as usize);
    world.resource_mut::<Device>().run(&kernels, &records, record.len(), times).unwrap();
    bring_to_host(world, |_, _| true).unwrap();
}

pub fn entities<C: Component>(world: &mut World) -> Vec<Entity> {
    let mut all: Vec<Entity> = world.query_filtered::<Entity, With<C>>().iter(world).collect();
    all.sort();
    all
}

impl Pair {
    pub fn host(&self) -> &World {
        self.host.world()
    }
    pub fn before(&self) -> &World {
        self.before.world()
    }

    /// Compares a column of real numbers: `bound` gives, for a number of an entity, the difference that rounding
    /// explains.
    pub fn agree<C: Component + std::ops::Deref<Target = Reals>>(
        &mut self,
        bound: impl Fn(&Self, Entity, usize) -> f64,
    ) {
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
    pub fn identical<C: Column>(&mut self) {
        for entity in entities::<C>(self.host.world_mut()) {
            let host = self.host.world().get::<C>(entity).unwrap().bytes();
            let device = self.device.world().get::<C>(entity).unwrap().bytes();
            let differing = host.chunks(4).zip(device.chunks(4)).filter(|(a, b)| a != b).count();
            assert_eq!(differing, 0, "numbers of {} of {entity} that differ", C::NAME);
        }
    }

    pub fn changed<C: Column>(&mut self) -> usize {
        let mut count = 0;
        for entity in entities::<C>(self.host.world_mut()) {
            let before = self.before.world().get::<C>(entity).unwrap().bytes();
            let device = self.device.world().get::<C>(entity).unwrap().bytes();
            count += before.chunks(4).zip(device.chunks(4)).filter(|(a, b)| a != b).count();
        }
        count
    }
}

/// Steps and forces of all bodies at random, in the fourth step: what attachments and surfaces begin with.
pub fn stir(simulation: &mut sinew::Simulation) {
    let world = simulation.world_mut();
    let mut random = fastrand::Rng::with_seed(3);
    for body in entities::<Displacement>(world) {
        let mut fill = |reals: &mut Reals, scale: f64| {
            (0..reals.len()).for_each(|i| reals.set(i, scale * (2.0 * random.f64() - 1.0)));
        };
        fill(&mut world.get_mut::<Displacement>(body).unwrap(), 5e-5);
        fill(&mut world.get_mut::<DisplacementIncrement>(body).unwrap(), 5e-5);
        fill(&mut world.get_mut::<InternalForce>(body).unwrap(), 1e-3);
        fill(&mut world.get_mut::<ExternalForce>(body).unwrap(), 1e-3);
    }
    let mut clock = world.resource_mut::<Clock>();
    clock.step = 3;
    let (window, times) = (clock.window_at(3), [3, 4].map(|step| f64::from(step) * clock.time_step));
    world.resource_mut::<Signals>().evaluate(window, times);
}
