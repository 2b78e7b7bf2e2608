//! Tools that cannot be, go nowhere, go too fast, or stand in the way.

use crate::complaints::told_of;

/// An open tetrahedron.
const OPEN: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\n";

/// What is said of a tool and its contact, each complaint in one line without its place in the line.
pub fn told(tool: &str, contact: &str, more: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("open.obj"), OPEN).unwrap();
    let text = format!(
        "(duration: 0.1, bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (4, 4, 4)), material: \"m\")}},
materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}},
constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))], {more}
tools: {{\"rod\": {tool}}},
contacts: [{contact}])"
    );
    told_of(&text, folder.path())
}

pub const ROD: &str = "(shape: Capsule(length: 0.2, radius: 0.06), at: (0.05, 0.05, 0.11))";
pub const TOUCH: &str = "Tool(tool: \"rod\")";

#[test]
fn a_good_tool_has_no_complaints() {
    assert_eq!(told(ROD, TOUCH, ""), "");
}

/// Pseudo-steps are no way that something slides along.
#[test]
fn a_static_analysis_has_no_lengths_of_slides() {
    let asks =
        "probes: {\"way\": (what: ContactSlip, on: Set(\"z1\"))}, output: (fields: [Displacement, ContactSlip]),";
    assert_eq!(told(ROD, TOUCH, asks), "");
    let found = told(ROD, TOUCH, &format!("analysis: Static(), {asks}"));
    let errors: Vec<&str> = found.lines().filter(|line| line.starts_with("3: error: ")).collect();
    let is_told = |line: &&str| line.contains("a static analysis has no `ContactSlip` | it is the length");
    assert!(errors.len() == 2 && errors.iter().all(is_told), "{found}");
    let others = asks.replace("ContactSlip", "ContactGap");
    assert!(!told(ROD, TOUCH, &format!("analysis: Static(), {others}")).contains("error"), "{others}");
}

