//! The words of a scene's `picture`, each seen in what is drawn.

use crate::read_png;
use glam::{DVec3, Vec2, Vec3};
use sinew::mesh::{CellKind, Cells};
use sinew::output::{Array, Folder, Frame, Series, Values};
use sinew::scene::schema::{Colours, Cut, Opacity, Picture};
use sinew_pictures::render::{Camera, Fit, RenderOptions, Tools, View, draw, stage};
use std::path::{Path, PathBuf};

const SIZE: (usize, usize) = (480, 360);

/// A run of one frame or two: a box of hexahedra (or six tetrahedra each), of which the second frame lacks some.
pub struct Run {
    pub cells: [u32; 3],
    pub tets: bool,
    /// Of all nodes (m).
    pub displacement: Vec3,
    /// What gives the colour, by where an element is.
    pub value: fn(DVec3) -> f32,
    /// Which elements are of the material `core`.
    pub core: fn(DVec3) -> bool,
    pub removed: Option<Removed>,
}

/// Which elements go in a second frame, and whether the file keeps them.
pub type Removed = (fn(DVec3) -> bool, bool);

pub const BOX: Run =
    Run { cells: [5; 3], tets: false, displacement: Vec3::ZERO, value: |_| 1.0, core: |_| false, removed: None };

impl Run {
    /// Elements are unit cubes.
    pub fn write(&self, name: &str) -> PathBuf {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("render").join(name);
        let [nx, ny, nz] = self.cells;
        let row = |x: u32, y: u32, z: u32| (x * (ny + 1) + y) * (nz + 1) + z;
        let points: Vec<DVec3> =
            crate::each([nx + 1, ny + 1, nz + 1]).map(|(x, y, z)| DVec3::new(x.into(), y.into(), z.into())).collect();
        let corner = |x: u32, y: u32, z: u32| {
            let corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)];
            corners.map(|(dx, dy, dz)| row(x + dx, y + dy, z + dz))
        };
        let places: Vec<(u32, u32, u32)> = crate::each(self.cells).collect();
        let middle = |&(x, y, z): &(u32, u32, u32)| DVec3::new(x.into(), y.into(), z.into()) + 0.5;
        let u: Vec<f32> = points.iter().flat_map(|_| self.displacement.to_array()).collect();
        let mut series = Series::create(&Folder::create(&folder).unwrap()).unwrap();
        for frame in 0..=usize::from(self.removed.is_some()) {
            let goes = |at: &(u32, u32, u32)| frame == 1 && self.removed.is_some_and(|(goes, _)| goes(middle(at)));
            let kept = self.removed.is_none_or(|(_, kept)| kept);
            let there: Vec<&(u32, u32, u32)> = places.iter().filter(|at| kept || !goes(at)).collect();
            let six = [[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6]];
            let mut cells = Cells::default();
            for &&(x, y, z) in &there {
                let c = corner(x, y, z);
                match self.tets {
                    true => six.iter().for_each(|tet| cells.push(CellKind::Tet4, tet.map(|n: usize| c[n])).unwrap()),
                    false => cells.push(CellKind::Hex8, c).unwrap(),
                }
            }
            let each = |of: &dyn Fn(&(u32, u32, u32)) -> f32| -> Vec<f32> {
                there.iter().flat_map(|at| vec![of(at); if self.tets { 6 } else { 1 }]).collect()
            };
            let values = each(&|at| (self.value)(middle(at)));
            let alive: Vec<u8> = each(&|at| if goes(at) { 0.0 } else { 1.0 }).into_iter().map(|v| v as u8).collect();
            let material: Vec<u32> =
                each(&|at| u8::from(!(self.core)(middle(at))).into()).into_iter().map(|v| v as u32).collect();
            let body = vec![0_u32; material.len()];
            let array = |name, components, values| Array { name, components, values };
            let mut cell_arrays = vec![
                array("von_mises", 1, Values::F32(&values)),
                array("body", 1, Values::U32(&body)),
                array("material", 1, Values::U32(&material)),
            ];
            if kept {
                cell_arrays.push(array("alive", 1, Values::U8(&alive)));
            }
            let point_arrays = vec![array("displacement", 3, Values::F32(&u))];
            let (time, points, cells) = (frame as f64, &*points, &cells);
            series.write(&Frame { time, points, cells, point_arrays, cell_arrays }).unwrap();
        }
        let names = r#"{"names": {"bodies": ["box"], "materials": ["core", "rest"]}}"#;
        std::fs::write(folder.join("summary.json"), names).unwrap();
        folder
    }
}

