//! Sudden loads and motions.

use super::super::Trial;
use super::super::monitor::Monitor;
use sinew::Error;

/// H19.
pub fn sudden_load(trial: &mut Trial<'_>) -> Result<(), Error> {
    let mut simulation = trial.start(&[])?;
    match Monitor::run(&mut simulation) {
        Ok(monitor) => trial.most("imbalance of energy", monitor.imbalance, trial.bound(0.01, 0.02)),
        ended => trial.stops("the bar", ended.map(|_| ()), &["element"]),
    }
    Ok(())
}

/// H24.
pub fn jump(trial: &mut Trial<'_>) -> Result<(), Error> {
    let mut simulation = trial.start(&[])?;
    trial.run(&mut simulation, 0.0)?;
    let work = simulation.energies()?.constraint_work.unwrap_or(0.0);
    trial.holds("the work of the jump is counted", work > 0.0);
    let mut far = trial.start(&["constraints[1].displacement=(-0.04, 0, 0)".into()])?;
    let ended = far.finish();
    trial.stops("a jump by the whole length", ended, &["ramp"]);
    Ok(())
}
