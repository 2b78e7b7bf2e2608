//! Files of triangles, good ones and bad ones.

use super::super::{DistanceGrid, Shape, Solid};
use super::{assert_closed, volume};
use glam::{DQuat, DVec3};
use sinew_mesh::{FilePosition, MeshError, Triangles};

fn tube() -> Triangles {
    let shape = Shape::Tube { length: 12e-3, inner: 2e-3, outer: 3e-3, bevel: 30.0 };
    let (points, triangles) = Solid::new(shape, 0.2e-3).unwrap().surface(16, 0.0);
    // what a binary file holds
    let points = points.into_iter().map(|point| point.as_vec3().as_dvec3()).collect();
    Triangles { points, triangles, ..Triangles::default() }
}

fn each_corner(surface: &Triangles) -> impl Iterator<Item = [DVec3; 3]> {
    surface.triangles.iter().map(|corners| corners.map(|row| surface.points[row as usize]))
}

fn as_text(surface: &Triangles, line: &str) -> String {
    let facet = |corners: [DVec3; 3]| {
        let vertex = |at: DVec3| format!("      vertex {:e} {:e} {:e}", at.x, at.y, at.z);
        let [a, b, c] = corners.map(vertex);
        ["  facet normal nan 0 0", "    outer loop", &a, &b, &c, "    endloop", "  endfacet", ""].join(line)
    };
    let facets: String = each_corner(surface).map(facet).collect();
    format!("solid a tube, facet by facet{line}{facets}endsolid{line}")
}

fn as_binary(surface: &Triangles, head: &[u8]) -> Vec<u8> {
    let mut bytes = head.to_vec();
    bytes.resize(80, b' ');
    bytes.extend((surface.triangles.len() as u32).to_le_bytes());
    for corners in each_corner(surface) {
        bytes.extend([0; 12]);
        bytes.extend(corners.iter().flat_map(|at| at.as_vec3().to_array()).flat_map(f32::to_le_bytes));
        bytes.extend([7, 7]);
    }
    bytes
}

fn as_obj(surface: &Triangles, backwards: bool) -> String {
    let points: String =
        surface.points.iter().map(|at| format!("v {} {} {} 1.0\nvt 0 0\n", at.x, at.y, at.z)).collect();
    let count = surface.points.len() as i64;
    let name = |row: u32| if backwards { i64::from(row) - count } else { i64::from(row) + 1 };
    let faces: String = surface
        .triangles
        .iter()
        .map(|corners| {
            let [a, b, c] = corners.map(name);
            format!("f {a}/1/1 {b}//1 \\\n {c} # a face\n")
        })
        .collect();
    format!("# made by hand\nmtllib x.mtl\no tube\n{points}g all\ns off\n{faces}")
}

#[test]
fn a_surface_is_the_same_from_all_formats() {
    let surface = tube();
    let brute = (surface.points.clone(), surface.triangles.clone());
    let files = [
        ("tube.stl", as_text(&surface, "\n").into_bytes()),
        ("tube.STL", as_text(&surface, "\r\n").to_uppercase().replace("NAN", "nan").into_bytes()),
        ("tube.stl", [b"\xef\xbb\xbf \n", as_text(&surface, "\n").as_bytes()].concat()),
        ("tube.stl", as_binary(&surface, b"binary")),
        ("tube", as_binary(&surface, b"solid but binary\nv 1 2 3")),
        ("tube.obj", as_obj(&surface, false).into_bytes()),
        ("tube.obj", as_obj(&surface, true).into_bytes()),
    ];
    for (name, bytes) in files {
        let read = Triangles::from_bytes(name, &bytes).unwrap_or_else(|error| panic!("{error}"));
        assert!(each_corner(&read).eq(each_corner(&surface)), "{name}");
        assert_eq!(read.points.len(), surface.points.len());
        let read = (read.points, read.triangles);
        assert_closed(&read);
        assert!((volume(&read) / volume(&brute) - 1.0).abs() < 1e-12);
    }
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("tube.stl");
    std::fs::write(&file, as_binary(&surface, b"")).unwrap();
    let grid = DistanceGrid::new(&Triangles::read(&file).unwrap(), 0.2e-3).unwrap();
    assert!(grid.distance(DVec3::new(2.5e-3, 0.0, 8e-3)).0 < -0.4e-3 && grid.notes().is_empty());
    let missing = Triangles::read(folder.path().join("none.stl")).unwrap_err();
    assert!(matches!(missing, MeshError::Unreadable { .. }) && missing.to_string().contains("none.stl"));
}

