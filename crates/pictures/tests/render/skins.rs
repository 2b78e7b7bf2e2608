//! Skins: shaded by the normals that they bring, and coloured by the elements that carry them.

use crate::words::{plain, seen_with};
use glam::DVec3;
use sinew::mesh::topology::MOST_NODES;
use sinew::mesh::{CellKind, Cells};
use sinew::output::{Array, Folder, Frame, Series, Values};
use sinew::{BackendChoice, Options, SceneFile, Simulation};
use sinew_pictures::render::{FrameFile, Skins, Tools};
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("render").join(name)
}

/// Points of a ball in the middle of a unit cube, from near its one pole to near the other, and triangles between them.
/// `atlas`: each corner of each triangle has its own place in a texture.
fn ball(atlas: bool) -> String {
    let (rings, round) = (10_u32, 20_u32);
    let mut text = String::new();
    for ring in 1..=rings {
        for at in 0..round {
            let (polar, azimuth) = (TAU / 2.0 * f64::from(ring) / f64::from(rings + 1), TAU * f64::from(at) / 20.0);
            let place = DVec3::new(azimuth.cos() * polar.sin(), azimuth.sin() * polar.sin(), polar.cos());
            let [x, y, z] = (place * 0.4 + 0.5).to_array();
            text += &format!("v {x} {y} {z}\n");
        }
    }
    let mut corners = 0_u32;
    for (ring, at) in (1..rings).flat_map(|ring| (0..round).map(move |at| (ring, at))) {
        let row = |ring: u32, at: u32| (ring - 1) * round + at % round + 1;
        let [a, b, c, d] = [row(ring, at), row(ring + 1, at), row(ring + 1, at + 1), row(ring, at + 1)];
        for three in [[a, b, c], [a, c, d]] {
            let mut face = "f".to_string();
            for point in three {
                corners += 1;
                text += &format!("vt {} {}\n", f64::from(corners % 64) / 64.0, f64::from(corners / 64) / 64.0);
                face += &if atlas { format!(" {point}/{corners}") } else { format!(" {point}") };
            }
            text += &format!("{face}\n");
        }
    }
    text
}

/// What a run writes at its start.
fn run(name: &str, skin: String) -> PathBuf {
    let text = r#"(duration: 0.01,
        bodies: {"b": (mesh: Box(size: (1, 1, 1), cells: (2, 2, 2)), material: "m", skin: (file: "ball.obj"))},
        materials: {"m": (density: 1000, neo_hookean: Young(young: 3e4, poisson: 0.3))})"#;
    let files = BTreeMap::from([("ball.obj".to_string(), skin.into_bytes())]);
    let scene = SceneFile::from_memory("scene.ron", text, files, &[]).unwrap();
    let options = Options { backend: BackendChoice::Cpu, threads: 1, ..Options::default() };
    let mut simulation = Simulation::new(&scene, &options).unwrap();
    let mut into = Folder::create(&folder(name)).unwrap();
    simulation.write_into(&mut into).unwrap();
    simulation.observe().unwrap();
    folder(name)
}

/// Where texture coordinates differ at a place a skin has several points there, and looks as one without them.
#[test]
fn a_skin_with_an_atlas_is_as_smooth_as_one_without() {
    let [with, without] = [true, false].map(|atlas| {
        let name = if atlas { "skin_with_atlas" } else { "skin_without_atlas" };
        seen_with(&run(name, ball(atlas)), plain(), None, Tools::default())
    });
    let of_ball = with.count(|[r, g, b]| r.max(g).max(b) - r.min(g).min(b) > 25);
    assert!(of_ball > 5000, "{of_ball}");
    assert!(with.bytes == without.bytes, "they look different");
}

/// What is seen at rest of a body with a skin is that, and not the cube around it: so it fills the picture as without.
#[test]
fn the_ghost_of_a_body_with_a_skin_is_the_skin() {
    let folder = run("skin_ghost", ball(false));
    let [with, without] = [true, false].map(|ghost| {
        let seen = seen_with(&folder, sinew::scene::schema::Picture { ghost, ..plain() }, None, Tools::default());
        seen.count(|[r, g, b]| r.max(g).max(b) - r.min(g).min(b) > 25)
    });
    assert!(without > 5000 && 10 * with > 9 * without, "{with} pixels of the ball, {without} without a ghost");
}

#[test]
fn elements_with_large_numbers_carry_their_own_points() {
    let path = folder("skin_large_numbers");
    let into = Folder::create(&path).unwrap();
    let array = |name, components, values| Array { name, components, values };
    let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::ONE];
    let cells = Cells::of(CellKind::Tet4, &[[0, 1, 2, 3], [1, 4, 2, 3]]).unwrap();
    // as f32 both are the first
    let [one, other] = [1_i64 << 24, (1 << 24) + 1];
    let numbers = [one, other];
    let cell_arrays = vec![array("body", 1, Values::U32(&[0, 0])), array("element", 1, Values::I64(&numbers))];
    let frame = Frame { time: 0.0, points: &points, cells: &cells, point_arrays: Vec::new(), cell_arrays };
    Series::create(&into).unwrap().write(&frame).unwrap();
    let (vectors, weights, carriers) = ([0.0_f32; 9], [0.1_f32; 3 * MOST_NODES], [one, other, other]);
    let point_arrays = vec![
        array("displacement", 3, Values::F32(&vectors)),
        array("normal", 3, Values::F32(&vectors)),
        array("body", 1, Values::U32(&[0, 0, 0])),
        array("element", 1, Values::I64(&carriers)),
        array("weights", MOST_NODES, Values::F32(&weights)),
    ];
    let cells = Cells::triangles(&[[0, 1, 2]]);
    let frame = Frame { time: 0.0, points: &points[..3], cells: &cells, point_arrays, cell_arrays: Vec::new() };
    Series::named(&path, "skin_b").unwrap().write(&frame).unwrap();
    let frame = FrameFile::open(&path.join("fields_000000.vtu")).unwrap();
    let skins = Skins::open(&path).of_frame(&frame).unwrap();
    let found: Vec<usize> = skins[0].carriers.iter().map(|(cell, _)| *cell).collect();
    assert_eq!(found, [0, 1, 1]);
}
