//! Guards: what kernels found wrong in passing, and what a sample of energies and elements shows, told in the author's
//! words.

use super::balance::{balance, gives_back, made_by_formula, see_scale, shorter_steps, stiffened};
use super::rounding::Rounding;
use super::sample::{Sample, sample, sample_result};
use crate::backend::cpu::BlockSums;
use crate::backend::device::bring_to_host;
use crate::components::*;
use crate::elements::point_count;
use crate::error::{Criterion, Error, Instability};
use crate::scene::schema::{Guard, Guards, Inversion};
use bevy_ecs::prelude::*;

/// What leads to a breakdown when the scene insists on a step beyond the stable one.
const STEP_TOO_LARGE: &str = "a time step beyond the stable one (leave `step` out to have it found)";
/// Why energy may come from contact, where something began inside of something else.
const INSIDE: &str = "nodes that were inside tools or other bodies at the start, and were pushed out (begin apart, or with a \
     finer mesh: see the warnings of `sinew check`)";
const JUMP: &str = "a prescribed motion that jumps (use a ramp: `curve: Smooth(end: ...)` or `Ramp(end: ...)`)";
const INVERTED: &str = "a load or motion too large or too sudden for the mesh (use a ramp, a finer mesh, or say by `inversion` of the \
                        material what becomes of such elements), or a time step that is too large (lower integration.safety)";
const OVERFLOW: &str = "a motion, load or modulus beyond what numbers can express, or a time step that is too large (lower \
                        integration.safety)";
const MADE_BY_CONTACT: &str = "an error of the engine, which is worth a report with the scene";
/// Parts that hold less than this share of all energy are not asked for their hourglass energy.
const WORTH_CHECKING: f64 = 1e-3;
/// Shares of hourglass energy are told up to the first in words, and up to the second as numbers: elastic energy may be
/// next to none.
const MOST_TOLD: f64 = 10.0;
const MOST_SHARE: f64 = 1e6;

/// How a scene wants to be guarded.
#[derive(Clone, Debug, Default)]
pub struct GuardSettings {
    /// Its limits.
    pub limits: Guards,
    /// Whether it insists on a step beyond the stable one.
    pub beyond: bool,
    /// Whether systems of the scene's own write more than external forces: energy is theirs to make, and only warned
    /// of.
    pub foreign: bool,
    /// Whether elements may go and take energy with them: what is lost then is no error.
    pub removal: bool,
    /// Whether something may touch something in a motion, and give energy back.
    pub contacts: bool,
    /// Whether springs of contact act as loads, and may make energy.
    pub springs: bool,
    /// Whether steps are implicit: limits of energy are ten times those that the scene has.
    pub implicit: bool,
    /// Whether these are solved, and not as far as one iteration or a budget leads: energy that their formula makes
    /// ends the run then.
    pub solved: bool,
}

impl GuardSettings {
    /// Where a limit of energy, `warn` or `stop`, stands in the scene.
    pub(super) fn limit_of_energy(&self, name: &str) -> String {
        let of_scene = format!("guards.energy.{name}");
        if self.implicit { format!("ten times {of_scene}, for steps are implicit") } else { of_scene }
    }
}

/// What broke down, if something did: the first displacement that is not finite, or element that is turned inside out.
pub(super) fn find(world: &mut World, good_until: f64, settings: &GuardSettings) -> Result<Option<Instability>, Error> {
    bring_to_host(world, |_, name| name == FirstInverted::NAME || name == FirstNonFinite::NAME)?;
    let mut found: Option<(Entity, String, &str, Criterion)> = None;
    for (body, authoring, node) in world.query::<(Entity, &Authoring, &FirstNonFinite)>().iter(world) {
        if node[0] != u32::MAX {
            let node = authoring.node_id(node[0] as usize);
            let what = format!("the displacement of node {node} is not finite");
            let cause = "a load that is too sudden (use a ramp), a wrong modulus, a system of one's own that writes what is no \
                         number, or a time step that is too large (lower integration.safety)";
            let criterion = Criterion { node: Some(node), ..Criterion::of("not_finite") };
            found = Some((body, what, cause, criterion));
        }
    }
    // what turned inside out did so before it blew up
    type Noted<'a> = (Entity, &'a Block, &'a FirstInverted, Option<&'a OnInversion>);
    for (entity, block, inverted, policy) in world.query::<Noted>().iter(world) {
        if inverted[0] != u32::MAX
            && policy != Some(&OnInversion(Inversion::Recover))
            && let Some(authoring) = world.get::<Authoring>(block.body)
        {
            let (what, criterion) = turned_inside_out(authoring, entity, inverted[0] as usize);
            found = Some((block.body, what, INVERTED, criterion));
        }
    }
    let Some((body, what, cause, criterion)) = found else { return Ok(None) };
    let body = label(world, body);
    Ok(Some(instability(world, settings, body, what, cause, criterion, good_until)))
}

