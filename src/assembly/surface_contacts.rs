//! Surfaces that meet: which, and how.

use super::contacts::{bounds, edge, reference, settling, spring_of};
use super::{Assembly, BodyParts, PlacedMesh};
use crate::components::*;
use crate::contact::face_points;
use crate::mesh::SurfaceFace;
use crate::scene::SceneFile;
use crate::scene::schema::{Attachment, Contact, Points};
use crate::systems::{Meeting, SurfaceContacts};
use bevy_ecs::prelude::*;
use glam::DVec3;

/// Edges that differ by less are alike: those of a body that is placed twice differ by rounding.
const ALIKE: f64 = 1e-9;

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
    contacts.edges = edges(&meeting);
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
            let (friction, spring) = (contact.friction(), spring_of(contact, scene));
            let edge = f64::min(contacts.edges[a], contacts.edges[b]);
            let settling = [a, b].map(|of| settling(meeting[of].1, edge, world)).into_iter().fold(0.0, f64::max);
            let (thickness, edges) = (*thickness, *edges);
            contacts.meet([a, b], Meeting { friction, thickness, faces, edges, spring, edge, settling });
        }
    }
    let corners: Vec<DVec3> =
        meeting.iter().flat_map(|(_, body)| <[DVec3; 2]>::from(bounds(&body.placed.mesh.points))).collect();
    contacts.reference = reference(&corners);
    contacts.edge = contacts.edges.iter().copied().fold(f64::INFINITY, f64::min);
    for (number, (name, body)) in meeting.iter().enumerate() {
        let zeros = |rows: usize, numbers: usize| Reals::zeros(assembly.precision, numbers * rows);
        let nodes = body.node_rows.len();
        let columns = (ContactForce(zeros(nodes, 3)), SurfaceTouch(zeros(nodes, MEETING_NUMBERS)));
        world.entity_mut(body.entity).insert(columns).insert(Meets(met_by(&contacts, number)));
        if contacts.has_face_points(number) {
            let counted = |facet: [u32; 4]| (facet, face_points(facet).len());
            let points = if scene.may_lose_elements(name) {
                let faces = body.placed.mesh.faces_and_opposites(u32::MAX);
                let places = FacePlaces::of(faces.iter().flat_map(|(face, _)| face.facets()).map(counted));
                let points = places.points();
                world.entity_mut(body.entity).insert(places);
                points
            } else {
                let facets = body.placed.surface().iter().flat_map(SurfaceFace::facets);
                facets.map(|facet| counted(facet).1).sum()
            };
            world.entity_mut(body.entity).insert(FaceTouch(zeros(points, MEETING_NUMBERS)));
        }
    }
    world.insert_resource(contacts);
}

/// The bodies that are kept away from one, by its place among all, and how it meets them.
fn met_by(contacts: &SurfaceContacts, number: usize) -> Vec<Met> {
    let of_body = |body: Entity| {
        let other = contacts.bodies.iter().position(|of| *of == body)?;
        let Meeting { thickness, faces, edge, spring, .. } = contacts.meetings[number * contacts.bodies.len() + other]?;
        Some(Met { body, thickness, faces, spring: spring.is_some(), edge_of_body: contacts.edges[other], edge })
    };
    contacts.met_by(number).into_iter().filter_map(of_body).collect()
}

/// The lengths of an edge of bodies (m), of such as are alike the smallest.
fn edges(bodies: &[(&String, &BodyParts)]) -> Vec<f64> {
    let all: Vec<f64> = bodies.iter().map(|(_, body)| edge(body)).collect();
    let smallest = |of: &f64| all.iter().copied().filter(|other| *other >= (1.0 - ALIKE) * of).fold(*of, f64::min);
    all.iter().map(smallest).collect()
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
            let body = assembly.scene.scene.body_meant(body)?;
            Some((contact, [body, body]))
        }
    }
}
