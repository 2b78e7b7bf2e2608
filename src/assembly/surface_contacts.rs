//! Surfaces that meet: which, and whether they are in each other at the start.

use super::contacts::{bounds, edge, reference, settling, spring_of};
use super::{Assembly, BodyParts, PlacedMesh};
use crate::components::*;
use crate::contact::{Surfaces, Tree, face_points};
use crate::mesh::{Locator, Mesh, SurfaceFace};
use crate::scene::SceneFile;
use crate::scene::diagnostic::Diagnostics;
use crate::scene::schema::{Attachment, Contact, Points};
use crate::systems::{Meeting, SurfaceContacts};
use bevy_ecs::prelude::*;
use glam::DVec3;

/// How deep points may be inside another body at the start, in edges: those come out by and by.
const DEEPEST: f64 = 0.5;

/// Nodes that a complaint names.
const NAMED: usize = 10;

/// Notes which bodies may meet, if there are some.
pub(super) fn spawn(assembly: &Assembly<'_>, world: &mut World) {
    let scene = &assembly.scene.scene;
    let pairs: Vec<(&Contact, [&String; 2])> =
        scene.contacts.iter().filter_map(|contact| bodies(assembly, contact)).collect();
    let meets = |name: &String| pairs.iter().any(|(_, pair)| pair.contains(&name));
    let meeting: Vec<(&String, &BodyParts)> = assembly.bodies.iter().filter(|(name, _)| meets(name)).collect();
    if meeting.is_empty() {
        return;
    }
    let mut contacts = SurfaceContacts::new(meeting.iter().map(|(_, body)| body.entity).collect());
    let place = |name: &String| meeting.iter().position(|(other, _)| *other == name);
    for (contact, pair) in pairs {
        let (Contact::Between { thickness, sweeps, points, edges, .. }
        | Contact::Itself { thickness, sweeps, points, edges, .. }) = contact
        else {
            continue;
        };
        contacts.sweeps = contacts.sweeps.max(*sweeps as usize);
        if let [Some(a), Some(b)] = pair.map(place) {
            let faces = *points == Points::Faces;
            let (friction, spring) = (contact.friction(), spring_of(contact.law()));
            contacts.meet([a, b], Meeting { friction, thickness: *thickness, faces, edges: *edges, spring });
        }
    }
    let corners: Vec<DVec3> =
        meeting.iter().flat_map(|(_, body)| <[DVec3; 2]>::from(bounds(&body.placed.mesh.points))).collect();
    contacts.reference = reference(&corners);
    contacts.edge = meeting.iter().map(|(_, body)| edge(body)).fold(f64::INFINITY, f64::min);
    let speeds = meeting.iter().map(|(_, body)| settling(body, contacts.edge, world));
    contacts.settling = speeds.fold(0.0, f64::max);
    for (number, (_, body)) in meeting.iter().enumerate() {
        let zeros = |rows: usize, numbers: usize| Reals::zeros(assembly.precision, numbers * rows);
        let nodes = body.node_rows.len();
        let columns = (ContactForce(zeros(nodes, 3)), SurfaceTouch(zeros(nodes, MEETING_NUMBERS)));
        world.entity_mut(body.entity).insert(columns);
        if contacts.has_face_points(number) {
            let surface = body.placed.surface();
            let points = surface.iter().flat_map(SurfaceFace::facets).map(|facet| face_points(facet).len()).sum();
            world.entity_mut(body.entity).insert(FaceTouch(zeros(points, MEETING_NUMBERS)));
        }
    }
    world.insert_resource(contacts);
}

/// The author's nodes of a body's surface that no patch moves by itself, ascending: where it may meet others or is tied
/// to one, and the surface stays the same.
pub(super) fn apart(scene: &SceneFile, name: &str, placed: &PlacedMesh) -> Vec<u32> {
    let scene = &scene.scene;
    let meets = |contact: &Contact| match contact {
        Contact::Tool { .. } => false,
        Contact::Between { bodies: (a, b), .. } => a == name || b == name,
        Contact::Itself { body, .. } => body.as_ref().is_none_or(|body| body == name),
    };
    let ties = |attachment: &Attachment| match attachment {
        Attachment::Glue { .. } | Attachment::Tie { .. } => attachment.holds(name),
        Attachment::Grasp { .. } | Attachment::Suture { .. } => false,
    };
    let is_apart = scene.contacts.iter().any(meets) || scene.attachments.iter().any(ties);
    if !is_apart || scene.may_lose_elements(name) {
        return Vec::new();
    }
    let mut nodes: Vec<u32> = placed.surface().iter().flat_map(SurfaceFace::all_nodes).collect();
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

/// The bodies whose surfaces a contact is between.
fn bodies<'a>(assembly: &'a Assembly<'_>, contact: &'a Contact) -> Option<(&'a Contact, [&'a String; 2])> {
    match contact {
        Contact::Tool { .. } => None,
        Contact::Between { bodies: (a, b), .. } => Some((contact, [a, b])),
        Contact::Itself { body, .. } => {
            let body = body.as_ref().or(assembly.bodies.keys().next())?;
            Some((contact, [body, body]))
        }
    }
}

