//! Steps.

use super::build::after_the_step;
use super::{Job, ScheduledPass, Simulation};
use crate::backend::cpu::Cpu;
use crate::backend::device::{Device, bring_to_host, send_to_device};
use crate::backend::kernel::KernelId;
use crate::components::*;
use crate::error::{Error, GpuFailure};
use crate::observation::Observer;
use bevy_ecs::prelude::*;
use std::time::Duration;
use web_time::Instant;

/// A time is a whole number of steps, or of frames, that is so little of one away.
pub(super) const WHOLE: f64 = 1e-6;

impl Simulation {
    /// Takes one step.
    ///
    /// # Errors
    /// As [`Simulation::advance`].
    pub fn step(&mut self) -> Result<(), Error> {
        self.advance(1)
    }

    /// Takes steps until the clock shows at least `time` (s).
    ///
    /// # Errors
    /// As [`Simulation::advance`].
    pub fn advance_to(&mut self, time: f64) -> Result<(), Error> {
        self.settle()?;
        loop {
            match self.steps_left_to(time)? {
                0 => return Ok(()),
                left => self.advance(left)?,
            }
        }
    }

    /// Takes at most `most` steps, none of which goes beyond `time` (s), whatever becomes of their length.
    ///
    /// # Errors
    /// As [`Simulation::advance`].
    pub fn advance_short_of(&mut self, time: f64, most: u64) -> Result<(), Error> {
        self.settle()?;
        let end = self.step_count().saturating_add(most);
        loop {
            self.begin_step_in_time()?;
            let clock = *self.world.resource::<Clock>();
            let whole = ((time - clock.since.1) / clock.time_step + WHOLE).floor().max(0.0) as u64;
            let next = clock.since.0.saturating_add(whole).min(end).min(self.solver.next_check());
            if next <= clock.step {
                return Ok(());
            }
            self.advance(next - clock.step)?;
        }
    }

    /// Steps that can be taken together until the clock shows at least `time` (s), as long as Δt stays as it is. Where
    /// there are any, the first of them has begun, and must be taken before anything is set.
    pub(super) fn steps_left_to(&mut self, time: f64) -> Result<u64, Error> {
        if self.steps_until(time) == 0 {
            return Ok(0);
        }
        self.begin_step_in_time()?;
        let step = self.step_count();
        let next = step.saturating_add(self.steps_until(time).max(1)).min(self.solver.next_check());
        Ok(next.saturating_sub(step))
    }

    /// Steps of Δt as it is until the clock shows at least `time` (s).
    pub(super) fn steps_until(&self, time: f64) -> u64 {
        let clock = self.world.resource::<Clock>();
        // a time that is a whole number of steps is met in spite of rounding
        let steps = ((time - clock.since.1) / clock.time_step - WHOLE).ceil().max(0.0) as u64;
        clock.since.0.saturating_add(steps).saturating_sub(clock.step)
    }

    /// Takes at most `count` steps, and none beyond the end of the scene.
    ///
    /// # Errors
    /// As [`Simulation::advance`].
    pub fn advance_towards_end(&mut self, count: u64) -> Result<(), Error> {
        self.settle()?;
        let target = self.step_count().saturating_add(count);
        while !self.is_finished() && self.step_count() < target {
            self.begin_step_in_time()?;
            let end = self.planned_steps().min(target).min(self.solver.next_check());
            let left = end.saturating_sub(self.step_count());
            if left == 0 {
                break;
            }
            self.advance(left)?;
        }
        Ok(())
    }

    /// Takes `count` steps. On the GPU they go in as few submissions as observations and custom systems allow. A static
    /// analysis stops where it finds equilibrium; there further calls do nothing.
    ///
    /// # Errors
    /// That the simulation broke down or found no equilibrium (the world keeps the state in which this was noticed),
    /// that the GPU failed, or that outputs could not be written.
    pub fn advance(&mut self, count: u64) -> Result<(), Error> {
        self.settle()?;
        self.keep_start();
        let target = self.step_count().saturating_add(count);
        let result = self.timed(|simulation| simulation.on_threads(|simulation| simulation.steps_to(target)));
        result.map_err(|error| self.note(error))
    }

    /// As a part of the run, whose time is taken.
    fn timed<T>(&mut self, task: impl FnOnce(&mut Self) -> T) -> T {
        let started = Instant::now();
        self.running = Some(started);
        let done = task(self);
        self.running = None;
        self.elapsed += started.elapsed();
        done
    }

    /// From one of the threads that work, where there are several.
    fn on_threads(&mut self, task: impl FnOnce(&mut Self) -> Result<(), Error> + Send) -> Result<(), Error> {
        match self.world.resource::<Cpu>().pool().filter(|_| !self.facts.on_gpu) {
            Some(pool) => pool.install(|| task(self)),
            None => task(self),
        }
    }

    /// [`Simulation::begin_step`] as a part of the run.
    fn begin_step_in_time(&mut self) -> Result<(), Error> {
        self.keep_start();
        self.timed(|simulation| {
            simulation.before_the_check()?;
            // threads are not called together for nothing
            let is_due = simulation.solver.next_check() <= simulation.step_count();
            if is_due { simulation.on_threads(Self::follow) } else { Ok(()) }
        })
    }

    /// Says of a GPU that failed how far the run came.
    fn with_what_is_kept(&self, error: Error) -> Error {
        let Error::Gpu(reason) = error else { return error };
        let good_until = self.world.get_resource::<Observer>().map_or(0.0, |observer| observer.good_until);
        let snapshot = self.leave_last_snapshot();
        Error::GpuFailed(Box::new(GpuFailure {
            reason,
            time: self.time(),
            step: self.step_count(),
            good_until,
            snapshot,
        }))
    }

