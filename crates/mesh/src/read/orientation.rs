//! Elements listed inside out, and how they are turned.

use crate::{CellKind, Mesh};

impl Mesh {
    /// Turns elements that list their points in the other order: all of a kind if the whole file does so, single ones
    /// if `flip_inverted` is set. A folded hexahedron, positive at one corner and negative at another, cannot be
    /// turned.
    pub(crate) fn orient(&mut self, flip_inverted: bool) {
        let kinds: Vec<(CellKind, std::ops::Range<usize>)> =
            self.cells.blocks().map(|(kind, rows, _)| (kind, rows)).collect();
        for (kind, rows) in kinds {
            let count = rows.len();
            let Some(solid) = kind.topology().solid else { continue };
            let inside_out: Vec<usize> = rows.filter(|&row| solid.is_inside_out(&self.places(row))).collect();
            if self.notes_of_turning(flip_inverted, inside_out.len(), count, kind.topology().plural) {
                for row in inside_out {
                    let nodes = self.cells.nodes_mut(row);
                    let before = nodes.to_vec();
                    nodes.iter_mut().zip(solid.turned).for_each(|(node, &place)| *node = before[place]);
                }
            }
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
