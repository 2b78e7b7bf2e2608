//! How surfaces that meet stand to each other before the first step: what is inside another body, or another part of
//! its own, and where parts of one body are so near each other at rest that they never meet.

use super::{Assembly, BodyParts};
use crate::components::*;
use crate::contact::{TURNED_AWAY, Tree};
use crate::math::coordinates;
use crate::mesh::{Locator, Mesh, OnTriangle};
use crate::scene::diagnostic::Diagnostics;
use crate::scene::schema::Contact;
use crate::skins::normals;
use crate::systems::SurfaceContacts;
use bevy_ecs::prelude::*;
use glam::DVec3;
use std::collections::BTreeMap;

/// How deep points may be inside another body at the start, in edges of that: those come out by and by, and are seen.
const DEEPEST: f64 = 0.5;

/// How far below its surface, as a share of the way to the middle of its element, a node is that does not only touch.
const BELOW: f64 = 0.05;

/// Nodes that a complaint names.
const NAMED: usize = 10;

/// Looks for nodes that are inside another body, or another part of their own, at the start, and tells whether there
/// are some: deep ones are an error. Nodes of one that never meet what is near them at rest are told, too.
pub(super) fn check(assembly: &Assembly<'_>, world: &World, diagnostics: &mut Diagnostics) -> bool {
    let Some(contacts) = world.get_resource::<SurfaceContacts>() else { return false };
    let mut are_inside = false;
    let body = |name: &String| assembly.bodies.get(name);
    let place = |of: &BodyParts| contacts.bodies.iter().position(|body| *body == of.entity);
    let edge = |of: &BodyParts| place(of).map_or(contacts.edge, |place| contacts.edges[place]);
    for (number, contact) in assembly.scene.scene.contacts.iter().enumerate() {
        match contact {
            Contact::Tool { .. } => {}
            Contact::Between { bodies: (a, b), thickness, .. } => {
                let (Some(of_a), Some(of_b)) = (body(a), body(b)) else { continue };
                let [one, other] = [of_a, of_b].map(|body| Outside::new(body, at_start(body, world)));
                let [edge_of_a, edge_of_b] = [of_a, of_b].map(edge);
                let path = format!("contacts[{number}].bodies");
                let pairs = [([(a, &one), (b, &other)], edge_of_b), ([(b, &other), (a, &one)], edge_of_a)];
                for (pair, edge) in pairs {
                    are_inside |=
                        overlap(pair, edge, &path, diagnostics) || too_near(pair, edge, *thickness, &path, diagnostics);
                }
            }
            Contact::Itself { body: named, .. } => {
                let Some(name) = named.as_ref().or(assembly.bodies.keys().next()) else { continue };
                let Some(of) = body(name) else { continue };
                let path = format!("contacts[{number}]");
                let outside = Outside::new(of, at_start(of, world));
                are_inside |= overlap([(name, &outside), (name, &outside)], edge(of), &path, diagnostics);
                if let Some(near) = place(of).and_then(|place| contacts.near_at_rest(place)) {
                    narrow_gaps(name, &Outside::new(of, of.placed.mesh.clone()), near, &path, diagnostics);
                }
            }
        }
    }
    are_inside
}

/// A body's mesh with its nodes where they start.
pub(super) fn at_start(body: &BodyParts, world: &World) -> Mesh {
    let mut mesh = body.placed.mesh.clone();
    if let Some(u) = world.get::<Displacement>(body.entity) {
        let moved = mesh.points.iter_mut().zip(&body.node_rows);
        moved.for_each(|(point, &row)| *point += u.vector(row as usize));
    }
    mesh
}

/// A body's surface at some moment, and what is behind it.
struct Outside {
    mesh: Mesh,
    /// Its nodes, each with an element that has a face there.
    nodes: BTreeMap<u32, u32>,
    triangles: Vec<[u32; 3]>,
    /// Of all nodes of the mesh, outwards.
    normals: Vec<DVec3>,
    /// Of all nodes of the mesh the pieces that they are of.
    pieces: Vec<u32>,
    tree: Tree,
}

