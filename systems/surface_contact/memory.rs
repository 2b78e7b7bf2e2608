//! What contact between surfaces holds in memory beside the columns of bodies.

use super::{Surface, SurfaceContacts};

/// Bytes on the host.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SurfaceMemory {
    /// Triangles, points, their neighbours and places.
    pub surfaces: usize,
    /// Trees of boxes over the triangles.
    pub trees: usize,
    /// What may be near what, and where nodes were when that was found.
    pub lists: usize,
    /// Pairs of points and triangles in these.
    pub pairs: usize,
    /// What steps have found so far: contacts and the nodes they act on.
    pub step: usize,
}

impl SurfaceMemory {
    /// All of it.
    pub fn total(&self) -> usize {
        self.surfaces + self.trees + self.lists + self.step
    }
}

/// Bytes of the elements of a slice.
fn bytes<T>(slice: &[T]) -> usize {
    size_of_val(slice)
}

impl Surface {
    fn memory(&self) -> SurfaceMemory {
        let Self { facets, nodes, points, places_kept, apart, places, normals, numbers, .. } = self;
        let of_nodes = bytes(nodes) + bytes(places);
        let of_points = bytes(points) + bytes(places_kept) + bytes(apart);
        let of_triangles = self.triangles.bytes() + bytes(facets) + bytes(normals) + bytes(numbers);
        let near = bytes(&self.near.nodes) + bytes(&self.near.triangles);
        let of_pairs = self.faced_by_task.iter().map(|faced| bytes(faced)).sum::<usize>() + bytes(&self.pairs);
        let of_looking = bytes(&self.awake) + bytes(&self.turns);
        let of_step = of_looking + self.gathered.bytes() + bytes(&self.solved) + of_pairs;
        let of_points_near = bytes(&self.wake) + bytes(&self.shortlists) + self.neighbourhoods.bytes();
        let remembered = bytes(&self.pressed) + bytes(&self.touching);
        SurfaceMemory {
            surfaces: of_nodes + of_points + of_triangles + self.crossings.bytes(),
            trees: self.trees.iter().map(|tree| tree.bytes()).sum(),
            lists: self.lists.bytes() + of_points_near + near + self.motion.bytes(),
            pairs: self.lists.triangles.len(),
            step: of_step + remembered,
        }
    }
}

impl SurfaceContacts {
    /// What is held now.
    pub fn memory(&self) -> SurfaceMemory {
        self.surface.memory()
    }
}
