//! One small mesh in every format: a unit cube (a hexahedron) and a tetrahedron on its side x = 1.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use std::io::Write;

pub const POINTS: [[f64; 3]; 9] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 1.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [1.0, 0.0, 1.0],
    [1.0, 1.0, 1.0],
    [0.0, 1.0, 1.0],
    [2.0, 0.5, 0.5],
];
pub const HEX: [u32; 8] = [0, 1, 2, 3, 4, 5, 6, 7];
pub const TET: [u32; 4] = [1, 2, 6, 8];
pub const BASE: [u32; 4] = [0, 3, 2, 1];
pub const VOLUME: f64 = 1.0 + 1.0 / 6.0;
pub const FIBRES: [[f64; 3]; 2] = [[1.0, 0.0, 0.0], [0.0, 0.6, 0.8]];

/// How numbers are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    Text,
    Little,
    Big,
}

/// Bytes of a file in the making.
pub struct Out(pub Vec<u8>, pub Form);

impl Out {
    pub fn text(&mut self, text: &str) {
        self.0.extend(text.as_bytes());
    }

    fn put<const N: usize>(&mut self, mut little: [u8; N], word: String) {
        match self.1 {
            Form::Text => return self.text(&format!("{word}\n")),
            Form::Big => little.reverse(),
            Form::Little => {}
        }
        self.0.extend(little);
    }

    pub fn int(&mut self, value: u32) {
        self.put(value.to_le_bytes(), value.to_string());
    }

    pub fn size(&mut self, value: u64) {
        self.put(value.to_le_bytes(), value.to_string());
    }

    pub fn double(&mut self, value: f64) {
        self.put(value.to_le_bytes(), value.to_string());
    }

    pub fn float(&mut self, value: f32) {
        self.put(value.to_le_bytes(), value.to_string());
    }
}

/// Gmsh's number of a node: with gaps.
pub fn number(row: u32) -> u32 {
    10 * (row + 1)
}

const NAMES: &str = "$PhysicalNames\n2\n3 1 \"soft\"\n2 5 \"base\"\n$EndPhysicalNames\n";

pub fn gmsh1() -> Vec<u8> {
    let mut out = Out(Vec::new(), Form::Text);
    out.text("$NOD\n9\n");
    for (row, [x, y, z]) in (0..).zip(POINTS) {
        out.text(&format!("{} {x} {y} {z}\n", number(row)));
    }
    let list = |rows: &[u32]| rows.iter().map(|&row| number(row).to_string()).collect::<Vec<_>>().join(" ");
    out.text("$ENDNOD\n$ELM\n3\n");
    out.text(&format!("100 3 5 1 4 {}\n", list(&BASE)));
    out.text(&format!("101 4 1 1 4 {}\n", list(&TET)));
    out.text(&format!("102 5 2 1 8 {}\n$ENDELM\n", list(&HEX)));
    out.0
}

pub fn gmsh2(form: Form) -> Vec<u8> {
    let mut out = Out(Vec::new(), form);
    out.text(if form == Form::Text { "$MeshFormat\n2.2 0 8\n" } else { "$MeshFormat\n2.2 1 8\n" });
    if form != Form::Text {
        out.int(1);
        out.text("\n");
    }
    out.text(&format!("$EndMeshFormat\n{NAMES}$Nodes\n9\n"));
    for (row, point) in (0..).zip(POINTS) {
        out.int(number(row));
        point.into_iter().for_each(|x| out.double(x));
    }
    out.text("\n$EndNodes\n$Elements\n3\n");
    for (name, kind, group, nodes) in [(100, 3, 5, &BASE[..]), (101, 4, 1, &TET[..]), (102, 5, 2, &HEX[..])] {
        let head = if form == Form::Text { [name, kind, 2] } else { [kind, 1, 2] };
        head.into_iter().for_each(|value| out.int(value));
        let tail = if form == Form::Text { &[group, 1][..] } else { &[name, group, 1][..] };
        tail.iter().for_each(|&value| out.int(value));
        nodes.iter().for_each(|&row| out.int(number(row)));
    }
    out.text("\n$EndElements\n");
    element_data(&mut out);
    out.0
}

pub fn gmsh4(form: Form) -> Vec<u8> {
    let mut out = Out(Vec::new(), form);
    out.text(if form == Form::Text { "$MeshFormat\n4.1 0 8\n" } else { "$MeshFormat\n4.1 1 8\n" });
    if form != Form::Text {
        out.int(1);
        out.text("\n");
    }
    out.text(&format!("$EndMeshFormat\n{NAMES}$Entities\n"));
    [0, 0, 1, 2].into_iter().for_each(|count| out.size(count));
    for (entity, group) in [(7, 5), (1, 1), (2, 2)] {
        out.int(entity);
        [0.0; 6].into_iter().for_each(|x| out.double(x));
        out.size(1);
        out.int(group);
        out.size(0);
    }
    out.text("\n$EndEntities\n$Nodes\n");
    [2, 9, 10, 90].into_iter().for_each(|count| out.size(count));
    for (dimension, parametric, rows) in [(2, 1, 0..4), (3, 0, 4..9)] {
        [dimension, 1, parametric].into_iter().for_each(|value| out.int(value));
        out.size(rows.len() as u64);
        rows.clone().for_each(|row| out.size(u64::from(number(row))));
        for row in rows {
            POINTS[row as usize].into_iter().for_each(|x| out.double(x));
            (0..dimension * parametric).for_each(|_| out.double(0.25));
        }
    }
    out.text("\n$EndNodes\n$Elements\n");
    [3, 3, 100, 102].into_iter().for_each(|count| out.size(count));
    for (name, dimension, entity, kind, nodes) in
        [(100, 2, 7, 3, &BASE[..]), (101, 3, 1, 4, &TET[..]), (102, 3, 2, 5, &HEX[..])]
    {
        [dimension, entity, kind].into_iter().for_each(|value| out.int(value));
        out.size(1);
        out.size(name);
        nodes.iter().for_each(|&row| out.size(u64::from(number(row))));
    }
    out.text("\n$EndElements\n");
    element_data(&mut out);
    out.0
}

fn element_data(out: &mut Out) {
    out.text("$ElementData\n1\n\"fibre\"\n1\n0.0\n3\n0\n3\n2\n");
    for (name, vector) in [(102, FIBRES[0]), (101, FIBRES[1])] {
        out.int(name);
        vector.into_iter().for_each(|x| out.double(x));
    }
    out.text("\n$EndElementData\n");
}

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

/// Every format and form, with the name of a file that holds it.
pub fn all() -> Vec<(String, Vec<u8>)> {
    let mut all = vec![("gmsh1.msh".to_string(), gmsh1())];
    for form in [Form::Text, Form::Little, Form::Big] {
        all.push((format!("gmsh2-{form:?}.msh"), gmsh2(form)));
        all.push((format!("gmsh4-{form:?}.msh"), gmsh4(form)));
    }
    for form in [Form::Text, Form::Big] {
        all.push((format!("vtk3-{form:?}.vtk"), vtk(form, false)));
        all.push((format!("vtk5-{form:?}.vtk"), vtk(form, true)));
    }
    for packing in packings() {
        let Packing { place, compression, header, form } = packing;
        all.push((format!("{place}-{compression}-{header}-{form:?}.vtu"), vtu(packing)));
    }
    all
}