#[test]
fn what_is_wrong_with_a_tool_is_told_with_what_is_allowed() {
    let cases = [
        ("(at: (0, 0, 1))", TOUCH, "4: error: the tool has no `shape` | a tool has either a `shape` or a `mesh`"),
        (
            "(shape: Sphere(radius: 0.1), mesh: (path: \"open.obj\"))",
            TOUCH,
            "4: error: a `mesh` beside a `shape` | a tool has either a `shape` or a `mesh`",
        ),
        (
            "(shape: Sphere(radius: -0.1), at: (0, 0, 1))",
            TOUCH,
            "4: error: `radius` must be between 1e-9 m and 1e6 m, found -0.1 m",
        ),
        (
            "(shape: Sphere(radius: 0.1), at: (0, 0, 1), path: [(t: 0, at: (0, 0, 1))])",
            TOUCH,
            "4: error: `at` beside a `path`, which says where the tool is at all times | leave one of both out; `moves` may be \
             added to a path",
        ),
        (
            "(shape: Sphere(radius: 0.1), path: [(t: 0, at: (0, 0, 1)), (t: 0, at: (0, 0, 2))])",
            TOUCH,
            "4: error: places are in the order of time: after 0 s this is 0 s | the tool would jump by 1 m; give \
             it time to go there",
        ),
        (
            "(shape: Sphere(radius: 0.1), path: [(t: 0, at: (0, 0, 0.5)), (t: 1e-4, at: (0, 0, 0.3))])",
            TOUCH,
            "the tool `rod` goes up to 2.000e3 m/s",
        ),
        (
            "(shape: Capsule(length: 0.2, radius: 0.06), at: (0.05, 0.05, 0.17), pivot: (0.05, 0.05, 0.17))",
            TOUCH,
            "4: error: the tool's origin may come to its pivot: which way would its axis point there? | the axis z goes from the",
        ),
        (
            "(shape: Capsule(length: 0.2, radius: 0.06), pivot: (0.05, 0.05, 0.3), path: [(t: 0, at: (0.05, 0.05, 0.2)), \
             (t: 0.1, at: (0.05, 0.05, 0.4))])",
            TOUCH,
            "4: error: the tool's origin may come to its pivot: which way would its axis point there?",
        ),
        (
            "(shape: Capsule(length: 0.2, radius: 0.06), at: (0.05, 0.05, 0.5), pivot: (0.05, 0.05, 0.3))",
            TOUCH,
            "4: error: the tool would be turned by 180 degrees for its axis to go through this | 120 degrees are allowed",
        ),
        (
            "(shape: Capsule(length: 0.2, radius: 0.06), at: (0.05, 0.05, 0.2), pivot: (0.05, 0.05, 0.5), \
             moves: [(rotation: (150, 0, 0), curve: Smooth(end: 0.1))])",
            TOUCH,
            "4: error: the tool would be turned by up to 150 degrees for its axis to go through this | 120 degrees are",
        ),
        (
            "(shape: Sphere(radius: 0.06), at: (0.05, 0.05, 0.2), pivot: (0, 0, 1), port: (name: \"h\", speed: 0.1))",
            TOUCH,
            "4: error: a `pivot` beside a `port`: a hand turns the tool | leave one of both out; `path` and `moves` go with",
        ),
        (ROD, "", "4: warning: nothing touches the tool `rod` | under `contacts`: Tool(tool: \"rod\")"),
        (ROD, "Tool(tool: \"rot\")", "there is no tool `rot` | did you mean `rod`?"),
        (ROD, "Tool(tool: \"rod\", friction: -0.1)", "5: error: `friction` must be 0 or above, found -0.1"),
        (
            ROD,
            "Tool(tool: \"rod\", friction: 0.3, static_friction: 0.2)",
            "what sticks is held at least as well as what slides",
        ),
        (ROD, "Tool(tool: \"rod\", on: Set(\"lid\"))", "the mesh has no set named \"lid\""),
        (
            "(shape: Capsule(length: 0.2, radius: 0.06), at: (0.05, 0.05, 0.095))",
            TOUCH,
            "inside the tool `rod` at the start, the deepest by 5.000e-3 m | nodes: ",
        ),
        (
            "(shape: Capsule(length: 0.2, radius: 0.06), at: (0.05, 0.05, 0.05))",
            TOUCH,
            "4: error: 21 nodes of `b` are inside the tool `rod` at the start, the deepest by 5.000e-2 m",
        ),
        ("(mesh: (path: \"open.obj\"))", TOUCH, "4: error: open.obj: "),
        ("(mesh: (path: \"none.obj\"))", TOUCH, "there is no file `none.obj`"),
        (
            "(shape: Capsule(length: 0.2, radius: 0.01), at: (0.05, 0.05, 0.11))",
            TOUCH,
            "4: warning: the tool `rod` may slip between nodes: it is hardly thicker than the faces that it meets | half of its \
             thickness is 1.000e-2 m, and faces of `b` have edges of 2.845e-2 m | give `b` edges of 5.0e-3 m or less where it is touched \
             (more cells, `refine`), or take a thicker tool; `thin: true` in the contact says that this is meant",
        ),
        (
            "(shape: Sphere(radius: 0.1), at: (0.05, 0.05, 0.3), moves: [(curve: Smooth(end: 1))])",
            TOUCH,
            "4: warning: this moves nothing | give `displacement` or `rotation`",
        ),
        (
            "(shape: Sphere(radius: 0.1), at: (0.05, 0.05, 0.3), moves: [(displacement: (0, 0, -0.1), curve: Step(start: 0.05))])",
            TOUCH,
            "4: warning: the tool jumps",
        ),
    ];
    for (tool, contact, expected) in cases {
        let found = told(tool, contact, "");
        println!("{found}");
        assert!(found.contains(expected), "{tool} {contact}:\n{found}\nexpected\n{expected}");
    }
}

/// About its own axis a shaft may turn as often as it is to.
#[test]
fn a_shaft_that_spins_in_its_pivot_has_no_complaints() {
    let shaft = "(shape: Capsule(length: 0.2, radius: 0.06), at: (0.05, 0.05, 0.2), pivot: (0.05, 0.05, 0.5), \
        moves: [(rotation: (0, 0, 3600), curve: Smooth(end: 0.1))])";
    let found = told(shaft, TOUCH, "");
    assert!(!found.contains("degrees"), "{found}");
}

#[test]
fn a_thin_tool_that_is_meant_is_not_warned_of() {
    let thin = "(shape: Capsule(length: 0.2, radius: 0.01), at: (0.05, 0.05, 0.11))";
    assert_eq!(told(thin, "Tool(tool: \"rod\", thin: true)", ""), "");
}

#[test]
fn friction_in_a_static_analysis_is_warned_of() {
    let found = told(ROD, "Tool(tool: \"rod\", friction: 0.3)", "analysis: Static(),");
    assert!(found.contains("rest with friction depends on the way there"), "{found}");
    assert!(found.contains("take some 400 for each edge of its way"), "{found}");
    let found = told(ROD, "Tool(tool: \"rod\", friction: 0.3)", "analysis: Static(method: Newton),");
    assert!(!found.contains("load_steps"), "{found}");
}