impl Outside {
    /// Of a body whose nodes are where those of the mesh are.
    fn new(body: &BodyParts, mesh: Mesh) -> Self {
        let faces = body.placed.surface();
        let nodes = faces.iter().flat_map(|face| face.all_nodes().map(|node| (node, face.element))).collect();
        let triangles: Vec<[u32; 3]> = faces.iter().flat_map(|face| face.triangles()).collect();
        let corners = |number: u32| triangles[number as usize].map(|node| mesh.points[node as usize]);
        let tree = Tree::new(0..triangles.len() as u32, corners);
        let pieces = mesh.cells.pieces_of_nodes(mesh.points.len());
        Self { nodes, normals: normals(&mesh.points, &triangles), pieces, tree, triangles, mesh }
    }

    fn at(&self, node: u32) -> DVec3 {
        self.mesh.points[node as usize]
    }

    /// Goes through the triangles near a place (m): their nodes, their normals, and the places of theirs nearest to it.
    fn near(&self, at: DVec3, radius: f64, mut found: impl FnMut([u32; 3], DVec3, DVec3)) {
        self.tree.near(at, radius, |number| {
            let nodes = self.triangles[number as usize];
            let corners @ [a, b, c] = nodes.map(|node| self.at(node));
            found(nodes, (b - a).cross(c - a).normalize_or_zero(), OnTriangle::nearest(at, corners).at);
        });
    }

    /// The nodes that are inside another body, or another part of their own, and how deep (m, infinite beyond
    /// `deepest`), the deepest first; those that only touch are left out, but where bodies are in the same place.
    fn inside(&self, other: &Outside, deepest: f64, touching: f64) -> Vec<(f64, u32)> {
        let itself = std::ptr::eq(self, other);
        let locator = Locator::new(&other.mesh);
        let holds = |node: u32, at: DVec3| {
            locator.holds_among(at, |element| !itself || !other.mesh.element(element).contains(&node)).is_some()
        };
        let depth = |node: u32| {
            let (at, mut depth) = (self.at(node), f64::INFINITY);
            other.near(at, deepest, |nodes, normal, nearest| {
                // around a node is its own part of the surface
                let own = itself && (nodes.contains(&node) || normal.dot(self.normals[node as usize]) >= TURNED_AWAY);
                if !own {
                    depth = depth.min(at.distance(nearest));
                }
            });
            depth
        };
        let below = |node: u32, element: u32| {
            let nodes = self.mesh.element(element as usize);
            self.at(node).lerp(nodes.iter().map(|&node| self.at(node)).sum::<DVec3>() / nodes.len() as f64, BELOW)
        };
        let inside: Vec<(u32, u32)> =
            self.nodes.iter().map(|(a, b)| (*a, *b)).filter(|&(node, _)| holds(node, self.at(node))).collect();
        let within = inside.iter().filter(|&&(node, element)| holds(node, below(node, element))).count();
        let same = 2 * within > self.nodes.len();
        let mut found: Vec<(f64, u32)> = inside.iter().map(|&(node, _)| (depth(node), node)).collect();
        found.retain(|(depth, _)| same || *depth > touching);
        found.sort_by(|a, b| b.0.total_cmp(&a.0));
        found
    }

    /// The nodes that are so near (m) to another body, and how near, the nearest first.
    fn nearer(&self, other: &Outside, near: f64) -> Vec<(f64, u32)> {
        if near <= 0.0 {
            return Vec::new();
        }
        let distance = |node: u32| {
            let (at, mut distance) = (self.at(node), f64::INFINITY);
            other.near(at, near, |_, _, nearest| distance = distance.min(at.distance(nearest)));
            distance
        };
        let mut found: Vec<(f64, u32)> = self.nodes.keys().map(|&node| (distance(node), node)).collect();
        found.retain(|(distance, _)| *distance < near);
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        found
    }

    /// The nodes that are so near (m) in front of a face of another part of the same body that looks back at them, and
    /// how near, the nearest first.
    fn narrow(&self, near: f64) -> Vec<(f64, u32)> {
        let gap = |node: u32| {
            let (at, mut gap) = (self.at(node), f64::INFINITY);
            self.near(at, near, |nodes, normal, nearest| {
                let of_piece = self.pieces[nodes[0] as usize] == self.pieces[node as usize];
                let looks_back = of_piece && normal.dot(self.normals[node as usize]) < 0.0;
                // what is behind a thin body is no gap; rounding is nothing
                if looks_back && !nodes.contains(&node) && normal.dot(at - nearest) >= -1e-6 * near {
                    gap = gap.min(at.distance(nearest));
                }
            });
            gap
        };
        let gaps = self.nodes.keys().map(|&node| (gap(node), node));
        let mut found: Vec<(f64, u32)> = gaps.filter(|(gap, _)| *gap <= near).collect();
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        found
    }

