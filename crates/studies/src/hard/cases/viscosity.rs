//! Relaxation far faster and far slower than the step, and of no weight.

use super::super::Trial;
use sinew::Error;

/// Shear stress (Pa) that a shear of .1 makes at once, and after five steps.
fn sheared(trial: &Trial<'_>) -> Result<(f64, f64), Error> {
    let mut simulation = trial.start(&[])?;
    simulation.advance(5)?;
    let fields = simulation.fields("body")?;
    let mean = fields.stress.iter().map(|s| s[3]).sum::<f64>() / fields.stress.len() as f64;
    Ok((0.1 * 3000.0 / 2.9, mean))
}

/// H14.
pub fn fast(trial: &mut Trial<'_>) -> Result<(), Error> {
    let (instantaneous, found) = sheared(trial)?;
    trial.near("shear stress after five steps", found, 0.5 * instantaneous, 0.01);
    Ok(())
}

/// H15.
pub fn slow(trial: &mut Trial<'_>) -> Result<(), Error> {
    let (instantaneous, found) = sheared(trial)?;
    trial.near("shear stress after five steps", found, instantaneous, 1e-4);
    Ok(())
}

/// H16.
pub fn none(trial: &mut Trial<'_>) -> Result<(), Error> {
    let mut with = trial.start(&[])?;
    let mut without =
        trial.start(&["materials.tissue=(density: 1000, neo_hookean: Young(young: 3000, poisson: 0.45))".into()])?;
    with.finish()?;
    without.finish()?;
    trial.holds("the same bits as elastic", with.displacements("body")? == without.displacements("body")?);
    for (what, value, words) in [
        ("a weight of 1", "(alpha: 1, tau: 0.1)", ["alpha", "below 1"]),
        ("a weight of 1.5", "(alpha: 1.5, tau: 0.1)", ["alpha", "1.5"]),
        ("a time of 0", "(alpha: 0.5, tau: 0)", ["tau", "above 0"]),
        ("a time below 0", "(alpha: 0.5, tau: -1)", ["tau", "above 0"]),
    ] {
        let made = trial.start(&[format!("materials.tissue.prony.terms=[{value}]")]);
        trial.refused(what, made, &words);
    }
    Ok(())
}
