#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
use super::FIELDS;
use crate::scene::SceneFile;
use crate::scene::schema::texts;
use std::collections::BTreeMap;

/// A field of the schema that names a file says so in its docs.
#[test]
fn all_fields_that_name_files_are_known() {
    let told = |text: &str| {
        let lines: Vec<&str> = text.lines().map(|line| line.trim().trim_start_matches("///").trim()).collect();
        lines.join(" ").matches("its path relative to the scene file").count()
    };
    assert_eq!(texts().map(told).sum::<usize>(), FIELDS.len());
}

const WHOLE: &str = r#"(
    duration: 1,
    parts: {"p": (scene: "p/part.ron")},
    bodies: {"b": (mesh: File(path: "b.msh"), rest_shape: Some("r.msh"), material: "m",
        skin: (file: "s.gltf", image: "s.png"))},
    materials: {"m": (density: 1, law: (file: "l.wgsl"))},
    systems: {"pull": (file: "pull.wgsl")},
    tools: {"t": (mesh: (path: "t.stl"))},
)"#;
const PART: &str = r#"(tools: {"t": (mesh: (path: "t.stl"))})"#;
const GLTF: &str = r#"{"asset": {"version": "2.0"}, "buffers": [{"uri": "s%200.bin", "byteLength": 4}]}"#;

#[test]
fn files_are_listed_with_those_that_they_name() {
    let files = [("p/part.ron", PART), ("s.gltf", GLTF), ("s 0.bin", "1234")];
    let files: BTreeMap<String, Vec<u8>> = files.map(|(name, text)| (name.to_string(), text.into())).into();
    let scene = SceneFile::from_memory("whole.ron", WHOLE, files, &[]).unwrap();
    let found = scene.named_files();
    let told: Vec<String> = found.iter().map(|file| format!("{} {}", file.field, file.name)).collect();
    let expected = [
        "bodies.b.mesh.path b.msh",
        "bodies.b.rest_shape r.msh",
        "bodies.b.skin.file s.gltf",
        "bodies.b.skin.image s.png",
        "materials.m.law.file l.wgsl",
        "systems.pull.file pull.wgsl",
        "tools.t.mesh.path t.stl",
        "tools.\"p.t\".mesh.path p/t.stl",
    ];
    assert_eq!(told, expected);
    let beside: Vec<&String> = found.iter().flat_map(|file| &file.beside).collect();
    assert_eq!(beside, ["s 0.bin"]);
}
