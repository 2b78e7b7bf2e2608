//! Elements turned inside out, and starts that are deformed.

use super::super::Trial;
use sinew::Error;
use sinew::Simulation;

/// A law that ends at J = 0, in place of the scene's.
const ENDS: &str = "materials.tissue=(density: 1000, neo_hookean: Young(young: 3000, poisson: 0.45), damping: 40)";

/// The largest displacement over a length (m).
fn left(simulation: &mut Simulation, length: f64) -> Result<f64, Error> {
    let displacements = simulation.displacements("body")?;
    Ok(displacements.iter().fold(0.0_f64, |largest, u| if u.is_finite() { largest.max(u.length()) } else { f64::NAN })
        / length)
}

/// H05.
pub fn release(trial: &mut Trial<'_>) -> Result<(), Error> {
    let short = if trial.is_thorough() { "duration=0.5" } else { "duration=0.3" };
    // in twenty periods cells come to be squeezed to a twentieth: at .1 energy comes from nothing there, at .03 none
    // does
    let sets = if trial.full { vec!["integration.safety=0.03".into()] } else { vec![short.into()] };
    let mut simulation = trial.start(&sets)?;
    trial.run(&mut simulation, 0.1)?;
    Ok(())
}

/// H08.
pub fn through(trial: &mut Trial<'_>) -> Result<(), Error> {
    // one node alone hardly turns a hexahedron inside out, whose other nodes stay: of those the whole face goes
    let hexes = !trial.configuration.is_tets();
    let sets = if hexes { vec!["constraints[1].on=Set(\"z1\")".to_string()] } else { vec![] };
    let mut ends = trial.start(&[sets.clone(), vec![ENDS.into()]].concat())?;
    let ended = ends.finish();
    // by an element inside out or, where elements get stiff before, by energy from nothing
    trial.stops("a law that ends at J = 0", ended, &["broke down before"]);
    let mut simulation = trial.start(&sets)?;
    simulation.advance_to(0.9)?;
    let least = simulation.fields("body")?.volume_ratio.into_iter().fold(f64::INFINITY, f64::min);
    trial.most("least J on the way, below 0", least + 1.0, 1.0);
    simulation.finish()?;
    let stays = left(&mut simulation, 0.04)?;
    trial.most("what stays of the displacement", stays, 1e-3);
    Ok(())
}

/// H09 and H10.
pub fn deformed_start(trial: &mut Trial<'_>) -> Result<(), Error> {
    let made = trial.start(&[ENDS.into()]);
    trial.refused("a law that ends at J = 0", made, &["element"]);
    let sets = if trial.is_thorough() { vec![] } else { vec!["duration=1.5".into()] };
    let mut simulation = trial.start(&sets)?;
    simulation.finish()?;
    let stays = left(&mut simulation, 0.04)?;
    trial.most("what stays of the displacement", stays, 1e-3);
    let least = simulation.fields("body")?.volume_ratio.into_iter().fold(f64::INFINITY, f64::min);
    trial.least("least J at the end", least, 0.9);
    Ok(())
}
