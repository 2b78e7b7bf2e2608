//! Hertz: balls pressed into blocks and layers, and between plates.

use super::super::super::Trial;
use super::super::cells::vtk;
use sinew::Error;

const RADIUS: f64 = 5e-3;
const YOUNG: f64 = 3e3;

/// Hertz' force on a ball (N): 4/3 E/(1 − ν²) √R δ^1.5.
fn hertz(young: f64, poisson: f64, radius: f64, depth: f64) -> f64 {
    4.0 / 3.0 * young / (1.0 - poisson * poisson) * radius.sqrt() * depth.powf(1.5)
}

/// Places from 0 to `end`: cells of `fine` to `until`, then each longer than the one before by as much as fits.
fn graded(fine: f64, until: f64, end: f64) -> Vec<f64> {
    let mut places: Vec<f64> = (0..=(until / fine).ceil() as usize).map(|i| fine * i as f64).collect();
    let mut cell = fine;
    let mut last = fine * (places.len() - 1) as f64;
    while last + 1.35 * cell < end {
        cell *= 1.35;
        last += cell;
        places.push(last);
    }
    // what is left is shared out among those that grow
    let from = (until / fine).ceil() as usize;
    let start = places[from.min(places.len() - 1)];
    let stretch = if last > start { (end - start) / (last - start) } else { 1.0 };
    places.iter().map(|&place| if place > start { start + (place - start) * stretch } else { place }).collect()
}

/// A quarter of a block, z downwards from 0, fine about the origin.
fn quarter(fine: f64, touched: f64, width: f64, depth: f64, hexes: bool) -> String {
    let across = graded(fine, 1.5 * touched, width);
    let down = graded(fine, touched, depth);
    let (n, m) = (across.len() - 1, down.len() - 1);
    let place = |[x, y, z]: [usize; 3]| [across[x], across[y], -down[m - z]];
    vtk([n, n, m], place, |_| hexes)
}

/// A quarter of the ball's force over a quarter of Hertz'.
fn pressed(trial: &Trial<'_>, file: &str, (width, depth): (f64, f64), share: f64, faces: f64) -> Result<f64, Error> {
    let radius = (RADIUS * share * RADIUS).sqrt();
    let hexes = !trial.configuration.is_tets();
    let mesh = quarter(radius / faces, radius, width, depth, hexes);
    let kind = if hexes { "hexes" } else { "tets" };
    let sets = [
        format!("bodies.body.mesh=File(path: \"{file}\", {kind}: {})", trial.configuration.elements_name()),
        format!("tools.ball.moves[0].displacement=(0, 0, {})", -share * RADIUS),
    ];
    let mut simulation = trial.start_beside(file, &mesh, &sets)?;
    simulation.finish()?;
    Ok(simulation.tool("ball")?.force.z / (0.25 * hertz(YOUNG, 0.45, RADIUS, share * RADIUS)))
}

/// H36.
pub fn block(trial: &mut Trial<'_>) -> Result<(), Error> {
    for &(share, faces, expected, allowed) in
        trial.some(&[(0.1, 4.0, 1.061, 0.06), (0.05, 4.0, 1.045, 0.06), (0.1, 2.0, 1.061, 0.15)])
    {
        let found = pressed(trial, "block.vtk", (5.0 * RADIUS, 5.0 * RADIUS), share, faces)?;
        trial.near(format!("force over Hertz', pressed by {share} R, {faces} faces"), found, expected, allowed);
    }
    Ok(())
}

/// H37.
pub fn layer(trial: &mut Trial<'_>) -> Result<(), Error> {
    for &(share, expected) in trial.some(&[(0.1, 1.474), (0.05, 1.309)]) {
        let found = pressed(trial, "layer.vtk", (3.0 * RADIUS, RADIUS), share, 4.0)?;
        trial.near(format!("force over Hertz', pressed by {share} R"), found, expected, 0.08);
    }
    Ok(())
}

/// H38.
pub fn ball(trial: &mut Trial<'_>) -> Result<(), Error> {
    for &(share, poisson, expected) in
        trial.some(&[(0.1, 0.45, 1.155), (0.05, 0.45, 1.107), (0.1, 0.3, 1.215), (0.05, 0.3, 1.143)])
    {
        // three faces on the radius of contact: cells next to the poles are the ball's diameter over their number
        let radius = (RADIUS * share * RADIUS).sqrt();
        let across = 2 * (3.0 * RADIUS / radius).ceil() as usize;
        let mut sets = vec![
            format!("bodies.body.mesh.across={across}"),
            format!("materials.tissue.linear=Young(young: {YOUNG}, poisson: {poisson})"),
        ];
        for (tool, sign) in [("below", 1.0), ("above", -1.0)] {
            sets.push(format!("tools.{tool}.moves[0].displacement=(0, 0, {})", sign * share * RADIUS));
        }
        let mut simulation = trial.start(&sets)?;
        simulation.finish()?;
        let found = -simulation.tool("below")?.force.z / hertz(YOUNG, poisson, RADIUS, share * RADIUS);
        trial.near(format!("force over Hertz', by {share} R at ν {poisson}"), found, expected, 0.08);
    }
    Ok(())
}
