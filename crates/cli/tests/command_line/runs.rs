//! `sinew run`.

use crate::sinew::Workspace;

#[test]
fn a_run_leaves_all_its_outputs_and_they_can_be_read() {
    let place = Workspace::new();
    let said = place.done(&["run", "block.ron", "--backend", "cpu"]);
    for words in ["Small block", "CPU (1 thread", "64 nodes, 27 elements", "sinew render out/block", "element_forces"] {
        assert!(said.contains(words), "{words:?} is not in\n{said}");
    }
    let frames = place.frames("out/block");
    assert!(frames.len() >= 20, "{frames:?}");
    assert_eq!(frames[0], 0.0, "the start is observed");
    assert!((frames[frames.len() - 1] - 0.2).abs() < 1e-9, "the end is observed: {frames:?}");
    let top = place.table("out/block/probe_top.csv");
    assert_eq!((top[0][0], top[0][3]), (0.0, 0.0));
    assert!(top[top.len() - 1][3] < -1e-3, "the block does not sag: {top:?}");
    assert!(place.table("out/block/energy.csv").len() >= 5);
    assert_eq!(place.table("out/block/nodes.csv").len(), 64);
    let summary = place.json("out/block/summary.json");
    assert_eq!((&summary["ended"], &summary["nodes"]), (&"finished".into(), &64.into()));
    assert_eq!(summary["steps"], summary["planned_steps"]);
}

/// Places of all numbers of a summary that are no counts; of lists the list's.
fn reals(value: &serde_json::Value, place: &str, found: &mut std::collections::BTreeSet<String>) {
    match value {
        serde_json::Value::Number(number) if number.is_f64() => {
            found.insert(place.to_string());
        }
        serde_json::Value::Array(list) => list.iter().for_each(|value| reals(value, place, found)),
        serde_json::Value::Object(entries) => {
            for (key, value) in entries {
                let below = if place.is_empty() { key.clone() } else { format!("{place}.{key}") };
                reals(value, &below, found);
            }
        }
        _ => {}
    }
}

#[test]
fn a_summary_can_be_read_without_the_manual() {
    let place = Workspace::new();
    for set in ["duration=0.2", "analysis=Static()", "contacts=[Itself()]"] {
        place.done(&["run", "block.ron", "--backend", "cpu", "--set", set]);
        let summary = place.json("out/block/summary.json");
        assert_eq!(summary["version"], env!("CARGO_PKG_VERSION"));
        let units = summary["units"].as_object().unwrap();
        let mut found = std::collections::BTreeSet::new();
        reals(&summary, "", &mut found);
        // units of probes stand with their columns; the scene's are in its reference
        found.retain(|place| !place.starts_with("probes.") && !place.starts_with("parameters."));
        assert!(found.len() > 25, "{found:?}");
        for place in &found {
            let any = place.rsplit_once('.').map(|(before, _)| format!("{before}.*")).unwrap_or_default();
            // of each of what has names of the scene's
            let parts: Vec<&str> = place.splitn(3, '.').collect();
            let of_each = if let [of, _, what] = parts[..] { format!("{of}.*.{what}") } else { String::new() };
            let has_unit = [place, &any, &of_each].into_iter().any(|key| units.contains_key(key));
            assert!(has_unit, "{place} has no unit");
        }
        let contact = &summary["surface_contact"];
        assert_eq!(contact.is_object(), set.starts_with("contacts"), "{contact}");
        if contact.is_object() {
            let number = |key: &str| contact[key].as_f64().unwrap_or_else(|| panic!("{key} of {contact}"));
            assert!(number("builds") >= 1.0 && number("builds_a_second") > 0.0 && number("bytes") > 0.0, "{contact}");
            assert!((0.0..1.0).contains(&number("share")) && number("points") > 0.0, "{contact}");
        }
        let names = &summary["names"];
        assert_eq!((&names["bodies"][0], &names["materials"][0]), (&"block".into(), &"tissue".into()));
        for (file, columns) in names["columns"].as_object().unwrap() {
            let text = place.read(&format!("out/block/{file}"));
            let header: Vec<&str> = text.lines().next().unwrap().split(',').collect();
            let columns: Vec<&str> = columns.as_array().unwrap().iter().map(|c| c[0].as_str().unwrap()).collect();
            assert!(
                header.iter().zip(&columns).all(|(a, b)| a.split(" (").next() == Some(b)),
                "{header:?} {columns:?}"
            );
            assert_eq!(header.len(), columns.len(), "{file}");
        }
        assert!(names["columns"].as_object().unwrap().contains_key("energy.csv"));
        assert_eq!(summary["parameters"]["materials"]["tissue"]["density"], 1000.0);
        assert_eq!(summary["parameters"]["guards"]["every"], 256, "values that were left out, too");
        let [run, solving, writing] =
            ["run_seconds", "solving_seconds", "writing_seconds"].map(|key| summary[key].as_f64().unwrap());
        assert!(writing > 0.0 && solving > 0.0 && (run - solving - writing).abs() <= 1e-9 * run, "{summary}");
        let factor = solving / summary["simulated"].as_f64().unwrap();
        assert!((summary["real_time_factor"].as_f64().unwrap() / factor - 1.0).abs() <= 1e-9, "{summary}");
    }
}

