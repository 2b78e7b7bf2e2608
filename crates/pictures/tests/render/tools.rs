//! Tools of scenes: whether they are seen where they should be, and change nothing where there are none.

use crate::words::{BOX, Run, Seen, plain, seen_with};
use glam::DVec3;
use sinew::scene::schema::Picture;
use sinew::{Folder, SceneFile};
use sinew_pictures::render::{Tools, keep};
use std::path::Path;

/// A scene with some tools; the bodies of the pictures are elsewhere.
fn scene(tools: &str, analysis: &str, folder: &Path) -> SceneFile {
    let text = format!(
        r#"(duration: 2, {analysis}
            bodies: {{"box": (mesh: Box(size: (5, 5, 5), cells: (5, 5, 5)), material: "tissue")}},
            materials: {{"tissue": (density: 1000, neo_hookean: Young(young: 3000, poisson: 0.45))}},
            tools: {{{tools}}})"#
    );
    SceneFile::from_text("scene.ron", &text, folder, &[]).unwrap()
}

/// A cube of 5 m with a corner in the origin, seen from -y with tools around it.
fn rendered(folder: &Path, tools: &Tools, picture: Picture) -> Seen {
    let picture = Picture { from: DVec3::NEG_Y, ..picture };
    seen_with(folder, picture, None, tools.clone())
}

fn tools(text: &str) -> Tools {
    let (tools, missing) = Tools::of_scene(&scene(text, "", Path::new("")), Path::new(""));
    assert!(missing.is_empty(), "{missing:?}");
    tools
}

/// Grey, and darker than what is behind everything.
fn is_steel([r, g, b]: [u8; 3]) -> bool {
    r.max(g).max(b) - r.min(g).min(b) < 30 && b < 225 && b > 60
}

/// Where all is steel around: rims of bodies are grey, too.
fn steel(seen: &Seen) -> Vec<(usize, usize)> {
    let around = [(0, 0), (3, 0), (0, 3), (3, 3)];
    let places = seen.places(is_steel).into_iter();
    places.filter(|(x, y)| around.iter().all(|(dx, dy)| is_steel(seen.at(x + dx, y + dy)))).collect()
}

fn is_body([r, g, b]: [u8; 3]) -> bool {
    r.max(g).max(b) - r.min(g).min(b) > 60
}

/// Least and largest column and row of some pixels.
fn frame(places: &[(usize, usize)]) -> [usize; 4] {
    assert!(!places.is_empty());
    let columns = || places.iter().map(|place| place.0);
    let rows = || places.iter().map(|place| place.1);
    [columns().min().unwrap(), columns().max().unwrap(), rows().min().unwrap(), rows().max().unwrap()]
}

const BALL: &str = r#""ball": (shape: Sphere(radius: 1), at: (2.5, 2.5, 6))"#;

#[test]
fn a_ball_is_seen_on_the_body_that_it_touches() {
    let folder = BOX.write("tool_ball");
    let seen = rendered(&folder, &tools(BALL), plain());
    let [left, right, top, bottom] = frame(&seen.places(is_body));
    let [ball_left, ball_right, ball_top, ball_bottom] = frame(&steel(&seen));
    let middle = |low: usize, high: usize| (low + high) as f64 / 2.0;
    assert!((middle(left, right) - middle(ball_left, ball_right)).abs() < 3.0);
    // two fifths as wide as the cube's front, which is nearer
    let share = (ball_right - ball_left) as f64 / (right - left) as f64;
    assert!(share > 0.3 && share < 0.41, "{share}");
    assert!(ball_top + 20 < top && ball_bottom + 10 > top && ball_bottom < bottom, "{ball_top} {ball_bottom} {top}");
    let without = rendered(&folder, &tools(BALL), Picture { tools: false, ..plain() });
    assert_eq!(steel(&without), []);
}

