//! What bodies feel where they touch others, themselves and tools.

use crate::backend::device::bring_to_host;
use crate::components::*;
use crate::error::Error;
use bevy_ecs::prelude::*;
use glam::DVec3;

/// What a body feels where its surface touches others or itself, in the step that has just been taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct ContactReading {
    /// The force on it (N); what it does to itself is 0 in sum.
    pub force: DVec3,
    /// How many of its nodes touch faces; of points of faces too, each as one.
    pub nodes: usize,
    /// How deep the deepest of these is inside (m); 0 where none is.
    pub penetration: f64,
    /// What impact and friction at these have taken since the start (J).
    pub loss: f64,
}

/// What a body feels; `None` of one that may not meet others or itself.
///
/// # Errors
/// What the GPU says.
pub fn read_contact(world: &mut World, body: Entity) -> Result<Option<ContactReading>, Error> {
    bring_to_host(world, |_, name| [ContactForce::NAME, SurfaceTouch::NAME, FaceTouch::NAME].contains(&name))?;
    let (Some(force), Some(touch)) = (world.get::<ContactForce>(body), world.get::<SurfaceTouch>(body)) else {
        return Ok(None);
    };
    let mut reading = ContactReading { force: force.vectors().sum(), ..ContactReading::default() };
    let of_faces = world.get::<FaceTouch>(body).map(|touch| &touch.0);
    let starts = |touch: &Reals| (0..touch.len()).step_by(MEETING_NUMBERS);
    let points = [Some(&touch.0), of_faces].into_iter().flatten();
    for (touch, first) in points.flat_map(|touch| starts(touch).map(move |first| (touch, first))) {
        if touch.get(first + 4) > 1.0 {
            reading.nodes += 1;
            reading.penetration = reading.penetration.max(-touch.get(first + 5));
        }
        reading.loss += touch.get(first + 7);
    }
    Ok(Some(reading))
}
