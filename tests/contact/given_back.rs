//! What sinks in is pushed out again, and may have more energy than it came with: that is told, and sweeps mend it.

use crate::configurations::cpu_and_long_gpu;

/// Two free cubes of which one meets the face of the other with an edge. One sweep leaves nodes of the edge inside, and
/// when some have let go the rest of them yields less, and is thrown out.
#[test]
fn an_edge_that_bounces_off_a_face_is_given_more_than_it_brought_by_one_sweep_alone() {
    let cube = "mesh: Box(size: (0.02, 0.02, 0.02), cells: (4, 4, 4), elements: Tet4)";
    for run in cpu_and_long_gpu() {
        for (young, sweeps) in [(1e6, 1), (1e6, 8), (1e4, 8)] {
            // a software device takes its time
            if run.name.contains("GPU") && young < 1e6 {
                continue;
            }
            let mut simulation = run.start(&format!(
                "(duration: 0.05, bodies: {{
                    \"a\": ({cube}, material: \"m\", rotate: (0, 45, 0)),
                    \"b\": ({cube}, material: \"m\", rotate: (45, 0, 0), translate: (-0.021, 0.013333, -0.014142),
                        velocity: (0.2, 0, 0))}},
                materials: {{\"m\": (density: 1000, neo_hookean: Young(young: {young}, poisson: 0.3))}},
                contacts: [Between(bodies: (\"a\", \"b\"), sweeps: {sweeps})])"
            ));
            simulation.advance_to(0.05).unwrap();
            let energies = simulation.energies().unwrap();
            let (held, loss) = (energies.kinetic + energies.strain, energies.contact_loss.unwrap());
            let warnings = simulation.summary("").unwrap().guards.warnings;
            let told = warnings.iter().any(|notice| notice.criterion == "contact");
            println!("{}, {young} Pa, {sweeps} sweeps: {held:.4e} J of 1.6e-4, {loss:.2e} J lost", run.name);
            assert_eq!((told, loss < -1.6e-6), (sweeps == 1, sweeps == 1), "{}, {young}: {loss} J", run.name);
            // kinetic energy of the middle of a step
            assert!(held + loss > 1.58e-4 && held + loss < 1.62e-4, "{}, {young}: {held} J", run.name);
        }
    }
}

/// What begins inside comes out and has energy that nobody gave: that is told.
#[test]
fn what_begins_inside_and_is_pushed_out_is_warned_of() {
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(
            "(duration: 0.1, bodies: {
                \"a\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (3, 3, 3)), material: \"m\"),
                \"b\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (3, 3, 3)), material: \"m\", translate: (0, 0, 0.018))},
            materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e4, poisson: 0.3))},
            contacts: [Between(bodies: (\"a\", \"b\"))])",
        );
        simulation.advance_to(0.1).unwrap();
        let warnings = simulation.summary("").unwrap().guards.warnings;
        let told: Vec<_> = warnings.iter().filter(|notice| notice.criterion == "contact").collect();
        assert_eq!(told.len(), 1, "{}: {warnings:?}", run.name);
        let text = &told[0].message;
        assert!(text.contains("more than it took") && text.contains("more `sweeps`"), "{}: {text}", run.name);
    }
}
