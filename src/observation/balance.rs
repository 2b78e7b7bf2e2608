//! The balance of energy: what elements hold beside the work that was done on them.

use super::guards::{GuardSettings, warn};
use super::rounding::Rounding;
use super::sample::{Sample, sample};
use crate::components::*;
use crate::error::Error;
use crate::scene::schema::Guard;
use bevy_ecs::prelude::*;

/// What makes steps shorter.
pub(super) fn shorter_steps(world: &World) -> &'static str {
    match world.resource::<Clock>().velocities_at_ends {
        false => "lower integration.safety",
        true => "lower `step` of the solver, or make its steps `adaptive`",
    }
}

/// Energy (J) that has come from nothing since the start (negative: gone), and what elements hold. Of viscous parts
/// only what remains in the long term is known to be held; the rest may have been lost, so nothing is said of energy
/// that went.
///
/// Energies are those of the middle of the last step, and its second half is not counted yet: of a mode of frequency ω
/// that is (ωΔt/2)² of its kinetic energy, never more than that where the step is stable. Where something begins to
/// move at once (a tool touches it, a weight is let go) this is all there is, and says nothing. So what is no more than
/// the kinetic energy counts once it has lasted [`GuardMemory::DOUBT`] steps, or at the end.
pub(super) fn balance(
    memory: &mut GuardMemory,
    seen: &Sample,
    settings: &GuardSettings,
    last: bool,
    world: &World,
) -> (f64, f64) {
    see_scale(memory, seen, world);
    let Held { lasting: held, viscous, .. } = held_by(seen, world);
    if settings.limits.off.contains(&Guard::Energy) {
        return (0.0, held);
    }
    let made = held - seen.internal_work - memory.at_start;
    let made = if viscous || settings.removal { made.max(0.0) } else { made };
    let limit = settings.limits.energy.warn;
    // what rounding alone may have made of it is no imbalance
    let share = made.signum() * (made.abs() - memory.rounding).max(0.0) / memory.scale;
    let step = world.resource::<Clock>().step;
    let at_middle = world.resource::<Clock>().back_to_middle() > 0.0;
    let explained = at_middle && memory.scale > 0.0 && share > limit && made <= seen.kinetic;
    let since = memory.in_doubt.take().filter(|_| explained).unwrap_or(step);
    if explained && !last && step < since + GuardMemory::DOUBT {
        memory.in_doubt = Some(since);
        return (0.0, held);
    }
    if memory.scale > 0.0 && share.abs() > memory.imbalance.abs() {
        memory.imbalance = share;
    }
    if memory.scale > 0.0 && share.abs() > limit {
        let way = if made > 0.0 { "came from nothing" } else { "went into nothing" };
        let message = format!(
            "{:.1} % of the largest energy so far {way} ({:.1} % are a warning, {}): results are that uncertain; {}, \
             use ramps, or a finer mesh",
            100.0 * share.abs(),
            100.0 * limit,
            settings.limit_of_energy("warn"),
            shorter_steps(world)
        );
        warn(memory, world, "energy", "", share, limit, message);
    }
    (made, held)
}

/// Notes the largest energy so far.
pub(super) fn see_scale(memory: &mut GuardMemory, seen: &Sample, world: &World) {
    memory.scale = memory.scale.max(held_by(seen, world).all).max(seen.internal_work.abs());
}

/// What is held (J).
struct Held {
    /// By elements, and of viscous ones what remains in the long term.
    lasting: f64,
    /// By elements and by motion, that of free tools too.
    all: f64,
    /// Whether a part is viscous.
    viscous: bool,
}

fn held_by(seen: &Sample, world: &World) -> Held {
    let all = seen.kinetic + super::free_tools::kinetic(world);
    let mut held = Held { lasting: 0.0, all, viscous: false };
    for (entity, sums) in &seen.parts {
        let share = |terms: &[(f64, f64)]| terms.iter().map(|(alpha, _)| alpha).sum::<f64>();
        let relaxed = |prony: &Prony| share(&prony.terms).max(share(&prony.volumetric));
        let of_all = world.get::<Block>(*entity).and_then(|block| world.get::<Prony>(block.material));
        // of copies that differ, at least
        let relaxed = match world.get::<PerCopyMemory>(*entity) {
            None => of_all.map_or(0.0, relaxed),
            Some(PerCopyMemory(all)) => all.iter().filter_map(|of| of.prony.as_ref()).map(relaxed).fold(0.0, f64::max),
        };
        let damped = world
            .get::<Block>(*entity)
            .is_some_and(|block| world.entity(block.material).contains::<StiffnessDamping>());
        held.viscous |= relaxed > 0.0 || damped;
        held.lasting += (1.0 - relaxed) * sums.strain + sums.hourglass;
        held.all += sums.strain + sums.hourglass;
    }
    held
}

/// What elements hold as the balance of energy counts it (J), of viscous ones what remains in the long term, where
/// velocities are: in the middle of the last step, of implicit ones at its end.
///
/// # Errors
/// What the GPU says.
pub fn held_for_long(world: &mut World) -> Result<f64, Error> {
    let seen = sample(world)?;
    Ok(held_by(&seen, world).lasting)
}

