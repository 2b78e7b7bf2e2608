//! `sinew render`.

use crate::sinew::{SCENE, Workspace};
use sinew::scene::schema::Picture;
use sinew_pictures::render::{RenderOptions, draw};
use std::fs;
use std::io::BufReader;
use std::path::Path;
use std::time::{Duration, SystemTime};

#[test]
#[ignore = "long"]
fn a_scene_is_run_only_when_its_output_is_missing_or_older() {
    let place = Workspace::new();
    let first = place.sinew(&["render", "block.ron"]);
    first.wants(0, &["running block.ron first: out/block has no output of it"]);
    assert!(first.said.contains("von_mises"), "the scene says what to draw: {}", first.said);
    let picture = fs::read(place.path("out/block/picture.png")).unwrap();
    assert!(picture.starts_with(b"\x89PNG"));
    assert_eq!(picture[16..24], [0, 0, 1, 64, 0, 0, 0, 240], "the scene says how large");
    assert!(fs::read(place.path("out/block/animation.gif")).unwrap().starts_with(b"GIF89a"));

    let drawn = "drawing out/block, which is of this scene";
    place.sinew(&["render", "block.ron", "--no-animation"]).wants(0, &[drawn]);
    let text = fs::read_to_string(place.path("block.ron")).unwrap();
    fs::write(place.path("block.ron"), text.replace("size: (320, 240)", "size: (400, 300)")).unwrap();
    place.sinew(&["render", "block.ron", "--no-animation"]).wants(0, &[drawn]);
    assert_eq!(fs::read(place.path("out/block/picture.png")).unwrap()[16..24], [0, 0, 1, 144, 0, 0, 1, 44]);
    fs::write(place.path("block.ron"), text.replace("damping: 5", "damping: 6")).unwrap();
    let again = "running block.ron first: out/block was written of another, or with other values";
    place.sinew(&["render", "block.ron", "--no-animation"]).wants(0, &[again]);
}

