//! Two renderers check each other: what a graphics device draws of a state against the software renderer's picture.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use glam::{Vec2, Vec3};
use sinew::driver::{Command, Session, State};
use sinew::scene::schema::OutputField;
use sinew::{BackendChoice, Folder, Options, SceneFile, Simulation};
use sinew_pictures::render::{Camera, Image, Picture, View, keep, paint, write_png};
use sinew_view::playback::Playback;
use sinew_view::scene3d::{Look, Scene, Scene3d};
use sinew_view::surfaces::Scenery;
use sinew_view::{Settings, Start, headless};
use std::path::{Path, PathBuf};

const SIZE: (u32, u32) = (480, 360);

/// A device, real or in software; none where there is none and none must be.
fn device() -> Option<(wgpu::Device, wgpu::Queue)> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let found = pollster::block_on(async {
        let adapter = instance.request_adapter(&wgpu::RequestAdapterOptions::default()).await.ok()?;
        adapter.request_device(&wgpu::DeviceDescriptor::default()).await.ok()
    });
    let required = std::env::var_os("SINEW_REQUIRE_GPU").is_some_and(|value| value != "0");
    assert!(found.is_some() || !required, "no graphics device, and SINEW_REQUIRE_GPU is set");
    found
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn state(scene: &str, sets: &[&str], commands: Vec<Command>) -> State {
    let sets: Vec<String> = sets.iter().map(|set| set.to_string()).collect();
    state_of(SceneFile::load(root().join("scenes").join(scene), &sets).unwrap(), commands)
}

fn state_of(scene: SceneFile, commands: Vec<Command>) -> State {
    let options = Options { backend: BackendChoice::Cpu, threads: 1, ..Options::default() };
    let mut session = Session::new(options);
    session.command(Command::Load(Box::new(scene)));
    commands.into_iter().for_each(|command| session.command(command));
    let state = session.state();
    assert_eq!(state.refusal, None);
    state
}

fn cube() -> State {
    let field = Command::Field(Some(OutputField::Displacement));
    state("cube_under_gravity.ron", &["bodies.cube.mesh.cells=(5, 5, 5)"], vec![field, Command::Step(150)])
}

/// Sees all of it from a direction.
fn camera(state: &State, from: Vec3) -> Camera {
    let mut fit = sinew_pictures::render::Fit::new(&View::upright(from), Vec2::splat(30.0), Vec2::new(450.0, 330.0));
    let places = state.bodies.iter().flat_map(|body| &body.positions);
    places.for_each(|place| fit.see(Vec3::from_array(*place)));
    fit.camera().unwrap()
}

fn look(wet: f32, shadows: f32, scenery: &Scenery) -> Look {
    let tissues = scenery.tissues.clone();
    Look { wet, shadows, ground: shadows > 0.0, dark: false, scale: 1.0, tissues }
}

/// By both: the graphics device, the software renderer.
fn both(scene3d: &mut Scene3d, state: &State, settings: &Settings, camera: &Camera) -> [Image; 2] {
    let mut scenery = Scenery::default();
    scenery.follow(state);
    let look = look(0.0, 0.0, &scenery);
    let drawn = scenery.draw(state, settings);
    let surfaces = drawn.surfaces(camera);
    let (scale, plane, bodies) = (drawn.scale, drawn.plane, drawn.bodies);
    let scene = Scene { surfaces: &surfaces, key: drawn.key, scale, plane, bodies, ground: (Vec3::Z, 0.0), look };
    scene3d.draw(&scene, camera);
    let layers = drawn.layers(camera);
    let words = ("displacement", "m", "");
    let (quantity, unit, caption) = words;
    let (seen, keys, ground, panel) = (scale.range, &[], None, false);
    let picture = Picture { layers, scale, seen, quantity, unit, caption, keys, plane, ground, panel };
    let size = (SIZE.0 as usize, SIZE.1 as usize);
    [scene3d.picture().unwrap(), paint(&picture, camera, size).unwrap()]
}

/// Of all colours of pixels above the legend, the mean of how far they are apart (of 255).
fn difference(a: &Image, b: &Image) -> f64 {
    let rows = a.width * (a.height * 3 / 4);
    let parts = a.pixels[..rows].as_flattened().iter().zip(b.pixels[..rows].as_flattened());
    let sum: u64 = parts.map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
    sum as f64 / (3 * rows) as f64
}

