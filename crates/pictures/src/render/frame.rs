//! Reads one frame of a series: a VTU file as [`sinew::output::Series`] writes it (appended raw data in zlib blocks).

use super::RenderError;
use flate2::read::ZlibDecoder;
use glam::Vec3;
use sinew::mesh::topology::Listing;
use sinew::mesh::{CellKind, Cells};
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};

/// What the rows of an array belong to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FieldAssociation {
    /// One row a point.
    Points,
    /// One row a cell.
    Cells,
    /// Points, corners and kinds of the mesh itself.
    Mesh,
}

/// An array in the file.
#[derive(Clone, Debug)]
pub struct ArrayHeader {
    /// Its name.
    pub name: String,
    /// What its rows belong to.
    pub place: FieldAssociation,
    /// Values a row.
    pub components: usize,
    kind: String,
    offset: usize,
}

/// An open frame; arrays are unpacked when they are asked for.
pub struct FrameFile {
    /// The file.
    pub path: PathBuf,
    /// How many points there are.
    pub points: usize,
    /// How many cells there are.
    pub cells: usize,
    /// The arrays.
    pub entries: Vec<ArrayHeader>,
    bytes: Vec<u8>,
    /// Where the appended data begins.
    data: usize,
}

/// Ends the head and begins the data.
const DATA: &[u8] = b"<AppendedData encoding=\"raw\">";

impl ArrayHeader {
    /// Whether its values are real numbers, not names or numbers of things.
    pub fn is_real(&self) -> bool {
        self.kind.starts_with("Float")
    }
}

impl FrameFile {
    /// Opens a file and reads its head.
    pub fn open(path: &Path) -> Result<FrameFile, RenderError> {
        let bytes = fs::read(path).map_err(|source| RenderError::Read { path: path.to_path_buf(), source })?;
        let damaged = |reason: &str| RenderError::damaged(path, format!("not a frame that sinew wrote: {reason}"));
        let head = bytes.windows(DATA.len()).position(|window| window == DATA);
        let head = head.ok_or_else(|| damaged("no appended raw data"))?;
        let underscore = bytes[head..].iter().position(|&byte| byte == b'_');
        let data = head + underscore.ok_or_else(|| damaged("no appended raw data"))? + 1;
        let text = std::str::from_utf8(&bytes[..head]).map_err(|_| damaged("the head is no text"))?;
        let text = format!("{text}</VTKFile>");
        let document = roxmltree::Document::parse(&text).map_err(|error| damaged(&error.to_string()))?;
        let order = if cfg!(target_endian = "little") { "LittleEndian" } else { "BigEndian" };
        for (name, expected) in
            [("byte_order", order), ("header_type", "UInt64"), ("compressor", "vtkZLibDataCompressor")]
        {
            if document.root_element().attribute(name) != Some(expected) {
                return Err(damaged(&format!("{name} is not {expected}")));
            }
        }
        let piece = document.descendants().find(|node| node.has_tag_name("Piece"));
        let piece = piece.ok_or_else(|| damaged("no Piece"))?;
        let number =
            |node: roxmltree::Node<'_, '_>, name: &str| node.attribute(name).and_then(|text| text.parse().ok());
        let count = |name: &str| number(piece, name).ok_or_else(|| damaged(&format!("no {name}")));
        let (points, cells) = (count("NumberOfPoints")?, count("NumberOfCells")?);
        let entry = |node: roxmltree::Node<'_, '_>| {
            let place = match node.parent_element()?.tag_name().name() {
                "PointData" => FieldAssociation::Points,
                "CellData" => FieldAssociation::Cells,
                _ => FieldAssociation::Mesh,
            };
            let (name, kind) = (node.attribute("Name")?.to_string(), node.attribute("type")?.to_string());
            let components = number(node, "NumberOfComponents").unwrap_or(1);
            Some(ArrayHeader { name, place, components, kind, offset: number(node, "offset")? })
        };
        let entries = piece.descendants().filter(|node| node.has_tag_name("DataArray")).filter_map(entry).collect();
        Ok(FrameFile { path: path.to_path_buf(), points, cells, entries, bytes, data })
    }

