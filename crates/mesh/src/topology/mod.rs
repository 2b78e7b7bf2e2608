//! Reference cells: what is known of a kind of cell, in one place. A kind is one file here and one line in
//! [`CellKind`]; readers, writers, surfaces, refinement, pictures and elements take their tables from it.
//!
//! Nodes stand in VTK's order but where the kind says otherwise: corners first, then, in cells of second order, the
//! middles of the edges in the order of [`Topology::edges`].

pub mod flat;
pub mod foreign;
pub mod hex8;
mod isoparametric;
pub mod tet10;
pub mod tet4;
pub mod wedge6;

pub use isoparametric::{Located, Shape};

use glam::DVec3;

/// Nodes of the kind that has most.
pub const MOST_NODES: usize = 10;
/// Faces of the kind that has most.
pub const MOST_FACES: usize = 6;
/// Points of the [`Split`] that has most.
pub const MOST_SPLIT_POINTS: usize = 27;
/// Corners between which a point of a [`Split`] lies that has most.
pub const MOST_PARENTS: usize = 8;

// exactly what the kinds need: a kind that has more does not compile
const _: () = {
    const fn larger(a: usize, b: usize) -> usize {
        if a > b { a } else { b }
    }
    let (mut nodes, mut faces, mut points, mut parents) = (0, 0, 0, 0);
    let mut kind = 0;
    while kind < CellKind::ALL.len() {
        let topology = CellKind::ALL[kind].topology();
        nodes = larger(nodes, topology.nodes.len());
        faces = larger(faces, topology.faces.len());
        if let Some(split) = topology.split {
            points = larger(points, split.points.len());
            let mut point = 0;
            while point < split.points.len() {
                parents = larger(parents, split.points[point].len());
                point += 1;
            }
        }
        kind += 1;
    }
    assert!(nodes == MOST_NODES && faces == MOST_FACES && points == MOST_SPLIT_POINTS && parents == MOST_PARENTS);
};

/// Makes [`CellKind`] of its kinds and where they are described.
macro_rules! cell_kinds {
    ($($(#[$doc:meta])* $kind:ident => $topology:path,)*) => {
        /// A kind of cell. Their order is that of the cells of a mesh: tetrahedra first.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum CellKind {
            $($(#[$doc])* $kind,)*
        }

        impl CellKind {
            /// All kinds, ascending.
            pub const ALL: [CellKind; [$(CellKind::$kind),*].len()] = [$(CellKind::$kind),*];

            /// What is known of it.
            pub const fn topology(self) -> &'static Topology {
                match self {
                    $(Self::$kind => &$topology,)*
                }
            }
        }
    };
}

cell_kinds! {
    /// One point.
    Point => flat::POINT,
    /// Two points.
    Line => flat::LINE,
    /// Three points.
    Triangle => flat::TRIANGLE,
    /// Four points, in order around it.
    Quad => flat::QUAD,
    /// Four-node tetrahedron: the fourth point lies on the side that the right-hand normal of the first three points
    /// to.
    Tet4 => tet4::TET4,
    /// Eight-node hexahedron: bottom counter-clockwise seen from above, then the top.
    Hex8 => hex8::HEX8,
    /// Six-node wedge: the bottom counter-clockwise seen from the top, then the top.
    Wedge6 => wedge6::WEDGE6,
    /// A line of second order: its ends, then its middle.
    Line3 => flat::LINE3,
    /// A triangle of second order: its corners, then the middles of its edges.
    Triangle6 => flat::TRIANGLE6,
    /// Ten-node tetrahedron: corners as of four nodes, then the middles of its edges.
    Tet10 => tet10::TET10,
}

/// What is known of a kind of cell.
pub struct Topology {
    /// Its name in scenes and reports.
    pub name: &'static str,
    /// What many of them are called.
    pub plural: &'static str,
    /// 0 for points to 3 for cells that fill space.
    pub dimension: u8,
    /// Reference coordinates of its nodes.
    pub nodes: &'static [[f64; 3]],
    /// How many of the nodes are corners: the first. A node after them is the middle of the edge of the same place.
    pub corners: usize,
    /// Edges by the corners at their ends.
    pub edges: &'static [[usize; 2]],
    /// Faces by local nodes, counter-clockwise seen from outside; none but of cells that fill space.
    pub faces: &'static [Face],
    /// The flat polygons that a cell of two dimensions is taken for where flat ones are needed: in pictures, and by
    /// rays and areas; a triangle repeats its last node.
    pub facets: &'static [[usize; 4]],
    /// VTK's types: the first is written, all are read.
    pub vtk: &'static [Listing],
    /// Gmsh's type.
    pub gmsh: Listing,
    /// How it is refined, if it is.
    pub split: Option<&'static Split>,
    /// What cells that fill space have besides.
    pub solid: Option<&'static Solid>,
}

/// A face of a cell.
pub struct Face {
    /// What it is.
    pub kind: CellKind,
    /// Nodes of the cell, in the face's own order.
    pub nodes: &'static [usize],
}

impl Face {
    /// The corners of the face of a cell; a triangle repeats its last.
    pub fn corners<T: Copy>(&self, nodes: &[T]) -> [T; 4] {
        // three or four
        let last = self.kind.topology().corners - 1;
        [0, 1, 2, last].map(|place| nodes[self.nodes[place]])
    }

    /// Which nodes of the cell are the middles of its edges, if it has middles: a triangle's.
    pub fn middles(&self) -> Option<[usize; 3]> {
        self.nodes.get(self.kind.topology().corners..)?.first_chunk().copied()
    }

    /// The [facets](Topology::facets) of the face of a cell.
    pub fn facets<T: Copy>(&self, nodes: &[T]) -> impl Iterator<Item = [T; 4]> {
        self.kind.topology().facets.iter().map(move |facet| facet.map(|place| nodes[self.nodes[place]]))
    }
}

/// How files name a kind and in which order they list its nodes.
pub struct Listing {
    /// The type's number.
    pub number: u8,
    /// For each of the cell's nodes, its place in the file's list.
    pub order: &'static [usize],
}

/// How a cell is cut into smaller ones of its kind: a cell that fills space into eight, a face into four.
pub struct Split {
    /// Points of the parts: each the middle of these corners. New ones are made in this order.
    pub points: &'static [&'static [usize]],
    /// Parts by places in `points`; of cells of second order by their corners.
    pub parts: &'static [&'static [usize]],
    /// Ways to cut what these parts leave: that with the shortest diagonal is taken.
    pub inner: &'static [Diagonal],
}

