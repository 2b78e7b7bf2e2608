//! Loads: selections become rows, faces and shares of area.

use super::{Assembly, BodyParts};
use crate::components::*;
use crate::mesh::{CellKind, SurfaceFace};
use crate::scene::diagnostic::Diagnostics;
use crate::scene::schema::{Load, LoadParts, On, PerCopy, Share};
use bevy_ecs::prelude::*;
use glam::DVec3;
use std::collections::BTreeSet;
use std::sync::Arc;

/// Spawns all loads. Those of no weight are looked at like the others, and pruned: they cost nothing.
pub(super) fn spawn(assembly: &Assembly<'_>, world: &mut World, diagnostics: &mut Diagnostics) {
    let systems = crate::systems::of_loads();
    for (number, load) in assembly.scene.scene.loads.iter().enumerate() {
        let LoadParts { word, name, body, on, .. } = load.parts();
        let Some((bodies, on, share)) = acted_on(assembly, body, on, number, diagnostics) else { continue };
        let system = systems.iter().find(|(of, _)| *of == word).and_then(|(_, system)| system.load.as_ref());
        debug_assert!(system.is_some(), "the system of {word} is for no load");
        let (true, Some(put_on)) = (has_weight(load), system) else { continue };
        let signal = world.resource_mut::<Signals>().add_load(number, load, share);
        for body in bodies {
            let mut entity = world.spawn(OfBody(body));
            put_on(&on, signal, &mut entity);
            entity.insert(SceneLoad { name, signal, on: on.clone() });
        }
    }
}

/// The bodies that a load acts on, what of them, and among how many nodes it is shared.
fn acted_on(
    assembly: &Assembly<'_>,
    name: Option<&String>,
    on: On<'_>,
    number: usize,
    diagnostics: &mut Diagnostics,
) -> Option<(Vec<Entity>, LoadedRows, f64)> {
    let Some(select) = on.select() else {
        let named = name.and_then(|name| assembly.bodies.get(name));
        let bodies = named.map_or(assembly.bodies.values().collect(), |body| vec![body]);
        let factors = match (on.per_copy(), bodies.as_slice()) {
            (Some(per_copy), [body]) => {
                let rows: Vec<u32> = (0..body.node_rows.len() as u32).collect();
                body.of_rows(&rows, &factors_of(per_copy, number, body))
            }
            _ => Vec::new(),
        };
        let on = LoadedRows::All(Arc::new(factors));
        return Some((bodies.into_iter().map(|body| body.entity).collect(), on, 1.0));
    };
    let path = format!("loads[{number}].on");
    let body = assembly.body(&name.cloned())?;
    let picked = assembly.pick(body, select, &path, diagnostics)?;
    let factors = on.per_copy().map(|per_copy| factors_of(per_copy, number, body));
    let found = match on {
        On::Nodes(_, share, _) => picked.nodes(&body.placed).map(|marks| {
            let rows = body.rows_of(&marks);
            let factors = factors.map_or(Vec::new(), |factors| body.of_rows(&rows, &factors));
            let touched: BTreeSet<usize> = body.copies_of(&rows).into_iter().collect();
            let each = rows.len() as f64 / touched.len().max(1) as f64;
            let parts = if share == Share::Total { each } else { 1.0 };
            (LoadedRows::Nodes(Arc::new(LoadedNodes { rows, factors })), parts)
        }),
        On::Bodies(_) | On::Faces(..) => {
            let faces = picked.faces(&body.placed);
            faces.map(|places| (LoadedRows::Faces(Arc::new(face_corners(body, &places, factors.as_deref()))), 1.0))
        }
    };
    match found {
        Ok((rows, share)) => Some((vec![body.entity], rows, share)),
        Err(problem) => {
            diagnostics.error_at(path.as_str(), problem.message).notes(problem.notes);
            None
        }
    }
}

/// What the load of a number is multiplied with in each copy along each axis.
fn factors_of(per_copy: &PerCopy, number: usize, body: &BodyParts) -> Vec<[f64; 3]> {
    per_copy.vectors(&format!("loads[{number}]"), body.copies).into_iter().map(Into::into).collect()
}

/// Whether a load ever pushes.
pub(super) fn has_weight(load: &Load) -> bool {
    load.amplitude() != DVec3::ZERO
}

