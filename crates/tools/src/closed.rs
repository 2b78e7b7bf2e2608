//! Closed surfaces, with the normals by which inside and outside are told apart.

use glam::DVec3;
use sinew_mesh::{SurfaceError, Triangles};
use std::collections::HashMap;

/// Lower than this part of its longest side a triangle has no normal.
const FLAT: f64 = 1e-12;

/// The surface of a solid.
pub(super) struct Closed {
    pub surface: Triangles,
    /// Of each triangle: its unit normal, those of its sides (from each corner to the next), those of its corners. The
    /// sign of a distance is that along the normal of the part that is nearest: normals of sides are sums of those of
    /// two triangles, normals of corners are weighted with angles (Bærentzen and Aanæs 2005).
    pub normals: Vec<[DVec3; 7]>,
    /// What the author should know.
    pub notes: Vec<String>,
}

impl Closed {
    pub fn new(surface: &Triangles) -> Result<Self, SurfaceError> {
        surface.check_numbers()?;
        let mut surface = surface.clone();
        surface.merge_points();
        let mut notes = Vec::new();
        let all = surface.triangles.len();
        surface.triangles.retain(|&[a, b, c]| a != b && b != c && c != a);
        if surface.triangles.is_empty() {
            return Err(SurfaceError::Empty);
        }
        let mut edges = surface.edges()?;
        let dropped = all - surface.triangles.len();
        if dropped > 0 {
            notes.push(format!("{dropped} triangles with two corners at one place were left out"));
        }
        let flipped = flip_flat(&mut surface, &mut edges);
        if flipped > 0 {
            notes.push(format!("{flipped} triangles without area were joined with those beside their longest sides"));
        }
        let [low, high] = surface.bounds();
        let volume = surface.volume();
        if volume.abs() <= 1e-12 * (high - low).length().powi(3) {
            return Err(SurfaceError::Flat);
        }
        if volume < 0.0 {
            notes.push("the surface was inside out, and was turned round".into());
            surface.triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
            edges = edges.into_iter().map(|([a, b], triangle)| ([b, a], triangle)).collect();
        }
        let normals = normals(&surface, &edges);
        Ok(Self { surface, normals, notes })
    }
}

/// Twice the area and the longest side of a triangle, the number of this side.
fn measure(surface: &Triangles, triangle: usize) -> (f64, f64, usize) {
    let [a, b, c] = surface.corners(triangle);
    let sides = [b - a, c - b, a - c].map(DVec3::length);
    let longest = (0..3).fold(0, |best, side| if sides[side] > sides[best] { side } else { best });
    ((b - a).cross(c - a).length(), sides[longest], longest)
}

fn is_flat(surface: &Triangles, triangle: usize) -> bool {
    let (area, longest, _) = measure(surface, triangle);
    area <= FLAT * longest * longest
}

/// A triangle without area, whose corners lie on a line, makes its neighbour at the longest side one with a corner more
/// there: two triangles, of other corners. Returns how many were mended so; what cannot be is left as it is.
fn flip_flat(surface: &mut Triangles, edges: &mut HashMap<[u32; 2], u32>) -> usize {
    let mut waiting: Vec<usize> = (0..surface.triangles.len()).rev().filter(|&t| is_flat(surface, t)).collect();
    let (all, mut left) = (waiting.len(), 0);
    // a triangle may have to be flipped again, but not for ever
    let mut most = 16 * all;
    while let Some(triangle) = waiting.pop() {
        if !is_flat(surface, triangle) {
            continue;
        }
        let longest = measure(surface, triangle).2;
        let corners = surface.triangles[triangle];
        // c to a is the longest side, b lies between them
        let [c, a, b] = [0, 1, 2].map(|i| corners[(longest + i) % 3]);
        let Some(&other) = edges.get(&[a, c]) else { continue };
        let d = surface.triangles[other as usize].into_iter().find(|&row| row != a && row != c).unwrap_or(b);
        if d == b || edges.contains_key(&[b, d]) || edges.contains_key(&[d, b]) || most == 0 {
            left += 1;
            continue;
        }
        most -= 1;
        edges.remove(&[a, c]);
        edges.remove(&[c, a]);
        surface.triangles[triangle] = [a, b, d];
        surface.triangles[other as usize] = [b, c, d];
        for (p, q, side) in
            [(a, b, triangle), (b, d, triangle), (d, a, triangle), (b, c, other as usize), (c, d, other as usize)]
        {
            edges.insert([p, q], side as u32);
        }
        edges.insert([d, b], other);
        waiting.extend([triangle, other as usize]);
    }
    all - left.min(all)
}

fn normals(surface: &Triangles, edges: &HashMap<[u32; 2], u32>) -> Vec<[DVec3; 7]> {
    let count = surface.triangles.len();
    let own = |triangle: usize| {
        let [a, b, c] = surface.corners(triangle);
        if is_flat(surface, triangle) { DVec3::ZERO } else { (b - a).cross(c - a).normalize_or_zero() }
    };
    let faces: Vec<DVec3> = (0..count).map(own).collect();
    // a place where surfaces touch at a point only is a corner of its own for each of them
    let mut fans: Vec<u32> = (0..3 * count as u32).collect();
    let corner_at = |triangle: usize, row: u32| {
        let place = surface.triangles[triangle].iter().position(|&other| other == row).unwrap_or(0);
        (3 * triangle + place) as u32
    };
    let neighbour = |triangle: usize, side: usize| {
        let corners = surface.triangles[triangle];
        edges.get(&[corners[(side + 1) % 3], corners[side]]).map_or(triangle, |&other| other as usize)
    };
    for triangle in 0..count {
        for side in 0..3 {
            let other = neighbour(triangle, side);
            for place in [side, (side + 1) % 3] {
                let row = surface.triangles[triangle][place];
                join(&mut fans, (3 * triangle + place) as u32, corner_at(other, row));
            }
        }
    }
    let mut sums = vec![DVec3::ZERO; 3 * count];
    for triangle in 0..count {
        let corners = surface.corners(triangle);
        for place in 0..3 {
            let [at, next, last] = [0, 1, 2].map(|i| corners[(place + i) % 3]);
            let angle = (next - at).angle_between(last - at);
            let fan = root(&mut fans, (3 * triangle + place) as u32);
            if angle.is_finite() {
                sums[fan as usize] += angle * faces[triangle];
            }
        }
    }
    let all = (0..count).map(|triangle| {
        let sides = [0, 1, 2].map(|side| faces[triangle] + faces[neighbour(triangle, side)]);
        let corners = [0, 1, 2].map(|place| sums[root(&mut fans, (3 * triangle + place) as u32) as usize]);
        [faces[triangle], sides[0], sides[1], sides[2], corners[0], corners[1], corners[2]]
    });
    all.collect()
}

/// The first of a set, with the way there made shorter.
fn root(sets: &mut [u32], mut of: u32) -> u32 {
    while sets[of as usize] != of {
        sets[of as usize] = sets[sets[of as usize] as usize];
        of = sets[of as usize];
    }
    of
}

fn join(sets: &mut [u32], one: u32, other: u32) {
    let (one, other) = (root(sets, one), root(sets, other));
    sets[one.max(other) as usize] = one.min(other);
}
