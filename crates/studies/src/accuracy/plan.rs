//! What a study will run: everything is predicted first, and what does not fit into the budget is left out by name.

use super::configuration::{Configuration, Digits, Processor};
use super::refinement;
use super::solver::{Choices, Cost, Refusal, Solver};
use serde::Serialize;
use std::time::Instant;

/// The share of the time that the meshes of a reference may take.
pub const REFERENCE_SHARE: f64 = 0.75;

/// What a configuration varies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Varied {
    /// Nothing: the scene as it is written.
    Nothing,
    /// Element and mesh.
    Mesh,
    /// The mesh, in the way that a reference is made, where that is not the scene's own.
    Refinement,
    /// The time step.
    Step,
    /// The number type.
    Digits,
    /// Hourglass control.
    Hourglass,
    /// How viscous history is carried on.
    Viscous,
    /// The elastic law.
    Law,
    /// Where it runs.
    Place,
    /// How it is stepped in time, or led to rest.
    Solver,
    /// Step and number type at once, so that space alone is left to err.
    SpaceAlone,
    /// An effect is switched off.
    Effect,
}

impl Varied {
    /// Whether it solves the same problem in another way, and may be ranked with the others; another law or an effect
    /// less is another problem.
    pub fn is_ranked(self) -> bool {
        !matches!(self, Varied::Law | Varied::Effect)
    }
}

/// What becomes of a configuration.
#[derive(Clone, Debug, PartialEq)]
pub enum Fate {
    /// It runs.
    Run(Cost),
    /// It does not fit into the budget.
    LeftOut(Cost),
    /// It cannot run.
    Refused(String),
}

/// A configuration of a plan.
#[derive(Clone, Debug)]
pub struct Planned {
    /// What it varies.
    pub varied: Varied,
    /// The configuration.
    pub configuration: Configuration,
    /// How it is called.
    pub label: String,
    /// What becomes of it.
    pub fate: Fate,
}

/// What a study will run.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The configurations, in the order in which they are shown.
    pub rows: Vec<Planned>,
    /// Those of them that a reference is made of, from the coarsest mesh on; none where it comes from elsewhere or
    /// nothing fits.
    pub reference: Vec<usize>,
    /// Why there is no reference, where one was to be made.
    pub no_reference: Option<String>,
    /// The order in which they run, by their places in `rows`: who ends a study early, or a budget that is spent before
    /// it was predicted to be, leaves the most telling ones done.
    pub order: Vec<usize>,
    /// What all that runs takes, and what was spent before, as predicted (s).
    pub predicted: f64,
    /// What it may take (s).
    pub budget: f64,
}

impl Planned {
    /// A configuration that is left out until there is time for it.
    pub(super) fn of(
        solver: &mut dyn Solver,
        varied: Varied,
        configuration: Configuration,
        base: &Configuration,
    ) -> Result<Self, Refusal> {
        let fate = match solver.predict(&configuration) {
            Ok(cost) => Fate::LeftOut(cost),
            Err(Refusal::Interrupted) => return Err(Refusal::Interrupted),
            Err(Refusal::TooLong) => Fate::Refused("there was no time to predict it".into()),
            Err(Refusal::Refused(why) | Refusal::Broke(why)) => Fate::Refused(why),
        };
        let label = configuration.label(base);
        Ok(Planned { varied, configuration, label, fate })
    }
}

/// Predicts everything and chooses what fits into `budget` (s), of which predictions and all else since `started` have
/// taken their part.
///
/// # Errors
/// That somebody wants the study to end.
pub fn plan(
    solver: &mut dyn Solver,
    choices: &Choices,
    (budget, started): (f64, Instant),
    make_reference: bool,
) -> Result<Plan, Refusal> {
    let mut rows = Vec::new();
    for (varied, configuration) in variations(choices) {
        rows.push(Planned::of(solver, varied, configuration, &choices.base)?);
    }
    if make_reference {
        refinement::add(solver, choices, &mut rows)?;
    }
    let predicted = started.elapsed().as_secs_f64();
    let mut plan = Plan { rows, reference: Vec::new(), no_reference: None, order: Vec::new(), predicted, budget };
    // the scene as it is written comes before everything else, unless it takes all there is
    let left = budget - predicted;
    let written = plan.rows.first().map_or(0.0, seconds);
    if make_reference {
        let left = if written <= left { left - written } else { left };
        match refinement::choose(choices, &plan.rows, REFERENCE_SHARE * left) {
            Ok(chosen) => plan.reference = chosen,
            Err(why) => plan.no_reference = Some(why),
        }
    }
    // single layers of cells are for a reference alone: what they say of a body with more layers is luck
    let single = |planned: &Planned| choices.single_layers.contains(&planned.configuration.mesh);
    let mut kept = Vec::new();
    for (place, planned) in std::mem::take(&mut plan.rows).into_iter().enumerate() {
        let member = plan.reference.iter_mut().find(|member| **member == place);
        if member.is_some() || !single(&planned) {
            member.into_iter().for_each(|member| *member = kept.len());
            kept.push(planned);
        }
    }
    plan.rows = kept;
    let mut order: Vec<usize> = (0..plan.rows.len()).collect();
    order.sort_by(|&a, &b| {
        let key = |place: usize| (plan.urgency(place), seconds(&plan.rows[place]));
        let ((a, cost_a), (b, cost_b)) = (key(a), key(b));
        a.cmp(&b).then(cost_a.total_cmp(&cost_b))
    });
    for &place in &order {
        let Fate::LeftOut(cost) = plan.rows[place].fate else { continue };
        if plan.predicted + cost.seconds <= budget {
            plan.predicted += cost.seconds;
            plan.rows[place].fate = Fate::Run(cost);
        }
    }
    plan.order = order;
    Ok(plan)
}

