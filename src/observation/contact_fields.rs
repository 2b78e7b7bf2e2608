//! What nodes feel of what touches them, as fields and for probes: force, traction, pressure, area, gap, slip.

mod present;

use crate::backend::device::bring_to_host;
use crate::components::*;
use crate::contact::face_points;
use crate::error::Error;
use crate::scene::schema::{OutputField, Quantity};
use bevy_ecs::prelude::*;
use glam::DVec3;

/// A face counts for the area that a force presses on where the cosine of the angle between the force and its inwards
/// normal is above this (60°): of the faces around an edge those that are turned to what touches.
const PRESSED: f64 = 0.5;

/// Forces are rounding that are no larger than this, of the largest on the body: f32 knows seven digits.
const ROUNDING: f64 = 1e-6;

/// What touches each node of a body (N), in the author's order: other bodies, itself, tools.
///
/// # Errors
/// What the GPU says.
pub(super) fn contact_forces(body: Entity, world: &mut World) -> Result<Vec<DVec3>, Error> {
    bring_to_host(world, |_, name| [ContactForce::NAME, ToolTouch::NAME, ToolHold::NAME].contains(&name))?;
    let entity = world.entity(body);
    let Some(authoring) = entity.get::<Authoring>() else { return Ok(Vec::new()) };
    let count = authoring.node_rows.len();
    let mut forces = match entity.get::<ContactForce>() {
        Some(forces) => forces.vectors().collect(),
        None => vec![DVec3::ZERO; count],
    };
    if let (Some(contacts), Some(touch)) = (entity.get::<ToolContacts>(), entity.get::<ToolTouch>()) {
        for (place, &row) in contacts.rows.iter().enumerate() {
            let first = contacts.numbers() * place;
            let of_tool = |tool: usize| touch.vector_at(first + contacts.numbers_a_tool() * tool);
            forces[row as usize] += (0..contacts.tools.len()).map(of_tool).sum::<DVec3>();
        }
    }
    super::grasps::forces(entity, &mut forces);
    super::free_tools::add_forces(world, body, &mut forces);
    Ok(authoring.node_rows.iter().map(|&row| forces[row as usize]).collect())
}

/// A flat polygon of a surface as it is.
struct FacetNow {
    /// The author's nodes of its corners, as many as it has.
    nodes: Vec<usize>,
    /// What each has of its area, along its outwards normal (m²): a third of a triangle, a quarter of a quadrilateral.
    share: DVec3,
    /// The facet with all four corners; a triangle repeats the last one.
    facet: [u32; 4],
    /// Length of its first edge (m).
    edge: f64,
    /// Half of how far its element reaches behind it at rest (m).
    depth: f64,
}

/// The exposed surface of a body as it is.
fn surface_now(body: Entity, world: &mut World) -> Result<Vec<FacetNow>, Error> {
    bring_to_host(world, |_, name| name == Displacement::NAME || name == Alive::NAME)?;
    let entity = world.entity(body);
    let (Some(authoring), Some(rest), Some(u)) =
        (entity.get::<Authoring>(), entity.get::<RestPosition>(), entity.get::<Displacement>())
    else {
        return Ok(Vec::new());
    };
    let alive = |block: u32, row: u32| {
        let alive = world.get::<Alive>(authoring.blocks[block as usize]);
        alive.is_none_or(|alive| alive[row as usize] == 1)
    };
    let place = |node: u32| {
        let row = authoring.node_rows[node as usize] as usize;
        rest.0[row] + u.vector(row)
    };
    let at_rest = |node: u32| rest.0[authoring.node_rows[node as usize] as usize];
    let depth = |facet: [u32; 4], element: u32| {
        let [a, b, c, _] = facet.map(at_rest);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let behind = authoring.cells.nodes(element as usize).iter().map(|&node| normal.dot(a - at_rest(node)));
        0.5 * behind.fold(0.0, f64::max)
    };
    let now = |(facet, element): ([u32; 4], u32)| {
        let [a, b, c, d] = facet.map(place);
        let corners = if facet[2] == facet[3] { 3 } else { 4 };
        let area = 0.5 * ((b - a).cross(c - a) + (c - a).cross(d - a));
        let nodes = facet[..corners].iter().map(|&node| node as usize).collect();
        let (share, edge) = (area / corners as f64, a.distance(b));
        FacetNow { nodes, share, facet, edge, depth: depth(facet, element) }
    };
    let faces = authoring.surface(alive);
    Ok(faces.iter().flat_map(|face| face.facets().map(move |facet| (facet, face.element))).map(now).collect())
}