/// Inside of surfaces both compute the same light; what the pictures do not share is the software renderer's outline,
/// 2/3 of a pixel wide at either side of a silhouette and darker by 0.55 of light that is 200 of 255 at most, and in
/// colours that are rounded to bytes, 1 of 255. The outline of a cube or a cut one is no longer than 4 times the
/// picture's height: 4 · 360 · 4/3 · 110 of 480 · 360 pixels are 1.2; with rounding 2.2 of 255.
const APART: f64 = 2.2;

#[test]
fn both_renderers_see_the_same_cube_whole_and_cut_open() {
    let Some((device, queue)) = device() else { return };
    let mut scene3d = Scene3d::new(device, queue, SIZE);
    let state = cube();
    let base = Settings { field: Some(OutputField::Displacement), deformation: 3.0, ..Settings::default() };
    let cut = Settings { cut: true, cut_normal: Vec3::new(0.3, -1.0, 0.2), ..base.clone() };
    for (settings, from) in [(&base, Vec3::new(1.0, -2.0, 0.8)), (&cut, Vec3::new(1.0, -2.0, 0.8)), (&base, Vec3::Y)] {
        let seen = camera(&state, from);
        let [device, software] = both(&mut scene3d, &state, settings, &seen);
        let apart = difference(&device, &software);
        println!("{from} cut {}: {apart:.2} of 255", settings.cut);
        assert!(apart < APART, "{apart} of 255");
        // so little is not nothing: from elsewhere, or with other values, it is much more
        let [other, _] = both(&mut scene3d, &state, settings, &camera(&state, Vec3::new(-1.0, -2.0, 0.5)));
        let [plain, _] = both(&mut scene3d, &state, &Settings { field: None, ..settings.clone() }, &seen);
        assert!(difference(&other, &software) > 2.0 * APART && difference(&plain, &software) > 2.0 * APART);
    }
}

#[test]
fn edges_ghosts_shadows_and_wetness_are_seen() {
    let Some((device, queue)) = device() else { return };
    let mut scene3d = Scene3d::new(device, queue, SIZE);
    let state = cube();
    let seen = camera(&state, Vec3::new(1.0, -2.0, 0.8));
    let base = Settings { field: Some(OutputField::Displacement), ..Settings::default() };
    let mut picture = |settings: &Settings, wet: f32, shadows: f32| {
        let mut scenery = Scenery::default();
        scenery.follow(&state);
        let look = look(wet, shadows, &scenery);
        let drawn = scenery.draw(&state, settings);
        let surfaces = drawn.surfaces(&seen);
        let (scale, plane, bodies) = (drawn.scale, drawn.plane, drawn.bodies);
        let ground = (Vec3::Z, bodies.low.z);
        scene3d.draw(&Scene { surfaces: &surfaces, key: drawn.key, scale, plane, bodies, ground, look }, &seen);
        scene3d.picture().unwrap()
    };
    let plain = picture(&base, 0.0, 0.0);
    let wire = picture(&Settings { wireframe: true, ..base.clone() }, 0.0, 0.0);
    let light = |image: &Image| image.pixels.iter().flatten().map(|part| f64::from(*part)).sum::<f64>();
    assert!(light(&wire) < light(&plain) * 0.995, "edges are dark");
    assert!(light(&picture(&base, 0.0, 1.0)) < light(&plain) * 0.99, "shadows are dark");
    let tissue = Settings { field: None, ..base.clone() };
    let (dry, wet) = (picture(&tissue, 0.0, 0.0), picture(&tissue, 1.0, 0.0));
    assert!(light(&wet) > light(&dry) * 1.001, "wet tissue shines");
    let ghost = picture(&Settings { ghost: true, deformation: 4.0, ..base.clone() }, 0.0, 0.0);
    let none = picture(&Settings { deformation: 4.0, ..base.clone() }, 0.0, 0.0);
    assert!(difference(&ghost, &none) > 0.3);
}

/// A square on top of a cube, with places in a picture.
const TOP: &str = "v 0 0 0.1\nv 0.1 0 0.1\nv 0.1 0.1 0.1\nv 0 0.1 0.1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n\
                   f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n";

