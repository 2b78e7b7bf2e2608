//! Rigid tools that are in bodies which they touch: contact is of nodes, and does not see what is between them.

use super::{OVERLAP, Placed, near, place};
use crate::components::*;
use crate::contact::immersed;
use crate::math::coordinates;
use crate::observation::tools::poses_now;
use crate::tools::Geometry;
use bevy_ecs::prelude::*;
use glam::DVec3;

/// How deep in a body a tool's surface must be, in edges of faces: between nodes it dips into faces.
const DEPTH: f64 = 0.5;

/// How deep nodes are in a tool, in edges, that are more than at its surface.
const PRESSED: f64 = 0.01;

/// A tool and a body that it may touch.
pub(super) struct Pair {
    tool: String,
    geometry: Geometry,
    /// In the scene (m).
    pose: Pose,
    body: Entity,
    /// Of a guided tool its place in [`ToolContacts::tools`].
    bit: Option<usize>,
    /// The body's name.
    label: String,
    /// Of the body's faces (m).
    edge: f64,
}

/// Warns once of each tool in a body.
pub(super) fn check(world: &World, pairs: &[Pair], memory: &mut GuardMemory, (time, step): (f64, u64)) {
    for pair in pairs {
        for notice in unfelt(world, pair, (time, step)).into_iter().flatten() {
            if !memory.warnings.iter().any(|other| other.criterion == OVERLAP && other.part == notice.part) {
                memory.warnings.push(notice);
            }
        }
        let part = format!("{} and {}", pair.tool, pair.label);
        let is_told = memory.warnings.iter().any(|notice| notice.criterion == OVERLAP && notice.part == part);
        let Some((middle, radius)) = pair.geometry.bounding_sphere() else { continue };
        let Some(body) = place(world, pair.body).filter(|_| !is_told) else { continue };
        // what is cut off there is far from the tool
        let around = DVec3::splat(radius + 2.0 * DEPTH * pair.edge);
        let middle = pair.pose.place(middle);
        let near = near(world, &body, middle - around, middle + around);
        if near.elements.is_empty() {
            continue;
        }
        if let Some((at, element)) = immersed(&pair.geometry, &pair.pose, &near.mesh, DEPTH * pair.edge) {
            let message = message(pair, &body, (at, near.elements[element]));
            let criterion = OVERLAP.to_string();
            memory.warnings.push(Notice { criterion, part, time, step, value: 1.0, limit: 0.0, message });
        }
    }
}

/// What to say of nodes inside a guided tool that are moved otherwise: fixed or prescribed, it feels nothing of
/// them; held by another closed tool, each undoes in every step what the other does, and the force that it feels is by
/// the step.
fn unfelt(world: &World, pair: &Pair, (time, step): (f64, u64)) -> [Option<Notice>; 2] {
    let of_body = |bit: usize| {
        let (contacts, axes) = (world.get::<ToolContacts>(pair.body)?, world.get::<ConstrainedAxes>(pair.body)?);
        let (rest, u) = (world.get::<RestPosition>(pair.body)?, world.get::<Displacement>(pair.body)?);
        let met = contacts.rows.iter().zip(&contacts.masks).filter(move |(_, mask)| **mask >> bit & 1 == 1);
        let inside = move |row: u32| {
            let at = row as usize;
            let depth = -pair.geometry.distance(pair.pose.inverse(rest.0[at] + u.vector(at))).0;
            (depth > PRESSED * pair.edge).then_some((axes.hold(at), row, depth))
        };
        Some(met.filter_map(move |(&row, _)| inside(row)))
    };
    let Some(inside) = pair.bit.and_then(of_body) else { return [None, None] };
    let (mut led, mut held) = ((0, 0.0_f64), (0, 0.0_f64));
    for (is_led, row, depth) in inside {
        if is_led {
            led = (led.0 + 1, led.1.max(depth));
        } else if holds(world, pair, row) {
            held = (held.0 + 1, held.1.max(depth));
        }
    }
    let (tool, label) = (&pair.tool, &pair.label);
    let notice = |(count, deepest): (usize, f64), of: &str, that: [&str; 2], then: &str| {
        let message = match count {
            1 => format!("the tool {tool} is in a node of {label} that {}, by {deepest:.3e} m: {then}", that[0]),
            _ => format!(
                "the tool {tool} is in {count} nodes of {label} that {}, the deepest by {deepest:.3e} m: {then}",
                that[1]
            ),
        };
        let (criterion, part) = (OVERLAP.to_string(), format!("{tool} and {of} nodes of {label}"));
        (count > 0).then_some(Notice { criterion, part, time, step, value: 1.0, limit: 0.0, message })
    };
    [
        notice(
            led,
            "led",
            ["is fixed or prescribed", "are fixed or prescribed"],
            "it feels nothing there; hold nodes that it does not reach",
        ),
        notice(
            held,
            "held",
            ["another closed tool holds"; 2],
            "each of both tools has its own way, and what they feel is by the step; hold nodes that it does not reach",
        ),
    ]
}