/// Without what would change colours from place to place.
pub fn plain() -> Picture {
    let size = (SIZE.0 as u32, SIZE.1 as u32);
    Picture { edges: false, shadow: false, range: Some((0.0, 2.0)), size, ..Picture::default() }
}

pub struct Seen {
    pub bytes: Vec<u8>,
}

fn seen_at(folder: &Path, picture: Picture, at: Option<f64>) -> Seen {
    seen_with(folder, picture, at, Tools::default())
}

pub fn seen_with(folder: &Path, picture: Picture, at: Option<f64>, tools: Tools) -> Seen {
    let out = folder.join(format!("{}.png", std::thread::current().name().unwrap_or("x").replace("::", "_")));
    let options = RenderOptions { field: Some("von_mises".into()), at, tools, ..RenderOptions::new(picture, out) };
    draw(folder, &options).unwrap();
    Seen { bytes: read_png(&options.out).1 }
}

fn seen(folder: &Path, picture: Picture) -> Seen {
    seen_at(folder, picture, None)
}

impl Seen {
    pub fn at(&self, x: usize, y: usize) -> [u8; 3] {
        let at = 3 * (y * SIZE.0 + x);
        [self.bytes[at], self.bytes[at + 1], self.bytes[at + 2]]
    }

    /// Pixels above the legend that are like this.
    pub fn count(&self, like: impl Fn([u8; 3]) -> bool) -> usize {
        self.places(like).len()
    }

    pub fn places(&self, like: impl Fn([u8; 3]) -> bool) -> Vec<(usize, usize)> {
        let bottom = stage(SIZE).1.y as usize;
        let all = (0..bottom).flat_map(|y| (0..SIZE.0).map(move |x| (x, y)));
        all.filter(|&(x, y)| like(self.at(x, y))).collect()
    }
}

/// Not the background, which is nearly grey.
fn coloured([r, g, b]: [u8; 3]) -> bool {
    r.max(g).max(b) - r.min(g).min(b) > 25
}

/// The camera of a picture that sees a box of this size from its origin on.
fn camera(picture: &Picture, size: Vec3) -> Camera {
    let (left_top, right_bottom) = stage(SIZE);
    let mut fit = Fit::new(&View::from(picture), left_top, right_bottom);
    (0..8).for_each(|row| fit.see(size * Vec3::new((row & 1) as f32, (row >> 1 & 1) as f32, (row >> 2) as f32)));
    fit.camera().unwrap()
}

#[test]
fn a_cut_is_closed_and_has_the_area_of_its_polygon() {
    for tets in [false, true] {
        let folder = Run { tets, ..BOX }.write(&format!("cut_{tets}"));
        for (normal, point, polygon) in [
            // between nodes, and through them
            (DVec3::X, 2.3, vec![(2.3, 0.0, 0.0), (2.3, 5.0, 0.0), (2.3, 5.0, 5.0), (2.3, 0.0, 5.0)]),
            (DVec3::X, 3.0, vec![(3.0, 0.0, 0.0), (3.0, 5.0, 0.0), (3.0, 5.0, 5.0), (3.0, 0.0, 5.0)]),
            (
                DVec3::ONE,
                2.5,
                vec![
                    (5.0, 2.5, 0.0),
                    (2.5, 5.0, 0.0),
                    (0.0, 5.0, 2.5),
                    (0.0, 2.5, 5.0),
                    (2.5, 0.0, 5.0),
                    (5.0, 0.0, 2.5),
                ],
            ),
        ] {
            let cut = Some(Cut { point: DVec3::splat(point), normal: 3.0 * normal });
            let picture = Picture { cut, from: normal, ..plain() };
            let camera = camera(&picture, Vec3::splat(5.0));
            let corners: Vec<Vec2> = polygon.into_iter().map(|at| camera.project(at.into()).truncate()).collect();
            let next = |row: usize| corners[(row + 1) % corners.len()];
            let exact: f32 = (0..corners.len()).map(|row| corners[row].perp_dot(next(row))).sum::<f32>().abs() / 2.0;
            let seen = seen(&folder, picture);
            let middle = corners.iter().sum::<Vec2>() / corners.len() as f32;
            let colour = seen.at(middle.x as usize, middle.y as usize);
            assert!(coloured(colour), "{colour:?}");
            // all of one colour, as the plane is: no hole, nothing before it; its outline is darker
            let like = |c: [u8; 3]| c.iter().zip(colour).all(|(a, b)| a.abs_diff(b) <= 3);
            let round: f32 = (0..corners.len()).map(|row| corners[row].distance(next(row))).sum();
            let found = seen.count(like) as f32;
            let rim = if normal == DVec3::X { 1.5 * round } else { 0.5 * round };
            assert!(
                (found + rim / 2.0 - exact).abs() < 0.01 * exact + rim / 2.0,
                "{tets} {normal}: {found}, not {exact}"
            );
            if normal == DVec3::X {
                let found = seen.count(coloured) as f32;
                assert!((found - exact).abs() < 0.01 * exact, "{tets}: {found} pixels, not {exact}");
            }
        }
    }
}