/// Looks for nodes of one body that are inside another at the start: deep ones are an error.
pub(super) fn check(assembly: &Assembly<'_>, world: &World, diagnostics: &mut Diagnostics) {
    let Some(contacts) = world.get_resource::<SurfaceContacts>() else { return };
    for (number, contact) in assembly.scene.scene.contacts.iter().enumerate() {
        let Contact::Between { bodies: (a, b), .. } = contact else { continue };
        let path = format!("contacts[{number}].bodies");
        for [of, inside] in [[a, b], [b, a]] {
            overlap(assembly, world, (of, inside), contacts.edge, &path, diagnostics);
        }
    }
}

/// A body's mesh with its nodes where they start.
fn at_start(body: &BodyParts, world: &World) -> Mesh {
    let mut mesh = body.placed.mesh.clone();
    if let Some(u) = world.get::<Displacement>(body.entity) {
        let moved = mesh.points.iter_mut().zip(&body.node_rows);
        moved.for_each(|(point, &row)| *point += u.vector(row as usize));
    }
    mesh
}

fn overlap(
    assembly: &Assembly<'_>,
    world: &World,
    (of, other): (&String, &String),
    edge: f64,
    path: &str,
    diagnostics: &mut Diagnostics,
) {
    let (Some(of_body), Some(other_body)) = (assembly.bodies.get(of), assembly.bodies.get(other)) else { return };
    let (mesh, solid) = (at_start(of_body, world), at_start(other_body, world));
    let locator = Locator::new(&solid);
    let mut nodes: Vec<u32> = of_body.placed.surface().iter().flat_map(SurfaceFace::all_nodes).collect();
    nodes.sort_unstable();
    nodes.dedup();
    let inside: Vec<u32> =
        nodes.iter().copied().filter(|&node| locator.holds(mesh.points[node as usize]).is_some()).collect();
    if inside.is_empty() {
        return;
    }
    let triangles: Vec<[u32; 3]> = other_body.placed.surface().iter().flat_map(|face| face.triangles()).collect();
    let surfaces = Surfaces::new(solid.points.len(), triangles.clone(), vec![0; triangles.len()], Vec::new());
    let tree = Tree::new(0..triangles.len() as u32, |triangle| surfaces.corners(&solid.points, triangle));
    // none within the depth that comes out by itself: deeper
    let depth = |node: u32| {
        let (at, mut nearest) = (mesh.points[node as usize], f64::INFINITY);
        tree.near(at, DEEPEST * edge, |triangle| {
            let found = crate::math::OnTriangle::nearest(at, surfaces.corners(&solid.points, triangle));
            nearest = nearest.min(at.distance(found.at));
        });
        nearest
    };
    let mut found: Vec<(f64, u32)> = inside.iter().map(|&node| (depth(node), node)).collect();
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    // what only touches is not inside, but for bodies in the same place
    let same = 2 * found.len() > nodes.len();
    found.retain(|(depth, _)| same || *depth > 1e-3 * edge);
    let Some(&(deepest, _)) = found.first() else { return };
    let many = |count: usize| if count == 1 { "a node".to_string() } else { format!("{count} nodes") };
    let is = if found.len() == 1 { "is" } else { "are" };
    let ids = &of_body.placed.mesh.point_ids;
    let mut named: Vec<String> = found.iter().take(NAMED).map(|&(_, node)| ids.of(node as usize).to_string()).collect();
    if found.len() > NAMED {
        named.push("...".into());
    }
    let nodes_named = format!("nodes: {}", named.join(", "));
    let deep = found.iter().filter(|(depth, _)| *depth > DEEPEST * edge).count();
    if deep > 0 || 2 * found.len() > nodes.len() {
        let message =
            format!("{} of `{of}` {is} inside `{other}` at the start, {deep} of them deep", many(found.len()));
        diagnostics
            .error_at(path, message)
            .note(nodes_named)
            .note(format!("up to half an edge of a face, {:.3e} m, is pushed out", DEEPEST * edge));
    } else {
        let message = format!(
            "{} of `{of}` {is} inside `{other}` at the start, the deepest by {deepest:.3e} m",
            many(found.len())
        );
        diagnostics
            .warn_at(path, message)
            .note(nodes_named)
            .note("they are pushed out while a wave goes through the body");
    }
}
