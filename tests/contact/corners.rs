//! What lies in a corner of three walls of one body: each bears it along its own normal.

use crate::configurations::{configurations, near};
use crate::grooves::Written;
use glam::DVec3;
use sinew::BackendChoice;
use std::collections::BTreeMap;
use std::path::Path;

/// Writes a corner: three slabs of 4 mm, 16 mm wide, that meet at the origin, and go on along x, y and z from there.
fn write_corner(path: &Path) {
    let (mut mesh, mut numbers) = (Written::default(), BTreeMap::new());
    let cells = (0..4).flat_map(|i| (0..4).flat_map(move |j| (0..4).map(move |k| [i, j, k])));
    for [i, j, k] in cells.filter(|cell| cell.contains(&0)) {
        let mut of = |i: u32, j: u32, k: u32| {
            let place = [i, j, k].map(|number| 0.004 * (f64::from(number) - 1.0));
            *numbers.entry([i, j, k]).or_insert_with(|| mesh.node(place))
        };
        let [low, high] = [k, k + 1].map(|k| [of(i, j, k), of(i + 1, j, k), of(i + 1, j + 1, k), of(i, j + 1, k)]);
        mesh.element([&low, &high]);
    }
    mesh.write(path);
}

/// Writes a spike along (1, 1, 1): a prism with a tip of one node, at the origin.
fn write_spike(path: &Path) {
    let mut mesh = Written::default();
    let axis = DVec3::ONE.normalize();
    let side = DVec3::new(1.0, -1.0, 0.0).normalize();
    let around =
        [side, -0.5 * side + 0.75_f64.sqrt() * axis.cross(side), -0.5 * side - 0.75_f64.sqrt() * axis.cross(side)];
    let tip = mesh.node([0.0; 3]);
    let [low, high] = [0.006, 0.009].map(|far| around.map(|out| mesh.node((far * axis + 0.0015 * out).to_array())));
    mesh.element([&low, &[tip]]);
    mesh.element([&high, &low]);
    mesh.write(path);
}

const SPRINGS: &str = ", law: Penalty(share: 0.2, damping: 0.3)";

/// How steps are taken, and by what law, and how deep a node of the tip may rest in walls (m): the masses of nodes are
/// shared among what touches there, so that one sweep holds by what is left. The GPU has no implicit steps.
const CASES: [(&str, &str, f64); 4] = [
    ("", "", 1e-4),
    ("", ", sweeps: 20", 1e-6),
    ("", SPRINGS, 2e-4),
    ("solver: Implicit(step: 2.5e-3),", SPRINGS, 2e-4),
];

/// A block whose weight presses it into the corner comes to rest, and each wall bears its part. Of three walls two
/// counted, and the run ended at the default step: what sank into the third meanwhile came out with more energy.
#[test]
fn what_its_weight_presses_into_a_corner_rests() {
    let folder = tempfile::tempdir().unwrap();
    write_corner(&folder.path().join("c.msh"));
    let pull = DVec3::new(-4.0, -6.0, -8.0);
    for run in configurations() {
        for (solver, law, deepest) in CASES {
            if !solver.is_empty() && run.options.backend != BackendChoice::Cpu {
                continue;
            }
            let text = format!(
                "(duration: 0.6, {solver} bodies: {{
                    \"c\": (mesh: File(path: \"c.msh\", hexes: Hex8MeanDilatation), material: \"m\"),
                    \"b\": (mesh: Box(size: (0.008, 0.008, 0.008), cells: (3, 3, 3), elements: Hex8MeanDilatation),
                        material: \"m\")}},
                materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e4, poisson: 0.3), damping: 30)}},
                constraints: [Fixed(body: \"c\", on: All)],
                loads: [Gravity(body: \"b\", acceleration: ({}, {}, {}), curve: Smooth(end: 0.1))],
                contacts: [Between(bodies: (\"c\", \"b\"), friction: 0{law})])",
                pull.x, pull.y, pull.z
            );
            let what = format!("{}, {solver}{law}", run.name);
            let mut simulation = run.start_in(&text, folder.path());
            let weight = pull * simulation.masses("b").unwrap().iter().sum::<f64>();
            let seen = [0.5, 0.6].map(|time| {
                simulation.advance_to(time).unwrap();
                simulation.displacements("b").unwrap().to_vec()
            });
            let goes = seen[0].iter().zip(&seen[1]).map(|(one, other)| one.distance(*other)).fold(0.0, f64::max);
            assert!(goes < 1e-7, "{what}: {goes} m in .1 s");
            near(&what, simulation.contact("b").unwrap().force.distance(-weight), 0.0, weight.length(), 1e-3);
            // the node in the tip itself is in all three walls
            assert!(seen[1][0].min_element() > -deepest, "{what}: {}", seen[1][0]);
        }
    }
}

/// A spike that is pressed into the corner and no wider than that is borne by all three walls alike.
#[test]
fn a_spike_in_a_corner_is_borne_by_its_three_walls() {
    let folder = tempfile::tempdir().unwrap();
    write_corner(&folder.path().join("c.msh"));
    write_spike(&folder.path().join("s.msh"));
    for run in configurations() {
        for (solver, law, deepest) in CASES {
            if !solver.is_empty() && run.options.backend != BackendChoice::Cpu {
                continue;
            }
            let text = format!(
                "(duration: 0.4, {solver} bodies: {{
                    \"c\": (mesh: File(path: \"c.msh\", hexes: Hex8MeanDilatation), material: \"m\"),
                    \"s\": (mesh: File(path: \"s.msh\", tets: Tet4), material: \"m\", translate: (1e-5, 1e-5, 1e-5))}},
                materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e5, poisson: 0.3), damping: 100)}},
                constraints: [Fixed(body: \"c\", on: All),
                    Prescribed(body: \"s\", on: Plane(normal: (1, 1, 1), at: 0.00901732, tolerance: 1e-5),
                        displacement: (-2e-4, -2e-4, -2e-4), curve: Smooth(end: 0.2))],
                contacts: [Between(bodies: (\"c\", \"s\"), friction: 0{law})])"
            );
            let what = format!("{}, {solver}{law}", run.name);
            let mut simulation = run.start_in(&text, folder.path());
            simulation.advance_to(0.4).unwrap();
            let force = simulation.contact("s").unwrap().force;
            assert!(force.min_element() > 1e-3, "{what}: {force} N");
            near(&what, force.distance(DVec3::splat(force.element_sum() / 3.0)), 0.0, force.length(), 1e-3);
            let tip = simulation.displacements("s").unwrap()[0] + 1e-5;
            assert!(tip.min_element() > -deepest, "{what}: {tip} m");
        }
    }
}
