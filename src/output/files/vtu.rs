//! One frame as a VTU file (VTK XML, unstructured grid): appended raw data in zlib blocks, as ParaView writes it
//! itself.

use crate::mesh::topology::Listing;
use crate::mesh::{CellKind, Cells};
use crate::output::{Frame, OutputError, Values, replace};
use flate2::Compression;
use flate2::write::ZlibEncoder;
use rayon::prelude::*;
use std::fs::File;
use std::io::{BufWriter, Seek, SeekFrom, Write};
use std::path::Path;

impl<'a> Values<'a> {
    /// The type's name in the file, the number of values, and their bytes.
    fn parts(&self) -> (&'static str, usize, &'a [u8]) {
        match *self {
            Values::F32(v) => ("Float32", v.len(), bytemuck::cast_slice(v)),
            Values::F64(v) => ("Float64", v.len(), bytemuck::cast_slice(v)),
            Values::U8(v) => ("UInt8", v.len(), v),
            Values::U32(v) => ("UInt32", v.len(), bytemuck::cast_slice(v)),
            Values::I64(v) => ("Int64", v.len(), bytemuck::cast_slice(v)),
        }
    }
}

/// Bytes that are compressed as one piece; pieces are compressed side by side.
const BLOCK: usize = 1 << 18;
/// Room for `offset="..."` with every number that fits in 64 bits.
const OFFSET_ROOM: usize = 29;

/// Writes a frame; the file appears when it is complete. Not more than one array is held as a copy.
pub fn write(path: &Path, frame: &Frame<'_>) -> Result<(), OutputError> {
    check(path, frame)?;
    replace(path, |file| {
        Writer { file, offsets: Vec::new(), data: 0 }.frame(frame).map_err(OutputError::system("write", path))
    })
}

/// A file that ParaView would stumble over is not written.
fn check(path: &Path, frame: &Frame<'_>) -> Result<(), OutputError> {
    let cells = frame.cells.len();
    let arrays = frame.point_arrays.iter().map(|array| (array, frame.points.len()));
    for (array, rows) in arrays.chain(frame.cell_arrays.iter().map(|array| (array, cells))) {
        let (_, found, _) = array.values.parts();
        if found != rows * array.components {
            let (array, components) = (array.name.to_string(), array.components);
            return Err(OutputError::ArrayLength { path: path.to_path_buf(), array, found, rows, components });
        }
    }
    match frame.cells.all_nodes().max() {
        Some(point) if point as usize >= frame.points.len() => {
            Err(OutputError::NoSuchPoint { path: path.to_path_buf(), point, points: frame.points.len() })
        }
        _ => Ok(()),
    }
}

/// The head comes before the data that it gives the places of: it is written with gaps, which are filled at the end.
struct Writer<'a> {
    file: &'a mut BufWriter<File>,
    /// Where in the file the place of each array belongs.
    offsets: Vec<u64>,
    /// Where in the file the data begins.
    data: u64,
}

