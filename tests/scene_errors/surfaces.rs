//! Surfaces that meet wrongly: whose they are, how, and where bodies stand at the start.

use crate::complaints::told_of;

/// What is said of a contact between two cubes of 10 cm, the second moved by so much.
fn told(contact: &str, moved: &str) -> String {
    let text = format!(
        "(duration: 0.1, bodies: {{
    \"a\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (4, 4, 4)), material: \"m\"),
    \"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (4, 4, 4)), material: \"m\", translate: {moved})}},
materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}},
contacts: [{contact}])"
    );
    told_of(&text, std::path::Path::new("."))
}

const MEET: &str = "Between(bodies: (\"a\", \"b\"))";

#[test]
fn bodies_apart_or_face_on_face_have_no_complaints() {
    for moved in ["(0, 0, 0.11)", "(0, 0, 0.1)", "(0.05, 0.02, 0.1)"] {
        assert_eq!(told(MEET, moved), "", "{moved}");
    }
}

#[test]
fn what_is_wrong_with_surfaces_is_told_with_what_is_allowed() {
    let cases = [
        ("Between(bodies: (\"a\", \"c\"))", "5: error: there is no body `c`"),
        ("Between(bodies: (\"a\", \"a\"))", "5: error: `a` twice | a body that meets itself: Itself(body: \"a\")"),
        ("Itself()", "5: error: which body? The scene has 2 | bodies: a, b"),
        ("Between(bodies: (\"a\", \"b\"), sweeps: 0)", "5: error: `sweeps` must be from 1 to 100, found 0"),
        ("Between(bodies: (\"a\", \"b\"), thickness: -1)", "5: error: `thickness` must be 0 or above, found -1 m"),
        ("Between(bodies: (\"a\", \"b\"), friction: -1)", "5: error: `friction` must be 0 or above, found -1"),
        (
            "Between(bodies: (\"a\", \"b\"), friction: 0.3, static_friction: 0.2)",
            "5: error: `static_friction` is 0.2, and `friction` is 0.3 | what sticks is held at least as well as what slides",
        ),
        (
            "Between(bodies: (\"a\", \"b\"), friction: 30)",
            "5: warning: friction of 30: what touches hardly ever slides | it is a coefficient, and no percentage: 30 % is 0.3",
        ),
    ];
    for (contact, wanted) in cases {
        let found = told(contact, "(0, 0, 0.11)");
        assert!(found.starts_with(wanted), "{contact}: {found}");
    }
}

#[test]
fn who_meets_twice_is_told() {
    let found = told(&format!("{MEET}, Between(bodies: (\"b\", \"a\"), friction: 0.1)"), "(0, 0, 0.11)");
    assert_eq!(found, "5: error: `a` and `b` meet by contacts[0] already | leave one of both out");
    let found = told(&format!("{MEET}, Itself(body: \"a\"), Itself(body: \"a\")"), "(0, 0, 0.11)");
    assert_eq!(found, "5: error: `a` meets itself by contacts[1] already | leave one of both out");
}

#[test]
fn bodies_nearer_than_their_thickness_are_told() {
    let thick = |thickness: f64| format!("Between(bodies: (\"a\", \"b\"), thickness: {thickness:?})");
    assert_eq!(told(&thick(9e-3), "(0, 0, 0.11)"), "");
    let found = told(&thick(1.2e-2), "(0, 0, 0.11)");
    let wanted = "5: warning: 25 nodes of `a` are nearer to `b` at the start than the `thickness` of 1.200e-2 m, the nearest by \
                  2.000e-3 m";
    assert!(found.contains(wanted) && found.contains("25 nodes of `b` are nearer to `a`"), "{found}");
    let found = told(&thick(2.6e-2), "(0, 0, 0.11)");
    assert!(found.contains("5: error: 25 nodes of `a` are nearer to `b` at the start"), "{found}");
    assert!(found.contains("up to half an edge of a face, 1.423e-2 m, is pushed apart"), "{found}");
}

#[test]
fn a_probe_of_what_nothing_touches_is_told() {
    let probe = "Between(bodies: (\"a\", \"b\"))], probes: {\"p\": (body: \"a\", what: ContactForce, on: All)";
    let found = told(&format!("{probe}}}, loads: ["), "(0, 0, 0.11)");
    assert_eq!(found, "");
    let found = told(&format!("Itself(body: \"b\"){}}}, loads: [", &probe[MEET.len()..]), "(0, 0, 0.11)");
    assert!(found.contains("5: warning: nothing touches `a`: this will say so in every row"), "{found}");
}

