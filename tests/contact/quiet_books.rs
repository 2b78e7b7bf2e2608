//! Who presses, holds and lifts without a jolt loses nothing and gains nothing, however it quickens and slows down.

use crate::configurations::{Configuration, configurations, cpu_and_long_gpu, near};
use sinew::Simulation;

/// A block that stands, and what it is of.
const BLOCK: &str =
    "\"b\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (4, 4, 4), elements: Hex8MeanDilatation), material: \"m\")";
const TISSUE: &str = "materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.4), damping: 20)}";

/// What pressing the block by a fifth takes (J).
const PRESSED: f64 = 6e-4;

/// A plate that presses the block by a fifth and is drawn back, as a tool that does so.
fn pressed(what: &str) -> String {
    format!(
        "(duration: 0.25, bodies: {{{BLOCK}}}, {TISSUE}, constraints: [Fixed(on: Set(\"z0\"))],
        tools: {{\"t\": (shape: Plane(), rotation: (180, 0, 0), at: (0, 0, 0.02), moves: [
            (displacement: (0, 0, -0.004), curve: Smooth(end: 0.1)),
            (displacement: (0, 0, 0.006), curve: Smooth(start: 0.12, end: 0.22))])}}, {what})"
    )
}

/// Whether nobody was warned of contact.
fn is_quiet(simulation: &mut Simulation, what: &str) {
    simulation.observe().unwrap();
    let warnings = simulation.summary("").unwrap().guards.warnings;
    assert!(warnings.iter().all(|notice| notice.criterion != "contact"), "{what}: {warnings:?}");
}

/// The tool was taken to go with its step to come where nodes go with the mean of two: what slows down while it presses
/// harder and harder seemed to give back 1.4 % of what it did, and was warned of.
#[test]
fn who_presses_quietly_loses_nothing() {
    for run in cpu_and_long_gpu() {
        for (what, least) in [
            ("contacts: [Tool(tool: \"t\")]", 1e-4),
            // springs end where nodes are, between steps
            ("contacts: [Tool(tool: \"t\", law: Penalty(share: 0.2))], integration: (step: 4e-4)", 5e-3),
        ] {
            let mut simulation = run.start(&pressed(what));
            for time in [0.06, 0.11, 0.25] {
                simulation.advance_to(time).unwrap();
                let tool = simulation.tool("t").unwrap();
                let (work, loss) = (tool.work.unwrap(), tool.loss.unwrap());
                println!("{}, {what}, {time} s: {work:e} J done, {loss:e} J lost", run.name);
                // springs hold what they come to
                let most = if least < 1e-3 || time > 0.2 { 0.01 } else { 1.0 };
                assert!(loss > -least * PRESSED && loss < most * PRESSED, "{}, {what}: {loss} J", run.name);
            }
            is_quiet(&mut simulation, run.name);
        }
    }
}

#[test]
fn who_holds_quietly_loses_nothing() {
    for run in cpu_and_long_gpu() {
        let grasp = "attachments: [Grasp(tool: \"t\", on: Set(\"z1\"), closed: Step())]";
        let mut simulation = run.start(&pressed(grasp));
        for time in [0.06, 0.11, 0.25] {
            simulation.advance_to(time).unwrap();
            let tool = simulation.tool("t").unwrap();
            let what = format!("{}, {time} s: {:e} J done", run.name, tool.work.unwrap());
            near(&what, tool.loss.unwrap(), 0.0, PRESSED, 1e-4);
        }
        is_quiet(&mut simulation, run.name);
    }
}

/// The block and a plate above it whose nodes go as told by a height (m), and what is between both.
fn plate(height: f64, between: &str, output: &str) -> String {
    format!(
        "(duration: 0.11, bodies: {{{BLOCK}, \"p\": (mesh: Box(size: (0.03, 0.03, 0.005), cells: (4, 4, 1),
            elements: Hex8MeanDilatation), material: \"m\", translate: (-0.005, -0.005, 0.02))}}, {TISSUE},
        constraints: [Fixed(body: \"b\", on: Set(\"z0\")),
            Prescribed(body: \"p\", on: All, displacement: (0, 0, {height}), curve: Smooth(end: 0.1))],
        {between} {output})"
    )
}

/// Whether all work or that of elements alone is counted, the last step of nodes that go as told is kept for it.
const OUTPUTS: [&str; 2] = ["", "output: (energies_every: 0.05)"];

fn ended(run: &Configuration, text: &str) -> Simulation {
    let mut simulation = run.start(text);
    simulation.finish().unwrap();
    simulation
}

/// `boundary` writes their step to come over the last one, which was taken for both: 1.3 % were warned of.
#[test]
fn what_goes_as_told_and_presses_loses_nothing() {
    for run in configurations() {
        for output in OUTPUTS {
            let mut simulation = ended(&run, &plate(-0.004, "contacts: [Between(bodies: (\"b\", \"p\"))],", output));
            let loss = simulation.energies().unwrap().contact_loss.unwrap();
            println!("{}, {output}: {loss:e} J lost", run.name);
            assert!(loss > -2e-3 * PRESSED && loss < 0.02 * PRESSED, "{}, {output}: {loss} J", run.name);
            is_quiet(&mut simulation, run.name);
        }
    }
}

/// Likewise where it draws by glue, which does no work.
#[test]
fn what_goes_as_told_and_draws_by_glue_loses_nothing() {
    for run in configurations() {
        for output in OUTPUTS {
            let glue = "attachments: [Glue(name: \"g\", bodies: (\"b\", \"p\"), reach: 1e-3)],";
            let simulation = &mut ended(&run, &plate(0.004, glue, output));
            let loss = simulation.attachment("g").unwrap().loss;
            near(&format!("{}, {output}", run.name), loss, 0.0, PRESSED, run.bound(1e-5, 1e-3));
        }
    }
}

/// Likewise where it lifts a free box.
#[test]
fn what_goes_as_told_and_lifts_a_free_tool_loses_nothing() {
    for run in cpu_and_long_gpu() {
        for output in OUTPUTS {
            let mut simulation = run.start(&format!(
                "(duration: 0.2, bodies: {{\"p\": (mesh: Box(size: (0.03, 0.03, 0.005), cells: (6, 6, 2),
                    elements: Hex8MeanDilatation), material: \"m\", translate: (-0.015, -0.015, -0.005))}}, {TISSUE},
                tools: {{\"t\": (shape: Box(size: (0.02, 0.02, 0.02)), at: (0, 0, 0.01), free: (density: 1000))}},
                contacts: [Tool(tool: \"t\", friction: 0.3)], loads: [Gravity(acceleration: (0, 0, -9.81))],
                constraints: [Prescribed(on: All, displacement: (0, 0, 0.01), curve: Smooth(start: 0.03, end: 0.18))],
                {output})"
            ));
            simulation.finish().unwrap();
            let tool = simulation.tool("t").unwrap();
            let lifted = 8e-3 * 9.81 * 0.01;
            near(&format!("{}, {output}: work", run.name), -tool.work.unwrap(), lifted, lifted, 1e-3);
            near(&format!("{}, {output}", run.name), tool.loss.unwrap(), 0.0, lifted, run.bound(1e-4, 1e-3));
        }
    }
}
