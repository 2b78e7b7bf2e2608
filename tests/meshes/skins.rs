//! Surfaces that meshes carry: affine motions, virtual work, points outside, hosts that go. Affine motions are exact to
//! the rounding of weights, some 1e-15 of the body's size; the bounds here leave room for badly shaped elements.

use glam::{DMat3, DVec3};
use sinew::mesh::Triangles;
use sinew::mesh::{ElementKind, Mesh, generators};
use sinew::skins::{Embedding, Skin, normals};
use std::collections::HashMap;

/// Numbers between -1 and 1, the same in every run.
struct Dice(u64);

impl Dice {
    fn number(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self) -> DVec3 {
        DVec3::new(self.number(), self.number(), self.number())
    }
}

const SIZE: DVec3 = DVec3::new(0.02, 0.03, 0.01);

/// A box of each kind of elements, its nodes moved by a tenth of an element where those stay convex.
fn meshes() -> Vec<(ElementKind, Mesh)> {
    let mesh = |kind: ElementKind| {
        let mut mesh = generators::box_mesh(SIZE, (4, 5, 3), kind).unwrap();
        let mut dice = Dice(7);
        if kind != ElementKind::Tet10 {
            mesh.points.iter_mut().for_each(|point| *point += 2e-4 * dice.vector());
        }
        (kind, mesh)
    };
    ElementKind::ALL.into_iter().map(mesh).collect()
}

/// Points in a box and, where `beyond` is above 0, around it (m).
fn points(count: usize, beyond: f64) -> Vec<DVec3> {
    let mut dice = Dice(3);
    (0..count).map(|_| SIZE / 2.0 + (SIZE / 2.0 + beyond) * dice.vector()).collect()
}

fn affine() -> impl Fn(DVec3) -> DVec3 {
    let gradient = DMat3::from_cols(DVec3::new(1.3, 0.2, -0.1), DVec3::new(-0.4, 0.8, 0.3), DVec3::new(0.1, 0.5, 1.1));
    move |x| gradient * x + DVec3::new(0.01, -0.02, 0.03)
}

#[test]
fn affine_motions_are_reproduced_inside_and_near_outside() {
    for (kind, mesh) in meshes() {
        for beyond in [0.0, 1e-3] {
            let points = points(500, beyond);
            let embedding = Embedding::new(&mesh, &points, &|_| true);
            let nodes: Vec<DVec3> = mesh.points.iter().map(|&x| affine()(x)).collect();
            let found = embedding.places(&mesh, &nodes);
            let worst = points.iter().zip(found).map(|(&x, y)| affine()(x).distance(y)).fold(0.0, f64::max);
            assert!(worst < 1e-15, "{kind:?}, {beyond} m outside: {worst:e} m off");
            let sums = embedding.carriers().iter().map(|carrier| carrier.as_ref().unwrap().weights.iter().sum::<f64>());
            assert!(sums.into_iter().all(|sum| (sum - 1.0).abs() < 1e-12), "{kind:?}");
        }
    }
}

/// Far from the origin, where places have fewer digits, the same elements carry the same points by the same weights.
#[test]
fn points_far_from_the_origin_are_carried_as_near_it() {
    let offset = DVec3::new(1e4, -2e4, 5e3);
    for (kind, mesh) in meshes() {
        let mut far = mesh.clone();
        far.points.iter_mut().for_each(|point| *point += offset);
        let points = points(500, 0.0);
        let moved: Vec<DVec3> = points.iter().map(|&point| point + offset).collect();
        let (here, there) = (Embedding::new(&mesh, &points, &|_| true), Embedding::new(&far, &moved, &|_| true));
        let mut same = 0;
        for (one, other) in here.carriers().iter().flatten().zip(there.carriers().iter().flatten()) {
            // on a face between two it may be either
            if one.element == other.element {
                let apart = one.weights.iter().zip(other.weights).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                // places are rounded by 2e-12 m, and elements measure 3 to 6 mm
                assert!(apart < 3e-8, "{kind:?}: {one:?}, {other:?}");
                same += 1;
            }
        }
        assert!(same > 490, "{kind:?}: {same} of 500 in the same elements");
    }
}

