//! A tick: inputs in, steps, what they brought out.

use crate::mesh::BodyShape;
use crate::simulation::*;
use bevy_ecs::prelude::*;
use bevy_time::Time;
use sinew::{Ended, Error};
use std::time::Duration;

/// Sets the inputs that have changed.
pub(crate) fn set_inputs(
    mut scenes: Query<(Entity, Ref<SoftInputs>, &mut SoftSimulation)>,
    mut refused: MessageWriter<Refused>,
) {
    for (scene, inputs, mut simulation) in &mut scenes {
        if !inputs.is_changed() && !simulation.fresh {
            continue;
        }
        for (name, value) in &inputs.0 {
            if let Err(error) = simulation.set_input(name, *value) {
                refused.write(Refused { scene, error: error.to_string() });
            }
        }
        simulation.fresh = false;
    }
}

/// What a tick brought.
struct Tick {
    /// The share of its time that was simulated, where that is not all.
    fell_behind: Option<f64>,
    /// Bodies whose elements have gone or come back, and how many are left.
    removed: Vec<(String, usize)>,
}

type Scene<'a> = (Entity, &'a mut SoftSimulation, Option<&'a mut SoftProbes>, Option<&'a Children>);
type Body<'a> = (&'a SoftBody, &'a mut BodyShape);

/// Takes the steps of a tick in all scenes.
pub(crate) fn step(
    time: Res<Time>,
    clock: Res<SinewClock>,
    mut scenes: Query<Scene>,
    mut bodies: Query<Body>,
    mut broke_down: MessageWriter<BrokeDown>,
    mut fell_behind: MessageWriter<FellBehind>,
    mut elements_removed: MessageWriter<ElementsRemoved>,
) {
    let asked = time.delta_secs_f64() * clock.speed;
    let budget = share_of(clock.budget, scenes.iter().filter(|(_, simulation, ..)| !simulation.broken).count());
    for (scene, mut simulation, mut probes, children) in &mut scenes {
        let children: Vec<Entity> = children.into_iter().flatten().copied().collect();
        let stands = clock.paused || simulation.broken || !(asked.is_finite() && asked > 0.0);
        let asked = (!stands).then_some((asked, budget));
        match pass(&mut simulation, asked, &children, &mut bodies, &mut probes) {
            Ok(tick) => {
                fell_behind.write_batch(tick.fell_behind.map(|factor| FellBehind { scene, factor }));
                let told = tick.removed.into_iter().map(|(body, left)| ElementsRemoved { scene, body, left });
                elements_removed.write_batch(told);
            }
            Err(error) => {
                simulation.broken = true;
                broke_down.write(BrokeDown { scene, error: error.to_string() });
            }
        }
    }
}

/// What of a budget each of so many scenes may take.
fn share_of(budget: Duration, scenes: usize) -> Duration {
    budget / u32::try_from(scenes.max(1)).unwrap_or(u32::MAX)
}

/// A tick of a scene: the time that it is asked for (s), and what that may take; nothing where it stands.
fn pass(
    simulation: &mut SoftSimulation,
    asked: Option<(f64, Duration)>,
    children: &[Entity],
    bodies: &mut Query<Body>,
    probes: &mut Option<Mut<SoftProbes>>,
) -> Result<Tick, Error> {
    let mut removed = Vec::new();
    if simulation.has_gone_over() {
        // nothing is drawn between a state and one that no steps lead to
        removed = look(simulation, children, bodies, probes, true)?;
    }
    let Some((asked, budget)) = asked else {
        for &child in children {
            if let Ok((_, mut shape)) = bodies.get_mut(child) {
                shape.stand_still();
            }
        }
        return Ok(Tick { fell_behind: None, removed });
    };
    let fell_behind = advance(simulation, asked, budget)?;
    removed.extend(look(simulation, children, bodies, probes, false)?);
    Ok(Tick { fell_behind, removed })
}

/// Reads what is drawn of bodies and what probes see; bodies whose elements have gone or come back, and how many are
/// left. `anew`: no steps have led here from what was read before.
fn look(
    simulation: &mut SoftSimulation,
    children: &[Entity],
    bodies: &mut Query<Body>,
    probes: &mut Option<Mut<SoftProbes>>,
    anew: bool,
) -> Result<Vec<(String, usize)>, Error> {
    let mut removed = Vec::new();
    for &child in children {
        let Ok((body, mut shape)) = bodies.get_mut(child) else { continue };
        if shape.update(simulation, &body.name, anew)? {
            removed.push((body.name.clone(), shape.left));
        }
    }
    if let Some(probes) = probes {
        let names: Vec<String> = simulation.scene().probes.keys().cloned().collect();
        let seen = names.into_iter().map(|name| simulation.probe(&name).map(|seen| (name, seen)));
        // a scene that was loaded anew may have others
        probes.0 = seen.collect::<Result<_, Error>>()?;
    }
    Ok(removed)
}

/// Steps until the time that is asked for, if they fit into the budget; which share of it was simulated, where that is
/// not all.
fn advance(simulation: &mut SoftSimulation, asked: f64, budget: Duration) -> Result<Option<f64>, Error> {
    let from = simulation.time() - simulation.ahead.clamp(0.0, simulation.time_step());
    let until = from + asked;
    if simulation.time() >= until {
        simulation.ahead = simulation.time() - until;
        return Ok(None);
    }
    let advanced = simulation.advance_for(budget, until)?;
    let now = simulation.time();
    simulation.ahead = (now - until).max(0.0);
    let behind = advanced.why == Ended::Budget && now < until;
    Ok(behind.then(|| ((now - from) / asked).clamp(0.0, 1.0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_share_the_budget_of_a_tick() {
        let budget = Duration::from_millis(10);
        assert_eq!([0, 1, 2].map(|scenes| share_of(budget, scenes).as_millis()), [10, 10, 5]);
    }
}
