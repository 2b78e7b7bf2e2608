//! Where a plane cuts cells: polygons that close them.

use super::plane::Plane;
use glam::Vec3;
use sinew::mesh::CellKind;
use sinew::mesh::topology::MOST_NODES;

/// A cut through some cells, as triangles.
#[derive(Default)]
pub struct Section {
    /// Positions (m).
    pub vertices: Vec<Vec3>,
    /// What is coloured, one a vertex.
    pub values: Vec<f32>,
    /// Triangles; the last point is repeated.
    pub faces: Vec<[u32; 4]>,
    /// Which sides of each triangle lie on a face of a cell: bit 0 that from its first to its second point, and so on.
    pub sides: Vec<u8>,
}

/// A corner: its place (m), how far it is beyond the plane (m), and its value.
type Corner = (Vec3, f32, f32);

/// Pairs of a tetrahedron's corners whose edges are cut when one of it, the first, is alone on its side, and the corner
/// that is opposite to the face between an edge and the next.
const ALONE: [[usize; 3]; 4] = [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]];

impl Section {
    /// Adds a cell with its nodes. One with quadrilaterals is taken as tetrahedra about its middle and those of its
    /// faces, which is how faces are drawn: the cut of a cell meets those of its neighbours and the surface without a
    /// gap.
    pub fn add(&mut self, plane: &Plane, kind: CellKind, points: &[Vec3], values: &[f32]) {
        let corner = |row: usize| (points[row], plane.beyond(points[row]), values[row]);
        let sides = (0..points.len()).map(|row| plane.beyond(points[row]));
        let (low, high) = sides.fold((f32::MAX, f32::MIN), |(low, high), beyond| (low.min(beyond), high.max(beyond)));
        if !(low <= 0.0 && high > 0.0) {
            return;
        }
        if kind == CellKind::Tet4 {
            self.tetrahedron([0, 1, 2, 3].map(corner), [true; 4]);
            return;
        }
        let mean = |rows: &[usize]| {
            let share = 1.0 / rows.len() as f32;
            let place = rows.iter().map(|row| points[*row]).sum::<Vec3>() * share;
            (place, plane.beyond(place), rows.iter().map(|row| values[*row]).sum::<f32>() * share)
        };
        let all: [usize; MOST_NODES] = std::array::from_fn(|row| row);
        let centre = mean(&all[..points.len()]);
        for facet in kind.topology().faces.iter().flat_map(|face| face.facets(&all)) {
            let face = &facet[..if facet[2] == facet[3] { 3 } else { 4 }];
            let middle = mean(face);
            for side in 0..face.len() {
                let (a, b) = (corner(face[side]), corner(face[(side + 1) % face.len()]));
                // only the side opposite to the cell's middle lies on a face of it
                self.tetrahedron([centre, middle, a, b], [true, false, false, false]);
            }
        }
    }

    /// Adds the cut through a tetrahedron; `outer`: whether the side opposite to each corner is one of a cell's faces.
    fn tetrahedron(&mut self, corners: [Corner; 4], outer: [bool; 4]) {
        let beyond = corners.map(|corner| corner.1 > 0.0);
        let bit = |outer: bool, place: u8| u8::from(outer) << place;
        match beyond.iter().filter(|beyond| **beyond).count() {
            count @ (1 | 3) => {
                let Some(lone) = beyond.iter().position(|beyond| *beyond == (count == 1)) else { return };
                let [a, b, c] = ALONE[lone];
                let points = [a, b, c].map(|other| self.point(&corners[lone], &corners[other]));
                // the line from one cut edge to the next lies on the face opposite to the third corner
                let sides = bit(outer[c], 0) | bit(outer[a], 1) | bit(outer[b], 2);
                self.triangle(points, sides);
            }
            2 => {
                let of = |wanted: bool| (0..4).filter(move |row| beyond[*row] == wanted);
                let (over, under): (Vec<usize>, Vec<usize>) = (of(true).collect(), of(false).collect());
                let ([a, b], [c, d]) = ([over[0], over[1]], [under[0], under[1]]);
                let ring = [(a, c), (a, d), (b, d), (b, c)].map(|(x, y)| self.point(&corners[x], &corners[y]));
                self.triangle([ring[0], ring[1], ring[2]], bit(outer[b], 0) | bit(outer[c], 1));
                self.triangle([ring[0], ring[2], ring[3]], bit(outer[a], 1) | bit(outer[d], 2));
            }
            _ => (),
        }
    }

