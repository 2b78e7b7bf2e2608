//! Format 1: `$NOD` and `$ELM`, text only.

use super::{File, kinds};
use crate::CellKind;
use crate::read::Fault;
use glam::DVec3;

impl File<'_> {
    pub(super) fn nodes1(&mut self) -> Result<(), Fault> {
        for _ in 0..self.cursor.count(8, "nodes")? {
            let number = self.cursor.number("the number of a node")?;
            let [x, y, z] = ["x", "y", "z"];
            let point = DVec3::new(self.cursor.number(x)?, self.cursor.number(y)?, self.cursor.number(z)?);
            self.node(number, point);
        }
        Ok(())
    }

    pub(super) fn elements1(&mut self) -> Result<(), Fault> {
        for _ in 0..self.cursor.count(12, "elements")? {
            let number: u64 = self.cursor.number("the number of an element")?;
            let kind: u64 = self.cursor.number("the type of an element")?;
            let group: i64 = self.cursor.number("the physical group of an element")?;
            let _entity: i64 = self.cursor.number("the geometric entity of an element")?;
            let count: u64 = self.cursor.number("the number of an element's nodes")?;
            let known = kinds::kind(kind).ok_or_else(|| self.unknown_kind(number, kind))?;
            if count != known.nodes as u64 {
                let what = format!("element {number} has {count} nodes");
                return Err(self.cursor.fault(what, format!("{} (type {kind}) have {}", known.name, known.nodes)));
            }
            self.element(number, known, &[group])?;
        }
        Ok(())
    }

    pub(super) fn unknown_kind(&self, number: u64, kind: u64) -> Fault {
        let known = CellKind::ALL.map(CellKind::topology);
        let known = known.map(|known| format!("{} ({})", known.plural, known.gmsh.number)).join(", ");
        let allowed = format!("sinew uses {known}");
        self.cursor.fault(format!("element {number} is of the unknown type {kind}"), allowed)
    }

    /// Reads the nodes of an element and adds it; formats 1 and 2. Group 0 means none.
    pub(super) fn element(&mut self, number: u64, kind: kinds::Kind, groups: &[i64]) -> Result<(), Fault> {
        let mut nodes = [0u64; 64];
        for node in &mut nodes[..kind.nodes] {
            *node = self.element_node()?;
        }
        let Some(cell) = kind.cell else {
            self.draft.cannot_use(kind.name, kind.dimension);
            return Ok(());
        };
        let cell = self.draft.add(cell, number, cell.topology().gmsh.read(&nodes[..kind.nodes]));
        for &group in groups.iter().filter(|&&group| group != 0) {
            self.draft.group(&self.groups.name(kind.dimension, group), cell);
        }
        Ok(())
    }

    fn element_node(&mut self) -> Result<u64, Fault> {
        let what = "a node of an element";
        if self.version == 4 {
            return self.cursor.size(self.width, what);
        }
        let node = self.cursor.int(what)?;
        u64::try_from(node)
            .map_err(|_| self.cursor.fault(format!("{node} where {what} should be"), "numbers begin at 1"))
    }
}
