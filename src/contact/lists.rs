//! Which triangles may be near which points: found now and then, and right until something has gone too far.

use super::boxes::Tree;
use super::surfaces::{Point, Surfaces};
use crate::backend::cpu::Cpu;
use crate::math::OnTriangle;
use glam::DVec3;

/// Points that a task looks for.
const POINTS_A_TASK: usize = 256;

/// Triangles that may be near points. Valid while nothing has moved farther than its skin: so what is found with them
/// does not depend on when they were made.
#[derive(Clone, Debug, Default)]
pub struct Lists {
    /// Points that have any, ascending.
    pub points: Vec<u32>,
    /// Where each one's triangles begin, and where the last one's end.
    starts: Vec<u32>,
    /// Ascending for each point.
    triangles: Vec<u32>,
    /// Where the nodes were.
    places: Vec<DVec3>,
    /// How far a triangle may be from a point that is in no list (m).
    radius: f64,
}

/// Who may meet whom.
pub struct Finder<'a> {
    /// The surfaces.
    pub surfaces: &'a Surfaces,
    /// The points that may meet them.
    pub points: &'a [Point],
    /// How far triangles of a body are in the way of points of another (m); `None` where they never are.
    pub reach: &'a (dyn Fn(u32, u32) -> Option<f64> + Sync),
    /// Pairs of a point and a triangle that are never in each other's way, ascending.
    pub apart: &'a [(u32, u32)],
}

impl Lists {
    /// The triangles that may be near the point of a place in [`points`](Self::points).
    pub fn triangles(&self, place: usize) -> &[u32] {
        &self.triangles[self.starts[place] as usize..self.starts[place + 1] as usize]
    }

    /// Whether they hold all triangles within `reach` (m) of points, now that nodes are at these places.
    pub fn hold(&self, places: &[DVec3], reach: f64) -> bool {
        if self.places.len() != places.len() || places.is_empty() {
            return false;
        }
        // what flies together stays near or far
        let moved = |(now, then): (&DVec3, &DVec3)| *now - *then;
        let mean = places.iter().zip(&self.places).map(moved).sum::<DVec3>() / places.len() as f64;
        let farthest = |most: f64, pair| f64::max(most, (moved(pair) - mean).length_squared());
        let most = places.iter().zip(&self.places).fold(0.0, farthest).sqrt();
        reach + 2.0 * most <= self.radius
    }

    /// Finds all triangles within a radius (m) of points, in a tree a body.
    pub fn find(finder: &Finder<'_>, trees: &[Tree], places: &[DVec3], radius: f64, cpu: &Cpu) -> Self {
        let task = |task: usize| {
            let (mut found, mut near) = (Vec::new(), Vec::new());
            let points = task * POINTS_A_TASK..finder.points.len().min((task + 1) * POINTS_A_TASK);
            for number in points {
                near.clear();
                let point = &finder.points[number];
                let at = point.place(places);
                let met = trees.iter().zip(0..).filter(|(_, body)| (finder.reach)(point.body, *body).is_some());
                for (tree, _) in met {
                    tree.near(at, radius, |triangle| {
                        if finder.may_meet(number as u32, triangle) {
                            let corners = finder.surfaces.corners(places, triangle);
                            if OnTriangle::nearest(at, corners).at.distance_squared(at) <= radius * radius {
                                near.push(triangle);
                            }
                        }
                    });
                }
                if !near.is_empty() {
                    near.sort_unstable();
                    found.push((number as u32, near.clone()));
                }
            }
            found
        };
        let mut lists = Lists { places: places.to_vec(), radius, starts: vec![0], ..Lists::default() };
        for (point, triangles) in cpu.map(finder.points.len().div_ceil(POINTS_A_TASK), task).into_iter().flatten() {
            lists.points.push(point);
            lists.triangles.extend(triangles);
            lists.starts.push(lists.triangles.len() as u32);
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

    fn is_of_point(&self, point: &Point, triangle: u32) -> bool {
        let corners = self.surfaces.triangles[triangle as usize];
        point.parts().any(|(node, _)| corners.contains(&node))
    }
}
