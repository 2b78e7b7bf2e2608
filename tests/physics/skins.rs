//! Skins go with their bodies: on every backend, when elements go, and from a snapshot on.

use crate::configurations::{Configuration, configurations, cpu_and_long_gpu, near};
use glam::{DMat3, DVec3};
use sinew::mesh::Triangles;
use sinew::scene::{SceneFile, validate};
use sinew::{Folder, Simulation, Snapshot};
use std::collections::BTreeMap;

/// A net of 12 by 12 squares .2 mm above the upper side of a box of 2 × 2 × 1 cm, in mm.
fn net() -> String {
    let mut text = String::new();
    for y in 0..13 {
        for x in 0..13 {
            text += &format!("v {} {} 10.2\n", f64::from(x) * 20.0 / 12.0, f64::from(y) * 20.0 / 12.0);
        }
    }
    for y in 0..12 {
        for x in 0..12 {
            let row = 13 * y + x + 1;
            text += &format!("f {} {} {} {}\n", row, row + 1, row + 14, row + 13);
        }
    }
    text
}

fn scene(elements: &str, more: &str) -> SceneFile {
    scene_with("file: \"net.obj\"", elements, more)
}

fn scene_with(skin: &str, elements: &str, more: &str) -> SceneFile {
    let text = format!(
        "(duration: 0.05, bodies: {{\"b\": (mesh: Box(size: (20, 20, 10), cells: (4, 4, 2), elements: {elements}),
            scale: 1e-3, rotate: (0, 0, 30), translate: (0, 0, 1), material: \"m\", skin: ({skin}))}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.4), damping: 20)}}, {more})"
    );
    let files = BTreeMap::from([("net.obj".to_string(), net().into_bytes())]);
    SceneFile::from_memory("net.ron", &text, files, &[]).unwrap_or_else(|wrong| panic!("{wrong}"))
}

fn start(run: &Configuration, scene: &SceneFile) -> Simulation {
    Simulation::new(scene, &run.options).unwrap_or_else(|error| panic!("{}: {error}", run.name))
}

const AFFINE: &str = "constraints: [Prescribed(on: All, displacement: (1e-3, 0, 2e-3), center: (0, 0, 1),
    gradient: ((0.1, 0.2, 0), (0, -0.1, 0.1), (0.05, 0, 0.2)), curve: Ramp(end: 0.04))]";

#[test]
fn a_skin_goes_where_an_affine_motion_takes_it() {
    let gradient = DMat3::from_cols(DVec3::new(0.1, 0.0, 0.05), DVec3::new(0.2, -0.1, 0.0), DVec3::new(0.0, 0.1, 0.2));
    for run in cpu_and_long_gpu() {
        for elements in ["Tet4", "Hex8", "Wedge6", "Tet10"] {
            let mut simulation = start(&run, &scene(elements, AFFINE));
            let before = simulation.skin("b").unwrap();
            assert_eq!((before.points.len(), before.triangles.len()), (169, 288));
            let corner = DMat3::from_rotation_z(30_f64.to_radians()) * DVec3::new(0.02, 0.02, 0.0102) + DVec3::Z;
            near("a corner at rest", before.rest[168].distance(corner), 0.0, 1.0, 1e-15);
            simulation.finish().unwrap();
            let skin = simulation.skin("b").unwrap();
            let moved = |x: DVec3| x + gradient * (x - DVec3::Z) + DVec3::new(1e-3, 0.0, 2e-3);
            let off = skin.points.iter().zip(&before.rest).map(|(now, rest)| now.distance(moved(*rest)));
            let worst = off.fold(0.0, f64::max);
            // a place of 1 m in f64; displacements of some mm in f32
            near(&format!("{} {elements}", run.name), worst, 0.0, 5e-3, run.bound(1e-12, 1e-6));
            let normal = (DMat3::IDENTITY + gradient).inverse().transpose() * DVec3::Z;
            let wrong = skin.normals.iter().map(|n| n.distance(normal.normalize())).fold(0.0, f64::max);
            near("normals", wrong, 0.0, 1.0, run.bound(1e-10, 1e-4));
        }
    }
}

