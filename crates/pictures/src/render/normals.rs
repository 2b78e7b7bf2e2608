//! Normals for shading: smooth over what is round, sharp at edges.

use super::picture::Layer;
use glam::Vec3;

/// Cosine of the largest angle between neighbouring faces that still look like one smooth surface (40°).
const CREASE: f32 = 0.766;

/// The normals of a layer's faces, one a corner.
pub fn of_layer(layer: &Layer<'_>) -> Vec<[Vec3; 4]> {
    match layer.flat {
        Some(normal) => vec![[normal; 4]; layer.faces.len()],
        None if !layer.normals.is_empty() && layer.normals.len() == layer.vertices.len() => {
            layer.faces.iter().map(|face| face.map(|point| layer.normals[point as usize])).collect()
        }
        None => of_corners(layer.vertices, layer.faces),
    }
}

/// One normal for each corner of each face (a triangle repeats its last point): the mean of the normals of the faces
/// around that point which lie within 40° of the face's own.
fn of_corners(vertices: &[Vec3], faces: &[[u32; 4]]) -> Vec<[Vec3; 4]> {
    let own: Vec<Vec3> = faces.iter().map(|face| area_vector(vertices, face)).collect();
    let around = Around::new(vertices.len(), faces);
    let corner = |face: usize, point: u32| {
        let direction = own[face].normalize_or_zero();
        let near = |other: &&u32| own[**other as usize].normalize_or_zero().dot(direction) >= CREASE;
        let sum: Vec3 = around.faces(point).iter().filter(near).map(|other| own[*other as usize]).sum();
        sum.normalize_or(direction)
    };
    (0..faces.len()).map(|face| faces[face].map(|point| corner(face, point))).collect()
}

/// Which sides of each face are borders or creases of more than 40°: bit 0 the side from its first corner to its
/// second.
pub fn creases(vertices: &[Vec3], faces: &[[u32; 4]]) -> Vec<u8> {
    let own: Vec<Vec3> = faces.iter().map(|face| area_vector(vertices, face).normalize_or_zero()).collect();
    let mut sides: Vec<([u32; 2], u32, u8)> = Vec::with_capacity(4 * faces.len());
    for (row, face) in faces.iter().enumerate() {
        let count = corners(face).count();
        for side in 0..count {
            let (a, b) = (face[side], face[(side + 1) % count]);
            sides.push(([a.min(b), a.max(b)], row as u32, side as u8));
        }
    }
    sides.sort_unstable();
    let mut found = vec![0; faces.len()];
    for same in sides.chunk_by(|a, b| a.0 == b.0) {
        let smooth = |other: &([u32; 2], u32, u8)| own[same[0].1 as usize].dot(own[other.1 as usize]) >= CREASE;
        if same.len() != 2 || !same.iter().all(smooth) {
            same.iter().for_each(|(_, row, side)| found[*row as usize] |= 1 << side);
        }
    }
    found
}

/// The normal of a face times its area.
fn area_vector(vertices: &[Vec3], face: &[u32; 4]) -> Vec3 {
    let [a, b, c, d] = face.map(|point| vertices[point as usize]);
    // half the cross product of the diagonals: right for triangles too, and the mean over a warped quadrilateral
    let vector = (c - a).cross(d - b) * 0.5;
    if face[2] == face[3] { (b - a).cross(c - a) * 0.5 } else { vector }
}

/// The faces around each point, one list after the other.
struct Around {
    starts: Vec<u32>,
    faces: Vec<u32>,
}

impl Around {
    fn new(points: usize, faces: &[[u32; 4]]) -> Around {
        let mut starts = vec![0u32; points + 2];
        for point in faces.iter().flat_map(corners) {
            starts[point as usize + 2] += 1;
        }
        for point in 2..starts.len() {
            starts[point] += starts[point - 1];
        }
        let mut list = vec![0; starts[points + 1] as usize];
        for (row, face) in faces.iter().enumerate() {
            for point in corners(face) {
                let next = &mut starts[point as usize + 1];
                list[*next as usize] = row as u32;
                *next += 1;
            }
        }
        Around { starts, faces: list }
    }

    fn faces(&self, point: u32) -> &[u32] {
        let point = point as usize;
        &self.faces[self.starts[point] as usize..self.starts[point + 1] as usize]
    }
}

/// The points of a face, each once.
fn corners(face: &[u32; 4]) -> impl Iterator<Item = u32> {
    face.iter().copied().take(if face[2] == face[3] { 3 } else { 4 })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
    use super::*;

    #[test]
    fn a_right_angle_stays_sharp_and_a_flat_bend_becomes_smooth() {
        for (height, smooth) in [(0.2, true), (10.0, false)] {
            let bent = [
                (0.0, 0.0, 0.0),
                (1.0, 0.0, 0.0),
                (1.0, 1.0, 0.0),
                (0.0, 1.0, 0.0),
                (2.0, 0.0, height),
                (2.0, 1.0, height),
            ];
            let vertices = bent.map(Vec3::from);
            let normals = of_corners(&vertices, &[[0, 1, 2, 3], [1, 4, 5, 2]]);
            assert!(normals[0][0].distance(Vec3::Z) < 1e-6);
            assert_eq!(normals[0][1].distance(normals[1][0]) < 1e-6, smooth);
        }
    }

    #[test]
    fn the_edges_of_a_box_are_creases_and_those_within_its_sides_are_not() {
        // two squares in a plane and one upright at their end
        let points = [(0, 0, 0), (1, 0, 0), (2, 0, 0), (0, 1, 0), (1, 1, 0), (2, 1, 0), (2, 0, 1), (2, 1, 1)];
        let vertices = points.map(|(x, y, z)| Vec3::new(x as f32, y as f32, z as f32));
        let found = creases(&vertices, &[[0, 1, 4, 3], [1, 2, 5, 4], [2, 6, 7, 5]]);
        assert_eq!(found, [0b1101, 0b0111, 0b1111]);
    }
}
