//! Tools that suck: names become mouths, and bodies tell their faces.

use super::body_columns::stiffnesses;
use super::contacts::{bounds, edge, motion, reference, way};
use super::glue::points_of;
use super::loads::corners_of;
use super::{Assembly, BodyParts};
use crate::components::*;
use crate::elements::Stiffness;
use crate::scene::diagnostic::Diagnostics;
use crate::scene::schema;
use crate::tools::Shape;
use bevy_ecs::prelude::*;
use glam::DVec3;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Edges of faces that are so many times as long as a mouth is across are told of.
const COARSE: f64 = 2.0;

/// How much farther than `reach`, in edges of faces, nodes of a body may be of which middles of faces are in reach.
const FACE: f64 = 2.0;

/// Spawns all tools that suck.
pub(super) fn spawn(assembly: &Assembly<'_>, world: &mut World, diagnostics: &mut Diagnostics) {
    let scene = &assembly.scene.scene;
    let mut of_body: BTreeMap<Entity, (Arc<BodyFaces>, usize)> = BTreeMap::new();
    let mut mouths: Vec<(&str, f64)> = Vec::new();
    for (number, suction) in scene.suction.iter().enumerate() {
        let (Some(body), Some(tool)) = (assembly.body(&suction.body), scene.tools.get(&suction.tool)) else { continue };
        let Some(bore) = suction.bore.or(bore(tool)) else { continue };
        soft(body, (number, suction), world, diagnostics);
        coarse(body, number, bore, diagnostics);
        stays_away(body, (number, suction), (scene, tool, bore), world, diagnostics);
        mouths.push((&suction.tool, bore));
        let (faces, count) = of_body.entry(body.entity).or_insert_with(|| (Arc::new(faces(body, world)), 0));
        let reference = reference(&body.placed.mesh.points);
        let mut signals = world.resource_mut::<Signals>();
        let pose = signals.add(Signal::Pose { motion: motion(tool), reference });
        let amplitude = DVec3::X * suction.pressure;
        let pressure = signals.add(Signal::Load { curve: suction.curve.clone(), amplitude });
        let sucks = Suction {
            tool: suction.tool.clone(),
            number: *count,
            mouth: mouths.iter().take_while(|&&of| of != (suction.tool.as_str(), bore)).count(),
            pose,
            reference,
            pressure,
            bore,
            reach: suction.reach,
            delay: suction.delay,
            faces: faces.clone(),
            active: FaceCorners::default(),
            now: 0.0,
        };
        *count += 1;
        world.spawn((sucks, OfBody(body.entity)));
    }
    for (body, (faces, count)) in of_body {
        let pressure = Reals::zeros(assembly.precision, SUCTION_NUMBERS * count);
        let marks = vec![0; faces.words() * count];
        let presence = vec![1; faces.len()];
        world.entity_mut(body).insert((SuctionPressure(pressure), SuctionMarks(marks), FacePresence(presence)));
    }
}

/// The radius of a tool's own mouth (m).
fn bore(tool: &schema::Tool) -> Option<f64> {
    match &tool.shape {
        Some(Shape::Tube { inner, .. }) => Some(*inner),
        _ => None,
    }
}

/// Warns of tissue that is drawn into the mouth without end.
fn soft(body: &BodyParts, (number, suction): (usize, &schema::Suction), world: &World, diagnostics: &mut Diagnostics) {
    let young = |of: Stiffness| (of.shear * (3.0 * of.lambda + 2.0 * of.shear) / (of.lambda + of.shear), of.eta);
    // fibres stiffen it
    let materials = body.blocks.iter().flat_map(|&block| stiffnesses(world, block));
    let softest = materials.map(young).filter(|of| of.1 == 0.0).map(|of| of.0).reduce(f64::min);
    if let Some(young) = softest.filter(|young| suction.pressure > *young) {
        let message = format!(
            "the suction of {:.3e} Pa is more than Young's modulus of what it sucks, {young:.3e} Pa",
            suction.pressure
        );
        diagnostics
            .warn_at(format!("suction[{number}].pressure").as_str(), message)
            .note("such tissue may be drawn into the mouth without end");
    }
}

/// Warns of faces that are far larger than the mouth: what it pulls at in one is spread over the whole of it.
fn coarse(body: &BodyParts, number: usize, bore: f64, diagnostics: &mut Diagnostics) {
    let edge = edge(body);
    if edge > COARSE * 2.0 * bore {
        let message = format!(
            "the mouth is {:.3e} m across, and edges of the surface that it sucks are {edge:.3e} m long in the mean",
            2.0 * bore
        );
        diagnostics
            .warn_at(format!("suction[{number}]").as_str(), message)
            .note("the pull is that of the mouth, but spread over whole faces: a finer mesh shows what is drawn in");
    }
}

/// Warns of a mouth that, as the body is at the start, is nowhere on its way as near to it as it sucks.
fn stays_away(
    body: &BodyParts,
    (number, suction): (usize, &schema::Suction),
    (scene, tool, bore): (&schema::Scene, &schema::Tool, f64),
    world: &World,
    diagnostics: &mut Diagnostics,
) {
    let motion = motion(tool);
    // where hands, programs and forces will move it nobody knows
    if motion.is_led() || tool.free.is_some() {
        return;
    }
    let points = points_of(body, true, world);
    let (low, high) = bounds(&points);
    // what counts are middles of faces, which are less than an edge or two from a node
    let near = suction.reach + FACE * edge(body);
    let mouth = Mouth::Disc(bore);
    let mut nearest = f64::INFINITY;
    for pose in way(&motion, scene.duration) {
        let outside = pose.at.distance(pose.at.clamp(low, high)) - bore;
        if outside >= nearest {
            continue;
        }
        let distances = points.iter().map(|&x| mouth.distance(pose.inverse(x)));
        nearest = distances.fold(nearest, f64::min);
        if nearest <= near {
            return;
        }
    }
    let Some(name) = scene.body_meant(&suction.body) else { return };
    let message = format!(
        "as `{name}` is at the start, the mouth of `{}` comes no nearer to it than {nearest:.3e} m: it sucks nothing",
        suction.tool
    );
    let note = format!("`reach` is {:.3e} m: let the tool come nearer, or reach farther", suction.reach);
    diagnostics.warn_at(format!("suction[{number}]").as_str(), message).note(note);
}

/// The faces that may be sucked.
fn faces(body: &BodyParts, world: &World) -> BodyFaces {
    let goes = body.blocks.iter().any(|&block| world.get::<Alive>(block).is_some());
    let all: Vec<(crate::mesh::SurfaceFace, u32)> = match goes {
        true => body.placed.mesh.faces_and_opposites(NO_FACE),
        false => body.placed.surface().iter().map(|face| (*face, NO_FACE)).collect(),
    };
    let rows = |nodes: [u32; 4]| nodes.map(|node| body.node_rows[node as usize]);
    let (parts, of_part) = corners_of(body, all.iter().map(|(face, _)| face));
    BodyFaces {
        corners: all.iter().map(|(face, _)| rows(face.nodes)).collect(),
        elements: all.iter().map(|(face, _)| body.element_rows[face.element as usize]).collect(),
        opposites: all.iter().map(|(_, opposite)| *opposite).collect(),
        parts,
        of_part,
    }
}
