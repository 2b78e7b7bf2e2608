//! The meshes that ship with the scenes.

use sinew::mesh::{CellKind, Mesh};
use std::f64::consts::PI;
use std::path::Path;

#[test]
fn the_lenses_are_sound_and_named() {
    // two caps of height h on a circle of radius a: πh/3·(3a² + h²)
    let exact = PI * 2e-3 / 3.0 * (3.0 * 4.5e-3f64.powi(2) + 2e-3f64.powi(2));
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/meshes");
    for (file, nodes, tets, miss) in [("lens_814.msh", 814, 4093, 0.025), ("lens_7880.msh", 7880, 46713, 0.012)] {
        let mesh = Mesh::read(folder.join(file), false).unwrap();
        assert_eq!((mesh.points.len(), mesh.cells.count(CellKind::Tet4)), (nodes, tets));
        assert!((0.0..miss).contains(&(1.0 - mesh.volume() / exact)), "{file}: {:e} of {exact:e} m³", mesh.volume());
        assert_eq!((mesh.soundness().warnings, &mesh.notes), (vec![], &vec![]));
        assert_eq!(mesh.element_sets["core"].len() + mesh.element_sets["cortex"].len(), tets);
        assert_eq!(mesh.face_sets["front"].len() + mesh.face_sets["back"].len(), mesh.surface().len());
        assert!(mesh.node_sets["rim"].iter().all(|&row| mesh.points[row as usize].z.abs() < 0.501e-3));
    }
}
