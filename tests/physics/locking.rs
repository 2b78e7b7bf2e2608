//! Near incompressibility: a bar of .1 × .02 × .02 m, clamped at x = 0, hangs under gravity; μ = 1e4 Pa, ν = .49.
//!
//! Reference: its end sinks by 73.85 ± .05 mm, by two independent implicit codes with quadratic hexahedra (FElupe
//! 73.80, CalculiX 73.90; docs/accuracy.md). With 20 × 4 × 4 cells plain tetrahedra must show their locking, and the
//! other kinds what they are for.

use crate::configurations::ELEMENTS;
use crate::locking::Bound::{Above, Below};
use crate::on_cpu::on_cpu;

const SINKS: f64 = 73.85e-3;

enum Bound {
    Above(f64),
    Below(f64),
}

#[test]
#[ignore = "long"]
fn elements_lock_as_told_or_not_at_all() {
    // wedges hold two volumes where hexahedra hold one, 1.5 degrees of freedom for each: they lock a little (8.2 % with
    // half the cells along each edge, 5.6 % here; hardly anything at ν = .3)
    let bounds = [Above(0.40), Below(0.09), Below(0.05), Below(0.02), Below(0.06), Below(0.02)];
    for (run, (elements, bound)) in on_cpu().iter().flat_map(|run| ELEMENTS.iter().zip(&bounds).map(move |e| (run, e)))
    {
        // as many nodes; with as many cells Tet10 is 0.1 % too stiff
        let cells = if *elements == "Tet10" { "10, 2, 2" } else { "20, 4, 4" };
        let mut simulation = run.start(&format!(
            "(duration: 1, analysis: Static(), bodies: {{\"b\": (mesh: Box(size: (0.1, 0.02, 0.02), cells: ({cells}), elements: {elements}), material: \"m\")}},
            materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 2.98e4, poisson: 0.49))}},
            constraints: [Fixed(on: Plane(normal: (1, 0, 0), at: 0))], loads: [Gravity(acceleration: (0, 0, -9.81))],
            probes: {{\"end\": (what: Displacement, on: Plane(normal: (1, 0, 0), at: 0.1))}})"
        ));
        simulation.finish().unwrap();
        let error = 1.0 + simulation.probe("end").unwrap()[2] / SINKS;
        println!("{}, {elements}: too stiff by {:.2} %", run.name, 100.0 * error);
        match bound {
            Above(least) => assert!(error > *least, "{}, {elements}: {error}", run.name),
            Below(most) => assert!(error.abs() < *most, "{}, {elements}: {error}", run.name),
        }
    }
}
