//! Scenes made of parts: names, places, and what is said of mistakes in files of parts.

use sinew::glam::DVec3;
use sinew::scene::schema::{Axis, Constraint, Contact, MeshSource, Probe, Quantity, Select, When};
use sinew::scene::{Allowed, Diagnostics, SceneFile, validate};
use std::collections::BTreeMap;

pub const WHOLE: &str = r#"(
    duration: 0.1,
    parts: {
        "eye": (scene: "eye.ron"),
        "tip": (scene: "tools/tip.ron", translate: (0, 0, 1)),
    },
    contacts: [Tool(tool: "tip.needle", body: "eye.lens")],
)"#;
pub const EYE: &str = r#"// an eye
(
    title: "An eye",
    bodies: {"lens": (mesh: Box(size: (1, 1, 1), cells: (2, 2, 2)), material: "soft")},
    materials: {"soft": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.4))},
    constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))],
    loads: [NodalForce(on: Nodes([26]), force: (0, 0, 1), curve: Input(name: "pull"))],
    probes: {"top": (what: Displacement, on: Set("z1"))},
) // the end"#;
const TIP: &str = r#"(
    tools: {"needle": (shape: Capsule(length: 0.5, radius: 0.1), at: (0, 0, 1))},
    probes: {"force": (what: ToolForce(tool: "needle"))},
)"#;

fn files() -> BTreeMap<String, Vec<u8>> {
    with(&[])
}

/// The files of the parts, some of them others or more.
pub fn with(others: &[(&str, &str)]) -> BTreeMap<String, Vec<u8>> {
    let all = [("eye.ron", EYE), ("tools/tip.ron", TIP)];
    let all = all.iter().chain(others).map(|(name, text)| (name.to_string(), text.as_bytes().to_vec()));
    all.collect()
}

pub fn read(whole: &str, files: BTreeMap<String, Vec<u8>>, sets: &[&str]) -> Result<SceneFile, Diagnostics> {
    let sets: Vec<String> = sets.iter().map(|set| set.to_string()).collect();
    SceneFile::from_memory("whole.ron", whole, files, &sets)
}

/// All complaints, each in a line: with label and notes behind bars.
pub fn brief(whole: &str, files: BTreeMap<String, Vec<u8>>, sets: &[&str]) -> String {
    let found = read(whole, files, sets).map_or_else(
        |wrong| wrong,
        |scene| {
            let mut found = scene.diagnostics();
            validate(&scene, &mut found);
            found
        },
    );
    let told = found.lines().into_iter().zip(found.list()).map(|(line, complaint)| {
        let label = std::iter::once(complaint.label.clone()).filter(|label| !label.is_empty());
        label.chain(complaint.notes.clone()).fold(line, |text, part| format!("{text} | {part}"))
    });
    told.collect::<Vec<_>>().join("\n")
}

#[test]
fn names_of_a_part_begin_with_its_own() {
    assert_eq!(brief(WHOLE, files(), &[]), "");
    let file = read(WHOLE, files(), &[]).unwrap();
    let scene = &file.scene;
    assert!(scene.parts.is_empty());
    assert_eq!(scene.bodies["eye.lens"].material, "eye.soft");
    assert!(scene.materials.contains_key("eye.soft"));
    let names: Vec<&String> = scene.probes.keys().collect();
    assert_eq!(names, ["eye.top", "tip.force"]);
    assert_eq!(scene.probes["tip.force"].what, Quantity::ToolForce { tool: "tip.needle".into() });
    let Constraint::Fixed { body, .. } = &scene.constraints[0] else { panic!() };
    assert_eq!(body.as_deref(), Some("eye.lens"));
    let Contact::Tool { tool, .. } = &scene.contacts[0] else { panic!("a tool") };
    assert!(scene.tools.contains_key(tool));
    assert!(format!("{:?}", scene.loads[0].curve()).contains("eye.pull"));
}

