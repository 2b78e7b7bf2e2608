//! What a study will run: everything is predicted first, and what does not fit into the budget is left out by name.

use super::configuration::{Configuration, Digits, Factor, Place};
use super::solver::{Choices, Cost, Refusal, Solver};
use serde::Serialize;
use std::cmp::Reverse;

/// The share of the budget that the configurations themselves may claim before the reference takes the rest.
const ROWS_SHARE: f64 = 0.4;

/// What a configuration varies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Varied {
    /// Nothing: the scene as it is written.
    Nothing,
    /// Element and mesh.
    Mesh,
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
    /// Step and number type at once, so that space alone is left to err.
    SpaceAlone,
    /// An effect is switched off.
    Effect,
}

impl Varied {
    /// Whether it solves the same problem in another way, and may be ranked with the others; another law or an effect less
    /// is another problem.
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
    /// Three meshes, ascending, that a reference is made of; none where it comes from elsewhere or does not fit.
    pub reference: Vec<Planned>,
    /// Why there is no reference, where one was to be made.
    pub no_reference: Option<String>,
    /// The configurations, in the order in which they are shown.
    pub rows: Vec<Planned>,
    /// The order in which they run, by their places in `rows`: who ends a study early, or a budget that is spent before it was
    /// predicted to be, leaves the most telling ones done.
    pub order: Vec<usize>,
    /// What all that runs takes, as predicted (s).
    pub predicted: f64,
    /// What it may take (s).
    pub budget: f64,
}

