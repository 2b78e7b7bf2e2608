//! What holds for all of them.

use super::{reference, scene};
use sinew::components::Precision;
use sinew::output::Folder;
use sinew::scene::load;
use sinew::scene::schema::Scene;
use sinew::systems::Registry;
use sinew::{BackendChoice, Options, Simulation};

/// The scenes, and what makes each of them short and coarse.
pub const SCENES: [(&str, &[&str]); 19] = [
    ("ball_on_tissue", &["bodies.tissue.mesh.cells=(12, 8, 3)", "duration=0.15"]),
    ("cataract", &crate::cataract::SHORT),
    ("cube_under_gravity", &["bodies.cube.mesh.cells=(5, 5, 5)", "duration=0.3"]),
    ("folded_strip", &["bodies.strip.mesh.cells=(24, 3, 2)", "duration=0.5"]),
    ("grasped_liver", &["duration=0.3"]),
    ("groove", &["bodies.gel.mesh.cells=(12, 6, 3)", "duration=0.1"]),
    ("indentation", &["bodies.layer.mesh.cells=(12, 12, 4)"]),
    ("needle", &["bodies.tissue.mesh.cells=(20, 8, 5)", "duration=0.15"]),
    ("probe", &["bodies.tissue.mesh.cells=(16, 8, 4)", "duration=0.2"]),
    ("retracted_lobe", &["bodies.lobe.mesh.across=8", "duration=0.3"]),
    (
        "stacked_blocks",
        &[
            "bodies.low.mesh.cells=(3, 3, 3)",
            "bodies.middle.mesh.cells=(4, 4, 4)",
            "bodies.high.mesh.cells=(3, 3, 3)",
            "duration=0.2",
        ],
    ),
    ("stretched_bar", &["bodies.bar.mesh.cells=(20, 2, 2)", "duration=0.5"]),
    ("traction", &["bodies.strip.mesh.cells=(20, 3, 1)", "duration=0.3"]),
    ("training_set", &["bodies.tissue.copies=4", "probes.last.on=Set(\"copy 3\")", "duration=0.02"]),
    ("trocar", &["bodies.tissue.mesh.cells=(15, 8, 3)", "duration=0.15"]),
    ("twisted_column", &["bodies.column.mesh.cells=(4, 4, 16)", "duration=1.2"]),
    (
        "lens_tets",
        &["duration=0.05", "loads[0].curve=Smooth(end: 0.01)", "removal[0].when=During(start: 0.01, end: 0.04)"],
    ),
    ("lens_pressed", &["duration=0.03"]),
    (
        "lens_hexes",
        &[
            "bodies.lens.mesh.across=8",
            "bodies.lens.mesh.through=4",
            "duration=0.1",
            "loads[0].curve=Smooth(end: 0.02)",
            "removal[0].when=During(start: 0.02, end: 0.05)",
            "removal[1].when=During(start: 0.05, end: 0.08)",
        ],
    ),
];

#[test]
fn every_scene_in_the_folder_is_tested_here() {
    let folder = format!("{}/scenes", env!("CARGO_MANIFEST_DIR"));
    let mut found: Vec<String> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter_map(|name| name.strip_suffix(".ron").map(str::to_string))
        .collect();
    let mut tested: Vec<String> = SCENES.iter().map(|(name, _)| name.to_string()).collect();
    found.sort();
    tested.sort();
    assert_eq!(found, tested);
}

#[test]
fn scenes_are_sound_without_a_warning() {
    for (name, _) in SCENES {
        let found = Simulation::check(&scene(name, &[]), &Registry::default());
        assert!(found.is_empty(), "{}", found.render(false));
    }
}

#[test]
fn scenes_have_a_title_and_something_to_observe() {
    for (name, _) in SCENES {
        let scene = scene(name, &[]).scene;
        assert!(!scene.title.is_empty() && !scene.probes.is_empty(), "{name}");
    }
}

/// What a run in f32 warns of: bodies and tools that are where others are, too, as fields are written.
fn warned(name: &str, sets: &[&str]) -> Vec<String> {
    let options = Options { backend: BackendChoice::Cpu, precision: Precision::F32, ..Options::default() };
    let folder = tempfile::tempdir().unwrap();
    let mut simulation = Simulation::new(&scene(name, sets), &options).unwrap();
    simulation.write_into(&mut Folder::create(folder.path()).unwrap()).unwrap();
    simulation.observe().unwrap();
    simulation.finish().unwrap();
    let warnings = simulation.summary("finished").unwrap().guards.warnings;
    warnings.into_iter().map(|notice| format!("{} s: {}", notice.time, notice.message)).collect()
}

/// Until it slides, which takes longer to compute.
#[test]
fn the_needle_presses_in_without_a_warning() {
    assert_eq!(warned("needle", &["duration=0.1"]), [""; 0]);
}

#[test]
#[ignore = "long"]
fn scenes_with_tools_run_to_their_end_without_a_warning() {
    for (name, _) in SCENES.iter().filter(|(name, _)| !scene(name, &[]).scene.tools.is_empty()) {
        assert_eq!(warned(name, &[]), [""; 0], "{name}");
    }
}

/// Sinew reads scenes by a syntax tree that knows where everything stands.
#[test]
fn a_scene_is_what_ron_reads() {
    for (name, _) in SCENES {
        let file = scene(name, &[]);
        if file.parts().is_empty() {
            assert_eq!(load::options().from_str::<Scene>(file.text()).unwrap(), file.scene, "{name}");
        }
    }
}

#[test]
fn a_scene_written_and_read_again_is_the_same() {
    for (name, _) in SCENES {
        let before = scene(name, &[]).scene;
        let text = load::options().to_string_pretty(&before, ron::ser::PrettyConfig::default()).unwrap();
        let after: Scene = load::options().from_str(&text).unwrap_or_else(|wrong| panic!("{name}: {wrong}\n{text}"));
        assert_eq!(before, after, "{name}");
    }
}

#[test]
#[ignore = "long"]
fn every_backend_and_precision_ends_with_the_same_displacements() {
    let gpu = sinew::backend::gpu::gpu_or_reason().is_some();
    for (name, sets) in SCENES {
        let scene = scene(name, sets);
        let end = |options: &Options| {
            let mut simulation = Simulation::new(&scene, options).unwrap();
            simulation.finish().unwrap_or_else(|wrong| panic!("{name}: {wrong}"));
            let body = scene.scene.bodies.keys().next().unwrap();
            let rest = simulation.rest_positions(body).unwrap();
            (simulation.displacements(body).unwrap(), rest)
        };
        let (exact, rest) = end(&reference());
        let size = exact.iter().map(|u| u.length()).fold(0.0, f64::max);
        let extent = rest.iter().map(|place| place.distance(rest[0])).fold(0.0, f64::max);
        // bodies of 10 cm by 10 µm
        assert!(size > 1e-4 * extent, "{name}: nothing moves: {size} m of {extent} m");
        let single = Options { backend: BackendChoice::Cpu, precision: Precision::F32, ..Options::default() };
        let device = Options { backend: BackendChoice::Gpu, ..single.clone() };
        for options in [Some(single), gpu.then_some(device)].into_iter().flatten() {
            let (found, _) = end(&options);
            let worst = found.iter().zip(&exact).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
            assert!(worst < 2e-4 * size, "{name} on {:?}: {worst} m of {size} m", options.backend);
        }
    }
}
