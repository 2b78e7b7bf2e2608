//! `$ElementData`: vectors of elements.

use super::File;
use crate::read::Fault;
use crate::read::cursor::Form;
use glam::DVec3;

impl File<'_> {
    pub(super) fn element_data(&mut self) -> Result<(), Fault> {
        let mut name = String::new();
        let strings = self.cursor.count(2, "names")?;
        self.cursor.try_line();
        for row in 0..strings {
            let line = self.cursor.try_line().unwrap_or_default();
            name = if row == 0 { line.trim_matches('"').to_string() } else { name };
        }
        for _ in 0..self.cursor.count(2, "real tags")? {
            let _time: f64 = self.cursor.number("a real tag")?;
        }
        let mut integers = [0, 1, 0];
        for row in 0..self.cursor.count(2, "integer tags")? {
            let value: u64 = self.cursor.number("an integer tag")?;
            if let Some(integer) = integers.get_mut(row) {
                *integer = value;
            }
        }
        let [_step, components, rows] = integers;
        let components = self.cursor.claim(components, 2, "components")?;
        let text = self.binary == Form::Text;
        let bytes_each = if text { 2 + 2 * components } else { 4 + 8 * components };
        let rows = self.cursor.claim(rows, bytes_each, "rows of element data")?;
        if !text {
            self.cursor.skip_line_break();
            self.cursor.form = self.binary;
        }
        let mut vectors = Vec::new();
        for _ in 0..rows {
            let number = self.positive("the number of an element")?;
            let mut vector = DVec3::ZERO;
            for component in 0..components {
                let value = self.cursor.double("a component of element data")?;
                if component < 3 {
                    vector[component] = value;
                }
            }
            vectors.push((number, vector));
        }
        self.cursor.form = Form::Text;
        if components == 3 {
            self.draft.vectors.insert(name, vectors);
        }
        Ok(())
    }
}
