//! What is above a body with a notch from below, or with a pit: walls of those are walls of corners, and whoever is
//! beyond the body, near to the plane of one, is not in it.

use crate::configurations::{configurations, near};
use crate::written::Written;
use glam::DVec3;
use std::path::Path;

/// Writes a cube of six tetrahedra but for one, at its underside; the upper side is whole.
fn write_notch(path: &Path) {
    let mut mesh = Written::default();
    let corner = |n: u32| [0.009 * f64::from(n & 1), 0.009 * f64::from(n >> 1 & 1), 0.006 * f64::from(n >> 2)];
    let nodes: Vec<usize> = (0..8).map(|n| mesh.node(corner(n))).collect();
    for [a, b, c, d] in [[0, 1, 3, 7], [0, 2, 6, 7], [0, 4, 5, 7], [0, 1, 7, 5], [0, 4, 7, 6]] {
        mesh.element([&[nodes[a], nodes[b], nodes[c]], &[nodes[d]]]);
    }
    mesh.write(path);
}

/// Writes a slab of 6 mm whose underside is a groove along y that leaves 1 mm.
fn write_grooved_slab(path: &Path) {
    let mut mesh = Written::default();
    let slices: Vec<[usize; 6]> = (0..4)
        .map(|j| {
            let y = 0.003 * f64::from(j);
            [(0.0, 0.0), (0.0045, 0.005), (0.009, 0.0), (0.0, 0.006), (0.0045, 0.006), (0.009, 0.006)]
                .map(|(x, z)| mesh.node([x, y, z]))
        })
        .collect();
    for pair in slices.windows(2) {
        for corners in [[0, 1, 4, 3], [1, 2, 5, 4]] {
            let [near, far] = [pair[0], pair[1]].map(|slice| corners.map(|i: usize| slice[i]));
            mesh.element([&near, &far]);
        }
    }
    mesh.write(path);
}

/// A block that flies .3 mm above is left alone, above a notch in the underside and above what elements have left: it
/// was pushed by walls that it is behind the planes of, by more than its weight.
#[test]
fn what_flies_above_a_notch_is_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    write_notch(&folder.path().join("n.msh"));
    let velocity = DVec3::new(0.011, 0.007, 0.0);
    let pit = "Box(size: (0.009, 0.009, 0.006), cells: (3, 3, 2))";
    for run in configurations() {
        for (mesh, gone) in [("File(path: \"n.msh\")", ""), (pit, "60"), (pit, "60, 61, 64, 65, 72, 74, 81, 93")] {
            for points in ["Nodes", "Faces"] {
                let removal = match gone {
                    "" => String::new(),
                    gone => format!("removal: [(body: \"a\", on: Elements([{gone}]), when: At(0.001))],"),
                };
                let text = format!(
                    "(duration: 0.2, bodies: {{
                        \"a\": (mesh: {mesh}, material: \"m\"),
                        \"b\": (mesh: Box(size: (0.006, 0.006, 0.004), cells: (2, 2, 2), elements: Hex8),
                            material: \"m\", translate: (0.0013, 0.0011, 0.0063), velocity: (0.011, 0.007, 0))}},
                    materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 5e3, poisson: 0.4))}},
                    constraints: [Fixed(body: \"a\", on: All)], {removal}
                    contacts: [Between(bodies: (\"a\", \"b\"), points: {points})])"
                );
                let what = format!("{}, {mesh}, {points}, {gone}", run.name);
                let mut simulation = run.start_in(&text, folder.path());
                let mut most = 0.0_f64;
                while simulation.time() < 0.2 {
                    simulation.advance(5).unwrap();
                    most = most.max(simulation.contact("b").unwrap().force.length());
                }
                assert_eq!(most, 0.0, "{what}");
                let far = velocity * simulation.time();
                for u in simulation.displacements("b").unwrap() {
                    assert!(u.distance(far) < 1e-3 * far.length(), "{what}: {u} m");
                }
            }
        }
    }
}

/// A block that lies on a slab with a groove in its underside is borne by what it lies on.
#[test]
fn what_lies_above_a_groove_below_rests() {
    let folder = tempfile::tempdir().unwrap();
    write_grooved_slab(&folder.path().join("g.msh"));
    for run in configurations() {
        for points in ["Nodes", "Faces"] {
            let text = format!(
                "(duration: 0.6, bodies: {{
                    \"a\": (mesh: File(path: \"g.msh\", hexes: Hex8MeanDilatation), material: \"m\"),
                    \"b\": (mesh: Box(size: (0.006, 0.006, 0.004), cells: (2, 2, 2), elements: Hex8MeanDilatation),
                        material: \"m\", translate: (0.0013, 0.0011, 0.00605))}},
                materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 5e4, poisson: 0.3), damping: 40)}},
                constraints: [Fixed(body: \"a\", on: All)],
                loads: [Gravity(acceleration: (0, 0, -9.81))],
                contacts: [Between(bodies: (\"a\", \"b\"), points: {points})])"
            );
            let what = format!("{}, {points}", run.name);
            let mut simulation = run.start_in(&text, folder.path());
            simulation.advance_to(0.6).unwrap();
            let weight = 9.81 * simulation.masses("b").unwrap().iter().sum::<f64>();
            let force = simulation.contact("b").unwrap().force;
            near(&what, force.distance(weight * DVec3::Z), 0.0, weight, 2e-3);
            let lowest = simulation.displacements("b").unwrap().iter().map(|u| u.z).fold(f64::INFINITY, f64::min);
            assert!((-1e-4..-3e-5).contains(&lowest), "{what}: {lowest} m");
        }
    }
}
