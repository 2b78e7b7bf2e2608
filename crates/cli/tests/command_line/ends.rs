//! How the command ends: one status for each kind of failure, and words that say where and what.

use crate::sinew::{Ended, SCENE, Workspace};
use std::fs;
use std::process::Stdio;

#[test]
fn a_wrong_scene_ends_with_2_all_its_mistakes_and_no_output() {
    let scene = SCENE.replace("density", "densty").replace("duration: 0.2", "duration: -1");
    let place = Workspace::with_scene(&scene);
    for command in ["run", "check", "explain", "render"] {
        let ended = place.sinew(&[command, "block.ron"]);
        ended.wants(
            2,
            &["block.ron:5:", "`densty`", "did you mean `density`?", "block.ron:3:", "2 errors; nothing was run"],
        );
        assert!(ended.said.is_empty() && !place.path("out").exists());
    }
}

#[test]
fn a_scene_that_is_not_there_ends_with_2() {
    Workspace::new().sinew(&["run", "blocks.ron"]).wants(2, &["cannot read the scene blocks.ron"]);
}

#[test]
fn a_broken_mesh_ends_with_2_and_names_the_file() {
    let scene = SCENE.replace("Box(size: (0.1, 0.1, 0.1), cells: (3, 3, 3), elements: Hex8)", "File(path: \"m.msh\")");
    let place = Workspace::with_scene(&scene);
    place.sinew(&["run", "block.ron"]).wants(2, &["m.msh"]);
    fs::write(place.path("m.msh"), "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0 0").unwrap();
    for command in ["run", "check"] {
        place.sinew(&[command, "block.ron"]).wants(2, &["m.msh", "nothing was run"]);
    }
}

#[test]
fn files_outside_the_folder_of_a_scene_are_read_where_that_is_allowed() {
    let scene =
        SCENE.replace("Box(size: (0.1, 0.1, 0.1), cells: (3, 3, 3), elements: Hex8)", "File(path: \"../m.msh\")");
    let place = Workspace::new();
    fs::create_dir(place.path("inner")).unwrap();
    fs::write(place.path("inner/block.ron"), scene).unwrap();
    fs::write(place.path("m.msh"), "no mesh").unwrap();
    for command in ["run", "check", "explain", "render", "accuracy"] {
        place.sinew(&[command, "inner/block.ron"]).wants(2, &["`../m.msh` lies outside", "--allow-outside"]);
        // allowed, it is read, and refused for what it is
        let read = place.sinew(&[command, "inner/block.ron", "--allow-outside"]);
        read.wants(2, &["m.msh", "does not begin as a .msh file does"]);
    }
}

#[test]
fn wrong_options_end_with_2() {
    let place = Workspace::new();
    place.sinew(&["run"]).wants(2, &["SCENE"]);
    place.sinew(&["run", "block.ron", "--backend", "tpu"]).wants(2, &["tpu", "auto, cpu, gpu"]);
    place.sinew(&["run", "block.ron", "--threads", "-1"]).wants(2, &["--threads"]);
    place.sinew(&["run", "block.ron", "--set", "duration"]).wants(2, &["a value is missing"]);
    place.sinew(&["run", "block.ron", "--backend", "gpu", "--precision", "f64"]).wants(2, &["f32 only"]);
    assert!(!place.path("out").exists());
}