/// Notes what bodies hold before the first step, from which on imbalances count.
///
/// # Errors
/// What the GPU says.
pub fn begin(world: &mut World) -> Result<(), Error> {
    let seen = sample(world)?;
    let held = held_by(&seen, world);
    let rounding = Rounding::of(world);
    let mut memory = world.get_resource_or_init::<GuardMemory>();
    (memory.at_start, memory.scale) = (held.lasting, held.all);
    memory.rounding = rounding.of_energy(&seen.reach);
    world.insert_resource(rounding);
    Ok(())
}

/// Warns of contact that gives back more energy than it took (J): what has sunk in is pushed out, and what touches and
/// lets go again and again may get more back from springs than it gave.
pub(super) fn gives_back(memory: &mut GuardMemory, made: f64, settings: &GuardSettings, world: &World) {
    let limit = settings.limits.energy.warn;
    // a free tool that something holds has hardly any energy, and what holds it is not exact
    let made = made - super::free_tools::given_by_weight(world, limit);
    let share = (made - memory.rounding) / memory.scale;
    if settings.limits.off.contains(&Guard::Energy) || memory.scale <= 0.0 || share.is_nan() || share <= limit {
        return;
    }
    // tools have no sweeps
    let mut surfaces = world.try_query::<&SurfaceTouch>();
    let among_bodies = surfaces.as_mut().is_some_and(|touches| touches.iter(world).next().is_some());
    let ((gave, than), way_out) = match (settings.springs, settings.implicit) {
        (false, _) if !among_bodies => (
            ("contact gave back", "than it took"),
            "points that began inside or have sunk in are pushed out; a lower integration.safety or finer faces let less \
             sink in",
        ),
        (false, _) => (
            ("contact gave back", "than it took"),
            "points that began inside or have sunk in are pushed out; a lower integration.safety, more `sweeps` of the \
             contact or finer faces let less sink in",
        ),
        (true, false) => (
            ("springs of contact gave back", "than they got"),
            "what begins inside is pushed out, or something rattles; a smaller `share`, `damping` of the law, a smaller \
             integration.safety, or `law: Kinematic`, which makes none from outside",
        ),
        (true, true) => (
            ("springs of contact gave back", "than they got"),
            "what begins inside is pushed out, or a step brought it in before anybody looked; lower `step` of the solver, \
             or make its steps `adaptive`",
        ),
    };
    let message = format!(
        "{gave} {:.1} % of the largest energy so far more {than} ({:.1} % are a warning, {}): {way_out}",
        100.0 * share,
        100.0 * limit,
        settings.limit_of_energy("warn")
    );
    warn(memory, world, "contact", "", share, limit, message);
}

/// Of what implicit steps turn over the share that their formula may make: what rubs or is damped turns over many times
/// what is held, and each step of it is known to some share. Steps that are found make .2 to 3 % of it (a block that
/// slides, bars that are dragged), steps of an egg on a block whose friction is not found 24 to 67 %.
const OF_TURNOVER: f64 = 0.1;

/// Warns of implicit steps whose formula has made energy, and gives the most that this has been as a share of the
/// largest energy so far; 0 where it is not worth a warning. What it makes is an imbalance, and stays one where a later
/// step takes it.
pub(super) fn made_by_formula(memory: &mut GuardMemory, settings: &GuardSettings, world: &World) -> f64 {
    let limit = settings.limits.energy.warn;
    let made = -memory.least_scheme_loss - memory.rounding;
    let share = made / memory.scale;
    if settings.limits.off.contains(&Guard::Energy) || memory.scale <= 0.0 || share.is_nan() || share <= limit {
        return 0.0;
    }
    if made <= OF_TURNOVER * memory.turned_over {
        return 0.0;
    }
    if share > memory.imbalance.abs() {
        memory.imbalance = share;
    }
    let message = format!(
        "the formula of implicit steps has made {:.1} % of the largest energy so far ({:.1} % are a warning, {}), and did \
         not take any: results are that uncertain; {}, or let less stick and slide by turns (a smaller `share` of \
         springs of contact, less `friction`)",
        100.0 * share,
        100.0 * limit,
        settings.limit_of_energy("warn"),
        shorter_steps(world)
    );
    warn(memory, world, "scheme_loss", "", share, limit, message);
    share
}

/// How much stiffer springs of contact become before it is told.
const STIFFER: f64 = 1.25;

/// Warns of springs of contact that have become stiffer: their stiffness goes with the square of the step, which other
/// bodies may shorten.
pub(super) fn stiffened(memory: &mut GuardMemory, settings: &GuardSettings, world: &World) {
    let step = world.resource::<Clock>().time_step;
    memory.longest_step = memory.longest_step.max(step);
    let stiffer = (memory.longest_step / step).powi(2);
    if settings.implicit || stiffer.is_nan() || stiffer <= STIFFER {
        return;
    }
    let message = format!(
        "springs of contact are {stiffer:.1} times as stiff as they were: the step has become {step:.3e} s, from {:.3e} s, \
         and what they bear sinks in less; keep both by `integration: (step: {step:.1e})`, or use `law: Kinematic`, \
         which has no stiffness",
        memory.longest_step
    );
    warn(memory, world, "contact_stiffness", "", stiffer, STIFFER, message);
}
