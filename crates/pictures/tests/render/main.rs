//! Pictures of a series that the crate's own writers made. They stay in the target folder's `tmp/render`, to be looked
//! at.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod skins;
mod tools;
mod words;

use glam::{DQuat, DVec3, Vec3};
use sinew::mesh::{CellKind, Cells};
use sinew::output::{Array, Folder, Frame, Series, Values};
use sinew::scene::schema;
use sinew_pictures::render::{
    Colouring, Finish, Fit, Layer, Lines, Picture, RenderError, RenderOptions, Scale, View, draw, paint,
};
use std::fs::{self, File};
use std::path::{Path, PathBuf};

/// A bar along x, half of it hexahedra and half tetrahedra, that is twisted and bent and loses some elements.
struct Bar {
    points: Vec<DVec3>,
    cells: Cells,
}

const CELLS: [u32; 3] = [24, 6, 8];
const SIZE: DVec3 = DVec3::new(0.4, 0.1, 0.13);

impl Bar {
    fn new() -> Bar {
        let [nx, ny, nz] = CELLS;
        let row = |x: u32, y: u32, z: u32| (x * (ny + 1) + y) * (nz + 1) + z;
        let mut bar = Bar { points: Vec::new(), cells: Cells::default() };
        for (x, y, z) in each([nx + 1, ny + 1, nz + 1]) {
            let counts = DVec3::new(nx.into(), ny.into(), nz.into());
            bar.points.push(DVec3::new(x.into(), y.into(), z.into()) / counts * SIZE);
        }
        for (x, y, z) in each(CELLS) {
            let corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)];
            let c = corners.map(|(dx, dy, dz)| row(x + dx, y + dy, z + dz));
            if x < nx / 2 {
                bar.cells.push(CellKind::Hex8, c).unwrap();
            } else {
                let six = [[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6]];
                six.iter().for_each(|tet| bar.cells.push(CellKind::Tet4, tet.map(|corner: usize| c[corner])).unwrap());
            }
        }
        bar
    }

    fn centroid(&self, corners: &[u32]) -> DVec3 {
        corners.iter().map(|&corner| self.points[corner as usize]).sum::<DVec3>() / corners.len() as f64
    }

    fn cells(&self) -> impl Iterator<Item = DVec3> {
        self.cells.iter().map(|(_, nodes)| self.centroid(nodes))
    }

    /// Displacement at a share of the whole course.
    fn displacement(&self, share: f64) -> Vec<f32> {
        let moved = |point: &DVec3| {
            let along = point.x / SIZE.x;
            let twisted = DQuat::from_rotation_x(1.6 * share * along) * (*point - SIZE / 2.0).with_x(0.0);
            let angle = (1.1 * share).max(1e-6) * along;
            let radius = SIZE.x / (1.1 * share).max(1e-6);
            let axis = DVec3::new(radius * angle.sin(), 0.0, radius * (angle.cos() - 1.0));
            let to = axis + DQuat::from_rotation_y(angle) * twisted + SIZE / 2.0 * DVec3::new(0.0, 1.0, 1.0);
            (to - *point).as_vec3().to_array()
        };
        self.points.iter().flat_map(moved).collect()
    }

    /// Writes a whole run.
    fn run(&self, folder: &Path, frames: usize) {
        let mut series = Series::create(&Folder::create(folder).unwrap()).unwrap();
        for frame in 0..frames {
            let share = frame as f64 / (frames - 1) as f64;
            let displacement = self.displacement(share);
            let along = |cell: &DVec3| (cell.x / SIZE.x, (cell - SIZE / 2.0).with_x(0.0).length() / 0.08);
            let von_mises: Vec<f32> =
                self.cells().map(|cell| (12e3 * share * along(&cell).1 * (1.3 - along(&cell).0)) as f32).collect();
            let pressure: Vec<f32> = self.cells().map(|cell| (4e3 * share * (cell.z / 0.065 - 1.0)) as f32).collect();
            let near = |cell: &DVec3| cell.distance(DVec3::new(0.26, 0.0, 0.08)) < 0.055 * (2.0 * share - 1.0);
            let alive: Vec<u8> = self.cells().map(|cell| u8::from(!near(&cell))).collect();
            let stress: Vec<f32> = (0..alive.len() * 6).map(|row| row as f32).collect();
            let array = |name, components, values| Array { name, components, values };
            let frame = Frame {
                time: 0.02 * share,
                points: &self.points,
                cells: &self.cells,
                point_arrays: vec![array("displacement", 3, Values::F32(&displacement))],
                cell_arrays: vec![
                    array("von_mises", 1, Values::F32(&von_mises)),
                    array("pressure", 1, Values::F32(&pressure)),
                    array("stress", 6, Values::F32(&stress)),
                    array("alive", 1, Values::U8(&alive)),
                ],
            };
            series.write(&frame).unwrap();
        }
    }
}

