//! Half sections of shapes, and triangles on their surface, for pictures.

use super::shape::Shape;
use super::solid::Solid;
use glam::{DVec2, DVec3};
use std::collections::HashMap;

/// With fewer segments around there is nothing inside.
const LEAST_SEGMENTS: usize = 3;

/// Directions in a half plane (degrees), from the outward one across towards z.
const DOWN: f64 = -90.0;
const OUT: f64 = 0.0;
const UP: f64 = 90.0;
const IN: f64 = 180.0;

/// An arc of a profile: the centre (across, along z; m), and where it begins and ends (degrees).
pub(super) struct Arc(pub DVec2, pub f64, pub f64);

impl Arc {
    /// Where it begins and ends (m), of a radius (m).
    pub fn ends(&self, radius: f64) -> [DVec2; 2] {
        [self.1, self.2].map(|degrees| self.0 + radius * direction(degrees))
    }
}

impl Solid {
    /// The arcs that its half section has, of one radius (m), with what is straight between them: from the tip outside
    /// to the other end, of a tube (square, before it is bevelled) round its wall. None of planes and boxes.
    pub(super) fn section(&self) -> Option<(Vec<Arc>, f64)> {
        let r = self.rounding();
        let [a, b, c, d, e, f] = self.form().sizes();
        let arc = |across: f64, z: f64, from: f64, to: f64| Arc(DVec2::new(across, z), from, to);
        Some(match *self.shape() {
            Shape::Plane {} | Shape::Box { .. } => return None,
            Shape::Sphere { .. } => (vec![arc(0.0, 0.0, DOWN, UP)], a),
            Shape::Capsule { .. } => (vec![arc(0.0, b, DOWN, OUT), arc(0.0, c, OUT, UP)], a),
            Shape::Cylinder { .. } => (vec![arc(a, b, DOWN, OUT), arc(a, c, OUT, UP)], r),
            Shape::Cone { .. } => {
                let mantle = f.atan2(e).to_degrees();
                (vec![arc(a, c, DOWN, mantle), arc(b, d, mantle, UP)], r)
            }
            Shape::Tube { .. } => {
                (vec![arc(b, c, DOWN, OUT), arc(b, d, OUT, UP), arc(a, d, UP, IN), arc(a, c, IN, 360.0 + DOWN)], r)
            }
        })
    }

    /// A closed surface of triangles in the tool's frame, normals outwards, with so many segments around (three at
    /// least). Its points are on the surface (m). That of a plane is a square about the origin, `half` (m) from its
    /// middle to its sides, which is not closed.
    pub fn surface(&self, segments: usize, half: f64) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let segments = segments.max(LEAST_SEGMENTS);
        let [a, b, c, _, e, f] = self.form().sizes();
        let Some((arcs, radius)) = self.section() else {
            if matches!(self.shape(), Shape::Box { .. }) {
                return joined(&box_rings(DVec3::new(a, b, c), self.rounding(), segments));
            }
            let corners = [(-half, -half), (half, -half), (half, half), (-half, half)];
            return (corners.map(|(x, y)| DVec3::new(x, y, 0.0)).to_vec(), vec![[0, 1, 2], [0, 2, 3]]);
        };
        let Shape::Tube { outer, .. } = *self.shape() else {
            return joined(&revolved(solid(&arcs, radius, segments), segments));
        };
        let mut around = profile(&arcs, radius, segments);
        around.extend(around.first().copied());
        let mut rings = revolved(around, segments);
        // what the bevel takes away is moved up to it
        for point in rings.iter_mut().flatten() {
            point.z = point.z.max((outer - point.x) * e / f);
        }
        joined(&rings)
    }
}

/// With exact zeros along the axes.
fn direction(degrees: f64) -> DVec2 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let exact = |part: f64| if part.abs() < 1e-15 { 0.0 } else { part };
    DVec2::new(exact(cos), exact(sin))
}

/// The points of arcs of a radius, as fine as the circle of so many segments.
fn profile(arcs: &[Arc], radius: f64, segments: usize) -> Vec<DVec2> {
    let points = arcs.iter().flat_map(|&Arc(center, from, to)| {
        let steps = if radius > 0.0 { (segments as f64 * (to - from) / 360.0).ceil().max(1.0) as usize } else { 0 };
        let angle = move |step: usize| from + (to - from) * step as f64 / steps.max(1) as f64;
        (0..=steps).map(move |step| center + radius * direction(angle(step)))
    });
    points.collect()
}

/// The same from the axis and back to it.
fn solid(arcs: &[Arc], radius: f64, segments: usize) -> Vec<DVec2> {
    let mut points = profile(arcs, radius, segments);
    if let (Some(&first), Some(&last)) = (points.first(), points.last()) {
        points.insert(0, DVec2::new(0.0, first.y));
        points.push(DVec2::new(0.0, last.y));
    }
    points
}

/// Each point of a profile turned about the axis.
fn revolved(profile: Vec<DVec2>, segments: usize) -> Vec<Vec<DVec3>> {
    let around: Vec<DVec2> = (0..segments).map(|i| direction(360.0 * i as f64 / segments as f64)).collect();
    let ring = |point: DVec2| around.iter().map(|way| (*way * point.x).extend(point.y)).collect();
    profile.into_iter().map(ring).collect()
}

/// A box with corners of a radius: a ball pulled apart along its axes, with the middles of two faces as poles.
fn box_rings(half: DVec3, radius: f64, segments: usize) -> Vec<Vec<DVec3>> {
    let steps = if radius > 0.0 { segments.div_ceil(4) } else { 0 };
    let quarter = |from: f64| (0..=steps).map(move |step| direction(from + 90.0 * step as f64 / steps.max(1) as f64));
    let ring = |z: f64, way: DVec2| -> Vec<DVec3> {
        let corners = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)].map(DVec2::from);
        let places = corners.into_iter().zip([0.0, 90.0, 180.0, 270.0]).flat_map(|(corner, from)| {
            quarter(from).map(move |around| corner * half.truncate() + around * (way.x * radius))
        });
        places.map(|place| place.extend(z + way.y * radius)).collect()
    };
    let mut rings: Vec<Vec<DVec3>> = quarter(DOWN).map(|way| ring(-half.z, way)).collect();
    rings.extend(quarter(OUT).map(|way| ring(half.z, way)));
    let pole = |z: f64| vec![DVec3::new(0.0, 0.0, z); 4 * (steps + 1)];
    rings.insert(0, pole(-half.z - radius));
    rings.push(pole(half.z + radius));
    rings
}

/// Triangles between one ring and the next; equal points are one, and what has no area is left out.
fn joined(rings: &[Vec<DVec3>]) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let mut points = Vec::new();
    let mut rows = HashMap::new();
    let mut row = |point: DVec3| {
        // zero has two signs
        let bits = (point + DVec3::ZERO).to_array().map(f64::to_bits);
        *rows.entry(bits).or_insert_with(|| {
            points.push(point);
            (points.len() - 1) as u32
        })
    };
    let rings: Vec<Vec<u32>> = rings.iter().map(|ring| ring.iter().map(|&point| row(point)).collect()).collect();
    let mut triangles = Vec::new();
    for pair in rings.windows(2) {
        let [low, high] = [&pair[0], &pair[1]];
        for i in 0..low.len() {
            let next = (i + 1) % low.len();
            for [a, b, c] in [[low[i], low[next], high[next]], [low[i], high[next], high[i]]] {
                if a != b && b != c && c != a {
                    triangles.push([a, b, c]);
                }
            }
        }
    }
    (points, triangles)
}
