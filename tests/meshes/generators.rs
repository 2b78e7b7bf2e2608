//! Generators against exact volumes and areas.
//!
//! A ball of radii a, b, c has 4π/3·abc; a lens of two caps of height h on a circle of radius a has πh/3·(3a² + h²); a
//! mesh inscribed into a smooth surface misses a share of the volume that falls with the square of the cell size.

use super::topology::flux;
use glam::DVec3;
use sinew::mesh::generators::{box_mesh, cylinder_mesh, ellipsoid_mesh, hexahedron_mesh, lens_mesh, tube_mesh};
use sinew::mesh::measure::longest_edge;
use sinew::mesh::{CellKind, ElementKind, Mesh, MeshError};
use std::f64::consts::PI;

const KINDS: [ElementKind; 3] = [ElementKind::Tet4, ElementKind::Hex8, ElementKind::Wedge6];

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
    let shape = |(kind, nodes): (CellKind, &[u32])| {
        let p: Vec<DVec3> = nodes.iter().map(|&node| mesh.points[node as usize]).collect();
        let (solid, edge) = (kind.topology().solid.unwrap(), longest_edge(kind, &p));
        match kind {
            CellKind::Tet4 => (solid.smallest_altitude)(&p) / edge,
            _ => solid.corner_volumes(&p).fold(solid.middle_volume(&p), f64::min) / edge.powi(3),
        }
    };
    mesh.cells.iter().map(shape).fold(f64::MAX, f64::min)
}

#[test]
fn a_box_is_exact_closed_and_named() {
    for kind in KINDS {
        let mesh = box_mesh(DVec3::new(0.1, 0.02, 0.03), (5, 2, 3), kind).unwrap();
        assert_eq!(mesh.points.len(), 6 * 3 * 4);
        assert_eq!(mesh.element_count(), 5 * 2 * 3 * kind.a_cell().unwrap() as usize);
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
        let centre: DVec3 =
            mesh.element(face.element as usize).iter().map(|&row| mesh.points[row as usize] / 8.0).sum();
        assert!(area_vector(&mesh, face.nodes).dot(mesh.points[face.nodes[0] as usize] - centre) > 0.0, "outwards");
    }
}

/// Cook's panel with a twisted top.
fn panel() -> [DVec3; 8] {
    let flat = [(0.0, 0.0), (0.048, 0.044), (0.048, 0.06), (0.0, 0.044)];
    let corner = |i: usize| DVec3::new(flat[i % 4].0, flat[i % 4].1, [0.0, 0.005][i / 4]);
    let mut corners = [0, 1, 2, 3, 4, 5, 6, 7].map(corner);
    corners[6].z = 0.006;
    corners
}

#[test]
fn a_hexahedron_fills_its_corners_whatever_the_cells() {
    // a trilinear block is what its six bilinear faces enclose
    let whole = hexahedron_mesh(panel(), (1, 1, 1), ElementKind::Hex8).unwrap().volume();
    let middle = (0.044 + 0.016) / 2.0 * 0.048 * 0.005;
    assert!(whole > middle && whole < 1.1 * middle, "{whole} m³");
    for kind in KINDS {
        let mesh = hexahedron_mesh(panel(), (6, 5, 2), kind).unwrap();
        let miss = (mesh.volume() / whole - 1.0).abs();
        // hexahedra share the block's own faces; tetrahedra cut the twisted top into triangles
        assert!(miss < if kind == ElementKind::Hex8 { 1e-12 } else { 1e-3 }, "{kind:?}: {miss:e}");
        assert_closed(&mesh, "hexahedron");
        let soundness = mesh.soundness();
        assert!(soundness.is_sound() && soundness.warnings.is_empty(), "{kind:?}: {soundness:?}");
        let loaded = &mesh.node_sets["x1"];
        assert!(loaded.len() == 6 * 3 && loaded.iter().all(|&row| mesh.points[row as usize].x == 0.048));
        for corner in panel() {
            assert!(mesh.points.iter().any(|point| point.distance(corner) < 1e-15), "no node at {corner}");
        }
        let named: usize = mesh.face_sets.values().map(Vec::len).sum();
        assert_eq!(named, mesh.surface().len());
    }
    let unit = [0, 1, 2, 3, 4, 5, 6, 7]
        .map(|i| DVec3::new([0.0, 1.0, 1.0, 0.0][i % 4], [0.0, 0.0, 1.0, 1.0][i % 4], [0.0, 1.0][i / 4]));
    let (block, cube) = (hexahedron_mesh(unit, (3, 2, 4), KINDS[0]), box_mesh(DVec3::ONE, (3, 2, 4), KINDS[0]));
    let (block, cube) = (block.unwrap(), cube.unwrap());
    assert_eq!(block.cells, cube.cells);
    assert!(block.points.iter().zip(&cube.points).all(|(a, b)| a.distance(*b) < 1e-15), "a box is a hexahedron");
}