#[test]
fn what_is_without_tools_is_drawn_as_ever() {
    let folder = BOX.write("tool_none");
    for picture in [plain(), Picture { shadow: true, edges: true, zoom: 1.3, ..Picture::default() }] {
        let picture = Picture { size: plain().size, ..picture };
        let before = rendered(&folder, &Tools::default(), picture.clone());
        assert!(before.bytes == rendered(&folder, &tools(""), picture.clone()).bytes);
        assert!(before.bytes == rendered(&folder, &tools(BALL), Picture { tools: false, ..picture }).bytes);
    }
}

#[test]
fn tools_are_where_they_are_at_the_time_of_a_frame() {
    // the run's frames are at 0 and 1 s
    let folder = Run { removed: Some((|_| false, true)), ..BOX }.write("tool_moves");
    let way = r#""ball": (shape: Sphere(radius: 1), at: (-0.5, 2.5, 6),
        moves: [(displacement: (12, 0, 0), curve: Ramp(end: 2))])"#;
    let course = |analysis: &str| {
        let (tools, _) = Tools::of_scene(&scene(way, analysis, Path::new("")), Path::new(""));
        [0.0, 1.0].map(|time| {
            let picture = Picture { from: DVec3::NEG_Y, ..plain() };
            let [left, right, ..] = frame(&steel(&seen_with(&folder, picture, Some(time), tools.clone())));
            (left + right) as f64 / 2.0
        })
    };
    let [before, after] = course("");
    // 6 m of a cube that is 5 m wide
    assert!(after - before > 150.0, "{before} {after}");
    let [start, half] = course("analysis: Static(),");
    assert!((start - before).abs() < 2.0 && (half - after).abs() < 2.0, "{start} {half}, not {before} {after}");
    // at a quarter of the way there, motions have grown by a tenth
    let [_, part] = course("analysis: Static(at: 4),");
    assert!(part - before < 0.4 * (after - before), "{part}");
}