/// Predicts everything and chooses what fits into `budget` (s).
///
/// # Errors
/// That somebody wants the study to end.
pub fn plan(solver: &mut dyn Solver, choices: &Choices, budget: f64, make_reference: bool) -> Result<Plan, Refusal> {
    let mut rows = Vec::new();
    for (varied, configuration) in variations(choices) {
        let fate = match solver.predict(&configuration) {
            Ok(cost) => Fate::LeftOut(cost),
            Err(Refusal::Interrupted) => return Err(Refusal::Interrupted),
            Err(Refusal::Refused(why) | Refusal::Broke(why)) => Fate::Refused(why),
        };
        let label = configuration.label(&choices.base);
        rows.push(Planned { varied, configuration, label, fate });
    }
    let modest: f64 = rows.iter().filter(|row| row.configuration.mesh <= Factor::ONE).map(seconds).sum();
    let mut plan = Plan { reference: Vec::new(), no_reference: None, rows, order: Vec::new(), predicted: 0.0, budget };
    if make_reference {
        reference(solver, choices, &mut plan, budget - modest.min(ROWS_SHARE * budget))?;
    }
    plan.predicted = plan.reference.iter().map(seconds).sum();
    let mut order: Vec<usize> = (0..plan.rows.len()).collect();
    order.sort_by(|&a, &b| {
        let key = |row: &Planned| (urgency(row.varied), seconds(row));
        let ((a, cost_a), (b, cost_b)) = (key(&plan.rows[a]), key(&plan.rows[b]));
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

/// What is given a place in the budget first: the scene itself, then what is about as cheap, then other meshes by cost.
fn urgency(varied: Varied) -> u8 {
    match varied {
        Varied::Nothing => 0,
        Varied::Mesh => 2,
        _ => 1,
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
        for mesh in rows_of_meshes(&choices.meshes) {
            add(Varied::Mesh, &|c| (c.element, c.mesh) = (element, mesh));
        }
    }
    for &step in &choices.steps {
        add(Varied::Step, &|c| c.step = step);
    }
    for &digits in &choices.digits {
        // GPUs compute in f32 only
        let place = if digits == Digits::Double { Place::Cpu } else { base.place };
        add(Varied::Digits, &|c| (c.digits, c.place) = (digits, place));
    }
    choices.hourglass.iter().for_each(|scale| add(Varied::Hourglass, &|c| c.hourglass = *scale));
    choices.viscous.iter().for_each(|viscous| add(Varied::Viscous, &|c| c.viscous = Some(*viscous)));
    choices.laws.iter().for_each(|law| add(Varied::Law, &|c| c.law = Some(law.clone())));
    choices.places.iter().for_each(|place| add(Varied::Place, &|c| c.place = *place));
    if choices.digits.contains(&Digits::Double) {
        add(Varied::SpaceAlone, &|c| {
            (c.digits, c.step, c.place) = (Digits::Double, finest_step(choices), Place::Cpu);
        });
    }
    choices.effects.iter().for_each(|effect| add(Varied::Effect, &|c| c.without = Some(effect.clone())));
    list
}

/// The meshes of rows: halved and doubled ones, whose nodes meet; where the scene's cells cannot be halved, a third.
fn rows_of_meshes(all: &[Factor]) -> Vec<Factor> {
    let halves = |factor: &&Factor| factor.up.is_power_of_two() && factor.down.is_power_of_two();
    let mut rows: Vec<Factor> = all.iter().filter(halves).copied().collect();
    if !rows.iter().any(|&factor| factor < Factor::ONE) {
        rows.extend(all.iter().filter(|&&factor| factor == Factor::new(1, 3)));
    }
    rows.sort();
    rows
}

/// Whether each mesh's nodes are nodes of the next.
pub fn nested(meshes: [Factor; 3]) -> bool {
    let [a, b, c] = meshes;
    let whole = |coarse: Factor, fine: Factor| (fine.up * coarse.down).is_multiple_of(fine.down * coarse.up);
    whole(a, b) && whole(b, c)
}

/// Chooses three meshes of the best element, f64, a quarter of the step: those whose finest is finest, as far as they fit
/// into `share` (s).
fn reference(solver: &mut dyn Solver, choices: &Choices, plan: &mut Plan, share: f64) -> Result<(), Refusal> {
    let mut candidates = triples(&choices.meshes);
    // coarse ones follow no power of the cell size yet
    candidates.sort_by_key(|&[a, b, c]| (Reverse(c), !nested([a, b, c]), Reverse(b), Reverse(a)));
    let (mut least, mut why) = (f64::INFINITY, "the meshes of the scene come in fewer than three sizes".to_string());
    for meshes in candidates {
        let mut three = Vec::new();
        for mesh in meshes {
            let configuration = best(choices, mesh);
            match solver.predict(&configuration) {
                Ok(cost) => {
                    let label = format!("reference, mesh {mesh}");
                    three.push(Planned { varied: Varied::Nothing, configuration, label, fate: Fate::Run(cost) });
                }
                Err(Refusal::Interrupted) => return Err(Refusal::Interrupted),
                Err(Refusal::Refused(reason) | Refusal::Broke(reason)) => why = reason,
            }
        }
        let cost: f64 = three.iter().map(seconds).sum();
        if three.len() == 3 && cost <= share {
            plan.reference = three;
            return Ok(());
        }
        if three.len() == 3 && cost < least {
            least = cost;
        }
    }
    if least.is_finite() {
        let budget = (least / (1.0 - ROWS_SHARE)).ceil();
        why = format!("the smallest one takes {least:.1} s; --budget {budget} would do");
    }
    plan.no_reference = Some(why);
    Ok(())
}

/// What the step is divided by where time must not err.
fn finest_step(choices: &Choices) -> u32 {
    choices.steps.iter().copied().max().unwrap_or(1)
}

/// The most accurate way there is to solve the scene on a mesh.
fn best(choices: &Choices, mesh: Factor) -> Configuration {
    let element = choices.elements.last().copied().or(choices.base.element);
    let viscous = choices.viscous.first().copied().or(choices.base.viscous);
    let (step, digits, place) = (finest_step(choices), Digits::Double, Place::Cpu);
    Configuration { element, mesh, step, digits, viscous, place, ..choices.base.clone() }
}

/// All sets of three meshes that lie far enough apart.
fn triples(meshes: &[Factor]) -> Vec<[Factor; 3]> {
    let apart = |a: Factor, b: Factor| b.value() > 1.2 * a.value();
    let mut found = Vec::new();
    for &a in meshes {
        for &b in meshes.iter().filter(|&&b| apart(a, b)) {
            found.extend(meshes.iter().filter(|&&c| apart(b, c)).map(|&c| [a, b, c]));
        }
    }
    found
}
