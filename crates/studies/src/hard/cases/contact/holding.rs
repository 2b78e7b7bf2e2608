//! What is held: by forceps, by a thread, by glue.

use super::super::super::Trial;
use super::measures::mass;
use sinew::components::DisplacementIncrement;
use sinew::{Error, Simulation};

/// Momentum of the body along z (kg m/s), in the middle of the last step.
fn rising(simulation: &mut Simulation) -> Result<f64, Error> {
    let (masses, rate) = (simulation.masses("body")?, 1.0 / simulation.time_step());
    let view = simulation.column::<DisplacementIncrement>("body")?;
    let rows = view.node_rows().iter().zip(masses);
    Ok(rows.map(|(&row, mass)| view.values().vector(row as usize).z * rate * mass).sum())
}

/// Kinetic energy and what elements hold (J).
fn energy(simulation: &mut Simulation) -> Result<f64, Error> {
    let energies = simulation.energies()?;
    Ok(energies.kinetic + energies.strain + energies.hourglass)
}

/// H61.
pub fn grasp(trial: &mut Trial<'_>) -> Result<(), Error> {
    for &(density, young, cells) in trial.some(&[(1000.0, 3e3, 3), (600.0, 2e3, 2)]) {
        lifted(trial, density, young, cells)?;
    }
    Ok(())
}

/// A cube of a density (kg/m³), a modulus (Pa) and so many cells across.
fn lifted(trial: &mut Trial<'_>, density: f64, young: f64, cells: u32) -> Result<(), Error> {
    let elements = trial.configuration.elements_name();
    let mut simulation = trial.start(&[
        format!(
            "bodies.body.mesh=Box(size: (0.02, 0.02, 0.02), cells: ({cells}, {cells}, {cells}), elements: {elements})"
        ),
        format!(
            "materials.tissue=(density: {density}, neo_hookean: Young(young: {young}, poisson: 0.45), damping: 20)"
        ),
    ])?;
    let held = (cells as usize + 1).pow(2);
    let what = |what: &str| format!("{what}, {cells} cells of {young} Pa");
    let weight = 9.81 * mass(&mut simulation, "body")?;
    let largest = 0.03 * weight;
    simulation.advance_to(0.88)?;
    let (mut before, mut jump) = (energy(&mut simulation)?, 0.0_f64);
    while simulation.time() < 0.95 {
        simulation.advance(1)?;
        let now = energy(&mut simulation)?;
        jump = jump.max((now - before).abs() / largest);
        before = now;
    }
    trial.most(what("energy that closing makes or takes, of the largest"), jump, 1e-6);
    trial.holds(what("it is closed"), simulation.tool("forceps")?.nodes == held);
    simulation.advance_to(2.65)?;
    let reading = simulation.tool("forceps")?;
    trial.near(what("weight that hangs on it (N)"), -reading.force.z, weight, 1e-4);
    trial.most(what("force aside, of the weight"), reading.force.truncate().length() / weight, 1e-4);
    trial.holds(what("the table bears nothing"), simulation.tool("table")?.nodes == 0);
    simulation.advance_to(2.79)?;
    let mut jump = 0.0_f64;
    let mut before = rising(&mut simulation)?;
    while simulation.time() < 2.81 {
        simulation.advance(1)?;
        let now = rising(&mut simulation)?;
        // gravity and damping take no more in a step
        let bound = (1.01 * weight + 20.0 * before.abs()) * simulation.time_step();
        jump = jump.max((now - before).abs() / bound);
        before = now;
    }
    trial.most(what("change of momentum in a step while it opens, of what weight and damping make"), jump, 1.0);
    trial.holds(what("it is open"), simulation.tool("forceps")?.nodes == 0);
    Ok(())
}

/// Draws on what holds two bodies together until nothing of it does; gates what it bore (N), and what is booked of the
/// energy that bodies lost by it, which is told.
fn torn(trial: &mut Trial<'_>, sets: &[String], what: &str, strength: f64) -> Result<f64, Error> {
    let mut simulation = trial.start(sets)?;
    let mut most = 0.0_f64;
    while simulation.time() < 0.8 && simulation.attachment("seam")?.holds > 0 {
        simulation.advance(1)?;
        most = most.max(simulation.attachment("seam")?.force.length());
    }
    trial.near(format!("force that {what} bears (N)"), most, strength, 0.02);
    simulation.advance_to(1.0)?;
    let reading = simulation.attachment("seam")?;
    trial.holds(format!("{what} holds nothing any more"), reading.holds == 0 && reading.force.length() == 0.0);
    let energies = simulation.energies()?;
    let [spent, damped] = [energies.constraint_work, energies.damping_loss].map(|energy| energy.unwrap_or(f64::NAN));
    let left = energy(&mut simulation)?;
    let nobodys = (spent - damped - left - reading.loss) / spent;
    trial.most(format!("energy that {what} lost and nobody booked, of what was spent"), nobodys, 0.02);
    Ok(reading.loss)
}

/// H62.
pub fn suture(trial: &mut Trial<'_>) -> Result<(), Error> {
    for &(stiffness, strength, young, across) in trial.some(&[(50.0, 0.1, 2e4, 3), (80.0, 0.06, 4e4, 4)]) {
        let elements = trial.configuration.elements_name();
        let mut bars = vec![format!("materials.tissue.neo_hookean=Young(young: {young}, poisson: 0)")];
        bars.extend(["low", "up"].map(|body| {
            format!(
                "bodies.{body}.mesh=Box(size: (0.01, 0.01, 0.02), cells: ({across}, {across}, 6), elements: {elements})"
            )
        }));
        let of_thread =
            [format!("attachments[0].stiffness={stiffness}"), format!("attachments[0].strength={strength}")];
        let loss = torn(trial, &[&bars[..], &of_thread].concat(), &format!("a thread of {stiffness} N/m"), strength)?;
        let stored = 0.5 * strength * strength / stiffness;
        trial.near(format!("energy of the thread of {stiffness} N/m when it tears (J)"), loss, stored, 0.02);
        // on a square centimetre
        let pressure = strength * 1e4;
        let glue = [
            "bodies.up.translate=(0, 0, 0.02)".to_string(),
            format!(
                "attachments=[Glue(name: \"seam\", bodies: (\"low\", \"up\"), normal: {pressure}, shear: {pressure})]"
            ),
        ];
        torn(trial, &[&bars[..], &glue].concat(), &format!("glue of {pressure} Pa"), strength)?;
    }
    Ok(())
}
