//! From a draft to a mesh.

use super::numbering::Numbering;
use super::{Cell, Draft};
use crate::read::Fault;
use crate::topology::singular;
use crate::{CellKind, Ids, Mesh};
use glam::DVec3;
use std::collections::{BTreeMap, HashSet};

const SUPPORTED: &str = "sinew simulates tetrahedra of 4 and of 10 nodes, 8-node hexahedra (voxels too) and \
                         6-node wedges: save the mesh with those alone";

/// Vectors of elements that a file need not give.
const SPARSE_VECTORS: usize = 1_000_000;

/// No element of the mesh.
const NONE: u32 = u32::MAX;

impl Draft {
    /// The mesh of what was read.
    pub fn finish(mut self) -> Result<Mesh, Fault> {
        if !self.refused.is_empty() {
            return Err(Fault::whole(format!("the file holds {}", listed(&self.refused)), SUPPORTED));
        }
        let most = u32::MAX as usize - 1;
        if self.points.len() > most || self.cells.len() > most {
            return Err(Fault::whole("the file holds too many points or cells", format!("at most {most} of each")));
        }
        if !self.cells.iter().any(|cell| cell.kind.topology().dimension == 3) {
            return Err(self.without_volume());
        }
        let rows = self.rows()?;
        let mut mesh = Mesh { points: std::mem::take(&mut self.points), ..Mesh::default() };
        let elements = self.fill_elements(&mut mesh, &rows);
        mesh.point_ids = self.point_numbers.take().map_or(Ids::Rows, Ids::Named);
        self.fill_sets(&mut mesh, &rows, &elements);
        self.fill_vectors(&mut mesh, &elements)?;
        self.note_unused();
        mesh.notes = self.notes;
        Ok(mesh)
    }

    fn without_volume(&self) -> Fault {
        let mut counts: BTreeMap<String, usize> = self.left_out.clone();
        for cell in &self.cells {
            *counts.entry(cell.kind.topology().plural.into()).or_default() += 1;
        }
        let surface =
            counts.keys().any(|name| name.contains("triangle") || name.contains("quad") || name.contains("polygon"));
        let what = match (counts.is_empty(), surface) {
            (true, _) => "the file holds no elements".to_string(),
            (_, true) => format!("the file holds a surface mesh of {}, no volume elements", listed(&counts)),
            _ => format!("the file holds {}, no volume elements", listed(&counts)),
        };
        Fault::whole(
            what,
            "sinew needs tetrahedra, hexahedra or wedges that fill the body: mesh the inside of the surface first",
        )
    }

    /// The rows of all corners.
    fn rows(&self) -> Result<Vec<u32>, Fault> {
        let numbering = Numbering::new(self.point_numbers.as_deref(), self.points.len()).map_err(|number| {
            Fault::whole(format!("the number {number} is given to two nodes"), "each node needs a number of its own")
        })?;
        let rows: Vec<u32> = self.corners.iter().map(|&number| numbering.row(number).unwrap_or(NONE)).collect();
        if !rows.contains(&NONE) {
            return Ok(rows);
        }
        let lost = (0..self.cells.len()).filter_map(|cell| {
            let corners = self.corners(cell);
            let missing = corners.iter().find(|&&number| numbering.row(number).is_none())?;
            Some(format!("{} (node {missing})", self.cells[cell].number))
        });
        let lost: Vec<String> = lost.collect();
        let more = if lost.len() > 10 { format!(" and {} more", lost.len() - 10) } else { String::new() };
        let names = if lost.len() == 1 { "element names" } else { "elements name" };
        let what = format!(
            "{} {names} nodes that the file does not have: {}{more}",
            lost.len(),
            lost[..lost.len().min(10)].join(", ")
        );
        let allowed = match &self.point_numbers {
            None => format!("its {} nodes are numbered from 0", self.points.len()),
            Some(numbers) => format!(
                "its {} nodes have numbers from {} to {}",
                numbers.len(),
                numbers.iter().min().copied().unwrap_or(0),
                numbers.iter().max().copied().unwrap_or(0)
            ),
        };
        Err(Fault::whole(what, allowed))
    }

    /// Fills in the elements; gives the row of each cell among them.
    fn fill_elements(&mut self, mesh: &mut Mesh, rows: &[u32]) -> Vec<u32> {
        let mut elements = vec![NONE; self.cells.len()];
        let first_of = if self.repeats_elements { self.repeated() } else { BTreeMap::new() };
        let mut numbers = Vec::new();
        // rows count kind by kind
        for (kind, _) in CellKind::solids() {
            for (row, &Cell { kind: own, number, start }) in self.cells.iter().enumerate() {
                if own != kind || first_of.contains_key(&row) {
                    continue;
                }
                elements[row] = numbers.len() as u32;
                numbers.push(number);
                mesh.cells.push_nodes(kind, &rows[start..start + kind.node_count()]);
            }
        }
        if !first_of.is_empty() {
            self.notes.push(format!("{} elements are listed again, once a group; each is taken once", first_of.len()));
        }
        for (again, first) in first_of {
            elements[again] = elements[first];
        }
        mesh.element_ids = self.element_ids(numbers);
        elements
    }

