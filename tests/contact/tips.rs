//! What is pressed into a tip where three walls of one body meet, or more: it is borne by where they meet.

use crate::configurations::configurations;
use crate::written::Written;
use std::f64::consts::TAU;
use std::path::Path;

/// Writes a pit of so many walls that rise by 45° around the origin, 8 mm wide and 4 mm thick.
fn write_pit(path: &Path, walls: usize) {
    let mut mesh = Written::default();
    let mut ring = |down: f64| -> Vec<usize> {
        let tip = mesh.node([0.0, 0.0, -down]);
        let around = (0..walls).map(|i| {
            let (sine, cosine) = (TAU * i as f64 / walls as f64).sin_cos();
            mesh.node([0.008 * cosine, 0.008 * sine, 0.008 - down])
        });
        std::iter::once(tip).chain(around).collect()
    };
    let [low, high] = [0.004, 0.0].map(&mut ring);
    for i in 0..walls {
        let corners = [0, 1 + i, 1 + (i + 1) % walls];
        mesh.element([&corners.map(|corner| low[corner]), &corners.map(|corner| high[corner])]);
    }
    mesh.write(path);
}

/// Writes a spike upwards: a prism of four sides that ends in a node at the origin.
fn write_spike(path: &Path) {
    let mut mesh = Written::default();
    let tip = mesh.node([0.0; 3]);
    let sides = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)];
    let [low, high] = [0.004, 0.007].map(|z| sides.map(|(x, y)| mesh.node([0.0012 * x, 0.0012 * y, z])));
    mesh.element([&[low[0], low[1], low[2]], &[tip]]);
    mesh.element([&[low[0], low[2], low[3]], &[tip]]);
    mesh.element([&low, &high]);
    mesh.write(path);
}

/// A spike that is pressed in rests in the tip, and is borne along its axis: by two of the walls, now these and now
/// those, it was thrown about, and sank in by as much as it was pressed.
#[test]
fn a_spike_rests_where_walls_meet() {
    let folder = tempfile::tempdir().unwrap();
    write_spike(&folder.path().join("s.msh"));
    for walls in [3, 4, 6] {
        write_pit(&folder.path().join("p.msh"), walls);
        for run in configurations() {
            for (law, least) in [("", 2e-3), (", law: Penalty(share: 0.2, damping: 0.3)", 5e-4)] {
                let text = format!(
                    "(duration: 0.4, bodies: {{
                        \"p\": (mesh: File(path: \"p.msh\"), material: \"m\"),
                        \"s\": (mesh: File(path: \"s.msh\"), material: \"m\", translate: (0, 0, 1e-5))}},
                    materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e5, poisson: 0.3), damping: 100)}},
                    constraints: [Fixed(body: \"p\", on: All),
                        Prescribed(body: \"s\", on: Plane(normal: (0, 0, 1), at: 0.00701, tolerance: 1e-6),
                            displacement: (0, 0, -2e-4), curve: Smooth(end: 0.2))],
                    contacts: [Between(bodies: (\"p\", \"s\"), friction: 0{law})])"
                );
                let what = format!("{}, {walls} walls{law}", run.name);
                let mut simulation = run.start_in(&text, folder.path());
                let seen = [0.3, 0.4].map(|time| {
                    simulation.advance_to(time).unwrap();
                    simulation.displacements("s").unwrap()[0]
                });
                let force = simulation.contact("s").unwrap().force;
                println!("{what}: {force} N, {} m", seen[1]);
                assert!(force.z > least && force.truncate().length() < 0.15 * force.z, "{what}: {force} N");
                assert!(seen[0].distance(seen[1]) < 1e-7, "{what}: {seen:?} m");
                // the node where walls meet may come out of it at a side of its, which leans by .3
                let (aside, deep) = (seen[1].truncate().length(), -seen[1].z - 1e-5);
                assert!(aside < 0.3 * deep + 2e-6, "{what}: {} m", seen[1]);
            }
        }
    }
}