#[test]
fn values_on_a_cut_are_those_inside() {
    let folder =
        Run { value: |at| if (at - 2.5).abs().max_element() < 1.0 { 2.0 } else { 0.0 }, ..BOX }.write("inside");
    let cut = |point: f64| Some(Cut { point: DVec3::splat(point), normal: DVec3::X });
    let how = |point| Picture { cut: cut(point), from: DVec3::X, colours: Colours::Elements, ..plain() };
    let yellow = |[r, g, b]: [u8; 3]| r > 150 && g > 150 && b < 90;
    let (outside, inside) = (seen(&folder, how(0.5)).count(yellow), seen(&folder, how(2.5)));
    let share = inside.count(yellow) as f32 / inside.count(coloured) as f32;
    assert!(outside == 0 && (share - 0.04).abs() < 0.01, "{outside}, {share}: one element of 25");
}

#[test]
fn the_ghost_is_the_shape_at_rest_and_can_be_seen_through() {
    let folder = Run { displacement: Vec3::new(9.0, 0.0, 0.0), ..BOX }.write("ghost");
    let how = Picture { from: DVec3::NEG_Y, ghost: true, ..plain() };
    let with = seen(&folder, how.clone());
    // both boxes side by side: at rest at the left
    let (left, right) = (with.at(SIZE.0 / 5, SIZE.1 / 2 - 30), with.at(4 * SIZE.0 / 5, SIZE.1 / 2 - 30));
    let behind = with.at(SIZE.0 / 2, SIZE.1 / 2 - 30);
    assert!(coloured(right) && !coloured(left), "{left:?} {right:?}");
    let darker = behind[0].abs_diff(left[0]);
    assert!(darker > 4 && darker < 80, "{left:?} before {behind:?}");
    let lines = |seen: &Seen| seen.places(|c| c[0] < 190 && !coloured(c)).iter().filter(|at| at.0 < SIZE.0 / 2).count();
    assert!(lines(&with) > 100, "no outline");
    // only what is seen has to fit: without it the box fills the picture
    let without = seen(&folder, Picture { ghost: false, ..how });
    assert!(without.count(coloured) > 2 * with.count(coloured));
}

#[test]
fn a_fixed_range_says_which_value_has_which_colour() {
    let folder = BOX.write("range");
    let colour =
        |range| seen(&folder, Picture { range, from: DVec3::NEG_Y, ..plain() }).at(SIZE.0 / 2, SIZE.1 / 2 - 30);
    let (high, low) = (colour(Some((0.0, 1.0))), colour(Some((1.0, 9.0))));
    assert!(high[0] > 180 && high[1] > 180 && high[2] < 90, "{high:?}");
    assert!(low[1] < 80 && low[2] > 80, "{low:?}");
    let options =
        RenderOptions { field: Some("von_mises".into()), ..RenderOptions::new(plain(), folder.join("range.png")) };
    assert_eq!(draw(&folder, &options).unwrap().range, (0.0, 2.0));
}