#[test]
#[ignore = "long"]
fn writing_more_is_no_slower_solving() {
    let place = Workspace::new();
    let run = |every: &str| {
        let how = ["run", "block.ron", "--backend", "cpu", "--threads", "1"];
        let set = ["--set", "duration=1", "--set", every, "--set", "output.snapshots_every=0.005"];
        place.done(&[&how[..], &set[..]].concat());
        let summary = place.json("out/block/summary.json");
        ["solving_seconds", "writing_seconds"].map(|key| summary[key].as_f64().unwrap())
    };
    // the best of three, on a machine that does other things too
    let best = |every: &str| (0..3).map(|_| run(every)).min_by(|a, b| a[0].total_cmp(&b[0])).unwrap();
    let ([little, _], [much, writing]) = (best("output.fields_every=1"), best("output.fields_every=1e-9"));
    assert!(writing > much, "a frame costs more than a step of 27 elements: {writing} s, {much} s");
    assert!(much < little + 0.5 * writing, "writing counts as solving: {little} s, {much} s beside {writing} s");
}

#[test]
fn a_scene_at_rest_shows_its_residual_and_how_it_came_down() {
    let place = Workspace::new();
    let set = ["--set", "analysis=Static()", "--set", "probes.top.every=0.2", "--precision", "f64"];
    let said = place.done(&[&["run", "block.ron", "--backend", "cpu"], &set[..]].concat());
    for words in ["rest", "residual", "of loads and reactions", "sought 1e-6", "pseudo-steps", "loads grew over"] {
        assert!(said.contains(words), "{words:?} is not in\n{said}");
    }
    assert_eq!(place.frames("out/block"), [0.0, 0.2], "the start and rest");
    let top = place.table("out/block/probe_top.csv");
    assert_eq!(top.iter().map(|row| row[0]).collect::<Vec<_>>(), [0.0, 0.2]);
    let way = place.table("out/block/convergence.csv");
    let (first, last) = (&way[0], &way[way.len() - 1]);
    assert!(way.len() > 3 && last[2] <= 1e-6 && first[2] > 1e-3 && last[1] == 1.0, "{way:?}");
    let summary = place.json("out/block/summary.json");
    assert_eq!((&summary["ended"], &summary["equilibrium"]["reached"]), (&"finished".into(), &true.into()));
    // the JSON reader rounds a number's last digit as it likes
    let residual = summary["equilibrium"]["residual"].as_f64().unwrap();
    assert!((residual / last[2] - 1.0).abs() <= 2.0 * f64::EPSILON, "{residual:e}, {:e}", last[2]);
    assert_eq!(summary["steps"], last[0]);
    assert!(summary["steps"].as_u64() < summary["planned_steps"].as_u64());
    assert_eq!(summary["energies"]["kinetic"], 0.0);
    assert_eq!(place.table("out/block/nodes.csv").len(), 64);
    let said = place.done(&[&["check", "block.ron"], &set[..2]].concat());
    assert!(said.contains("rest under what acts at 200 ms") && said.contains("convergence.csv"), "{said}");
    let said = place.done(&[&["explain", "block.ron", "--backend", "gpu"], &set[..2]].concat());
    assert!(said.contains("inertial_mass") && said.contains("shaders/relaxation.wgsl"), "{said}");
}

