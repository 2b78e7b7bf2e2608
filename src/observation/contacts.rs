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
    /// How many of its points touch faces: of its nodes, and where `points: Faces` looks at them of points of its
    /// faces.
    pub points: usize,
    /// How deep the deepest of these is inside (m); 0 where none is.
    pub penetration: f64,
    /// What contact has taken of its energy since the start (J): negative where others have given it more, who have
    /// lost that. Summed over all bodies it is what impact and friction between them have taken. None in a static
    /// analysis, which counts none.
    pub loss: Option<f64>,
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
    let mut loss = 0.0;
    let of_faces = world.get::<FaceTouch>(body).map(|touch| &touch.0);
    let starts = |touch: &Reals| (0..touch.len()).step_by(MEETING_NUMBERS);
    let points = [Some(&touch.0), of_faces].into_iter().flatten();
    for (touch, first) in points.flat_map(|touch| starts(touch).map(move |first| (touch, first))) {
        if PointState::of(touch.get(first + 4)).touched() {
            reading.points += 1;
            reading.penetration = reading.penetration.max(-touch.get(first + 5));
        }
        loss += touch.get(first + 7);
    }
    reading.loss = world.resource::<Clock>().relaxation.is_none().then_some(loss);
    Ok(Some(reading))
}

/// That contact between bodies gave energy that its law cannot give, and how much (J), where it did.
pub(super) fn beyond_bound(world: &World) -> Option<(String, f64)> {
    let gain = world.get_resource::<ContactGain>()?;
    let what = format!(
        "contact between bodies gave {:.3e} J more than its law can, in {} steps that were looked at",
        gain.energy, gain.steps
    );
    // what is no number is told of
    (gain.energy != 0.0).then_some((what, gain.energy))
}

/// What contact has taken since the start (J): impact and friction where bodies touch each other and themselves, and
/// what tools lose, to catching nodes too; the sum of what [`read_contact`] and [`read_tool`](super::read_tool) tell.
/// `None` where nothing may touch, and in a static analysis, which counts none.
pub(super) fn loss(world: &mut World) -> Result<Option<f64>, Error> {
    if world.resource::<Clock>().relaxation.is_some() {
        return Ok(None);
    }
    let wanted = [SurfaceTouch::NAME, FaceTouch::NAME, ToolTouch::NAME, ToolHold::NAME];
    // what free tools do to nodes
    let steps = world.contains_resource::<FreeTools>();
    bring_to_host(world, |_, name| wanted.contains(&name) || steps && name == DisplacementIncrement::NAME)?;
    let every =
        |of: &Reals, number: usize, stride: usize| (number..of.len()).step_by(stride).map(|at| of.get(at)).sum();
    let mut losses: Vec<f64> = Vec::new();
    for (of_nodes, of_faces) in world.query::<(&SurfaceTouch, Option<&FaceTouch>)>().iter(world) {
        losses.push(every(&of_nodes.0, 7, MEETING_NUMBERS));
        losses.extend(of_faces.map(|of_faces| every(&of_faces.0, 7, MEETING_NUMBERS)));
    }
    for (contacts, touch) in world.query::<(&ToolContacts, &ToolTouch)>().iter(world) {
        losses.push(every(&touch.0, 6, contacts.numbers_a_tool()));
    }
    for (grasps, hold) in world.query::<(&Grasps, &ToolHold)>().iter(world) {
        losses.push(every(&hold.0, 5, grasps.numbers_a_grasp()));
    }
    losses.extend(super::free_tools::losses(world));
    Ok((!losses.is_empty()).then(|| losses.iter().sum()))
}
