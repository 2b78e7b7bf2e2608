//! Scenes made of parts that have parts: what is said of mistakes in these. What could not be read, and names of ports.

use crate::parts::{EYE, WHOLE, brief, files_of, read, with};

/// A part around the eye, with a body and a constraint of its own.
const HEAD: &str = r#"(
    parts: {"eye": (scene: "eye.ron")},
    bodies: {"bone": (mesh: Box(size: (1, 1, 1), cells: (2, 2, 2)), material: "hard")},
    materials: {"hard": (density: 1000, neo_hookean: Young(young: 3e5, poisson: 0.4))},
    constraints: [Fixed(body: "bone", on: Set("z0"))],
)"#;

#[test]
fn mistakes_in_parts_of_parts_are_shown_in_their_files() {
    let whole = r#"(duration: 1, parts: {"head": (scene: "head.ron", rotate: (30, 0, 0))})"#;
    let told = |old: &str, new: &str| {
        assert!(EYE.contains(old), "{old}");
        brief(whole, with(&[("head.ron", HEAD), ("eye.ron", &EYE.replacen(old, new, 1))]), &[])
    };
    // behind the constraint of the part around it
    let axes = "eye.ron:6:68: error: as the part `head` is turned, these axes lie along none of the scene's | hold or \
                move all three, or turn the part by right angles";
    assert_eq!(told("at: 0))]", "at: 0), axes: [X, Z])]"), axes);
    let shape = told("material: \"soft\"", "rest_shape: \"r.msh\", material: \"soft\"");
    let expected = "eye.ron:4:81: error: the part `head` is placed, and a `rest_shape` is not";
    assert!(shape.starts_with(expected) && shape.lines().count() == 1, "{shape}");
    let gravity = told("],\n    probes", ", Gravity(acceleration: (0, 0, 1))],\n    probes");
    let expected = "eye.ron:7:88: error: gravity belongs into the whole scene, not into a part";
    assert!(gravity.starts_with(expected) && gravity.lines().count() == 1, "{gravity}");
}

/// What stands for a load that cannot be read is nobody's.
#[test]
fn a_misspelt_load_of_a_part_is_told_of_as_that_alone() {
    let told = brief(WHOLE, with(&[("eye.ron", &EYE.replace("NodalForce", "NodalForc"))]), &[]);
    assert!(told.starts_with("eye.ron:7:") && told.contains("cannot be `NodalForc`"), "{told}");
    assert!(!told.contains("gravity") && told.lines().count() == 1, "{told}");
}

/// What an instrument does cannot name a body outside of it: of several it is told where they can be named.
#[test]
fn instruments_among_several_bodies_are_told_where_these_are_named() {
    let bodies = r#"bodies: {"c": BODY, "d": BODY},
        materials: {"m": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.4))},
        parts: {"i": (scene: "hook.ron")}"#
        .replace("BODY", r#"(mesh: Box(size: (1, 1, 1), cells: (2, 2, 2)), material: "m")"#);
    let whole = format!("(duration: 1, {bodies})");
    let hook = |body: &str| {
        let hook = r#"(tools: {"tip": (shape: Sphere(radius: 0.3), at: (0, 0, 2))},
            contacts: [Tool(tool: "tip"BODY)], suction: [(tool: "tip"BODY, pressure: 10, bore: 0.1, reach: 0.2)],
            removal: [(when: InTool(tool: "tip", reach: 0.1, rate: 1e-3)BODY)])"#;
        hook.replace("BODY", body)
    };
    let told =
        |whole: &str, hook: &str, head: &str| brief(whole, files_of(&[("hook.ron", hook), ("head.ron", head)]), &[]);
    let all = |told: &str, [what, tool, body]: [&str; 3]| {
        let note = "no part names a body outside of it: leave this entry out of the part, and write it in the \
                    scene around";
        let entries = [
            format!("Tool(tool: \"{tool}\", body: \"{body}\")"),
            format!("(tool: \"{tool}\", body: \"{body}\", ...)"),
            format!("(body: \"{body}\", when: InTool(tool: \"{tool}\", ...))"),
        ];
        let has = |entry: &String| {
            let expected = format!(": error: {what} | {note} | there: {entry}; bodies: ");
            told.lines().any(|line| line.starts_with("hook.ron:") && line.contains(&expected))
        };
        assert!(entries.iter().all(has) && told.lines().count() == 3, "{told}");
    };
    all(&told(&whole, &hook(""), ""), ["which body? The scene has 2", "i.tip", "c"]);
    all(&told(&whole, &hook(", body: \"d\""), ""), ["there is no body `i.d`", "i.tip", "d"]);
    // as it says
    let alone = r#"(tools: {"tip": (shape: Sphere(radius: 0.3), at: (0, 0, 2))})"#;
    let around = whole.replace("(duration: 1,", r#"(duration: 1, contacts: [Tool(tool: "i.tip", body: "c")],"#);
    assert_eq!(told(&around, alone, ""), "");
    // in a part of a part
    let (outer, head) = (r#"(duration: 1, parts: {"head": (scene: "head.ron")})"#, format!("({bodies})"));
    all(&told(outer, &hook(", body: \"d\""), &head), ["there is no body `head.i.d`", "head.i.tip", "head.d"]);
    let said = told(outer, &hook(""), &head);
    let expected = "which body? The part `head` has 2 | `body` is one of: c, d; a part of it names none of them: leave \
                    the entry out there, and write it in the part `head`, of `i.tip`";
    let count = said.lines().filter(|line| line.starts_with("hook.ron:") && line.contains(expected)).count();
    assert!(count == 3 && said.lines().count() == 3, "{said}");
    // who has no part around it names it where it stands
    let own = whole.replace("(duration: 1,", r#"(duration: 1, contacts: [Tool(tool: "i.tip")],"#);
    let said = told(&own, alone, "");
    assert!(said.contains("which body? The scene has 2 | needs `body` | bodies: c, d"), "{said}");
}

#[test]
fn ports_of_parts_are_named_as_all_else_in_them() {
    let whole = r#"(duration: 1,
        bodies: {"b": (mesh: Box(size: (1, 1, 1), cells: (2, 2, 2)), material: "m")},
        materials: {"m": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.4))},
        parts: {"left": (scene: "hook.ron"), "right": (scene: "hook.ron", translate: (1, 0, 0))})"#;
    let hook = r#"(tools: {"tip": (shape: Sphere(radius: 0.3), at: (0, 0, 2), port: (name: "hand", speed: 1))},
        contacts: [Tool(tool: "tip")])"#;
    let files = || files_of(&[("hook.ron", hook)]);
    let told = brief(whole, files(), &[]);
    assert!(!told.contains("port"), "{told}");
    let tools = read(whole, files(), &[]).unwrap().scene.tools;
    let ports: Vec<&str> = tools.values().flat_map(|tool| &tool.port).map(|port| port.name.as_str()).collect();
    assert_eq!(ports, ["left.hand", "right.hand"]);
    // none is none, and no `left.`
    let told = brief(whole, files_of(&[("hook.ron", &hook.replace("hand", ""))]), &[]);
    assert!(told.contains("a port needs a name, by which a program opens it"), "{told}");
}
