//! Surfaces with texture coordinates, as glTF and OBJ. Of glTF: where their numbers are, what nodes and modes make of
//! them, and what is refused.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glam::DVec3;
use sinew::mesh::Triangles;

/// Four places, their texture coordinates in bytes, and the corners of two triangles and of a strip that is the same.
fn numbers() -> Vec<u8> {
    let places = [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 2.0, 0.0], [0.0, 2.0, 0.0]];
    let mut bytes: Vec<u8> = places.iter().flatten().flat_map(|number| number.to_le_bytes()).collect();
    bytes.extend([[0, 255, 9, 9], [255, 255, 9, 9], [255, 0, 9, 9], [0, 0, 9, 9]].as_flattened());
    bytes.extend([0_u16, 1, 2, 0, 2, 3, 0, 1, 3, 2].iter().flat_map(|row| row.to_le_bytes()));
    bytes
}

/// A scene of a node with a child, which has the mesh.
fn scene(buffer: &str) -> String {
    let length = numbers().len();
    format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [1]}}],
"nodes": [{{"mesh": 0, "scale": [2, 2, 2]}}, {{"children": [0], "translation": [0, 0, 5]}}],
"meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0, "TEXCOORD_0": 1}}, "indices": 2, "mode": 4}}]}}],
"accessors": [
  {{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 2, 0]}},
  {{"bufferView": 1, "componentType": 5121, "normalized": true, "count": 4, "type": "VEC2"}},
  {{"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"}},
  {{"bufferView": 2, "byteOffset": 12, "componentType": 5123, "count": 4, "type": "SCALAR"}}],
"bufferViews": [{{"buffer": 0, "byteLength": 48}}, {{"buffer": 0, "byteOffset": 48, "byteLength": 16, "byteStride": 4}},
  {{"buffer": 0, "byteOffset": 64, "byteLength": 20}}],
"buffers": [{{{buffer}"byteLength": {length}}}]}}"#
    )
}

