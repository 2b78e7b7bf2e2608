//! What lies still, and what is pressed.

use super::super::super::Trial;
use super::super::point::Law;
use super::measures::{last_window, mass, momentum, places, steps};
use glam::DVec3;
use sinew::Error;
use sinew::Simulation;

const G: f64 = 9.81;

/// H45.
pub fn rests(trial: &mut Trial<'_>) -> Result<(), Error> {
    for &(side, young, cells) in trial.some(&[(0.02, 3e3, 3), (0.005, 1e3, 2), (0.05, 2e4, 4)]) {
        let elements = trial.configuration.elements_name();
        let sets = [
            format!(
                "bodies.body.mesh=Box(size: ({side}, {side}, {side}), cells: ({cells}, {cells}, {cells}), elements: {elements})"
            ),
            format!("materials.tissue.neo_hookean=Young(young: {young}, poisson: 0.45)"),
        ];
        let mut simulation = trial.start(&sets)?;
        let weight = G * mass(&mut simulation, "body")?;
        simulation.finish()?;
        let (reading, step) = (simulation.tool("table")?, simulation.time_step());
        let fastest = steps(&mut simulation, "body")?.iter().fold(0.0, |most: f64, step| most.max(step.length()));
        let what = |what: &str| format!("{what}, a cube of {side} m and {young} Pa");
        trial.near(what("weight on the table (N)"), -reading.force.z, weight, 1e-4);
        // a GPU's kernels know places from the middle of the body in f32, to 1.2e-7 of the side: in a step that is a
        // speed
        trial.most(what("fastest node (m/s)"), fastest / step, trial.bound(1e-7, 1.2e-7 * side / step));
        // in f32 displacements, some percent of the side, are known to their last bit
        trial.depth(what("inside the table (m)"), reading.penetration, trial.bound(1e-15, 1e-7 * side));
    }
    Ok(())
}

/// H46.
pub fn stack(trial: &mut Trial<'_>) -> Result<(), Error> {
    let (young, side) = (3e3, 0.02);
    // a step on a GPU comes to the host and goes back
    let short = trial.configuration.is_gpu() && !trial.full;
    for &cells in trial.some(&[4, 3]) {
        let mut sets = trial.elements_of(&["other"]);
        sets.push(format!("bodies.other.mesh.cells=({cells}, {cells}, 3)"));
        let mut simulation = trial.start(&sets)?;
        let weight = G * mass(&mut simulation, "other")?;
        let end = if short { 1.6 } else { 2.0 };
        simulation.advance_to(end - 0.5)?;
        let earlier = simulation.displacements("other")?;
        simulation.advance_to(end)?;
        let moved = simulation.displacements("other")?.into_iter().zip(earlier);
        let farthest = moved.map(|(now, then)| now.distance(then)).fold(0.0, f64::max);
        let what = |what: &str| format!("{what}, {cells} cells on 3");
        trial.most(what("creeps in half a second (m)"), farthest, if short { 3e-6 } else { 1e-7 });
        let (high, low) = (simulation.contact("other")?, simulation.contact("body")?);
        trial.near(what("force between (N)"), high.force.z, weight, 1e-3);
        trial.most(
            what("sum of both over weight"),
            (high.force + low.force).length() / weight,
            trial.bound(1e-10, 1e-5),
        );
        trial.near(what("force on the table (N)"), -simulation.tool("table")?.force.z, 2.0 * weight, 1e-3);
        let left = 0.2 * (side / 3.0) * (weight / (side * side)) / young;
        trial.depth(what("inside each other (m)"), high.penetration.max(low.penetration), left);
        if !short && !trial.is_implicit() {
            let ripple = ripple(trial, &sets, weight)?;
            trial.report(what("ripple of the force with one sweep"), ripple);
        }
    }
    Ok(())
}

/// How far the force between the cubes is off their weight at most, in a hundred steps, where forces are corrected once
/// a step.
fn ripple(trial: &Trial<'_>, sets: &[String], weight: f64) -> Result<f64, Error> {
    let mut sets = sets.to_vec();
    sets.push("contacts[1]=Between(bodies: (\"body\", \"other\"), friction: 0.5)".into());
    let mut simulation = trial.start(&sets)?;
    simulation.advance_to(1.5)?;
    let mut most = 0.0_f64;
    for _ in 0..100 {
        simulation.advance(1)?;
        most = most.max((simulation.contact("other")?.force.z / weight - 1.0).abs());
    }
    Ok(most)
}

/// H48.
pub fn punch(trial: &mut Trial<'_>) -> Result<(), Error> {
    let side = 0.02;
    for &(depth, young, poisson) in trial.some(&[(3e-3, 3e3, 0.45), (1e-3, 2e4, 0.3)]) {
        let mut sets = vec![
            format!("tools.plate.moves[0].displacement=(0, 0, {})", -depth),
            format!("materials.tissue.neo_hookean=Young(young: {young}, poisson: {poisson})"),
        ];
        if !trial.configuration.is_f64() {
            sets.push("analysis=Static()".into());
        }
        let mut simulation = trial.start(&sets)?;
        simulation.finish()?;
        let what = |what: &str| format!("{what}, {depth} m deep");
        let stress: Vec<f64> = simulation.fields("body")?.stress.iter().map(|stress| stress[2]).collect();
        let mean = stress.iter().sum::<f64>() / stress.len() as f64;
        let off = stress.iter().fold(0.0, |most: f64, stress| most.max((stress / mean - 1.0).abs()));
        trial.most(what("stress of an element off the mean"), off, trial.bound(1e-6, 1e-3));
        let (plate, held) = (simulation.tool("plate")?, simulation.probe("base")?[2]);
        // springs give way
        let squeezed = depth - if trial.is_implicit() { plate.penetration } else { 0.0 };
        let (felt, expected) = (plate.force.z, -Law::young(young, poisson).free(1.0 - squeezed / side) * side * side);
        trial.near(what("force (N)"), felt, expected, trial.bound(1e-5, 1e-3));
        trial.near(what("force of the base (N)"), held, felt, trial.bound(1e-6, 1e-3));
    }
    Ok(())
}

