//! Going on with steps of another length: everything that counts in steps follows.

use super::block_forces::{BlockForces, widened};
use super::{Job, Simulation};
use crate::assembly::step_of;
use crate::backend::block_kernel::{law_numbers, terms_uniform};
use crate::backend::cpu::{BlockLaw, Cpu};
use crate::backend::device::{Device, bring_to_host, send_to_device};
use crate::components::*;
use crate::error::Error;
use crate::materials::PronyTerm;
use crate::observation::Observer;
use bevy_ecs::prelude::*;
use std::sync::Arc;

/// What is written: increments, viscous memories, which follow, and when elements go by time.
fn is_written(column: &ColumnAccess) -> bool {
    let follows = matches!(column.subject, Subject::Memory | Subject::Removal) && column.role == Role::State;
    follows || column.increments != Increments::None
}

/// What is read: the same, and what memories follow from.
fn is_read(column: &ColumnAccess) -> bool {
    is_written(column) || matches!(column.subject, Subject::Motion | Subject::Shape)
}

impl Simulation {
    /// Takes steps of another length (s) from the present one on, whatever is stable; the scene ends with the last
    /// whole step in its duration. Where the step follows what is stable, or errors of implicit steps, it becomes no
    /// larger than this from then on.
    ///
    /// # Errors
    /// A step that is no positive number; a static analysis, whose steps are no motion; what the GPU says.
    pub fn set_time_step(&mut self, time_step: f64) -> Result<(), Error> {
        let clock = *self.world.resource::<Clock>();
        if !(time_step.is_finite() && time_step > 0.0) || clock.relaxation.is_some() {
            return Err(Error::Options(format!("{time_step} s is no step that this simulation can take")));
        }
        self.lineage.note(clock.step, &format!("step {time_step:?}"));
        let left = ((self.scene.duration - clock.time()) / time_step).round().max(0.0);
        if let Some(control) = self.solver.step_control() {
            control.limit(time_step);
            return self.choose_step();
        }
        if let Some(follower) = self.solver.follower_mut() {
            follower.found.own = Some(time_step);
        }
        self.change_step(time_step, clock.step + left as u64)
    }

    /// Takes steps of another length (s) from the present step on.
    ///
    /// Velocities stay: the column of steps is scaled. The clock counts from here, and outputs, removal by time, custom
    /// systems and the history of viscous materials go on at their times.
    pub(super) fn change_step(&mut self, time_step: f64, last_step: u64) -> Result<(), Error> {
        let world = &mut self.world;
        let counted: Vec<ColumnAccess> =
            all_columns().iter().copied().filter(|column| column.increments != Increments::None).collect();
        bring_to_host(world, |_, name| column_is(name, is_read))?;
        let before = *world.resource::<Clock>();
        world.resource_scope(|world, mut observer: Mut<Observer>| observer.change_step(world, time_step, last_step))?;
        world.resource_mut::<Clock>().change_step(time_step);
        let now = *world.resource::<Clock>();
        scale_increments(&counted, now.time_step / before.time_step, world);
        relax_on(world, &now)?;
        remove_in_time(world, &now);
        for entry in &mut self.entries {
            if let Job::Host { interval, .. } = &mut entry.job {
                interval.change_step(now.step, before.time_step, now.time_step);
            }
        }
        self.facts.steps = last_step;
        send_to_device(world, |_, name| column_is(name, is_written))
    }
}

/// Velocities are kept: what columns hold of changes in a step follows it.
fn scale_increments(counted: &[ColumnAccess], factor: f64, world: &mut World) {
    let bodies: Vec<Entity> = world.query_filtered::<Entity, With<Body>>().iter(world).collect();
    for body in bodies {
        counted.iter().for_each(|column| (column.scale_increments)(world, body, factor));
    }
}