/// Pseudo-steps are no motion: nobody has counted work. What touches is a point, of a face also.
#[test]
fn a_scene_at_rest_says_nothing_of_work_and_bodies_touch_with_points() {
    let place = Workspace::new();
    let lid = "tools={\"lid\": (shape: Box(size: (0.2, 0.2, 0.02)), at: (0.05, 0.05, 0.111), \
               moves: [(displacement: (0, 0, -0.006), curve: Smooth(end: 0.1))])}";
    let run = |more: &str| {
        let sets = ["loads=[]", lid, "contacts=[Tool(tool: \"lid\", thin: true), Itself()]", more];
        let sets: Vec<&str> = sets.into_iter().flat_map(|set| ["--set", set]).collect();
        let said = place.done(&[&["run", "block.ron", "--backend", "cpu"], &sets[..]].concat());
        assert!(said.contains("lid feels (") && said.contains("touches with 0 points"), "{said}");
        (said, place.json("out/block/summary.json"))
    };
    let (said, summary) = run("analysis=Static()");
    assert!(!said.contains("it did") && !said.contains("lost to") && !said.contains("gained by"), "{said}");
    // in f32 it is told, and may be more than what is left
    assert!(said.contains("; rounding alone makes up to "), "{said}");
    for [of, name, what] in [["tools", "lid", "work"], ["tools", "lid", "loss"], ["contacts", "block", "loss"]] {
        assert_eq!(summary[of][name].get(what), Some(&serde_json::Value::Null), "{of}.{name}.{what}");
    }
    assert_eq!(summary["energies"].get("contact_loss"), Some(&serde_json::Value::Null));
    assert!(summary["tools"]["lid"]["force"][2].as_f64() > Some(0.1), "{}", summary["tools"]);
    let (said, summary) = run("duration=0.2");
    assert!(said.contains("; it did ") && said.contains("lost to impact and friction"), "{said}");
    assert!(summary["tools"]["lid"]["work"].as_f64() > Some(0.0), "{}", summary["tools"]);
}

/// What it has sucked did work, too, when it sucks no more.
#[test]
fn a_tool_that_has_sucked_says_what_its_work_leaves_out() {
    let place = Workspace::new();
    let tube = "tools={\"tube\": (shape: Tube(length: 0.1, inner: 0.03, outer: 0.035), at: (0.05, 0.05, 0.105))}";
    let run = |acts: &str| {
        let set = ["--set", tube, "--set", acts, "--set", "duration=0.1"];
        place.done(&[&["run", "block.ron", "--backend", "cpu"], &set[..]].concat())
    };
    let said = run("suction=[(tool: \"tube\", pressure: 100, reach: 0.02, curve: Step(end: 0.05))]");
    let expected = "tube feels (0 N, 0 N, 0 N) of 0 nodes; it did 0 J, the work of what it sucks left out, lost to";
    assert!(said.contains(expected), "{said}");
    let said = run("contacts=[Tool(tool: \"tube\", thin: true)]");
    assert!(said.contains("; it did ") && !said.contains("left out"), "{said}");
}

#[test]
fn values_of_set_reach_the_run_and_the_copy_of_the_scene() {
    let place = Workspace::new();
    let set = ["--set", "bodies.block.mesh.cells=(2, 2, 2)", "--set", "duration=0.1"];
    place.done(&[&["run", "block.ron", "--backend", "cpu", "--out", "here/and/there"], &set[..]].concat());
    let summary = place.json("here/and/there/summary.json");
    assert_eq!(summary["elements"], 8);
    assert!((summary["simulated"].as_f64().unwrap() - 0.1).abs() < 1e-9);
    assert!(place.read("here/and/there/scene.ron").contains("cells: (2, 2, 2)"));
}

#[test]
fn any_number_of_threads_gives_the_same_nodes() {
    let place = Workspace::new();
    let run = |threads: &str| {
        let large = ["--set", "bodies.block.mesh.cells=(14, 14, 14)", "--set", "duration=0.02"];
        let how = ["run", "block.ron", "--backend", "cpu", "--threads", threads];
        let said = place.done(&[&how[..], &large[..]].concat());
        (said, place.read("out/block/nodes.csv"))
    };
    let ((one, alone), (three, together)) = (run("1"), run("3"));
    assert!(one.contains("1 thread,") && three.contains("3 threads"), "{one}{three}");
    assert!(alone == together, "the nodes of 1 and 3 threads differ");
}

#[test]
fn precision_is_chosen_and_said() {
    let place = Workspace::new();
    place.done(&["run", "block.ron", "--precision", "f64", "--out", "f64"]);
    place.done(&["run", "block.ron", "--precision", "f32", "--backend", "cpu", "--out", "f32"]);
    assert_eq!(place.json("f64/summary.json")["precision"], "f64");
    assert_eq!(place.json("f32/summary.json")["precision"], "f32");
    let sag = |out: &str| place.table(&format!("{out}/probe_top.csv")).last().unwrap()[3];
    assert!((sag("f64") - sag("f32")).abs() < 1e-4 * sag("f64").abs());
    assert_ne!(sag("f64"), sag("f32"));
}