#[test]
fn polygons_are_fans_and_several_solids_are_one() {
    let cube = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
                f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    let read = Triangles::from_bytes("cube.obj", cube.as_bytes()).unwrap();
    assert_eq!((read.points.len(), read.triangles.len()), (8, 12));
    let both = (read.points.clone(), read.triangles.clone());
    assert_closed(&both);
    assert!((volume(&both) - 1.0).abs() < 1e-15);
    let mut other = read.clone();
    other.points.iter_mut().for_each(|point| point.x += 3.0);
    let text = as_text(&read, "\n") + &as_text(&other, "\n");
    assert_eq!(Triangles::from_bytes("two.stl", text.as_bytes()).unwrap().triangles.len(), 24);
}

/// A prism whose ends are an L of one polygon each, from any corner on, either way round, with corners on its straight
/// edges, too: closed, and of its volume and area.
#[test]
fn polygons_that_are_not_convex_do_not_fold() {
    let plain = [[0, 0], [8, 0], [8, 3], [3, 3], [3, 9], [0, 9]];
    let more = [[0, 0], [4, 0], [8, 0], [8, 3], [5, 3], [3, 3], [3, 3], [3, 6], [3, 7], [3, 9], [0, 9], [0, 8], [0, 5]];
    for outline in [&plain[..], &more] {
        let count = outline.len();
        for first in 0..count {
            let mut text = String::new();
            for (z, [x, y]) in [0, 4].into_iter().flat_map(|z| outline.iter().map(move |at| (z, at))) {
                // neither flat along an axis nor near the origin
                let turned =
                    DQuat::from_rotation_x(0.4) * DQuat::from_rotation_z(0.3) * DVec3::from([*x, *y, z].map(f64::from));
                let at = DVec3::new(50.0, -20.0, 7.0) + turned;
                text += &format!("v {} {} {}\n", at.x, at.y, at.z);
            }
            let around = |k: usize| (first + k) % count;
            let below: Vec<String> = (0..count).rev().map(|k| (around(k) + 1).to_string()).collect();
            let above: Vec<String> = (0..count).map(|k| (around(k) + 1 + count).to_string()).collect();
            text += &format!("f {}\nf {}\n", below.join(" "), above.join(" "));
            for k in 0..count {
                let next = (k + 1) % count;
                text += &format!("f {} {} {} {}\n", k + 1, next + 1, next + 1 + count, k + 1 + count);
            }
            let mut read = Triangles::from_bytes("l.obj", text.as_bytes()).unwrap();
            let area: f64 = (0..read.triangles.len())
                .map(|k| {
                    let [a, b, c] = read.corners(k);
                    0.5 * (b - a).cross(c - a).length()
                })
                .sum();
            assert!((area / (2.0 * 42.0 + 34.0 * 4.0) - 1.0).abs() < 1e-12, "{count}, from {first}: {area}");
            // a side between two corners in one place is none
            read.triangles.retain(|[a, b, c]| a != b && b != c && c != a);
            let both = (read.points, read.triangles);
            assert_closed(&both);
            assert!((volume(&both) / 168.0 - 1.0).abs() < 1e-9, "{count}, from {first}: {}", volume(&both));
        }
    }
}

#[test]
fn polygons_that_cross_themselves_are_refused_with_their_place() {
    let points = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 1 3 0\nv 1 1 0\n";
    let read = |corners: &str| Triangles::from_bytes("a.obj", format!("{points}f {corners}\n").as_bytes());
    for corners in ["1 3 2 4", "1 2 4 3 5", "1 3 2 4 5"] {
        let error = read(corners).unwrap_err();
        let MeshError::Format { at, .. } = &error else { panic!("{error}") };
        assert_eq!(*at, FilePosition::Line(7), "{corners}: {error}");
        assert!(error.to_string().contains("the polygon crosses itself"), "{corners}: {error}");
    }
    // what its first corner sees stays a fan, and so does what is a line
    assert_eq!(read("6 1 2 3").unwrap().triangles.len(), 2);
    assert_eq!(read("1 6 3 6").unwrap().triangles.len(), 2);
    let star: String = (0..1100)
        .map(|k| {
            let (angle, radius) = (f64::from(k) * std::f64::consts::TAU / 1100.0, f64::from(1 + k % 2));
            format!("v {} {} 0\n", radius * angle.cos(), radius * angle.sin())
        })
        .collect();
    let corners: Vec<String> = (1..=1100).map(|k| k.to_string()).collect();
    let error = Triangles::from_bytes("a.obj", format!("{star}f {}\n", corners.join(" ")).as_bytes()).unwrap_err();
    assert!(error.to_string().contains("has 1100 corners and is not convex; 1000 are allowed"), "{error}");
}

