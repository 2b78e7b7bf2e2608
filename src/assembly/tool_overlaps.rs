//! Bodies and rigid tools before the first step: which nodes are inside a tool, and whether a tool is in a body,
//! between its nodes.

use super::BodyParts;
use super::surface_overlaps::at_start;
use crate::components::*;
use crate::contact::immersed;
use crate::math::coordinates;
use crate::scene::diagnostic::Diagnostics;
use crate::scene::schema::{Contact, Scene, Select};
use crate::tools::Geometry;
use bevy_ecs::prelude::*;

/// How deep nodes may be inside a tool at the start, in edges: those come out by and by.
const DEEPEST: f64 = 0.5;

/// Nodes that a complaint names.
const NAMED: usize = 10;

/// A tool at the start, and the nodes that it may touch of a body whose edges are so long (m).
pub(super) struct Standing<'a> {
    pub tool: &'a str,
    pub geometry: &'a Geometry,
    pub pose: Pose,
    pub rows: &'a [u32],
    pub edge: f64,
}

/// What of a body and a tool is inside the other at the start: deep ones are an error. Tells whether nodes are inside.
pub(super) fn check(
    name: &str,
    body: &BodyParts,
    standing: &Standing<'_>,
    (scene, world): (&Scene, &World),
    diagnostics: &mut Diagnostics,
) -> bool {
    let deepest = nodes_inside(name, body, standing, world, diagnostics);
    let Standing { tool, geometry, pose, edge, .. } = standing;
    let is_meant = |contact: &Contact| match contact {
        Contact::Tool { tool: of, body, on, thin, .. } => {
            let is_this = of == tool && body.as_ref().is_none_or(|body| body == name);
            is_this && (*thin || !matches!(on, Select::Surface { normal: None, .. }))
        }
        _ => false,
    };
    if deepest > DEEPEST * edge || scene.contacts.iter().any(is_meant) {
        return deepest > 0.0;
    }
    let mesh = at_start(body, world);
    if let Some((at, element)) = immersed(geometry, pose, &mesh, DEEPEST * edge) {
        diagnostics
            .error_at(
                format!("tools.\"{tool}\"").as_str(),
                format!(
                    "the tool `{tool}` is in `{name}` at the start: its surface at ({}) m is in element {}, more \
                     than half an edge of a face, {:.3e} m, below the surface of `{name}`",
                    coordinates(at, *edge),
                    mesh.element_ids.of(element),
                    DEEPEST * edge
                ),
            )
            .note("tools touch nodes of surfaces: between them, inside of a body, nothing pushes it out")
            .note("begin outside; `thin: true` in the contact says that this is meant");
    }
    deepest > 0.0
}

/// Nodes that are inside a tool: deep ones are an error. How deep the deepest is (m), or 0.
fn nodes_inside(
    name: &str,
    body: &BodyParts,
    standing: &Standing<'_>,
    world: &World,
    diagnostics: &mut Diagnostics,
) -> f64 {
    let (Some(rest), Some(u)) = (world.get::<RestPosition>(body.entity), world.get::<Displacement>(body.entity)) else {
        return 0.0;
    };
    let Standing { tool, geometry, pose, rows, edge } = standing;
    let path = format!("tools.\"{tool}\"");
    let mut found: Vec<(f64, u32)> = rows
        .iter()
        .map(|&row| {
            let place = rest.0[row as usize] + u.vector(row as usize);
            (geometry.distance(pose.inverse(place)).0, row)
        })
        .filter(|(distance, _)| *distance < -1e-3 * edge)
        .collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    let Some(&(deepest, _)) = found.first() else { return 0.0 };
    let authoring = world.get::<Authoring>(body.entity);
    let number = |row: u32| authoring.map_or(u64::from(row), |authoring| authoring.node_id(row as usize));
    let mut nodes: Vec<String> = found.iter().take(NAMED).map(|&(_, row)| number(row).to_string()).collect();
    if found.len() > NAMED {
        nodes.push("...".into());
    }
    let message = format!(
        "{} of `{name}` {} inside the tool `{}` at the start, the deepest by {:.3e} m",
        if found.len() == 1 { "a node".to_string() } else { format!("{} nodes", found.len()) },
        if found.len() == 1 { "is" } else { "are" },
        tool,
        -deepest,
    );
    let nodes = format!("nodes: {}", nodes.join(", "));
    if -deepest > DEEPEST * edge {
        diagnostics
            .error_at(path.as_str(), message)
            .note(nodes)
            .note(format!("up to half an edge of a face, {:.3e} m, is pushed out", DEEPEST * edge));
    } else {
        diagnostics
            .warn_at(path.as_str(), message)
            .note(nodes)
            .note("they are pushed out while a wave goes through the body");
    }
    -deepest
}
