//! Triangles of surfaces, and what is beside them.

use glam::DVec3;
use std::collections::HashMap;
use std::f64::consts::{FRAC_PI_2, PI};

/// How deep behind a face is still its inside at most, in edges of its own body; of thin elements half of what is
/// behind it.
pub const DEEPEST: f64 = 0.5;

/// Triangles of a facet of the author's nodes; a quadrilateral is cut from the lowest of its corners, so that the same
/// is cut alike from both sides, and however the scene is turned.
pub fn triangles_of([a, b, c, d]: [u32; 4]) -> impl Iterator<Item = [u32; 3]> {
    let (first, second) = match c == d {
        true => ([a, b, c], None),
        false if a.min(c) < b.min(d) => ([a, b, c], Some([a, c, d])),
        false => ([a, b, d], Some([b, c, d])),
    };
    std::iter::once(first).chain(second)
}

/// What the normal of a node is known to.
pub(super) const OF_ANGLES: f64 = 1e-4;

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
    /// The largest of these; 0 where there are none.
    deepest: f64,
    /// The triangle across each side, from each corner to the next; [`NONE`] where there is not exactly one.
    adjacent: Vec<[u32; 3]>,
    /// The triangles around each node, in compressed rows.
    starts: Vec<u32>,
    around: Vec<u32>,
}

/// Where surfaces are: places of nodes (m), and unit normals of triangles. Only of those are they needed that are near
/// what is asked for ([`Surfaces::neighbourhood`]).
#[derive(Clone, Copy, Debug)]
pub struct Placed<'a> {
    /// Of each node (m).
    pub places: &'a [DVec3],
    /// Of each triangle; zero of one without area. Empty where they are found one by one as they are asked for.
    pub normals: &'a [DVec3],
}

/// Parts of surfaces that are near something.
#[derive(Clone, Debug, Default)]
pub struct Near {
    /// Nodes.
    pub nodes: Vec<u32>,
    /// Triangles.
    pub triangles: Vec<u32>,
}

/// A point of a surface that may meet others: a node, or a place on a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// The number of its body.
    pub body: u32,
    /// The nodes it is between, the first so many of them.
    pub nodes: [u32; 4],
    /// What each has of it: one of few ways to weigh the corners of a facet.
    pub weights: &'static [f64; 4],
    /// The triangle that it is on; `None` of a node.
    pub triangle: Option<u32>,
}

impl Point {
    /// A node of a body.
    pub fn node(body: u32, node: u32) -> Self {
        Self { body, nodes: [node; 4], weights: &[1.0, 0.0, 0.0, 0.0], triangle: None }
    }

    /// Its nodes and their weights.
    #[inline(always)] // with the instructions of whoever asks
    pub fn slices(&self) -> (&[u32], &[f64]) {
        let count = if self.triangle.is_some() { 4 } else { 1 };
        (&self.nodes[..count], &self.weights[..count])
    }

