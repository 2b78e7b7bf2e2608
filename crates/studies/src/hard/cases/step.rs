//! The stable step: what sets it, what is beyond it, and what is done when it shrinks.

use super::super::Trial;
use super::super::monitor::Monitor;
use super::cells::vtk;
use sinew::Error;
use sinew::Simulation;

/// A column of cells of 1 cm, of the heights given (m).
fn column(trial: &Trial<'_>, heights: &[f64], more: &[String]) -> Result<Simulation, Error> {
    let hexes = !trial.configuration.is_tets();
    let height = |layers: usize| heights[..layers].iter().sum::<f64>();
    let mesh = vtk([1, 1, heights.len()], |[x, y, z]| [0.01 * x as f64, 0.01 * y as f64, height(z)], |_| hexes);
    let elements = trial.configuration.elements_name();
    let kind = if hexes { "hexes" } else { "tets" };
    let sets = [&[format!("bodies.body.mesh=File(path: \"column.vtk\", {kind}: {elements})")], more].concat();
    trial.start_beside("column.vtk", &mesh, &sets)
}

/// H03.
pub fn sliver(trial: &mut Trial<'_>) -> Result<(), Error> {
    let h = 0.01;
    let by_elements = ["integration.bound=Elements".to_string()];
    let alone = column(trial, &[h, 1e-3 * h, h], &by_elements)?.time_step();
    let usual = column(trial, &[h, h, h], &by_elements)?.time_step();
    trial.most("step with a sliver of h/1000 over step without, by elements", alone / usual, 0.01);
    // it brings a thousandth of the mass to its nodes: together all allow about the root of that
    let mut thin = column(trial, &[h, 1e-3 * h, h], &["integration.bound=Auto".into()])?;
    trial.least("step that all elements together allow over that", thin.time_step() / alone, 10.0);
    thin.advance(3000)?;
    let largest = thin.displacements("body")?.iter().fold(0.0_f64, |largest, u| largest.max(u.length()));
    // g t²/2
    let fallen = 0.5 * 9.81 * thin.time().powi(2);
    trial.near("fall with the sliver (m)", largest, fallen, 0.01);
    let mut thinner = column(trial, &[h, 1e-6 * h, h], &[])?;
    let told = thinner.warnings().render(false);
    let summary = thinner.summary("")?;
    trial.holds("a sliver of h/1e6 is warned of", told.contains("makes the step"));
    trial.least("worst elements named", summary.stability.bound.worst.len() as f64, 3.0);
    trial.refused("a flat element", column(trial, &[h, 0.0, h], &[]), &["element"]);
    trial.refused("an element of negative volume", column(trial, &[h, -0.5 * h, h], &[]), &["inverted"]);
    Ok(())
}

/// H04.
pub fn sizes(trial: &mut Trial<'_>) -> Result<(), Error> {
    let heights: Vec<f64> = (0..10).map(|layer| 1e-5 * 1000.0_f64.powf(f64::from(layer) / 9.0)).collect();
    let mut simulation = column(trial, &heights, &[])?;
    let summary = simulation.summary("")?;
    let worst = summary.stability.bound.worst.first().map_or(u64::MAX, |worst| worst.element);
    let of_a_layer = if trial.configuration.is_tets() { 6 } else { 1 };
    trial.most(
        "number of the element that sets the step, among those of the first layer",
        worst as f64,
        f64::from(of_a_layer) - 0.5,
    );
    let cost = summary.stability.bound.worst.first().map_or(0.0, |worst| worst.cost);
    trial.least("how many times the steps it costs", cost, 100.0);
    trial.holds("it is warned of", simulation.warnings().render(false).contains("makes the step"));
    Ok(())
}

/// H29.
pub fn beyond(trial: &mut Trial<'_>) -> Result<(), Error> {
    let limit = trial.start(&[])?.stable_limit()?.unwrap_or(0.0);
    let step = |factor: f64| format!("integration.step={:e}", factor * limit);
    let mut below = trial.start(&[step(0.99)])?;
    let steps = match (trial.full, trial.configuration.is_gpu()) {
        (true, _) => 100_000,
        (_, true) => 2_000,
        _ => 5_000,
    };
    let ended = below.advance(steps);
    let largest = below
        .displacements("body")?
        .iter()
        .fold(0.0_f64, |l, u| if u.is_finite() { l.max(u.length()) } else { f64::NAN });
    trial.holds(format!("{steps} steps at .99 of the limit"), ended.is_ok() && largest < 0.02);
    // the limit is found from below, to 3 %
    for factor in [1.05, 1.14, 2.07] {
        trial.refused(&format!("a step {factor} times as large"), trial.start(&[step(factor)]), &["beyond", "stable"]);
        let mut insists = trial.start(&[step(factor), "integration.beyond_stable_step=true".into()])?;
        let ended = insists.advance(steps);
        trial.stops(&format!("{factor} times as large, insisted on,"), ended, &["step"]);
    }
    Ok(())
}

/// H30.
pub fn shrinks(trial: &mut Trial<'_>) -> Result<(), Error> {
    let mut adapts = trial.start(&[])?;
    let first = adapts.time_step();
    trial.run(&mut adapts, 0.0)?;
    let smallest = adapts.step_history().map_or(first, |history| history.smallest);
    trial.most("smallest step over the first", smallest / first, 0.8);
    let mut reporting = trial.start(&["integration.when_unstable=Watch".into()])?;
    let ended = Monitor::run(&mut reporting).map(|_| ());
    let warned = reporting.step_history().is_some_and(|history| history.beyond_since.is_some());
    trial.holds("a step that stays is reported, or the run stops", warned || matches!(ended, Err(Error::Unstable(_))));
    Ok(())
}

/// H32.
pub fn mass_scaling(trial: &mut Trial<'_>) -> Result<(), Error> {
    let h = 0.01;
    let heights = [h, 0.05 * h, h];
    let plain = column(trial, &heights, &["integration.bound=Elements".into()])?;
    for (most, told) in [(0.04, false), (0.2, true)] {
        let set = format!("integration.when_unstable=ScaleMass(most: {most})");
        let mut scaled = column(trial, &heights, &[set])?;
        let share = scaled.step_history().map_or(f64::NAN, |history| history.added_share);
        trial.most(format!("added share, {most} allowed"), share, most * 1.001);
        trial.least("step over that without", scaled.time_step() / plain.time_step(), 1.05);
        let warned = scaled.warnings().render(false).contains("added");
        trial.holds(format!("warned of above 5 % alone ({most})"), warned == told);
        trial.run(&mut scaled, 0.0)?;
    }
    Ok(())
}
