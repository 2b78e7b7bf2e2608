//! What slides along curved tools without friction keeps its energy: no work is done along a surface.

use crate::configurations::{Configuration, configurations, cpu_and_long_gpu, near};
use sinew::Simulation;

/// A cube of 4 mm that slides to and fro in a trough of a radius of 5 cm, and its first kinetic energy (J).
fn in_a_trough(run: &Configuration, free: &str) -> (Simulation, f64) {
    let simulation = run.start(&format!(
        "(duration: 1.1, materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 5e3, poisson: 0.3))}},
        bodies: {{\"c\": (mesh: Box(size: (0.004, 0.004, 0.004), cells: (1, 1, 1), elements: Hex8MeanDilatation), material: \"m\",
            translate: (-0.002, -0.002, -0.0499599), velocity: (0, 0.1, 0))}},
        tools: {{\"t\": (shape: Tube(length: 0.1, inner: 0.05, outer: 0.06), at: (-0.05, 0, 0), rotation: (0, 90, 0){free})}},
        contacts: [Tool(tool: \"t\", on: Set(\"z0\"))],
        loads: [Gravity(body: \"c\", acceleration: (0, 0, -9.81))], output: (energies_every: 0.1))"
    ));
    (simulation, 0.5 * 1000.0 * 0.004_f64.powi(3) * 0.1 * 0.1)
}

/// Nothing is lost but what shakes corners at the start; a fifth of it was, as much less as the step is shorter.
fn keeps_its_energy(run: &Configuration, free: &str) {
    let (mut simulation, kinetic) = in_a_trough(run, free);
    simulation.advance_to(0.98).unwrap();
    let (mut steps, mut touched) = (0, 0_usize);
    while simulation.time() < 1.0 {
        simulation.advance(1).unwrap();
        steps += 1;
        touched += usize::from(simulation.tool("t").unwrap().nodes > 0);
    }
    let what = format!("{}{free}", run.name);
    assert!(2 * touched > steps, "{what}: it touches the trough in {touched} steps of {steps}");
    let e = simulation.energies().unwrap();
    near(&format!("{what}: lost to contact"), e.contact_loss.unwrap(), 0.0, kinetic, 0.02);
}

#[test]
fn what_slides_in_a_trough_keeps_its_energy() {
    for run in configurations() {
        keeps_its_energy(&run, "");
    }
}

#[test]
fn what_slides_in_a_free_trough_keeps_its_energy() {
    for run in cpu_and_long_gpu() {
        keeps_its_energy(&run, ", free: (mass: 1)");
    }
}

/// A ball is pressed into a cube by 3 mm and held there: the cube rang ever more, by what contact gave it.
#[test]
fn tissue_under_a_ball_that_is_held_still_comes_to_rest() {
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(
            "(duration: 1.5, materials: {\"m\": (density: 1000, neo_hookean: Young(young: 5e3, poisson: 0.4), damping: 10)},
            bodies: {\"c\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (4, 4, 4)), material: \"m\")},
            constraints: [Fixed(on: Set(\"z0\"))],
            tools: {\"t\": (shape: Sphere(radius: 0.004), at: (0.01, 0.01, 0.025),
                moves: [(displacement: (0, 0, -0.004), curve: Smooth(end: 0.04))])},
            contacts: [Tool(tool: \"t\", thin: true)], output: (energies_every: 0.1))",
        );
        simulation.advance_to(0.1).unwrap();
        let early = simulation.energies().unwrap();
        simulation.advance_to(1.5).unwrap();
        let late = simulation.energies().unwrap();
        println!("{}: {early:?}, {late:?}", run.name);
        assert!(early.kinetic > 1e-6 && late.kinetic < 1e-8, "{}: {} J", run.name, late.kinetic);
        // 4e-5 J were given
        let taken = late.contact_loss.unwrap() - early.contact_loss.unwrap();
        assert!(taken > -1e-6, "{}: contact gave {} J", run.name, -taken);
        assert!(simulation.tool("t").unwrap().nodes > 0, "{}: it is touched", run.name);
    }
}