/// Whether a closed tool other than this one holds a node.
fn holds(world: &World, pair: &Pair, row: u32) -> bool {
    let (Some(grasps), Some(hold)) = (world.get::<Grasps>(pair.body), world.get::<ToolHold>(pair.body)) else {
        return false;
    };
    let Ok(place) = grasps.rows.binary_search(&row) else { return false };
    let of = |number: usize| hold.get(grasps.numbers() * place + grasps.numbers_a_grasp() * number + 3);
    let mut others = grasps.grasps.iter().enumerate().filter(|(_, grasp)| grasp.tool.tool != pair.tool);
    others.any(|(number, _)| of(number) == ToolHold::HELD)
}

fn message(Pair { tool, edge, .. }: &Pair, body: &Placed<'_>, (at, element): (DVec3, usize)) -> String {
    format!(
        "the tool {tool} is in {} at ({}) m: its surface is in element {}, more than half an edge of a face, {:.3e} m, \
         below that of {}; contact is of nodes, however slow the tool is: finer faces, a thicker tool or one that presses \
         less deep keep it out",
        body.label,
        coordinates(at, *edge),
        body.authoring.element_ids.of(element),
        DEPTH * edge,
        body.label,
    )
}

/// All tools and the bodies that they may touch, by their names.
pub(super) fn pairs(world: &mut World) -> Vec<Pair> {
    let mut all = Vec::new();
    let now = poses_now(world);
    let mut bodies = world.query::<(Entity, &Label, &ToolContacts)>();
    for (body, label, contacts) in bodies.iter(world) {
        for (bit, contact) in contacts.tools.iter().enumerate() {
            let Some((_, pose)) = now.iter().find(|(slot, _)| *slot == contact.signal) else { continue };
            let pose = Pose { at: pose.at + contacts.reference, ..*pose };
            let (tool, geometry) = (contact.tool.clone(), contact.geometry.clone());
            all.push(Pair { tool, geometry, pose, body, bit: Some(bit), label: label.0.clone(), edge: contacts.edge });
        }
    }
    if let (Some(tools), Some(motions)) = (world.get_resource::<FreeTools>(), world.get_resource::<FreeMotions>()) {
        for (tool, state) in tools.all.iter().zip(&motions.all) {
            let pose = tool.pose(&state.motion);
            let pose = Pose { at: pose.at + tools.reference, ..pose };
            let pair = |met: &MetBody| {
                let (tool, geometry) = (tool.name.clone(), tool.geometry.clone());
                Pair { tool, geometry, pose, body: met.body, bit: None, label: met.name.clone(), edge: met.edge }
            };
            all.extend(tool.meets.iter().map(pair));
        }
    }
    all.sort_by(|a, b| (&a.tool, &a.label).cmp(&(&b.tool, &b.label)));
    all
}
