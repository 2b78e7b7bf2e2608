//! The kinematic law between bodies at rest, by relaxation: what is found, beside springs, and how it ends.

use crate::bits::start;
use crate::configurations::near;
use sinew::components::Precision;
use sinew::{Error, Simulation};

/// A block that is led down on another by a depth (m), and how that ended.
fn pressed(elements: &str, depth: f64, contact: &str) -> (Simulation, Result<(), Error>) {
    let text = format!(
        "(duration: 1, analysis: Static(),
        bodies: {{\"low\": (mesh: Box(size: (0.02, 0.02, 0.01), cells: (4, 4, 2), elements: {elements}), material: \"m\"),
            \"high\": (mesh: Box(size: (0.01, 0.01, 0.01), cells: (3, 3, 3), elements: {elements}), translate: (0.004, 0.003, 0.012), material: \"m\")}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.4))}},
        constraints: [Fixed(body: \"low\", on: Plane(normal: (0, 0, 1), at: 0)),
            Prescribed(body: \"high\", on: Plane(normal: (0, 0, 1), at: 0.022), displacement: (0, 0, -{depth:?}))],
        contacts: [Between(bodies: (\"low\", \"high\"), {contact})],
        probes: {{\"base\": (body: \"low\", what: Force(direction: (0, 0, 1)), on: Plane(normal: (0, 0, 1), at: 0)),
            \"lid\": (body: \"high\", what: Force(direction: (0, 0, 1)), on: Plane(normal: (0, 0, 1), at: 0.022))}})"
    );
    let mut simulation = start(&text, Precision::F64, 1);
    let ended = simulation.finish();
    (simulation, ended)
}

/// At rest: the force between the blocks (N), equal at both ends, and how deep points are inside (m).
fn at_rest(elements: &str, depth: f64, contact: &str) -> (f64, f64) {
    let (mut simulation, ended) = pressed(elements, depth, contact);
    ended.unwrap();
    let found = simulation.equilibrium().unwrap();
    assert!(found.reached && found.residual <= 1e-6, "{contact}: {found:?}");
    let [base, lid] = ["base", "lid"].map(|probe| simulation.probe(probe).unwrap()[0]);
    let reading = simulation.contact("high").unwrap();
    assert!(reading.loss.is_none(), "nothing at rest counts what is lost: {reading:?}");
    near(&format!("{elements}, {contact}: base"), base.abs(), reading.force.z, reading.force.z, 1e-6);
    near(&format!("{elements}, {contact}: lid"), lid.abs(), reading.force.z, reading.force.z, 1e-6);
    println!("{elements}, {contact}: {} N, {} m", reading.force.z, reading.penetration);
    (reading.force.z, reading.penetration)
}

/// With sweeps enough that nothing of a correction is left, points end on faces, and the force is the one that springs
/// come to as they are made stiffer: along a straight line in the depth by which they give way.
#[test]
fn blocks_rest_by_the_kinematic_law_where_ever_stiffer_springs_have_them() {
    for (elements, depth) in [("Hex8MeanDilatation", 3e-3), ("Tet4", 2.2e-3)] {
        let (force, inside) = at_rest(elements, depth, "sweeps: 64");
        assert!(inside < 1e-12, "{elements}: {inside} m");
        let [soft, stiff] = [1, 10].map(|share| at_rest(elements, depth, &format!("law: Penalty(share: {share})")));
        assert!(soft.1 > 5.0 * stiff.1 && soft.0 < stiff.0, "{elements}: {soft:?} {stiff:?}");
        let limit = stiff.0 + stiff.1 * (stiff.0 - soft.0) / (soft.1 - stiff.1);
        near(&format!("{elements}: limit of springs"), force, limit, limit, 3e-3);
        assert!(force > stiff.0, "{elements}: {force} {stiff:?}");
    }
}

/// One sweep a step leaves something of each correction, which goes round among hexahedra: there is no rest to 1e-6 of
/// the loads, and the analysis says so, with the residual, some 1e-2 of them.
#[test]
fn what_one_sweep_leaves_may_keep_blocks_from_rest_and_is_told() {
    let (simulation, ended) = pressed("Hex8MeanDilatation", 3e-3, "sweeps: 1");
    let told = ended.unwrap_err().to_string();
    assert!(told.contains("no equilibrium after") && told.contains("the residual is"), "{told}");
    let found = simulation.equilibrium().unwrap();
    assert!(!found.reached && found.residual > 1e-4 && found.residual < 3e-2, "{found:?}");
}