    /// The entry of an array, if there is one.
    pub fn entry(&self, place: FieldAssociation, name: &str) -> Option<&ArrayHeader> {
        self.entries.iter().find(|entry| entry.place == place && entry.name == name)
    }

    /// The values of an array, as many as rows times components.
    pub fn floats(&self, entry: &ArrayHeader) -> Result<Vec<f32>, RenderError> {
        let count = self.count(entry);
        Ok(match entry.kind.as_str() {
            "Float32" => self.unpack(entry, count)?.into_iter().map(f32::from_ne_bytes).collect(),
            "Float64" => self.unpack(entry, count)?.into_iter().map(|bytes| f64::from_ne_bytes(bytes) as f32).collect(),
            "UInt8" => self.unpack(entry, count)?.into_iter().map(|[byte]| f32::from(byte)).collect(),
            "UInt32" => self.unpack(entry, count)?.into_iter().map(|bytes| u32::from_ne_bytes(bytes) as f32).collect(),
            "Int64" => self.unpack(entry, count)?.into_iter().map(|bytes| i64::from_ne_bytes(bytes) as f32).collect(),
            other => return Err(self.damaged(entry, &format!("is of the unexpected type {other}"))),
        })
    }

    /// The whole numbers of an array, as many as rows times components: those of things, which floats of
    /// [`Self::floats`] have no digits for.
    pub fn integers(&self, entry: &ArrayHeader) -> Result<Vec<i64>, RenderError> {
        let count = self.count(entry);
        Ok(match entry.kind.as_str() {
            "UInt8" => self.unpack(entry, count)?.into_iter().map(|[byte]| i64::from(byte)).collect(),
            "UInt32" => {
                self.unpack(entry, count)?.into_iter().map(|bytes| i64::from(u32::from_ne_bytes(bytes))).collect()
            }
            "Int64" => self.unpack(entry, count)?.into_iter().map(i64::from_ne_bytes).collect(),
            other => return Err(self.damaged(entry, &format!("is of the type {other}, not of whole numbers"))),
        })
    }

    /// How many values an array has.
    fn count(&self, entry: &ArrayHeader) -> usize {
        let rows = if entry.place == FieldAssociation::Cells { self.cells } else { self.points };
        rows.saturating_mul(entry.components)
    }

    /// The values of an array of vectors.
    pub fn vectors(&self, entry: &ArrayHeader) -> Result<Vec<Vec3>, RenderError> {
        if entry.components != 3 {
            return Err(self.damaged(entry, &format!("has {} components a row, not 3", entry.components)));
        }
        Ok(self.floats(entry)?.chunks_exact(3).map(Vec3::from_slice).collect())
    }

    /// The cells.
    pub fn cells(&self) -> Result<Cells, RenderError> {
        let mesh = |name: &str| {
            let missing = || RenderError::damaged(&self.path, format!("the array {name} is missing"));
            self.entry(FieldAssociation::Mesh, name).ok_or_else(missing)
        };
        let kinds: Vec<[u8; 1]> = self.unpack(mesh("types")?, self.cells)?;
        let run = |run: &[[u8; 1]]| {
            let (kind, listing) = CellKind::of_vtk(run[0][0]).ok().filter(|of| of.0.topology().solid.is_some())?;
            Some((kind, listing, run.len()))
        };
        let runs = kinds.chunk_by(|a, b| a == b).map(run).collect::<Option<Vec<(CellKind, &Listing, usize)>>>();
        let Some(runs) = runs.filter(|runs| runs.is_sorted_by_key(|of| of.0)) else {
            let solids: Vec<&str> = CellKind::solids().map(|(kind, _)| kind.topology().plural).collect();
            let what = format!("names cells other than {}", solids.join(" and, after them, "));
            return Err(self.damaged(mesh("types")?, &what));
        };
        let (entry, count) =
            (mesh("connectivity")?, runs.iter().map(|(kind, _, cells)| kind.node_count() * cells).sum());
        let corners: Vec<u32> = match entry.kind.as_str() {
            "Int32" => self.unpack(entry, count)?.into_iter().map(|bytes| i32::from_ne_bytes(bytes) as u32).collect(),
            _ => self.unpack(entry, count)?.into_iter().map(|bytes| i64::from_ne_bytes(bytes) as u32).collect(),
        };
        if corners.iter().any(|&corner| corner as usize >= self.points) {
            return Err(self.damaged(entry, "names points that do not exist"));
        }
        let (mut cells, mut rest) = (Cells::default(), &corners[..]);
        for (kind, listing, count) in runs {
            let (listed, behind) = rest.split_at(count * kind.node_count());
            match listing.keeps_order() {
                true => cells.extend_kind(kind, listed.iter().copied()),
                false => {
                    cells.extend_kind(kind, listed.chunks_exact(kind.node_count()).flat_map(|cell| listing.read(cell)));
                }
            }
            rest = behind;
        }
        Ok(cells)
    }