const REMOVED: &str = "constraints: [Fixed(on: Set(\"z0\"))], loads: [Gravity(acceleration: (3, 0, -9.81))],
    removal: [(on: Sphere(center: (0, 0.01, 1.01), radius: 0.006), when: During(start: 0.01, end: 0.03)),
        (on: Box(min: (-1, -1, 0), max: (1, 1, 1.005)), when: At(0.04))], output: (fields_every: 0.01)";

#[test]
fn a_skin_has_holes_where_elements_went_and_is_the_same_from_a_snapshot_on() {
    for run in configurations() {
        let scene = scene("Tet4", REMOVED);
        let mut simulation = start(&run, &scene);
        simulation.advance_to(0.02).unwrap();
        let file = tempfile::NamedTempFile::new().unwrap();
        simulation.snapshot().unwrap().write(file.path()).unwrap();
        let half = simulation.skin("b").unwrap();
        assert!(half.triangles.len() < 288 && half.triangles.len() > 150, "{}", half.triangles.len());
        simulation.advance_to(0.035).unwrap();
        let after = simulation.skin("b").unwrap();
        assert!(after.triangles.len() < half.triangles.len());
        assert!(
            after.points.iter().all(|point| point.is_finite() && point.distance(DVec3::new(0.0, 0.015, 1.0)) < 0.05)
        );
        let mut again = start(&run, &scene);
        again.restore(&Snapshot::read(file.path()).unwrap()).unwrap();
        assert_eq!(again.skin("b").unwrap(), half, "{}", run.name);
        again.advance_to(0.035).unwrap();
        assert_eq!(again.skin("b").unwrap(), after, "{}", run.name);
    }
}

/// They were written at the origin, 1 m off.
#[test]
fn points_stay_where_they_were_when_all_of_the_body_has_gone() {
    let more = "constraints: [Fixed(on: Set(\"z0\"))], loads: [Gravity(acceleration: (3, 0, -9.81))],
        removal: [(when: At(0.03))], output: (fields_every: 0.01)";
    for run in cpu_and_long_gpu() {
        let mut simulation = start(&run, &scene("Tet4", more));
        simulation.advance_to(0.025).unwrap();
        let before = simulation.skin("b").unwrap();
        simulation.finish().unwrap();
        let after = simulation.skin("b").unwrap();
        assert!(after.triangles.is_empty() && after.elements.iter().all(|element| *element == -1), "{}", run.name);
        let way = before.points.iter().zip(&after.points).map(|(before, after)| before.distance(*after));
        let farthest = way.fold(0.0, f64::max);
        assert!(farthest < 2e-3, "{}: {farthest} m from where they were 5 ms before", run.name);
        assert_eq!(after.rest, before.rest, "{}", run.name);
    }
}

