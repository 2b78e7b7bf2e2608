//! Elements listed inside out, and how they are turned.

use crate::mesh::Mesh;
use crate::mesh::measure::{hex_determinants, tet_volume};

impl Mesh {
    /// Turns elements that list their points in the other order: all of a kind if the whole file does so, single ones
    /// if `flip_inverted` is set. A folded hexahedron, positive at one corner and negative at another, cannot be
    /// turned.
    pub(in crate::mesh) fn orient(&mut self, flip_inverted: bool) {
        let tets: Vec<usize> = (0..self.tets.len()).filter(|&row| tet_volume(self.tet_corners(row)) < 0.0).collect();
        let inside_out = |&row: &usize| hex_determinants(self.hex_corners(row)).iter().all(|&value| value < 0.0);
        let hexes: Vec<usize> = (0..self.hexes.len()).filter(inside_out).collect();
        let turned_tets = self.notes_of_turning(flip_inverted, tets.len(), self.tets.len(), "tetrahedra");
        let turned_hexes = self.notes_of_turning(flip_inverted, hexes.len(), self.hexes.len(), "hexahedra");
        for row in tets.into_iter().filter(|_| turned_tets) {
            self.tets[row].swap(2, 3);
        }
        for row in hexes.into_iter().filter(|_| turned_hexes) {
            self.hexes[row].rotate_left(4);
        }
    }

    /// Whether `inverted` of `all` elements are to be turned; notes it.
    fn notes_of_turning(&mut self, flip_inverted: bool, inverted: usize, all: usize, kind: &str) -> bool {
        if inverted == 0 {
            return false;
        }
        if inverted == all {
            self.notes
                .push(format!("the file lists the nodes of all {all} {kind} in the other order; they were turned"));
        } else if flip_inverted {
            self.notes.push(format!("{inverted} of {all} {kind} were inverted and have been turned (flip_inverted)"));
        }
        inverted == all || flip_inverted
    }
}
