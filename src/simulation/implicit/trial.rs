//! Forces at a trial displacement: the systems of a step up to its loads, run in the world, and nothing kept of it.

use super::super::ScheduledPass;
use super::axes::Axes;
use super::springs::Springs;
use crate::components::*;
use crate::error::Error;
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

    /// The forces F − R (N) at displacements (m), and with `steps` at velocities (as displacements of a step), kept in
    /// the columns of forces, and the springs that touch there.
    pub fn forces(&mut self, u: &[f64], steps: Option<&[f64]>, net: &mut [f64]) -> Result<bool, Error> {
        let sound = self.find((u, steps), SpringForces::Tried, net)?;
        self.springs.find(self.world, self.axes);
        Ok(sound)
    }

    /// The same without what touches, whose springs stay those of before.
    pub fn forces_without_springs(&mut self, u: &[f64], steps: Option<&[f64]>, net: &mut [f64]) -> Result<bool, Error> {
        self.find((u, steps), SpringForces::Omitted, net)
    }

    /// The same with what touches among the loads, which is noted.
    pub fn noted_forces(&mut self, u: &[f64], steps: Option<&[f64]>, net: &mut [f64]) -> Result<bool, Error> {
        self.find((u, steps), SpringForces::Noted, net)
    }

    fn find(
        &mut self,
        (u, steps): (&[f64], Option<&[f64]>),
        touching: SpringForces,
        net: &mut [f64],
    ) -> Result<bool, Error> {
        if let Some(springs) = &mut self.world.resource_mut::<Clock>().springs {
            springs.forces = touching;
        }
        self.count += 1;
        self.elsewhere = true;
        self.axes.displace(self.world, u);
        if let Some(steps) = steps {
            self.axes.write::<DisplacementIncrement>(self.world, steps, |column| &mut column.0);
        }
        if let Some(mut trial) = self.world.get_resource_mut::<TrialForces>() {
            trial.inverted = false;
        }
        match self.is_on_device() {
            true => self.forces_on_device(steps.is_some())?,
            false => self.run(|pass| pass.finds_forces)?,
        }
        self.net(net);
        Ok(!self.world.get_resource::<TrialForces>().is_some_and(|trial| trial.inverted))
    }

    /// F − R (N) as the columns have them.
    pub fn net(&self, net: &mut [f64]) {
        for (body, range) in self.axes.each() {
            let entity = self.world.entity(body);
            let Some(internal) = entity.get::<InternalForce>() else { continue };
            let net = &mut net[range];
            internal.read(net);
            match entity.get::<ExternalForce>().map(|external| &external.0) {
                Some(Reals::F32(external)) => net.iter_mut().zip(external).for_each(|(f, &r)| *f -= f64::from(r)),
                Some(Reals::F64(external)) => net.iter_mut().zip(external).for_each(|(f, &r)| *f -= r),
                None => {}
            }
        }
    }

    /// What the columns of forces and the springs come to.
    pub fn judge(&self, sound: bool, free: &[bool], held: &[bool], net: &[f64]) -> Tried {
        let mut tried = Tried { loads: self.springs.square(), ..Tried::default() };
        let mut all = 0.0;
        for (body, range) in self.axes.each() {
            let Some(external) = self.world.get::<ExternalForce>(body) else { continue };
            for i in (0..range.len()).filter(|i| free[range.start + i]) {
                tried.loads += external.get(i).powi(2);
            }
        }
        for (axis, force) in net.iter().enumerate() {
            all += force;
            if held[axis] {
                tried.reactions += force * force;
            }
        }
        tried.sound = sound && all.is_finite() && tried.loads.is_finite();
        tried
    }

    /// How far (in units of p) a difference of forces goes along p (m).
    pub fn reach(&self, p: &[f64]) -> f64 {
        let strain = match &self.axes.heights {
            Reals::F32(heights) => largest_share(p, heights),
            Reals::F64(heights) => largest_share(p, heights),
        };
        let precision = self.axes.bodies.first().and_then(|&body| self.world.get::<Displacement>(body));
        let of_precision = match precision.map(|u| u.precision()) {
            Some(Precision::F64) => STRAIN[1],
            _ => STRAIN[0],
        };
        if strain > 0.0 { of_precision / strain } else { 0.0 }
    }
}

/// The largest |p|/h of all axes. Eight maxima side by side: one alone waits for each comparison.
fn largest_share<T: Copy + Into<f64>>(p: &[f64], heights: &[T]) -> f64 {
    let (chunks, rest) = p.as_chunks::<8>();
    let (of_chunks, of_rest) = heights.as_chunks::<8>();
    let mut largest = [0.0_f64; 8];
    for (p, heights) in chunks.iter().zip(of_chunks) {
        for i in 0..8 {
            let share = p[i].abs() / heights[i].into();
            // what is no number is none that is larger
            largest[i] = if share > largest[i] { share } else { largest[i] };
        }
    }
    let last = rest.iter().zip(of_rest).map(|(p, &height)| p.abs() / height.into());
    largest.into_iter().chain(last).fold(0.0, f64::max)
}
