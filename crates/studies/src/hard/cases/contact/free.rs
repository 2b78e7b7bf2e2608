//! Free bodies that meet others: what they keep.

use super::super::super::Trial;
use super::measures::{gone, kinetic_and_spent, mass, moments};
use sinew::Error;
use sinew::Simulation;

/// H50.
pub fn oblique(trial: &mut Trial<'_>) -> Result<(), Error> {
    let bodies = ["body", "other"];
    for &friction in trial.some(&[0.0, 0.4]) {
        let mut sets = trial.elements_of(&["other"]);
        sets.push(format!("contacts=[Between(bodies: (\"body\", \"other\"), friction: {friction})]"));
        let mut simulation = trial.start(&sets)?;
        simulation.advance(1)?;
        let start = moments(&mut simulation, &bodies)?;
        let before = kinetic_and_spent(&mut simulation)?;
        let (mut force, mut highest) = (0.0_f64, 0.0_f64);
        while simulation.time() < 0.05 {
            simulation.advance(5)?;
            force = force.max(simulation.contact("other")?.force.length());
            highest = highest.max(kinetic_and_spent(&mut simulation)? / before);
        }
        let what = |what: &str| format!("{what}, friction {friction}");
        trial.least(what("largest force (N)"), force, 0.1);
        trial.most(what("energy over that at the start"), highest, 1.0 + trial.bound(1e-9, 1e-5));
        let end = moments(&mut simulation, &bodies)?;
        let scale = start[0].length();
        trial.most(what("change of momentum"), (end[0] - start[0]).length() / scale, trial.bound(1e-10, 1e-5));
        // friction acts across the gap between a point and its face
        let allowed = if friction == 0.0 { trial.bound(1e-6, 1e-4) } else { 1e-3 };
        let moment = (end[1] - start[1]).length() / (scale * 0.02);
        trial.most(what("change of its moment over momentum times side"), moment, allowed);
    }
    Ok(())
}

const PLANES: [&str; 6] = ["floor", "lid", "left", "right", "front", "back"];

/// Energy by the laws and by what was spent (J), each with what planes have taken and with the height of the body.
fn all_of_it(simulation: &mut Simulation, weight: f64) -> Result<[f64; 2], Error> {
    let mut more = weight * gone(simulation, "body")?.z;
    for plane in PLANES {
        more += simulation.tool(plane)?.loss.unwrap_or(f64::NAN);
    }
    let energies = simulation.energies()?;
    Ok([energies.kinetic + energies.strain + energies.hourglass + more, kinetic_and_spent(simulation)? + more])
}

/// H70.
pub fn bouncing(trial: &mut Trial<'_>) -> Result<(), Error> {
    let (samples, steps) = match (trial.full, trial.configuration.is_gpu()) {
        (true, _) => (100, 1_000_000),
        (_, true) => (10, 2_000),
        _ => (40, 20_000),
    };
    let mut simulation = trial.start(&["integration=(safety: 0.15)".into()])?;
    let weight = 9.81 * mass(&mut simulation, "body")?;
    simulation.advance(1)?;
    let start = all_of_it(&mut simulation, weight)?;
    let (mut worst, mut touched) = ([0.0_f64; 2], 0);
    for _ in 0..samples {
        simulation.advance(steps / samples)?;
        let now = all_of_it(&mut simulation, weight)?;
        worst = [0, 1].map(|i| worst[i].max((now[i] / start[i] - 1.0).abs()));
    }
    for plane in PLANES {
        touched += usize::from(simulation.tool(plane)?.loss.unwrap_or(f64::NAN) > 0.0);
    }
    trial.most("drift of energy by the laws", worst[0], trial.bound(1e-3, 1e-2));
    trial.most("drift of energy as it was spent", worst[1], trial.bound(1e-3, 1e-2));
    trial.least("planes that it has met", touched as f64, 2.0);
    // at rest, with nothing that could damp it
    let sets = ["bodies.body.velocity=(0, 0, 0)", "bodies.body.spin=(0, 0, 0)", "bodies.body.translate=(0, 0, 0.01)"];
    let mut sets: Vec<String> = sets.map(String::from).to_vec();
    sets.extend([
        "start=Equilibrium()".into(),
        "contacts=[Tool(tool: \"floor\")]".into(),
        "tools={\"floor\": (shape: Plane())}".into(),
    ]);
    sets.push("constraints=[Fixed(on: Plane(normal: (1, 0, 0), at: 0), axes: [X]), Fixed(on: Plane(normal: (0, 1, 0), at: 0), axes: [Y])]".into());
    let mut rests = trial.start(&sets)?;
    rests.advance(if trial.full { steps } else { steps / 10 })?;
    let kinetic = rests.energies()?.kinetic;
    trial.most("kinetic energy at rest over weight times radius", kinetic / (weight * 0.01), 1e-6);
    trial.near("weight on the floor at rest (N)", -rests.tool("floor")?.force.z, weight, 1e-3);
    Ok(())
}
