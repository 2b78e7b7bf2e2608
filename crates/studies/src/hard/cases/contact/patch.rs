//! The contact patch test: a pressure across cells that do not match.

use super::super::super::Trial;
use super::super::point::Law;
use sinew::Error;

/// H47.
pub fn contact_patch(trial: &mut Trial<'_>) -> Result<(), Error> {
    let (young, poisson, pressure) = (3e3, 0.3, 100.0);
    let law = Law::young(young, poisson);
    // the stretch between walls whose stress is the pressure: J
    let (mut low, mut high) = (0.5, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if law.confined(middle) < -pressure { low = middle } else { high = middle }
    }
    let volume_ratio = low;
    for &(below, above) in trial.some(&[(4, 6), (7, 5)]) {
        let mut sets = trial.elements_of(&["other"]);
        sets.push(format!("bodies.body.mesh.cells=({below}, {below}, 2)"));
        sets.push(format!("bodies.other.mesh.cells=({above}, {above}, 3)"));
        let mut simulation = trial.start(&sets)?;
        simulation.finish()?;
        let (mut worst, mut least_j, mut most_j) = (0.0_f64, f64::INFINITY, 0.0_f64);
        for body in ["body", "other"] {
            let fields = simulation.fields(body)?;
            for (stress, j) in fields.stress.iter().zip(&fields.volume_ratio) {
                worst = worst.max((stress[2] / pressure + 1.0).abs());
                (least_j, most_j) = (least_j.min(*j), most_j.max(*j));
            }
        }
        let what = |what: &str| format!("{what}, cells {below} on {above}");
        trial.most(what("stress off the pressure"), worst, 0.06);
        let off = (least_j - volume_ratio).abs().max((most_j - volume_ratio).abs()) / (1.0 - volume_ratio);
        trial.most(what("change of volume off that of a point"), off, 0.06);
    }
    Ok(())
}