/// The yellow of the last colour ends the bar in a line, and in a point if there are values beyond.
#[test]
fn the_bar_has_a_point_where_values_lie_beyond_it() {
    // one element of so many is less than one in two hundred of what is seen
    type Value = fn(DVec3) -> f32;
    let runs: [(&str, Value); 2] = [
        ("beyond", |at| if at.max_element() < 1.0 { 20.0 } else { 0.1 * at.x as f32 }),
        ("within", |at| 0.1 * at.x as f32),
    ];
    let [with, without] = runs.map(|(name, value)| {
        let folder = Run { cells: [12; 3], value, ..BOX }.write(name);
        let how = Picture { range: None, colours: Colours::Elements, ..plain() };
        let options =
            RenderOptions { field: Some("von_mises".into()), ..RenderOptions::new(how, folder.join("bar.png")) };
        let (_, high) = draw(&folder, &options).unwrap().range;
        assert!(high > 1.0 && high < 1.2, "{name}: {high}");
        let (rows, bytes) = (stage(SIZE).1.y as usize..SIZE.1, read_png(&options.out).1);
        let picture = Seen { bytes };
        let is_last = |c: [u8; 3]| c[0].abs_diff(0xfd) < 3 && c[1].abs_diff(0xe7) < 3 && c[2].abs_diff(0x25) < 3;
        rows.flat_map(|y| (0..SIZE.0).map(move |x| (x, y))).filter(|&(x, y)| is_last(picture.at(x, y))).count()
    });
    assert!(without > 5 && with > without + 8, "{with} pixels with values beyond, {without} without");
}

#[test]
fn the_point_looked_at_is_in_the_middle_and_zoom_enlarges() {
    let folder = BOX.write("look_at");
    let area = |zoom| seen(&folder, Picture { zoom, ..plain() }).count(coloured) as f32;
    let ratio = area(0.5) / area(0.25);
    assert!((ratio - 4.0).abs() < 0.15, "{ratio}");
    // one corner in the middle: tissue on one side of it, nothing on the other
    let look_at = Some(DVec3::new(5.0, 0.0, 5.0));
    let seen = seen(&folder, Picture { look_at, zoom: 3.0, from: DVec3::NEG_Y, ..plain() });
    let (left_top, right_bottom) = stage(SIZE);
    let middle = ((left_top + right_bottom) / 2.0).as_ivec2();
    let at = |dx: i32, dy: i32| coloured(seen.at((middle.x + dx) as usize, (middle.y + dy) as usize));
    assert!(at(-5, 5) && !at(5, 5) && !at(-5, -5) && !at(5, -5));
    // nothing of it runs into the legend
    let legend = (SIZE.1 - 10..SIZE.1).flat_map(|y| (0..SIZE.0 / 8).map(move |x| (x, y)));
    assert!(legend.clone().all(|(x, y)| seen.at(x, y) == [247, 248, 250]), "the box reaches into the legend");
}

#[test]
fn what_is_up_turns_the_picture() {
    let folder = Run { cells: [10, 3, 3], ..BOX }.write("up");
    let extent = |up| {
        let places = seen(&folder, Picture { up, from: DVec3::NEG_Y, ..plain() }).places(coloured);
        let span = |of: fn(&(usize, usize)) -> usize| {
            places.iter().map(of).max().unwrap() - places.iter().map(of).min().unwrap()
        };
        span(|at| at.0) as f32 / span(|at| at.1) as f32
    };
    let (lying, standing) = (extent(DVec3::Z), extent(DVec3::X));
    assert!((lying - 10.0 / 3.0).abs() < 0.15 && (standing - 0.3).abs() < 0.02, "{lying} {standing}");
}

#[test]
fn a_material_that_is_seen_through_shows_what_it_holds() {
    let inner = |at: DVec3| (at - 2.5).abs().max_element() < 1.0;
    let value = |at: DVec3| if (at - 2.5).abs().max_element() < 1.0 { 2.0 } else { 0.0 };
    let folder = Run { core: inner, value, ..BOX }.write("opacity");
    let yellow = |[r, g, b]: [u8; 3]| i32::from(r.min(g)) - i32::from(b);
    let middle = |opacity: Vec<Opacity>| {
        let how = Picture { opacity, from: DVec3::NEG_Y, colours: Colours::Elements, ..plain() };
        let seen = seen(&folder, how);
        (yellow(seen.at(SIZE.0 / 2, SIZE.1 / 2 - 30)), seen.count(coloured))
    };
    let rest = |opacity: f64| Opacity { body: None, material: Some("rest".into()), opacity };
    let (closed, thin, gone) = (middle(vec![]), middle(vec![rest(0.2)]), middle(vec![rest(0.0)]));
    assert!(closed.0 < 0 && thin.0 > 20 && gone.0 > thin.0, "{closed:?} {thin:?} {gone:?}");
    // nothing but the core is left, and fills the picture as the whole did
    let share = gone.1 as f32 / closed.1 as f32;
    assert!((share - 1.0).abs() < 0.05, "{share}");
    // the last entry that fits counts
    let body = Opacity { body: Some("box".into()), material: None, opacity: 0.5 };
    assert_eq!(
        middle(vec![body, rest(0.0), Opacity { body: None, material: Some("core".into()), opacity: 1.0 }]),
        gone
    );
}