#[test]
fn points_are_nodes_or_those_of_faces() {
    let faces = "Between(bodies: (\"a\", \"b\"), edges: true, points: Faces)";
    assert_eq!(told(faces, "(0, 0, 0.11)"), "");
    let unknown = told("Between(bodies: (\"a\", \"b\"), points: Corners)", "(0, 0, 0.11)");
    assert!(unknown.contains("Corners") && unknown.contains("Faces"), "{unknown}");
}

#[test]
fn friction_of_edges_that_cross_in_implicit_steps_is_warned_of() {
    let told = |words: &str, solver: &str| {
        let contact = format!("Between(bodies: (\"a\", \"b\"), {words} law: Penalty(share: 1))], {solver} loads: [");
        told(&contact, "(0, 0, 0.11)")
    };
    let implicit = "solver: Implicit(step: 0.01),";
    let found = told("edges: true, friction: 0.3,", implicit);
    assert!(found.contains("5: warning: in implicit steps what should stick slides where edges cross"), "{found}");
    for (words, solver) in
        [("edges: true,", implicit), ("friction: 0.3,", implicit), ("edges: true, friction: 0.3,", "")]
    {
        let found = told(words, solver);
        assert!(!found.contains("edges cross"), "{words} {solver}: {found}");
    }
}

#[test]
fn springs_are_as_stiff_as_the_step_allows() {
    let law = |law: &str| format!("Between(bodies: (\"a\", \"b\"), law: {law})");
    let apart = "(0, 0, 0.11)";
    assert_eq!(told(&law("Penalty(share: 0.7)"), apart), "");
    let found = told(&law("Penalty(share: 0.8)"), apart);
    let wanted = "5: error: springs with a share of 0.8000 in all act on `a`: at 0.900 of the stable step 0.7600 are stable | give a smaller `share`";
    assert!(found.starts_with(wanted), "{found}");
    // damping that follows a step late leaves (√1.25 − .5)² of it
    let found = told(&law("Penalty(share: 0.5, damping: 0.5)"), apart);
    assert!(found.contains("0.2903 are stable"), "{found}");
    // in small steps, too, springs do not throw out at once what comes in
    let small =
        |share: f64| format!("{}], integration: (safety: 0.1), loads: [", law(&format!("Penalty(share: {share})")));
    assert_eq!(told(&small(0.99), apart), "");
    let found = told(&small(1.01), apart);
    assert!(found.contains("at 0.100 of the stable step 1.0000 are stable"), "{found}");
    for (text, wanted) in [
        ("Penalty(share: 0)", "5: error: `share` must be above 0, found 0"),
        ("Penalty(share: 0.1, damping: -1)", "5: error: `damping` must be 0 or above, found -1"),
        ("Penalty(share: 0.1), sweeps: 2", "5: error: a spring has one force, and not one of 2 sweeps"),
    ] {
        let found = told(&law(text), apart);
        assert!(found.starts_with(wanted), "{found}");
    }
}

#[test]
fn at_rest_all_contacts_are_springs_or_none_is() {
    let told_of = |analysis: &str, law: &str| {
        let text = format!(
            "(duration: 0.1, {analysis} bodies: {{\"a\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (2, 2, 2)), material: \"m\")}},
materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}}, tools: {{\"t\": (shape: Plane()), \"u\": (shape: Plane(), at: (0, 0, -0.1))}},
contacts: [Tool(tool: \"t\", law: Penalty(share: 20)),
    Tool(tool: \"u\"{law})])"
        );
        told_of(&text, std::path::Path::new("."))
    };
    for analysis in ["analysis: Static(),", "analysis: Static(method: Newton),"] {
        assert_eq!(told_of(analysis, ", law: Penalty(share: 1)"), "", "{analysis}");
    }
    let found = told_of("analysis: Static(),", "");
    assert!(
        found.contains("error: at rest all contacts are springs, or none is | write `law: Penalty(share: 1)`"),
        "{found}"
    );
    let found = told_of("analysis: Static(method: Newton),", "");
    assert!(found.contains("error: Newton's iterations cannot take part in the kinematic law of contact"), "{found}");
}

/// What is said of copies of a cube of 10 cm with contact with itself, each so far from the last.
fn told_of_copies(contact: &str, copies: u32, apart: &str) -> String {
    let text = format!(
        "(duration: 0.1, bodies: {{
    \"a\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (4, 4, 4)), material: \"m\", copies: {copies}, apart: {apart})}},
materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}},
contacts: [{contact}])"
    );
    told_of(&text, std::path::Path::new("."))
}