/// An octahedron cut along one of its diagonals.
pub struct Diagonal {
    /// Its ends, by places in [`Split::points`].
    pub ends: [usize; 2],
    /// The other four around it, right-handed: a part has the ends and two that follow each other.
    pub ring: [usize; 4],
}

/// By what rule the mass of a cell goes to its nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MassRule {
    /// Sums of the rows of the consistent mass matrix: ∫ N_a.
    RowSum,
    /// Hinton, Rock and Zienkiewicz (1976): its diagonal ∫ N_a², scaled so that all masses together are the cell's.
    /// Always above 0, where row sums of second order are not.
    Hrz,
}

/// What a cell that fills space has besides.
pub struct Solid {
    /// Values and natural gradients of the shape functions at a place of the reference cell.
    pub shape: fn([f64; 3]) -> Shape,
    /// Places and weights that integrate the determinant of the Jacobian exactly.
    pub quadrature: &'static [([f64; 3], f64)],
    /// By what rule the mass goes to the nodes.
    pub mass: MassRule,
    /// What the rule gives each node of the reference cell, 1 together. A distorted cell keeps these shares, as masses
    /// are lumped everywhere: its mass is right, its centre of mass not quite where the rule would put it for its own
    /// shape (for [`MassRule::Hrz`], ∫ N_a² with its own Jacobian).
    pub shares: &'static [f64],
    /// Three neighbours of each corner at which the Jacobian has to be looked at, so that corner and neighbours make a
    /// right-handed frame; none where the determinant is the same everywhere, or edges may be curved.
    pub frames: &'static [[usize; 4]],
    /// Places of the reference cell at which the Jacobian of the shape functions has to be looked at, where edges may
    /// be curved.
    pub samples: &'static [[f64; 3]],
    /// Mean edges along the three directions (m); their triple product is proportional to the determinant in the
    /// middle.
    pub axes: fn(&[DVec3]) -> [DVec3; 3],
    /// Volume of the affine cell whose axes, and whose frames, have the triple product 1.
    pub unit_volume: f64,
    /// Signed volume (m³).
    pub volume: fn(&[DVec3]) -> f64,
    /// Smallest altitude (m).
    pub smallest_altitude: fn(&[DVec3]) -> f64,
    /// How good its shape is: 1 is regular, 0 is flat, below 0 is inside out.
    pub quality: fn(&[DVec3]) -> f64,
    /// Where in the cell a point (m) lies.
    pub locate: fn(&[DVec3], DVec3) -> Located,
    /// The order in which the nodes stand when the cell is turned inside out.
    pub turned: &'static [usize],
    /// How many of them fill a cube whose corners are named by bits (1 upper in the first direction, 2 in the second, 4
    /// in the third), by their corners; none where these do not say. Cubes side by side meet in the same faces.
    pub in_cube: &'static [&'static [usize]],
}

impl CellKind {
    /// How many nodes it has.
    pub const fn node_count(self) -> usize {
        self.topology().nodes.len()
    }