/// An instrument brings what it touches, sucks and takes; the body is that of the scene around it, where there is one.
#[test]
fn an_instrument_without_a_body_acts_on_the_only_one_around_it() {
    let tip = TIP.replace(
        "probes:",
        "contacts: [Tool(tool: \"needle\", friction: 0.1)],
    suction: [(tool: \"needle\", pressure: 10, bore: 0.1, reach: 0.2, curve: Input(name: \"pedal\"))],
    removal: [(when: InTool(tool: \"needle\", reach: 0.1, rate: 1e-3, crumb: 1e-6))], probes:",
    );
    let whole = WHOLE.replace("translate: (0, 0, 1)", "translate: (0, 0, 1), scale: 2").replace("contacts:", "//");
    let files = || with(&[("tools/tip.ron", &tip)]);
    assert_eq!(brief(&whole, files(), &[]), "");
    let scene = read(&whole, files(), &[]).unwrap().scene;
    let (suction, removal) = (&scene.suction[0], &scene.removal[0]);
    assert_eq!((suction.tool.as_str(), suction.body.as_ref(), removal.body.as_ref()), ("tip.needle", None, None));
    assert_eq!((suction.bore, suction.reach, suction.pressure), (Some(0.2), 0.4, 10.0));
    assert!(format!("{:?}", suction.curve).contains("tip.pedal"));
    let When::InTool { tool, reach, rate, crumb, .. } = &removal.when else { panic!() };
    assert_eq!((tool.as_str(), *reach, *rate, *crumb), ("tip.needle", 0.2, Some(1e-3), Some(8e-6)));
    // of two bodies it is asked which, in the instrument's file
    let two = whole.replace("\"tip\":", "\"other\": (scene: \"eye.ron\", translate: (3, 0, 0)),\n        \"tip\":");
    let told = brief(&two, files(), &[]);
    assert_eq!(
        told.lines().filter(|line| line.starts_with("tools/tip.ron:") && line.contains("which body")).count(),
        3,
        "{told}"
    );
}

#[test]
fn a_text_with_its_parts_in_it_needs_no_files_and_is_the_same_scene() {
    let file = read(WHOLE, files(), &["parts.tip.rotate=(0, 90, 0)", "bodies.\"eye.lens\".refine=1"]).unwrap();
    let again = read(file.text(), BTreeMap::new(), &[]).unwrap();
    assert_eq!(again.scene, file.scene);
    assert_eq!(again.text(), file.text());
}

#[test]
fn values_reach_into_parts() {
    let set = |sets: &[&str]| read(WHOLE, files(), sets).unwrap_or_else(|wrong| panic!("{wrong}")).scene;
    let young = "materials.\"eye.soft\".neo_hookean=Young(young: 5e3, poisson: 0.4)";
    assert!(format!("{:?}", set(&[young]).materials["eye.soft"]).contains("5000"));
    let cells = |scene: &sinew::scene::schema::Scene| match scene.bodies["eye.lens"].mesh {
        MeshSource::Box { cells, .. } => cells,
        _ => panic!(),
    };
    assert_eq!(cells(&set(&["bodies.\"eye.lens\".mesh.cells=(3, 3, 3)"])), (3, 3, 3));
    assert_eq!(cells(&set(&["parts.eye.content.bodies.lens.mesh.cells=(4, 3, 3)"])), (4, 3, 3));
    assert_eq!(cells(&set(&["parts.eye.set={\"bodies.lens.mesh.cells\": (5, 3, 3)}"])), (5, 3, 3));
    assert_eq!(set(&["bodies.\"eye.lens\".refine=2"]).bodies["eye.lens"].refine, 2);
    // a value for a part goes before what the part says, one of the command line before both
    let whole = WHOLE.replace("\"eye.ron\"", "\"eye.ron\", set: {\"bodies.lens.mesh.cells\": (6, 6, 6)}");
    assert_eq!(cells(&read(&whole, files(), &[]).unwrap().scene), (6, 6, 6));
    assert_eq!(cells(&read(&whole, files(), &["bodies.\"eye.lens\".mesh.cells=(7, 6, 6)"]).unwrap().scene), (7, 6, 6));
    let other = read(WHOLE, with(&[("other.ron", TIP)]), &["parts.tip.scene=other.ron"]).unwrap();
    assert!(other.text().contains("\"other.ron\""));
    // lists of parts follow those of the scene
    let more = read(WHOLE, files(), &["constraints[0].axes=[X]"]).unwrap();
    assert!(matches!(&more.scene.constraints[0], Constraint::Fixed { axes, .. } if axes == &[Axis::X]));
}

#[test]
fn parts_have_parts_with_files_beside_them_and_values_for_these() {
    let head = r#"(parts: {"left": (scene: "bits/bit.ron"), "right": (scene: "bits/bit.ron",
        translate: (1, 0, 0), set: {"tools.bit.shape": Sphere(radius: 2), "parts.deep.scale": 3})})"#;
    let bit = r#"(tools: {"bit": (shape: Sphere(radius: 1), at: (0, 0, 1))},
        parts: {"deep": (scene: "../deep.ron")})"#;
    let deep = r#"(tools: {"end": (mesh: (path: "end.stl"), at: (0, 0, 1))})"#;
    let whole = r#"(duration: 1, parts: {"head": (scene: "tools/head.ron", scale: 2, rotate: (0, 90, 0),
        set: {"parts.left.translate": (0, 1, 0), "tools.\"right.bit\".rounding": 0.5})})"#;
    let files = [("tools/head.ron", head), ("tools/bits/bit.ron", bit), ("tools/deep.ron", deep)];
    let files = files.iter().map(|(name, text)| (name.to_string(), text.as_bytes().to_vec())).collect();
    let scene = read(whole, files, &[]).unwrap_or_else(|wrong| panic!("{wrong}"));
    let tools = &scene.scene.tools;
    let names: Vec<&String> = tools.keys().collect();
    assert_eq!(names, ["head.left.bit", "head.left.deep.end", "head.right.bit", "head.right.deep.end"]);
    assert_eq!(format!("{:?}", tools["head.right.bit"].shape), "Some(Sphere { radius: 4.0 })");
    assert_eq!((tools["head.right.bit"].rounding, tools["head.left.bit"].rounding), (1.0, 0.0));
    let near = |name: &str, expected: DVec3| {
        let at = tools[name].at.unwrap();
        assert!(at.distance(expected) < 1e-15, "{name}: {at}");
    };
    // z of the head is x of the scene, and its x is -z
    near("head.left.bit", DVec3::new(2.0, 2.0, 0.0));
    near("head.right.bit", DVec3::new(2.0, 0.0, -2.0));
    near("head.right.deep.end", DVec3::new(6.0, 0.0, -2.0));
    let mesh = tools["head.right.deep.end"].mesh.as_ref().unwrap();
    assert_eq!((shortest(&mesh.path), mesh.scale), ("tools/end.stl".into(), 6.0));
}

