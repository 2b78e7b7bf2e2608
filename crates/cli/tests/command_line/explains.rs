//! `sinew explain`.

use crate::sinew::{Ended, SCENE, Workspace};

const FIBRES: &str = "materials.tissue.fibres=(eta: 1000, direction: Around(axis: (0, 0, 1), center: (-1, -1, 0)))";

#[test]
fn only_what_the_scene_calls_for_has_columns() {
    let place = Workspace::new();
    let without = place.done(&["explain", "block.ron", "--backend", "cpu"]);
    let with = place.done(&["explain", "block.ron", "--backend", "cpu", "--set", FIBRES]);
    assert!(!without.contains("fibre_direction") && !without.contains("viscous_memory"), "{without}");
    assert!(with.contains("fibre_direction of block/tissue/Hex8"), "{with}");
    assert!(without.contains("without fibres, without viscosity"), "{without}");
    assert!(with.contains("with fibres, without viscosity"), "{with}");
    let in_f64 = place.done(&["explain", "block.ron", "--backend", "cpu", "--precision", "f64"]);
    assert!(in_f64.contains("which asks for each effect"), "{in_f64}");
}

#[test]
fn contact_says_what_it_looks_at_and_holds() {
    let place = Workspace::new();
    let without = place.done(&["explain", "block.ron", "--backend", "cpu"]);
    assert!(!without.contains("Contact by"), "{without}");
    for precision in ["f32", "f64"] {
        let sets = ["--precision", precision, "--set", "contacts=[Itself(sweeps: 3)]"];
        let said = place.done(&[&["explain", "block.ron", "--backend", "cpu"], &sets[..]].concat());
        for words in ["Contact by surface_contact", "are corrected 3 times", "bytes of lists", "bytes a face"] {
            assert!(said.contains(words), "{words:?} is not in\n{said}");
        }
    }
    let sets = ["tools={\"table\": (shape: Plane(), at: (0, 0, -1))}", "contacts=[Tool(tool: \"table\")]"];
    let said = place.done(&["explain", "block.ron", "--backend", "cpu", "--set", sets[0], "--set", sets[1]]);
    assert!(said.contains("Contact by tool_contact") && said.contains("may be touched by table"), "{said}");
}

#[test]
fn what_moves_freely_holds_or_sucks_says_what_it_looks_at() {
    let ball = "tools={\"ball\": (shape: Sphere(radius: 0.04), at: (0.05, 0.05, 0.15), free: (density: 1000))}";
    let jaws = "tools={\"jaws\": (shape: Sphere(radius: 0.04), at: (0.05, 0.05, 0.11))}";
    let tube = "tools={\"tube\": (shape: Tube(length: 0.1, inner: 0.03, outer: 0.035), at: (0.05, 0.05, 0.105))}";
    for (tool, acts, system, words) in [
        (ball, "contacts=[Tool(tool: \"ball\")]", "free_tool", " nodes of block may be touched by ball"),
        (
            jaws,
            "attachments=[Grasp(tool: \"jaws\", closed: Step(), on: All)]",
            "grasp",
            " 64 nodes of block may be held by jaws",
        ),
        (
            tube,
            "suction=[(tool: \"tube\", pressure: 100, reach: 0.02)]",
            "suction_mouth",
            " 54 faces of block may be in the mouth of tube",
        ),
    ] {
        let said = Workspace::new().done(&["explain", "block.ron", "--backend", "cpu", "--set", tool, "--set", acts]);
        let of = said.split(&format!("\nContact by {system}\n")).nth(1).unwrap_or_else(|| panic!("{system}:\n{said}"));
        assert!(of.split("\n\n").next().unwrap().contains(words), "{words:?} is not in\n{of}");
    }
}

#[test]
fn a_kernel_is_shown_whole() {
    let place = Workspace::new();
    let explain = |more: &[&str]| place.sinew(&[&["explain", "block.ron", "--set", "fuse=false"], more].concat());
    let shown = explain(&["--backend", "gpu", "--kernel", "Gravity"]).said;
    let heading = "// `call_all` of shaders/node_pass.wgsl calls `gravity` of shaders/gravity.wgsl";
    for words in [heading, "// ---- shaders/node_pass.wgsl", "fn node_pass(", "// ---- shaders/gravity.wgsl"] {
        assert_eq!(shown.matches(words).count(), 1, "{words:?} is not once in\n{shown}");
    }
    assert!(!shown.contains("shaders/integrate.wgsl"), "{shown}");
    let unknown = explain(&["--backend", "gpu", "--kernel", "gravty"]);
    unknown.wants(2, &["--kernel gravty: no kernel's label contains that (kernels: ", "integrate"]);
    let on_cpu = explain(&["--backend", "cpu", "--kernel", "gravity"]);
    on_cpu.wants(2, &["would run on the CPU, where there is no WGSL"]);
}

