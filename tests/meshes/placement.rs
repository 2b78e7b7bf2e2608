//! Where meshes stand.

use glam::DVec3;
use sinew::mesh::generators::box_mesh;
use sinew::mesh::{ElementKind, Mesh};

fn one() -> Mesh {
    let mut mesh = box_mesh(DVec3::ONE, (1, 1, 1), ElementKind::Hex8).unwrap();
    mesh.element_vectors.insert("fibre".into(), vec![DVec3::X]);
    mesh
}

#[test]
fn a_mesh_is_scaled_then_turned_about_x_y_z_then_moved() {
    let mut mesh = one();
    mesh.place(2.0, DVec3::new(90.0, 0.0, 90.0), DVec3::new(10.0, 0.0, 0.0)).unwrap();
    // (1, 1, 1)·2, about x: (2, −2, 2), about z: (2, 2, 2), moved: (12, 2, 2)
    assert!(mesh.points[7].distance(DVec3::new(12.0, 2.0, 2.0)) < 1e-14, "{}", mesh.points[7]);
    assert!(mesh.element_vectors["fibre"][0].distance(DVec3::Y) < 1e-15, "vectors turn, neither scaled nor moved");
    assert!((mesh.volume() - 8.0).abs() < 1e-12);
    let mut mesh = one();
    mesh.place(1.0, DVec3::new(0.0, 90.0, 90.0), DVec3::ZERO).unwrap();
    // (0, 0, 1), about y: (1, 0, 0), about z: (0, 1, 0)
    assert!(mesh.points[4].distance(DVec3::Y) < 1e-15, "{}", mesh.points[4]);
}

#[test]
fn impossible_placements_are_refused() {
    for (scale, turn, translate, text) in [
        (0.0, DVec3::ZERO, DVec3::ZERO, "place: scale is 0; it must be a finite number above 0"),
        (-1.0, DVec3::ZERO, DVec3::ZERO, "place: scale is -1;"),
        (f64::NAN, DVec3::ZERO, DVec3::ZERO, "place: scale is NaN;"),
        (1.0, DVec3::new(0.0, f64::INFINITY, 0.0), DVec3::ZERO, "place: rotate is [0, inf, 0]; angles must be finite"),
        (1.0, DVec3::ZERO, DVec3::NAN, "place: translate is [NaN, NaN, NaN]; it must be finite (m)"),
    ] {
        let mut mesh = one();
        let error = mesh.place(scale, turn, translate).unwrap_err().to_string();
        assert!(error.starts_with(text), "{error}");
        assert_eq!(mesh.points, one().points, "a refused placement changes nothing");
    }
}