#[test]
fn what_is_far_outside_goes_with_the_rotation_and_not_with_the_strain() {
    let turn = DMat3::from_euler(glam::EulerRot::XYZ, 0.7, -2.0, 1.1);
    let shift = DVec3::new(0.3, 0.2, -0.1);
    for (kind, mesh) in meshes() {
        let points: Vec<DVec3> = points(200, 0.1);
        let embedding = Embedding::new(&mesh, &points, &|_| true);
        let moved = |gradient: DMat3| -> Vec<DVec3> {
            let nodes: Vec<DVec3> = mesh.points.iter().map(|&x| gradient * x + shift).collect();
            embedding.places(&mesh, &nodes)
        };
        for (&x, y) in points.iter().zip(moved(turn)) {
            assert!(y.distance(turn * x + shift) < 1e-14, "{kind:?}: {x} to {y}");
        }
        // stretched to twice the size it would be farther by what it is off the body: it is off by no more than before
        // and an element
        for (&x, y) in points.iter().zip(moved(2.0 * turn)) {
            let off = |x: DVec3| x.distance(x.clamp(DVec3::ZERO, SIZE));
            let now = off(turn.transpose() * (y - shift) / 2.0) * 2.0;
            assert!(now < off(x) + 0.03, "{kind:?}: {x}: {now} m off, {} m before", off(x));
        }
    }
}

#[test]
fn forces_on_the_skin_do_the_same_work_on_the_nodes() {
    for (kind, mesh) in meshes() {
        for beyond in [0.0, 2e-3, 0.05] {
            let points = points(300, beyond);
            let embedding = Embedding::new(&mesh, &points, &|_| true);
            let mut dice = Dice(11);
            let forces: Vec<DVec3> = points.iter().map(|_| dice.vector()).collect();
            let at: Vec<DVec3> = mesh.points.iter().map(|&x| x + 1e-3 * dice.vector()).collect();
            let found = embedding.forces(&mesh, &at, &forces);
            // any motion of the nodes, which weights are linear in
            let moves: Vec<DVec3> = mesh.points.iter().map(|_| dice.vector()).collect();
            let moved = embedding.values(&mesh, |node| moves[node]);
            let work = |forces: &[DVec3], ways: &[DVec3]| -> (f64, f64) {
                let parts = forces.iter().zip(ways).map(|(force, way)| force.dot(*way));
                parts.fold((0.0, 0.0), |(sum, size), part| (sum + part, size + part.abs()))
            };
            let ((outer, size), (inner, _)) = (work(&forces, &moved), work(&found.forces, &moves));
            assert!((outer - inner).abs() < 1e-12 * size, "{kind:?}: {outer} and {inner}");
            let (sum, all): (DVec3, DVec3) = (forces.iter().sum(), found.forces.iter().sum());
            assert!(sum.distance(all) < 1e-12 * forces.len() as f64, "{kind:?}: {sum} and {all}");
            let places = embedding.places(&mesh, &at);
            let moment =
                |at: &[DVec3], forces: &[DVec3]| -> DVec3 { at.iter().zip(forces).map(|(x, f)| x.cross(*f)).sum() };
            let left = moment(&places, &forces).distance(moment(&at, &found.forces) + found.left_out);
            assert!(left < 1e-13 * forces.len() as f64, "{kind:?}: {left} N m");
        }
    }
}

/// A large element whose middle is far from the point, and a small one whose middle is near it.
#[test]
fn the_nearest_element_is_that_with_the_nearest_place() {
    let mut mesh = generators::box_mesh(DVec3::new(2.0, 1.0, 1.0), (2, 1, 1), ElementKind::Hex8).unwrap();
    mesh.points.iter_mut().filter(|point| point.x == 2.0).for_each(|point| point.x = 10.0);
    let at = DVec3::new(1.2, 0.5, 1.1);
    let found = Embedding::new(&mesh, &[at], &|_| true);
    assert_eq!(found.carriers()[0].as_ref().unwrap().element, 1);
}

