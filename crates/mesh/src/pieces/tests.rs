#![allow(clippy::unwrap_used)]

use super::*;
use crate::CellKind;

#[test]
fn cells_that_share_a_node_are_one_piece_until_the_cell_between_them_is_gone() {
    // 0-1-2-3, 3-4-5-6 over node 3, 10-11-12-13 apart, 7-8-9-6 over node 6
    let cells = [[1, 0, 2, 3], [3, 4, 5, 6], [13, 12, 11, 10], [7, 8, 9, 6]];
    let cells = Cells::of(CellKind::Tet4, &cells).unwrap();
    assert_eq!(cells.pieces(14, |_| true), [0, 0, 10, 0]);
    assert_eq!(cells.pieces(14, |cell| cell != 1), [0, NO_PIECE, 10, 6]);
    assert_eq!(cells.pieces(14, |_| false), [NO_PIECE; 4]);
}
