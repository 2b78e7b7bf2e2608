//! A run on the GPU: where the truth of each column lies, and what travels.

use super::Buffers;
use super::gpu::{Buffer, BufferKind, Gpu, GpuLimits};
use super::kernel::{BindingKind, BufferId, Composed, Kernel, KernelError, KernelId, MostBuffers};
use crate::components::*;
use crate::error::Error;
use bevy_ecs::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::sync::Arc;

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Truth {
    Host,
    Device,
    Both,
}

struct DeviceColumn {
    buffer: BufferId,
    /// Its bytes there.
    place: Range<u64>,
    truth: Truth,
    access: ColumnAccess,
}

type Key = (Entity, &'static str);

/// What travelled between host and device for systems that run on the host.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct Traffic {
    /// Bytes brought to the host.
    pub down: u64,
    /// Bytes sent to the device.
    pub up: u64,
    /// Seconds spent waiting for both.
    pub seconds: f64,
}

/// The GPU, the device's columns and the step's kernels.
#[derive(Resource)]
pub struct Device {
    gpu: Gpu,
    columns: BTreeMap<Key, DeviceColumn>,
    written: BTreeMap<KernelId, Vec<Key>>,
    labelled: BTreeMap<String, Vec<BufferId>>,
    traffic: Traffic,
}

impl Device {
    /// Takes a GPU for a run.
    pub fn new(gpu: Gpu) -> Self {
        let (columns, written, labelled) = (BTreeMap::new(), BTreeMap::new(), BTreeMap::new());
        Self { gpu, columns, written, labelled, traffic: Traffic::default() }
    }

    /// What the GPU allows.
    pub fn limits(&self) -> GpuLimits {
        self.gpu.limits()
    }

    /// The GPU.
    pub fn gpu(&mut self) -> &mut Gpu {
        &mut self.gpu
    }

    /// Writes a uniform or constants anew, wherever kernels have them under that label; nothing where none has.
    ///
    /// # Errors
    /// What the GPU says.
    pub fn rewrite(&mut self, label: &str, bytes: &[u8]) -> Result<(), Error> {
        for &buffer in self.labelled.get(label).into_iter().flatten() {
            self.gpu.upload(buffer, 0, bytes)?;
        }
        Ok(())
    }

    /// What has travelled so far.
    pub fn traffic(&self) -> Traffic {
        self.traffic
    }

    /// Makes a system's kernels ready. `describe` is the systems' own description of them.
    ///
    /// # Errors
    /// Kernels that do not compile, and buffers that the device does not hold.
    pub fn prepare(
        world: &mut World,
        describe: impl FnOnce(&mut World, &mut dyn Buffers) -> Vec<Kernel>,
    ) -> Result<Vec<KernelId>, Error> {
        let Some(mut device) = world.remove_resource::<Device>() else { return Ok(Vec::new()) };
        let result = device.prepare_in(world, describe);
        world.insert_resource(device);
        result
    }

    fn prepare_in(
        &mut self,
        world: &mut World,
        describe: impl FnOnce(&mut World, &mut dyn Buffers) -> Vec<Kernel>,
    ) -> Result<Vec<KernelId>, Error> {
        let mut sizes = BTreeMap::new();
        let entities: Vec<Entity> = world.query::<EntityRef>().iter(world).map(|entity| entity.id()).collect();
        for &entity in &entities {
            for access in all_columns() {
                if let Some(bytes) = (access.bytes)(world, entity) {
                    sizes.insert((entity, access.name), (bytes.len(), *access));
                }
            }
        }
        let mut binder = Binder { device: self, sizes, fresh: Vec::new(), failure: None };
        let kernels = describe(world, &mut binder);
        let (fresh, failure) = (binder.fresh, binder.failure);
        if let Some(failure) = failure {
            return Err(failure);
        }
        for key in fresh {
            self.upload(world, key)?;
        }
        kernels.iter().map(|kernel| self.prepare_kernel(kernel)).collect()
    }

    fn prepare_kernel(&mut self, kernel: &Kernel) -> Result<KernelId, Error> {
        let id = self.gpu.prepare(kernel)?;
        let composed = self.gpu.compose(kernel).map_err(super::gpu::GpuError::from)?;
        let writes = |name: &str| composed.binding(name).is_some_and(|binding| binding.kind == BindingKind::ReadWrite);
        let buffers: BTreeSet<BufferId> =
            kernel.bindings.iter().filter(|(name, _)| writes(name)).map(|(_, buffer)| *buffer).collect();
        let keys = self.columns.iter().filter(|(_, column)| buffers.contains(&column.buffer)).map(|(key, _)| *key);
        self.written.insert(id, keys.collect());
        Ok(id)
    }

    /// Runs `count` steps of kernels in as few submissions as possible.
    ///
    /// # Errors
    /// What the GPU says.
    pub fn run(&mut self, kernels: &[KernelId], records: &[u8], record_size: usize, count: u32) -> Result<(), Error> {
        self.gpu.run(kernels, records, record_size, count)?;
        for kernel in kernels {
            for key in self.written.get(kernel).into_iter().flatten() {
                if let Some(column) = self.columns.get_mut(key) {
                    column.truth = Truth::Device;
                }
            }
        }
        Ok(())
    }

    /// The buffer of a column, and its bytes there.
    pub fn lend(&self, entity: Entity, name: &'static str) -> Option<(Buffer, Range<u64>)> {
        let column = self.columns.get(&(entity, name))?;
        Some((self.gpu.lend(column.buffer)?, column.place.clone()))
    }