/// The same over the area of the surface around each node as it is (Pa): a third of its triangles, a quarter of its
/// quadrilaterals.
fn tractions(forces: Vec<DVec3>, surface: &[FacetNow]) -> Vec<DVec3> {
    let mut areas = vec![0.0; forces.len()];
    for facet in surface {
        facet.nodes.iter().for_each(|&node| areas[node] += facet.share.length());
    }
    let over = |(force, area): (DVec3, f64)| if area > 0.0 { force / area } else { DVec3::ZERO };
    forces.into_iter().zip(areas).map(over).collect()
}

/// Of each node, from the forces on nodes, the area that its force presses on (m²), along the mean normal of that: none
/// of what is no more than rounding of the largest force.
fn pressed(forces: &[DVec3], surface: &[FacetNow]) -> Vec<(f64, DVec3)> {
    let mut areas = vec![(0.0, DVec3::ZERO); forces.len()];
    let least = ROUNDING * forces.iter().map(|force| force.length()).fold(0.0, f64::max);
    for (facet, &node) in surface.iter().flat_map(|facet| facet.nodes.iter().map(move |node| (facet, node))) {
        let (force, size) = (forces[node], facet.share.length());
        if force.length() > least && -force.dot(facet.share) > PRESSED * force.length() * size {
            areas[node].0 += size;
            areas[node].1 += facet.share;
        }
    }
    areas
}

/// The part of a force into the surface that it presses on (N).
fn into_surface(force: DVec3, along: DVec3) -> f64 {
    -force.dot(along.normalize_or_zero())
}

/// Gap (m) of each node, in the author's order: as contact saw it in the step, else by the surfaces as they are, as far
/// as an edge is long on average; that where a node faces nothing so near.
fn gaps(body: Entity, surface: &[FacetNow], world: &mut World) -> Result<Vec<f64>, Error> {
    let nowhere = mean_edge(body, surface, world);
    let mut gaps: Vec<f64> = gaps_and_slips(body, surface, world)?.into_iter().map(|[gap, _]| gap).collect();
    present::find((body, surface), nowhere, &mut gaps, world)?;
    gaps.iter_mut().filter(|gap| gap.is_infinite()).for_each(|gap| *gap = nowhere);
    Ok(gaps)
}

/// Mean length of the edges of a body's surface as it is (m); of the one at rest where all of the body is gone.
fn mean_edge(body: Entity, surface: &[FacetNow], world: &World) -> f64 {
    let mean = |edges: Vec<f64>| edges.iter().sum::<f64>() / edges.len().max(1) as f64;
    let (Some(authoring), Some(rest), true) =
        (world.get::<Authoring>(body), world.get::<RestPosition>(body), surface.is_empty())
    else {
        return mean(surface.iter().map(|facet| facet.edge).collect());
    };
    let place = |node: u32| rest.0[authoring.node_rows[node as usize] as usize];
    let whole = authoring.surface(|_, _| true);
    let facets = whole.iter().flat_map(|face| face.facets());
    mean(facets.map(|[a, b, ..]| place(a).distance(place(b))).collect())
}

