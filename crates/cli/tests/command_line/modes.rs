//! `sinew modes` says what it leaves out.

use crate::sinew::{SCENE, Workspace};

/// The block with more in its scene.
fn with(more: &str) -> Workspace {
    Workspace::with_scene(&SCENE.replacen("duration: 0.2,", &format!("duration: 0.2, {more}"), 1))
}

#[test]
fn what_holds_bodies_beside_constraints_is_warned_of() {
    let modes = ["modes", "block.ron", "--count", "1", "--no-picture"];
    let plain = Workspace::new().sinew(&modes);
    assert_eq!(plain.status, Some(0), "{}", plain.complained);
    assert!(!plain.complained.contains("warning"), "{}", plain.complained);
    let place = with(
        "tools: {\"jaws\": (shape: Sphere(radius: 0.02), at: (0.05, 0.05, 0.11)), \"table\": (shape: Plane(), at: (0, 0, -0.01))},
        attachments: [Grasp(tool: \"jaws\", on: Set(\"z1\"), closed: Step()),
            Suture(name: \"stitch\", from: (at: (0, 0, 0.1)), to: (at: (0.1, 0.1, 0.1)), stiffness: 1)],
        contacts: [Tool(tool: \"table\"), Itself()],",
    );
    let left_out = "sutures (`stitch`), grasps (`jaws`), contact (with `table`, of the body with itself)";
    let ended = place.sinew(&modes);
    ended.wants(0, &["warning: modes are those of bodies without", left_out, "too low"]);
    // nothing of it changes what is found
    let frequency = |said: &str| said.lines().nth(1).and_then(|line| line.split(" Hz").next()).map(str::to_owned);
    assert_eq!(frequency(&ended.said), frequency(&plain.said), "{}", ended.said);
    // and programs read what they read
    let ended = place.sinew(&["modes", "block.ron", "--count", "1", "--json"]);
    ended.wants(0, &[left_out]);
    let modes: Vec<serde_json::Value> = serde_json::from_str(&ended.said).unwrap();
    assert_eq!(modes.len(), 1, "{}", ended.said);
}

#[test]
fn of_many_of_a_kind_some_are_named() {
    let stitch =
        |x: usize| format!("Suture(from: (at: (0, 0, 0.1)), to: (at: ({}, 0, 0.1)), stiffness: 1), ", 0.02 * x as f64);
    let stitches: String = (1..=5).chain(1..=1).map(stitch).collect();
    let place = with(&format!("attachments: [{stitches}],"));
    let ended = place.sinew(&["modes", "block.ron", "--count", "1", "--no-picture"]);
    ended.wants(0, &["sutures (`0`, `1`, `2`, `3` and 2 more)"]);
}