/// Any file: that of a law, and one that a file of the scene names.
#[test]
fn a_scene_is_run_again_when_a_file_that_it_names_has_changed() {
    let skin = r#"material: "tissue", skin: (file: "pyramid.gltf", scale: 0.05)) }"#;
    let law = r#"law: (file: "own_law.wgsl", parameters: {"mu": 1e4, "b": 2, "bulk": 1e5})"#;
    let text = SCENE.replace(r#"material: "tissue") }"#, skin).replace("duration: 0.2", "duration: 0.01");
    let place = Workspace::with_scene(&text.replace("neo_hookean: Young(young: 3000, poisson: 0.45)", law));
    place.write_pyramid();
    fs::write(place.path("own_law.wgsl"), include_str!("../../../../examples/own_law.wgsl")).unwrap();
    place.done(&["run", "block.ron", "--backend", "cpu"]);
    let (before, after) = (SystemTime::UNIX_EPOCH, SystemTime::now() + Duration::from_secs(600));
    for file in ["own_law.wgsl", "pyramid.bin"] {
        let change = |at: SystemTime| {
            fs::File::options().append(true).open(place.path(file)).unwrap().set_modified(at).unwrap();
        };
        change(after);
        let why = format!("running block.ron first: {file} has changed since out/block was written");
        place.sinew(&["render", "block.ron", "--no-animation"]).wants(0, &[&why]);
        change(before);
    }
    place.sinew(&["render", "block.ron", "--no-animation"]).wants(0, &["drawing out/block, which is of this scene"]);
}

#[test]
fn values_are_put_into_the_picture_of_a_run_and_into_any_of_a_scene() {
    let place = Workspace::new();
    place.done(&["run", "block.ron", "--backend", "cpu"]);
    let picture = |arguments: &[&str]| {
        place.done(&[&["render", "out/block", "--no-animation"], arguments].concat());
        fs::read(place.path("out/block/picture.png")).unwrap()
    };
    let before = picture(&[]);
    let set = |value: &str| picture(&["--set", value]);
    for value in [
        "picture.zoom=2",
        "picture.range=(0, 9)",
        "picture.ghost=true",
        "picture.cut=(point: (0.05, 0.05, 0.05), normal: (0, -1, 0))",
        "picture.opacity=[(body: \"block\", opacity: 0.4)]",
        "picture.opacity=[(material: \"tissue\", opacity: 0.4)]",
        "picture.up=(1, 0, 0)",
        "picture.look_at=(0.1, 0, 0)",
        "picture.colours=Elements",
        "picture.edges=false",
        "picture.shadow=false",
        "picture.field=Displacement",
    ] {
        assert!(set(value) != before, "{value} changes nothing");
    }
    assert!(picture(&[]) == before);
    let refused = |value: &str, wanted: &[&str]| {
        place.sinew(&["render", "out/block", "--set", value]).wants(2, wanted);
    };
    refused("duration=3", &["only its `picture` can be changed"]);
    refused("picture.zoom=0", &["--set:1:", "`zoom` must be from 0.01 to 1000, found 0"]);
    refused("picture.range=(2, 1)", &["`range` is empty: from 2 to 1"]);
    refused("picture.zom=1", &["unknown field `zom`", "did you mean `zoom`?"]);
    refused(
        "picture.opacity=[(body: \"blok\", opacity: 2)]",
        &["there is no body `blok`", "`block`", "between 0 and 1"],
    );
    let ran = place.sinew(&["render", "block.ron", "--no-animation", "--set", "picture.zoom=3"]);
    ran.wants(0, &["drawing out/block, which is of this scene"]);
    let ran = place.sinew(&["render", "block.ron", "--no-animation", "--set", "duration=0.1"]);
    ran.wants(0, &["running block.ron first: out/block was written of another"]);
    assert!(ran.said.contains("t = 0.1000 s"), "{}", ran.said);
    place.sinew(&["render", "block.ron", "--set", "picture.from=(0, 0, 0)"]).wants(2, &["`from` has no direction"]);
}

#[test]
fn an_output_folder_is_drawn_as_its_scene_wants_or_as_told() {
    let place = Workspace::new();
    place.done(&["run", "block.ron", "--backend", "cpu", "--out", "elsewhere"]);
    let said = place.done(&["render", "elsewhere", "--no-animation"]);
    assert!(said.contains("elsewhere/picture.png") && said.contains("von_mises"), "{said}");
    assert!(!place.path("elsewhere/animation.gif").exists());
    let told =
        ["--field", "displacement.z", "--from", "-1,-2,0.5", "--size", "400x300", "--at", "0.1", "--to", "a.png"];
    let said = place.done(&[&["render", "elsewhere"], &told[..]].concat());
    assert!(said.contains("a.png  displacement.z, t = 0.1"), "{said}");
    assert_eq!(fs::read(place.path("a.png")).unwrap()[16..24], [0, 0, 1, 144, 0, 0, 1, 44]);
}

#[test]
fn what_cannot_be_drawn_is_told() {
    let place = Workspace::new();
    fs::create_dir(place.path("empty")).unwrap();
    place.sinew(&["render", "empty"]).wants(2, &["no output folder of sinew"]);
    place.done(&["run", "block.ron", "--backend", "cpu"]);
    place.sinew(&["render", "out/block", "--field", "stres"]).wants(2, &["no field \"stres\"", "von_mises"]);
    place.sinew(&["render", "out/block", "--to", "a.jpg"]).wants(2, &[".png or .gif"]);
    place.sinew(&["render", "out/block", "--from", "1,2"]).wants(2, &["three numbers"]);
    place.sinew(&["render", "out/block", "--size", "10x10"]).wants(2, &["320 by 240"]);
    place.sinew(&["render", "out/block", "--no-animation", "--to", "x.png"]).wants(2, &["cannot be used with"]);
    place.sinew(&["render", "out/block", "--to", "nowhere/a.png"]).wants(3, &["nowhere/a.png"]);
}

#[test]
#[ignore = "long"]
fn modes_swing_with_their_number_and_frequency_and_relative_amplitudes() {
    let place = Workspace::new();
    place.done(&["modes", "block.ron", "--count", "2"]);
    let mut decoder = gif::DecodeOptions::new();
    decoder.set_color_output(gif::ColorOutput::Indexed);
    let animation = fs::read(place.path("out/block-modes/animation.gif")).unwrap();
    let mut decoder = decoder.read_info(&animation[..]).unwrap();
    let mut frames = 0;
    while decoder.read_next_frame().unwrap().is_some() {
        frames += 1;
    }
    assert_eq!(frames, 2 * 16, "two modes, a period each");
    // what colours is a plain number from 0 to 1: the shape's own length means nothing
    // a picture drawn later has number and frequency below it, too, and no time
    let said = place.done(&["render", "out/block-modes", "--no-animation"]);
    let (_, caption) = said.trim_end().split_once("relative_amplitude, ").expect("the field, and what is below");
    assert!(caption.starts_with("mode 2, ") && caption.ends_with(" Hz") && !said.contains("t = "), "{said}");
    let (drawn, out) = (fs::read(place.path("out/block-modes/picture.png")).unwrap(), place.path("expected.png"));
    let how = Picture { range: Some((0.0, 1.0)), ghost: true, ..Picture::default() };
    for (captions, same) in [(vec![String::new(), caption.into()], true), (vec![], false)] {
        let field = Some("relative_amplitude".into());
        let options = RenderOptions { field, captions, swing: 16, ..RenderOptions::new(how.clone(), out.clone()) };
        draw(&place.path("out/block-modes"), &options).unwrap();
        assert_eq!(fs::read(&out).unwrap() == drawn, same, "with the time: {}", !same);
    }
    let said = place.done(&["render", "out/block-modes", "--at", "1", "--no-animation"]);
    assert!(said.contains("relative_amplitude, mode 1, "), "{said}");
    // and the animation is that of `sinew modes`: its scene wants another size only
    let said = place.done(&["render", "out/block-modes", "--animate", "--size", "320x240"]);
    assert!(said.contains("32 frames until mode 2, "), "{said}");
    assert_eq!(fs::read(place.path("out/block-modes/animation.gif")).unwrap(), animation);
}

/// Pixels with the tint of what was bared: reddish, where values far below the range are violet.
fn tinted(file: &Path) -> usize {
    let mut reader = png::Decoder::new(BufReader::new(fs::File::open(file).unwrap())).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut bytes).unwrap();
    let tint = |[r, g, b]: &&[u8; 3]| *r > g.saturating_add(15) && *r > b.saturating_add(15) && *b > 60;
    bytes.as_chunks::<3>().0.iter().filter(tint).count()
}