#[test]
fn a_second_run_replaces_the_first_and_its_pictures() {
    let place = Workspace::new();
    place.done(&["run", "block.ron", "--backend", "cpu"]);
    place.done(&["render", "out/block", "--no-animation"]);
    let mut before = place.frames("out/block").len();
    assert!(place.path("out/block/picture.png").exists());
    place.done(&["run", "block.ron", "--backend", "cpu", "--set", "output.fields_every=0.1"]);
    assert!(!place.path("out/block/picture.png").exists(), "a picture of another run is left");
    before -= place.frames("out/block").len();
    assert!(before > 10);
}

#[test]
fn check_names_what_sets_the_step_and_what_it_costs() {
    let place = Workspace::new();
    let said = place.done(&["check", "block.ron"]);
    for words in ["true limit:", "the step is ", "elements that set it:", "costs 1 times the steps"] {
        assert!(said.contains(words), "no {words:?} in\n{said}");
    }
    // all of its elements that are held alike are alike
    assert_eq!(said.matches("  element ").count(), 1, "{said}");
    assert!(said.contains("and at least 9 more like it"), "{said}");
    let all = place.done(&["check", "-v", "block.ron"]);
    assert_eq!(all.matches("  element ").count(), 10, "{all}");
    let graded =
        ["--set", "bodies.block.mesh=Tube(inner: 0.01, outer: 0.1, height: 0.1, cells: (6, 8, 2), elements: Hex8)"];
    let graded = place.done(
        &[
            &["check", "block.ron", "--set", "constraints=[Fixed(on: Set(\"bottom\"))]"],
            &graded[..],
            &["--set", "probes={}"],
        ]
        .concat(),
    );
    assert!(graded.contains("elements that set it:"), "{graded}");
    let facts: serde_json::Value = serde_json::from_str(&place.done(&["check", "--json", "block.ron"])).unwrap();
    let number = |path: &str| facts.pointer(path).and_then(|x| x.as_f64()).unwrap();
    assert!(number("/stability/limit") >= number("/stability/bound/time_step"), "{facts}");
    let share = number("/stability/step") / number("/stability/limit");
    assert!((number("/share_of_limit") - share).abs() < 1e-12 && share < 1.0, "{facts}");
    assert_eq!(facts["stability"]["bound"]["worst"].as_array().unwrap().len(), 10);
}

#[test]
fn check_says_between_what_the_true_limit_is_where_few_products_were_worth_their_time() {
    let place = Workspace::new();
    let stability = |integration: &str, duration: &str| {
        let [integration, duration] = [format!("integration=({integration})"), format!("duration={duration}")];
        let arguments = ["check", "block.ron", "--set", integration.as_str(), "--set", duration.as_str()];
        let facts = place.done(&[&arguments[..], &["--json"]].concat());
        let facts: serde_json::Value = serde_json::from_str(&facts).unwrap();
        let number = |name: &str| facts["stability"][name].as_f64().unwrap_or_else(|| panic!("no {name}: {facts}"));
        (number("limit"), number("beyond"), place.done(&arguments))
    };
    let (known, beyond, said) = stability("bound: Iterated", "0.5");
    assert!(known <= beyond && 0.95 * beyond < known, "{known} {beyond}");
    assert!(said.contains("; true limit: ") && !said.contains("true limit: below"), "{said}");
    // long enough to be sought, too short to be sought well
    let (limit, beyond, said) = stability("", "0.12");
    assert!(limit < 0.95 * known && limit < 0.95 * beyond && 0.95 * known < beyond, "{limit} {known} {beyond}");
    assert!(said.contains("true limit: below ") && said.contains("the step is at most 0."), "{said}");
}

#[test]
fn check_tells_what_a_run_will_leave() {
    let place = Workspace::new();
    let said = place.done(&["check", "block.ron"]);
    assert!(said.starts_with("sound: 64 nodes, 27 elements in 1 block;"), "{said}");
    place.done(&["run", "block.ron", "--backend", "cpu"]);
    for (file, rows) in [
        ("fields.pvd", format!("{} frames", place.frames("out/block").len())),
        ("probe_top.csv", format!("{} rows", place.table("out/block/probe_top.csv").len())),
        ("energy.csv", format!("{} rows", place.table("out/block/energy.csv").len())),
    ] {
        assert!(said.contains(&format!("{file} ({rows})")), "{file} ({rows}) is not in\n{said}");
    }
}

