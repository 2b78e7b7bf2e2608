//! Far from where a body began, displacements in f32 have too few digits left for strains; and where parts of a scene
//! are far from each other, places on a GPU have too few for what touches. What touches or is tied to rounding feels
//! forces that are nothing else.

use super::stiffness::StiffnessTracker;
use crate::components::*;
use crate::systems::SurfaceContacts;
use bevy_ecs::prelude::*;
use glam::DVec3;

/// What rounding may make of strains before it is warned of.
const MOST_NOISE: f64 = 1e-4;
/// Half of the last digit of a number in f32, relative to it.
const HALF_DIGIT: f64 = 1.0 / (1 << 24) as f64;

/// Warns of each body, once, where displacements u in f32 are so large that rounding makes strains of u·2⁻²⁴/h, h being
/// the shortest edge. Displacements on the host must be up to date.
pub(super) fn warn_of_rounding(trackers: &[StiffnessTracker], world: &mut World) {
    for block in trackers {
        let Some((body, largest)) = largest_rounded(block, world) else { continue };
        let noise = largest * HALF_DIGIT / block.shortest_edge;
        if noise > MOST_NOISE {
            warn(body, largest, noise, world);
        }
    }
}

/// The body, and the largest component of its displacements (m); `None` in f64.
fn largest_rounded(block: &StiffnessTracker, world: &World) -> Option<(Entity, f64)> {
    let body = world.get::<Block>(block.entity)?.body;
    match &world.get::<Displacement>(body)?.0 {
        Reals::F32(u) => Some((body, f64::from(u.iter().fold(0.0_f32, |largest, u| largest.max(u.abs()))))),
        Reals::F64(_) => None,
    }
}

/// Warns of what may touch on a GPU, where it reaches so far (m) from the point that places are counted from in f32
/// that rounding makes gaps of that share of an edge: parts of one scene that are far from each other, copies of a
/// body too.
pub(super) fn warn_of_places(world: &mut World) {
    let mut under_tools = world.query::<(&Label, &RestPosition, &ToolContacts)>();
    let of_tools = |(label, rest, tools): (&Label, &RestPosition, &ToolContacts)| {
        (label.0.clone(), "tools", farthest(rest, tools.reference), tools.edge)
    };
    let mut found: Vec<_> = under_tools.iter(world).map(of_tools).collect();
    if let Some(SurfaceContacts { bodies, reference, edges, .. }) = world.get_resource::<SurfaceContacts>() {
        found.extend(bodies.iter().zip(edges).filter_map(|(&body, edge)| {
            let (label, rest) = (world.get::<Label>(body)?, world.get::<RestPosition>(body)?);
            Some((label.0.clone(), "others", farthest(rest, *reference), *edge))
        }));
    }
    for (part, whom, far, edge) in found {
        let noise = far * HALF_DIGIT / edge;
        if noise > MOST_NOISE {
            let message = format!(
                "{part} may touch {whom} up to {far:.3e} m from the middle from which places are counted, where f32 rounds \
                 so coarsely that gaps are off by {noise:.1e} of an edge ({MOST_NOISE:.0e} are a warning): bring parts \
                 nearer to each other, or use --backend cpu, which counts places in f64"
            );
            note(part, noise, message, world);
        }
    }
}

/// How far (m) a coordinate of a body's nodes at rest is from a point at most.
fn farthest(rest: &RestPosition, reference: DVec3) -> f64 {
    rest.0.iter().map(|at| (*at - reference).abs().max_element()).fold(0.0, f64::max)
}

/// The last digit (m) of where a body's nodes are, in f64, in which systems look for what touches and what holds
/// together; 0 where none looks at them. A displacement in it is known no better, however small it is.
pub(super) fn digit_of_places(body: Entity, world: &World) -> f64 {
    let Some(rest) = world.get::<RestPosition>(body) else { return 0.0 };
    let tools = world.get::<ToolContacts>(body).map(|tools| tools.reference);
    let surfaces = world.get_resource::<SurfaceContacts>().filter(|contacts| contacts.bodies.contains(&body));
    let glue = world.get_resource::<Glue>().filter(|glue| glue.bodies.contains(&body));
    let sutures = world.get_resource::<Sutures>().filter(|_| world.get::<Sutured>(body).is_some());
    let free = world.get_resource::<FreeTools>().filter(|tools| tools.meet(body));
    let references = [
        tools,
        surfaces.map(|contacts| contacts.reference),
        glue.map(|glue| glue.reference),
        sutures.map(|sutures| sutures.reference),
        free.map(|tools| tools.reference),
    ];
    let reach = references.into_iter().flatten().map(|reference| farthest(rest, reference)).fold(0.0, f64::max);
    f64::EPSILON * reach
}

fn warn(body: Entity, largest: f64, noise: f64, world: &mut World) {
    let part = world.get::<Label>(body).map(|label| label.0.clone()).unwrap_or_default();
    let message = format!(
        "{part} has moved by {largest:.3e} m, where f32 rounds so coarsely that it makes strains of {noise:.1e} \
         ({MOST_NOISE:.0e} are a warning): what it feels is that uncertain; use --precision f64, or a mesh that begins near where \
         it goes"
    );
    note(part, noise, message, world);
}

/// Once of a body.
fn note(part: String, noise: f64, message: String, world: &mut World) {
    let (time, step) = (world.resource::<Clock>().time(), world.resource::<Clock>().step);
    let mut memory = world.get_resource_or_init::<GuardMemory>();
    if !memory.warnings.iter().any(|notice| notice.criterion == "rounding" && notice.part == part) {
        let criterion = "rounding".to_string();
        memory.warnings.push(Notice { criterion, part, time, step, value: noise, limit: MOST_NOISE, message });
    }
}