#[test]
fn what_was_bared_before_a_run_was_taken_up_has_its_tint_too() {
    let removal = r#"removal: [(on: Sphere(center: (0.1, 0, 0.1), radius: 0.05), when: At(0.02))],
    output: (snapshots_every: 0.1,"#;
    let text = SCENE.replace("output: (", removal).replace("size: (320, 240)", "size: (320, 240), range: (0, 1e9)");
    // hardly moves, so that cameras are nearly the same whatever frames they have to show
    let text = text.replace("-9.81", "-0.1");
    let place = Workspace::with_scene(&text);
    let draw = |folder: &str| {
        place.done(&["render", folder, "--no-animation"]);
        tinted(&place.path(&format!("{folder}/picture.png")))
    };
    place.done(&["run", "block.ron", "--backend", "cpu"]);
    let names = fs::read_dir(place.path("out/block")).unwrap().map(|entry| entry.unwrap().file_name());
    let mut snapshots: Vec<String> = names.map(|name| name.to_string_lossy().into_owned()).collect();
    snapshots.retain(|name| name.starts_with("snapshot_"));
    snapshots.sort();
    let from = format!("out/block/{}", snapshots[0]);
    place.done(&["run", "block.ron", "--backend", "cpu", "--resume", &from]);
    let (whole, resumed) = (draw("out/block"), draw("out/block-resumed"));
    assert!(whole > 300, "{whole} pixels have the tint");
    assert!(resumed.abs_diff(whole) < whole / 10, "{resumed} pixels have the tint, of the whole run {whole}");
    // a run from the start tells of the whole in its first frame, and what an earlier one left is cleared
    let mesh = |folder: &str| place.path(&format!("{folder}/whole_mesh.vtu")).exists();
    assert!(mesh("out/block-resumed") && !mesh("out/block"));
    place.done(&["run", "block.ron", "--backend", "cpu", "--out", "out/block-resumed"]);
    assert!(!mesh("out/block-resumed"));
}