#[test]
fn what_is_wrong_with_a_port_is_told_with_what_is_allowed() {
    let port = |words: &str, more: &str| {
        format!("(shape: Sphere(radius: 0.06), at: (0.05, 0.05, 0.2), port: ({words}) {more})")
    };
    assert_eq!(told(&port("name: \"hand\", speed: 0.1", ""), TOUCH, ""), "");
    let cases = [
        (
            "speed: 0.1",
            "",
            "4: error: the field `name` is missing in `port` | name: Its name, by which a program opens it.",
        ),
        ("name: \"\", speed: 0.1", "", "4: error: a port needs a name, by which a program opens it"),
        ("name: \"h\", speed: 0", "", "4: error: `speed` must be above 0, found 0 m/s"),
        ("name: \"h\", speed: 1, spin: -1", "", "4: error: `spin` must be above 0, found -1 degrees a second"),
        ("name: \"h\", speed: 1, every: 0", "", "4: error: `every` must be above 0, found 0 s"),
        (
            "name: \"h\", speed: 1, follow: Proxy(stiffness: 0)",
            "",
            "4: error: `stiffness` must be above 0, found 0 N/m",
        ),
        (
            "name: \"h\", speed: 1, follow: Proxy(stiffness: 1, damping: -1)",
            "",
            "4: error: `damping` must be 0 or above, found -1 N s/m",
        ),
        ("name: \"h\", speed: 1, follow: Pull", "", "`follow` cannot be `Pull`"),
        ("name: \"h\", speed: 100", "", "4: error: the tool `rod` goes up to 1.0"),
        (
            "name: \"h\", speed: 1",
            ", moves: [(displacement: (0, 0, 1))]",
            "4: error: a `port` beside `moves`: a hand moves the tool, and nobody else | leave one of both out; \
             `at` says where the tool is at first",
        ),
    ];
    for (words, more, expected) in cases {
        let found = told(&port(words, more), TOUCH, "");
        assert!(found.contains(expected), "{words}{more}:\n{found}\nexpected\n{expected}");
    }
    let found = told(&port("name: \"h\", speed: 1", ""), TOUCH, "analysis: Static(),");
    assert!(found.contains("4: warning: the tool stays where it is: in a static analysis"), "{found}");
    let two = format!("{}, \"tip\": {}", port("name: \"h\", speed: 1", ""), port("name: \"h\", speed: 1", ""));
    let found = told(&two, "Tool(tool: \"rod\"), Tool(tool: \"tip\")", "");
    assert!(found.contains("4: error: `rod` has the port `h` already | a device moves one tool"), "{found}");
}

#[test]
fn probes_of_tools_name_one_that_is_there_and_no_nodes() {
    let of = |probe: &str| told(ROD, TOUCH, &format!("probes: {{\"p\": ({probe})}},"));
    assert_eq!(of("what: ToolForce(tool: \"rod\")"), "");
    assert!(of("what: ToolForce(tool: \"ro\")").contains("there is no tool `ro` | did you mean `rod`?"));
    assert!(of("what: ToolTorque(tool: \"rod\"), on: All").contains("what a tool feels is of the whole tool"));
    // as if it were what one of several bodies feels
    assert!(of("what: ToolForce(tool: \"rod\"), body: \"b\"").contains("is of the whole tool | leave `body` out"));
    assert!(of("what: Displacement").contains("the probe `p` lacks `on`"));
}

