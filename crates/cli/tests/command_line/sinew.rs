//! Runs the built command in a folder of its own.

use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

/// A small block of tissue that sags.
pub const SCENE: &str = r#"(
    title: "Small block",
    duration: 0.2,
    bodies: { "block": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (3, 3, 3), elements: Hex8), material: "tissue") },
    materials: { "tissue": (density: 1000, neo_hookean: Young(young: 3000, poisson: 0.45), damping: 5) },
    constraints: [Fixed(on: Set("z0"))],
    loads: [Gravity(acceleration: (0, 0, -9.81))],
    probes: { "top": (what: Displacement, on: Set("z1"), every: 0.01) },
    output: (energies_every: 0.05),
    picture: (field: VonMises, size: (320, 240)),
)"#;

/// A folder with a scene in it, in which the command runs.
pub struct Workspace {
    pub folder: tempfile::TempDir,
}

/// How a run of the command ended.
pub struct Ended {
    pub status: Option<i32>,
    pub said: String,
    pub complained: String,
}

impl Workspace {
    /// With `block.ron` in it.
    pub fn with_scene(text: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("block.ron"), text).unwrap();
        Self { folder }
    }

    /// With [`SCENE`] as `block.ron`.
    pub fn new() -> Self {
        Self::with_scene(SCENE)
    }

    /// Writes a pyramid of 1 m with a corner in the origin, `pyramid.gltf`, whose numbers are in `pyramid.bin`.
    pub fn write_pyramid(&self) {
        let places = [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let mut bytes: Vec<u8> = places.iter().flatten().flat_map(|number| number.to_le_bytes()).collect();
        bytes.extend([0_u16, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3].iter().flat_map(|row| row.to_le_bytes()));
        fs::write(self.path("pyramid.bin"), bytes).unwrap();
        let text = r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
"accessors": [
  {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]},
  {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"}],
"bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 24}],
"buffers": [{"uri": "pyramid.bin", "byteLength": 72}]}"#;
        fs::write(self.path("pyramid.gltf"), text).unwrap();
    }

    /// The command, not begun yet.
    pub fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_sinew"));
        command.args(arguments).current_dir(self.folder.path()).stdin(Stdio::null());
        command
    }

    /// Runs the command.
    pub fn sinew(&self, arguments: &[&str]) -> Ended {
        Ended::of(self.command(arguments).output().unwrap())
    }

    /// Runs the command and wants it to succeed; what it said.
    pub fn done(&self, arguments: &[&str]) -> String {
        let ended = self.sinew(arguments);
        assert_eq!(ended.status, Some(0), "{arguments:?}: {}", ended.complained);
        ended.said
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    pub fn json(&self, name: &str) -> serde_json::Value {
        serde_json::from_str(&self.read(name)).unwrap()
    }

    /// Rows of a table, its header left out; all of one length and all numbers.
    pub fn table(&self, name: &str) -> Vec<Vec<f64>> {
        let text = self.read(name);
        assert!(text.ends_with('\n'), "{name} ends within a row");
        let mut lines = text.lines();
        let columns = lines.next().unwrap().split(',').count();
        let rows: Vec<Vec<f64>> =
            lines.map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect();
        assert!(rows.iter().all(|row| row.len() == columns), "{name}");
        rows
    }

    /// Frames of a series, each with its time; all of them are there and are XML from beginning to end.
    pub fn frames(&self, out: &str) -> Vec<f64> {
        let series = self.read(&format!("{out}/fields.pvd"));
        let series = roxmltree::Document::parse(&series).unwrap();
        let entries = series.descendants().filter(|node| node.has_tag_name("DataSet"));
        entries
            .map(|entry| {
                let file = self.path(&format!("{out}/{}", entry.attribute("file").unwrap()));
                let bytes = fs::read(&file).unwrap();
                assert!(bytes.trim_ascii_end().ends_with(b"</VTKFile>"), "{}", file.display());
                entry.attribute("timestep").unwrap().parse().unwrap()
            })
            .collect()
    }
}

impl Ended {
    pub fn of(output: Output) -> Self {
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        Self { status: output.status.code(), said: text(output.stdout), complained: text(output.stderr) }
    }

    /// Wants a status and words in what it complained about.
    pub fn wants(&self, status: i32, words: &[&str]) {
        assert_eq!(self.status, Some(status), "{}", self.complained);
        for word in words {
            assert!(self.complained.contains(word), "{word:?} is not in\n{}", self.complained);
        }
        assert!(!self.complained.contains("panicked"), "{}", self.complained);
        assert!(!self.complained.contains('\x1b'), "colours without a terminal: {}", self.complained);
    }
}