#[test]
fn a_resumed_run_ends_in_the_same_numbers() {
    let place = Workspace::new();
    let set = ["--set", "output.snapshots_every=0.05"];
    for precision in ["f32", "f64"] {
        let run = ["run", "block.ron", "--backend", "cpu", "--precision", precision];
        place.done(&[&run[..], &set[..]].concat());
        let names = std::fs::read_dir(place.path("out/block")).unwrap().map(|e| e.unwrap().file_name());
        let mut snapshots: Vec<String> = names.map(|n| n.to_string_lossy().into_owned()).collect();
        snapshots.retain(|name| name.starts_with("snapshot_"));
        snapshots.sort();
        assert_eq!(snapshots.len(), 4, "{snapshots:?}");
        let from = format!("out/block/{}", snapshots[1]);
        let said = place.done(&[&run[..], &set[..], &["--resume", &from]].concat());
        assert!(said.contains("out/block-resumed"), "{said}");
        assert!(place.read("out/block/nodes.csv") == place.read("out/block-resumed/nodes.csv"), "other nodes");
        let (whole, rest) = (place.json("out/block/summary.json"), place.json("out/block-resumed/summary.json"));
        for key in ["steps", "energies", "guards", "simulated"] {
            assert_eq!(whole[key], rest[key], "{key}");
        }
        assert!((rest["resumed_at"].as_f64().unwrap() - 0.1).abs() < 0.01, "{rest}");
        let (whole, rest) = (place.table("out/block/probe_top.csv"), place.table("out/block-resumed/probe_top.csv"));
        assert!(rest[0][0] > 0.09 && rest.len() < whole.len());
        // rows between two steps as well: the last one before the snapshot is not lost
        let after = whole.iter().position(|row| row[0] > rest[0][0]).unwrap();
        assert_eq!(whole[after..], rest[1..]);
        // where nothing is left to do, where it would be cleared, and of another scene
        let last = format!("out/block/{}", snapshots[3]);
        place.sinew(&[&run[..], &set[..], &["--resume", &last]].concat()).wants(2, &["nothing is left"]);
        place
            .sinew(&[&run[..], &["--resume", &from, "--out", "out/block"]].concat())
            .wants(2, &["name another with --out"]);
        assert!(place.path(&from).exists());
        let other = ["--set", "materials.tissue.density=900", "--resume", &from];
        place.sinew(&[&run[..], &other[..]].concat()).wants(2, &["of another simulation", "materials"]);
    }
    std::fs::write(place.path("broken.sinew"), "no snapshot").unwrap();
    place.sinew(&["run", "block.ron", "--resume", "broken.sinew"]).wants(2, &["no snapshot of sinew"]);
    place
        .sinew(&["run", "block.ron", "--resume", "nowhere.sinew"])
        .wants(2, &["cannot read the snapshot nowhere.sinew"]);
}

/// There is no program that would set them: the run says what they stay at.
#[test]
fn inputs_stay_as_they_are_and_the_run_says_so() {
    let place = Workspace::new();
    let set = "loads[0].curve=Input(name: \"tilt\", initial: 0.5)";
    let ended = place.sinew(&["run", "block.ron", "--backend", "cpu", "--set", set]);
    assert_eq!(ended.status, Some(0), "{}", ended.complained);
    assert!(ended.complained.contains("tilt stays at 0.5"), "{}", ended.complained);
    place.done(&["check", "block.ron", "--set", set]);
    let sag = |folder: &str| place.table(&format!("{folder}/probe_top.csv")).last().unwrap()[3];
    let half = sag("out/block");
    place.done(&["run", "block.ron", "--backend", "cpu"]);
    assert!(half < 0.0 && sag("out/block") < 1.2 * half, "{half} m with half the weight");
}

/// Steps are not cut: the end is another, and the report says so where that is more than a hundredth.
#[test]
fn a_run_that_ends_elsewhere_says_so() {
    let place = Workspace::new();
    let of = |word: &str, step: &str| {
        let solver = format!("solver=Implicit(step: {step})");
        let set = ["--set", "duration=0.1", "--set", &solver];
        let device: &[&str] = if word == "run" { &["--backend", "cpu"] } else { &[] };
        place.done(&[&[word, "block.ron"], &set[..], device].concat())
    };
    let told = "at 70 ms, not at the 100 ms of `duration`";
    let said = of("run", "0.07");
    assert!(said.lines().any(|line| line.starts_with("ended") && line.contains(told)), "{said}");
    assert!(of("check", "0.07").contains(told));
    assert!(!of("run", "0.05").contains("ended") && !of("check", "0.05").contains("not at"));
}