/// The cube with that as `top.obj`, and with the picture `top.png`.
fn with_top() -> String {
    let skin = "material: \"tissue\", skin: (file: \"top.obj\", image: \"top.png\")";
    include_str!("../../../scenes/cube_under_gravity.ron").replace("material: \"tissue\"", skin)
}

/// A picture whose left half is green and whose right half is blue.
#[test]
fn a_picture_is_seen_on_a_skin_at_its_texture_coordinates() {
    let Some((device, queue)) = device() else { return };
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("top.obj"), TOP).unwrap();
    let mut halves = Image::new(8, 4, [20, 200, 20]);
    (0..4).for_each(|row| halves.pixels[8 * row + 4..8 * row + 8].fill([20, 20, 200]));
    write_png(&folder.path().join("top.png"), &halves).unwrap();
    let cube = with_top();
    let state = state_of(SceneFile::from_text("cube.ron", &cube, folder.path(), &[]).unwrap(), Vec::new());
    let mut scene3d = Scene3d::new(device, queue, SIZE);
    let above = camera(&state, Vec3::Z);
    // where pixels of a colour are, on the average, and how many there are
    let colour = |image: &Image, part: usize| {
        let is = |pixel: &[u8; 3]| (0..3).all(|other| other == part || pixel[part] > pixel[other].saturating_add(30));
        let found = image.pixels.iter().enumerate().filter(|(_, pixel)| is(pixel));
        let (sum, count) = found.fold((0, 0u32), |(sum, count), (place, _)| (sum + place % image.width, count + 1));
        (sum as f64 / f64::from(count.max(1)), count)
    };
    let [seen, _] = both(&mut scene3d, &state, &Settings::default(), &above);
    let ((green, some), (blue, others)) = (colour(&seen, 1), colour(&seen, 2));
    // x goes to the right, seen from above, and the square's halves are alike
    assert!(green < blue && some > 5000 && some.abs_diff(others) < some / 5, "{green} {some} {blue} {others}");
    let [bare, _] = both(&mut scene3d, &state, &Settings { skins: false, ..Settings::default() }, &above);
    assert_eq!((colour(&bare, 1).1, colour(&bare, 2).1), (0, 0));
    // a picture that cannot be read is told, and the skin is drawn without
    std::fs::write(folder.path().join("top.png"), b"\x89PNG\r\n\x1a\nno picture").unwrap();
    let state = state_of(SceneFile::from_text("cube.ron", &cube, folder.path(), &[]).unwrap(), Vec::new());
    let mut scenery = Scenery::default();
    scenery.follow(&state);
    assert!(
        scenery.missing[0].contains("the picture on the skin of `cube` is not drawn: top.png"),
        "{:?}",
        scenery.missing
    );
}

/// What is kept of a run does: the files of its scene are gone.
#[test]
fn a_finished_run_has_normals_and_the_picture_of_a_skin() {
    let (files, out) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    std::fs::write(files.path().join("top.obj"), TOP).unwrap();
    write_png(&files.path().join("top.png"), &Image::new(2, 2, [20, 200, 20])).unwrap();
    let cells = ["bodies.cube.mesh.cells=(2, 2, 2)".to_string()];
    let scene = SceneFile::from_text("cube.ron", &with_top(), files.path(), &cells).unwrap();
    let options = Options { backend: BackendChoice::Cpu, threads: 1, ..Options::default() };
    let mut simulation = Simulation::new(&scene, &options).unwrap();
    let mut folder = Folder::create(out.path()).unwrap();
    std::fs::write(folder.claim("scene.ron").unwrap(), scene.text()).unwrap();
    keep(&scene, &mut folder).unwrap();
    simulation.write_into(&mut folder).unwrap();
    simulation.observe().unwrap();
    drop(files);
    let state = Playback::open(out.path()).unwrap().state();
    let skin = state.bodies[0].skin.as_ref().unwrap();
    assert_eq!((skin.texture.len(), skin.normals.len()), (4, 4));
    assert!(skin.normals.iter().all(|normal| normal.z > 0.999), "{:?}", skin.normals);
    let mut scenery = Scenery::new(false, Some(out.path().into()));
    scenery.follow(&state);
    assert!(scenery.missing.is_empty(), "{:?}", scenery.missing);
}

