//! The surface of a mesh: faces that belong to exactly one element.

use super::Mesh;
use super::topology::{CellKind, MOST_FACES};
use std::collections::HashMap;

/// A face of the surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SurfaceFace {
    /// Rows of `points`, so that the right-hand normal points outwards; a triangle repeats its last point.
    pub nodes: [u32; 4],
    /// The element it belongs to.
    pub element: u32,
    /// Of a face of second order the middles of its edges, from that between its first two points on.
    pub middles: Option<[u32; 3]>,
}

impl SurfaceFace {
    /// Its points, each once.
    pub fn corners(&self) -> &[u32] {
        &self.nodes[..if self.nodes[2] == self.nodes[3] { 3 } else { 4 }]
    }

    /// Its points, each once: corners, then middles of edges.
    pub fn all_nodes(&self) -> impl Iterator<Item = u32> + '_ {
        self.corners().iter().copied().chain(self.middles.into_iter().flatten())
    }

    /// The flat polygons that it is taken for: itself, or four triangles where it has middles; a triangle repeats its
    /// last point.
    #[doc(hidden)]
    pub fn facets(&self) -> impl Iterator<Item = [u32; 4]> + use<> {
        let [a, b, c, _] = self.nodes;
        let four =
            self.middles.map(|[ab, bc, ca]| [[a, ab, ca, ca], [ab, b, bc, bc], [ca, bc, c, c], [ab, bc, ca, ca]]);
        let whole = four.is_none().then_some(self.nodes);
        whole.into_iter().chain(four.into_iter().flatten())
    }

    /// The triangles it is made of: two of a quadrilateral, four of one with middles.
    pub fn triangles(&self) -> impl Iterator<Item = [u32; 3]> + use<> {
        self.facets().flat_map(|[a, b, c, d]| std::iter::once([a, b, c]).chain((c != d).then_some([a, c, d])))
    }
}

/// A face is numbered `element * FACES + local face`.
const FACES: u64 = MOST_FACES as u64;

impl Mesh {
    /// Faces that belong to exactly one element, sorted by element, then by local face.
    ///
    /// Where a quadrilateral of a hexahedron lies on two triangles of tetrahedra, both sides count as surface: they are
    /// different faces, and nothing but their shared nodes joins them. So they do where a face of second order lies on
    /// one that has no middles.
    pub fn surface(&self) -> Vec<SurfaceFace> {
        self.exposed(|_| true)
    }

    /// The same of the mesh that is left of it: faces that belong to exactly one of the elements that live. Where they
    /// do not touch other kinds of faces, every edge belongs to an even number of them, whatever has been removed: they
    /// are the boundary of what is left, and a boundary has none.
    #[doc(hidden)]
    pub fn exposed(&self, lives: impl Fn(usize) -> bool) -> Vec<SurfaceFace> {
        let mut single = self.single_faces(lives);
        single.sort_unstable();
        single.into_iter().map(|face| self.face(face)).collect()
    }

    /// Every face of every element, by element, then by local face, each with the place of the same face of the element
    /// on its other side; `none` where there is no such element.
    #[doc(hidden)]
    pub fn faces_and_opposites(&self, none: u32) -> Vec<(SurfaceFace, u32)> {
        let (mut faces, mut alike) = (Vec::new(), Vec::new());
        self.each_face(
            |_| true,
            |number, nodes| {
                alike.push((nodes, faces.len() as u32));
                faces.push((self.face(number), none));
            },
        );
        alike.sort_unstable();
        for pair in alike.chunk_by(|a, b| a.0 == b.0).filter(|alike| alike.len() == 2) {
            faces[pair[0].1 as usize].1 = pair[1].1;
            faces[pair[1].1 as usize].1 = pair[0].1;
        }
        faces
    }