/// Gap (m) and length slid (m) of each node as contact has them, in the author's order; infinite where it faced nothing
/// that could touch in the step. Of points of faces the least gap and the longest length of those around a node: a mean
/// would follow which of them face anything, as those beyond an edge do at times.
fn gaps_and_slips(body: Entity, surface: &[FacetNow], world: &mut World) -> Result<Vec<[f64; 2]>, Error> {
    let wanted = [SurfaceTouch::NAME, FaceTouch::NAME, ToolTouch::NAME];
    bring_to_host(world, |entity, name| entity == body && wanted.contains(&name))?;
    let entity = world.entity(body);
    let Some(authoring) = entity.get::<Authoring>() else { return Ok(Vec::new()) };
    let count = authoring.node_rows.len();
    let mut found = vec![[f64::INFINITY, 0.0]; count];
    let mut add = |node: usize, touch: &Reals, first: usize| {
        let [gap, slid] = &mut found[node];
        if touch.get(first + 4) > 0.0 {
            *gap = gap.min(touch.get(first + 5));
        }
        *slid = slid.max(touch.get(first + 6));
    };
    if let Some(touch) = entity.get::<FaceTouch>() {
        let counted = surface.iter().map(|of| (of.facet, face_points(of.facet).len()));
        let firsts = FacePlaces::firsts(entity.get::<FacePlaces>(), counted);
        let room = touch.len() / MEETING_NUMBERS;
        for (facet, first) in surface.iter().zip(firsts) {
            for (place, weights) in (first..room).zip(face_points(facet.facet)) {
                let of_point = MEETING_NUMBERS * place;
                let around = facet.nodes.iter().zip(weights).filter(|(_, weight)| **weight > 0.0);
                around.for_each(|(&node, _)| add(node, touch, of_point));
            }
        }
    }
    if let Some(touch) = entity.get::<SurfaceTouch>() {
        for (node, &row) in authoring.node_rows.iter().enumerate() {
            add(node, touch, MEETING_NUMBERS * row as usize);
        }
    }
    let mut slid = vec![0.0; count];
    if let (Some(contacts), Some(touch)) = (entity.get::<ToolContacts>(), entity.get::<ToolTouch>()) {
        for (place, &row) in contacts.rows.iter().enumerate() {
            let first = contacts.numbers() * place;
            let of_tool = |tool: usize| touch.get(first + contacts.numbers_a_tool() * tool + 4);
            slid[row as usize] = (0..contacts.tools.len()).map(of_tool).sum();
        }
    }
    super::free_tools::add_slips(world, body, &mut slid);
    let of_node = |(node, &row): (usize, &u32)| {
        let [gap, longest] = found[node];
        [gap, longest + slid[row as usize]]
    };
    Ok(authoring.node_rows.iter().enumerate().map(of_node).collect())
}

/// A field of contact of a body's nodes in the author's order, its numbers one after the other.
///
/// # Errors
/// What the GPU says.
pub(super) fn contact_field(field: OutputField, body: Entity, world: &mut World) -> Result<Vec<f64>, Error> {
    let forces = contact_forces(body, world)?;
    let flat = |vectors: Vec<DVec3>| vectors.into_iter().flat_map(|vector| vector.to_array()).collect();
    if field == OutputField::ContactForce {
        return Ok(flat(forces));
    }
    let surface = surface_now(body, world)?;
    Ok(match field {
        OutputField::ContactTraction => flat(tractions(forces, &surface)),
        OutputField::ContactArea => pressed(&forces, &surface).into_iter().map(|(area, _)| area).collect(),
        OutputField::ContactPressure => {
            let pressure = |(force, (area, along)): (DVec3, (f64, DVec3))| {
                if area > 0.0 { into_surface(force, along) / area } else { 0.0 }
            };
            let pressed = pressed(&forces, &surface);
            forces.into_iter().zip(pressed).map(pressure).collect()
        }
        OutputField::ContactGap => gaps(body, &surface, world)?,
        _ => gaps_and_slips(body, &surface, world)?.into_iter().map(|[_, slip]| slip).collect(),
    })
}

/// What a probe sees of what touches its nodes.
///
/// # Errors
/// What the GPU says.
pub(super) fn of_probe(world: &mut World, body: Entity, probe: &Probe) -> Result<Vec<f64>, Error> {
    let Some(authoring) = world.get::<Authoring>(body) else { return Ok(Vec::new()) };
    let mut nodes = vec![false; authoring.node_rows.len()];
    probe.nodes.iter().for_each(|&row| nodes[row as usize] = true);
    let is_one: Vec<bool> = authoring.node_rows.iter().map(|&row| nodes[row as usize]).collect();
    let forces = contact_forces(body, world)?;
    let surface = surface_now(body, world)?;
    let of_nodes = |node: &usize| is_one[*node];
    let all = || (0..is_one.len()).filter(of_nodes);
    if probe.what == Quantity::ContactForce {
        return Ok(all().map(|node| forces[node]).sum::<DVec3>().to_array().to_vec());
    }
    if matches!(probe.what, Quantity::ContactPressure | Quantity::ContactArea) {
        let pressed = pressed(&forces, &surface);
        let area: f64 = all().map(|node| pressed[node].0).sum();
        let force: f64 = all().map(|node| into_surface(forces[node], pressed[node].1)).sum();
        let pressure = if area > 0.0 { force / area } else { 0.0 };
        return Ok(vec![if probe.what == Quantity::ContactArea { area } else { pressure }]);
    }
    if probe.what == Quantity::ContactGap {
        let gaps = gaps(body, &surface, world)?;
        return Ok(vec![all().map(|node| gaps[node]).fold(f64::INFINITY, f64::min)]);
    }
    let found = gaps_and_slips(body, &surface, world)?;
    let count = all().count().max(1) as f64;
    Ok(vec![all().map(|node| found[node][1]).sum::<f64>() / count])
}