/// The recursions of viscous materials take the coefficients of the new step. The memory of the exact one, H − φS,
/// holds a coefficient of the old step too: what it stands for stays the same. So does the stress at the end of an
/// implicit step, which memories before it tell of.
fn relax_on(world: &mut World, clock: &Clock) -> Result<(), Error> {
    for (entity, law) in laws_of_step(world, clock) {
        let Some(before) = world.get::<BlockLaw<f64>>(entity).cloned() else { continue };
        let then = |copy: Option<usize>, place: usize| {
            let of_copy =
                copy.zip(law.copies.as_ref()).and_then(|(copy, copies)| copies.of_copy[copy].terms.get(place));
            of_copy.or_else(|| law.prony.iter().chain(&law.volumetric).nth(place)).copied()
        };
        let aim = |copy: Option<usize>, place: usize| then(copy, place).map_or(0.0, |term| term.aim);
        let changes = before.with_terms(|copy, place, term| PronyTerm::adding(aim(copy, place) - term.aim));
        let kept = before.with_terms(|copy, place, term| {
            then(copy, place).map_or(PronyTerm::adding(0.0), |then| PronyTerm::keeping(term, &then))
        });
        carry_memory_on(world, entity, &changes);
        carry_memory_before_on(world, entity, &kept);
        take_law(world, entity, law)?;
    }
    Ok(())
}

/// The same where memories already belong to the step, as those of a snapshot do.
pub(super) fn relax_as(world: &mut World, clock: &Clock) -> Result<(), Error> {
    for (entity, law) in laws_of_step(world, clock) {
        take_law(world, entity, law)?;
    }
    Ok(())
}

/// Bodies that start deformed have been so for a step: damping remembers the stress that they start with. Memories must
/// be 0 before.
pub(super) fn remember_the_start(world: &mut World) {
    remember(world, |term| if term.is_damping() { term.aim } else { 0.0 });
}

/// The memories of blocks that have stood as they stand for long: each has come to its aim, aim·S, which takes αS from
/// the stress whatever the step is.
pub(super) fn relax_fully(world: &mut World) {
    world.query::<&mut ViscousMemory>().iter_mut(world).for_each(|mut memory| memory.0.bytes_mut().fill(0));
    world.query::<&mut MemoryBefore>().iter_mut(world).for_each(|mut memory| memory.0.bytes_mut().fill(0));
    remember(world, |term| term.aim);
}

/// Puts memories to so many times the present stress.
fn remember(world: &mut World, times: fn(&PronyTerm<f64>) -> f64) {
    let blocks: Vec<Entity> = world.query_filtered::<Entity, With<ViscousMemory>>().iter(world).collect();
    for entity in blocks {
        let Some(law) = world.get::<BlockLaw<f64>>(entity) else { continue };
        let adding = law.with_terms(|_, _, term| PronyTerm::adding(times(term)));
        add_to_memory_by(world, entity, adding);
    }
}

/// Viscous blocks, with their laws for a step of the clock's length.
fn laws_of_step(world: &mut World, clock: &Clock) -> Vec<(Entity, BlockLaw<f64>)> {
    let blocks: Vec<Entity> = world.query_filtered::<Entity, With<ViscousMemory>>().iter(world).collect();
    let of_block = |entity: Entity| {
        let [prony, volumetric] = ElementMemory::of(world, world.get::<Block>(entity)?.material).terms(clock);
        let mut law = BlockLaw { prony, volumetric, ..world.get::<BlockLaw<f64>>(entity)?.clone() };
        if let (Some(copies), Some(memories)) = (&law.copies, world.get::<PerCopyMemory>(entity)) {
            law.copies = Some(Arc::new(copies.with_memories(&memories.0, clock)));
        }
        Some((entity, law))
    };
    blocks.into_iter().filter_map(of_block).collect()
}

