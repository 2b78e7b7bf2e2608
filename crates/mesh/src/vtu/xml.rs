//! The structure of a VTU file.

use super::appended::{Split, split};
use super::decode::{Compression, Packing, base64};
use super::scalar::Scalar;
use super::{DataArray, VtuFile};
use crate::FilePosition;
use crate::read::Fault;
use glam::DVec3;
use roxmltree::Node;
use std::cell::Cell;
use std::collections::BTreeMap;

/// Numbers that a file may hold for each of its bytes. Compressed meshes come to two; arrays that share appended data,
/// or are compressed to next to nothing, could come to any number.
const NUMBERS_A_BYTE: usize = 20;
/// Numbers that a file of any size may hold.
const FEWEST_NUMBERS: usize = 1 << 20;

/// What is needed to read arrays anywhere in a file.
struct Reader<'a> {
    packing: Packing,
    appended: &'a Split<'a>,
    /// Offsets of all appended arrays, ascending: base64 text ends where the next begins.
    offsets: Vec<usize>,
    /// How many numbers may still be read.
    left: Cell<usize>,
}

/// Reads the bytes of a file.
pub fn parse(bytes: &[u8]) -> Result<VtuFile, Fault> {
    let appended = split(bytes)?;
    let document = roxmltree::Document::parse(&appended.xml).map_err(|error| Fault {
        at: FilePosition::Line(error.pos().row as usize),
        what: format!("the XML is damaged ({error})"),
        allowed: "the file may have been cut short".into(),
    })?;
    let root = document.root_element();
    let kind = root.attribute("type").unwrap_or("none");
    if !root.has_tag_name("VTKFile") || kind != "UnstructuredGrid" {
        let what = format!("<{}> of type {kind}", root.tag_name().name());
        return Err(fault(root, what, "sinew reads <VTKFile type=\"UnstructuredGrid\">: volume elements in one file"));
    }
    let offsets = root.descendants().filter_map(|node| node.attribute("offset")?.trim().parse().ok());
    let mut offsets: Vec<usize> = offsets.collect();
    offsets.sort_unstable();
    let left = Cell::new(FEWEST_NUMBERS.saturating_add(NUMBERS_A_BYTE.saturating_mul(bytes.len())));
    let reader = Reader { packing: packing(root)?, appended: &appended, offsets, left };
    let mut file = VtuFile::default();
    let mut pieces = 0;
    for piece in root.descendants().filter(|node| node.has_tag_name("Piece")) {
        reader.piece(piece, &mut file, pieces == 0)?;
        pieces += 1;
    }
    if pieces == 0 {
        return Err(fault(root, "there is no <Piece>".into(), "points and cells are given in pieces"));
    }
    Ok(file)
}

fn fault(node: Node, what: String, allowed: &str) -> Fault {
    let row = node.document().text_pos_at(node.range().start).row;
    Fault { at: FilePosition::Line(row as usize), what, allowed: allowed.into() }
}

fn packing(root: Node) -> Result<Packing, Fault> {
    let big_endian = match root.attribute("byte_order").unwrap_or("LittleEndian") {
        "LittleEndian" => false,
        "BigEndian" => true,
        other => return Err(fault(root, format!("byte order {other}"), "it must be LittleEndian or BigEndian")),
    };
    let header = match root.attribute("header_type").unwrap_or("UInt32") {
        "UInt32" => 4,
        "UInt64" => 8,
        other => return Err(fault(root, format!("header type {other}"), "it must be UInt32 or UInt64")),
    };
    let compression = match root.attribute("compressor") {
        None | Some("") => Compression::None,
        Some("vtkZLibDataCompressor") => Compression::Zlib,
        Some("vtkLZ4DataCompressor") => Compression::Lz4,
        Some(other) => {
            let allowed = "sinew reads vtkZLibDataCompressor, vtkLZ4DataCompressor and uncompressed files";
            return Err(fault(root, format!("compressor {other}"), allowed));
        }
    };
    Ok(Packing { header, big_endian, compression })
}