fn each(counts: [u32; 3]) -> impl Iterator<Item = (u32, u32, u32)> {
    (0..counts[0]).flat_map(move |x| (0..counts[1]).flat_map(move |y| (0..counts[2]).map(move |z| (x, y, z))))
}

/// A fresh folder with a run in it.
fn example(name: &str, frames: usize) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("render").join(name);
    Bar::new().run(&folder, frames);
    folder
}

fn options(out: PathBuf) -> RenderOptions {
    RenderOptions { field: Some("von_mises".into()), ..RenderOptions::new(schema::Picture::default(), out) }
}

/// Width and rows of RGB bytes.
fn read_png(path: &Path) -> (usize, Vec<u8>) {
    let mut reader = png::Decoder::new(std::io::BufReader::new(File::open(path).unwrap())).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    (info.width as usize, bytes)
}

#[test]
fn a_series_becomes_a_picture() {
    let folder = example("picture", 5);
    let options = options(folder.join("last.png"));
    let drawn = draw(&folder, &options).unwrap();
    assert_eq!((drawn.frames, drawn.time), (1, 0.02));
    assert!(drawn.range.0 == 0.0 && drawn.range.1 > 8e3 && drawn.range.1 < 16e3, "{:?}", drawn.range);
    let (width, bytes) = read_png(&options.out);
    assert_eq!((width, bytes.len()), (960, 960 * 720 * 3));
    // the corner is background, and a good part of the stage is not
    assert!(bytes[0] > 240 && bytes[1] > 240 && bytes[2] > 240);
    let coloured = bytes.as_chunks::<3>().0.iter().filter(|[r, g, b]| r.max(g).max(b) - r.min(g).min(b) > 30).count();
    assert!(coloured > 960 * 720 / 6, "{coloured}");
    let first = fs::read(&options.out).unwrap();
    draw(&folder, &options).unwrap();
    assert!(first == fs::read(&options.out).unwrap(), "the same input, other bytes");
}

#[test]
#[ignore = "long"]
fn other_fields_sizes_and_directions_can_be_drawn() {
    let folder = example("others", 3);
    for (field, size, from, edges) in [
        ("displacement", (1440, 1080), DVec3::new(1.0, -2.0, 0.8), true),
        ("pressure", (960, 720), DVec3::new(-1.0, -1.5, 1.2), true),
        ("displacement.z", (320, 240), DVec3::NEG_Y, false),
        ("stress.xy", (640, 640), DVec3::Z, true),
        ("alive", (400, 900), DVec3::X, true),
    ] {
        let out = folder.join(format!("{field}.png"));
        let picture = schema::Picture { size, from, edges, ..schema::Picture::default() };
        let field = Some(field.to_string());
        draw(&folder, &RenderOptions { picture, field, ..options(out.clone()) }).unwrap();
        assert_eq!(read_png(&out).0, size.0 as usize);
    }
}

