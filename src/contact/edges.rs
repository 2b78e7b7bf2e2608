//! Edges that cross: where two edges are nearest to each other, and which way out is.

use super::surfaces::{NONE, Placed, Surfaces};
use glam::DVec3;

/// Edges are parallel where the sine of the angle between them is below the root of this: then nodes see each other.
const PARALLEL: f64 = 1e-6;

/// An edge is a ridge towards what it crosses where both its faces fall off from the normal by more than this (3°);
/// what is flatter the points of surfaces see.
const FALLS: f64 = 0.05;

/// An edge between two triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edge {
    /// The number of its body.
    pub body: u32,
    /// Its ends.
    pub nodes: [u32; 2],
    /// The triangles beside it.
    pub triangles: [u32; 2],
    /// The corners of these across from it.
    pub across: [u32; 2],
}

/// Two edges that cross.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// What the ends of each have of the nearest place on it.
    pub weights: [[f64; 2]; 2],
    /// The unit normal, from the second to the first.
    pub normal: DVec3,
    /// How far apart they are (m); negative where they have passed each other.
    pub gap: f64,
}

impl Surfaces {
    /// The edges that have two triangles, and of each triangle the numbers of those that are its sides; `u32::MAX`
    /// where one has not two.
    pub fn edges(&self) -> (Vec<Edge>, Vec<[u32; 3]>) {
        let mut edges = Vec::new();
        let mut sides = vec![[NONE; 3]; self.triangles.len()];
        for (number, corners) in (0..).zip(&self.triangles) {
            for (side, other) in self.beside(number).into_iter().enumerate() {
                // each once
                if other == NONE || other < number {
                    continue;
                }
                let nodes = [corners[side], corners[(side + 1) % 3]];
                let theirs = self.triangles[other as usize];
                let Some(place) = theirs.iter().position(|corner| !nodes.contains(corner)) else { continue };
                sides[number as usize][side] = edges.len() as u32;
                // from the corner after the one across to the next
                sides[other as usize][(place + 1) % 3] = edges.len() as u32;
                edges.push(Edge {
                    body: self.bodies[number as usize],
                    nodes,
                    triangles: [number, other],
                    across: [corners[(side + 2) % 3], theirs[place]],
                });
            }
        }
        (edges, sides)
    }

    /// How two edges cross; `None` where they are nearest at an end or parallel, where one of them is no ridge towards
    /// the other, or where they are farther apart than `reach` or deeper in each other than insides go (m).
    pub fn crossing(&self, now: Placed<'_>, one: &Edge, other: &Edge, reach: f64) -> Option<Crossing> {
        let ends = |edge: &Edge| edge.nodes.map(|node| now.places[node as usize]);
        let ([p, p_end], [q, q_end]) = (ends(one), ends(other));
        let (along, beside) = (p_end - p, q_end - q);
        let (aa, ab, bb) = (along.dot(along), along.dot(beside), beside.dot(beside));
        let size = aa * bb - ab * ab;
        // no number is no angle
        if size.is_nan() || size <= PARALLEL * aa * bb {
            return None;
        }
        let (a_off, b_off) = (along.dot(p - q), beside.dot(p - q));
        let (s, t) = ((ab * b_off - bb * a_off) / size, (aa * b_off - ab * a_off) / size);
        if !(s > 0.0 && s < 1.0 && t > 0.0 && t < 1.0) {
            return None;
        }
        let outwards = |edge: &Edge| edge.triangles.iter().map(|&of| self.normal_now(now, of)).sum::<DVec3>();
        let across = along.cross(beside).normalize_or_zero();
        let normal = if across.dot(outwards(other)) >= 0.0 { across } else { -across };
        if normal == DVec3::ZERO || normal.dot(outwards(one)) >= 0.0 {
            return None;
        }
        let falls = |edge: &Edge, from: DVec3, way: DVec3| {
            edge.across.iter().all(|&node| {
                let to = now.places[node as usize] - from;
                to.dot(way) < -FALLS * to.length()
            })
        };
        let (at, at_other) = (p.lerp(p_end, s), q.lerp(q_end, t));
        if !falls(other, at_other, normal) || !falls(one, at, -normal) {
            return None;
        }
        let gap = normal.dot(at - at_other);
        let depth =
            |edge: &Edge| edge.triangles.iter().map(|&of| self.depths[of as usize]).fold(f64::INFINITY, f64::min);
        let inside = depth(one).min(depth(other));
        (gap >= -inside && gap <= reach).then_some(Crossing { weights: [[1.0 - s, s], [1.0 - t, t]], normal, gap })
    }
}

/// How far two segments are apart (m) (Ericson 2004, section 5.1.9).
pub fn distance([p, p_end]: [DVec3; 2], [q, q_end]: [DVec3; 2]) -> f64 {
    let (along, beside, off) = (p_end - p, q_end - q, p - q);
    let (aa, ab, bb) = (along.dot(along), along.dot(beside), beside.dot(beside));
    let size = aa * bb - ab * ab;
    let share = |upper: f64, lower: f64| if lower > 0.0 { (upper / lower).clamp(0.0, 1.0) } else { 0.0 };
    let s = if size > PARALLEL * aa * bb { share(ab * beside.dot(off) - bb * along.dot(off), size) } else { 0.5 };
    let t = share(ab * s + beside.dot(off), bb);
    let s = share(ab * t - along.dot(off), aa);
    p.lerp(p_end, s).distance(q.lerp(q_end, t))
}

#[cfg(test)]
mod tests;
