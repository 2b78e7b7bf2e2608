//! From the cells of a VTK grid to a draft of a mesh; legacy files take the same road.

use super::{DataArray, VtuFile};
use crate::read::Fault;
use crate::read::draft::Draft;
use crate::topology::CellKind;
use glam::DVec3;
use std::collections::BTreeSet;

/// Integer cell data with more values than this is no naming of regions.
const MOST_VALUES: usize = 64;

impl VtuFile {
    /// The draft of a mesh: cells, sets from integer cell data, vectors from cell data of three components.
    pub(crate) fn draft(self) -> Result<Draft, Fault> {
        let mut draft = Draft::with_notes(self.notes.clone());
        let mut rows = vec![None; self.types.len()];
        for cell in 0..self.types.len() {
            let corners = self.cell(cell);
            match CellKind::of_vtk(self.types[cell]) {
                Ok((kind, listing)) if corners.len() == kind.node_count() => {
                    rows[cell] = Some(draft.add(kind, cell as u64, listing.read(corners)));
                }
                Ok((kind, _)) => {
                    let what = format!("cell {cell} has {} points", corners.len());
                    let allowed = format!("{} have {}", kind.topology().plural, kind.node_count());
                    return Err(Fault::whole(what, allowed));
                }
                Err((name, dimension)) => draft.cannot_use(&name, dimension),
            }
        }
        for (name, column) in &self.cell_data {
            match column.components {
                1 if column.integers => group(&mut draft, name, column, &rows),
                3 => {
                    let vectors = column.values.chunks_exact(3).map(DVec3::from_slice);
                    draft.vectors.insert(name.clone(), (0..).zip(vectors).collect());
                }
                _ => {}
            }
        }
        draft.points = self.points;
        Ok(draft)
    }
}

/// Groups cells by an integer each has.
fn group(draft: &mut Draft, name: &str, column: &DataArray, rows: &[Option<u32>]) {
    let mut values = BTreeSet::new();
    for &value in &column.values {
        values.insert(value as i64);
        if values.len() > MOST_VALUES {
            draft.notes.push(format!("cell data `{name}` has more than {MOST_VALUES} values, so it names no sets"));
            return;
        }
    }
    for (&value, row) in column.values.iter().zip(rows) {
        if let Some(row) = row {
            draft.group(&format!("{name}={}", value as i64), *row);
        }
    }
}