    /// Triangles, in a file of nothing else: rows of points.
    pub fn triangles(&self) -> Result<Vec<[u32; 3]>, RenderError> {
        let missing = || RenderError::damaged(&self.path, "the array connectivity is missing");
        let entry = self.entry(FieldAssociation::Mesh, "connectivity").ok_or_else(missing)?;
        let corners: Vec<u32> = match entry.kind.as_str() {
            "Int32" => {
                self.unpack(entry, 3 * self.cells)?.into_iter().map(|bytes| i32::from_ne_bytes(bytes) as u32).collect()
            }
            _ => {
                self.unpack(entry, 3 * self.cells)?.into_iter().map(|bytes| i64::from_ne_bytes(bytes) as u32).collect()
            }
        };
        match corners.iter().any(|&corner| corner as usize >= self.points) {
            true => Err(self.damaged(entry, "names points that do not exist")),
            false => Ok(corners.as_chunks::<3>().0.to_vec()),
        }
    }

    /// Unpacks an array of `count` values of `N` bytes.
    fn unpack<const N: usize>(&self, entry: &ArrayHeader, count: usize) -> Result<Vec<[u8; N]>, RenderError> {
        let short = || self.damaged(entry, "ends too early");
        let start = self.data.checked_add(entry.offset).ok_or_else(short)?;
        let word = |row: usize| {
            let at = start.checked_add(row.checked_mul(8)?)?;
            let bytes = self.bytes.get(at..at.checked_add(8)?)?;
            usize::try_from(u64::from_ne_bytes(bytes.try_into().ok()?)).ok()
        };
        let blocks = word(0).ok_or_else(short)?;
        let wanted = count.checked_mul(N).ok_or_else(short)?;
        let mut next = blocks.checked_add(3).and_then(|words| start.checked_add(words.checked_mul(8)?));
        let mut bytes = Vec::new();
        for block in 0..blocks {
            let from = next.ok_or_else(short)?;
            let to = word(3 + block).and_then(|size| from.checked_add(size)).ok_or_else(short)?;
            let packed = self.bytes.get(from..to).ok_or_else(short)?;
            // no more than what is wanted, whatever the file says
            let room = (wanted - bytes.len()) as u64 + 1;
            ZlibDecoder::new(packed)
                .take(room)
                .read_to_end(&mut bytes)
                .map_err(|_| self.damaged(entry, "is damaged"))?;
            if bytes.len() > wanted {
                return Err(self.damaged(entry, "is longer than its rows"));
            }
            next = Some(to);
        }
        if bytes.len() != wanted {
            return Err(short());
        }
        Ok(bytes.as_chunks::<N>().0.to_vec())
    }

    fn damaged(&self, entry: &ArrayHeader, what: &str) -> RenderError {
        RenderError::damaged(&self.path, format!("the array {} {what}", entry.name))
    }
}
