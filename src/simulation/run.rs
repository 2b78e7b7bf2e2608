//! Steps: how many are taken together, what comes before and after them, and one of them on the host.

use super::build::after_the_step;
use super::{Job, ScheduledPass, Simulation};
use crate::backend::cpu::Cpu;
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
        self.advance_towards(time, u64::MAX).map(drop)
    }

    /// The same in at most `most` steps; whether there may be more to take.
    #[doc(hidden)]
    pub fn advance_towards(&mut self, time: f64, most: u64) -> Result<bool, Error> {
        self.settle()?;
        let end = self.step_count().saturating_add(most);
        loop {
            let step = self.step_count();
            if step >= end {
                return Ok(true);
            }
            match self.steps_left_to(time)? {
                0 => return Ok(false),
                left => self.advance(left.min(end - step))?,
            }
            // a static analysis is at rest
            if self.step_count() == step {
                return Ok(false);
            }
        }
    }

    /// Takes at most `most` steps, none of which goes beyond `time` (s), whatever becomes of their length. Where not
    /// even one of the present length fits, nothing begins: what has been set may be set anew.
    ///
    /// # Errors
    /// As [`Simulation::advance`].
    pub fn advance_short_of(&mut self, time: f64, most: u64) -> Result<(), Error> {
        self.settle()?;
        let end = self.step_count().saturating_add(most);
        while self.steps_short_of(time, end) > 0 {
            self.begin_step_in_time()?;
            // by now their length may be another one
            let unchecked = self.solver.next_check().saturating_sub(self.step_count());
            match self.steps_short_of(time, end).min(unchecked) {
                0 => break,
                steps => self.advance(steps)?,
            }
        }
        Ok(())
    }

    /// Steps of Δt as it is, none of which goes beyond `time` (s) or the step `end`.
    fn steps_short_of(&self, time: f64, end: u64) -> u64 {
        let clock = self.world.resource::<Clock>();
        let whole = ((time - clock.since.1) / clock.time_step + WHOLE).floor().max(0.0) as u64;
        clock.since.0.saturating_add(whole).min(end).saturating_sub(clock.step)
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

    /// Takes steps up to `target`, or as far as the solver goes.
    pub(super) fn steps_to(&mut self, target: u64) -> Result<(), Error> {
        while self.step_count() < target {
            self.begin_step()?;
            self.begin_frame();
            let step = self.step_count();
            let Some(until) = self.solver.until(step, || self.next_of_others()) else { return Ok(()) };
            if step < until {
                self.some_steps(target.min(until))?;
                self.end_batches()?;
                self.end_frame();
            }
            if self.solver.check(&mut self.world, &mut self.entries)? {
                self.world.resource_mut::<Observer>().last_step = self.step_count();
                self.observe_in_time()?;
            }
        }
        Ok(())
    }

    /// What comes before a step, in an order that does not depend on how the program asks for steps: the state is kept,
    /// inputs and what hands do are taken up, and then the stable step is checked. A second time before the same step
    /// it does nothing.
    fn begin_step(&mut self) -> Result<(), Error> {
        self.before_the_check()?;
        self.follow()
    }

    /// All of it but the check.
    pub(super) fn before_the_check(&mut self) -> Result<(), Error> {
        self.wait_for_real_time();
        self.keep_history_if_due()?;
        self.take_up_inputs()?;
        self.begin_batches()
    }

    /// The next step before which somebody beside the solver has something to do: who sets inputs, who keeps states, a
    /// hand at a port, the clock on the wall, the end of a frame.
    fn next_of_others(&self) -> u64 {
        let kept = self.next_kept().max(self.step_count() + 1);
        self.next_change().min(kept).min(self.ports.next_end()).min(self.next_tick()).min(self.next_frame())
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
    pub(super) fn on_threads(&mut self, task: impl FnOnce(&mut Self) -> Result<(), Error> + Send) -> Result<(), Error> {
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

    /// Curves of a step, which loads and motions read: of loads their mean over the step.
    pub(super) fn evaluate_signals(&mut self, step: u64) {
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

    /// Runs a host system if this is one of its steps: what `entries` in `build.rs` made of the pass, as the plan says
    /// and `explain` prints: `patch_pass` (elements with what follows for nodes), `node_pass`, `shared_pass`, or the
    /// system by itself.
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