    /// The point where an edge is cut, between ends on both sides.
    fn point(&mut self, from: &Corner, to: &Corner) -> u32 {
        let share = from.1 / (from.1 - to.1);
        self.vertices.push(from.0.lerp(to.0, share));
        self.values.push(from.2 + (to.2 - from.2) * share);
        self.vertices.len() as u32 - 1
    }

    fn triangle(&mut self, [a, b, c]: [u32; 3], sides: u8) {
        self.faces.push([a, b, c, c]);
        self.sides.push(sides);
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
    use super::*;
    use glam::DVec3;
    use sinew::scene::schema::Cut;

    fn area(section: &Section) -> f32 {
        let point = |row: u32| section.vertices[row as usize];
        section
            .faces
            .iter()
            .map(|[a, b, c, _]| (point(*b) - point(*a)).cross(point(*c) - point(*a)).length() / 2.0)
            .sum()
    }

    /// A unit cube, as one hexahedron or as six tetrahedra, and values that are linear in place.
    fn cut(normal: DVec3, point: DVec3, tets: bool) -> Section {
        let corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)];
        let points = corners.map(|(x, y, z)| Vec3::new(x as f32, y as f32, z as f32));
        let value = |point: &Vec3| 3.0 * point.x - 2.0 * point.y + point.z;
        let plane = Plane::new(&Cut { point, normal }, 1.0);
        let mut section = Section::default();
        let six = [[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6]];
        let cells: Vec<Vec<Vec3>> = match tets {
            false => vec![points.to_vec()],
            true => six.iter().map(|tet| tet.iter().map(|&row: &usize| points[row]).collect()).collect(),
        };
        for cell in cells {
            let kind = if tets { CellKind::Tet4 } else { CellKind::Hex8 };
            section.add(&plane, kind, &cell, &cell.iter().map(value).collect::<Vec<_>>());
        }
        for (point, found) in section.vertices.iter().zip(&section.values) {
            assert!((value(point) - found).abs() < 1e-5, "{point}: {found}");
            assert!(plane.beyond(*point).abs() < 1e-6);
        }
        section
    }

    #[test]
    fn the_cut_of_a_cube_has_the_area_of_its_polygon() {
        let middle = DVec3::splat(0.5);
        for tets in [false, true] {
            for (normal, point, exact) in [
                (DVec3::X, DVec3::splat(0.3), 1.0),
                (DVec3::new(1.0, 1.0, 0.0), middle, 2f32.sqrt()),
                // a regular hexagon through the middle, and a triangle near a corner
                (DVec3::ONE, middle, 3.0 * 3f32.sqrt() / 4.0),
                (DVec3::ONE, DVec3::splat(0.1), 0.5 * (0.3f32 * 2f32.sqrt()).powi(2) * 0.75f32.sqrt()),
                // on a face of the cell: that is the surface's to draw
                (DVec3::X, DVec3::X, 0.0),
                (DVec3::NEG_X, DVec3::X, 1.0),
                (DVec3::X, DVec3::splat(1.5), 0.0),
            ] {
                let found = area(&cut(normal, point, tets));
                assert!((found - exact).abs() < 1e-5, "{normal} {point} {tets}: {found}, not {exact}");
            }
        }
    }

    #[test]
    fn only_the_outline_of_a_cell_is_drawn_as_its_edge() {
        for tets in [false, true] {
            let section = cut(DVec3::Z, DVec3::splat(0.4), tets);
            let mut length = 0.0;
            for (face, sides) in section.faces.iter().zip(&section.sides) {
                for side in (0..3).filter(|side| sides >> side & 1 == 1) {
                    let (a, b) = (face[side], face[(side + 1) % 3]);
                    length += section.vertices[a as usize].distance(section.vertices[b as usize]);
                }
            }
            // the square, and between six tetrahedra the diagonals twice
            let exact = if tets { 4.0 + 2.0 * between_tets() } else { 4.0 };
            assert!((length - exact).abs() < 1e-5, "{tets}: {length}");
        }
    }

    /// The lines in z = 0.4 between the six tetrahedra about the diagonal of a unit cube: each side of it is cut along
    /// the lines from (0.4, 0.4) to where a diagonal or an edge of the cube's surface passes.
    fn between_tets() -> f32 {
        let middle = glam::Vec2::splat(0.4);
        let ends = [(0.0, 0.0), (0.4, 0.0), (1.0, 0.4), (1.0, 1.0), (0.4, 1.0), (0.0, 0.4)];
        ends.iter().map(|(x, y)| middle.distance(glam::Vec2::new(*x, *y))).sum()
    }
}