/// A picture of a state as tissue, by a device that the simulation may have bodies on.
fn tissue(scene3d: &mut Scene3d, state: &State, lends: bool) -> Image {
    let mut scenery = Scenery::new(lends, None);
    scenery.follow(state);
    let look = look(0.5, 0.5, &scenery);
    let settings = Settings { deformation: 2.0, ..Settings::default() };
    let drawn = scenery.draw(state, &settings);
    let camera = camera(state, Vec3::new(1.0, -2.0, 0.8));
    let surfaces = drawn.surfaces(&camera);
    assert_eq!(surfaces.iter().any(|surface| surface.lent.is_some()), lends);
    let (scale, plane, bodies) = (drawn.scale, drawn.plane, drawn.bodies);
    let scene = Scene { surfaces: &surfaces, key: drawn.key, scale, plane, bodies, ground: (Vec3::Z, 0.0), look };
    scene3d.draw(&scene, &camera);
    scene3d.picture().unwrap()
}

#[test]
fn what_is_drawn_from_the_simulations_own_buffer_is_where_its_nodes_are() {
    let Some((device, queue)) = device() else { return };
    drop((device, queue));
    let host = headless::device().unwrap();
    for mesh in ["cells: (5, 5, 5), elements: Hex8", "cells: (4, 4, 4), elements: Tet4"] {
        let text = include_str!("../../../scenes/cube_under_gravity.ron");
        let text = text.replace("cells: (10, 10, 10), elements: Hex8", mesh);
        let scene = SceneFile::from_text("cube.ron", &text, Path::new(""), &[]).unwrap();
        let options = Options { backend: BackendChoice::Gpu, host: Some(host.clone()), ..Options::default() };
        let mut session = Session::new(options);
        session.command(Command::Load(Box::new(scene)));
        session.command(Command::Step(60));
        let before = session.state();
        assert_eq!(before.refusal, None);
        let mut scene3d = Scene3d::new(host.device.clone(), host.queue.clone(), SIZE);
        let copied = tissue(&mut scene3d, &before, false);
        let lent = tissue(&mut scene3d, &before, true);
        let apart = difference(&copied, &lent);
        println!("{mesh}: {apart:.4} of 255");
        // the same numbers but for rounding of f32, which moves an edge by less than a thousandth of a pixel
        assert!(apart < 0.05, "{apart} of 255");
        // it is the simulation's buffer: an old state is drawn where nodes are by now
        session.command(Command::Step(400));
        let later = session.state();
        let moved = tissue(&mut scene3d, &before, true);
        assert!(difference(&moved, &copied) > 0.5, "{}", difference(&moved, &copied));
        drop(later);
    }
}

#[test]
fn a_scene_is_filmed_by_simulated_time_and_a_finished_run_frame_by_frame() {
    if device().is_none() {
        return;
    }
    let place = tempfile::tempdir().unwrap();
    let scene = place.path().join("cube.ron");
    let text = include_str!("../../../scenes/cube_under_gravity.ron");
    let text = text.replace("(10, 10, 10)", "(3, 3, 3)").replace("duration: 1,", "duration: 0.4,");
    std::fs::write(&scene, &text).unwrap();
    let options = Options { backend: BackendChoice::Cpu, threads: 1, ..Options::default() };
    let start = |path: &Path| Start { scene: Some(path.into()), options: options.clone(), ..Start::default() };
    // 0.4 s at half the speed are 0.8 s of 25 pictures each, and the first one
    let film = place.path().join("film");
    let told = headless::film(&start(&scene), &film, (161, 120), 0.5).unwrap();
    assert!(told.ends_with("21 pictures of 160 × 120"), "{told}");
    let pictures = |folder: &Path| -> Vec<Vec<u8>> {
        let mut files: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
        files.sort();
        files.iter().map(|file| std::fs::read(file).unwrap()).collect()
    };
    let taken = pictures(&film);
    assert!(taken.len() == 21 && taken[0] != taken[10], "it moves");
    let out = place.path().join("out");
    let mut folder = Folder::create(&out).unwrap();
    std::fs::write(folder.claim("scene.ron").unwrap(), &text).unwrap();
    let mut simulation = Simulation::new(&SceneFile::load(&scene, &[]).unwrap(), &options).unwrap();
    simulation.write_into(&mut folder).unwrap();
    simulation.observe().unwrap();
    simulation.finish().unwrap();
    let film = place.path().join("film_of_run");
    // a frame each 0.02 s
    let told = headless::film(&start(&out), &film, (160, 120), 1.0).unwrap();
    assert!(told.ends_with("21 pictures of 160 × 120"), "{told}");
    assert!(pictures(&film)[0] != pictures(&film)[20]);
    let stress = Settings { field: Some(OutputField::ContactGap), ..Settings::default() };
    let lacks = headless::film(&Start { settings: stress, ..start(&out) }, &film, (160, 120), 1.0).unwrap_err();
    assert!(lacks.contains("did not write contact_gap"), "{lacks}");
}

