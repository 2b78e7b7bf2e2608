//! Bodies that are where others are: warned of once a pair, when and where; never of those that only touch.

use crate::configurations::configurations;
use crate::element_turns::with_elements;
use sinew::components::Notice;
use sinew::output::Folder;
use sinew::{Options, SceneFile, Simulation};
use std::path::Path;

/// A cube: cells along an edge, its length (m), and where it stands (m).
type Cube = (u32, f64, [f64; 3]);

/// What a run of .1 s of cubes, and of what is done to them, warns of.
fn warned(options: &Options, elements: &str, cells: &[Cube], rest: &str) -> Vec<Notice> {
    let bodies: String = cells
        .iter()
        .enumerate()
        .map(|(i, (cells, size, [x, y, z]))| {
            format!(
                "\"b{i}\": (mesh: Box(size: ({size}, {size}, {size}), cells: ({cells}, {cells}, {cells}), elements: {elements}),
                material: \"m\", translate: ({x}, {y}, {z})),"
            )
        })
        .collect();
    let scene = format!(
        "(duration: 0.1, bodies: {{{bodies}}}, materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}},
        output: (fields_every: 0.02), {rest})"
    );
    overlaps_of(options, &scene)
}

/// What a run of a scene warns of that is where others are.
fn overlaps_of(options: &Options, scene: &str) -> Vec<Notice> {
    let scene = SceneFile::from_text("overlaps.ron", scene, Path::new("."), &[])
        .unwrap_or_else(|wrong| panic!("{}", wrong.render(false)));
    let folder = tempfile::tempdir().unwrap();
    let mut simulation = Simulation::new(&scene, options).unwrap();
    simulation.write_into(&mut Folder::create(folder.path()).unwrap()).unwrap();
    simulation.observe().unwrap();
    simulation.finish().unwrap();
    let summary = simulation.summary("finished").unwrap();
    let mut warnings = summary.guards.warnings;
    warnings.retain(|notice| notice.criterion == "overlap");
    warnings
}

#[test]
#[ignore = "long"]
fn bodies_that_overlap_at_the_start_are_warned_of_once_and_those_beside_each_other_are_not() {
    let cases: [(&str, &[Cube], bool); 8] = [
        ("apart", &[(2, 0.1, [0.0; 3]), (3, 0.1, [0.2, 0.0, 0.0])], false),
        ("face on face", &[(2, 0.1, [0.0; 3]), (3, 0.1, [0.1, 0.0, 0.0])], false),
        ("edge on face", &[(2, 0.1, [0.0; 3]), (3, 0.1, [0.1, 0.05, 0.0])], false),
        ("a corner in", &[(2, 0.1, [0.0; 3]), (3, 0.1, [0.08, 0.08, 0.08])], true),
        ("half in", &[(2, 0.1, [0.0; 3]), (2, 0.1, [0.05, 0.0, 0.0])], true),
        ("within", &[(1, 0.1, [0.0; 3]), (2, 0.02, [0.03, 0.03, 0.03])], true),
        ("around", &[(2, 0.02, [0.03, 0.03, 0.03]), (1, 0.1, [0.0; 3])], true),
        ("the same", &[(2, 0.1, [0.0; 3]), (2, 0.1, [0.0; 3])], true),
    ];
    for (run, elements) in with_elements(&configurations(), 1) {
        for (what, cells, overlap) in cases {
            let told = warned(&run.options, elements, cells, "");
            assert_eq!(told.len(), usize::from(overlap), "{}, {elements}, {what}: {told:?}", run.name);
            for notice in told {
                assert_eq!((notice.part.as_str(), notice.time, notice.step), ("b0 and b1", 0.0, 0));
                assert!(
                    notice.message.contains("overlap at (") && notice.message.contains("nothing keeps them apart"),
                    "{notice:?}"
                );
            }
        }
    }
}

/// The second cube goes through the first, from .05 m beside it at 3 m/s; the third stays where it is, out of their
/// way.
#[test]
fn a_body_that_passes_through_another_is_warned_of_when_it_gets_there() {
    let cells: [Cube; 3] = [(2, 0.1, [0.0; 3]), (3, 0.1, [0.15, 0.02, 0.01]), (1, 0.1, [0.0, 0.0, 0.5])];
    let moves = "constraints: [Prescribed(body: \"b1\", on: All, displacement: (-0.3, 0, 0), curve: Ramp(end: 0.1))]";
    for run in &configurations() {
        let told = warned(&run.options, "Hex8", &cells, moves);
        assert_eq!(told.len(), 1, "{}: {told:?}", run.name);
        // checked every .02 s: at .02 s it is .01 m in
        assert!((0.02 - 1e-9..0.03).contains(&told[0].time) && told[0].part == "b0 and b1", "{told:?}");
    }
}