#[test]
fn what_is_wrong_with_a_free_tool_is_told_with_what_is_allowed() {
    let ball = |rest: &str| format!("(shape: Sphere(radius: 0.06), at: (0.05, 0.05, 0.17), {rest})");
    let either = "a free tool has either a `mass` (kg) or a `density` (kg/m³)";
    let cases = [
        ("free: ()", format!("4: error: how heavy is it? | {either}")),
        ("free: (mass: 1, density: 1000)", format!("4: error: a `density` beside a `mass` | {either}")),
        ("free: (mass: 0)", "4: error: `mass` must be above 0, found 0 kg".into()),
        ("free: (density: -1)", "4: error: `density` must be above 0, found -1 kg/m³".into()),
        ("free: (mass: 1, damping: -1)", "4: error: `damping` must be 0 or above, found -1 1/s".into()),
        ("free: (mass: 1, inertia: (1, 1, 0))", "4: error: `inertia` must be above 0 kg m² along each axis".into()),
        ("free: (mass: 1, inertia: (1, 1, 3))", "4: error: no body has such moments of inertia".into()),
        (
            "free: (mass: 1), moves: [(displacement: (0, 0, 1), curve: Smooth(end: 1))]",
            "4: error: `free` beside `moves`: what moves freely is not guided | leave one of both out".into(),
        ),
        ("free: (mass: 1), pivot: (0, 0, 1)", "4: error: `free` beside `pivot`".into()),
        ("free: (mass: 1), port: (name: \"h\", speed: 0.1)", "4: error: `free` beside `port`".into()),
        ("free: (mass: 1, velocity: (0, 0, -1e4))", "the tool `rod` goes".into()),
    ];
    assert_eq!(told(&ball("free: (mass: 1)"), TOUCH, ""), "");
    for (rest, expected) in cases {
        let found = told(&ball(rest), TOUCH, "");
        assert!(found.contains(&expected), "{rest}: {found}");
    }
    let plane = told("(shape: Plane(), at: (0, 0, -1), free: (mass: 1))", TOUCH, "");
    assert!(plane.contains("4: error: a plane has no end: it cannot move freely | take a `Box`"), "{plane}");
    let inside = told("(shape: Sphere(radius: 0.06), at: (0.05, 0.05, 0.13), free: (mass: 1))", TOUCH, "");
    assert!(inside.contains("inside the tool `rod` at the start, the deepest by 3.000e-2 m"), "{inside}");
    for more in ["analysis: Static(),", "start: Equilibrium(),"] {
        let found = told(&ball("free: (mass: 1)"), TOUCH, more);
        assert!(found.contains("has no free tools: what rests on tissue depends on the way there"), "{found}");
    }
    // whom the steps do not move it does not help to leave the law of its contact out
    let found =
        told(&ball("free: (mass: 1)"), "Tool(tool: \"rod\", law: Penalty(share: 1))", "solver: Implicit(step: 0.01),");
    assert_eq!(found, "4: error: implicit steps do not move free tools | use `solver: Explicit`");
    let grasp = "attachments: [Grasp(tool: \"rod\", closed: Step())], ";
    let found = told(&ball("free: (mass: 1)"), TOUCH, grasp);
    assert!(found.contains("4: error: `rod` is `free`, and grasps | a free tool touches, and does no more"), "{found}");
    let suction = "suction: [(tool: \"rod\", pressure: 10, bore: 0.01, reach: 0.01)], ";
    let found = told(&ball("free: (mass: 1)"), TOUCH, suction);
    assert!(found.contains("4: error: `rod` is `free`, and sucks"), "{found}");
}

#[test]
fn a_tool_that_begins_in_a_body_between_its_nodes_is_refused() {
    let bead = |z: f64| format!("(shape: Sphere(radius: 0.002), at: (0.0375, 0.0375, {z:?}))");
    let thin = "Tool(tool: \"rod\", thin: true)";
    let part = "Tool(tool: \"rod\", thin: false, on: Surface(normal: (0, 0, 1)))";
    let deep = told(&bead(0.05), TOUCH, "");
    assert!(deep.contains("error: the tool `rod` is in `b` at the start: its surface at ("), "{deep}");
    assert!(deep.contains("more than half an edge of a face, 1.423e-2 m, below the surface of `b`"), "{deep}");
    // above; within half an edge of the surface it is only said that it may slip between nodes
    for (z, contact) in [(0.11, TOUCH), (0.095, TOUCH), (0.05, thin), (0.05, part)] {
        let said = told(&bead(z), contact, "");
        assert!(!said.contains("is in `b` at the start"), "{z}, {contact}: {said}");
    }
    let free = told("(shape: Sphere(radius: 0.002), at: (0.0375, 0.0375, 0.05), free: (mass: 1e-3))", TOUCH, "");
    assert!(free.contains("error: the tool `rod` is in `b` at the start"), "{free}");
}

#[test]
fn a_surface_that_meets_a_tool_twice_is_told() {
    let above = "Tool(tool: \"rod\", friction: 0.1, on: Surface(normal: (0, 0, 1)))";
    let below = "Tool(tool: \"rod\", on: Surface(normal: (0, 0, -1)))";
    assert_eq!(told(ROD, &format!("{above}, {below}"), ""), "");
    let twice = told(ROD, &format!("{TOUCH}, {TOUCH}"), "");
    assert!(
        twice.contains("5: error: 98 nodes of `b` would meet the tool `rod` twice: by contacts[0] and here"),
        "{twice}"
    );
    let some = told(ROD, &format!("{TOUCH}, {above}"), "");
    assert!(some.contains("25 nodes of `b` would meet the tool `rod` twice"), "{some}");
    let free = "(shape: Sphere(radius: 0.06), at: (0.05, 0.05, 0.17), free: (mass: 1))";
    let twice = told(free, &format!("{TOUCH}, {TOUCH}"), "");
    assert!(twice.contains("98 nodes of `b` would meet the tool `rod` twice"), "{twice}");
}