#[test]
#[ignore = "long"]
fn an_animation_has_all_frames_and_loops() {
    let folder = example("animation", 21);
    let picture = schema::Picture { size: (480, 360), ..schema::Picture::default() };
    let small = RenderOptions { animate: true, picture, ..options(folder.join("all.gif")) };
    assert_eq!(draw(&folder, &small).unwrap().frames, 21);
    let first = fs::read(&small.out).unwrap();
    draw(&folder, &small).unwrap();
    assert!(first == fs::read(&small.out).unwrap(), "the same input, other bytes");
    let count = |path: &Path| {
        let mut decoder = gif::DecodeOptions::new();
        decoder.set_color_output(gif::ColorOutput::RGBA);
        let mut decoder = decoder.read_info(File::open(path).unwrap()).unwrap();
        assert_eq!((decoder.width(), decoder.height()), (480, 360));
        let (mut frames, mut hundredths) = (0, 0);
        while let Some(frame) = decoder.read_next_frame().unwrap() {
            frames += 1;
            hundredths += u32::from(frame.delay);
        }
        assert!((200..=600).contains(&hundredths), "{hundredths}");
        assert!(matches!(decoder.repeat(), gif::Repeat::Infinite));
        frames
    };
    assert_eq!(count(&small.out), 21);
    let half = RenderOptions { at: Some(0.0101), out: folder.join("half.gif"), ..small };
    assert_eq!(draw(&folder, &half).unwrap().time, 0.01);
    assert_eq!(count(&half.out), 11);
}

const LEFT_TOP: glam::Vec2 = glam::Vec2::splat(100.0);
const RIGHT_BOTTOM: glam::Vec2 = glam::Vec2::splat(300.0);

/// The corners of a square across the line of sight.
fn square(y: f32) -> [Vec3; 4] {
    [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, z)| Vec3::new(x, y, z))
}

/// Squares seen from -y, each with one value all over.
fn squares(places: &[f32], values: &[f32], scale: Scale, edges: bool) -> sinew_pictures::render::Image {
    let lines = if edges { Lines::All } else { Lines::None };
    let finish = Finish::Plain;
    painted(&places.iter().zip(values).map(|(y, value)| (*y, *value, finish)).collect::<Vec<_>>(), scale, lines)
}

/// Squares seen from -y: where they are along y, their value and what they are made of.
fn painted(squares: &[(f32, f32, Finish)], scale: Scale, lines: Lines<'_>) -> sinew_pictures::render::Image {
    let corners: Vec<[Vec3; 4]> = squares.iter().map(|(y, ..)| square(*y)).collect();
    let values: Vec<[f32; 1]> = squares.iter().map(|(_, value, _)| [*value]).collect();
    let layers = (0..squares.len()).map(|row| Layer {
        vertices: &corners[row],
        faces: &[[0, 1, 2, 3]],
        values: Colouring::Faces(&values[row]),
        finish: squares[row].2,
        lines,
        normals: &[],
        flat: None,
        cut: true,
    });
    let (layers, keys) = (layers.collect(), &[]);
    let (plane, ground, panel) = (None, None, false);
    let (quantity, unit, caption, seen) = ("value", "", "", scale.range);
    let picture = Picture { layers, scale, seen, quantity, unit, caption, keys, plane, ground, panel };
    let mut fit = Fit::new(&View::upright(Vec3::NEG_Y), LEFT_TOP, RIGHT_BOTTOM);
    square(0.0).into_iter().for_each(|vertex| fit.see(vertex));
    paint(&picture, &fit.camera().unwrap(), (400, 400)).unwrap()
}

const UNIT: Scale = Scale { range: (0.0, 1.0), centre: None };

#[test]
fn a_known_value_has_its_colour_where_it_is_expected() {
    let image = squares(&[0.0], &[0.5], UNIT, false);
    let [r, g, b] = image.at(200, 200);
    // the map has (33.5, 156.5, 136) in its middle; light makes that darker or brighter, of the same hue
    let shares = [f32::from(r) / 33.5, f32::from(g) / 156.5, f32::from(b) / 136.0];
    assert!(shares.iter().all(|share| (share - shares[1]).abs() < 0.04 && *share > 0.7 && *share < 1.15), "{shares:?}");
    assert!(image.at(110, 110)[1] < 175 && image.at(290, 290)[1] < 175);
    for (x, y) in [(95, 200), (305, 200), (200, 95), (200, 305)] {
        assert!(image.at(x, y)[0] > 200, "the square reaches beyond its place at {x}, {y}");
    }
    assert_eq!(squares(&[0.0], &[f32::NAN], UNIT, false).at(200, 200)[1] / 32, 0);
}

#[test]
fn the_nearer_face_hides_the_farther() {
    for (places, values) in [([0.0, 0.1], [1.0, 0.0]), ([0.1, 0.0], [0.0, 1.0])] {
        let [r, g, b] = squares(&places, &values, UNIT, false).at(200, 200);
        assert!(r > 150 && g > 150 && b < 90, "{:?} is not the yellow of the nearer one", (r, g, b));
    }
}

