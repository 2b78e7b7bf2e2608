//! Guards: what kernels found wrong in passing, told in the author's words.

use crate::backend::device::bring_to_host;
use crate::components::*;
use crate::error::{Error, Instability};
use crate::scene::schema::Inversion;
use bevy_ecs::prelude::*;

/// How much more energy elements may hold than was spent on them, in shares of all there is: more than a step near the
/// stable one may err by.
const MADE_OF_NOTHING: f64 = 0.1;

/// What leads to a breakdown when the scene insists on a step beyond the stable one.
const STEP_TOO_LARGE: &str = "a time step beyond the stable one (leave `step` out to have it found)";

/// What broke down, if something did: the first displacement that is not finite, or element that is turned inside out.
/// `beyond`: the scene insists on a step beyond the stable one.
pub(super) fn find(world: &mut World, good_until: f64, beyond: bool) -> Result<Option<Instability>, Error> {
    bring_to_host(world, |_, name| name == FirstInverted::NAME || name == FirstNonFinite::NAME)?;
    let clock = *world.resource::<Clock>();
    let mut found: Option<(Entity, String, &str)> = None;
    for (body, authoring, node) in world.query::<(Entity, &Authoring, &FirstNonFinite)>().iter(world) {
        if node[0] != u32::MAX {
            let what = format!("the displacement of node {} is not finite", authoring.node_id(node[0] as usize));
            found = Some((body, what, "a load that is too sudden, a wrong modulus, or a time step that is too large"));
        }
    }
    // what turned inside out did so before it blew up
    type Noted<'a> = (Entity, &'a Block, &'a FirstInverted, Option<&'a OnInversion>);
    for (entity, block, inverted, policy) in world.query::<Noted>().iter(world) {
        if inverted[0] != u32::MAX
            && policy != Some(&OnInversion(Inversion::Recover))
            && let Some(authoring) = world.get::<Authoring>(block.body)
        {
            let place = authoring.blocks.iter().position(|&b| b == entity).unwrap_or(0);
            let element = authoring.element_id(place, inverted[0] as usize);
            let what = format!("element {element} is turned inside out (J < 0)");
            let cause = "a load or motion too large or too sudden for the mesh (use a ramp, a finer mesh, or say by \
                         `inversion` of the material what becomes of such elements), or a time step that is too large (lower integration.safety)";
            found = Some((block.body, what, cause));
        }
    }
    let Some((body, what, cause)) = found else { return Ok(None) };
    let cause = if beyond { STEP_TOO_LARGE } else { cause };
    let body = world.get::<Label>(body).map(|label| label.0.clone()).unwrap_or_default();
    let (time, step) = (clock.time(), clock.step);
    Ok(Some(Instability { time, step, body, what, cause: cause.into(), good_until }))
}

/// Stops when elements hold more energy than was ever spent on them: so a step beyond the stable one shows that does not
/// run away, because large motion holds it. Of viscous blocks only what remains in the long term counts.
pub(super) fn check_energy(world: &mut World, good_until: f64) -> Result<(), Error> {
    let energies = super::energies(world)?;
    let Some(spent) = energies.internal_work else { return Ok(()) };
    let alpha = |prony: &Prony| prony.terms.iter().map(|(alpha, _)| alpha).sum::<f64>();
    let viscous = world.query_filtered::<&Prony, With<Density>>().iter(world).map(alpha).fold(0.0, f64::max);
    let held = (1.0 - viscous) * energies.strain + energies.hourglass;
    let works = [energies.load_work, energies.constraint_work].map(|work| work.unwrap_or(0.0).abs());
    let scale = works.into_iter().fold(energies.kinetic + energies.strain + energies.hourglass, f64::max);
    if held - spent <= MADE_OF_NOTHING * scale {
        return Ok(());
    }
    let clock = *world.resource::<Clock>();
    let mut bodies: Vec<String> =
        world.query_filtered::<&Label, With<Authoring>>().iter(world).map(|label| label.0.clone()).collect();
    bodies.sort();
    Err(Error::Unstable(Box::new(Instability {
        time: clock.time(),
        step: clock.step,
        body: bodies.join(", "),
        what: format!("elements hold {held:.3e} J, but only {spent:.3e} J were spent on them"),
        cause: STEP_TOO_LARGE.into(),
        good_until,
    })))
}