#[test]
fn surfaces_that_were_bared_have_their_own_tint() {
    let tinted = |[r, g, b]: [u8; 3]| r > g.saturating_add(15) && r > b.saturating_add(15) && b > 60;
    for kept in [false, true] {
        let goes: fn(DVec3) -> bool = |at| at.x > 2.0 && at.y < 2.0 && at.z > 3.0;
        let folder = Run { removed: Some((goes, kept)), ..BOX }.write(&format!("bared_{kept}"));
        let count = |at: f64| seen_at(&folder, plain(), Some(at)).count(tinted);
        let (before, after) = (count(0.0), count(1.0));
        assert!(before == 0 && after > 2000, "{before} {after}, elements stay in the file: {kept}");
        let swatch = |at: f64| {
            let seen = seen_at(&folder, plain(), Some(at));
            let below = stage(SIZE).1.y as usize + 5;
            (below..SIZE.1)
                .flat_map(|y| (SIZE.0 / 2..SIZE.0).map(move |x| (x, y)))
                .filter(|&(x, y)| tinted(seen.at(x, y)))
                .count()
        };
        assert!(swatch(0.0) == 0 && swatch(1.0) > 40, "the legend tells it: {} {}", swatch(0.0), swatch(1.0));
    }
}

#[test]
fn values_of_elements_are_averaged_at_nodes_or_shown_as_they_are() {
    let folder = Run { value: |at| if at.x < 2.5 { 0.0 } else { 2.0 }, ..BOX }.write("colours");
    let between = |colours| {
        let seen = seen(&folder, Picture { colours, from: DVec3::NEG_Y, ..plain() });
        // teal, which lies between violet and yellow
        seen.count(|[r, g, b]| g > r.saturating_add(40) && b > r.saturating_add(30))
    };
    assert_eq!(between(Colours::Elements), 0);
    assert!(between(Colours::Smooth) > 1000);
}

#[test]
fn a_body_casts_a_soft_shadow_on_the_ground_unless_told_not_to() {
    let folder = BOX.write("shadow");
    let how = |shadow| Picture { shadow, zoom: 0.5, ..plain() };
    let (with, without) = (seen(&folder, how(true)), seen(&folder, how(false)));
    let all = with.places(|c| !coloured(c));
    let depth = |&(x, y): &(usize, usize)| i32::from(without.at(x, y)[1]) - i32::from(with.at(x, y)[1]);
    let dark = all.iter().filter(|at| depth(at) > 12).count();
    assert!(dark > 500 && all.iter().all(|at| depth(at) < 90), "{dark}");
    assert_eq!(depth(&(2, 2)), 0);
}

#[test]
fn captions_stand_below_their_frames_and_shapes_swing_through_their_rest() {
    let folder = Run { displacement: Vec3::new(0.0, 0.0, 4.0), ..BOX }.write("swing");
    let out = |name: &str| folder.join(name);
    let how = |name: &str, caption: Option<&str>| RenderOptions {
        field: Some("von_mises".into()),
        captions: caption.map(String::from).into_iter().collect(),
        ..RenderOptions::new(plain(), out(name))
    };
    let bytes = |options: &RenderOptions| {
        draw(&folder, options).unwrap();
        std::fs::read(&options.out).unwrap()
    };
    let named = bytes(&how("named.png", Some("mode 3, 0.28 Hz")));
    assert!(named != bytes(&how("time.png", None)) && named != bytes(&how("other.png", Some("mode 3, 0.29 Hz"))));
    assert_eq!(named, bytes(&how("again.png", Some("mode 3, 0.28 Hz"))));
    let swing = RenderOptions { swing: 4, animate: true, ..how("swing.gif", None) };
    assert_eq!(draw(&folder, &swing).unwrap().frames, 4);
    let mut decoder = gif::DecodeOptions::new();
    decoder.set_color_output(gif::ColorOutput::RGBA);
    let mut decoder = decoder.read_info(std::fs::File::open(&swing.out).unwrap()).unwrap();
    // at rest, up, at rest, down: only what differs is in a frame
    let mut tops = Vec::new();
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        tops.push((frame.top, frame.height));
    }
    assert!(tops.len() == 4 && tops[1].0 < tops[3].0, "{tops:?}");
}
