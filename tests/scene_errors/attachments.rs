//! Attachments of what is not there, or that cannot hold.

use crate::complaints::told_of;
use sinew::systems::Registry;
use sinew::{SceneFile, Simulation};

/// What is said of attachments, which stand in line 5, each complaint in one line without its place in the line.
fn told(attachments: &str, more: &str) -> String {
    let text = format!(
        "(duration: 0.1, bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (4, 4, 4)), material: \"m\")}},
materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}},
constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))], {more}
tools: {{\"forceps\": (shape: Capsule(length: 0.2, radius: 0.01), at: (0.05, 0.05, 0.1))}},
attachments: [{attachments}])"
    );
    told_of(&text, std::path::Path::new("."))
}

const GRASP: &str = "Grasp(tool: \"forceps\", closed: Step())";

fn all_are_told(cases: &[(&str, &str)]) {
    for (attachment, expected) in cases {
        let found = told(attachment, "");
        println!("{found}");
        assert!(found.contains(expected), "{attachment}:\n{found}\nexpected\n{expected}");
    }
}

#[test]
fn good_attachments_have_no_complaints() {
    assert_eq!(told(GRASP, ""), "");
}

#[test]
fn what_is_wrong_with_a_grasp_is_told_where_it_stands() {
    let many = format!("{GRASP},").repeat(9);
    let twice = format!("{GRASP}, {}", GRASP.replace("closed", "body: \"b\", closed"));
    all_are_told(&[
        ("Grasp(tool: \"forcep\", closed: Step())", "5: error: there is no tool `forcep` | did you mean `forceps`?"),
        ("Grasp(tool: \"forceps\")", "`closed`"),
        ("Grasp(tool: \"forceps\", body: \"c\", closed: Step())", "5: error: there is no body `c`"),
        ("Grasp(tool: \"forceps\", closed: Step(), reach: -1)", "5: error: `reach` must be 0 or above, found -1 m"),
        ("Grasp(tool: \"forceps\", closed: Step(), strength: -1)", "5: error: `strength` must be above 0, found -1 N"),
        ("Grasp(tool: \"forceps\", closed: Step(), stength: 1)", "did you mean `strength`?"),
        ("Grasp(tool: \"forceps\", closed: Step(), jaws: Sphere(radius: 0))", "5: error: `radius` must be"),
        ("Grasp(tool: \"forceps\", closed: Smooth(start: 1, end: 0))", "5: error: "),
        ("Grasp(tool: \"forceps\", closed: Step(), on: Plane(normal: (0, 0, 1), at: 1))", "5: error: no node is here"),
        (
            "Grasp(tool: \"forceps\", closed: Step(start: 1))",
            "5: warning: the tool `forceps` never closes: nothing is held",
        ),
        (
            "Grasp(tool: \"forceps\", closed: Step(), on: Plane(normal: (0, 0, 1), at: 0), reach: 0.01)",
            "5: error: there is nothing of `b` in the jaws of `forceps`, which are closed at the start | the nearest node is \
             1.000e-1 m from them, and `reach` is 1.000e-2 m",
        ),
        (
            "Grasp(tool: \"forceps\", closed: Step(start: 0.05), on: Plane(normal: (0, 0, 1), at: 0), reach: 0.01)",
            "5: warning: as `b` is at the start, nothing of it is in the jaws of `forceps` when they close | at 5.000e-2 s",
        ),
        (
            "Grasp(tool: \"forceps\", closed: Step(), on: Plane(normal: (0, 0, 1), at: 0))",
            "5: warning: all nodes of `b` that the tool `forceps` may hold are fixed or prescribed | no force moves those: it \
             bears nothing",
        ),
        (&many, "5: error: at most 8 grasps may hold a body"),
        (&many, "5: error: this tool holds the same nodes by attachments[0] already"),
        (&twice, "5: error: this tool holds the same nodes by attachments[0] already"),
    ]);
    let weak = GRASP.replace("closed", "strength: 1, closed");
    let found = told(&weak, "analysis: Static(),");
    assert!(found.contains("5: warning: nothing breaks in a static analysis"), "{found}");
    let found = told(&weak, "start: Equilibrium(),");
    assert!(found.contains("5: warning: nothing breaks on the way to the equilibrium of the start"), "{found}");
    // it holds nothing until then
    let found = told(&weak.replace("Step()", "Step(start: 0.05)"), "start: Equilibrium(),");
    assert!(!found.contains("nothing breaks") && !found.contains("error"), "{found}");
}

/// A suture of two points of the only body, with some more.
fn suture(to: &str, more: &str) -> String {
    format!("Suture(from: (at: (0.02, 0.02, 0.1)), to: (at: {to}), stiffness: 5 {more})")
}