fn embedded() -> String {
    let text = STANDARD.encode(numbers());
    scene(&format!(r#""uri": "data:application/octet-stream;base64,{text}", "#))
}

fn binary() -> Vec<u8> {
    let mut text = scene("").into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let numbers = numbers();
    let mut bytes = b"glTF".to_vec();
    let put = |bytes: &mut Vec<u8>, number: usize| bytes.extend((number as u32).to_le_bytes());
    put(&mut bytes, 2);
    put(&mut bytes, 12 + 8 + text.len() + 8 + numbers.len());
    put(&mut bytes, text.len());
    bytes.extend(b"JSON");
    bytes.extend(text);
    put(&mut bytes, numbers.len());
    bytes.extend(b"BIN\0");
    bytes.extend(numbers);
    bytes
}

fn read(text: &str) -> Result<Triangles, String> {
    Triangles::from_bytes("a.gltf", text.as_bytes()).map_err(|error| error.to_string())
}

fn changed(from: &str, to: &str) -> Result<Triangles, String> {
    let text = embedded();
    assert!(text.contains(from), "{from}");
    read(&text.replacen(from, to, 1))
}

/// Where the places are in the scene.
fn square() -> [DVec3; 4] {
    let places = [DVec3::ZERO, 2.0 * DVec3::X, DVec3::new(2.0, 4.0, 0.0), 4.0 * DVec3::Y];
    places.map(|place| place + 5.0 * DVec3::Z)
}

#[test]
fn numbers_are_in_the_file_beside_it_or_in_its_binary_part() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("a b.bin"), numbers()).unwrap();
    let beside = folder.path().join("a.gltf");
    std::fs::write(&beside, scene(r#""uri": "a%20b.bin", "#)).unwrap();
    for read in [
        read(&embedded()).unwrap(),
        Triangles::from_bytes("a.glb", &binary()).unwrap(),
        Triangles::read(&beside).unwrap(),
    ] {
        assert_eq!(read.points, square());
        assert_eq!(read.triangles, [[0, 1, 2], [0, 2, 3]]);
        // upwards, as in OBJ files
        let [a, b, c, d] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        assert_eq!(read.texture, [[a, b, c], [a, c, d]]);
    }
    let outside = scene(r#""uri": "../a.bin", "#);
    std::fs::write(&beside, outside).unwrap();
    let error = Triangles::read(&beside).unwrap_err().to_string();
    assert!(error.contains("../a.bin: the file is not in the same folder"), "{error}");
}

#[test]
fn strips_fans_mirrors_and_meshes_without_corners_or_texture() {
    let strip = changed(r#""indices": 2, "mode": 4"#, r#""indices": 3, "mode": 5"#).unwrap();
    let places = strip.triangles.iter().map(|three| three.map(|row| strip.points[row as usize]));
    let corners = [[0, 1, 3], [1, 2, 3]].map(|three| three.map(|corner| square()[corner]));
    assert!(places.eq(corners), "the second one turned round");
    let fan = changed(r#""indices": 2, "mode": 4"#, r#""mode": 6"#).unwrap();
    assert_eq!(fan.triangles, [[0, 1, 2], [0, 2, 3]]);
    let mirrored = changed(r#""scale": [2, 2, 2]"#, r#""scale": [-2, 2, 2]"#).unwrap();
    let [a, b, c] = mirrored.triangles[0].map(|row| mirrored.points[row as usize]);
    assert!((b - a).cross(c - a).z > 0.0, "still outwards");
    assert!(changed(r#", "TEXCOORD_0": 1"#, "").unwrap().texture.is_empty());
}

/// What there is of one kind with texture coordinates and of one without is a surface with some at each triangle.
#[test]
fn kinds_with_and_without_texture_are_read_in_either_order() {
    let plain = r#"{"attributes": {"POSITION": 0}, "indices": 3, "mode": 5}"#;
    let before = changed(r#""primitives": ["#, &format!(r#""primitives": [{plain}, "#)).unwrap();
    let after = changed(r#""mode": 4}"#, &format!(r#""mode": 4}}, {plain}"#)).unwrap();
    for (read, textured) in [(before, 2..4), (after, 0..2)] {
        assert_eq!((read.triangles.len(), read.texture.len()), (4, 4));
        let shown = (0..4).filter(|&row| read.texture[row] != [[0.0; 2]; 3]);
        assert!(shown.eq(textured), "{:?}", read.texture);
    }
}

#[test]
fn bad_files_are_refused_in_words() {
    for (from, to, expected) in [
        (r#""count": 4, "type": "VEC3""#, r#""count": 5, "type": "VEC3""#, "accessor 0 goes beyond its buffer"),
        (r#""count": 6"#, r#""count": 60"#, "accessor 2 goes beyond its buffer"),
        (r#""count": 6"#, r#""count": 18446744073709551615"#, "accessor 2 goes beyond its buffer"),
        (r#""byteOffset": 64"#, r#""byteOffset": 48"#, "a triangle names point"),
        (r#""byteStride": 4"#, r#""byteStride": 255"#, "byteStride: Invalid value"),
        (r#""indices": 2"#, r#""indices": 0"#, "accessor 0 has another number of parts"),
        (r#""TEXCOORD_0": 1"#, r#""TEXCOORD_0": 7"#, "a mesh names accessor 7; there are 4"),
        (r#""mesh": 0, "#, r#""mesh": 0, "children": [1], "#, "node 1 is in the scene twice, or below itself"),
        (r#""scene": 0, "scenes": [{"nodes": [1]}],"#, "", "the file has no scene"),
        (r#""mode": 4"#, r#""mode": 1"#, "the file has no triangles"),
        ("base64,", "base64,*", "a buffer is no base64 text"),
        (r#""2.0""#, "", "a.gltf"),
    ] {
        let error = changed(from, to).map(|_| ()).unwrap_err();
        assert!(error.contains(expected), "{to}: {error}");
    }
    let error = read(&scene(r#""uri": "a.bin", "#)).unwrap_err();
    assert!(error.contains("a.bin: no other file is read here"), "{error}");
}

#[test]
fn cut_and_changed_files_are_refused_or_read_but_never_worse() {
    let mut dice = fastrand::Rng::with_seed(9);
    for file in [embedded().into_bytes(), binary()] {
        for _ in 0..3000 {
            let mut bytes = file.clone();
            if dice.u8(..4) == 0 {
                bytes.truncate(dice.usize(..=file.len()));
            }
            for _ in 0..dice.usize(1..4) {
                if !bytes.is_empty() {
                    let at = dice.usize(..bytes.len());
                    // digits make other numbers
                    bytes[at] = if bytes[at].is_ascii_digit() { dice.u8(b'0'..=b'9') } else { dice.u8(..) };
                }
            }
            if let Ok(read) = Triangles::from_bytes("changed", &bytes) {
                assert!(read.triangles.as_flattened().iter().all(|&row| (row as usize) < read.points.len()));
            }
        }
    }
}

#[test]
fn texture_coordinates_of_obj_files_go_with_corners() {
    let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt .5 0\nvt .5 1\nvt 0 1\nvt 1\nf 1/1 2/2 3/3 4/4\n";
    let read = Triangles::from_bytes("a.obj", format!("{square}f 1/-1/7 2//1 3/3").as_bytes()).unwrap();
    assert_eq!(read.triangles, [[0, 1, 2], [0, 2, 3], [0, 1, 2]]);
    let corners = [[[0.0, 0.0], [0.5, 0.0], [0.5, 1.0]], [[0.0, 0.0], [0.5, 1.0], [0.0, 1.0]]];
    assert_eq!(read.texture[..2], corners);
    assert_eq!(read.texture[2], [[1.0, 0.0], [0.0, 0.0], [0.5, 1.0]]);
    assert!(Triangles::from_bytes("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 1 1\nf 1 2 3").unwrap().texture.is_empty());
    for (text, expected) in
        [("vt x", "no texture coordinates"), ("f 1/6 2/1 3/1", "numbers of the 5 texture coordinates")]
    {
        let error = Triangles::from_bytes("a.obj", format!("{square}{text}\n").as_bytes()).unwrap_err().to_string();
        assert!(error.contains(expected) && error.contains("11"), "{error}");
    }
}