#[test]
fn a_tube_is_closed_sound_and_named_as_ring_and_as_sector() {
    for kind in KINDS {
        for (angle, around) in [(360.0, 3), (360.0, 16), (90.0, 1), (90.0, 7), (300.0, 12)] {
            let what = format!("{kind:?}, {angle}° of {around} cells");
            let mesh = tube_mesh(0.01, 0.02, 0.03, angle, (3, around, 2), kind).unwrap();
            assert_closed(&mesh, &what);
            let soundness = mesh.soundness();
            assert!(soundness.is_sound() && soundness.warnings.is_empty(), "{what}: {soundness:?}");
            // a ring of straight walls: n triangles of r² sin(φ/n)/2 less those inside
            let share = (f64::to_radians(angle) / f64::from(around)).sin() * f64::from(around) / 2.0;
            let exact = share * (0.02f64.powi(2) - 0.01f64.powi(2)) * 0.03;
            assert!((mesh.volume() / exact - 1.0).abs() < 1e-12, "{what}: {} of {exact} m³", mesh.volume());
            let open = u32::from(angle < 360.0);
            assert_eq!(mesh.points.len() as u32, 4 * (around + open) * 3, "{what}: points");
            let named: usize = mesh.face_sets.values().map(Vec::len).sum();
            assert_eq!(named, mesh.surface().len(), "{what}: every face of the surface has a name");
            for (set, radius) in [("inner", 0.01), ("outer", 0.02)] {
                let at = |row: &u32| mesh.points[*row as usize].truncate().length();
                assert!(mesh.node_sets[set].iter().all(|row| (at(row) - radius).abs() < 1e-15), "{what}: {set}");
            }
            let push: DVec3 = mesh.face_sets["inner"].iter().map(|&face| area_vector(&mesh, face)).sum();
            assert!(angle == 360.0 && push.length() < 1e-15 || push.length() > 1e-5, "{what}: {push}");
            assert_eq!(mesh.node_sets.contains_key("start"), angle < 360.0, "{what}");
        }
    }
    let quarter = tube_mesh(0.01, 0.02, 0.03, 90.0, (2, 4, 1), ElementKind::Hex8).unwrap();
    for (set, flat) in [("start", DVec3::Y), ("end", DVec3::X)] {
        let rows = &quarter.node_sets[set];
        assert!(rows.len() == 6 && rows.iter().all(|&row| quarter.points[row as usize].dot(flat) == 0.0), "{set}");
    }
}

/// Whether all middles of edges are halfway between their ends.
fn is_straight(mesh: &Mesh) -> bool {
    let at = |row: u32| mesh.points[row as usize];
    mesh.middles().into_iter().all(|([a, b], middle)| (0.5 * (at(a) + at(b))).distance(at(middle)) < 1e-12)
}

/// Volume inside a surface of triangles of second order.
fn enclosed_by_curves(mesh: &Mesh) -> f64 {
    let at = |node: u32| mesh.points[node as usize];
    mesh.surface().iter().map(|face| flux(&face.all_nodes().map(at).collect::<Vec<_>>())).sum()
}

