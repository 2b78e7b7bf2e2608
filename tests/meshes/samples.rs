//! One small mesh in every format: a unit cube (a hexahedron) and a tetrahedron on its side x = 1.

pub use crate::samples_vtk::{Packing, packings, vtk, vtu};

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