#[test]
fn a_plane_hides_no_body_from_either_side() {
    let folder = BOX.write("tool_plane");
    let count = |text: &str| rendered(&folder, &tools(text), plain()).count(is_body);
    let front = Picture { from: DVec3::NEG_Y, ..plain() };
    for plane in ["at: (0, 0, 0)", "at: (90, 0, 0)", "at: (0, -0.5, 0), rotation: (-90, 0, 0)"] {
        assert!(count(&format!(r#""plane": (shape: Plane(), {plane})"#)) > 20_000, "{plane}");
    }
    // from above the table is seen around the cube
    let table = tools(r#""table": (shape: Plane())"#);
    let seen = seen_with(&folder, Picture { from: DVec3::new(0.0, -1.0, 1.0), shadow: true, ..front }, None, table);
    let counts = [steel(&seen).len(), seen.count(is_body)];
    assert!(counts[0] > 3000 && counts[1] > 10_000, "{counts:?}");
}

#[test]
fn long_instruments_do_not_make_bodies_small() {
    let folder = BOX.write("tool_long");
    let width = |text: &str| {
        let [left, right, ..] = frame(&rendered(&folder, &tools(text), plain()).places(is_body));
        right - left
    };
    let (alone, upright) =
        (width(""), width(r#""rod": (shape: Cylinder(length: 500, radius: 0.5), at: (2.5, 2.5, 5))"#));
    assert!(upright * 10 > alone * 6, "{upright} of {alone}");
    // one that comes from behind the eye is seen as far as it is before it
    let rod = r#""rod": (shape: Cylinder(length: 500, radius: 0.5), at: (2.5, -0.1, 6), rotation: (80, 0, 0))"#;
    let seen = rendered(&folder, &tools(rod), plain());
    assert!(steel(&seen).len() > 2000, "{}", steel(&seen).len());
}

/// The pyramid of 3 m in mm, its numbers in a file of their own.
const GLTF: &str = r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
"accessors": [
  {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [3000, 3000, 3000]},
  {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"}],
"bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 24}],
"buffers": [{"uri": "pyramid.bin", "byteLength": 72}]}"#;

#[test]
fn tools_of_triangles_are_drawn_from_what_is_kept_or_the_file_and_else_left_out() {
    let (folder, files) = (BOX.write("tool_mesh"), tempfile::tempdir().unwrap());
    let places = [[0.0_f32; 3], [3000.0, 0.0, 0.0], [0.0, 3000.0, 0.0], [0.0, 0.0, 3000.0]];
    let mut numbers: Vec<u8> = places.iter().flatten().flat_map(|number| number.to_le_bytes()).collect();
    numbers.extend([0_u16, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3].iter().flat_map(|row| row.to_le_bytes()));
    let obj = "v 0 0 0\nv 3000 0 0\nv 0 3000 0\nv 0 0 3000\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n".as_bytes();
    let count = |tools: &Tools| steel(&rendered(&folder, tools, plain())).len();
    for (name, contents) in [
        ("pyramid.OBJ", vec![("pyramid.OBJ", obj)]),
        ("pyramid.gltf", vec![("pyramid.gltf", GLTF.as_bytes()), ("pyramid.bin", &*numbers)]),
    ] {
        let text = format!(r#""hook": (mesh: (path: "{name}", scale: 0.001), at: (1, 1, 5)), {BALL}"#);
        let scene = scene(&text, "", files.path());
        let (left, missing) = Tools::of_scene(&scene, &folder);
        let [note] = &missing[..] else { panic!("{missing:?}") };
        assert!(note.starts_with(&format!("the tool `hook` is not drawn: {name}: ")), "{note}");
        let ball = count(&left);
        assert!(ball > 1000);
        for (file, bytes) in &contents {
            std::fs::write(files.path().join(file), bytes).unwrap();
        }
        let kept = files.path().join(format!("run of {name}"));
        keep(&scene, &mut Folder::create(&kept).unwrap()).unwrap();
        let both = |run: &Path| {
            let (both, missing) = Tools::of_scene(&scene, run);
            assert!(missing.is_empty(), "{missing:?}");
            count(&both)
        };
        let from_file = both(&folder);
        for (file, _) in &contents {
            std::fs::remove_file(files.path().join(file)).unwrap();
        }
        let from_kept = both(&kept);
        assert!(from_file > ball + 1000 && from_kept == from_file, "{ball} {from_file} {from_kept}");
    }
}

/// A peak's table has other columns than the way of a tool.
#[test]
fn a_free_tool_is_where_a_probe_that_follows_it_says() {
    let folder = BOX.write("tool_free");
    let ball = r#""ball": (shape: Sphere(radius: 1), free: (density: 1000))"#;
    let course = r#"probes: {"a": (what: ToolPose(tool: "ball"), peak: true), "b": (what: ToolPose(tool: "ball"))},"#;
    let way = |z: f64| format!("t,x,y,z,rx,ry,rz\n0,2.5,2.5,{z},0,0,0\n");
    std::fs::write(folder.join("probe_a.csv"), way(20.0)).unwrap();
    std::fs::write(folder.join("probe_b.csv"), way(6.0)).unwrap();
    let (free, missing) = Tools::of_scene(&scene(ball, course, Path::new("")), &folder);
    assert!(missing.is_empty(), "{missing:?}");
    let poses = free.poses(0, 0.0);
    let [(name, place, _)] = &poses[..] else { panic!("{} tools", poses.len()) };
    assert!(name == "ball" && place.distance(DVec3::new(2.5, 2.5, 6.0)) < 1e-12, "{place}");
    // without one it is told
    let alone = course.replace(r#", "b": (what: ToolPose(tool: "ball"))"#, "");
    let (_, missing) = Tools::of_scene(&scene(ball, &alone, Path::new("")), &folder);
    assert!(missing[0].contains("no probe `ToolPose(tool: \"ball\")` tells where it is"), "{missing:?}");
}
