//! The face that a point faces.

use super::surfaces::{Placed, Point, Surfaces};
use crate::math::OnTriangle;
use glam::DVec3;

/// Surfaces face one another where the cosine between their normals is below this.
const TURNED_AWAY: f64 = 0.2;

/// What counts for nothing of a distance between two faces that are in a point's way, in edges: there the one that it
/// faces more is. Nor is a wall one that rises no higher beside a point of a face.
const ALIKE: f64 = 0.05;

/// Two faces are a corner where the cosine between their normals is below this (30°).
const CORNER: f64 = 0.866;

/// A face that a point faces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facing {
    /// Its number.
    pub triangle: u32,
    /// What each of its corners has of the nearest place.
    pub weights: [f64; 3],
    /// The nearest place (m).
    pub at: DVec3,
    /// The unit normal, out of the face's body.
    pub normal: DVec3,
    /// How far the point is outside (m); negative inside.
    pub gap: f64,
}

/// What a point faces: the face in its way, and where that is a wall of a corner, the other.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Faced {
    /// The face in its way.
    pub first: Option<Facing>,
    /// Another one.
    pub second: Option<Facing>,
    /// So much nearer than when the list was made (m) something must come before there is anything to see.
    pub wakes: f64,
}

/// Triangles that may be near a point, and how far they were when that was found.
#[derive(Clone, Copy, Debug)]
pub struct Listed<'a> {
    /// Their numbers, ascending.
    pub triangles: &'a [u32],
    /// How far each was (m).
    pub distances: &'a [f64],
    /// How much nearer anything can have come since (m).
    pub nearer: f64,
    /// Who is farther than this (m) is in nobody's way.
    pub farthest: f64,
}

impl Listed<'_> {
    /// Whether a triangle cannot have come near enough.
    fn is_far(&self, place: usize) -> bool {
        self.distances[place] > self.farthest + self.nearer
    }
}

/// So many triangles' nearest places are kept while it is found what a point faces; points near more are rare.
const KEPT: usize = 16;

/// Where triangles are nearest to a point, the first of those that may be near found beforehand.
struct Candidates<'a> {
    at: DVec3,
    listed: Listed<'a>,
    kept: [(OnTriangle, f64); KEPT],
}

impl<'a> Candidates<'a> {
    fn new(at: DVec3, listed: Listed<'a>) -> Self {
        let nowhere = (OnTriangle { at: DVec3::ZERO, weights: [0.0; 3], part: 0 }, f64::INFINITY);
        Self { at, listed, kept: [nowhere; KEPT] }
    }

    fn find(&mut self, surfaces: &Surfaces, places: &[DVec3]) {
        for (place, (&triangle, kept)) in self.listed.triangles.iter().zip(&mut self.kept).enumerate() {
            if !self.listed.is_far(place) {
                *kept = nearest(surfaces, places, self.at, triangle);
            }
        }
    }

    /// The nearest place of the triangle at a place in the list, and how far that is (m).
    fn nearest(&self, surfaces: &Surfaces, places: &[DVec3], place: usize) -> (OnTriangle, f64) {
        match self.kept.get(place) {
            Some(&kept) => kept,
            None => nearest(surfaces, places, self.at, self.listed.triangles[place]),
        }
    }

    /// How far a triangle is (m), whether it is in the list or not; infinitely far where it cannot be near enough.
    fn distance(&self, surfaces: &Surfaces, places: &[DVec3], triangle: u32) -> f64 {
        match self.listed.triangles.iter().take(KEPT).position(|&other| other == triangle) {
            Some(place) => self.kept[place].1,
            None => nearest(surfaces, places, self.at, triangle).1,
        }
    }
}

#[inline]
fn nearest(surfaces: &Surfaces, places: &[DVec3], at: DVec3, triangle: u32) -> (OnTriangle, f64) {
    let found = OnTriangle::nearest(at, surfaces.corners(places, triangle));
    (found, at.distance(found.at))
}

