//! Format 4.1.

use super::{File, kinds};
use crate::read::Fault;
use crate::read::cursor::Form;
use glam::DVec3;

impl File<'_> {
    fn size4(&mut self, what: &str) -> Result<u64, Fault> {
        self.cursor.size(self.width, what)
    }

    /// A count of things that take at least so many bytes each, as text or binary.
    fn count4(&mut self, text: usize, binary: usize, what: &str) -> Result<usize, Fault> {
        let count = self.size4(&format!("the number of {what}"))?;
        self.cursor.claim(count, if self.cursor.form == Form::Text { text } else { binary }, what)
    }

    fn dimension4(&mut self) -> Result<u8, Fault> {
        let dimension = self.cursor.int("the dimension of an entity")?;
        match u8::try_from(dimension) {
            Ok(dimension @ 0..=3) => Ok(dimension),
            _ => Err(self.cursor.fault(format!("an entity of dimension {dimension}"), "dimensions are 0 to 3")),
        }
    }

    /// Reads which physical groups each geometric entity belongs to.
    pub(super) fn entities4(&mut self) -> Result<(), Fault> {
        let mut counts = [0; 4];
        for count in &mut counts {
            *count = self.count4(8, 4 + 24 + self.width, "entities")?;
        }
        for (dimension, count) in (0u8..).zip(counts) {
            for _ in 0..count {
                let entity = self.cursor.int("the number of an entity")?;
                for _ in 0..if dimension == 0 { 3 } else { 6 } {
                    self.cursor.double("a bound of an entity")?;
                }
                let mut groups = Vec::new();
                for _ in 0..self.count4(2, 4, "physical groups")? {
                    // the sign tells the orientation
                    groups.push(i64::from(self.cursor.int("a physical group")?).abs());
                }
                if dimension > 0 {
                    for _ in 0..self.count4(2, 4, "bounding entities")? {
                        self.cursor.int("a bounding entity")?;
                    }
                }
                self.groups.entities.insert((dimension, entity), groups);
            }
        }
        Ok(())
    }

    pub(super) fn nodes4(&mut self) -> Result<(), Fault> {
        let blocks = self.count4(8, 12, "blocks of nodes")?;
        let total = self.count4(8, 24, "nodes")?;
        let _least_and_most = (self.size4("the smallest number")?, self.size4("the largest number")?);
        for _ in 0..blocks {
            let dimension = self.dimension4()?;
            let _entity = self.cursor.int("the number of an entity")?;
            let parametric = self.cursor.int("whether nodes have parameters")? != 0;
            let count = self.count4(8, 24, "nodes")?;
            let mut numbers = Vec::with_capacity(count);
            for _ in 0..count {
                numbers.push(self.size4("the number of a node")?);
            }
            for number in numbers {
                let point = DVec3::new(self.cursor.double("x")?, self.cursor.double("y")?, self.cursor.double("z")?);
                for _ in 0..if parametric { dimension } else { 0 } {
                    self.cursor.double("a parameter of a node")?;
                }
                self.node(number, point);
            }
        }
        self.agree4(self.draft.points.len(), total, "nodes")
    }

    pub(super) fn elements4(&mut self) -> Result<(), Fault> {
        let blocks = self.count4(8, 12, "blocks of elements")?;
        let total = self.count4(4, self.width, "elements")?;
        let _least_and_most = (self.size4("the smallest number")?, self.size4("the largest number")?);
        let (mut read, mut grouped) = (0, 0_usize);
        for _ in 0..blocks {
            let dimension = self.dimension4()?;
            let entity = self.cursor.int("the number of an entity")?;
            let kind = self.positive("the type of elements")?;
            let known = kinds::kind(kind).ok_or_else(|| self.unknown_kind(0, kind))?;
            let count = self.count4(4, self.width * (1 + known.nodes), "elements")?;
            let groups = self.groups.entities.get(&(dimension, entity)).cloned().unwrap_or_default();
            // many groups of many elements are few bytes and much memory
            grouped = grouped.saturating_add(count.saturating_mul(groups.len()));
            let most = self.cursor.bytes().len();
            if grouped > most {
                let what = format!("entity {entity} of dimension {dimension} is in {} groups", groups.len());
                let allowed = format!("all elements together may be in {most} groups, one a byte of the file");
                return Err(self.cursor.fault(what, allowed));
            }
            for _ in 0..count {
                let number = self.size4("the number of an element")?;
                self.element(number, known, &groups)?;
            }
            read += count;
        }
        self.agree4(read, total, "elements")
    }

    fn agree4(&self, read: usize, total: usize, what: &str) -> Result<(), Fault> {
        if read == total {
            return Ok(());
        }
        Err(self
            .cursor
            .fault(format!("{total} {what} are claimed, its blocks hold {read}"), "the two counts must agree"))
    }
}
