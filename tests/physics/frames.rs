//! Frames of a run, read by the rules of their format alone.

use flate2::read::ZlibDecoder;
use sinew::Simulation;
use sinew::output::Folder;
use std::collections::BTreeMap;
use std::io::Read;
use std::path::Path;

/// The arrays of a frame: rows of numbers by name; those of nodes begin with `node:`.
pub struct Frame {
    pub arrays: BTreeMap<String, Vec<Vec<f64>>>,
    pub cells: usize,
}

impl Frame {
    /// Reads `fields_NUMBER.vtu` of a folder.
    pub fn read(folder: &Path, number: usize) -> Self {
        let file = std::fs::read(folder.join(format!("fields_{number:06}.vtu"))).unwrap();
        let data = file.windows(10).position(|window| window == b"raw\">\n   _").unwrap() + 10;
        let head = String::from_utf8(file[..data - 1].to_vec()).unwrap() + "</AppendedData></VTKFile>";
        let head = roxmltree::Document::parse(&head).unwrap();
        let piece = head.descendants().find(|node| node.has_tag_name("Piece")).unwrap();
        let entries = piece.descendants().filter(|node| node.has_tag_name("DataArray"));
        let arrays = entries.map(|entry| {
            let word = |name: &str| entry.attribute(name).unwrap();
            let bytes = unpacked(&file, data + word("offset").parse::<usize>().unwrap());
            let numbers = numbers(word("type"), &bytes);
            let rows = numbers.chunks_exact(word("NumberOfComponents").parse().unwrap()).map(<[f64]>::to_vec).collect();
            let of_nodes = entry.parent_element().unwrap().has_tag_name("PointData");
            (format!("{}{}", if of_nodes { "node:" } else { "" }, word("Name")), rows)
        });
        let cells = piece.attribute("NumberOfCells").unwrap().parse().unwrap();
        Self { arrays: arrays.collect(), cells }
    }

    /// An array by its name.
    #[track_caller]
    pub fn array(&self, name: &str) -> &[Vec<f64>] {
        self.arrays.get(name).unwrap_or_else(|| panic!("no {name} among {:?}", self.arrays.keys()))
    }

    /// Sums of the components of an array.
    #[track_caller]
    pub fn sum(&self, name: &str) -> Vec<f64> {
        let rows = self.array(name);
        (0..rows[0].len()).map(|i| rows.iter().map(|row| row[i]).sum()).collect()
    }
}

fn unpacked(file: &[u8], at: usize) -> Vec<u8> {
    let word = |row: usize| u64::from_le_bytes(file[at + 8 * row..at + 8 * row + 8].try_into().unwrap()) as usize;
    let (mut bytes, mut next) = (Vec::new(), at + 8 * (3 + word(0)));
    for block in 0..word(0) {
        ZlibDecoder::new(&file[next..next + word(3 + block)]).read_to_end(&mut bytes).unwrap();
        next += word(3 + block);
    }
    bytes
}

fn numbers(kind: &str, bytes: &[u8]) -> Vec<f64> {
    match kind {
        "Float32" => bytes.chunks_exact(4).map(|b| f64::from(f32::from_le_bytes(b.try_into().unwrap()))).collect(),
        "Float64" => bytes.chunks_exact(8).map(|b| f64::from_le_bytes(b.try_into().unwrap())).collect(),
        "Int32" => bytes.chunks_exact(4).map(|b| f64::from(i32::from_le_bytes(b.try_into().unwrap()))).collect(),
        "UInt32" => bytes.chunks_exact(4).map(|b| f64::from(u32::from_le_bytes(b.try_into().unwrap()))).collect(),
        "Int64" => bytes.chunks_exact(8).map(|b| i64::from_le_bytes(b.try_into().unwrap()) as f64).collect(),
        "UInt8" => bytes.iter().map(|&b| f64::from(b)).collect(),
        other => panic!("numbers of the type {other}"),
    }
}

/// Writes a simulation from its present state to its end into a folder.
pub fn run_into(simulation: &mut Simulation, path: &Path) {
    simulation.write_into(&mut Folder::create(path).unwrap()).unwrap();
    simulation.observe().unwrap();
    simulation.finish().unwrap();
}