impl Writer<'_> {
    fn frame(mut self, frame: &Frame<'_>) -> std::io::Result<()> {
        self.head(frame)?;
        let mut places = Vec::with_capacity(self.offsets.len());
        let arrays = frame.point_arrays.iter().chain(&frame.cell_arrays).map(|array| array.values.parts().2);
        for bytes in arrays.chain([bytemuck::cast_slice(frame.points)]) {
            places.push(self.array(bytes)?);
        }
        let (cells, long) = (frame.cells, needs_long(frame));
        let mut nodes = Integers::with_capacity(node_count(cells), long);
        for (kind, _, own) in cells.blocks() {
            let listing = listing(kind);
            match listing.keeps_order() {
                true => own.iter().for_each(|&node| nodes.push(node.into())),
                false => own
                    .chunks_exact(kind.node_count())
                    .for_each(|cell| listing.write(cell).for_each(|node| nodes.push(node.into()))),
            }
        }
        places.push(self.array(&nodes.bytes)?);
        drop(nodes);
        let (mut ends, mut end) = (Integers::with_capacity(cells.len(), long), 0);
        for (_, nodes) in cells {
            end += nodes.len() as i64;
            ends.push(end);
        }
        places.push(self.array(&ends.bytes)?);
        drop(ends);
        let types: Vec<u8> = cells.iter().map(|(kind, _)| listing(kind).number).collect();
        places.push(self.array(&types)?);
        self.file.write_all(b"\n  </AppendedData>\n</VTKFile>\n")?;
        for (at, place) in self.offsets.iter().zip(places) {
            self.file.seek(SeekFrom::Start(*at))?;
            write!(self.file, "offset=\"{place}\"")?;
        }
        Ok(())
    }

    fn head(&mut self, frame: &Frame<'_>) -> std::io::Result<()> {
        let order = if cfg!(target_endian = "little") { "LittleEndian" } else { "BigEndian" };
        let (points, cells) = (frame.points.len(), frame.cells.len());
        let integer = if needs_long(frame) { "Int64" } else { "Int32" };
        write!(
            self.file,
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"{order}\" \
             header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n  <UnstructuredGrid>\n    <FieldData>\n      \
             <DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">{:?}</DataArray>\n    \
             </FieldData>\n    <Piece NumberOfPoints=\"{points}\" NumberOfCells=\"{cells}\">\n",
            frame.time
        )?;
        for (part, arrays) in [("PointData", &frame.point_arrays), ("CellData", &frame.cell_arrays)] {
            writeln!(self.file, "      <{part}>")?;
            for array in arrays {
                self.entry(array.values.parts().0, array.name, array.components)?;
            }
            writeln!(self.file, "      </{part}>")?;
        }
        writeln!(self.file, "      <Points>")?;
        self.entry("Float64", "Points", 3)?;
        writeln!(self.file, "      </Points>\n      <Cells>")?;
        self.entry(integer, "connectivity", 1)?;
        self.entry(integer, "offsets", 1)?;
        self.entry("UInt8", "types", 1)?;
        write!(
            self.file,
            "      </Cells>\n    </Piece>\n  </UnstructuredGrid>\n  <AppendedData encoding=\"raw\">\n   _"
        )?;
        self.data = self.file.stream_position()?;
        Ok(())
    }

    fn entry(&mut self, kind: &str, name: &str, components: usize) -> std::io::Result<()> {
        let name = name.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;");
        write!(self.file, "        <DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" ")?;
        write!(self.file, "format=\"appended\" ")?;
        self.offsets.push(self.file.stream_position()?);
        writeln!(self.file, "{:OFFSET_ROOM$}/>", "")
    }

    /// Writes one array and tells where it begins. Its head: number of blocks, bytes a block, bytes of the last block
    /// when that is shorter, then the compressed size of each block.
    fn array(&mut self, bytes: &[u8]) -> std::io::Result<u64> {
        let place = self.file.stream_position()? - self.data;
        let blocks = bytes.par_chunks(BLOCK).map(compress).collect::<std::io::Result<Vec<_>>>()?;
        for word in [blocks.len(), BLOCK, bytes.len() % BLOCK].into_iter().chain(blocks.iter().map(Vec::len)) {
            self.file.write_all(&(word as u64).to_ne_bytes())?;
        }
        for block in blocks {
            self.file.write_all(&block)?;
        }
        Ok(place)
    }
}

fn compress(block: &[u8]) -> std::io::Result<Vec<u8>> {
    let mut encoder = ZlibEncoder::new(Vec::with_capacity(block.len() / 2), Compression::fast());
    encoder.write_all(block)?;
    encoder.finish()
}

/// Whether 32 bits are too few for a corner's number or the count of corners.
fn needs_long(frame: &Frame<'_>) -> bool {
    frame.points.len().max(node_count(frame.cells)) > i32::MAX as usize
}

/// Nodes of all cells.
fn node_count(cells: &Cells) -> usize {
    cells.kinds().map(|(kind, count)| kind.node_count() * count).sum()
}

/// How VTK lists cells of a kind.
fn listing(kind: CellKind) -> &'static Listing {
    &kind.topology().vtk[0]
}

/// Whole numbers of 32 or 64 bits as they stand in a file.
struct Integers {
    bytes: Vec<u8>,
    long: bool,
}

impl Integers {
    fn with_capacity(count: usize, long: bool) -> Self {
        Self { bytes: Vec::with_capacity(count * if long { 8 } else { 4 }), long }
    }

    fn push(&mut self, value: i64) {
        match self.long {
            true => self.bytes.extend_from_slice(&value.to_ne_bytes()),
            false => self.bytes.extend_from_slice(&(value as i32).to_ne_bytes()),
        }
    }
}
