//! What implicit steps and Newton's iterations to equilibrium are made of, for `explain`.

use super::super::ScheduledPass;
use super::super::explain::SolverInUse;
use super::axes::{Axes, Motion};
use super::kept::Kept;
use super::newton::{Settings, Workspace};
use super::preconditioner::{Operator, Preconditioner};
use super::trial::is_of_forces;
use crate::components::Clock;
use bevy_ecs::prelude::*;

/// What solves, taken apart.
pub(super) struct Parts<'a> {
    pub settings: &'a Settings,
    pub axes: &'a Axes,
    pub motion: &'a mut Motion,
    pub space: &'a mut Workspace,
    pub preconditioner: &'a mut dyn Preconditioner,
    pub kept: &'a mut Kept,
}

impl Parts<'_> {
    /// What it does in words after `first`, and what it holds at the present state. The first step begins with the same.
    pub fn in_use(self, first: String, world: &mut World, passes: &[ScheduledPass]) -> SolverInUse {
        let h = world.resource::<Clock>().time_step;
        let Self { settings, axes, motion, space, preconditioner, kept } = self;
        axes.read(world, motion);
        kept.keep(world);
        let formula = &settings.formula;
        for axis in 0..axes.len() {
            let is_free = motion.free[axis];
            space.inertia[axis] =
                if is_free { formula.inertia(h, motion.mass[axis], motion.damping[axis]) } else { 0.0 };
        }
        preconditioner.follow(&Operator {
            world,
            bodies: &axes.bodies,
            free: &motion.free,
            inertia: &space.inertia,
            stiffness: formula.stiffness(),
        });
        let (made_of, mut held) = preconditioner.holds();
        let forces = passes.iter().filter(|pass| is_of_forces(pass.phase)).map(|pass| pass.name.as_str());
        let forces: Vec<&str> = forces.collect();
        let mut of = vec![
            first,
            format!(
                "a pass is {}, at trial displacements: one for each residual and for each product",
                forces.join(", ")
            ),
            format!("conjugate gradients are preconditioned with {made_of}"),
        ];
        if let Some(budget) = settings.budget {
            of.push(format!("at most {budget} passes a step, and two more"));
        }
        held.push(("vectors over all axes", (axes.bytes() + motion.bytes() + space.bytes()) as u64));
        held.push(("columns as they were before a step", kept.bytes() as u64));
        SolverInUse { of, held }
    }
}
