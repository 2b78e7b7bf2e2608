//! Uniform subdivision of meshes.

use sinew::glam::DVec3;
use sinew::mesh::generators::{box_mesh, cylinder_mesh, lens_mesh};
use sinew::mesh::{ElementKind, Ids, Mesh};
use std::collections::BTreeSet;

fn boxes() -> [Mesh; 2] {
    [ElementKind::Tet4, ElementKind::Hex8].map(|kind| box_mesh(DVec3::new(0.3, 0.2, 0.1), (3, 2, 1), kind).unwrap())
}

#[test]
fn each_element_becomes_eight_and_the_volume_is_kept() {
    let round = cylinder_mesh(0.1, 0.3, 4, 3, ElementKind::Hex8).unwrap();
    let lens = lens_mesh(9e-3, 4e-3, 6, 4, ElementKind::Tet4).unwrap();
    for mesh in boxes().into_iter().chain([round, lens]) {
        let (count, volume) = (mesh.element_count(), mesh.volume());
        let mut fine = mesh.clone();
        fine.refine(2).unwrap();
        assert_eq!(fine.element_count(), 64 * count);
        assert!((fine.volume() - volume).abs() < 1e-12 * volume, "{} {volume}", fine.volume());
        let soundness = fine.soundness();
        assert!(soundness.errors.is_empty(), "{:?}", soundness.errors);
    }
}

#[test]
fn a_refined_box_has_the_points_and_the_sets_of_a_box_of_twice_the_cells() {
    for (mesh, kind) in boxes().into_iter().zip([ElementKind::Tet4, ElementKind::Hex8]) {
        let mut fine = mesh;
        fine.refine(1).unwrap();
        let twice = box_mesh(DVec3::new(0.3, 0.2, 0.1), (6, 4, 2), kind).unwrap();
        let name = |x: &DVec3| (*x * 1e6).round().as_i64vec3().to_array();
        let points = |mesh: &Mesh| mesh.points.iter().map(name).collect::<BTreeSet<_>>();
        assert_eq!(points(&fine), points(&twice));
        assert_eq!(fine.points.len(), twice.points.len(), "no point twice");
        for (set, rows) in &twice.node_sets {
            let of = |mesh: &Mesh, rows: &[u32]| {
                rows.iter().map(|&row| name(&mesh.points[row as usize])).collect::<BTreeSet<_>>()
            };
            assert_eq!(of(&fine, &fine.node_sets[set]), of(&twice, rows), "{set}");
            assert_eq!(fine.face_sets[set].len(), twice.face_sets[set].len(), "{set}");
        }
        assert_eq!(fine.surface().len(), twice.surface().len());
    }
}

#[test]
fn sets_of_faces_stay_on_the_surface_and_keep_their_outward_side() {
    for mesh in boxes() {
        let mut fine = mesh;
        fine.refine(1).unwrap();
        let surface: BTreeSet<Vec<u32>> = fine.surface().iter().map(|face| sorted(&face.nodes)).collect();
        for face in &fine.face_sets["x1"] {
            assert!(surface.contains(&sorted(face)), "{face:?} is no face of the surface");
            let [a, b, c] = [face[0], face[1], face[2]].map(|row| fine.points[row as usize]);
            assert!((b - a).cross(c - a).x > 0.0, "{face:?} looks inwards");
        }
    }
}

fn sorted(nodes: &[u32]) -> Vec<u32> {
    nodes.iter().copied().collect::<BTreeSet<_>>().into_iter().collect()
}

#[test]
fn a_set_of_points_without_faces_grows_along_the_surface_that_it_covers() {
    for mut mesh in boxes() {
        mesh.face_sets.clear();
        let all: Vec<u32> = (0..mesh.points.len() as u32).collect();
        mesh.node_sets.insert("all".into(), all);
        mesh.node_sets.insert("edge".into(), {
            let on_edge = |x: &DVec3| x.y == 0.0 && x.z == 0.0;
            (0..mesh.points.len() as u32).filter(|&row| on_edge(&mesh.points[row as usize])).collect()
        });
        mesh.refine(1).unwrap();
        let x1: BTreeSet<u32> = mesh.node_sets["x1"].iter().copied().collect();
        for (row, point) in mesh.points.iter().enumerate() {
            assert_eq!(x1.contains(&(row as u32)), (point.x - 0.3).abs() < 1e-12, "{point}");
        }
        assert_eq!(mesh.node_sets["edge"].len(), 7, "four points and three between them");
    }
}

#[test]
fn parts_of_an_element_bear_its_number_its_vectors_and_its_sets() {
    for mut mesh in boxes() {
        let count = mesh.element_count();
        mesh.element_ids = Ids::Named((0..count as u64).map(|row| 100 + row).collect());
        mesh.point_ids = Ids::Named((0..mesh.points.len() as u64).map(|row| 10 * row).collect());
        mesh.element_sets.insert("second".into(), vec![1]);
        mesh.element_vectors.insert("fibre".into(), (0..count).map(|row| DVec3::splat(row as f64)).collect());
        let (parent, points) = (mesh.element(1).to_vec(), mesh.points.len());
        let corners: Vec<DVec3> = parent.iter().map(|&row| mesh.points[row as usize]).collect();
        mesh.refine(1).unwrap();
        assert_eq!(mesh.element_sets["second"], (8..16).collect::<Vec<u32>>());
        let low = corners.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let high = corners.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
        for part in 8..16 {
            assert_eq!(mesh.element_ids.of(part), 101);
            assert_eq!(mesh.element_vectors["fibre"][part], DVec3::ONE);
            for &row in mesh.element(part) {
                let x = mesh.points[row as usize];
                assert!(x.cmpge(low - 1e-12).all() && x.cmple(high + 1e-12).all(), "{x} is outside of the parent");
            }
        }
        // points keep their numbers, new ones have numbers of their own
        let ids: BTreeSet<u64> = (0..mesh.points.len()).map(|row| mesh.point_ids.of(row)).collect();
        assert_eq!(ids.len(), mesh.points.len());
        assert_eq!(mesh.point_ids.of(points - 1), 10 * (points as u64 - 1));
    }
}
