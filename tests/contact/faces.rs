//! Points of faces: how even pressures are across meshes that do not match, friction, and what else must hold of them.

use crate::configurations::{Configuration, ELEMENTS, configurations, near};

/// Two blocks between walls whose cells do not match, pressed together (C12): by how much stresses are off the
/// pressure, and the sum of what one feels (N).
fn patch(run: &Configuration, elements: &str, cells: (u32, u32), contact: &str) -> (f64, f64) {
    let (below, above) = cells;
    let mut simulation = run.start(&format!(
        "(duration: 2, bodies: {{
            \"low\": (mesh: Box(size: (0.02, 0.02, 0.01), cells: ({below}, {below}, 2), elements: {elements}), material: \"m\"),
            \"high\": (mesh: Box(size: (0.02, 0.02, 0.01), cells: ({above}, {above}, 3), elements: {elements}), material: \"m\", translate: (0, 0, 0.01))}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.3), damping: 30)}},
        constraints: [Fixed(body: \"low\", on: Set(\"z0\"), axes: [Z]),
            Fixed(body: \"low\", on: Or([Set(\"x0\"), Set(\"x1\")]), axes: [X]), Fixed(body: \"low\", on: Or([Set(\"y0\"), Set(\"y1\")]), axes: [Y]),
            Fixed(body: \"high\", on: Or([Set(\"x0\"), Set(\"x1\")]), axes: [X]), Fixed(body: \"high\", on: Or([Set(\"y0\"), Set(\"y1\")]), axes: [Y])],
        loads: [Pressure(body: \"high\", on: Set(\"z1\"), pressure: 100, curve: Smooth(end: 0.5))],
        contacts: [Between(bodies: (\"low\", \"high\"){contact})])"
    ));
    simulation.finish().unwrap();
    let mut worst = 0.0_f64;
    for body in ["low", "high"] {
        for stress in simulation.fields(body).unwrap().stress {
            worst = worst.max((stress[2] / 100.0 + 1.0).abs());
        }
    }
    (worst, simulation.contact("high").unwrap().force.z)
}

/// Stresses with points of faces are off the pressure by less than a bound, and by less than a share of what nodes
/// leave.
fn is_even(run: &Configuration, elements: &str, cells: (u32, u32)) {
    let what = format!("{}, {elements}, {cells:?}", run.name);
    let mut off = [0.0; 2];
    for (off, points) in off.iter_mut().zip(["Nodes", "Faces"]) {
        let (worst, force) = patch(run, elements, cells, &format!(", sweeps: {}, points: {points}", std::env::var("ASK").unwrap_or("4".into())));
        near(&what, force, 100.0 * 4e-4, 0.04, 2e-3);
        *off = worst;
    }
    let [of_nodes, of_faces] = off;
    println!("{what}: stresses off by {of_faces:.4} with points of faces, {of_nodes:.4} with nodes");
    if std::env::var("ASK").is_err() {
    assert!(of_faces < 0.018 && of_faces < 0.75 * of_nodes, "{what}: {of_faces} and {of_nodes}");
    }
}

/// The contact patch test on meshes that do not match (C12). After four sweeps nodes of both surfaces leave stresses
/// off by 2 to 3 % with tetrahedra and 8 to 15 % with hexahedra; points of faces are to come within 1.5 %, and a fifth
/// of that.
#[test]
fn points_of_faces_pass_the_patch_test_more_exactly_than_nodes() {
    for run in configurations().iter().filter(|run| !run.name.starts_with("GPU")) {
        for elements in ["Tet4", "Hex8"] {
            is_even(run, elements, (4, 6));
        }
    }
}

#[test]
#[ignore = "long"]
fn points_of_faces_pass_the_patch_test_on_other_meshes_and_beside_a_gpu() {
    for run in configurations() {
        // on a GPU the columns come and go in every step
        let elements = if run.name.starts_with("GPU") { &ELEMENTS[..1] } else { &ELEMENTS[..] };
        for elements in elements {
            for points in ["Nodes", "Faces"] {
                let (worst, _) = patch(&run, elements, (7, 5), &format!(", points: {points}"));
                println!("{}, {elements}: off by {worst:.4} with {points} in one sweep", run.name);
            }
            is_even(&run, elements, (7, 5));
        }
    }
}
