use super::*;

#[test]
fn few_nodes_do_not_move_by_themselves() {
    let few = GROUP_ROWS - 1;
    assert_eq!(inside_of([few, 0]), [0, 0]);
    assert_eq!(inside_of([GROUP_ROWS, few]), [GROUP_ROWS, 0]);
    assert_eq!(inside_of([GROUP_ROWS, GROUP_ROWS]), [GROUP_ROWS; 2]);
    assert_eq!(inside_of([few, few]), [0, 2 * few]);
    assert_eq!(inside_of([1, few - 1]), [0, 0]);
}
