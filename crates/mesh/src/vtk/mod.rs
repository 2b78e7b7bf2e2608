//! Legacy VTK files: unstructured grids of versions 1 to 5, as text or binary (most significant byte first).

mod attributes;

use super::read::Fault;
use super::read::cursor::{Cursor, Form};
use super::vtu::scalar::Scalar;
use super::vtu::{DataArray, VtuFile};
use glam::DVec3;

/// A file while it is read.
struct File<'a> {
    cursor: Cursor<'a>,
    binary: bool,
    grid: VtuFile,
}

/// Reads a file from its first word.
pub(super) fn read(mut cursor: Cursor) -> Result<VtuFile, Fault> {
    let header = cursor.try_line().unwrap_or_default();
    let version: f64 = header.rsplit(' ').next().and_then(|version| version.parse().ok()).unwrap_or(0.0);
    if !(1.0..6.0).contains(&version) {
        return Err(cursor.fault(format!("`{header}`"), "sinew reads legacy VTK files of the versions 1.0 to 5.1"));
    }
    let _title = cursor.try_line();
    let binary = match cursor.name("ASCII or BINARY")?.to_ascii_uppercase().as_str() {
        "ASCII" => false,
        "BINARY" => true,
        other => return Err(cursor.fault(format!("`{other}` where ASCII or BINARY should be"), "it is one of the two")),
    };
    cursor.expect("DATASET", "the third line is followed by DATASET")?;
    let dataset = cursor.name("the kind of data set")?.to_ascii_uppercase();
    if dataset != "UNSTRUCTURED_GRID" {
        return Err(other_dataset(&mut cursor, &dataset));
    }
    let mut file = File { cursor, binary, grid: VtuFile::default() };
    file.grid()?;
    Ok(file.grid)
}

fn other_dataset(cursor: &mut Cursor, dataset: &str) -> Fault {
    if dataset != "POLYDATA" {
        let allowed = "sinew reads UNSTRUCTURED_GRID: save the mesh as one";
        return cursor.fault(format!("the data set is {dataset}"), allowed);
    }
    let polygons =
        if cursor.skip_behind("\nPOLYGONS ") { cursor.number::<u64>("the number of polygons").ok() } else { None };
    let what = match polygons {
        Some(count) => {
            format!("the file holds a surface mesh (POLYDATA) of {count} triangles or polygons, no volume elements")
        }
        None => "the file holds a surface (POLYDATA), no volume elements".to_string(),
    };
    let allowed =
        "sinew needs tetrahedra, hexahedra or wedges that fill the body: mesh the inside of the surface first";
    Fault::whole(what, allowed)
}