#[test]
fn what_can_do_nothing_is_told() {
    let taken = |reach: &str| format!("removal: [(when: InTool(tool: \"rod\", reach: {reach}, rate: 1e-6))],");
    let said = told(ROD, TOUCH, &taken("1e-4"));
    assert!(
        said.contains("warning: `rod` takes elements whose centroids are within 1.0e-4 m, and it stays outside"),
        "{said}"
    );
    assert_eq!(told(ROD, TOUCH, &taken("2e-2")), "");
    let named = "loads: [Gravity(body: \"b\", acceleration: (0, 0, -9.81))],";
    let free = "(shape: Sphere(radius: 0.06), at: (0.05, 0.05, 0.17), free: (mass: 1))";
    let said = told(free, TOUCH, named);
    assert!(said.contains("warning: `rod` has no weight: `Gravity` acts on bodies that are named"), "{said}");
    assert_eq!(told(free, TOUCH, &named.replace("body: \"b\", ", "")), "");
}

#[test]
fn a_law_is_not_asked_for_where_none_is_allowed() {
    let free = "(shape: Sphere(radius: 0.06), at: (0.05, 0.05, 0.17), free: (mass: 1))";
    let said = told(free, TOUCH, "solver: Implicit(),");
    assert!(said.contains("implicit steps do not move free tools"), "{said}");
    assert!(!said.contains("Penalty"), "{said}");
}

#[test]
fn a_tool_in_millimetres_is_told_of() {
    let said = told("(shape: Capsule(length: 200, radius: 60), at: (50, 50, 110))", TOUCH, "");
    let expected = "warning: the tool `rod` comes no nearer than 1.2";
    assert!(said.contains(expected) && said.contains("m to where `b` is") && said.contains("metres"), "{said}");
    let far = "shape: Sphere(radius: 0.06), at: (0.05, 0.05, 18)";
    assert!(told(&format!("({far})"), TOUCH, "").contains("comes no nearer than"));
    // it comes for a moment, or a program may lead it
    let comes = "moves: [(displacement: (0, 0, -2), curve: Table([(0.04, 0), (0.05, 1), (0.06, 0)]))]";
    assert_eq!(told(&format!("({far}, {comes})"), TOUCH, "integration: (step: 1e-5),"), "");
    let led = "moves: [(displacement: (0, 0, -2), curve: Input(name: \"way\", rate: 1))]";
    assert_eq!(told(&format!("({far}, {led})"), TOUCH, ""), "");
}

#[test]
fn a_path_that_turns_without_end_is_refused() {
    let rod = |degrees: f64| {
        format!(
            "(shape: Capsule(length: 0.2, radius: 0.06), path: [(t: 0, at: (0.05, 0.05, 0.11)),
                (t: 0.1, at: (0.05, 0.05, 0.11), rotation: (0, 0, {degrees}))])"
        )
    };
    let said = told(&rod(4e5), TOUCH, "");
    assert!(said.contains("error: the tool turns 1111 times on its way: 1000 are allowed"), "{said}");
    assert_eq!(told(&rod(360.0), TOUCH, "integration: (step: 1e-5),"), "");
    assert!(told(&rod(1e300), TOUCH, "").contains("times on its way"));
}

#[test]
fn a_path_without_places_and_a_name_that_nothing_can_be_called_by_are_refused() {
    let said = told("(shape: Capsule(length: 0.2, radius: 0.06), at: (0.05, 0.05, 0.11), path: [])", TOUCH, "");
    assert!(said.contains("4: error: the path has no places | leave `path` out"), "{said}");
    let named = |name: &str| {
        let text = format!(
            "(duration: 0.1, bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (4, 4, 4)), material: \"m\")}},
materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}},
constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))],
tools: {{\"{name}\": {ROD}}},
contacts: [Tool(tool: \"{name}\")])"
        );
        told_of(&text, std::path::Path::new("."))
    };
    for name in ["", "a/b", ".rod"] {
        let wanted = format!("4: error: the tool `{name}` needs another name: programs and tables know it by that");
        assert!(named(name).contains(&wanted), "{}", named(name));
    }
    assert_eq!(named("rod-1"), "");
}