#[test]
fn what_is_off_says_what_turns_it_on() {
    let said = Workspace::new().done(&["explain", "block.ron", "--backend", "cpu"]);
    for words in [
        "off  turned on by `fibres` in the material tissue",
        "off  turned on by `prony` in the material tissue",
        "off  turned on by an entry under `removal` on the body block",
        "pressure          turned on by `Pressure(...)` under `loads`",
        "because: 1 gravity load",
    ] {
        assert!(said.contains(words), "{words:?} is not in\n{said}");
    }
    let viscous = "materials.tissue.prony=(terms: [(alpha: 0.5, tau: 0.1)])";
    let on = Workspace::new().done(&["explain", "block.ron", "--backend", "cpu", "--set", viscous]);
    assert!(on.contains("on   1 Prony term, Exact integrator") && on.contains("viscous_memory"), "{on}");
}

/// With whom a system shares its pass.
fn said_of(json: &serde_json::Value, name: &str) -> Vec<serde_json::Value> {
    let systems = json["systems"].as_array().unwrap().iter();
    systems.filter(|system| system["name"] == name).flat_map(|s| s["shares_with"].as_array().unwrap().clone()).collect()
}

#[test]
fn json_holds_what_the_page_says() {
    let place = Workspace::with_scene(SCENE);
    let text = place.done(&["explain", "block.ron", "--backend", "cpu", "--json"]);
    let json: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!((&json["nodes"], &json["elements"]), (&64.into(), &27.into()));
    let names = |key: &str| {
        let list = json[key].as_array().unwrap().iter();
        list.map(|system| system["name"].as_str().unwrap().to_string()).collect::<Vec<_>>()
    };
    // boundary waits for the systems with which it shares a pass over the nodes
    assert_eq!(names("systems"), ["element_forces", "gather", "gravity", "boundary", "integrate", "observe"]);
    assert!(said_of(&json, "gravity").contains(&"integrate".into()), "{json}");
    assert_eq!(
        names("systems_off"),
        [
            "suction_mouth",
            "suture_tension",
            "nodal_volume",
            "nodal_force",
            "pressure",
            "traction",
            "suction",
            "suture",
            "grab",
            "surface_contact",
            "glue",
            "free_tool",
            "tool_contact",
            "grasp",
            "tool_removal",
            "tool_threshold",
            "island_removal",
            "element_removal"
        ]
    );
    let columns = json["columns"].as_array().unwrap();
    let displacement = columns.iter().find(|column| column["name"] == "displacement").unwrap();
    assert_eq!((&displacement["of"], &displacement["bytes"]), (&"block".into(), &(64 * 3 * 4).into()));
    let sum: u64 = columns.iter().map(|column| column["bytes"].as_u64().unwrap()).sum();
    assert_eq!(json["host_bytes"], sum);
}

/// Kernels are put together and buffers counted where no driver is.
fn on_a_gpu(more: &[&str]) -> serde_json::Value {
    let place = Workspace::new();
    let mut command = place.command(&[&["explain", "block.ron", "--backend", "gpu", "--json"], more].concat());
    command.env("VK_DRIVER_FILES", "/nowhere").env("VK_ICD_FILENAMES", "/nowhere");
    let ended = Ended::of(command.output().unwrap());
    ended.wants(0, &[]);
    serde_json::from_str(&ended.said).unwrap()
}

#[test]
fn kernels_are_shown_with_their_fragments_and_buffers_without_a_gpu() {
    let json = on_a_gpu(&["--set", "fuse=false"]);
    let kernels = json["kernels"].as_array().unwrap();
    let forces = kernels.iter().find(|kernel| kernel["system"] == "element_forces").unwrap();
    assert_eq!(forces["label"], "element_forces of block/tissue/Hex8");
    // one patch; room for 64 nodes with a displacement and a force each
    let counts =
        ["threads", "workgroup", "workgroup_memory", "storage_buffers"].map(|name| forces[name].as_u64().unwrap());
    assert_eq!(counts, [128, 128, 64 * 24, 5]);
    let paths: Vec<&str> =
        forces["fragments"].as_array().unwrap().iter().map(|piece| piece["path"].as_str().unwrap()).collect();
    assert!(paths.contains(&"shaders/patches.wgsl") && !paths.contains(&"shaders/two_pass.wgsl"), "{paths:?}");
    assert!(paths.contains(&"shaders/hex8.wgsl") && paths.contains(&"shaders/neo_hookean.wgsl"), "{paths:?}");
    let displacement =
        &forces["bindings"].as_array().unwrap().iter().find(|b| b["variable"] == "displacement").unwrap();
    assert_eq!((&displacement["access"], &displacement["bytes"]), (&"read".into(), &(64 * 3 * 4).into()));
    let sum: u64 = json["buffers"].as_array().unwrap().iter().map(|buffer| buffer["bytes"].as_u64().unwrap()).sum();
    assert_eq!(json["device_bytes"], sum);
}

