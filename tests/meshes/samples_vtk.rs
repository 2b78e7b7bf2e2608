//! The small mesh as VTK writes it.

use crate::samples::{BASE, FIBRES, Form, HEX, Out, POINTS, TET};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use std::io::Write;

/// Legacy VTK; `form` is Text or Big; version 5 has offsets.
pub fn vtk(form: Form, version5: bool) -> Vec<u8> {
    let mut out = Out(Vec::new(), form);
    let (version, word) = (if version5 { "5.1" } else { "3.0" }, if form == Form::Text { "ASCII" } else { "BINARY" });
    out.text(&format!(
        "# vtk DataFile Version {version}\na cube and more\n{word}\nDATASET UNSTRUCTURED_GRID\nPOINTS 9 float\n"
    ));
    POINTS.iter().flatten().for_each(|&x| out.float(x as f32));
    let cells = [&HEX[..], &TET[..], &BASE[..]];
    if version5 {
        out.text("\nMETADATA\nINFORMATION 0\n\nCELLS 4 16\nOFFSETS vtktypeint64\n");
        [0, 8, 12, 16].into_iter().for_each(|offset| out.size(offset));
        out.text("\nCONNECTIVITY vtktypeint64\n");
        cells.iter().copied().flatten().for_each(|&row| out.size(u64::from(row)));
    } else {
        out.text("\nCELLS 3 19\n");
        for cell in cells {
            out.int(cell.len() as u32);
            cell.iter().for_each(|&row| out.int(row));
        }
    }
    out.text("\nCELL_TYPES 3\n");
    [12, 10, 9].into_iter().for_each(|kind| out.int(kind));
    out.text("\nPOINT_DATA 9\nSCALARS t double 1\nLOOKUP_TABLE default\n");
    (0..9).for_each(|row| out.double(f64::from(row)));
    out.text("\nCELL_DATA 3\nSCALARS region int\nLOOKUP_TABLE default\n");
    [7, 8, 9].into_iter().for_each(|region| out.int(region));
    out.text("\nVECTORS fibre double\n");
    FIBRES.iter().flatten().chain(&[0.0; 3]).for_each(|&x| out.double(x));
    out.text("\nFIELD FieldData 1\nsome 2 3 double\n");
    (0..6).for_each(|value| out.double(f64::from(value)));
    out.text("\n");
    out.0
}

/// How a VTU file is packed.
#[derive(Clone, Copy, Debug)]
pub struct Packing {
    /// `ascii`, `binary`, `raw` or `base64`; the last two appended.
    pub place: &'static str,
    /// `none`, `zlib` or `lz4`.
    pub compression: &'static str,
    pub header: usize,
    pub form: Form,
}

/// All packings there are.
pub fn packings() -> Vec<Packing> {
    let mut all = vec![Packing { place: "ascii", compression: "none", header: 4, form: Form::Text }];
    for place in ["binary", "raw", "base64"] {
        for compression in ["none", "zlib", "lz4"] {
            for (header, form) in [(4, Form::Little), (8, Form::Little), (4, Form::Big), (8, Form::Big)] {
                all.push(Packing { place, compression, header, form });
            }
        }
    }
    all
}

impl Packing {
    /// Header and data of an array, compressed in blocks of 48 bytes.
    fn pack(&self, plain: &[u8]) -> (Vec<u8>, Vec<u8>) {
        let mut header = Out(Vec::new(), self.form);
        let mut number = |value: usize| match self.header {
            4 => header.int(value as u32),
            _ => header.size(value as u64),
        };
        if self.compression == "none" {
            number(plain.len());
            return (header.0, plain.to_vec());
        }
        let blocks: Vec<Vec<u8>> = plain.chunks(48).map(|block| self.compress(block)).collect();
        [blocks.len(), 48, plain.len() % 48].into_iter().for_each(&mut number);
        blocks.iter().for_each(|block| number(block.len()));
        (header.0, blocks.concat())
    }

    fn compress(&self, block: &[u8]) -> Vec<u8> {
        if self.compression == "lz4" {
            return lz4_flex::block::compress(block);
        }
        let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
        encoder.write_all(block).unwrap();
        encoder.finish().unwrap()
    }

    /// VTK encodes a compressed array's header apart from its data, an uncompressed one's together.
    fn encode(&self, plain: &[u8]) -> Vec<u8> {
        let (header, data) = self.pack(plain);
        match (self.place, self.compression) {
            ("raw", _) => [header, data].concat(),
            (_, "none") => STANDARD.encode([header, data].concat()).into_bytes(),
            _ => (STANDARD.encode(header) + &STANDARD.encode(data)).into_bytes(),
        }
    }
}

pub fn vtu(packing: Packing) -> Vec<u8> {
    let mut appended = Vec::new();
    let mut array = |name: &str, kind: &str, components: usize, fill: &dyn Fn(&mut Out)| {
        let mut plain = Out(Vec::new(), packing.form);
        fill(&mut plain);
        let head = format!("<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\"");
        match packing.place {
            "ascii" => format!("{head} format=\"ascii\">\n{}</DataArray>\n", String::from_utf8(plain.0).unwrap()),
            "binary" => {
                format!(
                    "{head} format=\"binary\">\n{}\n</DataArray>\n",
                    String::from_utf8(packing.encode(&plain.0)).unwrap()
                )
            }
            _ => {
                let offset = appended.len();
                appended.extend(packing.encode(&plain.0));
                format!("{head} format=\"appended\" offset=\"{offset}\"/>\n")
            }
        }
    };
    let points = array("Points", "Float64", 3, &|out| POINTS.iter().flatten().for_each(|&x| out.double(x)));
    let cells =
        array("connectivity", "UInt32", 1, &|out| HEX.iter().chain(&TET).chain(&BASE).for_each(|&row| out.int(row)))
            + &array("offsets", "Int64", 1, &|out| [8, 12, 16].into_iter().for_each(|end| out.size(end)))
            + &array("types", "Int32", 1, &|out| [12, 10, 9].into_iter().for_each(|kind| out.int(kind)));
    let of_points = array("t", "Float32", 1, &|out| (0..9).for_each(|row| out.float(row as f32)));
    let of_cells = array("region", "Int32", 1, &|out| [7, 8, 9].into_iter().for_each(|region| out.int(region)))
        + &array("fibre", "Float64", 3, &|out| FIBRES.iter().flatten().chain(&[0.0; 3]).for_each(|&x| out.double(x)));
    let order = if packing.form == Form::Big { "BigEndian" } else { "LittleEndian" };
    let compressor = match packing.compression {
        "zlib" => " compressor=\"vtkZLibDataCompressor\"",
        "lz4" => " compressor=\"vtkLZ4DataCompressor\"",
        _ => "",
    };
    let header = 8 * packing.header;
    let mut file = format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"{order}\" \
         header_type=\"UInt{header}\"{compressor}>\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"9\" NumberOfCells=\"3\">\n\
         <PointData>{of_points}</PointData>\n<CellData>{of_cells}</CellData>\n<Points>{points}</Points>\n\
         <Cells>{cells}</Cells>\n</Piece>\n</UnstructuredGrid>\n"
    )
    .into_bytes();
    if !appended.is_empty() {
        file.extend(format!("<AppendedData encoding=\"{}\">\n_", packing.place).bytes());
        file.extend(appended);
        file.extend(b"\n</AppendedData>\n");
    }
    file.extend(b"</VTKFile>\n");
    file
}
