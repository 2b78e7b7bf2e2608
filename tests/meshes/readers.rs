//! Every reader against the same small mesh, and against files that are wrong in one way each.

use crate::samples::{self, Form, number};
use sinew::mesh::{CellKind, Ids, Mesh, MeshError, vtu};

/// Reads a file of that content.
pub fn read(name: &str, bytes: &[u8]) -> Result<Mesh, MeshError> {
    read_turning(name, bytes, false)
}

pub fn read_turning(name: &str, bytes: &[u8], flip_inverted: bool) -> Result<Mesh, MeshError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    Mesh::read(path, flip_inverted)
}

/// The refusal of a text file after one replacement.
fn refusal(name: &str, bytes: &[u8], from: &str, to: &str) -> String {
    let text = String::from_utf8(bytes.to_vec()).unwrap();
    assert!(text.contains(from), "{name} does not contain {from}");
    let error = read(name, text.replacen(from, to, 1).as_bytes()).unwrap_err().to_string();
    error[error.find(name).unwrap()..].to_string()
}

#[test]
fn every_format_and_form_gives_the_same_mesh() {
    for (name, bytes) in samples::all() {
        let mesh = read(&name, &bytes).unwrap_or_else(|error| panic!("{error}"));
        let cells: Vec<(CellKind, &[u32])> = mesh.cells.iter().collect();
        assert_eq!(cells, [(CellKind::Tet4, &samples::TET[..]), (CellKind::Hex8, &samples::HEX)], "{name}");
        for (point, exact) in mesh.points.iter().zip(samples::POINTS) {
            assert_eq!(point.to_array(), exact, "{name}");
        }
        assert!((mesh.volume() - samples::VOLUME).abs() < 1e-14);
        let gmsh = name.ends_with("msh");
        let (soft, hard, base) = match (gmsh, name.starts_with("gmsh1")) {
            (true, true) => ("1", "2", "5"),
            (true, false) => ("soft", "2", "base"),
            _ => ("region=8", "region=7", "region=9"),
        };
        assert_eq!((&mesh.element_sets[soft][..], &mesh.element_sets[hard][..]), (&[0][..], &[1][..]), "{name}");
        assert_eq!(mesh.node_sets[soft], [1, 2, 6, 8], "{name}");
        assert_eq!(mesh.face_sets[base], [samples::BASE], "{name}");
        assert_eq!(mesh.node_sets[base], [0, 1, 2, 3], "{name}");
        assert_eq!(mesh.notes, Vec::<String>::new(), "{name}");
        if gmsh {
            assert_eq!(mesh.point_ids, Ids::Named((0..9).map(|row| u64::from(number(row))).collect()), "{name}");
            assert_eq!(mesh.element_ids, Ids::Named(vec![101, 102]), "{name}");
        } else {
            assert_eq!((&mesh.point_ids, &mesh.element_ids), (&Ids::Rows, &Ids::Named(vec![1, 0])), "{name}");
        }
        if !name.starts_with("gmsh1") {
            let fibres = mesh.element_vectors["fibre"].iter().map(|vector| vector.to_array());
            assert!(fibres.eq([samples::FIBRES[1], samples::FIBRES[0]]), "{name}: tetrahedra come first");
        }
    }
}

#[test]
fn a_vtu_file_gives_all_its_columns() {
    let folder = tempfile::tempdir().unwrap();
    for packing in samples::packings() {
        let path = folder.path().join("all.vtu");
        std::fs::write(&path, samples::vtu(packing)).unwrap();
        let file = vtu::read(&path).unwrap();
        assert_eq!((file.types, file.offsets), (vec![12, 10, 9], vec![8, 12, 16]), "{packing:?}");
        assert_eq!(file.point_data["t"].values, (0..9).map(f64::from).collect::<Vec<_>>(), "{packing:?}");
        assert_eq!((file.cell_data["fibre"].components, file.cell_data["fibre"].integers), (3, false), "{packing:?}");
        assert!(file.cell_data["region"].integers);
    }
}

