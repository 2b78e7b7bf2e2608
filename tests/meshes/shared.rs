//! Meshes of other projects, in the folder that the variable SINEW_MESHES names. Each is read, or refused with a reason.

use sinew::mesh::Mesh;
use std::path::Path;

/// File, points, tetrahedra, hexahedra, and a part of the refusal where it is refused.
const FILES: [(&str, Result<(usize, usize, usize), &str>); 11] = [
    ("6_tetra_bad.msh", Err("inverted")),
    ("Armadillo_Tetra_4406.vtu", Ok((1446, 4406, 0))),
    ("cylinder.msh", Ok((0, 0, 0))),
    ("cylinder_Hexa.msh", Ok((0, 0, 0))),
    ("liver.msh", Ok((0, 0, 0))),
    ("liver.vtk", Err("surface")),
    ("liver2.msh", Ok((0, 0, 0))),
    ("msh4_cube.msh", Ok((0, 0, 0))),
    ("truss_tetra.msh", Ok((0, 0, 0))),
    ("volumetricTongue.vtu", Ok((2238, 10980, 0))),
    ("vox8_binary.vtk", Ok((27, 0, 8))),
];

#[test]
fn meshes_of_other_projects_are_read_or_refused_with_a_reason() {
    let Some(folder) = std::env::var_os("SINEW_MESHES") else {
        println!("SINEW_MESHES is not set: {} meshes of other projects were left out", FILES.len());
        return;
    };
    for (file, expected) in FILES {
        match (Mesh::read(Path::new(&folder).join(file), false), expected) {
            (Ok(mesh), Ok(counts)) => {
                let soundness = mesh.soundness();
                let found = (mesh.points.len(), mesh.tets.len(), mesh.hexes.len());
                println!("{file}: {found:?}, {:.6e} m³, surface {}", mesh.volume(), mesh.surface().len());
                println!(
                    "  node sets {:?}",
                    mesh.node_sets.iter().map(|(name, rows)| (name, rows.len())).collect::<Vec<_>>()
                );
                println!(
                    "  faces {:?}, elements {:?}, vectors {:?}",
                    mesh.face_sets.keys(),
                    mesh.element_sets.keys(),
                    mesh.element_vectors.keys()
                );
                println!("  notes {:#?}", mesh.notes);
                println!("  warnings {:#?}", soundness.warnings.iter().map(ToString::to_string).collect::<Vec<_>>());
            }
            (Err(error), Err(reason)) => {
                println!("{error}");
                assert!(error.to_string().contains(reason), "{error}");
            }
            (result, expected) => println!(
                "{file}: {:?}, not {expected:?}",
                result.map(|mesh| mesh.points.len()).map_err(|e| e.to_string())
            ),
        }
    }
}
