//! What is attacked. Each target gets an input and must end in good time, with little memory, with a result or with an
//! error that says something.

use sinew::mesh::{Mesh, vtu};
use sinew::scene::{Allowed, Diagnostics, SceneFile};
use sinew::systems::Registry;
use sinew::{BackendChoice, Error, Options, Simulation, Snapshot};
use std::path::Path;

/// What scenes are allowed here: what they ask for beyond is refused, and what they get takes no time.
const ALLOWED: Allowed = Allowed { outside: false, elements: 2000 };

/// A reader, and what it is fed with.
pub struct Target {
    /// Its name, and that of its folder in the corpus.
    pub name: &'static str,
    /// The name that its inputs have as files.
    pub file: &'static str,
    /// How many inputs of a hundred it gets.
    pub share: usize,
    /// The most memory that an input may take (bytes): so much, and so much for each of its bytes.
    pub memory: (usize, usize),
    /// Tries an input, which is also at the path.
    pub attempt: fn(&[u8], &Path),
}

/// All of them.
pub const TARGETS: [Target; 6] = [
    Target { name: "scenes", file: "scene.ron", share: 30, memory: (64 << 20, 512), attempt: scene },
    Target { name: "sets", file: "sets.txt", share: 15, memory: (64 << 20, 512), attempt: sets },
    Target { name: "meshes", file: "mesh.vtu", share: 42, memory: (64 << 20, 512), attempt: mesh },
    Target { name: "laws", file: "law.wgsl", share: 5, memory: (64 << 20, 4096), attempt: law },
    Target { name: "snapshots", file: "a.sinew", share: 4, memory: (64 << 20, 512), attempt: snapshot },
    Target { name: "runs", file: "scene.ron", share: 4, memory: (256 << 20, 512), attempt: run },
];

/// What is wrong must be told, in every form.
fn said(diagnostics: &Diagnostics, length: usize) {
    let (told, lines) = (diagnostics.render(false), diagnostics.lines());
    assert!(told.len() > 10 && lines.len() == diagnostics.list().len(), "refused without a word");
    assert!(told.len() < 200_000 + 100 * length, "{} bytes of complaints", told.len());
    assert!(!told.contains("this cannot be read"), "ron refuses what the check lets through: {told}");
}

fn load(text: &[u8], sets: &[String]) -> Option<SceneFile> {
    let text = String::from_utf8_lossy(text);
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    match SceneFile::from_text_allowing("hostile.ron", &text, &folder, sets, ALLOWED) {
        Ok(scene) => Some(scene),
        Err(wrong) => {
            assert!(wrong.has_errors());
            said(&wrong, text.len() + sets.iter().map(String::len).sum::<usize>());
            None
        }
    }
}

/// The words and values of a scene.
fn scene(text: &[u8], _: &Path) {
    if let Some(scene) = load(text, &[]) {
        let found = Simulation::check(&scene, &Registry::default());
        if !found.is_empty() {
            said(&found, text.len());
        }
    }
}

/// `--set`, one a line, on a sound scene.
fn sets(text: &[u8], _: &Path) {
    let sets: Vec<String> = String::from_utf8_lossy(text).lines().take(4).map(String::from).collect();
    if let Some(scene) = load(SMALL.as_bytes(), &sets) {
        let mut found = scene.diagnostics();
        sinew::scene::validate(&scene, &mut found);
        let _ = found.render(true);
    }
}

/// A sound scene.
pub const SMALL: &str = r#"(
    duration: 0.5,
    materials: {"tissue": (density: 1060, neo_hookean: Young(young: 3e3, poisson: 0.45))},
    bodies: {"cube": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (2, 2, 2)), material: "tissue")},
    constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0.0))],
    loads: [Gravity(acceleration: (0, 0, -9.81), curve: Table([(0, 0), (0.1, 1)]))],
    probes: {"tip": (what: Displacement, on: Surface(normal: (0, 0, 1)))},
)
"#;