    /// Volume cells with the corners of an earlier one, and that one.
    fn repeated(&self) -> BTreeMap<usize, usize> {
        let mut order: Vec<usize> =
            (0..self.cells.len()).filter(|&cell| self.cells[cell].kind.topology().dimension == 3).collect();
        order.sort_by(|&a, &b| self.corners(a).cmp(self.corners(b)));
        let alike = order.chunk_by(|&a, &b| self.corners(a) == self.corners(b));
        alike.flat_map(|alike| alike[1..].iter().map(|&again| (again, alike[0]))).collect()
    }

    fn element_ids(&mut self, numbers: Vec<u64>) -> Ids {
        if numbers.iter().copied().eq(0..numbers.len() as u64) {
            return Ids::Rows;
        }
        let mut seen = HashSet::new();
        match numbers.iter().find(|&&number| !seen.insert(number)) {
            None => Ids::Named(numbers),
            Some(twice) => {
                let times = numbers.iter().filter(|&number| number == twice).count();
                self.notes.push(format!(
                    "element numbers repeat ({twice}: {times} times), so elements are called by their place in the mesh, 1 to {}",
                    numbers.len()
                ));
                Ids::Named((1..=numbers.len() as u64).collect())
            }
        }
    }

    fn fill_sets(&mut self, mesh: &mut Mesh, rows: &[u32], elements: &[u32]) {
        for (name, cells) in &self.groups {
            let mut nodes = Vec::new();
            let mut dimensions = [false; 4];
            for &cell in cells {
                let Cell { kind, start, .. } = self.cells[cell as usize];
                let corners = &rows[start..start + kind.node_count()];
                nodes.extend_from_slice(corners);
                dimensions[kind.topology().dimension as usize] = true;
                if kind.topology().dimension == 2 {
                    let face = [0, 1, 2, kind.topology().corners - 1].map(|corner| corners[corner]);
                    mesh.face_sets.entry(name.clone()).or_default().push(face);
                } else if elements[cell as usize] != NONE {
                    mesh.element_sets.entry(name.clone()).or_default().push(elements[cell as usize]);
                }
            }
            if dimensions.into_iter().filter(|&has| has).count() > 1 {
                self.notes.push(format!(
                    "`{name}` names groups of several dimensions; its node set holds the nodes of all of them"
                ));
            }
            ascending(&mut nodes);
            mesh.node_sets.insert(name.clone(), nodes);
        }
        mesh.element_sets.values_mut().for_each(ascending);
    }

    fn fill_vectors(&mut self, mesh: &mut Mesh, elements: &[u32]) -> Result<(), Fault> {
        // many data that are given for next to no element are few bytes and much memory
        let given: usize = self.vectors.values().map(Vec::len).sum();
        let wanted = self.vectors.len().saturating_mul(mesh.element_count());
        if wanted > SPARSE_VECTORS + 100 * given {
            let what = format!("{} data of elements have {given} values together", self.vectors.len());
            return Err(Fault::whole(what, format!("{} elements need more", mesh.element_count())));
        }
        let mut by_number: Vec<(u64, u32)> =
            self.cells.iter().map(|cell| cell.number).zip(elements.iter().copied()).collect();
        by_number.retain(|&(_, element)| element != NONE);
        by_number.sort_unstable();
        for (name, values) in &self.vectors {
            let mut vectors = vec![DVec3::ZERO; mesh.element_count()];
            let mut given = vec![false; vectors.len()];
            // a later vector of the same element wins
            let values: BTreeMap<u64, DVec3> = values.iter().copied().collect();
            for &(number, element) in &by_number {
                if let Some(&vector) = values.get(&number) {
                    vectors[element as usize] = vector;
                    given[element as usize] = true;
                }
            }
            let missing = given.iter().filter(|&&given| !given).count();
            if missing == vectors.len() {
                continue;
            }
            if missing > 0 {
                self.notes.push(format!("`{name}` gives no vector to {missing} elements; theirs is zero"));
            }
            mesh.element_vectors.insert(name.clone(), vectors);
        }
        Ok(())
    }

    /// Notes which cells are neither elements nor in a set.
    fn note_unused(&mut self) {
        let mut grouped = vec![false; self.cells.len()];
        for &cell in self.groups.values().flatten() {
            grouped[cell as usize] = true;
        }
        for (cell, _) in
            self.cells.iter().zip(grouped).filter(|(cell, grouped)| !grouped && cell.kind.topology().dimension < 3)
        {
            *self.left_out.entry(cell.kind.topology().plural.into()).or_default() += 1;
        }
        if !self.left_out.is_empty() {
            self.notes
                .push(format!("{} belong to no element and no named set; they are left out", listed(&self.left_out)));
        }
    }
}

fn ascending(rows: &mut Vec<u32>) {
    rows.sort_unstable();
    rows.dedup();
}

/// "1 pyramid, 12 wedges".
fn listed(counts: &BTreeMap<String, usize>) -> String {
    let list = |(name, &count): (&String, &usize)| {
        if count == 1 { format!("1 {}", singular(name)) } else { format!("{count} {name}") }
    };
    counts.iter().map(list).collect::<Vec<_>>().join(", ")
}