    /// What share of a cell's mass each of its nodes has: [`Solid::shares`]; none of a kind that does not fill space.
    #[doc(hidden)]
    pub const fn shares(self) -> &'static [f64] {
        match self.topology().solid {
            Some(solid) => solid.shares,
            None => &[],
        }
    }

    /// The least of the [shares](CellKind::shares).
    #[doc(hidden)]
    pub const fn least_share(self) -> f64 {
        let (shares, mut least, mut node) = (self.shares(), 1.0, 0);
        while node < shares.len() {
            if shares[node] < least {
                least = shares[node];
            }
            node += 1;
        }
        least
    }

    /// Kinds that fill space, with what these have besides.
    #[doc(hidden)]
    pub fn solids() -> impl Iterator<Item = (CellKind, &'static Solid)> {
        Self::ALL.into_iter().filter_map(|kind| Some((kind, kind.topology().solid?)))
    }

    /// The kind of a type of VTK and how files list its nodes; else the name and the dimension of what sinew cannot use
    /// (3 where it is not known).
    #[doc(hidden)]
    pub fn of_vtk(number: u8) -> Result<(CellKind, &'static Listing), (String, u8)> {
        let listings = Self::ALL.into_iter().flat_map(|kind| kind.topology().vtk.iter().map(move |l| (kind, l)));
        listings.into_iter().find(|(_, listing)| listing.number == number).ok_or_else(|| {
            let known = foreign::CELLS.iter().find(|cell| cell.vtk == Some(number));
            known.map_or((format!("cells of VTK type {number}"), 3), |cell| (cell.plural.into(), cell.dimension))
        })
    }

    /// The kind of a type of Gmsh.
    #[doc(hidden)]
    pub fn of_gmsh(number: u64) -> Option<CellKind> {
        Self::ALL.into_iter().find(|kind| u64::from(kind.topology().gmsh.number) == number)
    }
}

/// What one of many is called, by the plural of a kind.
pub fn singular(plural: &str) -> String {
    match plural.strip_suffix("hedra") {
        Some(stem) => format!("{stem}hedron"),
        None => plural.trim_end_matches('s').to_string(),
    }
}

impl Listing {
    /// The nodes of a cell from those that a file lists.
    pub fn read<'a, T: Copy>(&'a self, listed: &'a [T]) -> impl ExactSizeIterator<Item = T> + 'a {
        self.order.iter().map(|&place| listed[place])
    }

    /// The nodes of a cell as a file lists them.
    pub fn write<T: Copy + Default>(&self, nodes: &[T]) -> impl ExactSizeIterator<Item = T> + use<T> {
        debug_assert_eq!(nodes.len(), self.order.len());
        let mut listed = [T::default(); MOST_NODES];
        self.order.iter().zip(nodes).for_each(|(&place, &node)| listed[place] = node);
        listed.into_iter().take(nodes.len())
    }

    /// Whether files list the nodes in the cell's own order.
    pub fn keeps_order(&self) -> bool {
        self.order.is_sorted()
    }
}

impl Split {
    /// How many parts there are.
    pub const fn count(&self) -> usize {
        self.parts.len() + if self.inner.is_empty() { 0 } else { 4 }
    }

    /// The parts of a cell, as places in [`Split::points`]; `at`: where the points of these places are (m).
    pub fn parts(&self, at: impl Fn(usize) -> DVec3, mut see: impl FnMut(&[usize])) {
        self.parts.iter().for_each(|part| see(part));
        let length = |diagonal: &Diagonal| at(diagonal.ends[0]).distance_squared(at(diagonal.ends[1]));
        let shorter = |shortest, other| if length(other) < length(shortest) { other } else { shortest };
        if let Some(Diagonal { ends: [a, b], ring }) = self.inner.iter().reduce(shorter) {
            (0..4).for_each(|i| see(&[*a, *b, ring[i], ring[(i + 1) % 4]]));
        }
    }
}

impl Solid {
    /// The volume (m³) of a cell that had everywhere the Jacobian of the middle of this one: an affine cell's own.
    pub fn middle_volume(&self, p: &[DVec3]) -> f64 {
        let [a, b, c] = (self.axes)(p);
        a.cross(b).dot(c) * self.unit_volume
    }

    /// The same of the corners, and of the places within, that have to be looked at.
    pub fn corner_volumes<'a>(&'a self, p: &'a [DVec3]) -> impl Iterator<Item = f64> + 'a {
        let frame = |&[o, a, b, c]: &[usize; 4]| (p[a] - p[o]).cross(p[b] - p[o]).dot(p[c] - p[o]);
        let sample = |at: &[f64; 3]| (self.shape)(*at).jacobian(p).determinant();
        self.frames.iter().map(frame).chain(self.samples.iter().map(sample)).map(|product| product * self.unit_volume)
    }

    /// Whether the Jacobian is the same everywhere.
    pub const fn is_affine(&self) -> bool {
        self.frames.is_empty() && self.samples.is_empty()
    }

    /// Whether a cell lists its nodes in the other order: it is negative everywhere.
    pub fn is_inside_out(&self, p: &[DVec3]) -> bool {
        match self.is_affine() {
            true => (self.volume)(p) < 0.0,
            false => self.corner_volumes(p).chain([self.middle_volume(p)]).all(|value| value < 0.0),
        }
    }
}
