//! Point and cell data of legacy files.

use super::File;
use crate::read::Fault;
use crate::vtu::DataArray;
use crate::vtu::scalar::Scalar;
use std::collections::BTreeMap;

impl File<'_> {
    /// Reads all that follows; `word` is POINT_DATA or CELL_DATA.
    pub(super) fn attributes(&mut self, word: &str) -> Result<(), Fault> {
        self.complete()?;
        let mut of_cells = word == "CELL_DATA";
        let mut rows = self.rows(of_cells)?;
        while let Some(word) = self.cursor.try_word() {
            let word = String::from_utf8_lossy(&word[..word.len().min(40)]).to_ascii_uppercase();
            let columns = match word.as_str() {
                "POINT_DATA" | "CELL_DATA" => {
                    of_cells = word == "CELL_DATA";
                    rows = self.rows(of_cells)?;
                    continue;
                }
                "METADATA" => {
                    self.metadata();
                    continue;
                }
                "SCALARS" => self.scalars(rows)?,
                "VECTORS" | "NORMALS" => self.column(rows, 3)?,
                "TENSORS" => self.column(rows, 9)?,
                "TEXTURE_COORDINATES" => {
                    let name = self.cursor.name("the name of data")?;
                    let dimension = self.cursor.count(0, "texture coordinates")?.min(3);
                    self.typed(name, rows, dimension)?
                }
                "COLOR_SCALARS" => self.colours(rows)?,
                "LOOKUP_TABLE" => {
                    let _name = self.cursor.name("the name of a table")?;
                    let count = self.cursor.count(4, "colours")?;
                    self.numbers(4 * count, self.colour(), "a colour")?;
                    continue;
                }
                "FIELD" => self.field()?,
                _ => {
                    // the mesh is complete; data of an unknown kind cannot be skipped, since its length is not known
                    self.grid.notes.push(format!("data from `{word}` on are of an unknown kind and left out"));
                    return Ok(());
                }
            };
            let all = if of_cells { &mut self.grid.cell_data } else { &mut self.grid.point_data };
            all.extend(
                columns
                    .into_iter()
                    .filter(|(_, column)| Some(column.values.len()) == rows.checked_mul(column.components)),
            );
        }
        Ok(())
    }

    fn rows(&mut self, of_cells: bool) -> Result<usize, Fault> {
        let rows = self.cursor.count(0, "rows of data")?;
        let (needed, what) =
            if of_cells { (self.grid.types.len(), "cells") } else { (self.grid.points.len(), "points") };
        if rows == needed {
            Ok(rows)
        } else {
            Err(self.cursor.fault(format!("data of {rows} {what}"), format!("there are {needed}")))
        }
    }

    /// Colours are numbers from 0 to 1 as text, bytes in binary.
    fn colour(&self) -> Scalar {
        if self.binary { Scalar::UInt(1) } else { Scalar::Float(4) }
    }

    fn typed(&mut self, name: String, rows: usize, components: usize) -> Result<BTreeMap<String, DataArray>, Fault> {
        let scalar = self.scalar()?;
        let count = rows.saturating_mul(components);
        let column = self.numbers(count, scalar, &format!("a value of `{name}`"))?;
        Ok(BTreeMap::from([(name, DataArray { components, ..column })]))
    }

    fn column(&mut self, rows: usize, components: usize) -> Result<BTreeMap<String, DataArray>, Fault> {
        let name = self.cursor.name("the name of data")?;
        self.typed(name, rows, components)
    }

    fn scalars(&mut self, rows: usize) -> Result<BTreeMap<String, DataArray>, Fault> {
        let line = self.cursor.try_line().unwrap_or_default();
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        let (name, kind, components) = match words.as_slice() {
            [name, kind] => (*name, *kind, 1),
            [name, kind, components] => (*name, *kind, components.parse().unwrap_or(0)),
            _ => ("", "", 0),
        };
        let Some(scalar) = Scalar::named(kind).filter(|_| (1..=4).contains(&components)) else {
            let allowed = "SCALARS is followed by a name, a type and 1 to 4 components";
            return Err(self.cursor.fault(format!("`SCALARS {line}`"), allowed));
        };
        let mut ahead = super::Cursor::new(self.cursor.bytes(), self.cursor.at());
        if ahead.try_word().is_some_and(|word| word.eq_ignore_ascii_case(b"LOOKUP_TABLE")) {
            self.cursor.expect("LOOKUP_TABLE", "")?;
            self.cursor.name("the name of a table")?;
        } else if self.binary {
            // numbers() moves to the next line, which has been done with the line of SCALARS
            self.cursor.step_back();
        }
        let column = self.numbers(rows.saturating_mul(components), scalar, &format!("a value of `{name}`"))?;
        Ok(BTreeMap::from([(name.to_string(), DataArray { components, ..column })]))
    }

    fn colours(&mut self, rows: usize) -> Result<BTreeMap<String, DataArray>, Fault> {
        let _name = self.cursor.name("the name of data")?;
        let components = self.cursor.count(0, "components")?;
        self.numbers(rows.saturating_mul(components), self.colour(), "a colour")?;
        Ok(BTreeMap::new())
    }

    /// Arrays of a field, each with its own number of rows.
    pub(super) fn field(&mut self) -> Result<BTreeMap<String, DataArray>, Fault> {
        let _name = self.cursor.name("the name of a field")?;
        let mut columns = BTreeMap::new();
        for _ in 0..self.cursor.count(4, "arrays")? {
            let mut name = self.cursor.name("the name of an array")?;
            if name == "METADATA" {
                self.metadata();
                name = self.cursor.name("the name of an array")?;
            }
            let components: u64 = self.cursor.number("the number of components")?;
            let rows: u64 = self.cursor.number("the number of rows")?;
            let count = self.cursor.claim(components.saturating_mul(rows), 1, "values")?;
            columns.extend(
                self.typed(name, count, 1)?
                    .into_iter()
                    .map(|(name, column)| (name, DataArray { components: components as usize, ..column })),
            );
        }
        Ok(columns)
    }

    /// Skips METADATA, which an empty line ends.
    pub(super) fn metadata(&mut self) {
        self.cursor.try_line();
        while self.cursor.try_line().is_some_and(|line| !line.is_empty()) {}
    }
}