/// Middles of edges lie on round surfaces: what lacks falls with the third power of the cells' size at least.
#[test]
fn shapes_of_second_order_follow_their_surface() {
    let kind = ElementKind::Tet10;
    let block = box_mesh(DVec3::new(0.1, 0.02, 0.03), (5, 2, 3), kind).unwrap();
    assert_eq!((block.points.len(), block.element_count()), (11 * 5 * 7, 6 * 5 * 2 * 3));
    assert!((block.volume() / (0.1 * 0.02 * 0.03) - 1.0).abs() < 1e-12);
    assert_eq!((block.node_sets["x1"].len(), block.face_sets["x1"].len()), (5 * 7, 2 * 2 * 3));
    for (name, make, exact) in round_shapes() {
        let miss = |n: u32| (1.0 - make(n, kind).volume() / exact).abs();
        let (coarse, fine) = (miss(8), miss(16));
        println!("{name}: lacks {coarse:.1e} of the volume, and {fine:.1e}");
        assert!(fine < 1e-3 && coarse / fine > 7.0, "{name}: {coarse:.2e} to {fine:.2e}");
    }
    let tube = |angle, cells| tube_mesh(0.01, 0.02, 0.03, angle, cells, kind).unwrap();
    let round = [2, 3, 8, 11].into_iter().flat_map(|n| round_shapes().map(|(name, make, _)| (name, make(n, kind))));
    let tubes = [(360.0, 3), (360.0, 16), (90.0, 1), (300.0, 12)];
    let tubes = tubes.map(|(angle, around)| ("tube", tube(angle, (3, around, 2))));
    let panel = [("hexahedron", hexahedron_mesh(panel(), (6, 5, 2), kind).unwrap()), ("box", block)];
    for (name, mesh) in round.chain(tubes).chain(panel) {
        let what = format!("{name} of {} elements", mesh.element_count());
        let soundness = mesh.soundness();
        assert!(soundness.is_sound() && soundness.warnings.is_empty(), "{what}: {soundness:?}");
        let (inside, volume) = (enclosed_by_curves(&mesh), mesh.volume());
        assert!((inside / volume - 1.0).abs() < 1e-12, "{what}: surface encloses {inside}, elements fill {volume}");
        for (set, faces) in &mesh.face_sets {
            assert!(faces.len() <= mesh.surface().len(), "{set}");
        }
        if name == "cylinder" {
            let at = |row: &u32| mesh.points[*row as usize].truncate().length();
            assert!(mesh.node_sets["side"].iter().all(|row| (at(row) - 0.05).abs() < 1e-15), "{what}");
        }
    }
}

/// The middle of the blunt edge of a lens of one cell would be at its rim, and fold elements.
#[test]
fn edges_are_straight_where_curved_ones_would_fold_elements() {
    assert!(is_straight(&lens(3, ElementKind::Tet10)));
    assert!(!is_straight(&lens(4, ElementKind::Tet10)));
}

#[test]
fn impossible_parameters_are_refused_with_what_is_allowed() {
    let kind = ElementKind::Tet4;
    let text = |result: Result<Mesh, MeshError>| result.unwrap_err().to_string();
    let mut swapped = panel();
    swapped.swap(1, 3);
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
        (
            text(hexahedron_mesh(swapped, (1, 1, 1), kind)),
            "Hexahedron: corners[0] is (0, 0, 0); there the block is flat",
        ),
        (text(hexahedron_mesh([DVec3::NAN; 8], (1, 1, 1), kind)), "Hexahedron: corners[0] is [NaN, NaN, NaN]; it must"),
        (text(hexahedron_mesh(panel(), (1, 1, 0), kind)), "Hexahedron: cells is 1×1×0; there must be at least 1"),
        (
            text(tube_mesh(2.0, 2.0, 1.0, 90.0, (1, 1, 1), kind)),
            "Tube: outer is 2 m; it must be more than `inner`, 2 m",
        ),
        (
            text(tube_mesh(1.0, 2.0, 1.0, 0.0, (1, 1, 1), kind)),
            "Tube: angle is 0°; it must be above 0° and at most 360°",
        ),
        (text(tube_mesh(1.0, 2.0, 1.0, f64::NAN, (1, 1, 1), kind)), "Tube: angle is NaN°;"),
        (
            text(tube_mesh(1.0, 2.0, 1.0, 360.0, (1, 2, 1), kind)),
            "Tube: cells is 1×2×1; an angle of 360° needs at least 3 cells around",
        ),
        (text(lens_mesh(1.0, 1.5, 4, 4, kind)), "Lens: thickness is 1.5 m; it must be at most the diameter, 1 m"),
    ] {
        assert!(found.contains(expected), "found    {found}\nexpected {expected}");
    }
}
