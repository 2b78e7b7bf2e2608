//! Meshes of other projects, in the folder that the variable SINEW_MESHES names. Each is read, or refused with a
//! reason.

use sinew::mesh::{CellKind, Mesh};
use std::path::Path;

/// What a file gives, or a part of its refusal.
type Expected = Result<Counts, &'static str>;

/// Points, tetrahedra, hexahedra, faces of the surface, volume (its own unit cubed), warnings.
type Counts = (usize, usize, usize, usize, f64, usize);

const FILES: [(&str, Expected); 11] = [
    ("6_tetra_bad.msh", Err("1 inverted element: 6 (volume -4.50e0 m³)")),
    ("Armadillo_Tetra_4406.vtu", Ok((1446, 4406, 0, 2532, 231.2143, 1))),
    ("cylinder.msh", Ok((510, 2430, 0, 360, 0.1836826, 0))),
    ("cylinder_Hexa.msh", Ok((5740, 0, 4920, 1526, 2.005807e-4, 0))),
    ("liver.msh", Ok((181, 596, 0, 276, 36.56085, 0))),
    ("liver.vtk", Err("a surface mesh (POLYDATA) of 10000 triangles or polygons, no volume elements")),
    ("liver2.msh", Ok((507, 1493, 0, 860, 1.125092, 0))),
    ("msh4_cube.msh", Ok((14, 24, 0, 24, 1.0, 0))),
    ("truss_tetra.msh", Ok((40, 54, 0, 76, 1e-5, 0))),
    ("volumetricTongue.vtu", Ok((2238, 10980, 0, 1940, 2.448448, 0))),
    ("vox8_binary.vtk", Ok((27, 0, 8, 24, 8.0, 0))),
];

#[test]
fn meshes_of_other_projects_are_read_or_refused_with_a_reason() {
    let Some(folder) = std::env::var_os("SINEW_MESHES") else {
        println!("SINEW_MESHES is not set: {} meshes of other projects were left out", FILES.len());
        return;
    };
    for (file, expected) in FILES {
        match (Mesh::read(Path::new(&folder).join(file), false), expected) {
            (Ok(mesh), Ok((points, tets, hexes, faces, volume, warnings))) => {
                let [of_tets, of_hexes] = [CellKind::Tet4, CellKind::Hex8].map(|kind| mesh.cells.count(kind));
                let found = (mesh.points.len(), of_tets, of_hexes, mesh.surface().len());
                assert_eq!(found, (points, tets, hexes, faces), "{file}");
                assert!((mesh.volume() / volume - 1.0).abs() < 1e-6, "{file}: {:e} m³", mesh.volume());
                assert_eq!(mesh.soundness().warnings.len(), warnings, "{file}: {:?}", mesh.soundness().warnings);
                println!("{file}: {:?}", mesh.notes);
            }
            (Err(error), Err(reason)) => assert!(error.to_string().contains(reason), "{error}"),
            (Ok(_), Err(reason)) => panic!("{file} was read; it should be refused: {reason}"),
            (Err(error), Ok(_)) => panic!("{error}"),
        }
    }
}
