//! Edges that cross, where the scene asks for them: which may be near which, and which cross now.

use super::survey::{MARGIN, NEAR_AT_REST};
use super::{Meeting, SurfaceContacts};
use crate::contact::{Crossing, Edge, Placed, Surfaces, distance};
use glam::DVec3;

/// Edges of surfaces, which may be near which, and which cross; all empty where no bodies meet with edges.
#[derive(Clone, Debug, Default)]
pub(super) struct Crossings {
    pub edges: Vec<Edge>,
    /// The edges that are sides of each triangle.
    sides: Vec<[u32; 3]>,
    /// Where nodes are at rest (m, from the reference).
    rest: Vec<DVec3>,
    /// Pairs that may be near each other, as long as the lists hold.
    pub near: Vec<[u32; 2]>,
    /// Pairs that cross.
    pub found: Vec<([u32; 2], Crossing)>,
}

impl Crossings {
    /// Of surfaces whose nodes are there at rest (m).
    pub fn of(surfaces: &Surfaces, rest: Vec<DVec3>) -> Self {
        let (edges, sides) = surfaces.edges();
        Self { edges, sides, rest, ..Self::default() }
    }

    /// Bytes that they take.
    pub fn bytes(&self) -> usize {
        let of_edges = size_of_val(&self.edges[..]) + size_of_val(&self.sides[..]) + size_of_val(&self.rest[..]);
        of_edges + size_of_val(&self.near[..]) + size_of_val(&self.found[..])
    }

    /// The triangles beside edges that may be near others.
    pub fn triangles(&self) -> impl Iterator<Item = u32> + '_ {
        self.near.iter().flatten().flat_map(|&edge| self.edges[edge as usize].triangles)
    }
}

impl SurfaceContacts {
    /// How edges of a body meet those of another, where they do.
    pub(super) fn crossing(&self, one: u32, other: u32) -> Option<Meeting> {
        self.meeting(one, other).filter(|meeting| meeting.edges)
    }
}

/// Finds all pairs of edges within a radius (m), and of such as go deeper as much beyond.
pub(super) fn list(contacts: &mut SurfaceContacts, radius: f64) {
    let mut crossings = std::mem::take(&mut contacts.surface.crossings);
    crossings.near.clear();
    let surface = &contacts.surface;
    let Crossings { edges, sides, rest, near, .. } = &mut crossings;
    let mut found = Vec::new();
    for (number, edge) in (0..).zip(&*edges) {
        let ends = |edge: &Edge, places: &[DVec3]| edge.nodes.map(|node| places[node as usize]);
        let of_edge = ends(edge, &surface.places);
        let (middle, half) = (of_edge[0].midpoint(of_edge[1]), 0.5 * of_edge[0].distance(of_edge[1]));
        found.clear();
        // each pair once
        for (body, tree) in (0..).zip(&surface.trees).skip(edge.body as usize) {
            let Some(meeting) = contacts.crossing(edge.body, body) else { continue };
            let itself = body == edge.body;
            let near_at_rest = NEAR_AT_REST * (meeting.thickness + MARGIN * meeting.edge);
            let [one, other] = [edge.body, body].map(|body| surface.beyond[body as usize]);
            let radius = radius + f64::min(one, other);
            tree.near(middle, radius + half, |triangle| {
                for other in sides[triangle as usize] {
                    let Some(met) = edges.get(other as usize).filter(|_| !itself || other > number) else { continue };
                    let [piece, of_met] = [edge, met].map(|of| surface.pieces.get(of.nodes[0] as usize));
                    let apart = itself
                        && piece == of_met
                        && (met.nodes.iter().any(|node| edge.nodes.contains(node))
                            || distance(ends(edge, rest), ends(met, rest)) <= near_at_rest);
                    if !apart && distance(of_edge, ends(met, &surface.places)) <= radius {
                        found.push(other);
                    }
                }
            });
        }
        found.sort_unstable();
        found.dedup();
        near.extend(found.iter().map(|&other| [number, other]));
    }
    contacts.surface.crossings = crossings;
}

/// Finds which of these cross, within `reach` (m) and thickness.
pub(super) fn find(contacts: &mut SurfaceContacts, reach: f64) {
    let mut crossings = std::mem::take(&mut contacts.surface.crossings);
    let surface = &contacts.surface;
    let now = Placed { places: &surface.places, normals: &surface.normals };
    let Crossings { edges, near, found, .. } = &mut crossings;
    found.clear();
    for &pair in &*near {
        let [one, other] = pair.map(|edge| &edges[edge as usize]);
        let Some(meeting) = contacts.crossing(one.body, other.body) else { continue };
        let reach = contacts.reach_of(&meeting, reach);
        found.extend(surface.triangles.crossing(now, one, other, reach).map(|crossing| (pair, crossing)));
    }
    contacts.surface.crossings = crossings;
}
