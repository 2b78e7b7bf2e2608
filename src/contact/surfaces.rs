//! Triangles of surfaces, and what is beside them.

use glam::DVec3;
use std::collections::HashMap;

/// No triangle.
pub(super) const NONE: u32 = u32::MAX;

/// Triangles of the surfaces of bodies, with nodes numbered through all of them.
#[derive(Clone, Debug, Default)]
pub struct Surfaces {
    /// Nodes of each triangle, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// The number of its body.
    pub bodies: Vec<u32>,
    /// How deep behind each triangle (m) is still its inside.
    pub depths: Vec<f64>,
    /// The triangle across each side, from each corner to the next; [`NONE`] where there is not exactly one.
    adjacent: Vec<[u32; 3]>,
    /// The triangles around each node, in compressed rows.
    starts: Vec<u32>,
    around: Vec<u32>,
}

/// A point of a surface that may meet others: a node, or a place on a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// The number of its body.
    pub body: u32,
    /// The nodes it is between, the first so many of them.
    pub nodes: [u32; 3],
    /// What each has of it.
    pub weights: [f64; 3],
    /// Its triangle; `None` of a node.
    pub triangle: Option<u32>,
}

impl Point {
    /// A node of a body.
    pub fn node(body: u32, node: u32) -> Self {
        Self { body, nodes: [node; 3], weights: [1.0, 0.0, 0.0], triangle: None }
    }

    /// Its nodes with their weights.
    pub fn parts(&self) -> impl Iterator<Item = (u32, f64)> + '_ {
        let count = if self.triangle.is_some() { 3 } else { 1 };
        self.nodes.into_iter().zip(self.weights).take(count)
    }

    /// Where it is (m).
    pub fn place(&self, places: &[DVec3]) -> DVec3 {
        self.parts().map(|(node, weight)| places[node as usize] * weight).sum()
    }
}

impl Surfaces {
    /// Of triangles of so many nodes, each with the number of its body and how deep it is behind it (m).
    pub fn new(nodes: usize, triangles: Vec<[u32; 3]>, bodies: Vec<u32>, depths: Vec<f64>) -> Self {
        let mut sides: HashMap<[u32; 2], u32> = HashMap::new();
        for (number, corners) in (0..).zip(&triangles) {
            for side in 0..3 {
                // of two on the same side of an edge neither is beside the other
                let known = sides.entry([corners[side], corners[(side + 1) % 3]]).or_insert(number);
                if *known != number {
                    *known = NONE;
                }
            }
        }
        let across = |from: u32, to: u32| sides.get(&[to, from]).copied().unwrap_or(NONE);
        let adjacent = triangles.iter().map(|&[a, b, c]| [across(a, b), across(b, c), across(c, a)]).collect();
        let mut starts = vec![0_u32; nodes + 1];
        triangles.iter().flatten().for_each(|&node| starts[node as usize + 1] += 1);
        (0..nodes).for_each(|node| starts[node + 1] += starts[node]);
        let (mut next, mut around) = (starts.clone(), vec![0; 3 * triangles.len()]);
        for (number, corners) in (0..).zip(&triangles) {
            for &node in corners {
                around[next[node as usize] as usize] = number;
                next[node as usize] += 1;
            }
        }
        Self { triangles, bodies, depths, adjacent, starts, around }
    }

    /// How many nodes.
    pub fn nodes(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// Where its corners are (m).
    pub fn corners(&self, places: &[DVec3], triangle: u32) -> [DVec3; 3] {
        self.triangles[triangle as usize].map(|node| places[node as usize])
    }

    /// The unit normal of a triangle; zero of one without area.
    pub fn normal(&self, places: &[DVec3], triangle: u32) -> DVec3 {
        let [a, b, c] = self.corners(places, triangle);
        (b - a).cross(c - a).normalize_or_zero()
    }

    /// The normal of a part of a triangle, as [`OnTriangle::part`](crate::math::OnTriangle) counts them: of a side the
    /// sum of those of both its triangles, of a corner the sum weighted with angles (Bærentzen and Aanæs 2005).
    pub(super) fn normal_of_part(&self, places: &[DVec3], triangle: u32, part: usize) -> DVec3 {
        match part {
            0 => self.normal(places, triangle),
            1..=3 => {
                let other = self.adjacent[triangle as usize][part - 1];
                let of_other = if other == NONE { DVec3::ZERO } else { self.normal(places, other) };
                (self.normal(places, triangle) + of_other).normalize_or_zero()
            }
            corner => self.normal_of_node(places, self.triangles[triangle as usize][(corner - 4).min(2)]),
        }
    }

    /// The triangles that share a part of one.
    pub(super) fn around_part(&self, triangle: u32, part: usize) -> impl Iterator<Item = u32> + '_ {
        let side = self.adjacent[triangle as usize][(part + 2) % 3];
        let adjacent = (matches!(part, 1..=3) && side != NONE).then_some(side);
        let node = self.triangles[triangle as usize][part.saturating_sub(4).min(2)] as usize;
        let around = if part > 3 { self.starts[node] as usize..self.starts[node + 1] as usize } else { 0..0 };
        adjacent.into_iter().chain(self.around[around].iter().copied())
    }

    /// The normal of a node, weighted with angles.
    pub fn normal_of_node(&self, places: &[DVec3], node: u32) -> DVec3 {
        let at = places[node as usize];
        let around = &self.around[self.starts[node as usize] as usize..self.starts[node as usize + 1] as usize];
        let of_triangle = |&triangle: &u32| {
            let corners = self.triangles[triangle as usize];
            let place = corners.iter().position(|&corner| corner == node).unwrap_or(0);
            let [b, c] = [1, 2].map(|next| places[corners[(place + next) % 3] as usize] - at);
            let across = b.cross(c);
            across.normalize_or_zero() * across.length().atan2(b.dot(c))
        };
        around.iter().map(of_triangle).sum::<DVec3>().normalize_or_zero()
    }
}