/// That an element is turned inside out.
fn turned_inside_out(authoring: &Authoring, block: Entity, row: usize) -> (String, Criterion) {
    let place = authoring.blocks.iter().position(|&b| b == block).unwrap_or(0);
    let element = authoring.element_id(place, row);
    let criterion = Criterion { limit: Some(0.0), element: Some(element), ..Criterion::of("inverted") };
    (format!("element {element} is turned inside out (J < 0)"), criterion)
}

/// The body, and the same, where a sample shows it of elements that must not: kernels see it a step later.
fn seen_inside_out(parts: &[(Entity, BlockSums)], world: &World) -> Option<(String, String, Criterion)> {
    parts.iter().find_map(|(entity, sums)| {
        let ends = world.get::<OnInversion>(*entity) == Some(&OnInversion(Inversion::Stop));
        // without elements J is infinite
        let inside_out = sums.least_volume_ratio <= 0.0 || sums.least_volume_ratio.is_nan();
        let body = world.get::<Block>(*entity).filter(|_| ends && inside_out)?.body;
        let (what, criterion) = turned_inside_out(world.get::<Authoring>(body)?, *entity, sums.row as usize);
        Some((label(world, body), what, criterion))
    })
}

/// What of a sample is no finite number: in words, with the body or part that it is of.
fn not_finite(seen: &Sample, world: &World) -> Option<(String, f64)> {
    let part = |(entity, sums): &(Entity, BlockSums)| {
        let label = label(world, *entity);
        let named = [("elastic energy", sums.strain), ("hourglass energy", sums.hourglass)];
        let found = named.into_iter().find(|(_, value)| !value.is_finite());
        let found = found.or(sums.least_volume_ratio.is_nan().then_some(("smallest J", sums.least_volume_ratio)));
        found.map(|(name, value)| (format!("the {name} of {label}"), value))
    };
    let of_nodes = [
        ("the kinetic energy", seen.kinetic),
        ("the work against internal forces", seen.internal_work),
        ("the largest speed", seen.fastest.map_or(0.0, |(.., speed)| speed)),
        ("the largest displacement", seen.reach.iter().map(|(_, reach)| *reach).fold(0.0, larger)),
    ];
    let of_nodes = of_nodes.into_iter().find(|(_, value)| !value.is_finite());
    seen.parts.iter().find_map(part).or(of_nodes.map(|(name, value)| (name.into(), value)))
}

/// The larger of two numbers, or what is no number.
fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}

/// What is wrong with the present state itself. Kernels notice what is turned inside out when they next take its
/// forces: of a state that is handed out as a result, and of the last one, that would be too late.
pub(super) fn find_in_result(
    world: &mut World,
    good_until: f64,
    settings: &GuardSettings,
) -> Result<Option<Instability>, Error> {
    let parts = sample_result(world)?;
    if let Some((body, what, criterion)) = seen_inside_out(&parts, world) {
        return Ok(Some(instability(world, settings, body, what, INVERTED, criterion, good_until)));
    }
    let added_up = super::energies::not_finite(world)?;
    Ok(added_up.map(|(what, value)| {
        let (body, what) = (bodies(world), format!("{what} is {value}"));
        instability(world, settings, body, what, OVERFLOW, Criterion::of("result"), good_until)
    }))
}

