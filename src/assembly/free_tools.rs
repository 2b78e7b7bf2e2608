//! Tools that move freely: what they weigh, where they begin, and which bodies they meet.

use super::contacts::{
    FARTHEST, bounds, edge, geometries, may_slip, meets_twice, motion, reference, rows, settling, sweeps_beyond,
};
use super::tool_overlaps::{self, Standing};
use super::{Assembly, loads};
use crate::components::*;
use crate::math::radians;
use crate::scene::diagnostic::Diagnostics;
use crate::scene::schema::{Contact, Free, Load, On, Tool};
use crate::tools::{Geometry, Inertia, RigidMotion};
use bevy_ecs::prelude::*;
use glam::{DMat3, DQuat, DVec3};

/// Spawns the free tools of a scene, and how they move at the start.
pub(super) fn spawn(assembly: &Assembly<'_>, world: &mut World, diagnostics: &mut Diagnostics) {
    let scene = &assembly.scene.scene;
    if scene.tools.values().all(|tool| tool.free.is_none()) {
        return;
    }
    let corners: Vec<DVec3> =
        assembly.bodies.values().flat_map(|body| <[DVec3; 2]>::from(bounds(&body.placed.mesh.points))).collect();
    let mut free_tools = FreeTools { all: Vec::new(), reference: reference(&corners) };
    let mut motions = FreeMotions::default();
    // what is wrong with shapes is told with those of guided tools
    let geometries = geometries(assembly.scene, world, &mut Diagnostics::default());
    let gravity = gravity(assembly, world);
    for (name, tool) in &scene.tools {
        let (Some(free), Some(geometry)) = (&tool.free, geometries.get(name)) else { continue };
        let path = format!("tools.\"{name}\".free");
        let Some(inertia) = inertia(free, geometry).filter(Inertia::is_sound) else {
            diagnostics.error_at(path.as_str(), "it has no volume that could be filled").note("give it another shape");
            continue;
        };
        let turn = pose_at_first(tool).1;
        let mut tool_ = FreeTool {
            name: name.clone(),
            geometry: geometry.clone(),
            inertia,
            damping: free.damping,
            gravity: gravity.clone(),
            start: DVec3::ZERO,
            meets: meets(assembly, name, geometry, world, diagnostics),
        };
        let place = pose_at_first(tool).0 + turn * inertia.center - free_tools.reference;
        tool_.start = place;
        let spin = radians(free.spin);
        let momentum = turn * (inertia.moments * (turn.conjugate() * spin));
        motions.all.push(FreeMotion::at(RigidMotion { place, turn, velocity: free.velocity, momentum }));
        free_tools.all.push(tool_);
    }
    world.insert_resource(free_tools);
    world.insert_resource(motions);
}

/// Where the origin of a tool is at first (m), and how it is turned.
fn pose_at_first(tool: &Tool) -> (DVec3, DQuat) {
    let (_, at, turn) = motion(tool).path[0];
    (at, turn)
}

fn inertia(free: &Free, geometry: &Geometry) -> Option<Inertia> {
    let filled = geometry.filled(free.mass, free.density.unwrap_or_default())?;
    Some(match free.inertia {
        Some(moments) => Inertia::new(filled.mass, filled.center, DMat3::from_diagonal(moments)),
        None => filled,
    })
}

/// Slots of accelerations that act on all bodies.
fn gravity(assembly: &Assembly<'_>, world: &mut World) -> Vec<usize> {
    let all = assembly.scene.scene.loads.iter().enumerate();
    let on_all = |load: &Load| matches!(load.parts().on, On::Bodies(_)) && load.parts().body.is_none();
    let acts = all.filter(|(_, load)| on_all(load) && loads::has_weight(load));
    acts.map(|(number, load)| world.resource_mut::<Signals>().add_load(number, load, 1.0)).collect()
}

/// What a tool may touch of each body.
fn meets(
    assembly: &Assembly<'_>,
    tool: &str,
    geometry: &Geometry,
    world: &World,
    diagnostics: &mut Diagnostics,
) -> Vec<MetBody> {
    let (mut all, mut numbers) = (Vec::new(), Vec::new());
    for (number, contact) in assembly.scene.scene.contacts.iter().enumerate() {
        let Contact::Tool { tool: of, body: on_body, on, thin, .. } = contact else { continue };
        if of != tool {
            continue;
        }
        for (name, body) in &assembly.bodies {
            if on_body.as_ref().is_some_and(|of| of != name) {
                continue;
            }
            let path = format!("contacts[{number}].on");
            let Some(rows) = rows(assembly, name, body, on, &path, diagnostics) else { continue };
            let edge = edge(body);
            if !thin {
                may_slip(tool, name, (geometry, edge), diagnostics);
            }
            for (other, met) in numbers.iter().zip(&all).filter(|(_, met): &(_, &MetBody)| met.name == *name) {
                let both = rows.iter().filter(|row| met.rows.binary_search(row).is_ok()).count();
                meets_twice(both, (tool, name), [*other, number], diagnostics);
            }
            numbers.push(number);
            let (settling, friction) = (settling(body, edge, world), contact.friction());
            let swept = sweeps_beyond(geometry, edge);
            all.push(MetBody { body: body.entity, name: name.clone(), rows, friction, edge, settling, swept });
        }
    }
    all
}

/// Looks for nodes inside free tools at the start, and tells whether there are some; and for tools that are too fast
/// for the step.
pub(super) fn check(assembly: &Assembly<'_>, world: &World, diagnostics: &mut Diagnostics) -> bool {
    let mut are_inside = false;
    let (Some(free), Some(motions)) = (world.get_resource::<FreeTools>(), world.get_resource::<FreeMotions>()) else {
        return false;
    };
    let time_step = world.resource::<Clock>().time_step;
    for (tool, FreeMotion { motion, .. }) in free.all.iter().zip(&motions.all) {
        let pose = tool.pose(motion);
        let pose = Pose { at: pose.at + free.reference, ..pose };
        let step = time_step * (motion.velocity.length() + tool.reach() * motion.spin(&tool.inertia).length());
        for met in &tool.meets {
            let Some(body) = assembly.bodies.get(&met.name) else { continue };
            let standing =
                Standing { tool: &tool.name, geometry: &tool.geometry, pose, rows: &met.rows, edge: met.edge };
            are_inside |= tool_overlaps::check(&met.name, body, &standing, (&assembly.scene.scene, world), diagnostics);
            if step > FARTHEST * met.edge {
                let message = format!(
                    "the tool `{}` goes {step:.3e} m a step at the start, and faces of `{}` have edges of {:.3e} m",
                    tool.name, met.name, met.edge
                );
                diagnostics.error_at(format!("tools.\"{}\".free", tool.name).as_str(), message).note(
                    "it could be through a surface before anybody sees it: give it a lower `velocity` or `spin`, or take a \
                     smaller `step`",
                );
            }
        }
    }
    are_inside
}
