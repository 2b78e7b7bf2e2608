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
mod tests;