/// A pyramid whose corners go round with the clock; without its base nobody knows what is outside.
#[test]
fn a_closed_skin_that_is_inside_out_is_turned_round_and_told_of() {
    let corners = "v 0 0 0\nvt 0 0\nv 20 0 0\nvt 1 0\nv 0 20 0\nvt 0 1\nv 0 0 10\nvt 1 1\n";
    let round = ["1 3 2", "1 2 4", "2 3 4", "3 1 4"];
    let skin = |faces: &[&str], inside_out: bool| {
        let face = |face: &&str| {
            let mut rows: Vec<String> = face.split(' ').map(|row| format!("{row}/{row}")).collect();
            if inside_out {
                rows.reverse();
            }
            format!("f {}\n", rows.join(" "))
        };
        let text = corners.to_string() + &faces.iter().map(face).collect::<String>();
        let scene = "(duration: 1, bodies: {\"b\": (mesh: Box(size: (20, 20, 10), cells: (2, 2, 1)), scale: 1e-3,
                material: \"m\", skin: (file: \"s.obj\"))},
            materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.4))})";
        let files = BTreeMap::from([("s.obj".to_string(), text.into_bytes())]);
        let file = SceneFile::from_memory("s.ron", scene, files, &[]).unwrap_or_else(|wrong| panic!("{wrong}"));
        let mut simulation = start(&configurations()[0], &file);
        let skin = simulation.skin("b").unwrap();
        (skin, simulation.warnings().render(false).contains("s.obj: the surface was inside out, and was turned round"))
    };
    let (plain, told) = skin(&round, false);
    assert!(!told);
    let (turned, told) = skin(&round, true);
    assert!(told);
    let of_corner = |at: DVec3| -> [f32; 2] {
        match at.to_array().map(|place| place > 5e-3) {
            [true, ..] => [1.0, 0.0],
            [_, true, _] => [0.0, 1.0],
            [.., true] => [1.0, 1.0],
            _ => [0.0, 0.0],
        }
    };
    for state in [&plain, &turned] {
        assert_eq!((state.points.len(), state.triangles.len()), (4, 4));
        let at = state.points.iter().position(|point| point.length() < 1e-9).unwrap();
        near("normal", state.normals[at].dot(DVec3::new(-1.0, -1.0, -2.0).normalize()), 1.0, 1.0, 1e-9);
        assert!(state.points.iter().zip(&state.texture).all(|(at, texture)| *texture == of_corner(*at)), "{state:?}");
    }
    let (_, told) = skin(&round[1..], true);
    assert!(!told, "of an open one nobody knows");
}

#[test]
fn a_run_writes_a_series_of_each_skin() {
    let folder = tempfile::tempdir().unwrap();
    let run = &configurations()[0];
    let mut simulation = start(run, &scene("Hex8", REMOVED));
    let mut into = Folder::create(folder.path()).unwrap();
    simulation.write_into(&mut into).unwrap();
    simulation.observe().unwrap();
    simulation.finish().unwrap();
    drop((simulation, into));
    let names = || -> Vec<String> {
        let entries = std::fs::read_dir(folder.path()).unwrap();
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
    };
    let series = std::fs::read_to_string(folder.path().join("skin_b.pvd")).unwrap();
    assert_eq!(series.matches("skin_b_00000").count(), 6);
    let fields = names().iter().filter(|name| name.starts_with("fields_")).count();
    assert_eq!(names().iter().filter(|name| name.starts_with("skin_b_") && name.ends_with(".vtu")).count(), fields);
    // the next run clears them
    drop(Folder::create(folder.path()).unwrap());
    assert!(!names().iter().any(|name| name.starts_with("skin_")), "{:?}", names());
}

#[test]
fn a_skin_is_also_written_for_programs_that_read_other_files() {
    let run = &configurations()[0];
    for (also, ending) in [("Ply", "ply"), ("Obj", "obj")] {
        let folder = tempfile::tempdir().unwrap();
        let mut into = Folder::create(folder.path()).unwrap();
        let mut simulation = start(run, &scene_with(&format!("file: \"net.obj\", also: {also}"), "Hex8", REMOVED));
        simulation.write_into(&mut into).unwrap();
        simulation.observe().unwrap();
        simulation.finish().unwrap();
        let skin = simulation.skin("b").unwrap();
        let names = || -> Vec<String> {
            let entries = std::fs::read_dir(folder.path()).unwrap();
            entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
        };
        let of =
            |ending: &str| names().iter().filter(|name| name.starts_with("skin_b_") && name.ends_with(ending)).count();
        assert_eq!((of(".vtu"), of(&format!(".{ending}"))), (6, 6));
        let path = folder.path().join(format!("skin_b_000005.{ending}"));
        // the last bits, too
        let read = Triangles::read(&path).unwrap();
        assert!(skin.triangles.len() < 288);
        let corners = |points: &[DVec3], triangles: &[[u32; 3]]| -> Vec<[DVec3; 3]> {
            triangles.iter().map(|corners| corners.map(|row| points[row as usize])).collect()
        };
        let (found, written) = (corners(&read.points, &read.triangles), corners(&skin.points, &skin.triangles));
        assert!(found == written, "{also}: {} triangles, {} of them read", written.len(), found.len());
        let bytes = std::fs::read(&path).unwrap();
        let normal = skin.normals[168].as_vec3().to_array();
        match also {
            "Obj" => assert!(
                String::from_utf8(bytes)
                    .unwrap()
                    .contains(&format!("vn {:?} {:?} {:?}\n", normal[0], normal[1], normal[2]))
            ),
            _ => {
                // 36 bytes a point, 13 a triangle
                let end = bytes.len() - 13 * skin.triangles.len();
                assert_eq!(bytes[end - 12..end], *bytemuck::bytes_of(&normal));
            }
        }
        drop((simulation, into));
        drop(Folder::create(folder.path()).unwrap());
        assert!(!names().iter().any(|name| name.starts_with("skin_")), "{:?}", names());
    }
}