    fn upload(&mut self, world: &World, key: Key) -> Result<(), Error> {
        let Some(column) = self.columns.get_mut(&key) else { return Ok(()) };
        let Some(bytes) = (column.access.bytes)(world, key.0) else { return Ok(()) };
        self.gpu.upload(column.buffer, column.place.start, bytes)?;
        column.truth = Truth::Both;
        self.traffic.up += bytes.len() as u64;
        Ok(())
    }

    fn keys_of(&self, truth: Truth, wanted: impl Fn(&Key, &ColumnAccess) -> bool) -> Vec<Key> {
        let right = self.columns.iter().filter(|(key, column)| column.truth == truth && wanted(key, &column.access));
        right.map(|(key, _)| *key).collect()
    }
}

/// Brings columns to the host where the device has newer ones. Nothing to do on the CPU backend.
///
/// # Errors
/// What the GPU says.
pub fn bring_to_host(world: &mut World, wanted: impl Fn(Entity, &'static str) -> bool) -> Result<(), Error> {
    let Some(mut device) = world.remove_resource::<Device>() else { return Ok(()) };
    let started = web_time::Instant::now();
    let keys = device.keys_of(Truth::Device, |key, _| wanted(key.0, key.1));
    let range = |column: &DeviceColumn| (column.buffer, column.place.start, column.place.end - column.place.start);
    let ranges: Vec<(BufferId, u64, u64)> = keys.iter().map(|key| range(&device.columns[key])).collect();
    let result = if ranges.is_empty() { Ok(Vec::new()) } else { device.gpu.download_ranges(&ranges) };
    // what comes is newer than what was seen before
    world.increment_change_tick();
    let result = result.map(|downloads| {
        for (key, bytes) in keys.iter().zip(downloads) {
            if let Some(column) = device.columns.get_mut(key) {
                (column.access.write)(world, key.0, &bytes);
                column.truth = Truth::Both;
                device.traffic.down += bytes.len() as u64;
            }
        }
    });
    device.traffic.seconds += started.elapsed().as_secs_f64();
    world.insert_resource(device);
    Ok(result?)
}

/// Says that the host has written columns, and sends them to the device.
///
/// # Errors
/// What the GPU says.
pub fn send_to_device(world: &mut World, written: impl Fn(Entity, &'static str) -> bool) -> Result<(), Error> {
    send(world, &[Truth::Both, Truth::Host], written)
}

/// The same, whatever kernels have made of these columns meanwhile.
///
/// # Errors
/// What the GPU says.
pub fn overwrite_on_device(world: &mut World, written: impl Fn(Entity, &'static str) -> bool) -> Result<(), Error> {
    send(world, &[Truth::Both, Truth::Host, Truth::Device], written)
}

fn send(world: &mut World, truths: &[Truth], written: impl Fn(Entity, &'static str) -> bool) -> Result<(), Error> {
    let Some(mut device) = world.remove_resource::<Device>() else { return Ok(()) };
    let started = web_time::Instant::now();
    for &truth in truths {
        for key in device.keys_of(truth, |key, _| written(key.0, key.1)) {
            if let Err(error) = device.upload(world, key) {
                world.insert_resource(device);
                return Err(error);
            }
        }
    }
    device.traffic.seconds += started.elapsed().as_secs_f64();
    world.insert_resource(device);
    Ok(())
}

/// Hands out buffers while kernels are described.
struct Binder<'a> {
    device: &'a mut Device,
    sizes: BTreeMap<Key, (usize, ColumnAccess)>,
    fresh: Vec<Key>,
    failure: Option<Error>,
}

impl Binder<'_> {
    fn create(&mut self, label: &str, bytes: &[u8], length: usize, kind: BufferKind) -> BufferId {
        let created = self.device.gpu.create(label, length as u64, kind).and_then(|id| {
            if !bytes.is_empty() {
                self.device.gpu.upload(id, 0, bytes)?;
            }
            Ok(id)
        });
        created.unwrap_or_else(|error| {
            self.failure.get_or_insert(error.into());
            BufferId::NONE
        })
    }
}

impl Buffers for Binder<'_> {
    fn column(&mut self, entity: Entity, name: &'static str) -> BufferId {
        if let Some(column) = self.device.columns.get(&(entity, name)) {
            return column.buffer;
        }
        let Some(&(_, access)) = self.sizes.get(&(entity, name)) else {
            self.failure
                .get_or_insert(Error::Options(format!("a kernel asks for the column {name} of an entity without it")));
            return BufferId::NONE;
        };
        let mut end = 0;
        let mut places = Vec::new();
        for column in columns_in(access.buffer) {
            if let Some(&(length, _)) = self.sizes.get(&(entity, column.name)) {
                places.push((column, end..end + length as u64));
                end += length as u64;
            }
        }
        let buffer = self.create(access.buffer, &[], end as usize, BufferKind::Storage);
        for (access, place) in places {
            let key = (entity, access.name);
            self.device.columns.insert(key, DeviceColumn { buffer, place, truth: Truth::Host, access });
            self.fresh.push(key);
        }
        buffer
    }

    fn compose(&mut self, kernel: &Kernel) -> Result<Arc<Composed>, KernelError> {
        self.device.gpu.compose(kernel)
    }

    fn most_buffers(&self) -> MostBuffers {
        self.device.gpu.limits().buffers
    }

    fn workgroup_invocations(&self) -> usize {
        self.device.gpu.limits().workgroup_size as usize
    }

    fn constants(&mut self, label: String, bytes: &[u8]) -> BufferId {
        let buffer = self.create(&label, bytes, bytes.len(), BufferKind::Storage);
        self.device.labelled.entry(label).or_default().push(buffer);
        buffer
    }

    fn uniform(&mut self, label: String, bytes: &[u8]) -> BufferId {
        let buffer = self.create(&label, bytes, bytes.len(), BufferKind::Uniform);
        self.device.labelled.entry(label).or_default().push(buffer);
        buffer
    }
}