/// What is told of two bodies that overlap is what is between these two, and not what is between others.
#[test]
fn who_overlaps_is_told_what_keeps_them_apart() {
    let third: Cube = (2, 0.1, [0.0, 0.0, 0.5]);
    let glued: [Cube; 3] = [(2, 0.1, [0.0; 3]), (3, 0.1, [0.097, 0.0, 0.0]), third];
    let half_in: [Cube; 3] = [(2, 0.1, [0.0; 3]), (2, 0.1, [0.05, 0.0, 0.0]), third];
    let cases = [
        (&glued, "attachments: [Glue(bodies: (\"b0\", \"b1\"))]", "they are glued or tied"),
        (
            &half_in,
            "contacts: [Between(bodies: (\"b0\", \"b2\")), Between(bodies: (\"b1\", \"b2\"))]",
            "nothing keeps them apart",
        ),
    ];
    let run = configurations().remove(0);
    for (cells, rest, says) in cases {
        let told = warned(&run.options, "Hex8", cells, rest);
        assert!(told.len() == 1 && told[0].message.contains(says), "{rest}: {told:?}");
    }
}

/// A soft ball dents coarse hexahedra: contact takes their warped faces for two triangles each, and keeps its nodes out
/// of these to nanometres, while the elements bulge out beneath them.
#[test]
fn what_lies_on_warped_faces_as_contact_has_them_is_not_warned_of() {
    let scene = "(duration: 0.06,
        bodies: {\"b0\": (mesh: Box(size: (0.06, 0.06, 0.02), cells: (6, 6, 2), elements: Hex8), material: \"m\"),
            \"b1\": (mesh: Ellipsoid(radii: (0.01, 0.01, 0.01), across: 4, elements: Hex8), material: \"m\",
                translate: (0.03, 0.03, 0.0305))},
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 1e4, poisson: 0.45), damping: 20)},
        constraints: [Fixed(body: \"b0\", on: Set(\"z0\"))], loads: [Gravity(acceleration: (0, 0, -9.81))],
        contacts: [Between(bodies: (\"b0\", \"b1\"), friction: 0.3, sweeps: 8)], output: (fields_every: 0.01))";
    for run in configurations() {
        assert_eq!(overlaps_of(&run.options, scene), [], "{}", run.name);
    }
}

#[test]
fn elements_that_are_gone_overlap_with_nothing() {
    let cells: [Cube; 2] = [(2, 0.1, [0.0; 3]), (2, 0.1, [0.15, 0.0, 0.0])];
    let moves = "constraints: [Prescribed(body: \"b1\", on: All, displacement: (-0.1, 0, 0), curve: Ramp(end: 0.1))]";
    let all = [configurations().remove(0)];
    let gone =
        format!("{moves}, removal: [(body: \"b0\", on: Box(min: (0.04, 0, 0), max: (0.1, 0.1, 0.1)), when: At(0.01))]");
    for run in &all {
        assert_eq!(warned(&run.options, "Hex8", &cells, moves).len(), 1);
        assert_eq!(warned(&run.options, "Hex8", &cells, &gone), []);
    }
}

/// The largest coordinate in the only message (m).
fn farthest(told: &[Notice]) -> f64 {
    assert_eq!(told.len(), 1, "{told:?}");
    let at = told[0].message.split(['(', ')']).nth(1).unwrap();
    at.split(", ").map(|x| x.parse::<f64>().unwrap()).fold(0.0, f64::max)
}

/// Cubes of 20 μm, half in each other, and a bead of 1 μm in one of 40, a metre from the origin.
#[test]
fn where_small_bodies_overlap_is_told_with_the_digits_that_it_takes() {
    let run = configurations().remove(0);
    let told = warned(&run.options, "Hex8", &[(1, 2e-5, [1.0, 0.0, 0.0]), (1, 2e-5, [1.00001, 0.0, 0.0])], "");
    assert!((0.9e-5..2.1e-5).contains(&(farthest(&told) - 1.0)), "{told:?}");
    let bead = "tools: {\"bead\": (shape: Sphere(radius: 1e-6), at: (1.00001, 1e-5, 1e-5))},
        contacts: [Tool(tool: \"bead\", thin: true)]";
    let told = warned(&run.options, "Hex8", &[(2, 4e-5, [1.0, 0.0, 0.0])], bead);
    assert!((0.8e-5..1.2e-5).contains(&(farthest(&told) - 1.0)), "{told:?}");
}

/// A bead, narrower than faces are, is driven into a coarse block between its nodes, which contact does not see.
#[test]
fn a_tool_that_goes_into_a_body_between_its_nodes_is_warned_of_when_it_is_there() {
    let guided = "path: [(t: 0, at: (0.0375, 0.0375, 0.11)), (t: 0.1, at: (0.0375, 0.0375, 0.05))]";
    let free = "at: (0.0375, 0.0375, 0.11), free: (mass: 1e-3, velocity: (0, 0, -0.6))";
    for run in &configurations() {
        for tool in [guided, free] {
            let rest = format!(
                "tools: {{\"bead\": (shape: Sphere(radius: 0.002), {tool})}}, contacts: [Tool(tool: \"bead\", thin: true)]"
            );
            let told = warned(&run.options, "Hex8", &[(4, 0.1, [0.0; 3])], &rest);
            assert_eq!(told.len(), 1, "{}, {tool}: {told:?}", run.name);
            // half an edge below the surface from .04 s on, and looked at every .02 s
            assert!((0.04 - 1e-9..0.061).contains(&told[0].time), "{}: {told:?}", run.name);
            assert!(
                told[0].part == "bead and b0" && told[0].message.contains("the tool bead is in b0 at ("),
                "{told:?}"
            );
            // a bead between nodes is there however slow it comes
            assert!(told[0].message.contains("presses less deep") && !told[0].message.contains("slower"), "{told:?}");
        }
    }
}

/// A plane that goes 5 mm into a face that is fixed pushes nobody there; into one that is free it does.
#[test]
fn a_tool_in_fixed_nodes_is_warned_of() {
    let rest = |held: &str| {
        format!(
            "tools: {{\"plane\": (shape: Plane(), at: (0, 0, 0.101), rotation: (180, 0, 0),
                moves: [(displacement: (0, 0, -0.006), curve: Ramp(end: 0.1))])}},
            contacts: [Tool(tool: \"plane\")], constraints: [Fixed(on: {held})]"
        )
    };
    for run in &configurations() {
        assert_eq!(warned(&run.options, "Hex8", &[(4, 0.1, [0.0; 3])], &rest("Set(\"z0\")")), []);
        for (held, said) in [
            ("Set(\"z1\")", "is in 25 nodes of b0 that are fixed or prescribed, the deepest by "),
            ("Nodes([124])", "is in a node of b0 that is fixed or prescribed, by "),
        ] {
            let told = warned(&run.options, "Hex8", &[(4, 0.1, [0.0; 3])], &rest(held));
            assert_eq!(told.len(), 1, "{}, {held}: {told:?}", run.name);
            let is_said = told[0].message.contains(&format!("the tool plane {said}"));
            assert!(is_said && told[0].part == "plane and led nodes of b0", "{told:?}");
        }
    }
}

/// Forceps press nodes 1 mm into a table that they touch: both want them.
#[test]
fn a_tool_in_nodes_that_another_holds_is_warned_of() {
    let rest = |way: f64| {
        format!(
            "tools: {{\"table\": (shape: Plane()), \"forceps\": (shape: Sphere(radius: 0.01), at: (0.05, 0.05, 0),
                moves: [(displacement: (0, 0, {way:?}), curve: Smooth(end: 0.05))])}},
            attachments: [Grasp(tool: \"forceps\", on: Plane(normal: (0, 0, 1), at: 0), closed: Step())],
            contacts: [Tool(tool: \"table\")]"
        )
    };
    for run in &configurations() {
        assert_eq!(warned(&run.options, "Hex8", &[(4, 0.1, [0.0; 3])], &rest(1e-3)), []);
        let told = warned(&run.options, "Hex8", &[(4, 0.1, [0.0; 3])], &rest(-1e-3));
        assert_eq!(told.len(), 1, "{}: {told:?}", run.name);
        let said = "the tool table is in 25 nodes of b0 that another closed tool holds, the deepest by ";
        assert!(told[0].message.contains(said) && told[0].part == "table and held nodes of b0", "{told:?}");
    }
}