#[test]
fn points_whose_element_has_gone_go_with_the_nearest_that_lives() {
    for (kind, mesh) in meshes() {
        let points = points(300, 1e-3);
        let whole = Embedding::new(&mesh, &points, &|_| true);
        let mut dice = Dice(5);
        let first: Vec<bool> = (0..mesh.element_count()).map(|_| dice.number() > -0.3).collect();
        let then: Vec<bool> = first.iter().map(|lives| *lives && dice.number() > 0.0).collect();
        let now = whole.rebound(&mesh, &points, &|element| then[element]);
        for ((carrier, before), &x) in now.carriers().iter().zip(whole.carriers()).zip(&points) {
            let (carrier, before) = (carrier.as_ref().unwrap(), before.as_ref().unwrap());
            assert!(then[carrier.element]);
            assert!(!then[before.element] || carrier == before);
            // none that lives is nearer than by its nodes
            let nodes =
                mesh.element(carrier.element).iter().map(|&node| mesh.points[node as usize]).collect::<Vec<_>>();
            assert!(carrier.place(&nodes).distance(x) < 1e-15, "{kind:?}");
        }
        let mut skin = Skin::new(mesh.clone(), surface(&points));
        skin.update_alive(first);
        skin.update_alive(then.clone());
        assert_eq!(skin.embedding(), &now, "{kind:?}: the way there does not matter");
        let shown: Vec<[u32; 3]> = skin.triangles().into_iter().map(|(triangle, _)| triangle).collect();
        let centroids: Vec<DVec3> = points.as_chunks::<3>().0.iter().map(|[a, b, c]| (*a + *b + *c) / 3.0).collect();
        let under = Embedding::new(&mesh, &centroids, &|_| true);
        let element = |of: &Embedding, row: usize| of.carriers()[row].as_ref().unwrap().element;
        for (number, triangle) in surface(&points).triangles.into_iter().enumerate() {
            let [a, b, c] = triangle.map(|point| element(&whole, point as usize));
            let under = if a == b && b == c { a } else { element(&under, number) };
            assert_eq!(shown.contains(&triangle), then[under], "{kind:?}");
        }
        skin.update_alive(vec![false; mesh.element_count()]);
        assert!(skin.triangles().is_empty());
        assert_eq!(skin.places(&mesh.points), whole.places(&mesh, &mesh.points), "{kind:?}: not at the origin");
    }
}

/// Points on what elements share are carried by the first of these; that keeps no triangle of another.
#[test]
fn all_of_a_skin_that_lies_on_an_element_goes_with_it_whatever_its_number() {
    for (kind, mesh) in meshes() {
        let faces = mesh.surface();
        let all: Vec<([u32; 3], usize)> =
            faces.iter().flat_map(|face| face.triangles().map(|corners| (corners, face.element as usize))).collect();
        let triangles = all.iter().map(|(corners, _)| *corners).collect();
        let surface = Triangles { points: mesh.points.clone(), triangles, ..Triangles::default() };
        let mut skin = Skin::new(mesh.clone(), surface);
        for gone in (0..mesh.element_count()).step_by(7).chain([mesh.element_count() - 1]) {
            skin.update_alive((0..mesh.element_count()).map(|element| element != gone).collect());
            let left: Vec<[u32; 3]> = skin.triangles().into_iter().map(|(corners, _)| corners).collect();
            let expected: Vec<[u32; 3]> =
                all.iter().filter(|(_, element)| *element != gone).map(|(corners, _)| *corners).collect();
            assert!(left == expected, "{kind:?}, {gone}: {} left, not {}", left.len(), expected.len());
        }
    }
}

fn surface(points: &[DVec3]) -> Triangles {
    let corners = 0..points.len() as u32 / 3;
    Triangles {
        points: points.to_vec(),
        triangles: corners.map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
        ..Triangles::default()
    }
}

#[test]
fn exposed_faces_have_no_boundary_whatever_has_gone() {
    for (kind, mesh) in meshes() {
        let mut dice = Dice(13);
        for share in [-1.0, -0.5, 0.0, 0.8] {
            let lives: Vec<bool> = (0..mesh.element_count()).map(|_| dice.number() > share).collect();
            let faces = mesh.exposed(|element| lives[element]);
            let mut edges: HashMap<[u32; 2], usize> = HashMap::new();
            for face in &faces {
                assert!(lives[face.element as usize]);
                let corners = face.corners();
                for (place, &a) in corners.iter().enumerate() {
                    let b = corners[(place + 1) % corners.len()];
                    *edges.entry([a.min(b), a.max(b)]).or_default() += 1;
                }
            }
            assert!(edges.values().all(|count| count % 2 == 0), "{kind:?}");
            assert_eq!(faces.is_empty(), !lives.contains(&true));
        }
        assert_eq!(mesh.exposed(|_| true), mesh.surface());
    }
}

#[test]
fn normals_point_outwards_and_have_length_one() {
    let mesh = generators::ellipsoid_mesh(DVec3::ONE, 8, ElementKind::Tet4).unwrap();
    let triangles: Vec<[u32; 3]> = mesh.surface().iter().flat_map(|face| face.triangles()).collect();
    let normals = normals(&mesh.points, &triangles);
    for &row in triangles.iter().flatten() {
        let (normal, outwards) = (normals[row as usize], mesh.points[row as usize].normalize());
        assert!((normal.length() - 1.0).abs() < 1e-12 && normal.dot(outwards) > 0.97, "{normal} at {outwards}");
    }
}

