//! Many copies of a mesh in one: a training set of small bodies that go their own ways.

use super::{Ids, Mesh};
use glam::DVec3;

impl Mesh {
    /// Copies that share nothing, one after the other: points, and elements of each kind, of the first, of the second
    /// and so on. Each stands `apart` (m) from the one before; they may stand in the same place. Sets hold the points
    /// and elements of all copies; the sets `copy 0`, `copy 1` ... those of one. Numbers of points and elements go on
    /// from copy to copy.
    #[doc(hidden)]
    pub fn repeat(&mut self, copies: u32, apart: DVec3) {
        if copies <= 1 {
            return;
        }
        let one = std::mem::take(self);
        let (points, elements) = (one.points.len(), one.element_count());
        // where an element of a copy stands: all copies of a kind come before those of the next
        let kinds: Vec<(usize, usize)> =
            one.cells.kinds().map(|(kind, count)| (one.cells.first(kind), count)).collect();
        let place = |copy: usize, element: usize| match kinds.iter().rfind(|(first, _)| *first <= element) {
            Some((first, count)) => copies as usize * first + copy * count + (element - first),
            None => element,
        };
        let (point_step, element_step) = (step_of(&one.point_ids, points), step_of(&one.element_ids, elements));
        let mut element_ids = vec![0; copies as usize * elements];
        let mut point_ids = Vec::with_capacity(copies as usize * points);
        for (name, vectors) in &one.element_vectors {
            self.element_vectors.insert(name.clone(), vec![DVec3::ZERO; copies as usize * vectors.len()]);
        }
        for copy in 0..copies as usize {
            let first = (copy * points) as u32;
            self.points.extend(one.points.iter().map(|&point| point + copy as f64 * apart));
            self.cells.extend_moved(&one.cells, first);
            point_ids.extend(
                (0..points).map(|row| one.point_ids.of(row).wrapping_add((copy as u64).wrapping_mul(point_step))),
            );
            for row in 0..elements {
                element_ids[place(copy, row)] =
                    one.element_ids.of(row).wrapping_add((copy as u64).wrapping_mul(element_step));
            }
            for (name, rows) in &one.node_sets {
                self.node_sets.entry(name.clone()).or_default().extend(rows.iter().map(|&row| first + row));
            }
            for (name, faces) in &one.face_sets {
                let faces = faces.iter().map(|face| face.map(|node| first + node));
                self.face_sets.entry(name.clone()).or_default().extend(faces);
            }
            for (name, rows) in &one.element_sets {
                let rows = rows.iter().map(|&row| place(copy, row as usize) as u32);
                self.element_sets.entry(name.clone()).or_default().extend(rows);
            }
            for (name, vectors) in &one.element_vectors {
                if let Some(all) = self.element_vectors.get_mut(name) {
                    vectors.iter().enumerate().for_each(|(row, &vector)| all[place(copy, row)] = vector);
                }
            }
            let name = format!("copy {copy}");
            self.node_sets.insert(name.clone(), (first..first + points as u32).collect());
            let own = (0..elements).map(|row| place(copy, row) as u32);
            self.element_sets.insert(name, own.collect());
        }
        self.element_sets.values_mut().for_each(|rows| rows.sort_unstable());
        self.point_ids = Ids::Named(point_ids);
        self.element_ids = Ids::Named(element_ids);
        self.notes = one.notes;
        // numbers are those of the first copy
        self.point_lists = one.point_lists;
    }
}

/// How far numbers go on from copy to copy.
fn step_of(ids: &Ids, count: usize) -> u64 {
    match ids {
        Ids::Rows => count as u64,
        Ids::Named(ids) => ids.iter().max().map_or(0, |largest| largest.wrapping_add(1)),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::expect_used)]

    use super::*;
    use crate::mesh::{CellKind, ElementKind, generators::box_mesh};

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
}
