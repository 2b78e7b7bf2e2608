//! Attachments of what is not there, or that cannot hold.

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
    let found = match SceneFile::from_text("t.ron", &text, std::path::Path::new("."), &[]) {
        Err(wrong) => wrong,
        Ok(scene) => Simulation::check(&scene, &Registry::default()),
    };
    let each = found.lines().into_iter().zip(found.list()).map(|(line, complaint)| {
        let line = line.strip_prefix("t.ron:").unwrap_or(&line).to_string();
        let (row, message) = line.split_once(": ").unwrap_or(("", &line));
        let row = row.split(':').next().unwrap_or("");
        complaint.notes.iter().fold(format!("{row}: {message}"), |text, note| format!("{text} | {note}"))
    });
    each.collect::<Vec<_>>().join("\n")
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
    all_are_told(&[
        ("Grasp(tool: \"forcep\", closed: Step())", "5: error: there is no tool `forcep` | did you mean `forceps`?"),
        ("Grasp(tool: \"forceps\")", "`closed`"),
        ("Grasp(tool: \"forceps\", body: \"c\", closed: Step())", "5: error: there is no body `c`"),
        (
            "Grasp(tool: \"forceps\", closed: Step(), reach: -1)",
            "5: error: `reach` must be 0 or above, found -1 m",
        ),
        (
            "Grasp(tool: \"forceps\", closed: Step(), strength: -1)",
            "5: error: `strength` must be above 0, found -1 N",
        ),
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
             9.000e-2 m from them, and `reach` is 1.000e-2 m",
        ),
        (
            "Grasp(tool: \"forceps\", closed: Step(start: 0.05), on: Plane(normal: (0, 0, 1), at: 0), reach: 0.01)",
            "5: warning: as `b` is at the start, nothing of it is in the jaws of `forceps` when they close | at 5.000e-2 s",
        ),
        (&many, "5: error: at most 8 grasps may hold a body"),
    ]);
}
