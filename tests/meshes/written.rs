//! Meshes that are written come back as they were.

use glam::DVec3;
use sinew::mesh::{ElementKind::*, Ids, Mesh, generators::*};
use sinew::output::write_gmsh;

fn meshes() -> Vec<(&'static str, Mesh)> {
    let mut turned = box_mesh(DVec3::new(0.1, 1.0 / 3.0, 0.7), (3, 2, 2), Tet4).unwrap();
    let elements = turned.element_count();
    turned
        .element_vectors
        .insert("fibres".into(), (0..elements).map(|i| DVec3::new(1.0 / 3.0, i as f64, -1e-9)).collect());
    turned.element_sets.insert("every second".into(), (0..elements as u32).step_by(2).collect());
    turned.element_sets.insert("first ten".into(), (0..10).collect());
    turned.node_sets.insert("some".into(), vec![1, 5, 9]);
    turned.point_ids = Ids::Named((0..turned.points.len() as u64).map(|row| 1000 - 3 * row).collect());
    turned.element_ids = Ids::Named((0..elements as u64).map(|row| 7 + 2 * row).collect());
    vec![
        ("tetrahedra with all there is", turned),
        ("hexahedra", box_mesh(DVec3::ONE, (3, 2, 4), Hex8).unwrap()),
        ("a tube", tube_mesh(1.0, 2.0, 1.0, 90.0, (2, 4, 2), Hex8).unwrap()),
        ("a lens", lens_mesh(2.0, 1.0, 4, 2, Tet4).unwrap()),
    ]
}

#[test]
fn a_mesh_written_and_read_again_is_the_same() {
    let folder = tempfile::tempdir().unwrap();
    for (name, mesh) in meshes() {
        let file = folder.path().join("mesh.msh");
        write_gmsh(&file, &mesh).unwrap();
        let read = Mesh::read(&file, false).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(read.points, mesh.points, "{name}");
        assert_eq!(read.cells, mesh.cells, "{name}");
        let numbers = |mesh: &Mesh| -> (Vec<u64>, Vec<u64>) {
            let of_points = (0..mesh.points.len()).map(|row| mesh.point_ids.of(row));
            (of_points.collect(), (0..mesh.element_count()).map(|row| mesh.element_ids.of(row)).collect())
        };
        assert_eq!(numbers(&read), numbers(&mesh), "{name}");
        assert_eq!(read.element_vectors, mesh.element_vectors, "{name}");
        assert_eq!(read.face_sets, mesh.face_sets, "{name}");
        for (set, elements) in &mesh.element_sets {
            assert_eq!(read.element_sets.get(set), Some(elements), "{name}: {set}");
        }
        for (set, nodes) in &mesh.node_sets {
            assert_eq!(read.node_sets.get(set), Some(nodes), "{name}: {set}");
        }
    }
}