#[test]
fn a_run_that_breaks_down_ends_with_1_and_keeps_what_it_wrote() {
    let place = Workspace::new();
    let sudden = "loads[0]=Gravity(acceleration: (0, 0, -9000), curve: Step(start: 0.1))";
    let ended = place.sinew(&["run", "block.ron", "--backend", "cpu", "--set", sudden, "--set", "guards.every=8"]);
    ended.wants(1, &["broke down", "element", "of body block", "Likely causes"].map(|w| w.trim_start_matches("of ")));
    let frames = place.frames("out/block");
    assert!(frames.len() >= 10, "{frames:?}");
    assert!(place.table("out/block/probe_top.csv").len() >= 10);
    let summary = place.json("out/block/summary.json");
    assert!(summary["ended"].as_str().unwrap().contains("broke down"));
    assert!(!place.path("out/block/nodes.csv").exists(), "nodes without meaning");
    // for programs: what ended it, and where to go on from
    let failure = &summary["failure"];
    // what falls flat is turned inside out, or needs steps of no length before
    assert!(["inverted", "step"].contains(&failure["criterion"]["name"].as_str().unwrap()), "{failure}");
    assert!(failure["criterion"]["element"].is_u64() && failure["criterion"]["limit"].is_f64(), "{failure}");
    let (good, series) = (failure["last_good"]["snapshot"].as_str(), failure["last_good"]["series"].as_str());
    let (good, series) = (good.unwrap().to_string(), series.unwrap());
    assert!(
        place.path(&format!("out/block/{good}")).exists()
            && place.read(&format!("out/block/{series}")).contains("last_states_000000.vtu")
    );
    assert!(failure["last_good"]["step"].as_u64() < failure["step"].as_u64());
    let from = format!("out/block/{good}");
    let again = place.sinew(&[
        "run",
        "block.ron",
        "--backend",
        "cpu",
        "--set",
        sudden,
        "--set",
        "guards.every=8",
        "--resume",
        &from,
    ]);
    again.wants(1, &["broke down"]);
    let resumed = place.json("out/block-resumed/summary.json");
    assert_eq!((&resumed["failure"]["what"], &resumed["failure"]["step"]), (&failure["what"], &failure["step"]));
    place.done(&["render", "out/block", "--no-animation"]);
}

/// In the last step tetrahedra that may go are drawn out to 1e21 of their size and inside out: nodes have a place,
/// forces overflow.
#[test]
fn a_result_that_is_no_number_ends_with_1_and_a_summary() {
    let place = Workspace::with_scene(
        r#"(duration: 0.006,
bodies: {"b": (mesh: Ellipsoid(radii: (0.00134, 0.00107, 0.00134), across: 2), material: "m", velocity: (0.2, 0.27, 0))},
materials: {"m": (density: 2500, arruda_boyce: (shear: 2350, locking_stretch: 6, bulk: 4e4), inversion: Remove)},
constraints: [Prescribed(on: Sphere(center: (0, 0.00036, -0.002), radius: 0.0016), axes: [Y, Z],
    displacement: (0, 0, -1.5e18), curve: Step(start: 0.00599999))],
guards: (off: [Energy]), output: (fields: [Displacement]))"#,
    );
    place
        .sinew(&["run", "block.ron", "--backend", "cpu", "--precision", "f64"])
        .wants(1, &["node", "no finite number"]);
    let summary = place.json("out/block/summary.json");
    assert!(summary["ended"].as_str().unwrap().contains("no finite number"));
    assert_eq!(summary["failure"]["criterion"]["name"], "result");
    assert!(!place.path("out/block/nodes.csv").exists(), "nodes without meaning");
}

/// In single precision: in double it can be told.
#[test]
fn energy_of_removed_elements_beyond_what_numbers_express_ends_with_1() {
    let place = Workspace::with_scene(
        r#"(duration: 0.02, bodies: {"b": (mesh: Box(size: (1, 1, 1), cells: (2, 1, 1)), material: "m", velocity: (1e20, 0, 0))},
materials: {"m": (density: 1000, neo_hookean: Young(young: 3000, poisson: 0.45))},
removal: [(on: Box(min: (0, 0, 0), max: (0.6, 1, 1)), when: At(0.01))],
guards: (off: [Energy]), output: (fields: [Displacement]))"#,
    );
    let run = |precision: &str| place.sinew(&["run", "block.ron", "--backend", "cpu", "--precision", precision]);
    run("f32").wants(1, &["the energy of removed elements is inf"]);
    assert_eq!(place.json("out/block/summary.json")["failure"]["criterion"]["name"], "result");
    run("f64").wants(0, &[]);
}