/// H68.
pub fn three_forces(trial: &mut Trial<'_>) -> Result<(), Error> {
    for &(friction, young, damping, cells) in
        trial.some(&[(0.3, 3e3, 20.0, 6), (0.0, 3e3, 20.0, 6), (0.5, 2e4, 60.0, 4)])
    {
        let elements = trial.configuration.elements_name();
        let mut simulation = trial.start(&[
            format!("contacts=[Tool(tool: \"ball\", friction: {friction})]"),
            format!("materials.tissue=(density: 1000, neo_hookean: Young(young: {young}, poisson: 0.45), damping: {damping})"),
            format!("bodies.body.mesh=Box(size: (0.03, 0.03, 0.02), cells: ({cells}, {cells}, 4), elements: {elements})"),
        ])?;
        simulation.advance_to(0.2)?;
        // forces at the beginning of a step change the momentum over it, and damping goes by the mean of both ends
        let (start, mut before) = (simulation.time(), momentum(&mut simulation, "body")?);
        let (mut impulse, mut gained) = (DVec3::ZERO, DVec3::ZERO);
        for _ in 0..5 {
            simulation.advance(1)?;
            let [felt, held] = [simulation.probe("felt")?, simulation.probe("held")?].map(|v| DVec3::from_slice(&v));
            let (window, after) = (last_window(&simulation), momentum(&mut simulation, "body")?);
            impulse += (held - felt) * window;
            gained += after - before + damping * 0.5 * (before + after) * window;
            before = after;
        }
        let scale = simulation.tool("ball")?.force.length() * (simulation.time() - start);
        let what = |what: &str| format!("{what}, friction {friction}, {young} Pa");
        // Euler's formula damps by the end of a step, and springs push as they are there
        let allowed = if trial.is_implicit() { 5e-3 } else { trial.bound(1e-9, 1e-4) };
        trial.most(
            what("impulse less change of momentum, over the impulse"),
            (gained - impulse).length() / scale,
            allowed,
        );
        simulation.finish()?;
        let felt = simulation.tool("ball")?.force;
        let held = DVec3::from_slice(&simulation.probe("held")?);
        trial.most(what("felt less held at rest, over felt"), (felt - held).length() / felt.length(), 1e-3);
        trial.least(what("felt (N)"), felt.z, 1e-3);
    }
    Ok(())
}

/// H69.
pub fn far_away(trial: &mut Trial<'_>) -> Result<(), Error> {
    let at = |place: DVec3| format!("({}, {}, {})", place.x, place.y, place.z);
    for &(young, damping, cells) in trial.some(&[(3e3, 20.0, (5, 2)), (2e4, 40.0, (4, 3))]) {
        let mut all = Vec::new();
        for shift in [DVec3::ZERO, DVec3::new(1e4, 0.0, 0.0), DVec3::new(-6e3, 8e3, 0.0)] {
            let (elements, (of_body, of_other)) = (trial.configuration.elements_name(), cells);
            let sets = [
                format!(
                    "materials.tissue=(density: 1000, neo_hookean: Young(young: {young}, poisson: 0.45), damping: {damping})"
                ),
                format!(
                    "bodies.body.mesh=Box(size: (0.03, 0.03, 0.02), cells: ({of_body}, {of_body}, 3), elements: {elements})"
                ),
                format!(
                    "bodies.other.mesh=Box(size: (0.01, 0.01, 0.01), cells: ({of_other}, {of_other}, {of_other}), elements: {elements})"
                ),
                format!("bodies.body.translate={}", at(shift)),
                format!("bodies.other.translate={}", at(shift + DVec3::new(0.0014, 0.0017, 0.0201))),
                format!("tools.ball.at={}", at(shift + DVec3::new(0.02, 0.02, 0.0282))),
            ];
            let mut simulation: Simulation = trial.start(&sets)?;
            simulation.finish()?;
            let low = places(&mut simulation, "other")?.iter().fold(f64::INFINITY, |low, place| low.min(place.z));
            all.push([simulation.tool("ball")?.force.z, simulation.contact("other")?.force.z, low]);
        }
        let here = all[0];
        for there in &all[1..] {
            let what = |what: &str| format!("{what}, {young} Pa");
            trial.near(what("force on the ball (N)"), there[0], here[0], 1e-3);
            trial.near(what("force on the cube (N)"), there[1], here[1], 1e-3);
            trial.near(what("height of the cube (m)"), there[2], here[2], 1e-3);
        }
    }
    Ok(())
}
