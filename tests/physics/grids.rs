//! Meshes of the tests' own: cells of either kind by layer, points moved at will, nodes and elements in any order.

use glam::DVec3;
use sinew::Simulation;
use sinew::mesh::{CellKind, ElementKind};
use std::collections::HashMap;
use std::fmt::Write;
use std::path::Path;

/// Six tetrahedra along the diagonal of a cell, by corner bits (1: upper in x, 2: in y, 4: in z).
const KUHN: [[usize; 4]; 6] = [[0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7]];
/// A hexahedron's corners likewise, in VTK order.
const HEX: [usize; 8] = [0, 1, 3, 2, 4, 5, 7, 6];

/// Two wedges along a diagonal of the bottom, their triangles counter-clockwise seen from above.
const WEDGES: [[usize; 6]; 2] = [[0, 1, 3, 4, 5, 7], [0, 3, 2, 4, 7, 6]];

/// Ends of the edges of a tetrahedron whose middles are nodes, in VTK's order.
pub const EDGES: [[usize; 2]; 6] = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];

/// Points and elements.
#[derive(Clone)]
pub struct Grid {
    pub points: Vec<DVec3>,
    pub elements: Vec<Vec<usize>>,
    /// Whether a point is on no side of the box.
    pub interior: Vec<bool>,
}

/// A box of unit cells; `kind` says what the cells of a layer in z are.
pub fn grid(cells: [usize; 3], kind: impl Fn(usize) -> ElementKind) -> Grid {
    let at = |i: usize, j: usize, k: usize| i + (cells[0] + 1) * (j + (cells[1] + 1) * k);
    let mut grid = Grid { points: Vec::new(), elements: Vec::new(), interior: Vec::new() };
    for k in 0..=cells[2] {
        for j in 0..=cells[1] {
            for i in 0..=cells[0] {
                grid.points.push(DVec3::new(i as f64, j as f64, k as f64));
                let inside = |n: usize, axis: usize| n > 0 && n < cells[axis];
                grid.interior.push(inside(i, 0) && inside(j, 1) && inside(k, 2));
            }
        }
    }
    for k in 0..cells[2] {
        for j in 0..cells[1] {
            for i in 0..cells[0] {
                let corner = |bits: usize| at(i + (bits & 1), j + (bits >> 1 & 1), k + (bits >> 2));
                match kind(k).cell() {
                    CellKind::Tet4 | CellKind::Tet10 => grid.elements.extend(KUHN.map(|tet| tet.map(corner).to_vec())),
                    CellKind::Wedge6 => grid.elements.extend(WEDGES.map(|wedge| wedge.map(corner).to_vec())),
                    _ => grid.elements.push(HEX.map(corner).to_vec()),
                }
            }
        }
    }
    if (0..cells[2]).any(|layer| kind(layer).cell() == CellKind::Tet10) {
        grid.add_middles(cells.map(|n| n as f64));
    }
    grid
}

impl Grid {
    /// Makes the tetrahedra ones of ten nodes; `size`: of the box.
    fn add_middles(&mut self, size: [f64; 3]) {
        let mut middles = HashMap::new();
        for element in self.elements.iter_mut().filter(|element| element.len() == 4) {
            for [a, b] in EDGES.map(|edge| edge.map(|end| element[end])) {
                let row = *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                    let at = 0.5 * (self.points[a] + self.points[b]);
                    self.points.push(at);
                    let inside = |axis: usize| at[axis] > 0.0 && at[axis] < size[axis];
                    self.interior.push((0..3).all(inside));
                    self.points.len() - 1
                });
                element.push(row);
            }
        }
    }

    /// With all middles of edges halfway between their ends.
    pub fn straight(mut self) -> Self {
        for element in self.elements.iter().filter(|element| element.len() == 10) {
            for (node, [a, b]) in (4..).zip(EDGES.map(|edge| edge.map(|end| element[end]))) {
                self.points[element[node]] = 0.5 * (self.points[a] + self.points[b]);
            }
        }
        self
    }

    /// With all points moved.
    pub fn moved(mut self, to: impl FnMut(DVec3) -> DVec3) -> Self {
        self.points = self.points.into_iter().map(to).collect();
        self
    }

    /// With the points that are not on a side moved.
    pub fn distorted(mut self, mut by: impl FnMut(DVec3) -> DVec3) -> Self {
        for (point, _) in self.points.iter_mut().zip(&self.interior).filter(|(_, interior)| **interior) {
            *point += by(*point);
        }
        self
    }

    /// With point `i` at place `points[i]` and element `i` at place `elements[i]`.
    pub fn shuffled(&self, points: &[usize], elements: &[usize]) -> Self {
        let mut other = self.clone();
        for (from, &to) in points.iter().enumerate() {
            other.points[to] = self.points[from];
            other.interior[to] = self.interior[from];
        }
        for (from, &to) in elements.iter().enumerate() {
            other.elements[to] = self.elements[from].iter().map(|&point| points[point]).collect();
        }
        other
    }

    /// Writes a legacy VTK file.
    pub fn write(&self, path: &Path) {
        let mut text = String::from("# vtk DataFile Version 3.0\ntest\nASCII\nDATASET UNSTRUCTURED_GRID\n");
        writeln!(text, "POINTS {} double", self.points.len()).unwrap();
        for p in &self.points {
            writeln!(text, "{:?} {:?} {:?}", p.x, p.y, p.z).unwrap();
        }
        let numbers: usize = self.elements.iter().map(|e| e.len() + 1).sum();
        writeln!(text, "CELLS {} {numbers}", self.elements.len()).unwrap();
        for element in &self.elements {
            let mut nodes: Vec<String> = element.iter().map(usize::to_string).collect();
            if nodes.len() == 6 {
                // VTK looks at the first triangle of a wedge from outside
                nodes.swap(1, 2);
                nodes.swap(4, 5);
            }
            writeln!(text, "{} {}", element.len(), nodes.join(" ")).unwrap();
        }
        writeln!(text, "CELL_TYPES {}", self.elements.len()).unwrap();
        for element in &self.elements {
            writeln!(text, "{}", [10, 13, 12, 24][element.len() / 2 - 2]).unwrap();
        }
        std::fs::write(path, text).unwrap();
    }
}

/// The bits of a body's displacements.
pub fn bits(simulation: &mut Simulation, body: &str) -> Vec<[u64; 3]> {
    simulation.displacements(body).unwrap().iter().map(|u| u.to_array().map(f64::to_bits)).collect()
}
