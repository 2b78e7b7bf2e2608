//! Generators against exact volumes and areas.
//!
//! A ball of radii a, b, c has 4π/3·abc; a lens of two caps of height h on a circle of radius a has πh/3·(3a² + h²); a mesh
//! inscribed into a smooth surface misses a share of the volume that falls with the square of the cell size.

use glam::DVec3;
use sinew::mesh::generators::{box_mesh, cylinder_mesh, ellipsoid_mesh, lens_mesh};
use sinew::mesh::measure::{hex_determinants, hex_longest_edge, tet_longest_edge, tet_smallest_altitude};
use sinew::mesh::{ElementKind, Mesh, MeshError};
use std::f64::consts::PI;

const KINDS: [ElementKind; 2] = [ElementKind::Tet4, ElementKind::Hex8];

fn cylinder(n: u32, kind: ElementKind) -> Mesh {
    cylinder_mesh(0.05, 0.2, n, n, kind).unwrap()
}

fn ellipsoid(n: u32, kind: ElementKind) -> Mesh {
    ellipsoid_mesh(DVec3::new(0.03, 0.02, 0.025), n, kind).unwrap()
}

fn lens(n: u32, kind: ElementKind) -> Mesh {
    lens_mesh(9e-3, 4e-3, n, n / 2, kind).unwrap()
}

