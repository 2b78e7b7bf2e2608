//! The outer faces of what is left of a mesh.

use rayon::prelude::*;

/// All faces of a mesh with the one or two cells at each.
pub struct Faces {
    faces: Vec<Face>,
}

struct Face {
    /// Counter-clockwise seen from outside of the first cell; a triangle repeats its last point.
    points: [u32; 4],
    /// The cell whose face this is.
    cell: u32,
    /// The cell beyond, or `NONE`.
    beyond: u32,
}

const NONE: u32 = u32::MAX;

/// Faces seen from outside, VTK's order of corners.
const TET: [[usize; 4]; 4] = [[0, 2, 1, 1], [0, 1, 3, 3], [1, 2, 3, 3], [2, 0, 3, 3]];
const HEX: [[usize; 4]; 6] = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];

impl Faces {
    /// The faces of a mesh: `corners` holds four a tetrahedron, then eight a hexahedron.
    pub fn new(corners: &[u32], tets: usize) -> Faces {
        let (tet_corners, hex_corners) = corners.split_at(4 * tets);
        let mut faces = Vec::with_capacity(corners.len());
        let mut add = |cell: usize, corners: &[u32], face: &[usize; 4]| {
            faces.push(Face { points: face.map(|corner| corners[corner]), cell: cell as u32, beyond: NONE });
        };
        for (cell, corners) in tet_corners.chunks_exact(4).enumerate() {
            TET.iter().for_each(|face| add(cell, corners, face));
        }
        for (cell, corners) in hex_corners.chunks_exact(8).enumerate() {
            HEX.iter().for_each(|face| add(tets + cell, corners, face));
        }
        let key = |face: &Face| {
            let mut key = face.points;
            key.sort_unstable();
            // a triangle's double must not depend on where the cell begins to count
            if face.points[2] == face.points[3] {
                let mut three = [face.points[0], face.points[1], face.points[2]];
                three.sort_unstable();
                key = [three[0], three[1], three[2], three[2]];
            }
            key
        };
        faces.par_sort_unstable_by_key(|face| (key(face), face.cell));
        faces.dedup_by(|later, first| {
            let same = first.beyond == NONE && key(later) == key(first);
            if same {
                first.beyond = later.cell;
            }
            same
        });
        Faces { faces }
    }

    /// The faces between what is alive and what is not, or nothing; each with its living cell. Without `alive`, all cells
    /// are.
    pub fn surface(&self, alive: Option<&[f32]>) -> (Vec<[u32; 4]>, Vec<u32>) {
        let lives = |cell: u32| cell != NONE && alive.is_none_or(|alive| alive[cell as usize] != 0.0);
        let mut outer = (Vec::new(), Vec::new());
        for face in &self.faces {
            let [a, b, c, d] = face.points;
            let (points, cell) = match (lives(face.cell), lives(face.beyond)) {
                (true, false) => (face.points, face.cell),
                (false, true) if c == d => ([a, c, b, b], face.beyond),
                (false, true) => ([a, d, c, b], face.beyond),
                _ => continue,
            };
            outer.0.push(points);
            outer.1.push(cell);
        }
        outer
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
    use super::*;
    use glam::Vec3;

    #[test]
    fn removed_cells_open_up_new_surface_that_faces_outwards() {
        // two cubes side by side, each of one hexahedron
        let points: Vec<Vec3> =
            (0..12).map(|row| Vec3::new((row / 4) as f32, (row / 2 % 2) as f32, (row % 2) as f32)).collect();
        let cube = |x: u32| [0, 4, 6, 2, 1, 5, 7, 3].map(|corner| 4 * x + corner);
        let faces = Faces::new(&[cube(0), cube(1)].concat(), 0);
        assert_eq!(faces.surface(None).0.len(), 10);
        for (alive, middle) in [([1.0, 0.0], 0.5), ([0.0, 1.0], 1.5)] {
            let (outer, cells) = faces.surface(Some(&alive));
            assert_eq!(outer.len(), 6);
            assert!(cells.iter().all(|&cell| alive[cell as usize] == 1.0));
            for face in outer {
                let [a, b, c, d] = face.map(|point| points[point as usize] - Vec3::new(middle, 0.5, 0.5));
                assert!((c - a).cross(d - b).dot(a + b + c + d) > 0.0, "{face:?}");
            }
        }
        assert_eq!(faces.surface(Some(&[0.0, 0.0])).0.len(), 0);
    }

    #[test]
    fn a_face_shared_by_two_tetrahedra_is_inside() {
        let faces = Faces::new(&[0, 1, 2, 3, 1, 4, 2, 3], 2);
        let (outer, _) = faces.surface(None);
        assert_eq!(outer.len(), 6);
        assert!(outer.iter().all(|face| face[2] == face[3]));
        assert_eq!(faces.surface(Some(&[0.0, 1.0])).0.len(), 4);
    }
}