fn shortest(path: &str) -> String {
    path.replace("bits/../", "")
}

#[test]
fn mistakes_in_parts_are_shown_in_their_files() {
    let cases = [
        (EYE, "3e3, poisson", "3e3, poison", "eye.ron:5:72: error: unknown field `poison` | not a field of Young"),
        (EYE, "\"soft\")", "\"soft\", spin: 3)", "eye.ron:4:93: error: `spin` must be 3 values in round brackets"),
        (EYE, "density: 1000", "density: -1", "eye.ron:5:35: error: `density` must be above 0, found -1 kg/m³"),
        (EYE, "material: \"soft\"", "material: \"sof\"", "eye.ron:4:79: error: there is no material `eye.sof`"),
        (EYE, "title:", "duration: 3, title:", "eye.ron:3:5: error: `duration` belongs into the whole scene"),
        (EYE, "(0, 0, 1), at", "(0, 0, 0), at", "eye.ron:6:43: error: `normal` has no direction"),
        (EYE, "\"lens\":", "\"l.ens\":", "eye.ron:4:23: error: the name `l.ens` in a part has a dot"),
        (
            EYE,
            "],\n    probes",
            ", Gravity(acceleration: (0, 0, 1))],\n    probes",
            "eye.ron:7:88: error: gravity belongs",
        ),
        (EYE, ") // the end", " // the end", "eye.ron:9:12: error: the file ends too early | the end of the file"),
        (TIP, "\"needle\"))", "\"nedle\"))", "tools/tip.ron:3:46: error: there is no tool `tip.nedle`"),
        (TIP, "probes:", "removal: [(when: At(1))], probes:", "tools/tip.ron:3:15: error: the part `tip` has no body"),
        (TIP, "radius: 0.1", "radius: 0.1e", "tools/tip.ron:2:60: error: `0.1e` is not a number"),
    ];
    let mut wrong = Vec::new();
    for (file, old, new, expected) in cases {
        let name = if file == EYE { "eye.ron" } else { "tools/tip.ron" };
        assert!(file.contains(old), "{old}");
        let told = brief(WHOLE, with(&[(name, &file.replacen(old, new, 1))]), &[]);
        if !told.lines().any(|line| line.starts_with(expected)) {
            wrong.push(format!("{new}: {told}\nexpected {expected}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
    let shown = read(WHOLE, with(&[("eye.ron", &EYE.replace("poisson", "poison"))]), &[]).unwrap_err().to_string();
    assert!(shown.contains("eye.ron:5:72") && shown.contains("5 │     materials: {\"soft\""), "{shown}");
}

#[test]
fn mistakes_around_parts_are_shown_where_the_part_is_named() {
    let cases = [
        ("\"eye.ron\"", "\"ey.ron\"", "whole.ron:4:24: error: there is no file `ey.ron` | did you mean `eye.ron`?"),
        ("\"eye.ron\"", "\"\"", "whole.ron:4:24: error: the path of the part is empty"),
        ("scene: \"eye.ron\"", "", "whole.ron:4:16: error: the part `eye` has no `scene`"),
        (
            "scene: \"eye.ron\"",
            "scale: 0, scene: \"eye.ron\"",
            "whole.ron:4:24: error: `scale` must be above 0, found 0",
        ),
        ("\"eye\":", "\"e.ye\":", "whole.ron:4:17: error: the part `e.ye` needs another name"),
        (
            "\"eye.ron\"",
            "\"eye.ron\", set: {\"bodies.len.refine\": 1}",
            "whole.ron:4:41: error: `set`: there is no `len` in `bodies` | did you mean `lens`?",
        ),
        (
            "\"eye.ron\"",
            "\"eye.ron\", set: {\"bodies.lens.refine\": -1}",
            "whole.ron:4:63: error: `refine` must be a whole number, 0 or above, found -1",
        ),
        ("\"eye.ron\"", "\"eye.ron\", set: {\"bodies.lens.refin\": 1}", "whole.ron:4:54: error: unknown field `refin`"),
        (
            "duration: 0.1,",
            "duration: 0.1, materials: {}, tools: {\"tip.needle\": (shape: Plane())},",
            "tools/tip.ron:2:23: error: `tip.needle` is in the scene already",
        ),
        (
            "body: \"eye.lens\"",
            "body: \"eye.len\"",
            "whole.ron:7:47: error: there is no body `eye.len` | did you mean `eye.lens`?",
        ),
    ];
    let mut wrong = Vec::new();
    for (old, new, expected) in cases {
        assert!(WHOLE.contains(old), "{old}");
        let told = brief(&WHOLE.replacen(old, new, 1), files(), &[]);
        if !told.lines().any(|line| line.starts_with(expected)) {
            wrong.push(format!("{new}: {told}\nexpected {expected}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
    let told = brief(WHOLE, files(), &["parts.eye.scene=ey.ron"]);
    assert!(told.starts_with("--set:1:17: error: there is no file `ey.ron`"), "{told}");
    let told = brief(WHOLE, files(), &["bodies.\"eye.lenz\".refine=1"]);
    assert!(told.contains("there is no `eye.lenz` in `bodies` | did you mean `eye.lens`?"), "{told}");
    let told = brief(WHOLE, files(), &["bodies.cube=(refine: 1)"]);
    assert!(told.contains("--set bodies.cube=(refine: 1): only parts have such"), "{told}");
    let told = brief(WHOLE, files(), &["probes={}"]);
    let expected = "--set probes={}: only parts have such: there is no `probes` in the scene to be changed as a whole | \
                    what is in it can be changed, or what a part brings: `parts.NAME.content.probes`";
    assert!(told.contains(expected), "{told}");
    let told = brief(WHOLE, files(), &["bodies.eye.lens.refine=1"]);
    assert!(told.contains("there is no `eye` in `bodies` | names with dots stand in quotes: `\"eye.lens\"`"), "{told}");
    // as it says
    let scene = read(WHOLE, files(), &["parts.tip.content.probes={}"]).unwrap();
    assert_eq!(scene.scene.probes.keys().collect::<Vec<_>>(), ["eye.top"]);
}

#[test]
fn circles_and_towers_of_parts_are_refused() {
    let part = |name: &str| format!("(parts: {{\"p\": (scene: \"{name}\")}})");
    let circle = with(&[("eye.ron", &part("tools/a.ron")), ("tools/a.ron", &part("../eye.ron"))]);
    let told = brief(WHOLE, circle, &[]);
    let expected = "tools/a.ron:1:23: error: `eye.ron` is a part of itself | eye.ron → tools/a.ron → eye.ron";
    assert_eq!(told, expected);
    let told = brief(WHOLE, with(&[("eye.ron", &part("whole.ron"))]), &[]);
    assert!(told.contains("eye.ron:1:23: error: `whole.ron` is a part of itself"), "{told}");
    let tower: Vec<(String, String)> = (0..20).map(|i| (format!("{i}.ron"), part(&format!("{}.ron", i + 1)))).collect();
    let mut tower: Vec<(&str, &str)> = tower.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect();
    let first = part("0.ron");
    tower.push(("eye.ron", &first));
    let told = brief(WHOLE, with(&tower), &[]);
    assert_eq!(told, "6.ron:1:23: error: parts of parts of parts: at most 8 within each other are allowed");
    // each of many holds many: refused before it fills the memory
    let many: String = (0..40).map(|i| format!("\"{i}\": (scene: \"many.ron\"),")).collect();
    let many = |name: &str| format!("(parts: {{{}}})", many.replace("many.ron", name));
    let files = with(&[("eye.ron", &many("b.ron")), ("b.ron", &many("tools/tip.ron"))]);
    assert!(brief(WHOLE, files, &[]).contains("the scene has more than 1000 parts, the most that are allowed"));
    let deep = format!("({}", "parts: {\"a\": (content: (".repeat(100));
    let told = brief(&deep, files_of(&[]), &[]);
    assert!(told.contains("brackets are nested more than 64 deep"), "{told}");
    let deep = format!("(duration: 1, {}{})", "parts: {\"a\": (content: (".repeat(15), "))}".repeat(15));
    let told = brief(&deep, files_of(&[]), &[]);
    assert!(told.contains("at most 8 within each other are allowed"), "{told}");
}

pub fn files_of(files: &[(&str, &str)]) -> BTreeMap<String, Vec<u8>> {
    files.iter().map(|(name, text)| (name.to_string(), text.as_bytes().to_vec())).collect()
}

#[test]
fn axes_turn_by_right_angles_and_by_no_others() {
    let fixed = EYE.replace("at: 0))]", "at: 0), axes: [X, Z])]");
    let turned = |by: &str| WHOLE.replace("\"eye.ron\"", &format!("\"eye.ron\", rotate: {by}"));
    let file = read(&turned("(90, 0, 0)"), with(&[("eye.ron", &fixed)]), &[]).unwrap();
    let Constraint::Fixed { on, axes, .. } = &file.scene.constraints[0] else { panic!() };
    assert_eq!(axes, &[Axis::X, Axis::Y]);
    let Select::Plane { normal, .. } = on else { panic!() };
    assert!(normal.distance(DVec3::NEG_Y) < 1e-15, "{normal}");
    let told = brief(&turned("(30, 0, 0)"), with(&[("eye.ron", &fixed)]), &[]);
    let expected = "eye.ron:6:68: error: as the part `eye` is turned, these axes lie along none of the scene's | hold or move all \
                    three, or turn the part by right angles";
    assert_eq!(told, expected);
    assert_eq!(brief(&turned("(30, 0, 0)"), files(), &[]), "");
}

#[test]
fn what_is_not_placed_keeps_its_bits() {
    let whole = WHOLE.replace(", translate: (0, 0, 1)", "");
    let plain = read(&whole, files(), &[]).unwrap().scene;
    assert_eq!(plain.tools["tip.needle"].at, Some(DVec3::Z));
    assert_eq!(plain.tools["tip.needle"].rotation, None);
    let Probe { on, .. } = &plain.probes["eye.top"];
    assert_eq!(on, &Some(Select::Set("z1".into())));
}

#[test]
fn parts_with_any_letter_missing_or_another_are_read_or_refused() {
    let whole = WHOLE.replace("\"eye.ron\"", "\"eye.ron\", rotate: (0, 0, 90), set: {\"bodies.lens.refine\": 1}");
    let mut texts = Vec::new();
    for (file, text) in [("whole.ron", whole.as_str()), ("eye.ron", EYE)] {
        for at in (0..text.len()).filter(|at| text.is_char_boundary(*at) && text.is_char_boundary(at + 1)) {
            for new in ["", "(", ")", "{", "\"", ",", ".", "-", "9"] {
                texts.push((file, format!("{}{new}{}", &text[..at], &text[at + 1..])));
            }
        }
    }
    for (file, text) in &texts {
        let of_part = with(&[("eye.ron", if *file == "eye.ron" { text } else { EYE })]);
        let found = read(if *file == "eye.ron" { &whole } else { text }, of_part, &[]);
        match found {
            Err(wrong) => assert!(wrong.has_errors() && wrong.render(true).len() > 20, "{text}"),
            Ok(scene) => {
                let mut told = scene.diagnostics();
                validate(&scene, &mut told);
                assert_eq!(told.lines().len(), told.list().len());
                assert_eq!(read(scene.text(), BTreeMap::new(), &[]).unwrap().scene, scene.scene, "{text}");
            }
        }
    }
}

#[test]
fn parts_on_a_disk_are_beside_the_scene_or_below() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    std::fs::create_dir_all(at("scenes/tools")).unwrap();
    std::fs::write(at("scenes/whole.ron"), WHOLE).unwrap();
    std::fs::write(at("scenes/eye.ron"), EYE).unwrap();
    std::fs::write(at("tip.ron"), TIP).unwrap();
    let load = |allowed: Allowed, set: &str| {
        let sets: Vec<String> = [set].iter().filter(|set| !set.is_empty()).map(|set| set.to_string()).collect();
        SceneFile::load_allowing(at("scenes/whole.ron"), &sets, allowed).map_err(|wrong| wrong.lines().join("\n"))
    };
    let told = load(Allowed::default(), "").unwrap_err();
    assert!(told.ends_with("whole.ron:5:24: error: there is no file `tools/tip.ron`"), "{told}");
    let outside = "parts.tip.scene=../tip.ron";
    let told = load(Allowed::default(), outside).unwrap_err();
    assert_eq!(told, "--set:1:17: error: `../tip.ron` lies outside the scene's folder");
    assert!(load(Allowed::files_anywhere(), outside).unwrap().scene.tools.contains_key("tip.needle"));
    let absolute = format!("parts.tip.scene={}", at("tip.ron").display());
    assert!(load(Allowed::files_anywhere(), &absolute).unwrap().scene.tools.contains_key("tip.needle"));
    let told = load(Allowed::default(), "parts.tip.scene=tools").unwrap_err();
    assert!(told.contains("the part `tools` cannot be read"), "{told}");
    std::fs::write(at("scenes/tools/tip.ron"), [0xff, 0xfe, 0x00]).unwrap();
    assert!(load(Allowed::default(), "").unwrap_err().contains("`tools/tip.ron` is not a text in UTF-8"));
    std::fs::write(at("scenes/tools/tip.ron"), TIP).unwrap();
    let file = load(Allowed::default(), "").unwrap();
    assert_eq!(file.parts(), [("eye", "eye.ron"), ("tip", "tools/tip.ron")]);
}

#[test]
fn lists_of_parts_are_told_of_in_the_files_that_they_come_from() {
    let whole = "(duration: 1, parts: {\"z\": (scene: \"bad.ron\"), \"a\": (scene: \"eye.ron\")})";
    let bad = EYE.replace("normal: (0, 0, 1)", "normal: (0, 0, 0)");
    let told = brief(whole, with(&[("bad.ron", &bad)]), &[]);
    assert!(told.starts_with("bad.ron:6:43: error: `normal` has no direction"), "{told}");
}
