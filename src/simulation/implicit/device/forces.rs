//! Forces at trial displacements on a device, and what travels for them.

use super::super::super::ScheduledPass;
use super::super::trial::Trial;
use crate::backend::device::{Device, bring_to_host, overwrite_on_device};
use crate::backend::kernel::KernelId;
use crate::backend::step::trial_record;
use crate::components::*;
use crate::error::Error;
use crate::scene::schema::Inversion;
use crate::systems::Phase;
use bevy_ecs::prelude::*;

/// Whether the column of a name is of a state, about one of some subjects.
fn is_about(name: &str, subjects: &[Subject]) -> bool {
    column_is(name, |column| column.role != Role::Scratch && subjects.contains(&column.subject))
}

/// How many elements are there, of blocks that may lose some, as the host knows.
pub(in super::super) fn left(world: &mut World) -> usize {
    // a query asks for memory
    if !is_anywhere::<Alive>(world) {
        return 0;
    }
    let mut all = world.query::<&Alive>();
    all.iter(world).flat_map(|alive| &alive.0).filter(|&&alive| alive != 0).count()
}

/// Brings to the host which elements are there, and where some have gone since there were so many, what has changed
/// with them. Whether some have.
pub(in super::super) fn bring_removal(world: &mut World, before: usize) -> Result<bool, Error> {
    bring_to_host(world, |_, name| is_about(name, &[Subject::Removal]))?;
    let went = left(world) != before;
    if went {
        bring_to_host(world, |_, name| is_about(name, &[Subject::Mass, Subject::Shape]))?;
    }
    Ok(went)
}

/// Brings the state to the host that a step begins with.
pub(in super::super) fn bring_state(world: &mut World) -> Result<(), Error> {
    let before = left(world);
    bring_removal(world, before)?;
    let read = [Subject::Motion, Subject::Constraint, Subject::Memory, Subject::Inversion];
    bring_to_host(world, |_, name| is_about(name, &read))
}

/// Sends the state to the device that a step has come to, or has gone back to.
pub(in super::super) fn send_state(world: &mut World) -> Result<(), Error> {
    overwrite_on_device(world, |_, name| is_about(name, &[Subject::Motion, Subject::Inversion]))
}

impl Trial<'_> {
    /// Whether a GPU has the forces.
    pub fn is_on_device(&self) -> bool {
        self.world.contains_resource::<Device>()
    }

    /// The kernels of some passes.
    pub(super) fn kernels(&self, which: impl Fn(&ScheduledPass) -> bool) -> Vec<KernelId> {
        self.passes.iter().filter(|pass| which(pass)).flat_map(|pass| pass.kernels()).copied().collect()
    }

    /// The record of forces at the end of the step.
    pub(super) fn record(&self) -> Vec<u8> {
        let trying = self.world.get_resource::<TrialForces>().is_some_and(|trial| trial.trying);
        trial_record(self.world.resource::<Clock>(), self.world.resource::<Signals>(), trying)
    }

    /// Runs the kernels of some passes.
    fn run_kernels(&mut self, which: impl Fn(&ScheduledPass) -> bool) -> Result<(), Error> {
        let (kernels, record) = (self.kernels(which), self.record());
        if kernels.is_empty() {
            return Ok(());
        }
        super::run(self.world, &kernels, &record, 1)
    }

    /// Says where held axes go.
    pub fn boundary_on_device(&mut self) -> Result<(), Error> {
        self.run_kernels(|pass| pass.phase == Phase::Boundary)?;
        bring_to_host(self.world, |_, name| name == DisplacementIncrement::NAME)
    }

    /// Takes the forces at the displacements, and if so at the velocities, that the host has.
    pub fn forces_on_device(&mut self, with_velocities: bool) -> Result<(), Error> {
        let trying = self.world.get_resource::<TrialForces>().is_some_and(|trial| trial.trying);
        // of what is only tried nothing is noted
        let noted = if trying { forget_inverted(self.world) } else { Vec::new() };
        let moves = |name| name == Displacement::NAME || with_velocities && name == DisplacementIncrement::NAME;
        overwrite_on_device(self.world, |_, name| moves(name) || name == FirstInverted::NAME)?;
        self.run_kernels(|pass| pass.finds_forces)?;
        bring_to_host(self.world, |_, name| is_about(name, &[Subject::Force, Subject::Inversion]))?;
        if trying {
            let inverted = must_not_be_inverted(self.world);
            if let Some(mut trial) = self.world.get_resource_mut::<TrialForces>() {
                trial.inverted = inverted;
            }
            remember_inverted(self.world, noted);
        }
        Ok(())
    }
}

fn forget_inverted(world: &mut World) -> Vec<(Entity, Vec<u32>)> {
    let mut blocks = world.query::<(Entity, &mut FirstInverted)>();
    let taken = blocks.iter_mut(world).map(|(block, mut inverted)| {
        let nothing = vec![u32::MAX; inverted.0.len()];
        (block, std::mem::replace(&mut inverted.0, nothing))
    });
    taken.collect()
}

fn remember_inverted(world: &mut World, noted: Vec<(Entity, Vec<u32>)>) {
    for (block, numbers) in noted {
        if let Some(mut inverted) = world.get_mut::<FirstInverted>(block) {
            inverted.0 = numbers;
        }
    }
}

/// Whether an element is noted that must not be turned inside out.
fn must_not_be_inverted(world: &mut World) -> bool {
    let mut blocks = world.query::<(&FirstInverted, Option<&OnInversion>)>();
    let must_not = |policy: Option<&OnInversion>| policy.is_none_or(|policy| policy.0 == Inversion::Stop);
    blocks.iter(world).any(|(inverted, policy)| must_not(policy) && inverted.0.first() != Some(&u32::MAX))
}