type Shape = (&'static str, fn(u32, ElementKind) -> Mesh, f64);

fn round_shapes() -> [Shape; 3] {
    let (a, h) = (4.5e-3f64, 2e-3f64);
    [
        ("cylinder", cylinder, PI * 0.05 * 0.05 * 0.2),
        ("ellipsoid", ellipsoid, 4.0 / 3.0 * PI * 0.03 * 0.02 * 0.025),
        ("lens", lens, PI * h / 3.0 * (3.0 * a * a + h * h)),
    ]
}

/// Area vector of a face: of a quadrilateral half the cross product of its diagonals.
fn area_vector(mesh: &Mesh, [a, b, c, d]: [u32; 4]) -> DVec3 {
    let at = |row: u32| mesh.points[row as usize];
    0.5 * (at(c) - at(a)).cross(at(d) - at(b))
}

/// Volume inside a surface of triangles and bilinear quadrilaterals, by the divergence theorem.
fn enclosed_volume(mesh: &Mesh, faces: impl Iterator<Item = [u32; 4]>) -> f64 {
    let at = |row: u32| mesh.points[row as usize];
    let cone = |a, b, c| at(a).dot(at(b).cross(at(c))) / 6.0;
    faces
        .map(|[a, b, c, d]| match c == d {
            true => cone(a, b, c),
            // a bilinear face encloses the mean of what its two ways of being cut enclose
            false => (cone(a, b, c) + cone(a, c, d) + cone(a, b, d) + cone(b, c, d)) / 2.0,
        })
        .sum()
}

fn assert_closed(mesh: &Mesh, what: &str) {
    let surface = mesh.surface();
    let sum: DVec3 = surface.iter().map(|face| area_vector(mesh, face.nodes)).sum();
    let total: f64 = surface.iter().map(|face| area_vector(mesh, face.nodes).length()).sum();
    assert!(sum.length() < 1e-12 * total, "{what}: area vectors sum to {sum}, not 0");
    let (inside, volume) = (enclosed_volume(mesh, surface.iter().map(|face| face.nodes)), mesh.volume());
    assert!((inside / volume - 1.0).abs() < 1e-9, "{what}: surface encloses {inside}, elements fill {volume}");
}

/// The thinnest tetrahedron (altitude against edge), or the smallest corner determinant against edge³ of hexahedra.
fn worst_shape(mesh: &Mesh) -> f64 {
    let tets =
        (0..mesh.tets.len()).map(|row| mesh.tet_corners(row)).map(|p| tet_smallest_altitude(p) / tet_longest_edge(p));
    let hexes = (0..mesh.hexes.len())
        .map(|row| mesh.hex_corners(row))
        .map(|p| hex_determinants(p).into_iter().fold(f64::MAX, f64::min) / hex_longest_edge(p).powi(3));
    tets.chain(hexes).fold(f64::MAX, f64::min)
}

#[test]
fn a_box_is_exact_closed_and_named() {
    for kind in KINDS {
        let mesh = box_mesh(DVec3::new(0.1, 0.02, 0.03), (5, 2, 3), kind).unwrap();
        assert_eq!(mesh.points.len(), 6 * 3 * 4);
        assert_eq!(mesh.element_count(), 5 * 2 * 3 * if kind == ElementKind::Tet4 { 6 } else { 1 });
        assert!((mesh.volume() / (0.1 * 0.02 * 0.03) - 1.0).abs() < 1e-12);
        assert_closed(&mesh, "box");
        assert!(mesh.soundness().is_sound());
        assert_eq!(mesh.soundness().warnings, []);
        let x1 = &mesh.node_sets["x1"];
        assert!(x1.len() == 3 * 4 && x1.iter().all(|&row| mesh.points[row as usize].x == 0.1));
        let normal: DVec3 = mesh.face_sets["y0"].iter().map(|&face| area_vector(&mesh, face)).sum();
        assert!(normal.distance(DVec3::new(0.0, -0.1 * 0.03, 0.0)) < 1e-15, "outwards with the side's area: {normal}");
        let named: usize = mesh.face_sets.values().map(Vec::len).sum();
        assert_eq!(named, mesh.surface().len());
    }
}

#[test]
fn volumes_of_round_shapes_converge_with_the_square_of_the_cell_size() {
    for (name, make, exact) in round_shapes() {
        for kind in KINDS {
            let miss = |n: u32| 1.0 - make(n, kind).volume() / exact;
            let (coarse, fine) = (miss(8), miss(16));
            assert!(fine > 0.0 && fine < 0.02, "{name} {kind:?}: misses {fine:.4} of the volume");
            assert!((3.5..5.0).contains(&(coarse / fine)), "{name} {kind:?}: {coarse:.4} to {fine:.4}");
        }
    }
}

#[test]
fn round_shapes_are_closed_and_sound() {
    for (name, make, _) in round_shapes() {
        for kind in KINDS {
            for n in [2, 3, 8, 11] {
                let mesh = make(n, kind);
                assert_closed(&mesh, name);
                let soundness = mesh.soundness();
                assert!(soundness.is_sound() && soundness.warnings.is_empty(), "{name} {n} {kind:?}: {soundness:?}");
            }
        }
    }
}

#[test]
fn no_cell_of_a_round_shape_is_bad() {
    for (name, make, _) in round_shapes() {
        for n in [2, 3, 4, 8, 11, 16, 32] {
            let tets = worst_shape(&make(n, ElementKind::Tet4));
            assert!(tets > 0.22, "{name} of {n} cells: thinnest tetrahedron {tets:.3}");
            // at the grid's own edges two faces lie side by side on the round surface: their angle opens with 1/n
            let hexes = worst_shape(&make(n, ElementKind::Hex8)) * f64::from(n);
            assert!(hexes > 0.11, "{name} of {n} cells: smallest corner determinant {hexes:.3}/n");
        }
    }
}

#[test]
fn surfaces_have_the_areas_of_their_shapes() {
    let area = |mesh: &Mesh, set: &str| -> f64 {
        mesh.face_sets[set].iter().map(|&face| area_vector(mesh, face).length()).sum()
    };
    for kind in KINDS {
        let (side, top) = (area(&cylinder(32, kind), "side"), area(&cylinder(32, kind), "top"));
        assert!((side / (2.0 * PI * 0.05 * 0.2) - 1.0).abs() < 1e-3 && (top / (PI * 0.05 * 0.05) - 1.0).abs() < 1e-3);
        let sphere = ellipsoid_mesh(DVec3::splat(0.5), 32, kind).unwrap();
        assert!((area(&sphere, "surface") / PI - 1.0).abs() < 5e-3);
        // a cap of height h on a circle of radius a: π(a² + h²)
        let (lens, cap) = (lens(32, kind), PI * (4.5e-3f64.powi(2) + 2e-3f64.powi(2)));
        for half in ["front", "back"] {
            assert!((area(&lens, half) / cap - 1.0).abs() < 5e-3, "{half}: {} of {cap} m²", area(&lens, half));
        }
        let rim = lens.points.iter().filter(|point| point.z == 0.0).map(|point| point.length()).fold(0.0, f64::max);
        assert!((rim - 4.5e-3).abs() < 1e-15);
    }
}

#[test]
fn surface_faces_come_in_the_order_of_their_elements() {
    let mesh = box_mesh(DVec3::ONE, (3, 3, 3), ElementKind::Hex8).unwrap();
    let surface = mesh.surface();
    assert_eq!(surface.len(), 54);
    assert!(surface.is_sorted_by_key(|face| face.element));
    for face in &surface {
        let centre: DVec3 = mesh.hexes[face.element as usize].iter().map(|&row| mesh.points[row as usize] / 8.0).sum();
        assert!(area_vector(&mesh, face.nodes).dot(mesh.points[face.nodes[0] as usize] - centre) > 0.0, "outwards");
    }
}

#[test]
fn impossible_parameters_are_refused_with_what_is_allowed() {
    let kind = ElementKind::Tet4;
    let text = |result: Result<Mesh, MeshError>| result.unwrap_err().to_string();
    for (found, expected) in [
        (
            text(box_mesh(DVec3::ONE, (4, 0, 4), kind)),
            "Box: cells is 4×0×4; there must be at least 1 cell in each direction",
        ),
        (
            text(box_mesh(DVec3::new(1.0, -1.0, 1.0), (1, 1, 1), kind)),
            "Box: size.y is -1; it must be a finite length above 0 m",
        ),
        (
            text(box_mesh(DVec3::ONE, (100_000, 100_000, 2), ElementKind::Hex8)),
            "Box: cells is 100000×100000×2; at most 1000000000 cells and 4294967295 points fit the 32-bit numbers",
        ),
        (text(box_mesh(DVec3::ONE, (u32::MAX, u32::MAX, u32::MAX), kind)), "at most 715827882 cells"),
        (text(cylinder_mesh(f64::NAN, 1.0, 4, 4, kind)), "Cylinder: radius is NaN;"),
        (text(ellipsoid_mesh(DVec3::new(1.0, 1.0, f64::INFINITY), 4, kind)), "Ellipsoid: radii.z is inf;"),
        (text(lens_mesh(1.0, 1.5, 4, 4, kind)), "Lens: thickness is 1.5 m; it must be at most the diameter, 1 m"),
    ] {
        assert!(found.contains(expected), "found    {found}\nexpected {expected}");
    }
}
