//! `sinew render`.

use crate::sinew::Place;
use std::fs;

#[test]
fn a_scene_is_run_only_when_its_output_is_missing_or_older() {
    let place = Place::new();
    let first = place.sinew(&["render", "block.ron"]);
    first.wants(0, &["running block.ron first: out/block has no output of it"]);
    assert!(first.said.contains("von_mises"), "the scene says what to draw: {}", first.said);
    let picture = fs::read(place.path("out/block/picture.png")).unwrap();
    assert!(picture.starts_with(b"\x89PNG"));
    assert_eq!(picture[16..24], [0, 0, 1, 64, 0, 0, 0, 240], "the scene says how large");
    assert!(fs::read(place.path("out/block/animation.gif")).unwrap().starts_with(b"GIF89a"));

    place.sinew(&["render", "block.ron", "--no-animation"]).wants(0, &["drawing out/block, which is newer"]);
    let later = std::time::SystemTime::now() + std::time::Duration::from_secs(10);
    fs::File::options().write(true).open(place.path("block.ron")).unwrap().set_modified(later).unwrap();
    place.sinew(&["render", "block.ron", "--no-animation"]).wants(0, &["running block.ron first: it has changed"]);
}

#[test]
fn an_output_folder_is_drawn_as_its_scene_wants_or_as_told() {
    let place = Place::new();
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
    let place = Place::new();
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