impl Surfaces {
    /// What a point faces among triangles that are no farther than `reach` (m). `edge` is the length of an edge (m).
    pub fn faced(
        &self,
        now: Placed<'_>,
        point: &Point,
        listed: Listed<'_>,
        reach: impl Fn(u32) -> f64,
        edge: f64,
    ) -> Faced {
        let at = point.place(now.places);
        let mut candidates = Candidates::new(at, listed);
        candidates.find(self, now.places);
        let mut faced = Faced { wakes: f64::INFINITY, ..Faced::default() };
        let mut own_normal = None;
        let mut least = [f64::INFINITY; 2];
        let is_corner = |first: &Facing, second: &Facing| self.is_corner(now.places, point, [first, second], edge);
        for (place, &triangle) in listed.triangles.iter().enumerate() {
            if listed.is_far(place) {
                faced.wakes = faced.wakes.min(listed.distances[place]);
                continue;
            }
            let (found, distance) = candidates.nearest(self, now.places, place);
            // both have moved since the list was made
            faced.wakes = faced.wakes.min(distance - listed.nearer);
            let reach = reach(triangle);
            if distance > reach && distance > self.depths[triangle as usize] {
                continue;
            }
            let Some(facing) = self.outside(now, &candidates, triangle, (found, distance), edge) else { continue };
            let inside = -self.depths[triangle as usize];
            if !(facing.gap >= inside && facing.gap <= reach) {
                continue;
            }
            let own = *own_normal.get_or_insert_with(|| match point.triangle {
                Some(triangle) => now.normals[triangle as usize],
                None => self.normal_of_node(now, point.nodes[0]),
            });
            let turned = facing.normal.dot(own);
            if turned >= TURNED_AWAY {
                continue;
            }
            // at an edge the walls beside a face are as near as itself
            let way = (facing.gap.abs() + ALIKE * edge) * (1.0 + TURNED_AWAY + turned);
            if way < least[0] {
                if faced.first.is_some_and(|other| is_corner(&facing, &other)) {
                    (faced.second, least[1]) = (faced.first, least[0]);
                }
                (faced.first, least[0]) = (Some(facing), way);
            } else if way < least[1] {
                (faced.second, least[1]) = (Some(facing), way);
            }
            let corner = |first: &Facing| faced.second.filter(|second| is_corner(first, second));
            faced.second = faced.first.as_ref().and_then(corner);
            if faced.second.is_none() {
                least[1] = f64::INFINITY;
            }
        }
        faced
    }

    /// How far a point is outside of a triangle, whose nearest place is known; `None` where another triangle must be
    /// nearer, and of triangles without area.
    fn outside(
        &self,
        now: Placed<'_>,
        candidates: &Candidates<'_>,
        triangle: u32,
        (found, distance): (OnTriangle, f64),
        edge: f64,
    ) -> Option<Facing> {
        let normal = now.normals[triangle as usize];
        if normal == DVec3::ZERO || !found.at.is_finite() {
            return None;
        }
        let off = candidates.at - found.at;
        let facing =
            |normal: DVec3, gap: f64| Some(Facing { triangle, weights: found.weights, at: found.at, normal, gap });
        if found.part == 0 || distance <= 1e-3 * edge {
            return facing(normal, off.dot(normal));
        }
        // the surface around a place that is nearest is nowhere nearer: not the flat surroundings of a point's own, nor a
        // side that leads round a corner
        let closer =
            |other: u32| other != triangle && candidates.distance(self, now.places, other) < (1.0 - 1e-6) * distance;
        if self.around_part(triangle, found.part).any(closer) {
            return None;
        }
        match off.dot(self.normal_of_part(now, triangle, found.part)) {
            out if out >= 0.0 => facing(off / distance, distance),
            _ => facing(-off / distance, -distance),
        }
    }