/// Checks energies and elements; `last` is whether nobody looks again. Warns of what passes a limit, each once, and
/// ends the run where elements hold more energy than work was done on them: so a step beyond the stable one shows that
/// does not run away, because large motion holds it. Gives whether the state passed: what is in doubt is checked
/// again.
pub(super) fn check_balance(
    world: &mut World,
    good_until: f64,
    settings: &GuardSettings,
    last: bool,
) -> Result<bool, Error> {
    let seen = sample(world)?;
    if let Some((what, value)) = not_finite(&seen, world) {
        let inside_out = seen_inside_out(&seen.parts, world);
        let (body, what, cause, criterion) = match inside_out {
            Some((body, what, criterion)) => (body, what, INVERTED, criterion),
            None => (bodies(world), format!("{what} is {value}"), OVERFLOW, Criterion::of("result")),
        };
        let broken = instability(world, settings, body, what, cause, criterion, good_until);
        return Err(Error::Unstable(Box::new(broken)));
    }
    let rounding = world.get_resource::<Rounding>().map_or(0.0, |rounding| rounding.of_energy(&seen.reach));
    let clock = *world.resource::<Clock>();
    let Some(mut memory) = world.remove_resource::<GuardMemory>() else { return Ok(true) };
    if memory.checked_at.replace(clock.step) != Some(clock.step) {
        memory.checks += 1;
    }
    memory.rounding = memory.rounding.max(rounding);
    remember(&mut memory, &seen, world);
    let (made, held) = balance(&mut memory, &seen, settings, last, world);
    hourglass(&mut memory, &seen, settings, world);
    if settings.contacts {
        let made = super::contacts::loss(world)?.map_or(0.0, |loss| -loss);
        gives_back(&mut memory, made, settings, world);
    }
    if settings.springs {
        stiffened(&mut memory, settings, world);
    }
    let by_formula = if settings.implicit { made_by_formula(&mut memory, settings, world) } else { 0.0 };
    let (scale, rounding, passed) = (memory.scale, memory.rounding, memory.in_doubt.is_none());
    world.insert_resource(memory);
    if let Some((what, value)) = super::contacts::beyond_bound(world) {
        let criterion = Criterion { value: Some(value), limit: Some(0.0), ..Criterion::of("contact") };
        let body = bodies(world);
        let broken = instability(world, settings, body, what, MADE_BY_CONTACT, criterion, good_until);
        return Err(Error::Unstable(Box::new(broken)));
    }
    let stop = settings.limits.energy.stop;
    if by_formula > stop && settings.solved && !settings.foreign {
        let what = format!(
            "the formula of implicit steps has made {:.1} % of the largest energy so far, {:.1} % are allowed ({})",
            100.0 * by_formula,
            100.0 * stop,
            settings.limit_of_energy("stop")
        );
        let cause = format!(
            "steps that were not solved to their ends ({}), for what touches sticks and slides by turns (a smaller `share`, \
             less `friction`), or a load or motion too sudden for the mesh (use a ramp)",
            shorter_steps(world)
        );
        let criterion = Criterion { value: Some(by_formula), limit: Some(stop), ..Criterion::of("energy") };
        let body = bodies(world);
        let broken = instability(world, settings, body, what, &cause, criterion, good_until);
        return Err(Error::Unstable(Box::new(broken)));
    }
    if made <= stop * scale + rounding || settings.foreign {
        return Ok(passed);
    }
    if let Some((body, what, criterion)) = seen_inside_out(&seen.parts, world) {
        return Err(Error::Unstable(Box::new(instability(
            world, settings, body, what, INVERTED, criterion, good_until,
        ))));
    }
    let what = format!(
        "elements hold {held:.3e} J, but work on them was only {:.3e} J: {:.1} % of the largest energy so far came from \
         nothing, {:.1} % are allowed ({})",
        seen.internal_work,
        100.0 * made / scale,
        100.0 * stop,
        settings.limit_of_energy("stop")
    );
    let cause = format!(
        "a time step that is too large ({}), or a load or motion too sudden for the mesh (use a ramp)",
        shorter_steps(world)
    );
    let criterion = Criterion { value: Some(made / scale), limit: Some(stop), ..Criterion::of("energy") };
    debug_assert!(clock.relaxation.is_none());
    let body = bodies(world);
    let broken = instability(world, settings, body, what, &cause, criterion, good_until);
    Err(Error::Unstable(Box::new(broken)))
}

/// Notes how large energies are, the smallest J and the fastest node, and judges nothing: between two checks, so that
/// what came and went is known of what later imbalances are shares of.
pub(super) fn look(world: &mut World) -> Result<(), Error> {
    let seen = sample(world)?;
    let Some(mut memory) = world.remove_resource::<GuardMemory>() else { return Ok(()) };
    if not_finite(&seen, world).is_none() {
        remember(&mut memory, &seen, world);
        see_scale(&mut memory, &seen, world);
    }
    world.insert_resource(memory);
    Ok(())
}

