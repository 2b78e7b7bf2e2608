//! Steps on a GPU: as many in a submission as nothing on the host has to see.

use super::build::after_the_step;
use super::{Job, ScheduledPass, Simulation};
use crate::backend::device::{Device, bring_to_host, send_to_device};
use crate::backend::kernel::KernelId;
use crate::components::*;
use crate::error::Error;
use crate::observation::Observer;

impl Simulation {
    /// As many steps as can be taken before a host system has to run, or one step around it.
    pub(super) fn device_steps(&mut self, target: u64) -> Result<(), Error> {
        let step = self.step_count();
        let custom_due = |step: u64| {
            self.entries
                .iter()
                .any(|entry| matches!(entry.job, Job::Host { interval, observes: false, .. } if interval.is_due(step)))
        };
        let custom_is_due = custom_due(step);
        let most = self.before_steps()?;
        if custom_is_due {
            return self.device_step_around_hosts(step);
        }
        let mut until = target.min(self.world.resource::<Observer>().next_due(step));
        for entry in &self.entries {
            if let Job::Host { interval, observes: false, .. } = entry.job {
                until = until.min(interval.next_after(step));
            }
        }
        let kernels: Vec<KernelId> = self.entries.iter().flat_map(ScheduledPass::kernels).copied().collect();
        let count = (until - step).min(4096).min(most);
        debug_assert!(count > 0, "no step to take at {step}");
        self.run_kernels(&kernels, step, count)?;
        self.world.resource_mut::<Clock>().step = step + count;
        self.observe_if_due(step + count)
    }

    /// Does what systems on the device need before steps are submitted; how many there may be at most.
    fn before_steps(&mut self) -> Result<u64, Error> {
        let mut most = u64::MAX;
        for entry in &self.entries {
            if let Some(before_steps) = entry.before_steps {
                most = most.min(before_steps(&mut self.world)?.max(1));
            }
        }
        Ok(most)
    }

    fn observe_if_due(&mut self, step: u64) -> Result<(), Error> {
        if self.world.resource::<Observer>().next_due(step - 1) != step {
            return Ok(());
        }
        for entry in &mut self.entries {
            if matches!(entry.job, Job::Host { observes: true, .. }) {
                entry.run_on_host(step - 1, &mut self.world)?;
            }
        }
        self.keep_what_is_due()
    }

    fn device_step_around_hosts(&mut self, step: u64) -> Result<(), Error> {
        let mut waiting: Vec<KernelId> = Vec::new();
        let mut moved = false;
        for place in 0..self.entries.len() {
            let after = after_the_step(self.entries[place].phase);
            if after && !moved {
                // the kernels of this step still count from its beginning
                self.run_kernels(&std::mem::take(&mut waiting), step, 1)?;
                moved = true;
            }
            let entry = &self.entries[place];
            match &entry.job {
                Job::Kernels(kernels) if after => self.run_kernels(&kernels.clone(), step, 1)?,
                Job::Kernels(kernels) => waiting.extend(kernels),
                Job::Host { observes: true, .. } => {}
                Job::Host { interval, .. } if !interval.is_due(step) => {}
                Job::Host { writes, .. } => {
                    let (reads, writes) = (entry.reads.clone(), writes.clone());
                    self.run_kernels(&std::mem::take(&mut waiting), step, 1)?;
                    bring_to_host(&mut self.world, |_, name| reads.contains(&name) || writes.contains(&name))?;
                    self.world.resource_mut::<Clock>().step = step + u64::from(after);
                    self.evaluate_signals(step);
                    self.entries[place].run_on_host(step, &mut self.world)?;
                    send_to_device(&mut self.world, |_, name| writes.contains(&name))?;
                    self.world.resource_mut::<Clock>().step = step;
                }
            }
        }
        self.run_kernels(&waiting, step, 1)?;
        self.world.resource_mut::<Clock>().step = step + 1;
        self.observe_if_due(step + 1)
    }

    /// What comes after an implicit step: kernels of that step, what changes where elements have gone since there were
    /// so many, and who observes.
    pub(super) fn after_a_step_on_device(&mut self, step: u64, elements: usize) -> Result<(), Error> {
        let after = self.entries.iter().filter(|entry| after_the_step(entry.phase));
        let kernels: Vec<KernelId> = after.flat_map(ScheduledPass::kernels).copied().collect();
        self.run_kernels(&kernels, step, 1)?;
        self.renew_forces(step, elements)?;
        self.observe_if_due(step + 1)
    }

    fn run_kernels(&mut self, kernels: &[KernelId], first: u64, count: u64) -> Result<(), Error> {
        if kernels.is_empty() {
            return Ok(());
        }
        let mut records = Vec::new();
        let mut clock = *self.world.resource::<Clock>();
        for step in first..first + count {
            clock.step = step;
            self.evaluate_signals(step);
            records.extend(crate::backend::step::record(
                &clock,
                self.world.resource::<Signals>(),
                step + 1 == first + count,
            ));
        }
        let size = records.len() / count as usize;
        self.world.resource_mut::<Device>().run(kernels, &records, size, count as u32)
    }
}