    /// The face of a number, its normal outwards.
    fn face(&self, number: u64) -> SurfaceFace {
        let (element, local) = ((number / FACES) as usize, (number % FACES) as usize);
        let corners = self.cells.nodes(element);
        let face = &self.cells.kind(element).topology().faces[local];
        let middles = face.middles().map(|middles| middles.map(|place| corners[place]));
        SurfaceFace { nodes: face.corners(corners), element: element as u32, middles }
    }

    /// Nodes in the middle of edges, by the corners at the ends of these, ascending.
    #[doc(hidden)]
    pub fn middles(&self) -> HashMap<[u32; 2], u32> {
        let mut middles = HashMap::new();
        for (kind, rows, _) in self.cells.blocks() {
            let topology = kind.topology();
            for nodes in rows.map(|row| self.cells.nodes(row)).take_while(|nodes| nodes.len() > topology.corners) {
                for (&[a, b], &middle) in topology.edges.iter().zip(&nodes[topology.corners..]) {
                    middles.insert(ascending(nodes[a], nodes[b]), middle);
                }
            }
        }
        middles
    }

    fn each_face(&self, lives: impl Fn(usize) -> bool, mut see: impl FnMut(u64, [u32; 4])) {
        for (element, (kind, corners)) in (0..).zip(self.cells.iter()).filter(|(element, _)| lives(*element as usize)) {
            for (local, face) in (0..).zip(kind.topology().faces) {
                let mut nodes = sorted(face.corners(corners));
                if let Some(middles) = face.middles() {
                    // else than a face without middles at the same corners
                    nodes[3] = middles.map(|place| corners[place]).into_iter().fold(u32::MAX, u32::min);
                }
                see(element * FACES + local, nodes);
            }
        }
    }

    /// Numbers of faces that occur once. Faces are dealt into one bucket a smallest node, where few remain to compare:
    /// several times faster than sorting all faces.
    fn single_faces(&self, lives: impl Fn(usize) -> bool) -> Vec<u64> {
        let mut starts = vec![0usize; self.points.len() + 1];
        self.each_face(&lives, |_, nodes| starts[nodes[0] as usize + 1] += 1);
        for node in 0..self.points.len() {
            starts[node + 1] += starts[node];
        }
        let mut next = starts.clone();
        let mut dealt = vec![([0u32; 3], 0u64); starts[self.points.len()]];
        self.each_face(&lives, |number, [smallest, rest @ ..]| {
            dealt[next[smallest as usize]] = (rest, number);
            next[smallest as usize] += 1;
        });
        let mut single = Vec::new();
        for bucket in starts.windows(2) {
            let faces = &mut dealt[bucket[0]..bucket[1]];
            faces.sort_unstable();
            let alike = faces.chunk_by(|a, b| a.0 == b.0).filter(|alike| alike.len() == 1);
            single.extend(alike.map(|alike| alike[0].1));
        }
        single
    }
}

/// The ends of an edge, as [`Mesh::middles`] names it.
pub fn ascending(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// The points of a face, each once, by its corners, of which a triangle repeats the last: these, then the
/// [middles](Mesh::middles) of its edges, in their order, where there are some.
#[doc(hidden)]
pub fn nodes_of_face(face: &[u32; 4], middles: &HashMap<[u32; 2], u32>) -> Vec<u32> {
    let corners = &face[..CellKind::of_face(face).node_count()];
    let ends = (0..corners.len()).map(|place| (corners[place], corners[(place + 1) % corners.len()]));
    corners.iter().copied().chain(ends.filter_map(|(a, b)| middles.get(&ascending(a, b)).copied())).collect()
}

/// The nodes of a face in ascending order; of a triangle's repeated last node the copy is moved to the end, so that it
/// stays different from every quadrilateral.
fn sorted([a, b, c, d]: [u32; 4]) -> [u32; 4] {
    if c == d {
        let mut nodes = [a, b, c];
        nodes.sort_unstable();
        [nodes[0], nodes[1], nodes[2], nodes[2]]
    } else {
        let mut nodes = [a, b, c, d];
        nodes.sort_unstable();
        nodes
    }
}
