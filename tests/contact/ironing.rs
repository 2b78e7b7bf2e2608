//! A ball that is drawn over a block: how much the force ripples as nodes come and go.

use crate::configurations::configurations;

/// C14 between bodies: pressed in by a tenth of the radius and drawn over ten faces, four of them on the radius of
/// contact. The force along the way is μ times that down but for what friction draws along, which leans against the
/// ball.
#[test]
#[ignore = "long"]
fn a_ball_is_drawn_over_a_block_with_an_even_force() {
    let scene = "(duration: 0.3, bodies: {
            \"body\": (mesh: Box(size: (0.012, 0.008, 0.004), cells: (30, 20, 10), elements: Hex8), material: \"tissue\",
                translate: (0, -0.004, -0.004)),
            \"ball\": (mesh: Ellipsoid(radii: (5e-3, 5e-3, 5e-3), across: 24, elements: Hex8), material: \"tissue\",
                translate: (0.004, 0, 5.01e-3))},
        materials: {\"tissue\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45), damping: 60)},
        constraints: [Fixed(body: \"body\", on: Set(\"z0\")),
            Prescribed(body: \"ball\", on: All, axes: [X, Y], displacement: (0.004, 0, 0), curve: Ramp(start: 0.1, end: 0.3)),
            Prescribed(body: \"ball\", on: All, axes: [Z], displacement: (0, 0, -0.51e-3), curve: Ramp(end: 0.1))],
        contacts: [Between(bodies: (\"body\", \"ball\"), friction: 0.2)])";
    // what a GPU in software would take minutes for
    for run in configurations().iter().filter(|run| run.name == "CPU f32") {
        let mut simulation = run.start(scene);
        // the touching nodes have changed all round once it has gone two faces far
        simulation.advance_to(0.14).unwrap();
        let (mut least, mut most, mut along, mut down) = (f64::INFINITY, 0.0_f64, 0.0, 0.0);
        while simulation.time() < 0.3 {
            simulation.advance_to((simulation.time() + 0.002).min(0.3)).unwrap();
            let force = simulation.contact("ball").unwrap().force;
            (least, most) = (least.min(force.z), most.max(force.z));
            (along, down) = (along - force.x, down + force.z);
        }
        let ripple = (most - least) / (0.5 * (most + least));
        println!("{}: {least} to {most} N, ripple {ripple}, along over down {}", run.name, along / down);
        assert!(least > 5e-3 && ripple <= 0.05, "{}: {least} to {most} N, {ripple}", run.name);
        assert!((along / down - 0.2).abs() <= 0.05 * 0.2, "{}: {} of 0.2", run.name, along / down);
    }
}