#[test]
fn what_is_no_skin_is_told() {
    let told = |skin: &str, more: &str| {
        let text = format!(
            "(duration: 1, bodies: {{\"b\": (mesh: Box(size: (1, 1, 1), cells: (1, 1, 1)), {more} material: \"m\",
            skin: {skin})}}, materials: {{\"m\": (density: 1, neo_hookean: Young(young: 3e3, poisson: 0.4))}})"
        );
        let files = BTreeMap::from([
            ("net.obj".to_string(), net().into_bytes()),
            ("far.obj".to_string(), b"v 0 0 0\nv 1e9 0 0\nv 0 1 0\nf 1 2 3\n".to_vec()),
            ("text.obj".to_string(), b"nothing".to_vec()),
            ("text.png".to_string(), b"nothing".to_vec()),
        ]);
        let scene = SceneFile::from_memory("s.ron", &text, files, &[]).unwrap_or_else(|wrong| panic!("{wrong}"));
        let mut found = scene.diagnostics();
        validate(&scene, &mut found);
        if !found.has_errors() {
            let options = sinew::Options { backend: sinew::BackendChoice::Cpu, ..sinew::Options::default() };
            return Simulation::new(&scene, &options).map(drop).unwrap_err().to_string();
        }
        found.to_string()
    };
    let near = |told: String, expected: &str| assert!(told.contains(expected), "{told}\nexpected {expected}");
    near(told("(file: \"nets.obj\")", ""), "there is no file `nets.obj`");
    near(told("(file: \"net.obj\", scale: 0)", ""), "`scale` must be above 0, found 0");
    near(told("(file: \"net.obj\", image: \"net.png\")", ""), "there is no file `net.png`");
    near(told("(file: \"net.obj\", image: \"net.obj\")", ""), "PNG (.png)");
    near(told("(file: \"net.obj\", image: \"text.png\")", ""), "`text.png` is no picture that can be read");
    let unknown = SceneFile::from_memory(
        "s.ron",
        "(bodies: {\"b\": (skin: (file: \"a.obj\", also: Stl))})",
        BTreeMap::new(),
        &[],
    );
    let unknown = unknown.map(|scene| scene.diagnostics().to_string()).unwrap_or_else(|wrong| wrong.to_string());
    assert!(["Stl", "Ply", "Obj"].iter().all(|word| unknown.contains(word)), "{unknown}");
    near(told("(file: \"net.obj\")", "copies: 3,"), "a skin on 3 copies of a mesh");
    near(told("(file: \"far.obj\")", ""), "coordinates must be numbers of at most 1e6 m");
    near(told("(file: \"text.obj\")", ""), "text.obj");
    let plain = crate::configurations::scene_of(
        "(duration: 1, bodies: {\"b\": (mesh: Box(size: (1, 1, 1), cells: (1, 1, 1)), material: \"m\")},
        materials: {\"m\": (density: 1, neo_hookean: Young(young: 3e3, poisson: 0.4))})",
        std::path::Path::new("."),
    );
    let mut simulation = start(&configurations()[0], &plain);
    near(simulation.skin("b").unwrap_err().to_string(), "the body `b` has no `skin` in the scene");
    near(simulation.skin("c").unwrap_err().to_string(), "there is no body named \"c\"");
}