#[test]
fn pieces_of_a_vtu_file_are_joined() {
    let one = String::from_utf8(samples::vtu(samples::packings()[0])).unwrap();
    let start = one.find("<Piece").unwrap();
    let end = one.find("</Unstr").unwrap();
    let apart = one[start..end].replace("\n2\n0.5\n0.5\n", "\n3\n0.5\n0.5\n");
    let mesh = read("two.vtu", (one[..end].to_string() + &apart + &one[end..]).as_bytes()).unwrap();
    let kinds: Vec<(CellKind, usize)> = mesh.cells.kinds().collect();
    assert_eq!((mesh.points.len(), &kinds[..]), (18, &[(CellKind::Tet4, 2), (CellKind::Hex8, 2)][..]));
    assert_eq!(mesh.element(1), samples::TET.map(|row| row + 9));
    assert_eq!(mesh.element_sets["region=7"], [2, 3]);
}

#[test]
fn voxels_become_hexahedra() {
    let text = String::from_utf8(samples::vtk(Form::Text, false)).unwrap();
    let text = text.replace("8\n0\n1\n2\n3\n4\n5\n6\n7\n", "8 0 1 3 2 4 5 7 6\n").replace("12\n10\n9\n", "11 10 9\n");
    assert_eq!(read("voxel.vtk", text.as_bytes()).unwrap().cells.of_kind(CellKind::Hex8).unwrap(), [samples::HEX]);
}

#[test]
fn wrong_gmsh_files_are_refused_with_place_and_reason() {
    let (one, two, four) = (samples::gmsh1(), samples::gmsh2(Form::Text), samples::gmsh4(Form::Text));
    let cases = [
        refusal("a.msh", &one, "90 2 0.5 0.5", "90 2 0.5 half"),
        refusal("a.msh", &one, "101 4 1 1 4 20", "101 4 1 1 4 21"),
        refusal("a.msh", &one, "$NOD\n9", "$NOD\n8"),
        refusal("a.msh", &one, "$NOD\n9", "$NOD\n900000000000"),
        refusal("a.msh", &one, "90 2 0.5", "80 2 0.5"),
        refusal("a.msh", &one, "101 4 1 1 4", "101 44 1 1 4"),
        refusal("a.msh", &one, "101 4 1 1 4 20 30 70 90", "101 7 1 1 5 20 30 70 90 10"),
        refusal("a.msh", &two, "2.2 0 8", "4 0 8"),
        refusal("a.msh", &four, "\n3\n3\n100\n102\n", "\n3\n4\n100\n102\n"),
        refusal("a.msh", &four, "$EndElements", "$EndElement"),
    ];
    let expected = [
        "a.msh:11: `half` where z should be; a number is needed here",
        "a.msh: 1 element names nodes that the file does not have: 101 (node 21); its 9 nodes have numbers from 10 to 90",
        "a.msh:11: `90` where $ENDNOD should be; the section's count must fit what it holds",
        "a.msh:2: 900000000000 nodes are claimed, 193 bytes follow; the count must fit the file, which may have been cut short",
        "a.msh: the number 80 is given to two nodes; each node needs a number of its own",
        "a.msh:16: element 101 is of the unknown type 44; sinew uses points (15), lines (1), triangles (2), \
         quadrilaterals (3), tetrahedra (4), hexahedra (5)",
        "a.msh: the file holds 1 pyramid; sinew simulates tetrahedra of 4 and of 10 nodes, 8-node hexahedra (voxels too) and 6-node wedges: save the \
         mesh with those alone",
        "a.msh:2: Gmsh format 4; sinew reads the formats 1, 2.0 to 2.2 and 4.1 (in Gmsh: -format msh41 or msh22)",
        "4 elements are claimed, its blocks hold 3; the two counts must agree",
        "`$EndElement` where $EndElements should be",
    ];
    for (found, expected) in cases.iter().zip(expected) {
        assert!(found.contains(expected), "found    {found}\nexpected {expected}");
    }
}

