//! What a run writes can be read back, whole, at every moment.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use flate2::read::ZlibDecoder;
use glam::DVec3;
use serde_json::{Value, json};
use sinew::mesh::{CellKind, Cells};
use sinew::output::{Array, Folder, Frame, Lock, Node, Series, Table, Values, nodes, summary, write_vtu};
use std::fs;
use std::io::Read;
use std::path::Path;

/// A hexahedron with a tetrahedron beside it.
struct Example {
    points: Vec<DVec3>,
    cells: Cells,
    displacement: Vec<f32>,
    alive: Vec<u8>,
    stress: Vec<f64>,
}

impl Example {
    fn new() -> Example {
        let corners =
            [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1), (2, 0, 0)];
        let points: Vec<_> = corners.map(|(x, y, z)| DVec3::new(x as f64 / 3.0, y.into(), z.into())).to_vec();
        let mut cells = Cells::of(CellKind::Hex8, &[[0, 1, 2, 3, 4, 5, 6, 7]]).unwrap();
        cells.push(CellKind::Tet4, [1, 8, 2, 5]).unwrap();
        Example {
            displacement: (0..points.len() * 3).map(|row| row as f32 * 0.1).collect(),
            points,
            cells,
            alive: vec![0, 1],
            stress: (0..12).map(|row| f64::from(row) / 7.0).collect(),
        }
    }

    fn frame(&self, time: f64) -> Frame<'_> {
        Frame {
            time,
            points: &self.points,
            cells: &self.cells,
            point_arrays: vec![Array { name: "displacement", components: 3, values: Values::F32(&self.displacement) }],
            cell_arrays: vec![
                Array { name: "alive", components: 1, values: Values::U8(&self.alive) },
                Array { name: "a < \"b\" & c", components: 6, values: Values::F64(&self.stress) },
            ],
        }
    }
}

/// The bytes of a named array of a VTU file, read by the rules of the format alone.
fn array(file: &[u8], name: &str) -> Vec<u8> {
    let data = file.windows(10).position(|window| window == b"raw\">\n   _").expect("data") + 10;
    let head = String::from_utf8(file[..data - 1].to_vec()).unwrap() + "</AppendedData></VTKFile>";
    let head = roxmltree::Document::parse(&head).unwrap();
    assert_eq!(head.root_element().attribute("header_type"), Some("UInt64"));
    let entry = head.descendants().find(|node| node.attribute("Name") == Some(name)).expect(name);
    let at = data + entry.attribute("offset").unwrap().parse::<usize>().unwrap();
    let word = |row: usize| u64::from_le_bytes(file[at + 8 * row..at + 8 * row + 8].try_into().unwrap()) as usize;
    let (blocks, size, last) = (word(0), word(1), word(2));
    let (mut bytes, mut next) = (Vec::new(), at + 8 * (3 + blocks));
    for block in 0..blocks {
        ZlibDecoder::new(&file[next..next + word(3 + block)]).read_to_end(&mut bytes).unwrap();
        next += word(3 + block);
    }
    assert_eq!(bytes.len(), if last == 0 { blocks * size } else { (blocks - 1) * size + last });
    bytes
}

/// What is in a folder, hidden files aside.
fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.retain(|name| !name.starts_with('.'));
    names.sort();
    names
}

#[test]
fn a_frame_reads_back_bit_by_bit() {
    let (folder, example) = (tempfile::tempdir().unwrap(), Example::new());
    let path = folder.path().join("frame.vtu");
    write_vtu(&path, &example.frame(0.125)).unwrap();
    let file = fs::read(&path).unwrap();
    assert_eq!(array(&file, "displacement"), bytemuck::cast_slice::<f32, u8>(&example.displacement));
    assert_eq!(array(&file, "a < \"b\" & c"), bytemuck::cast_slice::<f64, u8>(&example.stress));
    assert_eq!(array(&file, "alive"), [0, 1]);
    assert_eq!(array(&file, "Points"), bytemuck::cast_slice::<DVec3, u8>(&example.points));
    assert_eq!(array(&file, "connectivity"), bytemuck::cast_slice::<i32, u8>(&[1, 8, 2, 5, 0, 1, 2, 3, 4, 5, 6, 7]));
    assert_eq!(array(&file, "offsets"), bytemuck::cast_slice::<i32, u8>(&[4, 12]));
    assert_eq!(array(&file, "types"), [10, 12]);
    assert!(String::from_utf8_lossy(&file).contains(">0.125</DataArray>"));
    assert_eq!(names(folder.path()), ["frame.vtu"]);
}

