//! What Newton's iterations go on from, in implicit steps and to equilibrium alike: what is the same from one solve to
//! the next.

use super::super::ScheduledPass;
use super::super::explain::SolverInUse;
use super::axes::{Axes, Motion};
use super::device::{OnDevice, in_words};
use super::free_motions::Unresisted;
use super::kept::Kept;
use super::newton::{Found, Newton, Settings, Workspace};
use super::place::Place;
use super::preconditioner::{Operator, Preconditioner, of_name};
use super::report::ImplicitSteps;
use super::step_control::{StepControl, error_and_reach};
use super::sums::Sums;
use super::trial::Trial;
use crate::backend::cpu::Cpu;
use crate::components::Clock;
use crate::scene::schema;
use bevy_ecs::prelude::*;

/// The passes of a step, and how many dispatches its forces are on a GPU where that is asked about.
pub(in crate::simulation) type OfForces<'a> = (&'a [ScheduledPass], Option<usize>);

/// Everything of a solver but its axes, which trials look at meanwhile.
pub(super) struct Iterations {
    pub settings: Settings,
    pub preconditioner: Box<dyn Preconditioner>,
    pub motion: Motion,
    pub space: Workspace,
    pub kept: Kept,
    pub sums: Sums,
    pub report: ImplicitSteps,
    /// Passes of the step that is sought so far, those that were taken back with them.
    passes: u64,
    /// What solves on a device, once it has.
    pub on_device: Option<OnDevice>,
}

impl Iterations {
    /// None taken yet.
    pub fn new(settings: Settings, preconditioner: schema::Preconditioner, axes: &Axes, world: &World) -> Self {
        Self {
            settings,
            preconditioner: of_name(preconditioner, axes.precision()),
            motion: axes.motion(),
            space: Workspace::of(axes),
            kept: Kept::new(axes.precision()),
            sums: Sums::on(world.resource::<Cpu>()),
            report: ImplicitSteps::default(),
            passes: 0,
            on_device: None,
        }
    }

    /// Those of a solve, in a step of a length (s).
    pub fn newton<'a, 'w>(&'a mut self, trial: Trial<'w>, h: f64) -> Newton<'a, 'w> {
        Newton {
            trial,
            settings: self.settings,
            motion: &self.motion,
            before: &self.kept.forces,
            space: &mut self.space,
            preconditioner: &mut *self.preconditioner,
            report: &mut self.report,
            sums: &self.sums,
            on_device: &mut self.on_device,
            h,
            beyond: false,
            farthest: None,
            unresisted: Unresisted::default(),
        }
    }

    /// Notes how often a solve took forces.
    pub fn count(&mut self, passes: u64) {
        self.report.passes += passes;
        self.passes += passes;
    }

    /// Where axes are at the end of a step of h (s).
    pub fn place(&self, h: f64) -> Place<'_> {
        let Self { settings, motion, space, .. } = self;
        Place { formula: &settings.formula, h, motion, correction: &space.correction, beyond: None }
    }

    /// Whether the end of a step of h is taken, by what chooses steps.
    pub fn takes(
        &self,
        control: Option<&mut StepControl>,
        h: f64,
        found: &Found,
        (axes, world): (&Axes, &World),
    ) -> bool {
        let Settings { formula, newton, budget, .. } = &self.settings;
        let Some(control) = control else { return true };
        let is_stuck = *newton > 1 && budget.is_none() && !found.solved;
        if is_stuck && control.cut_back(h) {
            return false;
        }
        let [error, reach] = error_and_reach(&self.place(h), axes, world);
        control.takes(h, error, reach, formula.order())
    }

    /// Notes that a step is taken back; what was told before it stands of residuals.
    pub fn take_back(&mut self, told: &ImplicitSteps) {
        let ImplicitSteps { unsolved, largest_residual_left, .. } = *told;
        let steps_rejected = self.report.steps_rejected + 1;
        self.report = ImplicitSteps { unsolved, largest_residual_left, steps_rejected, ..self.report };
    }

    /// Notes the end of a step.
    pub fn end_step(&mut self) {
        self.report.steps += 1;
        self.report.most_passes = self.report.most_passes.max(std::mem::take(&mut self.passes));
    }

    /// What was taken so far.
    pub fn report(&self) -> ImplicitSteps {
        let held = self.preconditioner.holds().1;
        ImplicitSteps { preconditioner_bytes: held.iter().map(|(_, bytes)| bytes).sum(), ..self.report }
    }

    /// What it does in words after `first`, and what it holds at the present state, for `explain`. The first step
    /// begins with the same.
    pub fn in_use(&mut self, first: String, axes: &Axes, world: &mut World, passes: OfForces<'_>) -> SolverInUse {
        let (passes, on_gpu) = passes;
        let h = world.resource::<Clock>().time_step;
        let Self { settings, motion, space, preconditioner, kept, .. } = self;
        axes.read(world, motion);
        kept.keep(world, axes);
        let formula = &settings.formula;
        preconditioner.follow(&Operator {
            world,
            bodies: &axes.bodies,
            free: &motion.free,
            inertia: motion.inertia(formula, h),
            stiffness: formula.stiffness(),
            springs: &[],
        });
        let (made_of, mut held) = preconditioner.holds();
        let forces = passes.iter().filter(|pass| pass.finds_forces).map(|pass| pass.name.as_str());
        let forces: Vec<&str> = forces.collect();
        let mut of = vec![
            first,
            format!(
                "a pass is {}, at trial displacements: one for each residual and for each product",
                forces.join(", ")
            ),
            format!("conjugate gradients are preconditioned with {made_of}"),
        ];
        if let Some(kernels) = on_gpu {
            of.push(in_words(axes, !preconditioner.coarse().is_empty(), kernels));
        }
        if let Some(budget) = settings.budget {
            of.push(format!("at most {budget} passes a step, and two more"));
        }
        held.push(("vectors over all axes", (axes.bytes() + motion.bytes() + space.bytes()) as u64));
        held.push(("columns as they were before a step", kept.bytes() as u64));
        SolverInUse { of, held }
    }
}
