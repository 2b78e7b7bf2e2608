//! Files cut short and changed at random: read or refused, never a panic.

use crate::{readers, samples};
use proptest::prelude::*;
use sinew::mesh::vtu;
use std::sync::LazyLock;

static FILES: LazyLock<Vec<(String, Vec<u8>)>> = LazyLock::new(samples::all);

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_file_cut_short_or_changed_makes_a_panic(
        file in 0usize..1000,
        cut in 0.0f64..1.3,
        changes in prop::collection::vec((0.0f64..1.0, any::<u8>()), 0..4),
        digits in prop::collection::vec((0.0f64..1.0, b'0'..=b'9'), 0..3),
    ) {
        let (name, mut bytes) = FILES[file % FILES.len()].clone();
        bytes.truncate((bytes.len() as f64 * cut.min(1.0)) as usize);
        let length = bytes.len();
        for (place, byte) in changes.into_iter().chain(digits) {
            if let Some(at) = bytes.get_mut((place * length as f64) as usize) {
                *at = byte;
            }
        }
        if let Ok(mesh) = readers::read_turning(&name, &bytes, true) {
            prop_assert!(mesh.soundness().is_sound());
            mesh.surface();
        }
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        std::fs::write(&path, &bytes).unwrap();
        let _ = vtu::read(&path);
    }
}

#[test]
#[ignore = "long"]
fn every_truncation_of_every_format_is_refused_or_read() {
    for (name, bytes) in FILES.iter().filter(|(name, _)| !name.contains("-8-")) {
        for length in (0..bytes.len()).step_by(7) {
            if let Err(error) = readers::read(name, &bytes[..length]) {
                assert!(error.to_string().contains("; "), "says what to do: {error}");
            }
        }
    }
}

#[test]
fn deeply_nested_xml_is_refused() {
    let text = "<a>".repeat(200_000);
    assert!(readers::read("deep.vtu", text.as_bytes()).is_err());
}

/// Few bytes that would take much memory are refused: what a file gives is in proportion to its length.
#[test]
fn files_out_of_all_proportion_are_refused() {
    // one entity in many groups
    let groups: String = (1..=1000).map(|group| format!("{group} ")).collect();
    let elements: String = (1..=2000).map(|number| format!("{number} 1 2 3 4\n")).collect();
    let file = |groups: &str| {
        format!(
            "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 0 1\n1 0 0 0 1 1 1 {groups} 0\n$EndEntities\n$Nodes\n1 4 1 4\n\
         3 1 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n$EndNodes\n$Elements\n1 2000 1 2000\n3 1 4 2000\n{elements}$EndElements\n"
        )
    };
    let told = readers::read("groups.msh", file(&format!("1000 {groups}")).as_bytes()).unwrap_err().to_string();
    assert!(told.contains("entity 1 of dimension 3 is in 1000 groups"), "{told}");
    // many data of elements, each for one element
    let mut text = file("0");
    for field in 0..2000 {
        text += &format!("$ElementData\n1\n\"d{field}\"\n0\n3\n0\n3\n1\n7 1 0 0\n$EndElementData\n");
    }
    let told = readers::read("data.msh", text.as_bytes()).unwrap_err().to_string();
    assert!(told.contains("2000 data of elements have 2000 values together"), "{told}");
}

/// Arrays that lie over each other, or are compressed to next to nothing.
#[test]
fn arrays_that_hold_more_than_their_file_are_refused() {
    let blob = vec![0u8; 1 << 20];
    let array = "<DataArray type=\"Int8\" Name=\"NAME\" format=\"appended\" offset=\"0\"/>";
    let arrays: String = (0..40).map(|i| array.replace("NAME", &format!("a{i}"))).collect();
    let file = |arrays: &str, points: usize, compressor: &str, data: &[u8]| {
        let head = format!(
            "<VTKFile type=\"UnstructuredGrid\" header_type=\"UInt64\"{compressor}><UnstructuredGrid><Piece NumberOfPoints=\"{points}\" \
             NumberOfCells=\"0\"><Points><DataArray type=\"Int8\" NumberOfComponents=\"3\" format=\"appended\" offset=\"0\"/></Points>\
             <Cells><DataArray type=\"Int8\" Name=\"connectivity\" format=\"ascii\"/><DataArray type=\"Int8\" Name=\"offsets\" format=\"ascii\"/>\
             <DataArray type=\"Int8\" Name=\"types\" format=\"ascii\"/></Cells><PointData>{arrays}</PointData></Piece></UnstructuredGrid>\
             <AppendedData encoding=\"raw\">_"
        );
        [head.as_bytes(), data, b"</AppendedData></VTKFile>"].concat()
    };
    let shared = [&(3_u64 << 18).to_le_bytes()[..], &blob].concat();
    let arrays = arrays.replace("Int8\"", "Int8\" NumberOfComponents=\"3\"");
    let told = readers::read("shared.vtu", &file(&arrays, 1 << 18, "", &shared)).unwrap_err().to_string();
    assert!(told.contains("more than") && told.contains("a file of this length may hold"), "{told}");
    // 48 MB in 48 kB
    let mut packed = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::best());
    std::io::Write::write_all(&mut packed, &vec![0; 48 << 20]).unwrap();
    let packed = packed.finish().unwrap();
    let header = [1, 48 << 20, 0, packed.len() as u64].map(u64::to_le_bytes).concat();
    let bomb = file("", 16 << 20, " compressor=\"vtkZLibDataCompressor\"", &[&header[..], &packed].concat());
    let told = readers::read("bomb.vtu", &bomb).unwrap_err().to_string();
    assert!(told.contains("a file of this length may hold"), "{told}");
}

#[test]
fn counts_that_no_file_holds_are_refused_unallocated() {
    for name in ["claims.msh", "claims-4.msh", "claims.vtk", "claims.vtu"] {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fuzz/corpus/meshes").join(name);
        let told = readers::read(name, &std::fs::read(path).unwrap()).unwrap_err().to_string();
        assert!(told.contains("1000000000000000000"), "{told}");
    }
}

#[test]
fn a_node_with_the_largest_number_can_be_refined() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fuzz/corpus/meshes/last-number.msh");
    let mut mesh = sinew::mesh::Mesh::read(path, false).unwrap();
    mesh.refine(1).unwrap();
    let sinew::mesh::Ids::Named(ids) = &mesh.point_ids else { panic!("numbers are lost") };
    assert_eq!(ids, &[1, 2, 3, u64::MAX, 0, 4, 5, 6, 7, 8]);
}