#[test]
fn frames_are_timed_with_a_hand_that_pulls() {
    if device().is_none() {
        return;
    }
    let place = tempfile::tempdir().unwrap();
    let scene = place.path().join("cube.ron");
    let text = include_str!("../../../scenes/cube_under_gravity.ron").replace("(10, 10, 10)", "(2, 2, 2)");
    std::fs::write(&scene, text).unwrap();
    let options = Options { backend: BackendChoice::Cpu, threads: 1, ..Options::default() };
    let start = Start { scene: Some(scene), options, ..Start::default() };
    let table = sinew_view::measure::frame_times(&start, 3, (64, 48), 1.0).unwrap();
    println!("{table}");
    assert!(table.contains("8 elements, 27 nodes; steps on CPU") && table.contains("3 frames of 16."), "{table}");
    assert!(["steps", "state", "drawing", "all"].iter().all(|part| table.contains(&format!("\n{part}"))));
    assert!(sinew_view::measure::frame_times(&start, 0, (64, 48), 1.0).is_err());
}

/// Pictures to look at: `SINEW_PICTURES=/tmp cargo test -p sinew-view --test scene3d looked_at -- --ignored`.
#[test]
#[ignore = "writes pictures to be looked at"]
fn pictures_to_be_looked_at() {
    let Some((device, queue)) = device() else { return };
    let folder = PathBuf::from(std::env::var_os("SINEW_PICTURES").unwrap());
    let mut scene3d = Scene3d::new(device, queue, (1000, 700));
    let steps = |count: u64, field| vec![Command::Field(field), Command::Step(count)];
    let stress = Some(OutputField::VonMises);
    let liver = state("grasped_liver.ron", &[], steps(0, None));
    let made = [
        ("cube", cube(), Settings { wireframe: true, field: Some(OutputField::Displacement), ..Settings::default() }),
        ("cube_tissue", cube(), Settings { ghost: true, ..Settings::default() }),
        ("lens", state("lens_pressed.ron", &[], steps(600, None)), Settings::default()),
        (
            "lens_cut",
            state("lens_pressed.ron", &[], steps(600, stress)),
            Settings { field: stress, cut: true, wireframe: true, ..Settings::default() },
        ),
        ("liver", liver, Settings::default()),
        (
            "liver_dark",
            state("grasped_liver.ron", &[], steps(0, stress)),
            Settings { dark: true, field: stress, ..Settings::default() },
        ),
    ];
    for (name, state, settings) in made {
        let mut scenery = Scenery::default();
        scenery.follow(&state);
        let look = Look { dark: settings.dark, ..look(0.8, 0.85, &scenery) };
        let drawn = scenery.draw(&state, &settings);
        let view = View::from(&state.loaded.as_ref().unwrap().scene.scene.picture);
        let mut fit = sinew_pictures::render::Fit::new(&view, Vec2::splat(60.0), Vec2::new(940.0, 640.0));
        state.bodies.iter().flat_map(|body| &body.positions).for_each(|place| fit.see(Vec3::from_array(*place)));
        let camera = fit.camera().unwrap();
        let surfaces = drawn.surfaces(&camera);
        let ground = !drawn.has_table(&surfaces);
        let (scale, plane, bodies) = (drawn.scale, drawn.plane, drawn.bodies);
        let scene = Scene {
            surfaces: &surfaces,
            key: drawn.key,
            scale,
            plane,
            bodies,
            ground: (Vec3::Z, bodies.low.z),
            look: Look { ground, ..look },
        };
        let started = std::time::Instant::now();
        scene3d.draw(&scene, &camera);
        write_png(&folder.join(format!("{name}.png")), &scene3d.picture().unwrap()).unwrap();
        println!("{name}: {:?}, {} tools missing", started.elapsed(), scenery.missing.len());
    }
}