/// Mesh files of all formats.
fn mesh(bytes: &[u8], path: &Path) {
    match Mesh::read(path, bytes.len().is_multiple_of(2)) {
        Err(error) => assert!(error.to_string().len() > 20),
        Ok(mut mesh) => {
            assert!(mesh.soundness().is_sound());
            mesh.surface();
            if mesh.element_count() < 500 && mesh.refine(1).is_ok() {
                assert_eq!(mesh.element_count() % 8, 0);
            }
            assert!(mesh.points.iter().all(|point| point.is_finite()));
        }
    }
    let _ = vtu::read(path);
}

/// Laws in WGSL.
fn law(bytes: &[u8], path: &Path) {
    let file = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    let text = format!(
        r#"(duration: 0.1, materials: {{"m": (density: 1000, law: (file: {file:?}, parameters: {{"mu": 1000, "b": 2, "bulk": 1e4}}))}},
bodies: {{"cube": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (1, 1, 1)), material: "m")}})"#
    );
    let folder = path.parent().unwrap_or(Path::new("."));
    if let Ok(scene) = SceneFile::from_text_allowing("law.ron", &text, folder, &[], ALLOWED) {
        let found = Simulation::check(&scene, &Registry::default());
        if found.has_errors() {
            said(&found, bytes.len());
        }
    }
}

/// A simulation that snapshots are of.
pub fn small() -> Simulation {
    let scene = SceneFile::from_text("small.ron", SMALL, Path::new("."), &[]).unwrap();
    Simulation::new(&scene, &Options { backend: BackendChoice::Cpu, threads: 1, ..Options::default() }).unwrap()
}

/// Snapshots, as they are and with a length and a checksum that fit.
fn snapshot(bytes: &[u8], _: &Path) {
    let mut sealed = bytes.to_vec();
    if let Some(content) = bytes.len().checked_sub(8).filter(|&end| end >= 24) {
        sealed[16..24].copy_from_slice(&(bytes.len() as u64).to_le_bytes());
        let check = twox_hash::XxHash64::oneshot(0, &sealed[..content]);
        sealed[content..].copy_from_slice(&check.to_le_bytes());
    }
    for bytes in [bytes, &sealed] {
        match Snapshot::from_bytes(bytes) {
            Err(error) => assert!(error.to_string().len() > 10),
            Ok(snapshot) => {
                let mut simulation = small();
                if simulation.restore(&snapshot).is_ok() && steps(&mut simulation).is_ok() {
                    assert!(simulation.time().is_finite());
                }
            }
        }
    }
}

/// A scene that is sound in spite of all runs, or says why not; its results are numbers.
fn run(text: &[u8], _: &Path) {
    let Some(scene) = load(text, &[]) else { return };
    let options = Options { backend: BackendChoice::Cpu, threads: 1, ..Options::default() };
    match Simulation::new(&scene, &options) {
        Err(Error::Scene(wrong)) => said(&wrong, text.len()),
        Err(other) => assert!(other.to_string().len() > 10),
        Ok(mut simulation) => {
            if let Err(error) = steps(&mut simulation) {
                assert!(error.to_string().len() > 10);
            }
        }
    }
}

fn steps(simulation: &mut Simulation) -> Result<(), Error> {
    simulation.observe()?;
    if simulation.scene().is_static() {
        // on the way to rest steps may go wrong and are taken back; what counts is what is called an equilibrium
        simulation.advance(200)?;
        if !simulation.is_finished() {
            return Ok(());
        }
    } else {
        simulation.advance(3)?;
    }
    // the guards check when something is observed
    simulation.observe()?;
    let names: Vec<String> = simulation.scene().bodies.keys().cloned().collect();
    for name in names {
        let displacements = simulation.displacements(&name)?;
        assert!(displacements.iter().all(|u| u.is_finite()), "displacements that are no numbers and no error");
    }
    Ok(())
}
