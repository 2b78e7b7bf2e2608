//! Guards: what kernels found wrong in passing, told in the author's words.

use crate::backend::device::bring_to_host;
use crate::components::*;
use crate::error::{Error, Instability};
use bevy_ecs::prelude::*;

/// Stops at the first displacement that is not finite, or element that is turned inside out.
pub(super) fn check(world: &mut World, good_until: f64) -> Result<(), Error> {
    bring_to_host(world, |_, name| name == FirstInverted::NAME || name == FirstNonFinite::NAME)?;
    let clock = *world.resource::<Clock>();
    let mut found: Option<(Entity, String, &str)> = None;
    for (body, authoring, node) in world.query::<(Entity, &Authoring, &FirstNonFinite)>().iter(world) {
        if node[0] != u32::MAX {
            let what = format!("the displacement of node {} is not finite", authoring.node_id(node[0] as usize));
            found =
                Some((body, what, "a time step beyond the stable one, a load that is too sudden, or a wrong modulus"));
        }
    }
    // what turned inside out did so before it blew up
    for (entity, block, inverted) in world.query::<(Entity, &Block, &FirstInverted)>().iter(world) {
        if inverted[0] != u32::MAX
            && let Some(authoring) = world.get::<Authoring>(block.body)
        {
            let place = authoring.blocks.iter().position(|&b| b == entity).unwrap_or(0);
            let element = authoring.element_id(place, inverted[0] as usize);
            let what = format!("element {element} is turned inside out (J < 0)");
            let cause = "a load or motion too large or too sudden for the mesh (use a ramp, a finer mesh, or remove \
                         such elements by VolumeRatioBelow), or a time step that is too large (lower integration.safety)";
            found = Some((block.body, what, cause));
        }
    }
    let Some((body, what, cause)) = found else { return Ok(()) };
    let body = world.get::<Label>(body).map(|label| label.0.clone()).unwrap_or_default();
    let (time, step) = (clock.time(), clock.step);
    Err(Error::Unstable(Box::new(Instability { time, step, body, what, cause: cause.into(), good_until })))
}