#[test]
fn a_body_in_itself_at_the_start_is_told_with_its_nodes() {
    for contact in ["Itself()", "Itself(body: \"a\")"] {
        assert_eq!(told_of_copies(contact, 3, "(0, 0, 0.11)"), "");
        let little = told_of_copies(contact, 2, "(0, 0, 0.098)");
        // all of the two faces: those on the rim, too, which face each other
        let wanted = "4: warning: 50 nodes of `a` are inside other parts of it at the start, the deepest by 2.000e-3 m | nodes: ";
        assert!(little.starts_with(wanted) && little.contains("pushed out while a wave goes"), "{little}");
        let deep = told_of_copies(contact, 2, "(0.01, 0.01, 0.08)");
        let wanted = "of `a` are inside other parts of it at the start, ";
        assert!(deep.contains("4: error: ") && deep.contains(wanted) && deep.contains("of them deep"), "{deep}");
        let same = told_of_copies(contact, 2, "(0, 0, 0)");
        assert!(same.contains("4: error: 196 nodes of `a` are inside other parts of it"), "{same}");
    }
}

/// What is said of a thick tube with a slit that is so wide (degrees), with contact with itself.
fn told_of_a_slit(contact: &str, slit: f64) -> String {
    let text = format!(
        "(duration: 0.1, bodies: {{
    \"a\": (mesh: Tube(inner: 0.05, outer: 0.1, height: 0.1, angle: {:?}, cells: (4, 40, 4), elements: Hex8), material: \"m\")}},
materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}},
contacts: [{contact}])",
        360.0 - slit
    );
    told_of(&text, std::path::Path::new("."))
}

#[test]
fn parts_of_a_body_that_never_meet_because_they_are_so_near_at_rest_are_told() {
    // the slit is 2.6 mm wide at the inside and 5.2 mm at the outside
    let near = told_of_a_slit("Itself(thickness: 0.004)", 3.0);
    assert!(near.starts_with("4: warning: 50 nodes of `a` are within 6."), "{near}");
    let known = near.contains("of other parts of its surface at rest: they never meet") && near.contains("nodes: ");
    assert!(known && near.contains("the narrowest gap, 2.61"), "{near}");
    assert_eq!(told_of_a_slit("Itself(thickness: 0.004)", 30.0), "");
    // copies that are as near, or touch, meet
    assert_eq!(told_of_copies("Itself(thickness: 0.004)", 2, "(0, 0, 0.104)"), "");
    assert_eq!(told_of_copies("Itself()", 3, "(0, 0, 0.1)"), "");
    // sides and corners of one cube are no gap, however near
    assert_eq!(told_of_copies("Itself(thickness: 0.05)", 2, "(0, 0, 0.3)"), "");
}

#[test]
fn bodies_in_each_other_at_the_start_are_told_with_their_nodes() {
    let little = told(MEET, "(0, 0, 0.098)");
    // those on the rim are on walls of the other
    let wanted = "warning: 9 nodes of `a` are inside `b` at the start, the deepest by 2.000e-3 m | nodes: 106, 107";
    assert!(little.contains(wanted) && little.contains("pushed out while a wave goes"), "{little}");
    let deep = told(MEET, "(0.01, 0.01, 0.08)");
    assert!(deep.contains("error: ") && deep.contains("of `a` are inside `b` at the start, "), "{deep}");
    assert!(deep.contains("up to half an edge of a face"), "{deep}");
    assert!(!deep.contains("more than half of the nodes"), "{deep}");
    // on each other's surface nobody is deep, and yet they are refused
    let same = told(MEET, "(0, 0, 0)");
    assert!(same.contains("error") && same.contains("0 of them deep | nodes: "), "{same}");
    assert!(same.contains("more than half of the nodes of its surface are"), "{same}");
}

#[test]
fn a_skin_that_cannot_be_that_of_its_body_is_told_of() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("skin.obj"), "v 0 0 0\nv 0.1 0 0\nv 0 0.12 0\nv 0 0 0.1\nf 1 3 2\nf 1 2 4\n")
        .unwrap();
    let told = |scale: f64| {
        let text = format!(
            "(duration: 0.1, bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (4, 4, 4)), material: \"m\",
                skin: (file: \"skin.obj\", scale: {scale}))}},
            materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}},
            constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))])"
        );
        told_of(&text, folder.path())
    };
    assert_eq!(told(1.0), "");
    assert_eq!(told(0.1), "", "a part of a body may have a skin");
    assert!(told(1000.0).contains("warning: the skin reaches 1.199e2 m beyond `b`, which measures 1.732e-1 m across"));
    assert!(told(1e-3).contains("warning: the skin measures 1.855e-4 m across"), "{}", told(1e-3));
}
