//! The grid of cells that every generator deforms.

use super::ElementKind;
use crate::surface::{ascending, nodes_of_face};
use crate::topology::{CellKind, MOST_NODES, Solid};
use crate::{Mesh, MeshError};
use glam::DVec3;
use std::collections::HashMap;

/// The most cells a generator makes: points and elements are counted in 32 bits.
const MOST_CELLS: u64 = 1_000_000_000;

/// A side of the grid.
#[derive(Clone, Copy)]
pub(super) struct Side {
    axis: usize,
    upper: bool,
}

/// All sides: lower and upper of x, y, z.
pub(super) const SIDES: [Side; 6] = [
    Side { axis: 0, upper: false },
    Side { axis: 0, upper: true },
    Side { axis: 1, upper: false },
    Side { axis: 1, upper: true },
    Side { axis: 2, upper: false },
    Side { axis: 2, upper: true },
];

/// A grid of cells, each filled with elements as their [kind](Solid::in_cube) says; corners are named by bits.
pub(super) struct Grid {
    cells: [u32; 3],
    kind: CellKind,
    /// How many elements a cell becomes.
    parts: u32,
    /// Axes along which the diagonals of the lower half are mirrored, so that they run from the middle outwards.
    mirrored: [bool; 3],
    /// Whether the last row of points along y is the first.
    ring: bool,
}

impl Grid {
    /// A grid of `cells`; refuses none and too many, and elements that it cannot make.
    pub fn new(
        name: &'static str,
        parameter: &'static str,
        cells: [u32; 3],
        kind: ElementKind,
    ) -> Result<Self, MeshError> {
        let Some(parts) = kind.a_cell() else {
            let able = ElementKind::ALL.iter().filter(|kind| kind.a_cell().is_some());
            let allowed =
                format!("generators make {}", able.map(|kind| format!("{kind:?}")).collect::<Vec<_>>().join(", "));
            return Err(MeshError::Parameter { name, parameter: "elements", value: format!("{kind:?}"), allowed });
        };
        let refuse = |allowed: String| {
            Err(MeshError::Parameter {
                name,
                parameter,
                value: format!("{}×{}×{}", cells[0], cells[1], cells[2]),
                allowed,
            })
        };
        if cells.contains(&0) {
            return refuse("there must be at least 1 cell in each direction".into());
        }
        let most = MOST_CELLS.min(u64::from(u32::MAX / parts));
        let count = cells.iter().try_fold(1u64, |product, &n| product.checked_mul(u64::from(n)));
        // with middles of edges a point at each half index
        let times = 1 + u64::from(kind.cell().node_count() > kind.cell().topology().corners);
        let points = cells.iter().try_fold(1u64, |product, &n| product.checked_mul(times * u64::from(n) + 1));
        let fits = |value: Option<u64>, limit: u64| value.is_some_and(|value| value <= limit);
        if !fits(count, most) || !fits(points, u64::from(u32::MAX)) {
            return refuse(format!(
                "at most {most} cells and {} points fit the 32-bit numbers of points and elements",
                u32::MAX
            ));
        }
        Ok(Grid { cells, kind: kind.cell(), parts, mirrored: [false; 3], ring: false })
    }

    /// Lets the diagonals of cells run outwards along these axes. On round shapes a cell in a corner of the grid has
    /// nearly straight angles there; a diagonal through the corner halves them, any other would cut off a flat element.
    /// Neighbours still agree: what they share depends only on indices they share.
    pub fn outward(mut self, axes: [bool; 3]) -> Self {
        self.mirrored = axes;
        self
    }

    /// Closes the grid along y: its two sides there become one. Diagonals must not be mirrored along y.
    pub fn ring(mut self) -> Self {
        self.ring = true;
        self
    }

    /// Points along y.
    fn points_along_y(&self) -> u32 {
        if self.ring { self.cells[1] } else { self.cells[1] + 1 }
    }

    /// The mesh with points placed by their indices, those in the middle of edges by the mean of the indices at their
    /// ends: they are on a curved surface, too, but where that would fold an element: then all edges are straight.
    /// Refuses a grid that does not fit into memory.
    pub fn mesh(&self, place: impl Fn([f64; 3]) -> DVec3) -> Result<Mesh, MeshError> {
        let [nx, ny, nz] = self.cells;
        let mut mesh = Mesh::default();
        let cells = nx as usize * ny as usize * nz as usize;
        let points = (nx as usize + 1) * self.points_along_y() as usize * (nz as usize + 1);
        let (kind, elements) = (self.kind, self.parts as usize * cells);
        let reserved = mesh.points.try_reserve_exact(points);
        let reserved = reserved.and_then(|()| mesh.cells.try_reserve_exact(kind, elements));
        if reserved.is_err() {
            let (name, parameter, value) = ("generator", "number of cells", cells.to_string());
            return Err(MeshError::Parameter { name, parameter, value, allowed: "it must fit into memory".into() });
        }
        for k in 0..=nz {
            for j in 0..self.points_along_y() {
                mesh.points.extend((0..=nx).map(|i| place([i, j, k].map(f64::from))));
            }
        }
        let (topology, mut middles) = (kind.topology(), HashMap::new());
        for k in 0..nz {
            for j in 0..ny {
                for i in 0..nx {
                    let cell = [i, j, k];
                    let halfway = |[a, b]: [usize; 2]| {
                        let along = |corner: usize, axis: usize| f64::from(cell[axis] + (corner >> axis & 1) as u32);
                        place([0, 1, 2].map(|axis| 0.5 * (along(a, axis) + along(b, axis))))
                    };
                    self.elements(cell, |corners| {
                        let nodes = self.nodes(cell, corners, |ends, rows| {
                            *middles.entry(rows).or_insert_with(|| {
                                mesh.points.push(halfway(ends));
                                mesh.points.len() as u32 - 1
                            })
                        });
                        mesh.cells.push_nodes(kind, &nodes[..kind.node_count()]);
                    });
                }
            }
        }
        if topology.nodes.len() > topology.corners && mesh.is_folded() {
            mesh.straighten();
        }
        Ok(mesh)
    }

