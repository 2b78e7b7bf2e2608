//! Pieces of a mesh: cells that hang together by nodes which they share.

use super::Cells;

/// The piece of a cell that is not there.
#[doc(hidden)]
pub const NO_PIECE: u32 = u32::MAX;

impl Cells {
    /// For each cell the lowest node of its piece, that of all cells which are reached from it over nodes that cells
    /// share which are there; `NO_PIECE` for those that are not. `points`: how many nodes there are.
    #[doc(hidden)]
    pub fn pieces(&self, points: usize, is_there: impl Fn(usize) -> bool) -> Vec<u32> {
        let mut lower: Vec<u32> = (0..points as u32).collect();
        self.hang_together(&mut lower, &is_there);
        let cells = self.iter().enumerate();
        let pieces = cells.map(|(cell, (_, nodes))| match nodes.first() {
            Some(&node) if is_there(cell) => lowest(&mut lower, node),
            _ => NO_PIECE,
        });
        pieces.collect()
    }

    /// For each node the lowest of its piece, with all cells; itself where no cell has it.
    #[doc(hidden)]
    pub fn pieces_of_nodes(&self, points: usize) -> Vec<u32> {
        let mut lower: Vec<u32> = (0..points as u32).collect();
        self.hang_together(&mut lower, |_| true);
        (0..points as u32).map(|node| lowest(&mut lower, node)).collect()
    }

    fn hang_together(&self, lower: &mut [u32], is_there: impl Fn(usize) -> bool) {
        for (_, (_, nodes)) in self.iter().enumerate().filter(|(cell, _)| is_there(*cell)) {
            for pair in nodes.windows(2) {
                let (a, b) = (lowest(lower, pair[0]), lowest(lower, pair[1]));
                lower[a.max(b) as usize] = a.min(b);
            }
        }
    }
}

/// The lowest node that one is known to hang together with; ways there become shorter.
#[doc(hidden)]
pub fn lowest(lower: &mut [u32], mut node: u32) -> u32 {
    while lower[node as usize] != node {
        let next = lower[node as usize];
        lower[node as usize] = lower[next as usize];
        node = next;
    }
    node
}

#[cfg(test)]
mod tests;
