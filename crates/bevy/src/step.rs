//! A tick: inputs in, steps, what they brought out.

use crate::mesh::BodyShape;
use crate::simulation::*;
use bevy_ecs::prelude::*;
use bevy_time::Time;
use sinew::{Ended, Error};

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
#[derive(Default)]
struct Tick {
    /// The share of its time that was simulated, where that is not all.
    fell_behind: Option<f64>,
    /// Bodies whose elements have gone or come back, and how many are left.
    removed: Vec<(String, usize)>,
}

type Scene<'a> = (Entity, &'a mut SoftSimulation, Option<&'a mut SoftProbes>, Option<&'a Children>);

/// Takes the steps of a tick in all scenes.
pub(crate) fn step(
    time: Res<Time>,
    clock: Res<SinewClock>,
    mut scenes: Query<Scene>,
    mut bodies: Query<(&SoftBody, &mut BodyShape)>,
    mut broke_down: MessageWriter<BrokeDown>,
    mut fell_behind: MessageWriter<FellBehind>,
    mut elements_removed: MessageWriter<ElementsRemoved>,
) {
    let asked = time.delta_secs_f64() * clock.speed;
    for (scene, mut simulation, probes, children) in &mut scenes {
        let children: Vec<Entity> = children.into_iter().flatten().copied().collect();
        if clock.paused || simulation.broken || !(asked.is_finite() && asked > 0.0) {
            for &child in &children {
                if let Ok((_, mut shape)) = bodies.get_mut(child) {
                    shape.stand_still();
                }
            }
            continue;
        }
        let ticked = tick(&mut simulation, asked, &clock).and_then(|mut tick| {
            for &child in &children {
                let Ok((body, mut shape)) = bodies.get_mut(child) else { continue };
                if shape.update(&mut simulation, &body.name)? {
                    tick.removed.push((body.name.clone(), shape.left));
                }
            }
            if let Some(mut probes) = probes {
                let names: Vec<String> = simulation.scene().probes.keys().cloned().collect();
                for name in names {
                    let seen = simulation.probe(&name)?;
                    probes.0.insert(name, seen);
                }
            }
            Ok(tick)
        });
        match ticked {
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

/// Steps until the time that is asked for, if they fit into the budget.
fn tick(simulation: &mut SoftSimulation, asked: f64, clock: &SinewClock) -> Result<Tick, Error> {
    let from = simulation.time() - simulation.ahead.clamp(0.0, simulation.time_step());
    let until = from + asked;
    if simulation.time() >= until {
        simulation.ahead = simulation.time() - until;
        return Ok(Tick::default());
    }
    let advanced = simulation.advance_for(clock.budget, until)?;
    let now = simulation.time();
    simulation.ahead = (now - until).max(0.0);
    let behind = advanced.why == Ended::Budget && now < until;
    Ok(Tick { fell_behind: behind.then(|| ((now - from) / asked).clamp(0.0, 1.0)), ..Tick::default() })
}
