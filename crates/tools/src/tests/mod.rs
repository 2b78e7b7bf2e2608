//! What tests of tools measure with: triangles, one after the other.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod files;
mod grids;
mod lost;
mod shapes;

use glam::DVec3;
use std::collections::HashMap;

/// Points and triangles.
type Triangles = (Vec<DVec3>, Vec<[u32; 3]>);

fn corners((points, triangles): &Triangles) -> impl Iterator<Item = [DVec3; 3]> {
    triangles.iter().map(|rows| rows.map(|row| points[row as usize]))
}

/// The distance (m) to the nearest point of a triangle: of its plane, if that lies inside, or of an edge.
fn to_triangle(y: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let normal = (b - a).cross(c - a);
    let sides = [(a, b), (b, c), (c, a)];
    if normal != DVec3::ZERO && sides.iter().all(|&(p, q)| normal.cross(q - p).dot(y - p) >= 0.0) {
        return (y - a).dot(normal.normalize()).abs();
    }
    let to_edge = |(p, q): (DVec3, DVec3)| {
        let length = (q - p).length_squared();
        let t = if length > 0.0 { ((y - p).dot(q - p) / length).clamp(0.0, 1.0) } else { 0.0 };
        y.distance(p + t * (q - p))
    };
    sides.into_iter().map(to_edge).fold(f64::INFINITY, f64::min)
}

/// The distance (m) to the nearest of all triangles.
fn to_triangles(y: DVec3, surface: &Triangles) -> f64 {
    corners(surface).map(|triangle| to_triangle(y, triangle)).fold(f64::INFINITY, f64::min)
}

/// How often triangles go round a place: their solid angles (van Oosterom and Strackee 1983).
fn winding(y: DVec3, surface: &Triangles) -> f64 {
    let angle = |triangle: [DVec3; 3]| {
        let [a, b, c] = triangle.map(|corner| corner - y);
        let [x, y, z] = [a.length(), b.length(), c.length()];
        2.0 * a.dot(b.cross(c)).atan2(x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y)
    };
    corners(surface).map(angle).sum::<f64>() / (4.0 * std::f64::consts::PI)
}

/// Volume (m³), by the divergence theorem.
fn volume(surface: &Triangles) -> f64 {
    corners(surface).map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum()
}

/// Each edge is passed once in either direction, and each point is a corner.
fn assert_closed(surface: &Triangles) {
    let mut edges: HashMap<[u32; 2], i32> = HashMap::new();
    let mut used = vec![false; surface.0.len()];
    for &[a, b, c] in &surface.1 {
        for edge in [[a, b], [b, c], [c, a]] {
            *edges.entry(edge).or_default() += 1;
            used[edge[0] as usize] = true;
        }
    }
    for (&[a, b], &times) in &edges {
        assert_eq!((times, edges.get(&[b, a])), (1, Some(&1)), "edge {a} {b}");
    }
    assert!(used.iter().all(|used| *used));
}

/// A place in a cube about a centre, with sides of twice a length.
fn place(dice: &mut fastrand::Rng, center: DVec3, half: f64) -> DVec3 {
    center + DVec3::from_array([0; 3].map(|_| (2.0 * dice.f64() - 1.0) * half))
}