impl Reader<'_> {
    fn piece(&self, piece: Node, file: &mut VtuFile, first: bool) -> Result<(), Fault> {
        let count = |name: &str| {
            let text = piece.attribute(name).unwrap_or("");
            let what = || fault(piece, format!("{name} is `{text}`"), "a piece states its numbers of points and cells");
            text.trim().parse::<usize>().map_err(|_| what())
        };
        let (points, cells) = (count("NumberOfPoints")?, count("NumberOfCells")?);
        let child = |name: &str| piece.children().find(|node| node.has_tag_name(name));
        let missing = |name: &str| fault(piece, format!("the piece has no <{name}>"), "it needs <Points> and <Cells>");
        let before = file.points.len();
        let array =
            child("Points").and_then(|node| node.children().find(Node::is_element)).ok_or_else(|| missing("Points"))?;
        let column = self.array(array, Some(points), Some(3))?;
        file.points.extend(column.values.chunks_exact(3).map(DVec3::from_slice));
        let node = child("Cells").ok_or_else(|| missing("Cells"))?;
        self.cells(node, cells, before, file)?;
        for (name, rows, columns) in
            [("PointData", points, &mut file.point_data), ("CellData", cells, &mut file.cell_data)]
        {
            let mut found = BTreeMap::new();
            for node in child(name).iter().flat_map(|data| data.children()).filter(Node::is_element) {
                let title = node.attribute("Name").unwrap_or("").to_string();
                match Scalar::named(node.attribute("type").unwrap_or("")) {
                    Some(_) => drop(found.insert(title, self.array(node, Some(rows), None)?)),
                    None => file.notes.push(format!("`{title}` in <{name}> holds no numbers and is left out")),
                }
            }
            join(columns, found, first, &mut file.notes);
        }
        Ok(())
    }

    fn cells(&self, node: Node, count: usize, first_point: usize, file: &mut VtuFile) -> Result<(), Fault> {
        let named = |name: &str| {
            let array = node.children().find(|child| child.attribute("Name") == Some(name));
            array.ok_or_else(|| {
                fault(node, format!("<Cells> has no array `{name}`"), "it needs connectivity, offsets and types")
            })
        };
        let (types, ends) = (named("types")?, named("offsets")?);
        let in_range = |node: Node, value: f64, most: f64| {
            let allowed = "it must be an integer in range";
            if value.fract() == 0.0 && (0.0..=most).contains(&value) {
                Ok(value)
            } else {
                Err(fault(node, format!("{value} among the {}", node.attribute("Name").unwrap_or("")), allowed))
            }
        };
        for value in self.array(types, Some(count), Some(1))?.values {
            file.types.push(in_range(types, value, 255.0)? as u8);
        }
        let start = file.connectivity.len();
        let connectivity = named("connectivity")?;
        for value in self.array(connectivity, None, None)?.values {
            file.connectivity.push(in_range(connectivity, value, 9e15)? as u64 + first_point as u64);
        }
        let most = (file.connectivity.len() - start) as f64;
        let mut last = 0.0;
        for value in self.array(ends, Some(count), Some(1))?.values {
            if in_range(ends, value, most)? < last {
                return Err(fault(ends, format!("offset {value} follows {last}"), "offsets must not fall"));
            }
            last = value;
            file.offsets.push(start + value as usize);
        }
        if last != most {
            let what = format!("the offsets end at {last}, the connectivity at {most}");
            return Err(fault(ends, what, "both must have the same length"));
        }
        Ok(())
    }

    /// The numbers of a `<DataArray>`; refuses another number of rows or components.
    fn array(&self, node: Node, rows: Option<usize>, components: Option<usize>) -> Result<DataArray, Fault> {
        let name = node.attribute("Name").unwrap_or("unnamed");
        let wrong = |what: String, allowed: &str| fault(node, format!("array `{name}`: {what}"), allowed);
        let kind = node.attribute("type").unwrap_or("");
        let allowed = "it must be Int8 to Int64, UInt8 to UInt64, Float32 or Float64";
        let scalar = Scalar::named(kind).ok_or_else(|| wrong(format!("type `{kind}`"), allowed))?;
        let stated = node.attribute("NumberOfComponents").unwrap_or("1");
        let stated: usize =
            stated.trim().parse().map_err(|_| wrong(format!("{stated} components"), "a number is needed"))?;
        let stated = stated.max(1);
        if components.is_some_and(|components| components != stated) {
            return Err(wrong(format!("{stated} components"), &format!("it must have {}", components.unwrap_or(1))));
        }
        let mut column = match node.attribute("format").unwrap_or("ascii") {
            "ascii" => text_column(node, scalar)
                .map_err(|word| wrong(format!("`{word}` among its values"), "numbers are needed"))?,
            "binary" => {
                let bytes = base64(node.text().unwrap_or("").as_bytes());
                let bytes = bytes.and_then(|bytes| self.unpack(&bytes, scalar));
                scalar.column(&bytes.map_err(|what| wrong(what, "the file may be damaged"))?, self.packing.big_endian)
            }
            "appended" => {
                let bytes =
                    self.appended(node, scalar).map_err(|what| wrong(what, "the file may have been cut short"))?;
                scalar.column(&bytes, self.packing.big_endian)
            }
            other => return Err(wrong(format!("format `{other}`"), "it must be ascii, binary or appended")),
        };
        column.components = stated;
        if let Some(rows) = rows
            && rows.checked_mul(stated) != Some(column.values.len())
        {
            let what = format!("{} values", column.values.len());
            return Err(wrong(what, &format!("{rows} rows of {stated} are needed")));
        }
        Ok(column)
    }

    fn unpack(&self, bytes: &[u8], scalar: Scalar) -> Result<Vec<u8>, String> {
        if bytes.is_empty() {
            // writers leave an array without values empty, without a header
            return Ok(Vec::new());
        }
        let plain = self.packing.unpack(bytes, self.left.get().saturating_mul(scalar.size()))?;
        self.spend(plain.len() / scalar.size())?;
        Ok(plain)
    }

    /// Notes that so many numbers were read.
    fn spend(&self, numbers: usize) -> Result<(), String> {
        let left = self.left.get().checked_sub(numbers);
        self.left.set(left.ok_or("the arrays hold more numbers than a file of this length may")?);
        Ok(())
    }

    fn appended(&self, node: Node, scalar: Scalar) -> Result<Vec<u8>, String> {
        let offset = node.attribute("offset").unwrap_or("");
        let offset: usize = offset.trim().parse().map_err(|_| format!("offset `{offset}` is not a number"))?;
        let data = self.appended.data;
        let from = data
            .get(offset..)
            .ok_or_else(|| format!("offset {offset} lies behind the {} appended bytes", data.len()))?;
        if !self.appended.base64 {
            return self.unpack(from, scalar);
        }
        let next = self.offsets.iter().find(|&&next| next > offset).copied().unwrap_or(data.len());
        let text = &from[..next.min(data.len()) - offset];
        // arrays may share a text, which is decoded for each of them
        self.spend(text.len() / 8)?;
        self.unpack(&base64(text)?, scalar)
    }
}

/// Numbers written as words; an error is the word that is none.
fn text_column(node: Node, scalar: Scalar) -> Result<DataArray, String> {
    let parse = |word: &str| word.parse::<f64>().map_err(|_| word.chars().take(40).collect::<String>());
    let values = node.text().unwrap_or("").split_ascii_whitespace().map(parse).collect::<Result<Vec<f64>, String>>()?;
    Ok(DataArray { components: 1, values, integers: scalar.is_integer() })
}

/// Appends a piece's columns; one that not all pieces have is left out.
fn join(
    columns: &mut BTreeMap<String, DataArray>,
    found: BTreeMap<String, DataArray>,
    first: bool,
    notes: &mut Vec<String>,
) {
    if first {
        *columns = found;
        return;
    }
    columns.retain(|name, column| {
        let more = found.get(name).filter(|more| more.components == column.components);
        match more {
            Some(more) => column.values.extend_from_slice(&more.values),
            None => notes.push(format!("`{name}` is not in all pieces and is left out")),
        }
        more.is_some()
    });
}