#[test]
fn which_bodies_take_many_steps_in_one_dispatch_is_told_with_the_reason() {
    let told = |more: &[&str]| {
        let json = on_a_gpu(more);
        let body = json["dispatched"][0].clone();
        assert_eq!(body["body"], "block");
        let entries: Vec<String> =
            json["kernels"].as_array().unwrap().iter().map(|kernel| kernel["entry"].as_str().unwrap().into()).collect();
        assert_eq!(body["many_steps"].as_bool().unwrap(), entries == ["many_steps"], "{entries:?}");
        let interior = (body["interior"].as_u64().unwrap(), body["interior_because"].as_str().unwrap().to_string());
        let steps = entries.iter().filter(|entry| *entry == "patch_step").count();
        assert_eq!(interior.0 > 0, steps > 0, "{entries:?}");
        (entries.len(), body["because"].as_str().unwrap().to_string(), interior)
    };
    let larger = "bodies.block.mesh=Box(size: (0.1, 0.1, 0.1), cells: (8, 8, 8), elements: Hex8)";
    let removal = "removal=[(body: \"block\", when: VolumeRatioAbove(2))]";
    let pressure = "loads=[Pressure(body: \"block\", on: All, pressure: 1)]";
    let (none, at_once) = ("no other patch has them", "all nodes move in the dispatch of all steps");
    for (more, kernels, because, interior) in [
        (&[][..], 1, "one workgroup of 128 has room for it", (0, at_once)),
        (
            &["--set", "fuse=false"],
            4,
            "`boundary` does not share a pass over the nodes",
            (0, "`gather` does not share a pass over the nodes"),
        ),
        (
            &["--set", larger],
            2,
            "elements of a block are in 3 patches: they are faster in as many workgroups",
            (588, none),
        ),
        (
            &["--scheme", "two-pass"],
            2,
            "its forces are not summed by patches",
            (0, "its forces are not summed by patches"),
        ),
        // the only patch has all nodes
        (&["--set", removal], 5, "`element_removal` does not share a pass over the nodes", (64, none)),
        (
            &["--set", pressure],
            3,
            "`pressure` reads other nodes than its own, which must not have moved",
            (0, "`pressure` reads other nodes than its own, which must not have moved"),
        ),
        (&["--set", FIBRES], 1, "it would need 17 storage buffers, and 16 may be", (64, none)),
    ] {
        let interior = (interior.0, interior.1.to_string());
        assert_eq!(told(more), (kernels, because.to_string(), interior), "{more:?}");
    }
    let page = Workspace::new();
    let mut command = page.command(&["explain", "block.ron", "--backend", "gpu"]);
    command.env("VK_DRIVER_FILES", "/nowhere").env("VK_ICD_FILENAMES", "/nowhere");
    let said = Ended::of(command.output().unwrap()).said;
    assert!(said.contains("block             yes  one workgroup of 128 has room for it"), "{said}");
    assert!(said.contains("block             0  all nodes move in the dispatch of all steps"), "{said}");
}

#[test]
fn a_scene_without_fibres_has_no_fibre_code_and_no_fibre_buffer() {
    let words = |json: &serde_json::Value| format!("{}{}{}", json["kernels"], json["buffers"], json["columns"]);
    let (without, with) = (words(&on_a_gpu(&[])), words(&on_a_gpu(&["--set", FIBRES])));
    assert!(!without.contains("fibre"), "{without}");
    assert!(with.contains("shaders/fibres.wgsl") && with.contains("fibre_direction"), "{with}");
}

/// What a key of systems says, by their names.
fn of_systems(json: &serde_json::Value, key: &str) -> Vec<(String, serde_json::Value)> {
    let systems = json["systems"].as_array().unwrap().iter();
    systems.map(|system| (system["name"].as_str().unwrap().to_owned(), system[key].clone())).collect()
}