#[test]
fn a_search_for_rest_that_finds_none_ends_with_1_and_says_how_far_it_came() {
    let place = Workspace::new();
    let analysis = "analysis=Static(max_steps: 120)";
    let ended = place.sinew(&["run", "block.ron", "--backend", "cpu", "--set", analysis]);
    ended.wants(1, &["no equilibrium after 120 steps", "the residual is", "at node", "max_steps"]);
    let summary = place.json("out/block/summary.json");
    assert!(summary["ended"].as_str().unwrap().contains("no equilibrium"));
    assert_eq!(summary["equilibrium"]["reached"], false);
    assert!(!place.path("out/block/nodes.csv").exists(), "nodes that are no equilibrium");
    assert_eq!(place.frames("out/block").len(), 1, "a frame that is no equilibrium");
}

#[test]
fn an_output_folder_that_cannot_be_written_ends_with_3() {
    let place = Workspace::new();
    fs::write(place.path("file"), "").unwrap();
    place.sinew(&["run", "block.ron", "--out", "file"]).wants(3, &["file is a file"]);
    fs::create_dir(place.path("photos")).unwrap();
    fs::write(place.path("photos/holiday.jpg"), "").unwrap();
    place.sinew(&["run", "block.ron", "--out", "photos"]).wants(3, &["holiday.jpg", "sinew.json"]);
    assert_eq!(fs::read_dir(place.path("photos")).unwrap().count(), 1);
}

/// A limit on the size of files stands in for a full disk: any user can set it.
#[cfg(unix)]
#[test]
fn files_that_cannot_grow_end_the_run_with_3_and_stay_readable() {
    let place = Workspace::new();
    let limited = "trap '' XFSZ; ulimit -f 16; exec \"$0\" run block.ron --backend cpu --set probes.top.every=1e-5 \
                   --set integration.step=1e-4";
    let mut command = std::process::Command::new("bash");
    command.args(["-c", limited, env!("CARGO_BIN_EXE_sinew")]).current_dir(place.folder.path());
    let ended = Ended::of(command.output().unwrap());
    ended.wants(3, &["cannot write", "probe_top.csv", "File too large"]);
    assert!(place.table("out/block/probe_top.csv").len() > 100);
    assert!(!place.frames("out/block").is_empty());
}

/// The real thing, where a small file system can be mounted.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_ends_the_run_with_3_and_leaves_whole_files() {
    let place = Workspace::new();
    fs::create_dir(place.path("disk")).unwrap();
    let disk = place.path("disk").display().to_string();
    let mounted = std::process::Command::new("mount").args(["-t", "tmpfs", "-o", "size=96k", "tmpfs", &disk]).output();
    if !mounted.is_ok_and(|output| output.status.success()) {
        eprintln!("left out: a file system of 96 kB cannot be mounted without root's rights");
        return;
    }
    let ended = place.sinew(&["run", "block.ron", "--backend", "cpu", "--out", "disk/out"]);
    let frames = std::panic::catch_unwind(|| place.frames("disk/out"));
    let table = std::panic::catch_unwind(|| place.table("disk/out/probe_top.csv"));
    let _ = std::process::Command::new("umount").arg(&disk).output();
    ended.wants(3, &["disk/out", "No space left on device"]);
    assert!(!frames.unwrap().is_empty() && !table.unwrap().is_empty());
}

#[cfg(target_os = "linux")]
#[test]
fn a_result_that_cannot_be_said_ends_with_3_and_a_closed_pipe_does_not() {
    let place = Workspace::new();
    let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let said = place.command(&["check", "block.ron"]).stdout(full).stderr(Stdio::piped()).output().unwrap();
    Ended::of(said).wants(3, &["cannot write to the standard output"]);
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    let said = place.command(&["explain", "block.ron", "--backend", "cpu"]).stdout(writer).output().unwrap();
    Ended::of(said).wants(0, &[]);
}

#[cfg(target_os = "linux")]
#[test]
fn without_a_gpu_the_run_ends_with_4_and_says_what_to_do() {
    let place = Workspace::new();
    let mut command = place.command(&["run", "block.ron", "--backend", "gpu"]);
    command.env("VK_DRIVER_FILES", "/nowhere").env("VK_ICD_FILENAMES", "/nowhere");
    Ended::of(command.output().unwrap()).wants(4, &["no GPU", "mesa-vulkan-drivers"]);
    assert!(!place.path("out").exists());
    place.sinew(&["run", "block.ron", "--backend", "gpu", "--gpu", "no such device"]).wants(4, &["no GPU"]);
}