#[test]
fn wrong_vtk_files_are_refused_with_place_and_reason() {
    let (three, five) = (samples::vtk(Form::Text, false), samples::vtk(Form::Text, true));
    let cases = [
        refusal("a.vtk", &three, "Version 3.0", "Version 9.0"),
        refusal("a.vtk", &three, "UNSTRUCTURED_GRID", "STRUCTURED_POINTS"),
        refusal("a.vtk", &three, "CELL_TYPES 3\n12", "CELL_TYPES 3\n15"),
        refusal("a.vtk", &three, "CELL_TYPES 3\n12", "CELL_TYPES 3\n10"),
        refusal("a.vtk", &three, "CELLS 3 19\n8", "CELLS 3 19\n19"),
        refusal("a.vtk", &five, "OFFSETS vtktypeint64\n0\n8", "OFFSETS vtktypeint64\n0\n-8"),
        refusal("a.vtk", &three, "POINT_DATA 9", "POINT_DATA 8"),
        refusal("a.vtk", &three, "POINTS 9 float", "POINTS 9 string"),
    ];
    let expected = [
        "a.vtk:1: `# vtk DataFile Version 9.0`; sinew reads legacy VTK files of the versions 1.0 to 5.1",
        "a.vtk:4: the data set is STRUCTURED_POINTS; sinew reads UNSTRUCTURED_GRID",
        "a.vtk: the file holds 1 pentagonal prism; sinew simulates",
        "a.vtk: cell 0 has 8 points; tetrahedra have 4",
        "cell 0 goes beyond the 19 numbers of CELLS; each cell is its number of points, then the points",
        "-8 in CELLS; points of cells are numbered from 0",
        "data of 8 points; there are 9",
        "a.vtk:5: numbers of type `string`; types are",
    ];
    for (found, expected) in cases.iter().zip(expected) {
        assert!(found.contains(expected), "found    {found}\nexpected {expected}");
    }
}

#[test]
fn wrong_vtu_files_are_refused_with_place_and_reason() {
    let text = samples::vtu(samples::packings()[0]);
    let raw = samples::vtu(samples::Packing { place: "base64", compression: "none", header: 4, form: Form::Little });
    let cases = [
        refusal("a.vtu", &text, "NumberOfPoints=\"9\"", "NumberOfPoints=\"8\""),
        refusal("a.vtu", &text, "type=\"UnstructuredGrid\"", "type=\"PolyData\""),
        refusal("a.vtu", &text, "</Points>", "</Point>"),
        refusal("a.vtu", &text, "\n8\n12\n16\n", "\n8\n12\n15\n"),
        refusal("a.vtu", &text, "Name=\"connectivity\"", "Name=\"connections\""),
        refusal("a.vtu", &text, "0.5", "0,5"),
        refusal("a.vtu", &text, "header_type", "compressor=\"vtkLZMADataCompressor\" header_type"),
        refusal("a.vtu", &raw, "</AppendedData>", ""),
    ];
    let expected = [
        "array `Points`: 27 values; 8 rows of 3 are needed",
        "a.vtu:2: <VTKFile> of type PolyData; sinew reads <VTKFile type=\"UnstructuredGrid\">: volume elements in one file",
        "the XML is damaged (expected 'Points' tag, not 'Point'",
        "the offsets end at 15, the connectivity at 16; both must have the same length",
        "<Cells> has no array `connectivity`; it needs connectivity, offsets and types",
        "array `Points`: `0,5` among its values; numbers are needed",
        "a.vtu:2: compressor vtkLZMADataCompressor; sinew reads vtkZLibDataCompressor, vtkLZ4DataCompressor",
        "AppendedData is cut short; it begins with an underscore and ends with </AppendedData>",
    ];
    for (found, expected) in cases.iter().zip(expected) {
        assert!(found.contains(expected), "found    {found}\nexpected {expected}");
    }
}

#[test]
fn files_of_other_formats_are_refused_by_name() {
    for (name, bytes, reason) in [
        ("a.msh", &b""[..], "the file is empty; sinew reads Gmsh"),
        ("a.msh.gz", b"\x1f\x8b\x08", "compressed with gzip"),
        ("a.stl", b"solid a", "a .stl file holds a surface"),
        ("a.inp", b"*NODE", "the format of .inp files is not known"),
        ("a.vtu", b"what", "does not begin as a .vtu file does"),
    ] {
        let error = read(name, bytes).unwrap_err().to_string();
        assert!(error.contains(reason), "{error}");
    }
    let error = Mesh::read("no/such/file.msh", false).unwrap_err().to_string();
    assert!(error.starts_with("no/such/file.msh: cannot be read"), "{error}");
}

#[test]
fn a_surface_alone_is_refused_with_its_counts() {
    let text = "$NOD\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$ENDNOD\n$ELM\n1\n1 2 0 0 3 1 2 3\n$ENDELM\n";
    let error = read("skin.msh", text.as_bytes()).unwrap_err().to_string();
    assert!(error.contains("a surface mesh of 1 triangle, no volume elements; sinew needs tetrahedra"), "{error}");
}