    /// Notes how the simulation broke down, and leaves the last states where files are written.
    pub(super) fn note(&mut self, error: Error) -> Error {
        let Error::Unstable(mut broken) = error else { return self.with_what_is_kept(error) };
        if self.failure.is_none() && self.solver.leaves_states() {
            // what cannot be written now must not hide why the run ended
            let _ = self.leave_last_states(&mut broken);
        }
        self.failure = Some((*broken).clone());
        Error::Unstable(broken)
    }

    /// One step on the host, or as many as can be submitted together.
    pub(super) fn some_steps(&mut self, target: u64) -> Result<(), Error> {
        match self.facts.on_gpu {
            _ if self.solver.implicit().is_some() => self.implicit_step(),
            true => self.device_steps(target),
            false => self.host_step(target),
        }
    }

    /// Observes the present state, whatever is due.
    ///
    /// # Errors
    /// As [`Simulation::advance`].
    pub fn observe(&mut self) -> Result<(), Error> {
        self.settle()?;
        self.timed(Self::observe_in_time)
    }

    /// [`Simulation::observe`] as a part of a run whose time is taken.
    pub(super) fn observe_in_time(&mut self) -> Result<(), Error> {
        let observed = self.world.resource_scope(|world, mut observer: Mut<Observer>| observer.observe(world));
        observed.map_err(|error| self.note(error))
    }

    fn evaluate_signals(&mut self, step: u64) {
        let clock = *self.world.resource::<Clock>();
        let mut signals = self.world.resource_mut::<Signals>();
        match &clock.relaxation {
            Some(relaxation) => signals.approach(relaxation.end, [step, step + 1].map(|step| relaxation.share(step))),
            None => signals.evaluate(clock.window_at(step), [step, step + 1].map(|step| clock.time_at(step))),
        }
    }

    /// A step on the way to `target`, where the caller may look at all.
    fn host_step(&mut self, target: u64) -> Result<(), Error> {
        let step = self.step_count();
        let due = target.min(self.world.resource::<Observer>().next_due(step));
        self.world.insert_resource(Observed(self.facts.custom || due == step + 1));
        self.evaluate_signals(step);
        let mut moved = false;
        let mut left = &mut self.entries[..];
        while let Some((entry, others)) = left.split_first_mut() {
            if after_the_step(entry.phase) && !moved {
                self.world.resource_mut::<Clock>().step = step + 1;
                moved = true;
            }
            let asleep = entry.sleepers > 0 && all_sleep(&mut others[..entry.sleepers], step, &mut self.world)?;
            entry.run_on_host(step, &mut self.world)?;
            // these are left out, and the pass that would move the nodes
            left = if asleep { &mut others[entry.sleepers + 1..] } else { others };
        }
        self.world.resource_mut::<Clock>().step = step + 1;
        self.keep_what_is_due()
    }

    /// As many steps as can be taken before a host system has to run, or one step around it.
    fn device_steps(&mut self, target: u64) -> Result<(), Error> {
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

    /// What comes after an implicit step: kernels of that step, and who observes.
    pub(super) fn after_a_step_on_device(&mut self, step: u64) -> Result<(), Error> {
        let after = self.entries.iter().filter(|entry| after_the_step(entry.phase));
        let kernels: Vec<KernelId> = after.flat_map(ScheduledPass::kernels).copied().collect();
        self.run_kernels(&kernels, step, 1)?;
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

/// Asks passes whether they do something in this step, before any force is known.
fn all_sleep(passes: &mut [ScheduledPass], step: u64, world: &mut World) -> Result<bool, Error> {
    world.insert_resource(SurfaceSleep { asked: true, asleep: true });
    let answered = passes.iter_mut().try_for_each(|pass| pass.run_on_host(step, world));
    let asleep = world.resource::<SurfaceSleep>().asleep;
    world.insert_resource(SurfaceSleep { asked: false, asleep });
    answered?;
    if !asleep {
        // who answers and then does something has run once
        passes.iter_mut().filter(|pass| pass.is_due(step)).for_each(|pass| pass.runs -= 1);
    }
    Ok(asleep)
}

impl ScheduledPass {
    pub(super) fn kernels(&self) -> &[KernelId] {
        match &self.job {
            Job::Kernels(kernels) => kernels,
            Job::Host { .. } => &[],
        }
    }

    /// Whether one of its systems reads a column.
    pub(super) fn reads(&self, name: &str) -> bool {
        self.reads.contains(&name)
    }

    /// Whether it is run in a step, if the host runs it.
    fn is_due(&self, step: u64) -> bool {
        matches!(&self.job, Job::Host { interval, .. } if interval.is_due(step))
    }

    /// Runs a host system if this is one of its steps.
    pub(super) fn run_on_host(&mut self, step: u64, world: &mut World) -> Result<(), Error> {
        if !self.is_due(step) {
            return Ok(());
        }
        let Job::Host { system, .. } = &mut self.job else { return Ok(()) };
        let started = Instant::now();
        let writing = |world: &World| world.get_resource::<Observer>().map_or(Duration::ZERO, |seen| seen.writing);
        let before = writing(world);
        let result = system.run((), world);
        self.time += started.elapsed().saturating_sub(writing(world) - before);
        self.runs += 1;
        match result {
            Ok(result) => result,
            Err(error) => Err(Error::Options(format!("the system `{}` cannot run: {error}", self.name))),
        }
    }
}