#[test]
fn an_array_of_many_blocks_reads_back() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("frame.vtu");
    for rows in [32_768, 100_000] {
        let points: Vec<_> = (0..rows).map(|row| DVec3::splat(f64::from(row).sin())).collect();
        let ids: Vec<i64> = (0..i64::from(rows)).collect();
        let point_arrays = vec![Array { name: "id", components: 1, values: Values::I64(&ids) }];
        let cells = Cells::default();
        let frame = Frame { time: 0.0, points: &points, cells: &cells, point_arrays, cell_arrays: vec![] };
        write_vtu(&path, &frame).unwrap();
        let file = fs::read(&path).unwrap();
        assert_eq!(array(&file, "id"), bytemuck::cast_slice::<i64, u8>(&ids));
        assert_eq!(array(&file, "Points"), bytemuck::cast_slice::<DVec3, u8>(&points));
    }
}

#[test]
fn a_frame_that_paraview_could_not_read_is_refused() {
    let (folder, mut example) = (tempfile::tempdir().unwrap(), Example::new());
    let path = folder.path().join("frame.vtu");
    example.cells.nodes_mut(0)[2] = 9;
    let text = write_vtu(&path, &example.frame(0.0)).unwrap_err().to_string();
    assert!(text.ends_with("an element names point 9, but there are 9 points, counted from 0"), "{text}");
    example.cells.nodes_mut(0)[2] = 2;
    example.alive.pop();
    let text = write_vtu(&path, &example.frame(0.0)).unwrap_err().to_string();
    assert!(text.ends_with("array \"alive\" has 1 values; 2 rows of 1 components need 2"), "{text}");
    assert_eq!(names(folder.path()), [""; 0]);
}

#[test]
fn a_series_is_whole_after_every_frame() {
    let (place, example) = (tempfile::tempdir().unwrap(), Example::new());
    let folder = Folder::create(&place.path().join("out")).unwrap();
    let mut series = Series::create(&folder).unwrap();
    for frame in 0..4 {
        let text = fs::read_to_string(folder.path().join("fields.pvd")).unwrap();
        let document = roxmltree::Document::parse(&text).unwrap();
        let entries = document.descendants().filter(|node| node.has_tag_name("DataSet"));
        let entries: Vec<_> = entries
            .map(|entry| (entry.attribute("timestep").unwrap().parse().unwrap(), entry.attribute("file").unwrap()))
            .collect();
        assert_eq!(entries.len(), frame);
        for (row, (time, file)) in entries.into_iter().enumerate() {
            assert_eq!((time, file), (row as f64 / 3.0, &*format!("fields_{row:06}.vtu")));
            assert!(folder.path().join(file).is_file());
        }
        series.write(&example.frame(frame as f64 / 3.0)).unwrap();
    }
    assert_eq!(series.frame_count(), 4);
}

#[test]
fn a_table_keeps_every_digit_and_whole_rows() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("energy.csv");
    let rows = [[0.1 + 0.2, -1e-300], [f64::MAX, 1.0 / 3.0], [5e-324, -0.0]];
    let mut table = Table::create(&path, &["time (s)", "a,b"]).unwrap();
    for (written, row) in rows.iter().enumerate() {
        table.row(row).unwrap();
        // read while the table is still open, as after a crash
        let text = fs::read_to_string(&path).unwrap();
        assert_eq!(text.lines().next(), Some("time (s),\"a,b\""));
        assert_eq!(text.lines().count(), written + 2);
        let read: Vec<f64> = text.lines().last().unwrap().split(',').map(|cell| cell.parse().unwrap()).collect();
        assert_eq!(read.map_bits(), row.to_vec().map_bits());
    }
    let text = table.row(&[1.0]).unwrap_err().to_string();
    assert!(text.ends_with("a row of 1 cells in a table of 2 columns"), "{text}");
}

/// Bits, so that -0 is not 0.
trait MapBits {
    fn map_bits(self) -> Vec<u64>;
}

impl MapBits for Vec<f64> {
    fn map_bits(self) -> Vec<u64> {
        self.into_iter().map(f64::to_bits).collect()
    }
}

#[test]
fn nodes_are_told_by_the_authors_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("nodes.csv");
    let node = Node {
        id: 17,
        position: DVec3::new(0.1, 2.0, -3.0),
        displacement: DVec3::new(1e-9, 0.0, 1.0 / 3.0),
        force: DVec3::X,
        mass: 0.25,
    };
    nodes::write(&path, [node]).unwrap();
    let text = fs::read_to_string(&path).unwrap();
    let expected = "id,X,Y,Z,ux,uy,uz,fx,fy,fz,mass\n17,0.1,2.0,-3.0,1e-9,0.0,0.3333333333333333,1.0,0.0,0.0,0.25\n";
    assert_eq!(text, expected);
}

