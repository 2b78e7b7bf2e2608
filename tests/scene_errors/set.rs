//! `--set path=value`.

use crate::good::{GOOD, brief};
use sinew::scene::SceneFile;
use sinew::scene::schema::MeshSource;
use std::path::Path;

#[test]
fn mistakes_in_a_set_are_shown_in_the_set() {
    let cases = [
        (
            "duration",
            r"error: --set duration: a value is missing | expected path=value, such as materials.tissue.density=1060",
        ),
        ("=3", r"error: --set =3: a path is missing before the ="),
        ("duration=", r"error: --set duration=: a value is missing after the ="),
        ("duration=inf", r"--set:1:10: error: `duration` must be finite, found inf | not a finite number"),
        ("duration=abc", r"--set:1:10: error: `duration` must be a number | found a word"),
        ("duration=(1,", r"error: --set duration=(1,: the value `(1,` cannot be read: it ends too early"),
        (
            "durration=3",
            r"--set:1:1: error: unknown field `durration` | not a field of Scene | did you mean `duration`? | allowed: title, duration, analysis, solver, start, parts, bodies, materials, constraints, loads, tools, contacts, suction, attachments, systems, removal, probes, integration, schedule, real_time, fuse, parameters, output, guards and 2 more",
        ),
        ("a..b=3", r"error: --set a..b=3: `a..b`: a name is missing"),
        ("loads[x]=3", r"error: --set loads[x]=3: `loads[x]`: [x] is not a number from 0"),
        ("loads[0=3", r"error: --set loads[0=3: `loads[0`: a ] is missing"),
        (
            "bodies.cubee.mesh.cells=(3,3,3)",
            r"error: --set bodies.cubee.mesh.cells=(3,3,3): there is no `cubee` in `bodies` | did you mean `cube`? | allowed: cube",
        ),
        (
            "bodies.cube.mesh.cells=(3,3,3.5)",
            r"--set:1:29: error: `cells` must be a whole number, 0 or above, found 3.5",
        ),
        (
            "bodies.cube.mesh.cels=(3,3,3)",
            r"--set:1:18: error: unknown field `cels` | not a field of Box | did you mean `cells`? | allowed: size, cells, elements",
        ),
        (
            "loads[3].acceleration=(0,0,1)",
            r"error: --set loads[3].acceleration=(0,0,1): there is no [3] in `loads` | counted from 0, the last is [0]",
        ),
        (
            "loads.x=3",
            r"error: --set loads.x=3: there is no `x` in `loads`, which is a list | its items are [0] to [0]",
        ),
        ("bodies[0]=3", r"error: --set bodies[0]=3: `bodies` has names inside, not numbers"),
        ("duration.x=3", r"error: --set duration.x=3: there is no `x` in `duration`, which is a number"),
        (
            "bodies.cube.mesh.cells.x=3",
            r"error: --set bodies.cube.mesh.cells.x=3: there is no `x` in `bodies.cube.mesh.cells`, which is values in brackets ( )",
        ),
        (
            "integration.saftey=0.5",
            r"--set:1:13: error: unknown field `saftey` | not a field of Integration | did you mean `safety`? | allowed: step, safety, bound, when_unstable, beyond_stable_step, compensated",
        ),
        (
            "bodies.cube.material=other",
            r"5:19: warning: no body uses the material `tissue`
--set:1:22: error: there is no material `other` | allowed: tissue",
        ),
        ("materials.tissue.density=-1", r"--set:1:26: error: `density` must be above 0, found -1 kg/m³"),
        (
            "accuracy.uncertainty={\"tip.uz\": 0.1}",
            r"--set:1:33: error: a reference that is made knows its own uncertainty; this is for `Values` and `Files`",
        ),
        (
            "removal[0].when=At(1)",
            r"error: --set removal[0].when=At(1): a list that is not in the scene cannot be changed item by item",
        ),
        (
            "bodies.cube.mesh=Box(size:(1,1,1))",
            r"--set:1:18: error: the field `cells` is missing in `Box` | Box needs `cells` | cells: Cells along each edge; a cell is one hexahedron, two wedges or six tetrahedra.",
        ),
    ];
    for (set, expected) in cases {
        assert_eq!(brief(GOOD, &[set]), expected, "--set {set}");
    }
}

