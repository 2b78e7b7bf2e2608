//! CSV tables: those that grow by whole rows, and those written at once.

use crate::output::{OutputError, replace};
use serde::Serialize;
use std::fs::File;
use std::io::{Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// A table: a header, then one row at a time. Each row is in the file when the call returns.
pub struct Table {
    path: PathBuf,
    file: File,
    columns: usize,
    /// Length of the file after the last whole row.
    whole: u64,
}

impl Table {
    /// Creates the file and writes the header; units belong into the names: `time (s)`.
    pub fn create<S: AsRef<str>>(path: &Path, header: &[S]) -> Result<Table, OutputError> {
        let file = File::create(path).map_err(OutputError::system("create", path))?;
        let mut table = Table { path: path.to_path_buf(), file, columns: header.len(), whole: 0 };
        table.append(&header.iter().map(AsRef::as_ref).collect::<Vec<_>>())?;
        Ok(table)
    }

    /// Appends a row of as many numbers as the header has names. Numbers get as many digits as give them back exactly;
    /// what is not finite stands as `NaN`, `inf` or `-inf`.
    pub fn row(&mut self, numbers: &[f64]) -> Result<(), OutputError> {
        if numbers.len() != self.columns {
            let (path, columns) = (self.path.clone(), self.columns);
            return Err(OutputError::RowLength { path, found: numbers.len(), columns });
        }
        self.append(numbers)
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    fn append<T: Serialize>(&mut self, cells: &[T]) -> Result<(), OutputError> {
        let format = |reason: String| OutputError::Format { path: self.path.clone(), reason };
        let mut line = csv::WriterBuilder::new().has_headers(false).from_writer(Vec::new());
        line.serialize(cells).map_err(|error| format(error.to_string()))?;
        let line = line.into_inner().map_err(|error| format(error.to_string()))?;
        let written = self.file.write_all(&line);
        if written.is_err() {
            // a full disk may have taken half of the row
            let _ = self.file.set_len(self.whole);
            let _ = self.file.seek(SeekFrom::Start(self.whole));
        } else {
            self.whole += line.len() as u64;
        }
        written.map_err(OutputError::system("write", &self.path))
    }
}

/// Writes a whole table; the file appears when it is complete.
///
/// # Errors
/// Files that cannot be written, and what cannot stand in a row.
pub fn write(path: &Path, header: &[&str], rows: impl Iterator<Item = impl Serialize>) -> Result<(), OutputError> {
    let refused = |error: csv::Error| match error.into_kind() {
        csv::ErrorKind::Io(source) => OutputError::system("write", path)(source),
        other => OutputError::Format { path: path.to_path_buf(), reason: format!("{other:?}") },
    };
    replace(path, |file| {
        let mut table = csv::WriterBuilder::new().has_headers(false).from_writer(file);
        table.write_record(header).map_err(refused)?;
        for row in rows {
            table.serialize(row).map_err(refused)?;
        }
        table.flush().map_err(OutputError::system("write", path))
    })
}