#[test]
fn a_summary_says_which_numbers_are_not_finite() {
    #[derive(serde::Serialize)]
    struct Energy {
        kinetic: f64,
        strain: Option<f32>,
    }
    #[derive(serde::Serialize)]
    struct Summary {
        steps: u64,
        energy: Energy,
        probes: std::collections::BTreeMap<&'static str, Vec<(f64, f64)>>,
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("summary.json");
    let mut run = Summary {
        steps: 3,
        energy: Energy { kinetic: 0.5, strain: None },
        probes: [("tip", vec![(1.0, 2.0), (3.0, 4.0)])].into(),
    };
    let read = || serde_json::from_str::<Value>(&fs::read_to_string(&path).unwrap()).unwrap();
    summary::write(&path, &run).unwrap();
    assert_eq!(read()["energy"], json!({ "kinetic": 0.5, "strain": null }));
    assert_eq!(read().get("not_finite"), None);
    (run.energy.kinetic, run.energy.strain) = (f64::NAN, Some(f32::INFINITY));
    run.probes.get_mut("tip").unwrap()[1].0 = f64::NEG_INFINITY;
    summary::write(&path, &run).unwrap();
    assert_eq!(read()["energy"]["kinetic"], Value::Null);
    let reasons = json!({ "energy.kinetic": "NaN", "energy.strain": "inf", "probes.tip.1.0": "-inf" });
    assert_eq!(read()["not_finite"], reasons);
    assert_eq!(read()["steps"], 3);
    assert!(summary::write(&path, &[f64::NAN]).is_err());
}

#[test]
fn only_what_sinew_wrote_is_cleared() {
    let (place, example) = (tempfile::tempdir().unwrap(), Example::new());
    let path = place.path().join("a/new/folder");
    let mut folder = Folder::create(&path).unwrap();
    Series::create(&folder).unwrap().write(&example.frame(0.0)).unwrap();
    Table::create(&folder.claim("tip.csv").unwrap(), &["time"]).unwrap();
    fs::write(folder.claim("nodes.csv").unwrap(), "").unwrap();
    for own in ["notes.txt", "fields_mine.vtu", "fields_12.vtu", "other.csv"] {
        fs::write(path.join(own), "").unwrap();
    }
    drop(folder);
    Folder::create(&path).unwrap();
    assert_eq!(names(&path), ["fields_12.vtu", "fields_mine.vtu", "notes.txt", "other.csv", "sinew.json"]);
}

#[test]
fn a_list_in_the_mark_cannot_reach_out_of_the_folder() {
    let place = tempfile::tempdir().unwrap();
    let (path, treasure) = (place.path().join("out"), place.path().join("treasure"));
    fs::create_dir(&path).unwrap();
    fs::write(&treasure, "").unwrap();
    fs::write(path.join("sinew.json"), r#"{"files": ["../treasure", "", ".."]}"#).unwrap();
    let mut folder = Folder::create(&path).unwrap();
    assert!(treasure.is_file());
    for name in ["../treasure", "a/b", "", ".hidden", "sinew.json", "a\\b", "c:"] {
        let text = folder.claim(name).unwrap_err().to_string();
        assert!(text.contains("cannot be the name of an output file"), "{text}");
    }
}

#[test]
fn a_foreign_folder_is_refused() {
    let place = tempfile::tempdir().unwrap();
    fs::write(place.path().join(".hidden"), "").unwrap();
    Folder::create(place.path()).unwrap();
    fs::remove_file(place.path().join("sinew.json")).unwrap();
    fs::write(place.path().join("thesis.tex"), "").unwrap();
    let text = Folder::create(place.path()).err().unwrap().to_string();
    assert!(text.contains("it holds thesis.tex but no sinew.json"), "{text}");
    let text = Folder::create(&place.path().join("thesis.tex")).err().unwrap().to_string();
    assert!(text.ends_with("thesis.tex is a file; the output needs a folder"), "{text}");
    let text = Folder::create(&place.path().join("thesis.tex/out")).err().unwrap().to_string();
    assert!(text.contains("cannot create") && text.contains("Not a directory"), "{text}");
    assert_eq!(names(place.path()), ["thesis.tex"]);
}

#[test]
fn a_folder_has_one_writer_until_the_last_who_writes_into_it_is_gone() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("out");
    let folder = Folder::create_for(&path, "cube.ron").unwrap();
    let refused = |why: &str| {
        let text = Folder::create(&path).err().unwrap_or_else(|| panic!("{why}")).to_string();
        let holder = format!("out is being written by another sinew (process {}, for ", std::process::id());
        assert!(text.contains(&holder) && text.contains(" s, cube.ron); wait"), "{text}");
    };
    refused("the folder is held");
    let lock = folder.lock();
    drop(folder);
    refused("who writes into it holds it");
    drop(lock);
    let pictures = Lock::of_pictures(&path, "sinew render").unwrap();
    let text = Folder::create(&path).err().unwrap().to_string();
    assert!(text.contains("sinew render"), "{text}");
    drop(pictures);
    let folder = Folder::create(&path).unwrap();
    // a run that goes on can be drawn
    Lock::of_pictures(&path, "sinew render").unwrap();
    drop(folder);
}