impl Plan {
    /// How many of `order` come before a finer mesh for the reference is thought of: the scene itself, what the
    /// reference is made of, the number type and the step.
    pub(super) fn basis(&self) -> usize {
        self.order.iter().take_while(|&&place| self.urgency(place) <= 2).count()
    }

    /// What is given a place in the budget first: the scene itself, then what the reference is made of, then the number
    /// type and the step, then what is about as cheap as the scene, then other meshes by cost.
    fn urgency(&self, place: usize) -> u8 {
        match self.rows[place].varied {
            Varied::Nothing => 0,
            _ if self.reference.contains(&place) => 1,
            Varied::Step | Varied::Digits => 2,
            Varied::Mesh | Varied::Refinement => 4,
            _ => 3,
        }
    }
}

fn seconds(planned: &Planned) -> f64 {
    match planned.fate {
        Fate::Run(cost) | Fate::LeftOut(cost) => cost.seconds,
        Fate::Refused(_) => 0.0,
    }
}

/// All configurations: element × mesh, and everything else one at a time.
fn variations(choices: &Choices) -> Vec<(Varied, Configuration)> {
    let base = &choices.base;
    let mut list = vec![(Varied::Nothing, base.clone())];
    let mut add = |varied: Varied, change: &dyn Fn(&mut Configuration)| {
        let mut configuration = base.clone();
        change(&mut configuration);
        if list.iter().all(|(_, known)| *known != configuration) {
            list.push((varied, configuration));
        }
    };
    let elements = match choices.elements.is_empty() {
        true => vec![base.element],
        false => choices.elements.iter().map(|kind| Some(*kind)).collect(),
    };
    for element in elements {
        for &mesh in &choices.meshes {
            add(Varied::Mesh, &|c| (c.element, c.mesh) = (element, mesh));
        }
    }
    for &step in &choices.steps {
        add(Varied::Step, &|c| c.step = step);
    }
    for &digits in &choices.digits {
        // GPUs compute in f32 only
        let place = if digits == Digits::Double { Processor::Cpu } else { base.place };
        add(Varied::Digits, &|c| (c.digits, c.place) = (digits, place));
    }
    choices.hourglass.iter().for_each(|scale| add(Varied::Hourglass, &|c| c.hourglass = *scale));
    choices.viscous.iter().for_each(|viscous| add(Varied::Viscous, &|c| c.viscous = Some(*viscous)));
    choices.laws.iter().for_each(|law| add(Varied::Law, &|c| c.law = Some(law.clone())));
    choices.places.iter().for_each(|place| add(Varied::Place, &|c| c.place = *place));
    for &method in &choices.methods {
        // those on a GPU have another balance of products and vectors
        let place = if method.is_implicit() { Processor::Cpu } else { base.place };
        add(Varied::Solver, &|c| (c.method, c.place) = (method, place));
    }
    if choices.digits.contains(&Digits::Double) {
        add(Varied::SpaceAlone, &|c| {
            (c.digits, c.step, c.place) = (Digits::Double, finest_step(choices), Processor::Cpu);
        });
    }
    choices.effects.iter().for_each(|effect| add(Varied::Effect, &|c| c.without = Some(effect.clone())));
    list
}

/// What the step is divided by where time must not err.
fn finest_step(choices: &Choices) -> u32 {
    choices.steps.iter().copied().max().unwrap_or(1)
}