/// Chosen faces of the surface, by the nodes they load, and how much they count in each copy.
fn face_corners(body: &BodyParts, places: &[usize], factors: Option<&[[f64; 3]]>) -> FaceCorners {
    let mut corners = corners_of(body, places.iter().map(|&place| &body.placed.surface()[place])).0;
    if let Some(factors) = factors {
        // a pressure has one number, the same along all axes
        let rows: Vec<u32> = corners.faces.iter().map(|face| face[0]).collect();
        let of_faces = body.of_rows(&rows, factors);
        corners.weights.iter_mut().zip(of_faces).for_each(|(weight, [factor, ..])| *weight *= factor);
        corners.factors = body.of_rows(&corners.rows, factors);
    }
    corners
}

/// Faces by the nodes they load, and for each flat one which of them it is of.
pub(super) fn corners_of<'a>(
    body: &BodyParts,
    faces: impl Iterator<Item = &'a SurfaceFace>,
) -> (FaceCorners, Vec<u32>) {
    let mut corners = FaceCorners::default();
    let mut of_part = Vec::new();
    let mut by_node: Vec<(u32, u32)> = Vec::new();
    for (place, face, (nodes, weight)) in
        (0..).zip(faces).flat_map(|(place, face)| parts(face).map(move |part| (place, face, part)))
    {
        of_part.push(place);
        let number = corners.faces.len() as u32;
        let count = CellKind::of_face(&nodes).node_count();
        let points = nodes.map(|node| body.placed.mesh.points[node as usize]);
        let nodes = nodes.map(|node| body.node_rows[node as usize]);
        for (corner, &node) in nodes.iter().enumerate().take(count) {
            by_node.push((node, 4 * number + corner as u32));
        }
        corners.faces.push(nodes);
        corners.weights.push(weight);
        corners.elements.push(body.element_rows[face.element as usize]);
        corners.areas.push(corner_areas(&points, count == 3).map(|area| weight * area));
    }
    by_node.sort_unstable();
    for (node, corner) in by_node {
        if corners.rows.last() != Some(&node) {
            corners.rows.push(node);
            corners.starts.push(corners.corners.len() as u32);
        }
        corners.corners.push(corner);
    }
    corners.starts.push(corners.corners.len() as u32);
    corners.alive.change(|marks| marks.resize(corners.faces.len(), 1));
    (corners, of_part)
}

/// The flat faces that a face is loaded as, each with its weight: itself, or of one with middles its four facets, 4/3
/// each, and the triangle of its corners, −1/3.
///
/// The chord of a parabola leaves out two thirds of base times height, two chords leave out a quarter of that: so
/// weighted, area vectors are exactly those of the curved face, and pressure is the derivative of a volume, of no total
/// force and moment on a closed surface. On a flat face with straight edges a third of the area falls to each middle
/// and none to a corner, as ∫ N_a dA has it.
fn parts(face: &SurfaceFace) -> impl Iterator<Item = ([u32; 4], f64)> + use<> {
    let curved = face.middles.is_some();
    let weight = if curved { 4.0 / 3.0 } else { 1.0 };
    face.facets().map(move |facet| (facet, weight)).chain(curved.then_some((face.nodes, -1.0 / 3.0)))
}

/// ∫ N_a dA of each corner (m²): a third of a triangle; 2×2 Gauss points for a quadrilateral, exact when it is flat.
fn corner_areas(points: &[DVec3; 4], triangle: bool) -> [f64; 4] {
    if triangle {
        let third = (points[1] - points[0]).cross(points[2] - points[0]).length() / 6.0;
        return [third, third, third, 0.0];
    }
    let signs = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0_f64]];
    let mut areas = [0.0; 4];
    for gauss in signs {
        let [x, y] = gauss.map(|sign| sign / 3.0_f64.sqrt());
        let by = |weight: &dyn Fn([f64; 2]) -> f64| -> DVec3 { (0..4).map(|b| points[b] * weight(signs[b])).sum() };
        let area = by(&|s| s[0] * (1.0 + s[1] * y) / 4.0).cross(by(&|s| s[1] * (1.0 + s[0] * x) / 4.0)).length();
        for a in 0..4 {
            areas[a] += area * (1.0 + signs[a][0] * x) * (1.0 + signs[a][1] * y) / 4.0;
        }
    }
    areas
}
