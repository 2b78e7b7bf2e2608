//! Which parts of a body's surface are one, where it is glued to itself.

use super::Placed;
use crate::mesh::SurfaceFace;
use std::collections::{BTreeMap, BTreeSet};

/// What of a body's surface is joined to what.
pub(super) struct Joints<'a> {
    of: Placed<'a>,
    /// The faces at each edge.
    faces: BTreeMap<[u32; 2], Vec<usize>>,
}

impl<'a> Joints<'a> {
    pub fn of(of: Placed<'a>) -> Self {
        let mut faces: BTreeMap<[u32; 2], Vec<usize>> = BTreeMap::new();
        for (place, face) in of.body.placed.surface().iter().enumerate() {
            edges(face).for_each(|edge| faces.entry(edge).or_default().push(place));
        }
        Self { of, faces }
    }

    /// Faces of the elements of a node, and those that are joined to these by edges no farther from it than so much
    /// (m). What is as near and not among them is another part of the surface.
    pub fn around(&self, node: u32, reach: f64) -> BTreeSet<usize> {
        let Placed { body, points, .. } = self.of;
        let (surface, at) = (body.placed.surface(), points[node as usize]);
        let has_it = |place: &usize| body.placed.mesh.element(surface[*place].element as usize).contains(&node);
        let is_near = |edge: &[u32; 2]| {
            let [a, b] = edge.map(|node| points[node as usize]);
            let share = (at - a).dot(b - a) / a.distance_squared(b);
            at.distance(a.lerp(b, share.clamp(0.0, 1.0))) <= reach
        };
        let mut found: BTreeSet<usize> = (0..surface.len()).filter(has_it).collect();
        let mut left: Vec<usize> = found.iter().copied().collect();
        while let Some(place) = left.pop() {
            let joined = edges(&surface[place]).filter(is_near).filter_map(|edge| self.faces.get(&edge)).flatten();
            left.extend(joined.copied().filter(|&place| found.insert(place)));
        }
        found
    }
}

/// The edges of a face, each by its nodes, ascending.
fn edges(face: &SurfaceFace) -> impl Iterator<Item = [u32; 2]> {
    // a triangle repeats its last node
    let sides = face.facets().flat_map(|[a, b, c, d]| [[a, b], [b, c], [c, d], [d, a]]);
    sides.filter(|[a, b]| a != b).map(|[a, b]| [a.min(b), a.max(b)])
}