#[test]
fn what_is_wrong_with_a_suture_or_a_tie_is_told_where_it_stands() {
    let good = suture("(0.08, 0.02, 0.1)", "");
    let cases = [
        (suture("(0.02, 0.02, 0.1)", ""), "5: error: both points of the suture are one place"),
        (suture("(0.08, 0.02, 0.1)", ", strength: -1"), "5: error: `strength` must be above 0, found -1 N"),
        (suture("(0.08, 0.02, 0.1)", ", tighten: -1"), "5: error: `tighten` must be 0 or above, found -1 m"),
        (
            suture("(0.08, 0.02, 0.1)", ", tighten: 0.07"),
            "5: error: it draws in 7.000e-2 m of a thread that is 6.000e-2 m long | no thread is shorter than 0 m",
        ),
        (good.replace("stiffness: 5", "stiffness: 0"), "5: error: `stiffness` must be above 0, found 0 N/m"),
        (good.replace("(at: (0.08", "(body: \"c\", at: (0.08"), "5: error: there is no body `c`"),
        (suture("(0.08, 0.02, 0.2)", ""), "5: error: nothing of `b` is there: the nearest place is 1.000e-1 m off"),
        (
            format!("{good}, {}", good.replace("from", "name: \"0\", from")),
            "5: error: another attachment is called `0`, too",
        ),
        (
            "Tie(from: (at: (0.02, 0.02, 0.1)), to: (at: (0.02, 0.02, 0)))".to_string(),
            "5: error: what is to be tied is 1.000e-1 m apart",
        ),
        (
            "Tie(from: (at: (0.02, 0.02, 0)), to: (at: (0.02, 0.02, 0)))".to_string(),
            "5: error: both points of the tie are one place",
        ),
    ];
    for (attachments, expected) in cases {
        let found = told(&attachments, "");
        println!("{found}");
        assert!(found.contains(expected), "{attachments}:\n{found}\nexpected\n{expected}");
    }
    let found = told(&good, "probes: {\"p\": (what: AttachmentForce(attachment: \"1\"))},");
    assert!(found.contains("3: error: there is no suture, tie or glue `1` | allowed: 0"), "{found}");
    let tie = "Tie(name: \"t\", from: (at: (0.02, 0.02, 0.1)), to: (at: (0.03, 0.02, 0.1)))";
    let found = told(tie, "probes: {\"p\": (what: SutureLength(attachment: \"t\"))},");
    let wanted = "3: error: `t` is no suture: it has no length | what it bears is AttachmentForce(attachment: \"t\")";
    assert!(found.contains(wanted), "{found}");
    let found = told(&suture("(0.08, 0.02, 0.1)", ", strength: 1"), "analysis: Static(),");
    assert!(found.contains("5: warning: nothing breaks in a static analysis"), "{found}");
    let found = told(&suture("(0.08, 0.02, 0.1)", ", strength: 1"), "start: Equilibrium(),");
    assert!(found.contains("5: warning: nothing breaks on the way to the equilibrium of the start"), "{found}");
}

/// No system of one's own is sent for.
#[test]
fn a_thread_that_makes_the_step_small_is_told_where_it_stands() {
    let stiff = suture("(0.08, 0.02, 0.1)", "").replace("stiffness: 5", "stiffness: 1e7");
    let found = told(&stiff, "");
    assert!(found.contains("5: warning: forces on nodes make ") && found.contains("less `stiffness`"), "{found}");
    let usual = told(&suture("(0.08, 0.02, 0.1)", ""), "");
    assert!(!usual.contains("forces on nodes make"), "{usual}");
}

#[test]
fn what_is_wrong_with_glue_is_told_where_it_stands() {
    let faces = "on: Surface(normal: (0, 0, 1)), onto: Surface(normal: (0, 0, -1))";
    all_are_told(&[
        ("Glue(bodies: (\"b\", \"c\"))", "5: error: there is no body `c`"),
        ("Glue(bodies: (\"b\", \"b\"))", "5: error: all of `b` would be glued to itself"),
        (
            &format!("Glue(bodies: (\"b\", \"b\"), {faces})"),
            "5: error: nothing of `b` is near `b`: nothing is glued | the nearest node is 1.000e-1 m off",
        ),
        (
            "Glue(bodies: (\"b\", \"b\"), on: Surface(normal: (0, 0, 1)))",
            "5: error: nothing of `b` is near `b`: nothing is glued | the nearest node is 1.768e-2 m off, and `reach` \
             is 2.845e-3 m | faces of `b` do not count that are joined to a node along the surface within 2.845e-3 m \
             of it",
        ),
        (
            &format!("Glue(bodies: (\"b\", \"b\"), {faces}, normal: 0)"),
            "5: error: `normal` must be above 0, found 0 Pa",
        ),
        (&format!("Glue(bodies: (\"b\", \"b\"), {faces}, sweeps: 0)"), "5: error: `sweeps` must be from 1 to 100"),
    ]);
}

/// What touches at rest is apart where it starts.
#[test]
fn what_starts_apart_is_not_glued() {
    let block = |more: &str| {
        format!("(mesh: Box(size: (0.01, 0.01, 0.01), cells: (3, 3, 3)), material: \"m\", translate: {more})")
    };
    let text = format!(
        "(duration: 0.02, bodies: {{\"a\": {}, \"b\": {}}},
materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 5e3, poisson: 0.3))}},
attachments: [Glue(bodies: (\"a\", \"b\"))])",
        block("(0, 0, 0)"),
        block("(0, 0, 0.01), start: Affine(gradient: ((0, 0, 0), (0, 0, 0), (0, 0, -0.05)), center: (0, 0, 0.02))"),
    );
    let found = told_of(&text, std::path::Path::new("."));
    let wanted = "3: error: nothing of `a` is near `b`: nothing is glued | the nearest node is 5.000e-4 m off, and \
                  `reach` is 3.794e-4 m | it counts where bodies are at the start, which their `start` or `rest_shape` \
                  tells";
    assert!(found.contains(wanted), "{found}");
}

/// Which of the copies would it be?
#[test]
fn bodies_with_copies_are_neither_sutured_nor_glued() {
    let text = "(duration: 0.1, bodies: {\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (2, 2, 2)), material: \"m\",
copies: 2, apart: (0.2, 0, 0))},
materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))},
attachments: [Suture(from: (at: (0.02, 0.02, 0.1)), to: (at: (0.08, 0.02, 0.1)), stiffness: 5)])";
    let scene = SceneFile::from_text("t.ron", text, std::path::Path::new("."), &[]).unwrap();
    let found = Simulation::check(&scene, &Registry::default()).to_string();
    assert!(found.contains("`b` has 2 copies: which of them?"), "{found}");
}