#[test]
fn bad_files_are_refused_with_their_place() {
    let text = as_text(&tube(), "\n");
    let lines: Vec<&str> = text.lines().collect();
    let with = |line: usize, new: &str| {
        let mut lines = lines.clone();
        lines[line - 1] = new;
        lines.join("\n").into_bytes()
    };
    let binary = as_binary(&tube(), b"");
    let mut not_finite = binary.clone();
    not_finite[84 + 50 + 12..84 + 50 + 16].copy_from_slice(&f32::NAN.to_le_bytes());
    let cases: [(&str, Vec<u8>, FilePosition, &str); 19] = [
        ("a.stl", with(4, "vertex 1 2 x"), FilePosition::Line(4), "`x` where a coordinate should be"),
        ("a.stl", with(4, "vertex 1 2 inf"), FilePosition::Line(4), "a coordinate is inf"),
        ("a.stl", with(4, "vertex 1 2"), FilePosition::Line(5), "`vertex` where a coordinate should be"),
        ("a.stl", with(7, ""), FilePosition::Line(8), "`endfacet` where endloop should be"),
        ("a.stl", with(9, "face"), FilePosition::Line(9), "`face` where facet or endsolid should be"),
        ("a.stl", lines[..8].join("\n").into_bytes(), FilePosition::Line(8), "the file ends without `endsolid`"),
        ("a.stl", lines[..5].join("\n").into_bytes(), FilePosition::Line(5), "the file ends where"),
        ("a.stl", b"solid\nendsolid\n".to_vec(), FilePosition::File, "the file has no triangles"),
        ("a.stl", binary[..1000].to_vec(), FilePosition::File, "and has 1000"),
        ("a.stl", not_finite, FilePosition::Byte(146), "a coordinate is NaN"),
        ("a.stl", Vec::new(), FilePosition::File, "the file is empty"),
        ("a.obj", b"v 0 0 0\nv 1 0\n".to_vec(), FilePosition::Line(2), "`v 1 0` is no point"),
        ("a.obj", b"v 0 0 0\nv 1 0 0\nf 1 2 3\n".to_vec(), FilePosition::Line(3), "`3` is no corner"),
        ("a.obj", b"v 0 0 0\nf 1 0 1\n".to_vec(), FilePosition::Line(2), "numbers of the 1 points above"),
        ("a.obj", b"v 0 0 0\nv 1 0 0\n\nf 1 2\n".to_vec(), FilePosition::Line(4), "`f 1 2` is no polygon"),
        ("a.obj", b"v 0 0 0\nf 1 -2 1\n".to_vec(), FilePosition::Line(2), "`-2` is no corner"),
        ("a.vtk", b"# vtk DataFile Version 3.0\n".to_vec(), FilePosition::File, "holds a volume mesh"),
        ("a.off", b"OFF\n".to_vec(), FilePosition::File, "the format of .off files is not known"),
        ("a.ply", b"ply\n".to_vec(), FilePosition::File, "the head of the file has no end"),
    ];
    for (name, bytes, place, message) in cases {
        let error = Triangles::from_bytes(name, &bytes).unwrap_err();
        let MeshError::Format { at, .. } = &error else { panic!("{error}") };
        assert!(*at == place && error.to_string().contains(message), "{error}, for {place:?}: {message}");
        assert!(error.to_string().starts_with(name), "{error}");
    }
}

#[test]
fn cut_and_changed_files_are_refused_or_read_but_never_worse() {
    let surface = tube();
    let files = [as_text(&surface, "\n").into_bytes(), as_binary(&surface, b""), as_obj(&surface, true).into_bytes()];
    let mut dice = fastrand::Rng::with_seed(8);
    for file in files {
        for _ in 0..300 {
            let mut bytes = file[..dice.usize(..=file.len())].to_vec();
            for _ in 0..dice.usize(..4) {
                if !bytes.is_empty() {
                    let at = dice.usize(..bytes.len());
                    bytes[at] = dice.u8(..);
                }
            }
            if let Ok(read) = Triangles::from_bytes("changed", &bytes) {
                // open, most of the time
                let _ = DistanceGrid::new(&read, 1e-3);
            }
        }
    }
}
