//! Forces at a trial displacement: the systems of a step up to its loads, run in the world, and nothing kept of it.

use super::super::ScheduledPass;
use super::axes::{Axes, Motion};
use super::place::Place;
use super::springs::Springs;
use super::vectors::{copy_to, with_numbers};
use crate::components::*;
use crate::error::Error;
use crate::math::Scalar;
use crate::systems::Phase;
use bevy_ecs::prelude::*;

/// How far products displace elements, as a share of their height at each node, in f32 and in f64: so that neither the
/// curvature of laws nor rounding counts.
pub(super) const STRAIN: [f64; 2] = [1e-3, 1e-7];

/// The forces of a step, tried.
pub(super) struct Trial<'a> {
    pub world: &'a mut World,
    pub passes: &'a mut [ScheduledPass],
    pub axes: &'a Axes,
    /// The springs that touched where forces were tried last, which the columns of forces do not have.
    pub springs: &'a mut Springs,
    /// The step.
    pub step: u64,
    /// How often forces were taken.
    pub count: u64,
    /// Whether the columns of forces may be those of a difference.
    pub elsewhere: bool,
}

/// What came of a trial.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Tried {
    /// Whether no element is turned inside out that must not be, and all forces are numbers.
    pub sound: bool,
    /// ‖R‖² over free axes (N²).
    pub loads: f64,
    /// ‖F − R‖² over held axes (N²).
    pub reactions: f64,
}

impl Trial<'_> {
    /// Runs some passes.
    fn run(&mut self, which: impl Fn(&ScheduledPass) -> bool) -> Result<(), Error> {
        for pass in self.passes.iter_mut().filter(|pass| which(pass)) {
            pass.run_on_host(self.step, self.world)?;
        }
        Ok(())
    }

    /// Says where held axes go.
    pub fn boundary(&mut self) -> Result<(), Error> {
        match self.is_on_device() {
            true => self.boundary_on_device(),
            false => self.run(|pass| pass.phase == Phase::Boundary && !pass.finds_forces),
        }
    }

    /// Whether loads look at the step that nodes take: at rest springs alone do, for their friction.
    pub fn looks_at_steps(&self) -> bool {
        let clock = self.world.resource::<Clock>();
        if clock.relaxation.is_some() {
            return clock.springs.is_some();
        }
        let name = DisplacementIncrement::NAME;
        let forces = self.passes.iter().filter(|pass| pass.finds_forces);
        forces.into_iter().any(|pass| pass.reads(name))
    }

    /// The forces F − R (N) at a place, and where loads look at them at its velocities, kept in the columns of forces,
    /// and the springs that touch there.
    pub fn forces(&mut self, place: &Place<'_>, net: &mut Reals) -> Result<bool, Error> {
        let sound = self.find(Some(place), SpringForces::Tried, net)?;
        self.springs.find(self.world, self.axes);
        Ok(sound)
    }

    /// The same where nodes are.
    pub fn present_forces(&mut self, net: &mut Reals) -> Result<bool, Error> {
        let sound = self.find(None, SpringForces::Tried, net)?;
        self.springs.find(self.world, self.axes);
        Ok(sound)
    }

    /// The same at a place without what touches, whose springs stay those of before.
    pub fn forces_without_springs(&mut self, place: &Place<'_>, net: &mut Reals) -> Result<bool, Error> {
        self.find(Some(place), SpringForces::Omitted, net)
    }

    /// The same with what touches among the loads, which is noted.
    pub fn noted_forces(&mut self, place: &Place<'_>, net: &mut Reals) -> Result<bool, Error> {
        self.find(Some(place), SpringForces::Noted, net)
    }

    fn find(&mut self, place: Option<&Place<'_>>, touching: SpringForces, net: &mut Reals) -> Result<bool, Error> {
        if let Some(springs) = &mut self.world.resource_mut::<Clock>().springs {
            springs.forces = touching;
        }
        self.count += 1;
        self.elsewhere = true;
        let with_velocities = place.is_some() && self.looks_at_steps();
        if let Some(place) = place {
            place.displace(self.axes, self.world);
            if with_velocities {
                place.write_steps(self.axes, self.world);
            }
        }
        if let Some(mut trial) = self.world.get_resource_mut::<TrialForces>() {
            trial.inverted = false;
        }
        match self.is_on_device() {
            true => self.forces_on_device(with_velocities)?,
            false => self.run(|pass| pass.finds_forces)?,
        }
        self.net(net);
        Ok(!self.world.get_resource::<TrialForces>().is_some_and(|trial| trial.inverted))
    }

    /// F − R (N) as the columns have them.
    pub fn net(&self, net: &mut Reals) {
        for (body, range) in self.axes.each() {
            let entity = self.world.entity(body);
            let Some(internal) = entity.get::<InternalForce>() else { continue };
            copy_to(net, range.start, internal);
            let Some(external) = entity.get::<ExternalForce>() else { continue };
            with_numbers!(net, T => {
                let net = &mut net.slice_mut::<T>()[range];
                net.iter_mut().zip(external.slice::<T>()).for_each(|(f, &r)| *f -= r);
            });
        }
    }

    /// What the columns of forces and the springs come to.
    pub fn judge(&self, sound: bool, motion: &Motion, net: &Reals) -> Tried {
        let mut tried = Tried { loads: self.springs.square(), ..Tried::default() };
        let mut all = 0.0;
        for (body, range) in self.axes.each() {
            let Some(external) = self.world.get::<ExternalForce>(body) else { continue };
            for i in (0..range.len()).filter(|i| motion.free[range.start + i]) {
                tried.loads += external.get(i).powi(2);
            }
        }
        for axis in 0..net.len() {
            let force = net.get(axis);
            all += force;
            if motion.is_held(axis) {
                tried.reactions += force * force;
            }
        }
        tried.sound = sound && all.is_finite() && tried.loads.is_finite();
        tried
    }

    /// How far (in units of p) a difference of forces goes along p (m).
    pub fn reach(&self, p: &Reals) -> f64 {
        let heights = &self.axes.heights;
        let strain = with_numbers!(p, T => largest_share(p.slice::<T>(), heights.slice::<T>()));
        let of_precision = match self.axes.precision() {
            Precision::F64 => STRAIN[1],
            Precision::F32 => STRAIN[0],
        };
        if strain > 0.0 { of_precision / strain } else { 0.0 }
    }
}

/// The largest |p|/h of all axes, h that of their nodes. Eight maxima side by side: one alone waits for comparisons.
fn largest_share<T: Scalar>(p: &[T], heights: &[T]) -> f64 {
    let share = |p: &[T; 3], height: T| {
        let along = |largest: f64, p: &T| if p.to_f64().abs() > largest { p.to_f64().abs() } else { largest };
        p.iter().fold(0.0, along) / height.to_f64()
    };
    let larger = |largest: f64, share: f64| if share > largest { share } else { largest };
    let nodes = p.as_chunks::<3>().0;
    let ((chunks, rest), (of_chunks, of_rest)) = (nodes.as_chunks::<8>(), heights.as_chunks::<8>());
    let mut largest = [0.0_f64; 8];
    for (p, heights) in chunks.iter().zip(of_chunks) {
        for i in 0..8 {
            // what is no number is none that is larger
            largest[i] = larger(largest[i], share(&p[i], heights[i]));
        }
    }
    let last = rest.iter().zip(of_rest).map(|(p, &height)| share(p, height));
    largest.into_iter().chain(last).fold(0.0, larger)
}
