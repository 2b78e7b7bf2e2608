//! Physical groups and their names.

use crate::read::Fault;
use crate::read::cursor::Cursor;
use std::collections::BTreeMap;

/// Physical groups of a file.
#[derive(Default)]
pub struct Groups {
    /// Names by dimension and number.
    names: BTreeMap<(u8, i64), String>,
    /// Groups of a geometric entity, by dimension and number (format 4).
    pub entities: BTreeMap<(u8, i32), Vec<i64>>,
}

impl Groups {
    /// The name of a group: its number where it has none.
    pub fn name(&self, dimension: u8, number: i64) -> String {
        self.names.get(&(dimension, number)).cloned().unwrap_or_else(|| number.to_string())
    }

    /// Reads `$PhysicalNames`.
    pub fn read_names(&mut self, cursor: &mut Cursor) -> Result<(), Fault> {
        for _ in 0..cursor.count(6, "physical names")? {
            let dimension: u8 = cursor.number("the dimension of a group")?;
            let number: i64 = cursor.number("the number of a group")?;
            let name = cursor.try_line().unwrap_or_default();
            let name = name.trim().trim_matches('"');
            if name.is_empty() {
                return Err(cursor.fault(format!("group {number} has no name"), "a line is: dimension number \"name\""));
            }
            self.names.insert((dimension, number), name.into());
        }
        Ok(())
    }
}
