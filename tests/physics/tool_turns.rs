//! Tools that turn, by more than half a turn too: on their way, and in tables.

use crate::configurations::{configurations, near, scene_of};
use glam::{DMat3, DQuat, DVec3};
use sinew::assembly::motion;
use sinew::{SceneFile, Simulation};
use std::path::Path;

/// A ball beside a block, which it does not reach, and what its probes tell.
fn scene(way: &str, every: f64) -> String {
    format!(
        "duration: 1, bodies: {{\"b\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (2, 2, 2)), material: \"t\")}},
        materials: {{\"t\": (density: 1000, neo_hookean: Young(young: 1e3, poisson: 0.3))}},
        constraints: [Fixed(on: Set(\"z0\"))],
        tools: {{\"k\": (shape: Sphere(radius: 0.02), {way})}}, contacts: [Tool(tool: \"k\")],
        probes: {{\"p\": (what: ToolPose(tool: \"k\"), every: {every}), \"v\": (what: ToolVelocity(tool: \"k\"), every: {every})}}"
    )
}

fn file(text: &str) -> SceneFile {
    scene_of(text, Path::new("."))
}

fn table(folder: &Path, name: &str) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(folder.join(name)).unwrap();
    text.lines().skip(1).map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect()
}

/// How far two rotations are from each other (rad).
fn apart(a: DQuat, b: DQuat) -> f64 {
    2.0 * a.dot(b).abs().min(1.0).acos()
}

/// Rows lie between steps, and some between the one before half a turn and the one after.
#[test]
fn tables_of_a_tool_that_turns_twice_know_of_no_jumps() {
    let turn = |t: f64| DQuat::from_rotation_z(4.0 * std::f64::consts::PI * t);
    let lying = DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2);
    let place = tempfile::tempdir().unwrap();
    for run in configurations() {
        for (base, first) in
            [(DQuat::IDENTITY, "at: (0.1, 0.1, 0.2)"), (lying, "at: (0.1, 0.1, 0.2), rotation: (90, 0, 0)")]
        {
            let way = format!("{first}, moves: [(rotation: (0, 0, 720), curve: Ramp(end: 1))]");
            let mut simulation = run.start(&format!("({})", scene(&way, 0.007)));
            crate::frames::run_into(&mut simulation, place.path());
            let poses = table(place.path(), "probe_p.csv");
            assert!(poses.len() > 140, "{}", poses.len());
            for row in &poses {
                let degrees = DVec3::from_slice(&row[4..7]);
                let found = DQuat::from_scaled_axis(degrees * std::f64::consts::PI / 180.0);
                // of the numbers that are written; an angle is the root of what is lost of its cosine
                assert!(apart(found, turn(row[0]) * base) < 1e-6, "{}: {row:?}", run.name);
                assert!(degrees.length() < 180.0 + 1e-9, "{row:?}");
            }
            for row in &table(place.path(), "probe_v.csv")[1..] {
                let (spin, expected) = (DVec3::from_slice(&row[4..7]), 4.0 * std::f64::consts::PI * DVec3::Z);
                near(&format!("{}, {row:?}", run.name), spin.distance(expected), 0.0, expected.z, 1e-6);
            }
        }
    }
}

/// At `share` of a way the rotation about z (degrees) from the first place on.
fn turned(file: &SceneFile, tool: &str, share: f64) -> DMat3 {
    motion(&file.scene.tools[tool]).pose(share, |_| 0.0).rotation
}

#[test]
fn a_path_turns_as_far_as_its_places_say() {
    for (from, to) in [(0.0_f64, 360.0_f64), (0.0, 270.0), (-30.0, 725.0), (350.0, -10.0), (0.0, 180.0), (100.0, 10.0)]
    {
        let way = format!(
            "path: [(t: 0, at: (0.1, 0.1, 0.2), rotation: (0, 0, {from})), (t: 1, at: (0.1, 0.1, 0.2), rotation: (0, 0, {to}))]"
        );
        let text = scene(&way, 0.1);
        let alone = file(&format!("({text})"));
        // as a part that is turned about the same axis, and about another
        let part = |rotate: &str| {
            let (duration, content) = text.split_once(", ").unwrap();
            file(&format!("({duration}, parts: {{\"p\": (content: ({content}), rotate: {rotate})}})"))
        };
        let placed = [
            ("(0, 0, 50)", DMat3::from_rotation_z(50_f64.to_radians())),
            ("(70, 0, 0)", DMat3::from_rotation_x(70_f64.to_radians())),
        ];
        let placed = placed.map(|(rotate, turn)| (part(rotate), turn));
        for share in [0.0, 0.1, 0.25, 0.4, 0.5, 0.7, 0.99, 1.0] {
            let expected = DMat3::from_rotation_z((from + share * (to - from)).to_radians());
            let found = turned(&alone, "k", share);
            assert!(found.abs_diff_eq(expected, 1e-12), "{from} to {to}, {share}: {found}");
            for (file, turn) in &placed {
                let found = turned(file, "p.k", share);
                assert!(found.abs_diff_eq(*turn * expected, 1e-12), "{from} to {to}, {share}, in a part: {found}");
            }
        }
        // how fast it is at most is what the guards go by
        let fastest = motion(&alone.scene.tools["k"]).fastest(1.0);
        near("rad/s", fastest, f64::abs(to - from).to_radians(), fastest, 1e-12);
    }
    // about different axes by the shorter way round
    let text = "path: [(t: 0, at: (0, 0, 1), rotation: (0, 0, 90)), (t: 1, at: (0, 0, 1), rotation: (90, 0, 0))]";
    let [from, to] =
        [DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2), DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2)];
    let found = turned(&file(&format!("({})", scene(text, 0.1))), "k", 0.5);
    assert!(found.abs_diff_eq(DMat3::from_quat(from.slerp(to, 0.5)), 1e-12), "{found}");
}

/// A tool that is there to be seen alone is where its path takes it, for probes and readings.
#[test]
fn a_tool_that_nothing_touches_is_where_it_is() {
    for run in configurations() {
        let mut simulation = run.start(
            "(duration: 0.02, bodies: {\"b\": (mesh: Box(size: (0.01, 0.01, 0.01), cells: (2, 2, 2)), material: \"m\")},
            materials: {\"m\": (density: 1000, neo_hookean: Young(young: 5e4, poisson: 0.3))},
            tools: {\"t\": (shape: Sphere(radius: 0.008), at: (0.1, 0.2, 0.3),
                moves: [(displacement: (0, 0, 0.04), curve: Ramp(end: 0.02))])},
            probes: {\"place\": (what: ToolPlace(tool: \"t\")), \"pose\": (what: ToolPose(tool: \"t\")),
                \"velocity\": (what: ToolVelocity(tool: \"t\"))})",
        );
        simulation.advance_to(0.01).unwrap();
        let at = DVec3::new(0.1, 0.2, 0.3 + 2.0 * simulation.time());
        let of = |simulation: &mut Simulation, name: &str| DVec3::from_slice(&simulation.probe(name).unwrap()[..3]);
        for (what, found) in [
            ("place", of(&mut simulation, "place")),
            ("pose", of(&mut simulation, "pose")),
            ("reading", simulation.tool("t").unwrap().place),
        ] {
            near(&format!("{}: {what}", run.name), found.distance(at), 0.0, 0.1, 1e-9);
        }
        let velocity = of(&mut simulation, "velocity");
        near(&format!("{}: velocity", run.name), velocity.distance(DVec3::Z * 2.0), 0.0, 2.0, 1e-9);
    }
}
