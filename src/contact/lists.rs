//! Which triangles may be near which points: found now and then, and right until something has gone too far.

use super::boxes::Tree;
use super::surfaces::{Point, Surfaces};
use crate::backend::cpu::Cpu;
use crate::mesh::OnTriangle;
use glam::DVec3;
use std::ops::Range;

/// Points that a task looks for.
const POINTS_A_TASK: usize = 256;

/// Triangles that may be near points. Valid while nothing has moved farther than its skin: so what is found with them
/// does not depend on when they were made.
#[derive(Clone, Debug, Default)]
pub struct Lists {
    /// Points that have any, ascending.
    pub points: Vec<u32>,
    /// Where each one's triangles begin, and where the last one's end.
    pub starts: Vec<u32>,
    /// Ascending for each point.
    pub triangles: Vec<u32>,
    /// How far each is from the point at least (m): rounded down, so that nobody is taken to be farther than it is.
    pub distances: Vec<f32>,
    /// All triangles that were so near to a point are in its list (m), and of each body as much beyond as the finder
    /// has it; more than was asked for where there are none.
    pub radius: f64,
}

/// Who may meet whom.
pub struct Finder<'a> {
    /// The surfaces.
    pub surfaces: &'a Surfaces,
    /// The points that may meet them.
    pub points: &'a [Point],
    /// Whether triangles of a body may be in the way of points of another: of nodes, and, if the third is true, of
    /// points of faces.
    pub meets: &'a (dyn Fn(u32, u32, bool) -> bool + Sync),
    /// Pairs of a point and a triangle that are never in each other's way, ascending.
    pub apart: &'a [(u32, u32)],
    /// How much farther than others triangles of each body are looked for (m).
    pub beyond: &'a [f64],
}

impl Lists {
    /// The triangles that may be near the point of a place in [`points`](Self::points).
    pub fn triangles(&self, place: usize) -> &[u32] {
        &self.triangles[self.range(place)]
    }

    /// How far each of these was (m).
    pub fn distances(&self, place: usize) -> &[f32] {
        &self.distances[self.range(place)]
    }

    /// Bytes that they take.
    pub fn bytes(&self) -> usize {
        let Self { points, starts, triangles, distances, .. } = self;
        size_of_val(&points[..]) + size_of_val(&starts[..]) + size_of_val(&triangles[..]) + size_of_val(&distances[..])
    }

    fn range(&self, place: usize) -> Range<usize> {
        self.starts[place] as usize..self.starts[place + 1] as usize
    }

    /// Finds all triangles within a radius (m) of points and what is beyond, in a tree a body.
    pub fn find(finder: &Finder<'_>, trees: &[Tree], places: &[DVec3], radius: f64, cpu: &Cpu) -> Self {
        let task = |task: usize| {
            let mut counts: Vec<(u32, u32)> = Vec::new();
            let mut found: Vec<(u32, f64)> = Vec::new();
            let points = task * POINTS_A_TASK..finder.points.len().min((task + 1) * POINTS_A_TASK);
            for number in points {
                let point = &finder.points[number];
                let (at, before) = (point.place(places), found.len());
                let of_face = point.triangle.is_some();
                let met = trees.iter().zip(0..).filter(|(_, body)| (finder.meets)(point.body, *body, of_face));
                for (tree, body) in met {
                    let radius = radius + finder.beyond[body as usize];
                    tree.near(at, radius, |triangle| {
                        let corners = finder.surfaces.corners(places, triangle);
                        let [a, b, c] = corners;
                        // how far its box is, to save the rest for most
                        let off = (a.min(b).min(c) - at).max(at - a.max(b).max(c)).max(DVec3::ZERO);
                        if off.length_squared() > radius * radius {
                            return;
                        }
                        if finder.may_meet(number as u32, triangle) {
                            let distance = OnTriangle::nearest(at, corners).at.distance(at);
                            if distance <= radius {
                                found.push((triangle, distance));
                            }
                        }
                    });
                }
                if found.len() > before {
                    found[before..].sort_unstable_by_key(|(triangle, _)| *triangle);
                    counts.push((number as u32, (found.len() - before) as u32));
                }
            }
            (counts, found)
        };
        let mut lists = Lists { radius, starts: vec![0], ..Lists::default() };
        for (counts, found) in cpu.map(finder.points.len().div_ceil(POINTS_A_TASK), task) {
            for (point, count) in counts {
                lists.points.push(point);
                lists.starts.push(lists.starts[lists.starts.len() - 1] + count);
            }
            lists.triangles.extend(found.iter().map(|(triangle, _)| *triangle));
            lists.distances.extend(found.into_iter().map(|(_, distance)| (distance as f32).next_down()));
        }
        if lists.points.is_empty() {
            lists.radius = finder.apart_by(trees).max(radius);
        }
        lists
    }
}

impl Finder<'_> {
    /// Whether a triangle of a body that a point meets may be in its way: none of its own nodes' triangles.
    fn may_meet(&self, number: u32, triangle: u32) -> bool {
        let point = &self.points[number as usize];
        (self.surfaces.bodies[triangle as usize] != point.body || !self.is_of_point(point, triangle))
            && (self.apart.is_empty() || self.apart.binary_search(&(number, triangle)).is_err())
    }

    /// How far the boxes of bodies that may meet are apart (m), less what is beyond; 0 where one may meet itself.
    fn apart_by(&self, trees: &[Tree]) -> f64 {
        let bodies = || (0..).zip(trees);
        let pairs = bodies().flat_map(|(a, of_a)| bodies().map(move |(b, of_b)| (a, of_a, b, of_b)));
        let meeting = pairs.filter(|&(a, _, b, _)| (self.meets)(a, b, false) || (self.meets)(a, b, true));
        let apart = |(a, of_a, b, of_b): (u32, &Tree, u32, &Tree)| match a == b {
            true => 0.0,
            false => of_a.distance(of_b) - self.beyond[b as usize],
        };
        meeting.map(apart).fold(f64::INFINITY, f64::min)
    }

    fn is_of_point(&self, point: &Point, triangle: u32) -> bool {
        let corners = self.surfaces.triangles[triangle as usize];
        point.parts().any(|(node, _)| corners.contains(&node))
    }
}