#[test]
fn element_edges_are_drawn_when_asked_for() {
    let (with, without) = (squares(&[0.0], &[0.7], UNIT, true), squares(&[0.0], &[0.7], UNIT, false));
    assert_eq!(with.at(200, 200), without.at(200, 200));
    // the outline darkens these pixels in both, the edge darkens them once more
    let differ = (102..298).filter(|&x| (100..104).any(|y| with.at(x, y)[1] + 5 < without.at(x, y)[1])).count();
    assert!(differ > 190, "{differ}");
}

#[test]
fn what_is_seen_through_blends_by_its_opacity() {
    // light mixes linearly: what a screen shows of it does not
    let light = |pixel: [u8; 3]| pixel.map(|c| (f64::from(c) / 255.0).powf(2.2));
    let seen = |squares: &[(f32, f32, Finish)]| light(painted(squares, UNIT, Lines::None).at(200, 200));
    let (near, far) = (seen(&[(-0.1, 0.2, Finish::Plain)]), seen(&[(0.1, 0.9, Finish::Plain)]));
    for opacity in [0.25, 0.6] {
        for order in [[0, 1], [1, 0]] {
            let squares = [(-0.1, 0.2, Finish::Sheet(opacity)), (0.1, 0.9, Finish::Plain)];
            let both = seen(&order.map(|row: usize| squares[row]));
            for channel in 0..3 {
                let blend = far[channel] + (near[channel] - far[channel]) * f64::from(opacity);
                assert!((both[channel] - blend).abs() < 0.02, "{opacity}: {both:?}, {near:?} before {far:?}");
            }
        }
    }
    // sheets are put in order of their distance, whatever order they come in
    let sheets = [(-0.2, 0.0, Finish::Sheet(0.5)), (0.0, 1.0, Finish::Sheet(0.5)), (0.2, 0.5, Finish::Sheet(0.5))];
    let once = seen(&sheets);
    for order in [[2, 0, 1], [1, 2, 0]] {
        assert_eq!(seen(&order.map(|row: usize| sheets[row])), once);
    }
    // and what is solid hides them
    assert_eq!(
        seen(&[(0.1, 0.2, Finish::Sheet(0.5)), (-0.1, 0.9, Finish::Plain)]),
        seen(&[(-0.1, 0.9, Finish::Plain)])
    );
}

#[test]
fn pictures_do_not_depend_on_the_number_of_threads() {
    let folder = example("threads", 2);
    let pictures = [1, 3].map(|threads| {
        let options = options(folder.join(format!("{threads}.png")));
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| draw(&folder, &options)).unwrap();
        fs::read(&options.out).unwrap()
    });
    assert!(pictures[0] == pictures[1]);
}

#[test]
fn colours_mean_the_same_in_all_frames() {
    let folder = example("same", 3);
    let at = |time: f64| {
        let options = RenderOptions { at: Some(time), ..options(folder.join(format!("{time}.png"))) };
        let drawn = draw(&folder, &options).unwrap();
        (drawn.time, drawn.range)
    };
    let (first, last) = (at(-1.0), at(9.0));
    assert_eq!((first.0, last.0), (0.0, 0.02));
    assert_eq!(first.1, last.1);
}

#[test]
#[ignore = "long"]
fn a_run_that_broke_can_still_be_drawn() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("render/broken");
    let bar = Bar::new();
    let mut series = Series::create(&Folder::create(&folder).unwrap()).unwrap();
    for (time, bad) in [(0.0, 0), (1.0, 40), (2.0, usize::MAX)] {
        let mut displacement = bar.displacement(0.5);
        displacement.iter_mut().take(bad).for_each(|value| *value = f32::NAN);
        displacement.iter_mut().skip(90).take(bad.min(30)).for_each(|value| *value = f32::INFINITY);
        let point_arrays = vec![Array { name: "displacement", components: 3, values: Values::F32(&displacement) }];
        let (points, cells) = (&bar.points, &bar.cells);
        series.write(&Frame { time, points, cells, point_arrays, cell_arrays: vec![] }).unwrap();
        let out = folder.join(format!("{time}.png"));
        let drawn = draw(&folder, &RenderOptions { field: Some("displacement".into()), ..options(out) }).unwrap();
        assert!(drawn.range.1 < 1.0, "{:?}", drawn.range);
    }
    let bodies = fs::read_to_string(folder.join("fields.pvd")).unwrap();
    let only_broken: String =
        bodies.lines().filter(|line| !line.contains("00.vtu") && !line.contains("01.vtu")).collect();
    fs::write(folder.join("fields.pvd"), only_broken).unwrap();
    let refused =
        draw(&folder, &RenderOptions { field: Some("displacement".into()), ..options(folder.join("no.png")) });
    assert!(matches!(refused, Err(RenderError::Nothing { .. })), "{refused:?}");
}

