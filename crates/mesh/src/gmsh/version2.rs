//! Formats 2.0 to 2.2.

use super::{File, kinds};
use crate::read::Fault;
use crate::read::cursor::Form;
use glam::DVec3;

impl File<'_> {
    /// Counts are words even in binary files; what follows is not.
    fn count2(&mut self, text: usize, binary: usize, what: &str) -> Result<usize, Fault> {
        let bytes_each = if self.binary == Form::Text { text } else { binary };
        let count = self.cursor.count(bytes_each, what)?;
        if self.binary != Form::Text {
            self.cursor.skip_line_break();
            self.cursor.form = self.binary;
        }
        Ok(count)
    }

    pub(super) fn nodes2(&mut self) -> Result<(), Fault> {
        for _ in 0..self.count2(8, 28, "nodes")? {
            let number = self.positive("the number of a node")?;
            let point = DVec3::new(self.cursor.double("x")?, self.cursor.double("y")?, self.cursor.double("z")?);
            self.node(number, point);
        }
        Ok(())
    }

    pub(super) fn elements2(&mut self) -> Result<(), Fault> {
        let count = self.count2(8, 8, "elements")?;
        let mut read = 0;
        while read < count {
            // text: number, type, tags; binary: type, how many follow, tags of each
            let (mut first, mut follow) = (0, 1);
            if self.binary == Form::Text {
                first = self.positive("the number of an element")?;
            }
            let kind = self.positive("the type of an element")?;
            let known = kinds::kind(kind).ok_or_else(|| self.unknown_kind(first, kind))?;
            if self.binary != Form::Text {
                follow = self.positive("how many elements follow")?;
            }
            let tags = self.positive("the number of tags")?;
            let tags = self.cursor.claim(tags, 2, "tags")?;
            if follow == 0 || follow > (count - read) as u64 {
                let what = format!("{follow} elements follow, {} of {count} are left", count - read);
                return Err(self.cursor.fault(what, "the counts must agree"));
            }
            for _ in 0..follow {
                let number = if self.binary == Form::Text { first } else { self.positive("the number of an element")? };
                let mut group = 0;
                for tag in 0..tags {
                    let value = self.cursor.int("a tag of an element")?;
                    group = if tag == 0 { value } else { group };
                }
                self.element(number, known, &[i64::from(group)])?;
                read += 1;
            }
        }
        Ok(())
    }

    /// An integer that must not be negative.
    pub(super) fn positive(&mut self, what: &str) -> Result<u64, Fault> {
        let value = self.cursor.int(what)?;
        u64::try_from(value)
            .map_err(|_| self.cursor.fault(format!("{value} where {what} should be"), "it cannot be below 0"))
    }
}