impl File<'_> {
    fn grid(&mut self) -> Result<(), Fault> {
        while let Some(word) = self.cursor.try_word() {
            let word = String::from_utf8_lossy(&word[..word.len().min(40)]).to_ascii_uppercase();
            match word.as_str() {
                "POINTS" => self.points()?,
                "CELLS" => self.cells()?,
                "CELL_TYPES" => self.cell_types()?,
                "FIELD" => drop(self.field()?),
                "METADATA" => self.metadata(),
                "POINT_DATA" | "CELL_DATA" => return self.attributes(&word),
                _ => {
                    let allowed =
                        "POINTS, CELLS, CELL_TYPES, POINT_DATA or CELL_DATA begins here; a count before may be wrong";
                    return Err(self.cursor.fault(format!("`{word}`"), allowed));
                }
            }
        }
        self.complete()
    }

    /// Refuses a grid whose parts do not fit together.
    fn complete(&self) -> Result<(), Fault> {
        let (types, cells) = (self.grid.types.len(), self.grid.offsets.len());
        if types == cells {
            return Ok(());
        }
        let what = format!("{cells} CELLS and {types} CELL_TYPES");
        Err(self.cursor.fault(what, "each cell needs a type; the file may have been cut short"))
    }

    /// So many numbers, as words or bytes.
    fn numbers(&mut self, count: usize, scalar: Scalar, what: &str) -> Result<DataArray, Fault> {
        if !self.binary {
            let count = self.cursor.claim(count as u64, 1, what)?;
            let mut values = Vec::with_capacity(count);
            for _ in 0..count {
                values.push(self.cursor.number(what)?);
            }
            return Ok(DataArray { components: 1, values, integers: scalar.is_integer() });
        }
        self.cursor.try_line();
        self.cursor.form = Form::BigEndian;
        let bytes = self.cursor.take(count.saturating_mul(scalar.size()), what)?;
        self.cursor.form = Form::Text;
        Ok(scalar.column(bytes, true))
    }

    fn scalar(&mut self) -> Result<Scalar, Fault> {
        let name = self.cursor.name("a type of numbers")?;
        let allowed = "types are char, short, int, long, their unsigned kin, float, double, vtkIdType and vtktypeint64";
        Scalar::named(&name).ok_or_else(|| self.cursor.fault(format!("numbers of type `{name}`"), allowed))
    }

    fn points(&mut self) -> Result<(), Fault> {
        let count = self.cursor.count(6, "points")?;
        let scalar = self.scalar()?;
        let column = self.numbers(3 * count, scalar, "a coordinate")?;
        self.grid.points = column.values.chunks_exact(3).map(DVec3::from_slice).collect();
        Ok(())
    }

    fn cells(&mut self) -> Result<(), Fault> {
        let count = self.cursor.count(2, "cells")?;
        let size = self.cursor.count(1, "numbers of cells")?;
        // up to version 4: size of a cell, its points; from 5 on: offsets, then points
        let mut ahead = Cursor::new(self.cursor.bytes(), self.cursor.at());
        if ahead.try_word().is_some_and(|word| word.eq_ignore_ascii_case(b"OFFSETS")) {
            self.cursor.expect("OFFSETS", "")?;
            let scalar = self.scalar()?;
            let offsets = self.numbers(count, scalar, "an offset")?;
            self.cursor.expect("CONNECTIVITY", "it follows the offsets")?;
            let scalar = self.scalar()?;
            let connectivity = self.numbers(size, scalar, "a point of a cell")?;
            self.grid.connectivity = self.indices(&connectivity.values, u64::MAX)?;
            let offsets = self.indices(&offsets.values, size as u64)?;
            let rising = offsets.first().is_none_or(|&first| first == 0) && offsets.is_sorted();
            if !rising || offsets.last().is_some_and(|&last| last != size as u64) {
                return Err(self
                    .cursor
                    .fault("the offsets of cells do not fit", format!("they rise from 0 to {size}")));
            }
            self.grid.offsets = offsets.into_iter().skip(1).map(|offset| offset as usize).collect();
            return Ok(());
        }
        let column = self.numbers(size, Scalar::Int(4), "a point of a cell")?;
        let numbers = self.indices(&column.values, u64::MAX)?;
        let mut rest = numbers.as_slice();
        for cell in 0..count {
            let points =
                rest.split_first().and_then(|(&length, rest)| rest.split_at_checked(usize::try_from(length).ok()?));
            let Some((points, behind)) = points else {
                let what = format!("cell {cell} goes beyond the {size} numbers of CELLS");
                return Err(self.cursor.fault(what, "each cell is its number of points, then the points"));
            };
            self.grid.connectivity.extend_from_slice(points);
            self.grid.offsets.push(self.grid.connectivity.len());
            rest = behind;
        }
        if rest.is_empty() {
            return Ok(());
        }
        Err(self
            .cursor
            .fault(format!("{} numbers of CELLS belong to no cell", rest.len()), format!("there are {count} cells")))
    }

    /// Numbers that must be integers from 0 to `most`.
    fn indices(&self, values: &[f64], most: u64) -> Result<Vec<u64>, Fault> {
        let wrong = values.iter().find(|&&value| value.fract() != 0.0 || !(0.0..=most as f64).contains(&value));
        match wrong {
            Some(value) => Err(self.cursor.fault(format!("{value} in CELLS"), "points of cells are numbered from 0")),
            None => Ok(values.iter().map(|&value| value as u64).collect()),
        }
    }

    fn cell_types(&mut self) -> Result<(), Fault> {
        let count = self.cursor.count(2, "cell types")?;
        let column = self.numbers(count, Scalar::Int(4), "the type of a cell")?;
        self.grid.types = column.values.iter().map(|&value| value as u8).collect();
        Ok(())
    }
}