    /// The row of the point at a corner of a cell.
    fn row(&self, cell: [u32; 3], corner: usize) -> u32 {
        let [i, j, k] = [0, 1, 2].map(|axis| cell[axis] + (corner >> axis & 1) as u32);
        let across = self.points_along_y();
        i + (self.cells[0] + 1) * (j % across + across * k)
    }

    /// Bits of the axes along which a cell's diagonal is mirrored.
    fn mirror(&self, cell: [u32; 3]) -> usize {
        (0..3).map(|axis| usize::from(self.mirrored[axis] && 2 * cell[axis] + 1 < self.cells[axis]) << axis).sum()
    }

    /// The corners (by bits) of the elements of a cell.
    fn elements(&self, cell: [u32; 3], mut see: impl FnMut(&[usize])) {
        let Some(Solid { in_cube, turned, .. }) = self.kind.topology().solid else { return };
        // an element that is the whole cell has no diagonals to mirror
        let mirror = if in_cube.len() == 1 { 0 } else { self.mirror(cell) };
        for part in *in_cube {
            let mut corners = [0; MOST_NODES];
            for place in 0..part.len() {
                // an odd number of mirrors turns an element inside out
                let from = if mirror.count_ones().is_multiple_of(2) { place } else { turned[place] };
                corners[place] = part[from] ^ mirror;
            }
            see(&corners[..part.len()]);
        }
    }

    /// The nodes of an element by its corners in a cell; `middle`: that of the edge between two corners and two rows.
    fn nodes(
        &self,
        cell: [u32; 3],
        corners: &[usize],
        mut middle: impl FnMut([usize; 2], [u32; 2]) -> u32,
    ) -> [u32; MOST_NODES] {
        let topology = self.kind.topology();
        let mut rows = [0; MOST_NODES];
        for (place, &corner) in corners.iter().enumerate() {
            rows[place] = self.row(cell, corner);
        }
        for (place, &[a, b]) in (topology.corners..topology.nodes.len()).zip(topology.edges) {
            rows[place] = middle([corners[a], corners[b]], ascending(rows[a], rows[b]));
        }
        rows
    }

    /// Adds a set of faces and one of their nodes: faces of `sides` that `keep` keeps by their centre.
    pub fn name_faces(&self, mesh: &mut Mesh, name: &str, sides: &[Side], keep: impl Fn(DVec3) -> bool) {
        let mut faces: Vec<[u32; 4]> = sides.iter().flat_map(|&side| self.faces(side)).collect();
        faces.retain(|&[a, b, c, d]| {
            let at = |row: u32| mesh.points[row as usize];
            keep(if c == d { (at(a) + at(b) + at(c)) / 3.0 } else { (at(a) + at(b) + at(c) + at(d)) / 4.0 })
        });
        let middles = mesh.middles();
        let mut nodes: Vec<u32> = faces.iter().flat_map(|face| nodes_of_face(face, &middles)).collect();
        nodes.sort_unstable();
        nodes.dedup();
        mesh.face_sets.insert(name.into(), faces);
        mesh.node_sets.insert(name.into(), nodes);
    }

    /// The faces of a side, their normals outwards.
    fn faces(&self, side: Side) -> Vec<[u32; 4]> {
        let mut faces = Vec::new();
        let first = if side.upper { self.cells[side.axis] - 1 } else { 0 };
        let (u, v) = ((side.axis + 1) % 3, (side.axis + 2) % 3);
        let on_side = |corner: usize| (corner >> side.axis & 1 == 1) == side.upper;
        for j in 0..self.cells[v] {
            for i in 0..self.cells[u] {
                let mut cell = [first; 3];
                (cell[u], cell[v]) = (i, j);
                self.elements(cell, |corners| {
                    let own = self.kind.topology().faces.iter().map(|face| face.corners(corners));
                    let own = own.filter(|face| face.iter().all(|&corner| on_side(corner)));
                    faces.extend(own.map(|face| face.map(|corner| self.row(cell, corner))));
                });
            }
        }
        faces
    }
}

impl Mesh {
    /// Whether an element is turned inside out somewhere.
    fn is_folded(&self) -> bool {
        let folded = |row: usize| {
            let solid = self.cells.kind(row).topology().solid;
            solid.is_some_and(|solid| solid.corner_volumes(&self.places(row)).any(|volume| volume <= 0.0))
        };
        (0..self.element_count()).any(folded)
    }

    /// Puts the middles of edges halfway between their ends.
    fn straighten(&mut self) {
        for ([a, b], middle) in self.middles() {
            self.points[middle as usize] = 0.5 * (self.points[a as usize] + self.points[b as usize]);
        }
    }
}
