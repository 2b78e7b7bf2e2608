//! What contact takes in implicit steps, beside what its forces do to bodies.

use crate::bits::start;
use crate::configurations::near;
use sinew::components::{Precision, WORK_NUMBERS, Work};

/// A box of so many cells.
fn block(name: &str, size: &str, cells: &str, how: &str) -> String {
    let mesh = format!("Box(size: ({size}), cells: ({cells}), elements: Hex8MeanDilatation)");
    format!("\"{name}\": (mesh: {mesh}, material: \"m\", {how})")
}

/// A block that is thrown on another, and slides.
fn thrown(points: &str) -> String {
    format!(
        "bodies: {{{}, {}}},
        constraints: [Fixed(body: \"low\", on: Plane(normal: (0, 0, 1), at: 0))],
        contacts: [Between(bodies: (\"low\", \"top\"), friction: 0.3, points: {points},
            law: Penalty(share: 1, damping: 0.1))],",
        block("low", "0.02, 0.02, 0.01", "4, 4, 2", ""),
        block("top", "0.01, 0.01, 0.01", "3, 3, 3", "translate: (0.005, 0.005, 0.0101), velocity: (0.05, 0, -0.2)"),
    )
}

/// Two bars whose edges cross, one thrown on the other.
fn crossed() -> String {
    format!(
        "bodies: {{{}, {}}},
        constraints: [Fixed(body: \"low\", on: All)],
        contacts: [Between(bodies: (\"low\", \"top\"), edges: true, law: Penalty(share: 1))],",
        block("low", "0.04, 0.01, 0.01", "1, 1, 1", "rotate: (45, 0, 0)"),
        block(
            "top",
            "0.01, 0.04, 0.01",
            "1, 1, 1",
            "rotate: (0, 45, 0), translate: (0.013, -0.02, 0.0215), velocity: (0, 0, -0.2)"
        ),
    )
}

/// A block that is thrown into the corner between a floor and a wall, whose nodes face both.
fn cornered() -> String {
    format!(
        "bodies: {{{}, {}, {}}},
        constraints: [Fixed(body: \"floor\", on: All), Fixed(body: \"wall\", on: All)],
        contacts: [Between(bodies: (\"floor\", \"top\"), friction: 0.2, law: Penalty(share: 1)),
            Between(bodies: (\"wall\", \"top\"), friction: 0.2, law: Penalty(share: 1))],",
        block("floor", "0.06, 0.03, 0.01", "1, 1, 1", "translate: (-0.02, -0.01, -0.01)"),
        block("wall", "0.06, 0.01, 0.03", "1, 1, 1", "translate: (-0.02, -0.01, 0)"),
        block("top", "0.01, 0.01, 0.01", "2, 2, 2", "translate: (0, 1e-4, 1e-4), velocity: (0.05, -0.1, -0.2)"),
    )
}

/// A block that is thrown on a table, which comes towards it.
fn on_a_table() -> String {
    format!(
        "bodies: {{{}}},
        tools: {{\"table\": (shape: Plane(), moves: [(displacement: (0, 0, 1e-3), curve: Smooth(end: 0.02))])}},
        contacts: [Tool(tool: \"table\", friction: 0.3, law: Penalty(share: 1, damping: 0.1))],",
        block("top", "0.01, 0.01, 0.01", "3, 3, 3", "translate: (0, 0, 0.0001), velocity: (0.1, 0, -0.2)"),
    )
}

/// There are no loads but contact: what bodies get by these it has given, and tools have done. Both are sums of the
/// same forces and ways, of some hundred numbers in 60 steps, whatever the solver leaves of its residual: they differ
/// by roundings, each of 1e-16 of what the bodies move with.
#[test]
fn contact_takes_in_implicit_steps_what_its_forces_take_from_bodies() {
    let scenes: [(&str, &[&str], String); 5] = [
        ("nodes", &["low", "top"], thrown("Nodes")),
        ("faces", &["low", "top"], thrown("Faces")),
        ("edges", &["low", "top"], crossed()),
        ("corner", &["floor", "wall", "top"], cornered()),
        ("tool", &[], on_a_table()),
    ];
    for scheme in ["Euler", "GeneralizedAlpha()"] {
        for (name, meet, scene) in &scenes {
            let mut simulation = start(
                &format!(
                    "(duration: 0.06, solver: Implicit(step: 1e-3, scheme: {scheme}), {scene}
                    materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 2e4, poisson: 0.3))}},
                    output: (energies_every: 1e-3))"
                ),
                Precision::F64,
                1,
            );
            let scale = simulation.energies().unwrap().kinetic;
            let mut most = 0.0_f64;
            for time in [0.001, 0.002, 0.003, 0.005, 0.008, 0.01, 0.015, 0.03, 0.06] {
                simulation.advance_to(time).unwrap();
                let what = format!("{name}, {scheme}, {time} s");
                let (mut work, mut told) = (0.0, 0.0);
                if meet.is_empty() {
                    let table = simulation.tool("table").unwrap();
                    (work, told) = (table.work.unwrap(), table.loss.unwrap());
                }
                for body in *meet {
                    let taken = simulation.contact(body).unwrap().loss.unwrap();
                    let view = simulation.column::<Work>(body).unwrap();
                    let of_body = (0..view.values().len()).step_by(WORK_NUMBERS).map(|i| view.values().get(i)).sum();
                    near(&format!("{what}: {body}"), of_body, -taken, scale, 1e-12);
                    told += taken;
                }
                let e = simulation.energies().unwrap();
                let (load_work, loss) = (e.load_work.unwrap(), e.contact_loss.unwrap());
                near(&format!("{what}: work"), load_work, work - loss, scale, 1e-12);
                near(&format!("{what}: told"), told, loss, scale, 1e-12);
                most = most.max(load_work.abs());
            }
            assert!(most > 0.05 * scale, "{name}, {scheme}: they hardly touched: {most} J of {scale}");
            // all have let go
            if meet.is_empty() {
                assert_eq!(simulation.tool("table").unwrap().nodes, 0, "{name}, {scheme}");
            }
            for body in *meet {
                assert_eq!(simulation.contact(body).unwrap().points, 0, "{name}, {scheme}: {body}");
            }
        }
    }
}