fn set(sets: &[&str]) -> SceneFile {
    let sets: Vec<String> = sets.iter().map(|set| set.to_string()).collect();
    SceneFile::from_text("cube.ron", GOOD, Path::new(""), &sets).unwrap()
}

#[test]
fn a_set_replaces_the_value_that_stands_there() {
    let scene =
        set(&["duration=2", "bodies.cube.mesh.cells=(5, 6, 7)", "loads[0].curve=Ramp(end:1)", "loads[0].curve.end=3"]);
    assert_eq!(scene.scene.duration, 2.0);
    assert!(matches!(scene.scene.bodies["cube"].mesh, MeshSource::Box { cells: (5, 6, 7), .. }));
    assert!(scene.text().contains("curve: Ramp(end:3)"), "{}", scene.text());
}

#[test]
fn a_set_adds_what_is_not_there() {
    let scene = set(&[
        "output.fields_every=0.01",
        "output.energies_every=0.1",
        "bodies.cube.scale=2",
        "materials.bone=(density: 1800)",
        "probes.\"left side\"=(what: Stress, on: All)",
        "constraints[0].on.tolerance=1e-3",
    ]);
    let scene = &scene.scene;
    assert_eq!((scene.output.fields_every, scene.output.energies_every), (Some(0.01), Some(0.1)));
    assert_eq!(scene.bodies["cube"].scale, 2.0);
    assert_eq!(scene.materials["bone"].density, 1800.0);
    assert!(scene.probes.contains_key("left side"));
}

#[test]
fn texts_may_be_set_without_quotes() {
    let title = |value: &str| set(&[&format!("title={value}")]).scene.title;
    for plain in ["sag", "a cube (small), or so", "3", "C:\\new", "true", "[x"] {
        assert_eq!(title(plain), plain);
    }
    assert_eq!(title("\"in quotes\""), "in quotes");
    assert_eq!(set(&["probes.tip.body=cube"]).scene.probes["tip"].body.as_deref(), Some("cube"));
    assert_eq!(set(&["probes.tip.body=None"]).scene.probes["tip"].body, None);
    assert_eq!(set(&["probes.tip.body=Some(\"cube\")"]).scene.probes["tip"].body.as_deref(), Some("cube"));
}

#[test]
fn comments_do_not_swallow_a_set() {
    let text =
        GOOD.replace("Box(", "Box /* ( */ ( // ( \n").replace("probes: {", "output: ( /* ( */ // (\n), probes: {");
    let sets = ["bodies.cube.mesh.elements=Tet4".to_string(), "output.fields_every=0.25".to_string()];
    let scene = SceneFile::from_text("cube.ron", &text.replace(", elements: Hex8", ""), Path::new(""), &sets).unwrap();
    assert!(scene.text().contains("elements: Tet4"));
    assert_eq!(scene.scene.output.fields_every, Some(0.25));
}

/// A map that is not there is made with what is put into it, at any depth.
#[test]
fn a_set_makes_the_maps_that_it_needs() {
    let scene =
        set(&["tools.ball.port.name=hand", "tools.ball.port.speed=0.1", "tools.ball.shape=Sphere(radius: 0.01)"]);
    let ball = &scene.scene.tools["ball"];
    assert_eq!(ball.port.as_ref().map(|port| port.name.as_str()), Some("hand"), "{}", scene.text());
    assert!(scene.text().contains("tools: {\"ball\": (shape: Sphere(radius: 0.01), port: ("), "{}", scene.text());
}