#[test]
#[ignore = "long"]
fn what_cannot_be_drawn_is_said() {
    let folder = example("wrong", 2);
    let good = options(folder.join("none.png"));
    let text = |options: &RenderOptions| draw(&folder, options).unwrap_err().to_string();
    let said = text(&RenderOptions { field: Some("strain".into()), ..good.clone() });
    assert!(
        said.starts_with("no field \"strain\" in ") && said.contains("; there are: displacement, displacement.x,"),
        "{said}"
    );
    assert!(
        said.ends_with("von_mises, pressure, stress.xx, stress.yy, stress.zz, stress.xy, stress.yz, stress.xz, alive")
    );
    assert!(text(&RenderOptions { field: Some("stress".into()), ..good.clone() }).starts_with("no field \"stress\""));
    let how = schema::Picture::default;
    let told = |picture: schema::Picture| text(&RenderOptions { picture, ..good.clone() });
    assert!(
        told(schema::Picture { from: DVec3::ZERO, ..how() }).contains("`from` is [0, 0, 0], which is no direction")
    );
    assert!(told(schema::Picture { up: DVec3::NAN, ..how() }).contains("`up`"));
    assert!(told(schema::Picture { size: (960, 4), ..how() }).contains("960 by 4 pixels; allowed are 320 by 240 to"));
    assert!(told(schema::Picture { range: Some((1.0, 1.0)), ..how() }).contains("`range` is from 1 to 1"));
    assert!(told(schema::Picture { range: Some((0.0, f64::NAN)), ..how() }).contains("`range`"));
    assert!(told(schema::Picture { zoom: f64::NAN, ..how() }).contains("`zoom` is NaN; allowed are 0.01 to 1000"));
    assert!(told(schema::Picture { look_at: Some(DVec3::INFINITY), ..how() }).contains("`look_at`"));
    let cut = |normal| Some(schema::Cut { point: DVec3::ZERO, normal });
    assert!(told(schema::Picture { cut: cut(DVec3::ZERO), ..how() }).contains("`cut.normal`"));
    let opacity =
        |opacity, body: Option<&str>| vec![schema::Opacity { body: body.map(String::from), material: None, opacity }];
    assert!(told(schema::Picture { opacity: opacity(1.5, None), ..how() }).contains("not between 0 and 1"));
    assert!(told(schema::Picture { opacity: opacity(0.5, Some("skin")), ..how() }).contains("summary.json"));
    assert!(matches!(draw(&folder.join("nowhere"), &good), Err(RenderError::NoSeries { .. })));
    let frame = folder.join("fields_000001.vtu");
    let whole = fs::read(&frame).unwrap();
    // wherever a frame breaks off or is damaged, that is an error or another picture, never a panic
    for cut in [0, 10, 900, 2000, whole.len() / 2, whole.len() - 60] {
        fs::write(&frame, &whole[..cut]).unwrap();
        assert!(
            draw(&folder, &RenderOptions { picture: schema::Picture { size: (320, 240), ..how() }, ..good.clone() })
                .is_err()
                || cut > whole.len() - 100,
            "{cut}"
        );
    }
    for at in (0..whole.len()).step_by(whole.len() / 40) {
        let mut damaged = whole.clone();
        damaged[at] ^= 0x5a;
        fs::write(&frame, &damaged).unwrap();
        let _ =
            draw(&folder, &RenderOptions { picture: schema::Picture { size: (320, 240), ..how() }, ..good.clone() });
    }
    assert!(draw(&folder, &RenderOptions { out: folder.join("no/such/folder.png"), ..good }).is_err());
}