    /// Whether two faces are walls of a corner that the point is in: the second rises before the first. A node on an edge
    /// has both its flanks, too. A point of a face is never on one, and a wall that falls off beside it, with a corner in
    /// the first's plane or one that rounding lifts a little, would push it along the face.
    fn is_corner(&self, places: &[DVec3], point: &Point, [first, second]: [&Facing; 2], edge: f64) -> bool {
        let height = |at: DVec3| first.normal.dot(at - first.at);
        let rises = || match point.triangle {
            None => height(second.at) > 0.0,
            Some(_) => self.corners(places, second.triangle).into_iter().any(|corner| height(corner) > ALIKE * edge),
        };
        first.normal.dot(second.normal) < CORNER && rises()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::expect_used)]

    use super::*;

    /// What a point faces, with the normals of all triangles found for it.
    fn faced(
        surfaces: &Surfaces,
        places: &[DVec3],
        point: &Point,
        triangles: &[u32],
        reach: impl Fn(u32) -> f64,
    ) -> Faced {
        let all = 0..surfaces.triangles.len() as u32;
        let normals: Vec<DVec3> = all.map(|triangle| surfaces.normal(places, triangle)).collect();
        let distances = vec![0.0; triangles.len()];
        let listed = Listed { triangles, distances: &distances, nearer: 0.0, farthest: 1.0 };
        surfaces.faced(Placed { places, normals: &normals }, point, listed, reach, 1.0)
    }

    /// A flat square of two triangles, normal up, and a point above it.
    fn square(height: f64) -> (Surfaces, Vec<DVec3>) {
        let places = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 1.0, 0.0), (0.0, 1.0, 0.0), (0.5, 0.5, height)];
        let triangles = vec![[0, 1, 2], [0, 2, 3]];
        (Surfaces::new(5, triangles, vec![0; 2], vec![0.5; 2]), places.map(DVec3::from).to_vec())
    }

    #[test]
    fn a_place_on_the_side_of_two_faces_is_as_far_from_both() {
        for height in [0.1, 1e-5, 0.0, -1e-5, -0.1] {
            let (surfaces, places) = square(height);
            let faced = faced(&surfaces, &places, &Point::node(1, 4), &[0, 1], |_| 0.2);
            let first = faced.first.expect("it faces them");
            assert!((first.gap - height).abs() < 1e-15 && (first.normal - DVec3::Z).length() < 1e-12, "{first:?}");
            assert_eq!((first.triangle, faced.second), (0, None));
        }
    }

    /// Of a strip the second half is not in any list: still it is seen that it is nearer.
    #[test]
    fn where_the_surface_goes_on_its_other_parts_are_not_faced() {
        let corners = [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (0.0, 1.0), (1.0, 1.0), (2.0, 1.0)];
        let mut places: Vec<DVec3> = corners.map(|(x, y)| DVec3::new(x, y, 0.0)).to_vec();
        places.push(DVec3::ZERO);
        let triangles = vec![[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4]];
        let surfaces = Surfaces::new(7, triangles, vec![0; 4], vec![0.5; 4]);
        for place in [(1.3, 0.5, 0.0), (1.3, 0.5, 0.1), (1.1, 0.0, -0.2), (1.4, 1.0, 1e-9), (1.4, 1.0, -1e-9)] {
            places[6] = place.into();
            let faced = |triangles: &[u32]| faced(&surfaces, &places, &Point::node(1, 6), triangles, |_| 1.0).first;
            assert_eq!(faced(&[0, 1]), None, "{place:?}");
            assert!((faced(&[0, 1, 2, 3]).expect("it faces one").gap - place.2).abs() < 1e-15);
        }
    }

    #[test]
    fn farther_than_the_reach_or_deeper_than_the_inside_is_nothing() {
        for (height, there) in [(0.21, false), (0.19, true), (-0.49, true), (-0.51, false)] {
            let (surfaces, places) = square(height);
            let faced = faced(&surfaces, &places, &Point::node(1, 4), &[0, 1], |_| 0.2);
            assert_eq!(faced.first.is_some(), there, "{height}");
        }
    }

    /// A floor and a wall at its end x = 0, up from it or down, and a point of a face that is a little or not at all
    /// inside both.
    #[test]
    fn a_wall_that_rises_is_another_face_and_one_that_falls_off_is_not() {
        for (rises, end) in [(true, 1.0), (false, -1.0)] {
            for height in [-1e-4, -1e-9, 0.0, 1e-9] {
                let floor = [(0.0, -1.0, 0.0), (1.0, -1.0, 0.0), (1.0, 1.0, 0.0), (0.0, 1.0, 0.0)];
                let wall = [(0.0, -1.0, end), (0.0, 1.0, end)];
                // it looks straight down
                let face = [(1e-9, 0.1, height), (1e-9, 1.1, height), (1.0, 0.1, height)];
                let places: Vec<DVec3> = floor.into_iter().chain(wall).chain(face).map(DVec3::from).collect();
                // out of the wall is +x where it rises, −x where it falls off
                let triangles = vec![[0, 1, 2], [0, 2, 3], [0, 3, 5], [0, 5, 4], [6, 7, 8]];
                let surfaces = Surfaces::new(9, triangles, vec![0, 0, 0, 0, 1], vec![0.5; 5]);
                let point = Point { triangle: Some(4), ..Point::node(1, 6) };
                let faced = faced(&surfaces, &places, &point, &[0, 1, 2, 3], |_| 0.2);
                assert!(faced.first.is_some(), "{rises}, {height}");
                assert_eq!(faced.second.is_some(), rises, "{rises}, {height}: {faced:?}");
            }
        }
    }

    #[test]
    fn triangles_without_area_are_never_faced() {
        let places: Vec<DVec3> =
            [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (2.0, 0.0, 0.0), (1.0, 0.0, 0.1)].map(DVec3::from).to_vec();
        let surfaces = Surfaces::new(4, vec![[0, 1, 2], [0, 0, 0]], vec![0; 2], vec![0.5; 2]);
        let faced = faced(&surfaces, &places, &Point::node(1, 3), &[0, 1], |_| 1.0);
        assert_eq!(faced.first, None);
    }
}
