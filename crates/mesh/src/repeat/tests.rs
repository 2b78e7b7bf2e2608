#![allow(clippy::expect_used)]

use super::*;
use crate::{CellKind, ElementKind, generators::box_mesh};

#[test]
fn copies_share_nothing_and_keep_their_sets() {
    let mut one = box_mesh(DVec3::ONE, (2, 1, 1), ElementKind::Hex8).expect("a box");
    one.cells.push(CellKind::Tet4, [0, 1, 2, 4]).expect("a tetrahedron");
    one.element_sets.insert("right".into(), vec![0, 2]);
    one.element_vectors.insert("fibres".into(), vec![DVec3::X, DVec3::Y, DVec3::Z]);
    let mut all = one.clone();
    all.repeat(3, DVec3::new(2.0, 0.0, 0.0));
    let count = |kind| all.cells.count(kind);
    assert_eq!((all.points.len(), count(CellKind::Tet4), count(CellKind::Hex8)), (3 * one.points.len(), 3, 6));
    let copy_of = |node: u32| node as usize / one.points.len();
    for element in 0..all.element_count() {
        let nodes = all.element(element);
        let copy = copy_of(nodes[0]);
        assert!(nodes.iter().all(|&node| copy_of(node) == copy));
        assert!(all.element_sets[&format!("copy {copy}")].contains(&(element as u32)));
        let moved = all.points[nodes[1] as usize] - DVec3::new(2.0 * copy as f64, 0.0, 0.0);
        assert!(one.points.contains(&moved));
    }
    assert_eq!(all.element_sets["right"], [0, 1, 2, 4, 6, 8]);
    let vectors = &all.element_vectors["fibres"];
    assert_eq!(vectors[..3], [DVec3::X; 3]);
    assert_eq!(vectors[3..], [DVec3::Y, DVec3::Z, DVec3::Y, DVec3::Z, DVec3::Y, DVec3::Z]);
    let Ids::Named(ids) = &all.element_ids else { unreachable!("copies have numbers") };
    assert_eq!(ids[..], [0, 3, 6, 1, 2, 4, 5, 7, 8]);
}
