//! The outer faces of what is left of a mesh; faces of second order as their flat facets.

use rayon::prelude::*;
use sinew::mesh::Cells;

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

impl Faces {
    /// The faces of some cells.
    pub fn new(cells: &Cells) -> Faces {
        let mut faces = Vec::with_capacity(cells.kinds().map(|(kind, n)| kind.topology().faces.len() * n).sum());
        for (cell, (kind, nodes)) in (0..).zip(cells.iter()) {
            let own = kind.topology().faces.iter();
            let facets = own.flat_map(|face| face.facets(nodes));
            faces.extend(facets.map(|points| Face { points: drawn(points, nodes), cell, beyond: NONE }));
        }
        faces.par_sort_unstable_by_key(|face| (key(face.points), face.cell));
        faces.dedup_by(|later, first| {
            let same = first.beyond == NONE && key(later.points) == key(first.points);
            if same {
                first.beyond = later.cell;
            }
            same
        });
        Faces { faces }
    }

    /// The faces between what is there and what is not, and between one group of cells and another, in which case they
    /// are those of the lower group. `group`: which one a cell belongs to; none when it is not there. `skin`: the faces
    /// that the bodies began with, in order.
    pub fn surface(&self, group: impl Fn(u32) -> Option<u8>, skin: Option<&Skin>) -> Vec<Outer> {
        let of = |cell: u32| if cell == NONE { None } else { group(cell) };
        let mut outer = Vec::new();
        for face in &self.faces {
            let (own, other) = (of(face.cell), of(face.beyond));
            // a gap beyond, or a group that hides less
            let first = match (own, other) {
                (Some(own), Some(other)) if own == other => continue,
                (Some(own), Some(other)) => own < other,
                (Some(_), None) => true,
                (None, Some(_)) => false,
                (None, None) => continue,
            };
            let [a, b, c, d] = face.points;
            let (points, cell) = match first {
                true => (face.points, face.cell),
                false if c == d => ([a, c, b, b], face.beyond),
                false => ([a, d, c, b], face.beyond),
            };
            let open = own.is_none() || other.is_none();
            let gone = face.beyond != NONE || skin.is_some_and(|skin| !skin.has(face.points));
            outer.push(Outer { points, cell, group: of(cell).unwrap_or(0), bared: open && gone });
        }
        outer
    }

    /// The faces with one cell.
    pub fn skin(&self) -> Skin {
        // faces are in order of their keys already
        Skin(self.faces.iter().filter(|face| face.beyond == NONE).map(|face| key(face.points)).collect())
    }
}

/// A face that is seen, with its cell.
pub struct Outer {
    /// Counter-clockwise seen from outside; a triangle repeats its last point.
    pub points: [u32; 4],
    /// The cell whose face it is.
    pub cell: u32,
    /// The group of that cell.
    pub group: u8,
    /// Whether it came to be seen because a cell is gone.
    pub bared: bool,
}

/// Faces by their points, in order.
pub struct Skin(Vec<[u32; 4]>);

impl Skin {
    fn has(&self, points: [u32; 4]) -> bool {
        self.0.binary_search(&key(points)).is_ok()
    }
}

/// The points of a face in the order in which they are drawn: a triangle at a cell's last node ends in it, as VTK has
/// them.
fn drawn([a, b, c, d]: [u32; 4], nodes: &[u32]) -> [u32; 4] {
    match nodes.last() {
        Some(&last) if c == d && a == last => [b, c, a, a],
        Some(&last) if c == d && b == last => [c, a, b, b],
        _ => [a, b, c, d],
    }
}

/// The same for all faces with the same points.
fn key(points: [u32; 4]) -> [u32; 4] {
    let mut key = points;
    // a triangle's double must not depend on where the cell begins to count
    if points[2] == points[3] {
        key[..3].sort_unstable();
        key[3] = key[2];
    } else {
        key.sort_unstable();
    }
    key
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
    use super::*;
    use glam::Vec3;
    use sinew::mesh::CellKind;

    #[test]
    fn removed_cells_open_up_new_surface_that_faces_outwards() {
        // two cubes side by side, each of one hexahedron
        let points: Vec<Vec3> =
            (0..12).map(|row| Vec3::new((row / 4) as f32, (row / 2 % 2) as f32, (row % 2) as f32)).collect();
        let cube = |x: u32| [0, 4, 6, 2, 1, 5, 7, 3].map(|corner| 4 * x + corner);
        let cells = |cubes: &[u32]| {
            let cubes: Vec<[u32; 8]> = cubes.iter().map(|&x| cube(x)).collect();
            Cells::of(CellKind::Hex8, &cubes).unwrap()
        };
        let faces = Faces::new(&cells(&[0, 1]));
        let surface = |alive: [f32; 2]| faces.surface(|cell| (alive[cell as usize] != 0.0).then_some(0), None);
        assert_eq!(surface([1.0; 2]).len(), 10);
        assert!(surface([1.0; 2]).iter().all(|face| !face.bared));
        for (alive, middle) in [([1.0, 0.0], 0.5), ([0.0, 1.0], 1.5)] {
            let outer = surface(alive);
            assert_eq!((outer.len(), outer.iter().filter(|face| face.bared).count()), (6, 1));
            assert!(outer.iter().all(|face| alive[face.cell as usize] == 1.0));
            for face in outer.into_iter().map(|face| face.points) {
                let [a, b, c, d] = face.map(|point| points[point as usize] - Vec3::new(middle, 0.5, 0.5));
                assert!((c - a).cross(d - b).dot(a + b + c + d) > 0.0, "{face:?}");
            }
        }
        assert_eq!(surface([0.0, 0.0]).len(), 0);
        // files from which removed cells are left out: the surface of before tells
        let (skin, left) = (faces.skin(), Faces::new(&cells(&[0])));
        let bared = |skin| left.surface(|_| Some(0), skin).iter().filter(|face| face.bared).count();
        assert_eq!((bared(Some(&skin)), bared(None)), (1, 0));
    }

    fn two_tetrahedra() -> Cells {
        Cells::of(CellKind::Tet4, &[[0, 1, 2, 3], [1, 4, 2, 3]]).unwrap()
    }

    #[test]
    fn faces_of_a_tetrahedron_are_drawn_as_vtk_lists_them() {
        let one = Cells::of(CellKind::Tet4, &[[0, 1, 2, 3]]).unwrap();
        let faces: Vec<[u32; 4]> = Faces::new(&one).surface(|_| Some(0), None).iter().map(|face| face.points).collect();
        assert_eq!(faces, [[0, 2, 1, 1], [0, 1, 3, 3], [2, 0, 3, 3], [1, 2, 3, 3]]);
    }

    #[test]
    fn a_face_shared_by_two_tetrahedra_is_inside() {
        let faces = Faces::new(&two_tetrahedra());
        let outer = faces.surface(|_| Some(0), None);
        assert_eq!(outer.len(), 6);
        assert!(outer.iter().all(|face| face.points[2] == face.points[3]));
        assert_eq!(faces.surface(|cell| (cell == 1).then_some(0), None).len(), 4);
    }

    #[test]
    fn a_face_between_two_groups_is_that_of_the_lower_one() {
        let faces = Faces::new(&two_tetrahedra());
        for lower in 0..2 {
            let outer = faces.surface(|cell| Some(u8::from(cell != lower)), None);
            assert_eq!((outer.len(), outer.iter().filter(|face| face.group == 0).count()), (7, 4));
            assert!(outer.iter().all(|face| !face.bared && (face.group == 0) == (face.cell == lower)));
        }
    }
}