/// A tetrahedron and a square as PLY, in a form: text, or the bytes of numbers.
fn ply(form: &str) -> Vec<u8> {
    let mut bytes = format!(
        "ply\nformat {form} 1.0\ncomment a test\nelement vertex 4\nproperty float x\nproperty double y\nproperty short z\n\
         property uchar red\nelement face 2\nproperty uchar quality\nproperty list uchar int vertex_indices\nelement edge 0\n\
         property int a\nend_header\n"
    )
    .into_bytes();
    let points = [(0.0, 0.0, 0), (1.5, 0.0, 0), (1.5, -2.25, 0), (0.0, 1.0, -300)];
    let big = form.contains("big");
    let mut put = |text: String, little: &[u8]| match form {
        "ascii" => bytes.extend(format!("{text} ").bytes()),
        _ if big => bytes.extend(little.iter().rev()),
        _ => bytes.extend(little),
    };
    for (x, y, z) in points {
        put(x.to_string(), &(x as f32).to_le_bytes());
        put(y.to_string(), &f64::to_le_bytes(y));
        put(z.to_string(), &i16::to_le_bytes(z));
        put("7".into(), &[7]);
    }
    for corners in [&[0, 1, 2][..], &[0, 1, 2, 3]] {
        put("1".into(), &[1]);
        put(corners.len().to_string(), &[corners.len() as u8]);
        corners.iter().for_each(|corner| put(corner.to_string(), &i32::to_le_bytes(*corner)));
    }
    bytes
}

#[test]
fn ply_files_are_read_in_all_their_forms_and_cut_short_ones_refused() {
    for form in ["ascii", "binary_little_endian", "binary_big_endian"] {
        let read = Triangles::from_bytes("a.ply", &ply(form)).unwrap();
        assert_eq!(read.points[3], DVec3::new(0.0, 1.0, -300.0), "{form}");
        assert_eq!((read.points[2].y, &read.triangles[..]), (-2.25, &[[0, 1, 2], [0, 1, 2], [0, 2, 3]][..]), "{form}");
        let whole = ply(form);
        for length in 0..whole.len() - 1 {
            let cut = Triangles::from_bytes("a.ply", &whole[..length]);
            // a text may end within its last number
            assert!(cut.is_err() || form == "ascii", "{form}, {length} bytes");
        }
    }
    let told = |from: &str, to: &str| {
        let text = String::from_utf8(ply("ascii")).unwrap();
        assert!(text.contains(from), "{from}");
        Triangles::from_bytes("a.ply", text.replacen(from, to, 1).as_bytes()).unwrap_err().to_string()
    };
    for (from, to, expected) in [
        ("format ascii 1.0\n", "", "the head names no format"),
        ("property float x", "property quad x", "`property quad x` in the head"),
        ("1.5 ", "abc ", "the file ends, or is no number, in vertex 1"),
        ("1.5 ", "nan ", "vertex 1 is no place"),
        ("1 4 0 1 2 3", "1 4 0 1 2 9", "a face names vertex 9; there are 4"),
        ("1 3 0 1 2", "1 2 0 1", "face 0 is no polygon"),
        ("1 3 0 1 2", "1 3 0 1 -2", "face 0 is no polygon"),
        ("end_header\n", "", "the head of the file has no end"),
    ] {
        assert!(told(from, to).contains(expected), "{to}: {}", told(from, to));
    }
}

/// A polygon whose points follow it: one that is not convex does not fold, one that crosses itself is refused.
#[test]
fn polygons_of_ply_files_do_not_fold() {
    let read = |corners: &str| {
        let text = format!(
            "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\nelement vertex 6\n\
             property float x\nproperty float y\nproperty float z\nend_header\n{corners}\n\
             0 0 0\n8 0 0\n8 3 0\n3 3 0\n3 9 0\n0 9 0\n"
        );
        Triangles::from_bytes("l.ply", text.as_bytes())
    };
    for corners in ["6 5 4 3 2 1 0", "6 3 2 1 0 5 4", "6 2 1 0 5 4 3"] {
        let read = read(corners).unwrap();
        let normals = (0..read.triangles.len()).map(|triangle| {
            let [a, b, c] = read.corners(triangle);
            (b - a).cross(c - a).z
        });
        let (all, positive) = (normals.clone().sum::<f64>(), normals.filter(|z| *z > 0.0).count());
        assert_eq!((read.triangles.len(), all, positive), (4, -84.0, 0), "{corners}");
    }
    let error = read("4 0 2 1 5").unwrap_err().to_string();
    assert!(error.contains("face 0, counted from 0, crosses itself"), "{error}");
}
