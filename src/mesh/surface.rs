//! The surface of a mesh: faces that belong to exactly one element.

use super::Mesh;
use super::topology::MOST_FACES;

/// A face of the surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SurfaceFace {
    /// Rows of `points`, so that the right-hand normal points outwards; a triangle repeats its last point.
    pub nodes: [u32; 4],
    /// The element it belongs to.
    pub element: u32,
}

impl SurfaceFace {
    /// Its points, each once.
    pub fn corners(&self) -> &[u32] {
        &self.nodes[..if self.nodes[2] == self.nodes[3] { 3 } else { 4 }]
    }

    /// The triangles it is made of: two of a quadrilateral.
    pub fn triangles(&self) -> impl Iterator<Item = [u32; 3]> + use<> {
        let [a, b, c, d] = self.nodes;
        std::iter::once([a, b, c]).chain((c != d).then_some([a, c, d]))
    }
}

/// A face is numbered `element * FACES + local face`.
const FACES: u64 = MOST_FACES as u64;

impl Mesh {
    /// Faces that belong to exactly one element, sorted by element, then by local face.
    ///
    /// Where a quadrilateral of a hexahedron lies on two triangles of tetrahedra, both sides count as surface: they are
    /// different faces, and nothing but their shared nodes joins them.
    pub fn surface(&self) -> Vec<SurfaceFace> {
        let mut single = self.single_faces();
        single.sort_unstable();
        single.into_iter().map(|face| self.face(face)).collect()
    }

    /// The face of a number, its normal outwards.
    fn face(&self, number: u64) -> SurfaceFace {
        let (element, local) = ((number / FACES) as usize, (number % FACES) as usize);
        let corners = self.cells.nodes(element);
        let nodes = self.cells.kind(element).topology().faces[local].corners(corners);
        SurfaceFace { nodes, element: element as u32 }
    }

    fn each_face(&self, mut see: impl FnMut(u64, [u32; 4])) {
        for (element, (kind, corners)) in (0..).zip(self.cells.iter()) {
            for (local, face) in (0..).zip(kind.topology().faces) {
                see(element * FACES + local, sorted(face.corners(corners)));
            }
        }
    }

    /// Numbers of faces that occur once. Faces are dealt into one bucket a smallest node, where few remain to compare:
    /// several times faster than sorting all faces.
    fn single_faces(&self) -> Vec<u64> {
        let mut starts = vec![0usize; self.points.len() + 1];
        self.each_face(|_, nodes| starts[nodes[0] as usize + 1] += 1);
        for node in 0..self.points.len() {
            starts[node + 1] += starts[node];
        }
        let mut next = starts.clone();
        let mut dealt = vec![([0u32; 3], 0u64); starts[self.points.len()]];
        self.each_face(|number, [smallest, rest @ ..]| {
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