#[test]
fn node_systems_say_for_which_nodes_they_are() {
    let place = Workspace::new();
    // two sides of 4 × 4 nodes with an edge of 4 in common, one of them twice
    let force = |on: &str| format!("NodalForce(on: Set(\"{on}\"), force: (1, 0, 0))");
    let forces = ["z1", "x1", "x1"].map(force).join(", ");
    let loads = format!("loads=[Gravity(acceleration: (0, 0, -9.81)), {forces}]");
    let sucks = "suction=[(tool: \"tip\", pressure: 1000, reach: 0.01)]";
    let tip = "tools={\"tip\": (shape: Tube(inner: 0.005, outer: 0.006, length: 0.05), at: (0.05, 0.05, 0.3))}";
    // a set that is fixed needs nothing said anew
    let moved = "constraints=[Prescribed(on: Set(\"z0\"), displacement: (0, 0, 1e-3), curve: Smooth(end: 0.1))]";
    let sets = ["--set", &loads, "--set", tip, "--set", sucks, "--set", moved];
    let explain = [&["explain", "block.ron", "--backend", "cpu"], &sets[..]].concat();
    let json: serde_json::Value = serde_json::from_str(&place.done(&[&explain[..], &["--json"]].concat())).unwrap();
    let all = || serde_json::json!("All");
    let list = |nodes: usize| serde_json::json!({ "List": nodes });
    let nothing = || serde_json::Value::Null;
    let said = of_systems(&json, "rows");
    for (system, rows) in [
        ("boundary", list(16)),
        ("element_forces", nothing()),
        ("gather", all()),
        ("gravity", all()),
        ("nodal_force", list(28)),
        ("suction", serde_json::json!("Changing")),
        ("integrate", all()),
        ("observe", nothing()),
    ] {
        assert!(said.contains(&(system.to_owned(), rows)), "{system}: {said:?}");
    }
    let page = place.done(&explain);
    for words in
        ["for all nodes of its bodies", "for a list of 28 nodes", "for a list of nodes that changes while it runs"]
    {
        assert!(page.contains(words), "{words:?} is not in\n{page}");
    }
}

#[test]
fn what_a_step_repeats_is_told_once_with_its_number() {
    let explained = |sweeps: &str| {
        let contacts = format!("contacts=[Itself({sweeps}friction: 0.3)]");
        let json = on_a_gpu(&["--set", &contacts]);
        let kernels = json["kernels"].as_array().unwrap().iter();
        let of_contact = kernels.filter(|kernel| kernel["system"] == "surface_contact");
        let times = of_contact.map(|kernel| (kernel["entry"].as_str().unwrap().to_owned(), kernel["times"].clone()));
        let repeats = of_systems(&json, "repeat").into_iter().find(|(name, _)| name == "surface_contact").unwrap().1;
        (times.collect::<Vec<_>>(), repeats)
    };
    let what = ["normal forces", "what they do to nodes", "friction", "what it does to nodes"];
    for (sweeps, times, repeats) in [
        ("", 1, serde_json::Value::Null),
        ("sweeps: 3, ", 3, serde_json::json!({ "times": 3, "until": null, "what": what })),
    ] {
        let (found, told) = explained(sweeps);
        let named = |name: &str, times: usize| (format!("surface_contact{name}"), serde_json::json!(times));
        let before = ["_place", "_foresee", "", "_share"].map(|name| named(name, 1));
        let swept = ["_impulse", "_apply", "_friction", "_apply"].map(|name| named(name, times));
        let after = ["_push", "_touch"].map(|name| named(name, 1));
        assert_eq!(found, [&before[..], &swept, &after].concat(), "{sweeps:?}");
        assert_eq!(told, repeats);
    }
    let page =
        Workspace::new().done(&["explain", "block.ron", "--backend", "cpu", "--set", "contacts=[Itself(sweeps: 3)]"]);
    assert!(page.contains("repeat 3 times: normal forces, what they do to nodes\n"), "{page}");
}

/// A path by arc length is followed in f64 only, and `check` had no word for that.
#[test]
fn check_takes_a_precision_and_a_path_by_arc_length_in_f64() {
    let place = Workspace::new();
    let snap = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/snap.ron");
    let said = place.done(&["check", snap]);
    assert!(said.starts_with("sound") && said.contains("path.csv"), "{said}");
    place.sinew(&["check", snap, "--precision", "f32"]).wants(2, &["a path by arc length is followed in f64"]);
    place.done(&["check", "block.ron", "--precision", "f64"]);
}