/// Gives a block the law of another step, here and on a device.
fn take_law(world: &mut World, entity: Entity, law: BlockLaw<f64>) -> Result<(), Error> {
    let label = world.get::<Label>(entity).map(|label| label.0.clone()).unwrap_or_default();
    let rounded = law.rounded::<f32>();
    if let Some(mut device) = world.get_resource_mut::<Device>() {
        for (label, bytes) in terms_uniform(&rounded, &label).into_iter().chain(law_numbers(&rounded, &label)) {
            device.rewrite(&label, &bytes)?;
        }
    }
    let mut entity = world.entity_mut(entity);
    if entity.contains::<BlockLaw<f32>>() {
        entity.insert(rounded);
    }
    entity.insert(law);
    Ok(())
}

/// Adds to a block's memory what a law adds whose terms do just that, and to that before the last step.
pub(super) fn add_to_memory_by(world: &mut World, entity: Entity, adding: BlockLaw<f64>) {
    carry_memory_on(world, entity, &adding);
    carry_memory_before_on(world, entity, &adding);
}

/// Carries a block's memory on by a law, where it has one.
fn carry_memory_on(world: &mut World, entity: Entity, law: &BlockLaw<f64>) {
    let of: &World = world;
    let carried = of.get::<ViscousMemory>(entity).and_then(|memory| carried_on(of, entity, law, &memory.0));
    if let (Some(carried), Some(mut memory)) = (carried, world.get_mut::<ViscousMemory>(entity)) {
        memory.0 = carried;
    }
}

/// The same of that before the last step.
fn carry_memory_before_on(world: &mut World, entity: Entity, law: &BlockLaw<f64>) {
    let of: &World = world;
    let carried = of.get::<MemoryBefore>(entity).and_then(|memory| carried_on(of, entity, law, &memory.0));
    if let (Some(carried), Some(mut memory)) = (carried, world.get_mut::<MemoryBefore>(entity)) {
        memory.0 = carried;
    }
}

/// A memory of a block as a law carries it on, by the block's own kernel.
fn carried_on(world: &World, entity: Entity, law: &BlockLaw<f64>, memory: &Reals) -> Option<Reals> {
    let mut block = BlockForces::of(world, entity, |_| law.clone())?;
    block.memory = widened(memory).into_owned();
    let body = block.block.body;
    let displacement = widened(world.get::<Displacement>(body)?);
    let mut unused = vec![0.0; world.get::<ElementForce>(body)?.len()];
    block.forces(world.resource::<Cpu>(), &displacement, &mut unused);
    Some(Reals::from_f64(memory.precision(), block.memory.into_iter()))
}

/// Gives viscous blocks a memory of before the last step, which is the present one where there was none.
pub(super) fn add_memories_before(world: &mut World) {
    let blocks: Vec<(Entity, Reals)> = world
        .query::<(Entity, &ViscousMemory)>()
        .iter(world)
        .map(|(entity, memory)| (entity, memory.0.clone()))
        .collect();
    for (entity, memory) in blocks {
        world.entity_mut(entity).insert(MemoryBefore(memory));
    }
}

/// Keeps memories that are about to be carried on, where somebody looks at them afterwards.
pub(super) fn keep_memories(world: &mut World) {
    // a query asks for memory
    if !is_anywhere::<MemoryBefore>(world) {
        return;
    }
    for (memory, mut before) in world.query::<(&ViscousMemory, &mut MemoryBefore)>().iter_mut(world) {
        before.0.bytes_mut().copy_from_slice(memory.0.bytes());
    }
}

/// What is still to go by time goes at the step that its time is now.
fn remove_in_time(world: &mut World, clock: &Clock) {
    for (times, alive, mut steps) in world.query::<(&RemovalTime, &Alive, &mut RemovalStep)>().iter_mut(world) {
        for row in (0..times.0.len()).filter(|&row| alive[row] == 1 && times.0[row].is_finite()) {
            let from_here = (times.0[row] - clock.since.1) / clock.time_step;
            steps[row] = step_of(clock.step as f64 + from_here, clock.step + 1);
        }
    }
}