    /// How a complaint names nodes: how many there are, and the first of them by their numbers.
    fn told(&self, found: &[(f64, u32)]) -> (String, String) {
        let ids = &self.mesh.point_ids;
        let mut named: Vec<String> =
            found.iter().take(NAMED).map(|&(_, node)| ids.of(node as usize).to_string()).collect();
        if found.len() > NAMED {
            named.push("...".into());
        }
        let many = if found.len() == 1 { "a node".to_string() } else { format!("{} nodes", found.len()) };
        (many, format!("nodes: {}", named.join(", ")))
    }
}

/// Tells of nodes of one body inside another, whose faces have edges of such a length (m), and whether there are some.
fn overlap(
    [(of, one), (inside, other)]: [(&String, &Outside); 2],
    edge: f64,
    path: &str,
    diagnostics: &mut Diagnostics,
) -> bool {
    let found = one.inside(other, DEEPEST * edge, 1e-3 * edge);
    let Some(&(deepest, _)) = found.first() else { return false };
    let (many, nodes) = one.told(&found);
    let is = if found.len() == 1 { "is" } else { "are" };
    let place = if of == inside { "other parts of it".to_string() } else { format!("`{inside}`") };
    let deep = found.iter().filter(|(depth, _)| *depth > DEEPEST * edge).count();
    let most = 2 * found.len() > one.nodes.len();
    let same = "more than half of the nodes of its surface are: they would not know which way out";
    if deep > 0 || most {
        let message = format!("{many} of `{of}` {is} inside {place} at the start, {deep} of them deep");
        let out =
            format!("up to half an edge of a face, {:.3e} m, is pushed out: move one apart so far", DEEPEST * edge);
        diagnostics.error_at(path, message).note(nodes).notes(most.then(|| same.to_string())).note(out);
    } else {
        let message = format!("{many} of `{of}` {is} inside {place} at the start, the deepest by {deepest:.3e} m");
        diagnostics.warn_at(path, message).note(nodes).note("they are pushed out while a wave goes through the body");
    }
    true
}

/// Tells of nodes of one body that are nearer to another, whose faces have edges of such a length (m), than the
/// thickness (m) between them, and whether there are some: those are pushed apart, like what is inside.
fn too_near(
    [(of, one), (to, other)]: [(&String, &Outside); 2],
    edge: f64,
    thickness: f64,
    path: &str,
    diagnostics: &mut Diagnostics,
) -> bool {
    let found = one.nearer(other, thickness - 1e-3 * edge);
    let Some(&(nearest, _)) = found.first() else { return false };
    let (many, nodes) = one.told(&found);
    let is = if found.len() == 1 { "is" } else { "are" };
    let message = format!(
        "{many} of `{of}` {is} nearer to `{to}` at the start than the `thickness` of {thickness:.3e} m, the nearest by \
         {:.3e} m",
        thickness - nearest
    );
    if thickness - nearest > DEEPEST * edge {
        diagnostics
            .error_at(path, message)
            .note(nodes)
            .note(format!("up to half an edge of a face, {:.3e} m, is pushed apart", DEEPEST * edge));
    } else {
        diagnostics.warn_at(path, message).note(nodes).note("they are pushed apart while a wave goes through the body");
    }
    true
}

/// Tells which nodes of a body never meet what they are in front of, because that is so near (m) at rest.
fn narrow_gaps(name: &str, rest: &Outside, near: f64, path: &str, diagnostics: &mut Diagnostics) {
    let found = rest.narrow(near);
    let Some(&(gap, node)) = found.first() else { return };
    let (many, nodes) = rest.told(&found);
    let (are, they, them) = if found.len() == 1 { ("is", "it", "it") } else { ("are", "they", "them") };
    let at = coordinates(rest.at(node), near);
    diagnostics
        .warn_at(
            path,
            format!(
                "{many} of `{name}` {are} within {near:.3e} m of other parts of its surface at rest: {they} never \
                 meet what is so near {them} then"
            ),
        )
        .note(nodes)
        .note(format!("the narrowest gap, {gap:.3e} m, is at ({at}) m"))
        .note("1.5 times the `thickness` and a hundredth of an edge counts as near");
}
