//! What sutures, ties and glue bear.

use crate::backend::device::bring_to_host;
use crate::components::*;
use crate::error::Error;
use bevy_ecs::prelude::*;
use glam::DVec3;

/// What a suture, a tie or glue bears, in the step that has just been taken.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
pub struct AttachmentReading {
    /// The force on the body of its first point, or on the first of its bodies (N).
    pub force: DVec3,
    /// How many of its points hold.
    pub holds: usize,
    /// How long a suture is (m), at the beginning of the step; 0 of others.
    pub length: f64,
    /// What a suture stores (J); 0 of others.
    pub energy: f64,
    /// What has been lost (J): what a suture stored when it tore or came out, and what ties have taken.
    pub loss: f64,
    /// When the first of its points broke (s), if one did.
    pub broke_at: Option<f64>,
    /// Nodes of glue that hold no more, by the author's numbers.
    pub broken: Vec<u64>,
}

/// What the attachment of a place in the scene bears; `None` of a grasp, which is the tool's.
///
/// # Errors
/// What the GPU says.
pub fn read_attachment(world: &mut World, number: usize) -> Result<Option<AttachmentReading>, Error> {
    let wanted = [SutureState::NAME, TieState::NAME, Displacement::NAME, DisplacementIncrement::NAME];
    bring_to_host(world, |_, name| wanted.contains(&name))?;
    if let Some(sutures) = world.get_resource::<Sutures>()
        && let Some(suture) = sutures.all.iter().find(|suture| suture.number == number)
    {
        return Ok(of_suture(suture, sutures.reference, world));
    }
    let Some(glue) = world.get_resource::<Glue>() else { return Ok(None) };
    let mut reading = None;
    for tie in glue.ties.iter().filter(|tie| tie.number == number) {
        let Some(state) = world.get::<TieState>(glue.bodies[tie.bodies[0]]) else { continue };
        let at = TIE_NUMBERS * tie.place;
        let reading = reading.get_or_insert_with(AttachmentReading::default);
        reading.loss += state.get(at + 5);
        if state.get(at) == 0.0 {
            reading.holds += 1;
            reading.force += state.vector_at(at + 2);
        } else {
            reading.broken.extend(tie.node);
            let when = state.get(at + 1);
            reading.broke_at = Some(reading.broke_at.map_or(when, |first| first.min(when)));
        }
    }
    if let Some(reading) = &mut reading {
        reading.broken.sort_unstable();
    }
    Ok(reading)
}

fn of_suture(suture: &Suture, reference: DVec3, world: &World) -> Option<AttachmentReading> {
    let state = world.get::<SutureState>(suture.ends[0].body)?;
    let at = SUTURE_NUMBERS * suture.place;
    let (tension, length) = (state.get(at + 2), state.get(at + 3));
    let [from, to] = [0, 1].map(|end| when_pulled(&suture.ends[end], reference, world));
    let holds = state.get(at) == 0.0;
    let [energy, loss] = if holds { [state.get(at + 4), 0.0] } else { [0.0, state.get(at + 4)] };
    Some(AttachmentReading {
        force: (to - from).normalize_or_zero() * tension,
        holds: usize::from(holds),
        length,
        energy,
        loss,
        broke_at: (!holds).then(|| state.get(at + 1)),
        broken: Vec::new(),
    })
}

/// Where an end was when forces acted (m, from a reference): at the beginning of the last step, of implicit ones at its
/// end.
fn when_pulled(end: &Anchor, reference: DVec3, world: &World) -> DVec3 {
    let columns = (
        world.get::<RestPosition>(end.body),
        world.get::<Displacement>(end.body),
        world.get::<DisplacementIncrement>(end.body),
    );
    let (Some(rest), Some(u), Some(step)) = columns else { return DVec3::ZERO };
    let clock = world.resource::<Clock>();
    // before the first step the column of steps holds the velocity
    let back = if clock.step > 0 && !clock.velocities_at_ends { 1.0 } else { 0.0 };
    let of = |&(row, weight): &(u32, f64)| {
        let row = row as usize;
        weight * (rest.0[row] - reference + u.vector(row) - step.vector(row) * back)
    };
    end.nodes.iter().map(of).sum()
}