    /// Its nodes with their weights.
    #[inline]
    pub fn parts(&self) -> impl Iterator<Item = (u32, f64)> + '_ {
        let (nodes, weights) = self.slices();
        nodes.iter().copied().zip(weights.iter().copied())
    }

    /// Where it is (m).
    #[inline(always)] // likewise
    pub fn place(&self, places: &[DVec3]) -> DVec3 {
        if self.triangle.is_none() {
            return places[self.nodes[0] as usize];
        }
        let (nodes, weights) = self.slices();
        let mut at = DVec3::ZERO;
        for (&node, &weight) in nodes.iter().zip(weights) {
            at += places[node as usize] * weight;
        }
        at
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
        let deepest = depths.iter().copied().fold(0.0, f64::max);
        Self { triangles, bodies, depths, deepest, adjacent, starts, around }
    }

    /// How deep behind any triangle is still its inside (m): asked for several times a step.
    pub fn deepest(&self) -> f64 {
        self.deepest
    }

    /// How many nodes.
    pub fn nodes(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// Bytes that they take.
    pub fn bytes(&self) -> usize {
        let Self { triangles, bodies, depths, adjacent, starts, around, .. } = self;
        let of_triangles = size_of_val(&triangles[..]) + size_of_val(&bodies[..]) + size_of_val(&depths[..]);
        of_triangles + size_of_val(&adjacent[..]) + size_of_val(&starts[..]) + size_of_val(&around[..])
    }

    /// Where its corners are (m).
    #[inline(always)] // with the instructions of whoever asks
    pub fn corners(&self, places: &[DVec3], triangle: u32) -> [DVec3; 3] {
        let [a, b, c] = self.triangles[triangle as usize];
        [places[a as usize], places[b as usize], places[c as usize]]
    }

    /// The unit normal of a triangle; zero of one without area.
    #[inline(always)] // with the instructions of whoever asks
    pub fn normal(&self, places: &[DVec3], triangle: u32) -> DVec3 {
        let [a, b, c] = self.corners(places, triangle);
        (b - a).cross(c - a).normalize_or_zero()
    }

    /// The same where they may be known.
    #[inline(always)] // with the instructions of whoever asks
    pub(super) fn normal_now(&self, now: Placed<'_>, triangle: u32) -> DVec3 {
        now.normals.get(triangle as usize).copied().unwrap_or_else(|| self.normal(now.places, triangle))
    }

    /// The normal of a part of a triangle, as [`OnTriangle::part`](crate::mesh::OnTriangle) counts them: of a side the
    /// sum of those of both its triangles, of a corner the sum weighted with angles (Bærentzen and Aanæs 2005).
    pub(super) fn normal_of_part(&self, now: Placed<'_>, triangle: u32, part: usize) -> DVec3 {
        match part {
            0 => self.normal_now(now, triangle),
            1..=3 => {
                let other = self.adjacent[triangle as usize][part - 1];
                let of_other = if other == NONE { DVec3::ZERO } else { self.normal_now(now, other) };
                (self.normal_now(now, triangle) + of_other).normalize_or_zero()
            }
            corner => self.normal_of_node(now, self.triangles[triangle as usize][(corner - 4).min(2)]),
        }
    }

    /// The triangles that share a part of one.
    pub(super) fn around_part(&self, triangle: u32, part: usize) -> impl Iterator<Item = u32> + '_ {
        let side = self.adjacent[triangle as usize][(part + 2) % 3];
        let adjacent = (matches!(part, 1..=3) && side != NONE).then_some(side);
        let node = self.triangles[triangle as usize][part.saturating_sub(4).min(2)];
        let around = if part > 3 { self.around(node) } else { &[] };
        adjacent.into_iter().chain(around.iter().copied())
    }

    /// Whether another triangle shares a part of one.
    pub(super) fn shares_part(&self, other: u32, triangle: u32, part: usize) -> bool {
        match part {
            0 => false,
            1..=3 => self.adjacent[triangle as usize][part - 1] == other,
            corner => {
                let node = self.triangles[triangle as usize][(corner - 4).min(2)];
                self.triangles[other as usize].contains(&node)
            }
        }
    }

    /// The triangles across the sides of one; `u32::MAX` where there is not exactly one.
    pub fn beside(&self, triangle: u32) -> [u32; 3] {
        self.adjacent[triangle as usize]
    }

    /// The triangles around a node, ascending.
    pub fn around(&self, node: u32) -> &[u32] {
        &self.around[self.starts[node as usize] as usize..self.starts[node as usize + 1] as usize]
    }

    /// The normal of a node, weighted with angles, to 1e-4: what is asked of it is to which side things are.
    #[inline(always)] // with the instructions of whoever asks
    pub fn normal_of_node(&self, now: Placed<'_>, node: u32) -> DVec3 {
        let of_triangle =
            |&triangle: &u32| self.normal_now(now, triangle) * self.angle_at(now.places, triangle, node).0;
        self.around(node).iter().map(of_triangle).sum::<DVec3>().normalize_or_zero()
    }

    /// The angle of a triangle at a node, to 1e-5, and the lengths of its sides there (m).
    #[inline(always)] // likewise
    pub(super) fn angle_at(&self, places: &[DVec3], triangle: u32, node: u32) -> (f64, [f64; 2]) {
        let corners = self.triangles[triangle as usize];
        let place = corners.iter().position(|&corner| corner == node).unwrap_or(0);
        let sides = [1, 2].map(|next| places[corners[(place + next) % 3] as usize] - places[node as usize]);
        let [b, c] = sides;
        (angle(b.cross(c).length(), b.dot(c)), sides.map(DVec3::length))
    }

    /// The triangles that may be asked for when it is found what points face among some triangles, and their corners;
    /// both ascending.
    pub fn neighbourhood(&self, points: impl Iterator<Item = Point>, among: &[u32]) -> Near {
        let mut of_nodes = vec![false; self.nodes()];
        let mut mark = |node: u32| of_nodes[node as usize] = true;
        points.for_each(|point| point.parts().for_each(|(node, _)| mark(node)));
        among.iter().for_each(|&triangle| self.triangles[triangle as usize].into_iter().for_each(&mut mark));
        let is_near = |corners: &[u32; 3]| corners.iter().any(|&node| of_nodes[node as usize]);
        let numbered = (0..).zip(&self.triangles);
        let triangles: Vec<u32> = numbered.filter(|(_, corners)| is_near(corners)).map(|(number, _)| number).collect();
        let mut nodes: Vec<u32> = triangles.iter().flat_map(|&number| self.triangles[number as usize]).collect();
        nodes.sort_unstable();
        nodes.dedup();
        Near { nodes, triangles }
    }
}

/// The angle whose sine and cosine are in the same ratio as these; 0 where both are 0. To 1e-5: Abramowitz and Stegun
/// 4.4.49 in an eighth of the circle.
fn angle(sine: f64, cosine: f64) -> f64 {
    let (low, high) = if sine < cosine.abs() { (sine, cosine.abs()) } else { (cosine.abs(), sine) };
    let x = if high > 0.0 { low / high } else { 0.0 };
    let square = x * x;
    let terms = 0.180_141_0 + square * (-0.085_133_0 + square * 0.020_835_1);
    let of_eighth = x * (0.999_866_0 + square * (-0.330_299_5 + square * terms));
    let of_quarter = if sine < cosine.abs() { of_eighth } else { FRAC_PI_2 - of_eighth };
    match (high > 0.0, cosine < 0.0) {
        (false, _) => 0.0,
        (true, false) => of_quarter,
        (true, true) => PI - of_quarter,
    }
}

#[cfg(test)]
mod tests;