fn hourglass(memory: &mut GuardMemory, seen: &Sample, settings: &GuardSettings, world: &World) {
    let limit = settings.limits.hourglass;
    for (entity, sums) in &seen.parts {
        let Some(part) = world.get::<Label>(*entity).map(|label| label.0.clone()) else { continue };
        let peak = memory.peaks.entry(part.clone()).or_default();
        *peak = peak.max(sums.strain);
        if sums.hourglass <= 0.0 || sums.hourglass + *peak < WORTH_CHECKING * memory.scale {
            continue;
        }
        let share = (sums.hourglass / peak.max(f64::MIN_POSITIVE)).min(MOST_SHARE);
        let worst = memory.hourglass.entry(part.clone()).or_default();
        *worst = worst.max(share);
        if share > limit && !settings.limits.off.contains(&Guard::Hourglass) {
            let holds = match share <= MOST_TOLD {
                true => format!("{:.0} % of", 100.0 * share),
                false => format!("more than {MOST_TOLD} times"),
            };
            // with several points volumes are held to their mean
            let has_points = world.get::<Block>(*entity).is_some_and(|block| point_count(block.kind) > 1);
            let reason = match has_points {
                true => {
                    "the volume at the points of an element differs from their mean, to which it is held; use a finer mesh"
                }
                false => "motion that elements with one point do not feel; use Hex8MeanDilatation, a finer mesh",
            };
            let message = format!(
                "hourglass control of {part} holds {holds} the part's elastic energy ({:.0} % are a warning, \
                 guards.hourglass): {reason}, or spread the load over more nodes",
                100.0 * limit
            );
            warn(memory, world, "hourglass", &part, share, limit, message);
        }
    }
}

pub(super) fn warn(
    memory: &mut GuardMemory,
    world: &World,
    criterion: &str,
    part: &str,
    value: f64,
    limit: f64,
    message: String,
) {
    if memory.warnings.iter().any(|notice| notice.criterion == criterion && notice.part == part) {
        return;
    }
    let clock = world.resource::<Clock>();
    let (criterion, part) = (criterion.to_string(), part.to_string());
    memory.warnings.push(Notice { criterion, part, time: clock.time(), step: clock.step, value, limit, message });
}

/// Notes the smallest J and the fastest node.
fn remember(memory: &mut GuardMemory, seen: &Sample, world: &World) {
    let time = world.resource::<Clock>().time();
    for (entity, sums) in &seen.parts {
        let (value, known) = (sums.least_volume_ratio, &memory.least_volume_ratio);
        let less = value.is_finite() && known.as_ref().is_none_or(|known| value < known.value);
        let Some(block) = world.get::<Block>(*entity).filter(|_| less) else { continue };
        let Some(authoring) = world.get::<Authoring>(block.body) else { continue };
        let place = authoring.blocks.iter().position(|block| block == entity).unwrap_or(0);
        let id = authoring.element_id(place, sums.row as usize);
        memory.least_volume_ratio = Some(Extreme { value, body: label(world, block.body), id, time });
    }
    if let Some((body, row, value)) = seen.fastest
        && memory.fastest_node.as_ref().is_none_or(|known| value > known.value)
        && let Some(authoring) = world.get::<Authoring>(body)
    {
        let id = authoring.node_id(row as usize);
        memory.fastest_node = Some(Extreme { value, body: label(world, body), id, time });
    }
}

/// The names of all bodies.
fn bodies(world: &mut World) -> String {
    let mut names: Vec<String> =
        world.query_filtered::<&Label, With<Authoring>>().iter(world).map(|label| label.0.clone()).collect();
    names.sort();
    names.join(", ")
}

fn label(world: &World, entity: Entity) -> String {
    world.get::<Label>(entity).map(|label| label.0.clone()).unwrap_or_default()
}

/// The report of a breakdown at the present step.
pub(super) fn instability(
    world: &World,
    settings: &GuardSettings,
    body: String,
    what: String,
    cause: &str,
    criterion: Criterion,
    good_until: f64,
) -> Instability {
    let clock = world.resource::<Clock>();
    let (time, step) = (clock.time(), clock.step);
    let jumped = world.get_resource::<Signals>().is_some_and(|signals| signals.have_jumped(time));
    let cause = if settings.beyond { STEP_TOO_LARGE.into() } else { cause.to_string() };
    let pushed = criterion.name == "energy" && world.contains_resource::<BeginsInside>();
    let cause = if pushed { format!("{INSIDE}; {cause}") } else { cause };
    let cause = if jumped { format!("{JUMP}; {cause}") } else { cause };
    Instability { time, step, body, what, cause, good_until, criterion, last_good: None }
}
