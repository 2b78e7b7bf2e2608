//! Bars, plates and columns that bend, twist and give way.

use super::super::Trial;
use super::super::monitor::Monitor;
use sinew::Error;

/// H02.
pub fn corner_load(trial: &mut Trial<'_>) -> Result<(), Error> {
    let mut simulation = trial.start(&[])?;
    simulation.finish()?;
    let mut monitor = Monitor::begin(&mut simulation)?;
    monitor.sample(&mut simulation)?;
    trial.most("hourglass energy over strain energy", monitor.hourglass, 0.1);

    let unsafe_scene = trial.start(&["bodies.body.hourglass=0".into()])?;
    let told = unsafe_scene.warnings().render(false);
    trial.holds("a coefficient of 0 is warned of", told.contains("hourglass"));

    // S1: its tip sinks by 73.85 mm (docs/accuracy.md)
    let mut bar = trial.start(&[
        "bodies.body.mesh.size=(0.1, 0.02, 0.02)".into(),
        "bodies.body.mesh.cells=(20, 4, 4)".into(),
        "constraints=[Fixed(on: Set(\"x0\"))]".into(),
        "loads=[Gravity(acceleration: (0, 0, -9.81))]".into(),
        "probes={\"end\": (what: Displacement, on: Set(\"x1\"))}".into(),
    ])?;
    bar.finish()?;
    trial.near("tip of S1", bar.probe("end")?[2], -73.85e-3, 0.05);
    Ok(())
}

/// H06.
pub fn twist(trial: &mut Trial<'_>) -> Result<(), Error> {
    let angles: &[f64] = match (trial.full, trial.is_thorough()) {
        (true, _) => &[180.0, 360.0, 720.0],
        (_, true) => &[180.0, 360.0],
        _ => &[360.0],
    };
    for &angle in angles {
        let mut sets = vec![format!("constraints[1].rotation=(0, 0, {angle})")];
        let cells = match (trial.full, trial.configuration.is_tets()) {
            (false, _) => "(3, 3, 12)",
            (true, _) if angle <= 360.0 => "(4, 4, 16)",
            (true, true) => "(6, 6, 24)",
            (true, false) => "(8, 8, 32)",
        };
        sets.push(format!("bodies.body.mesh.cells={cells}"));
        let mut simulation = trial.start(&sets)?;
        let monitor = trial.run(&mut simulation, 0.0)?;
        trial.least(format!("least volume at {angle}°"), monitor.volume[0], 0.97);
        trial.most(format!("largest volume at {angle}°"), monitor.volume[1], 1.03);
        let left = simulation.displacements("body")?.iter().fold(0.0_f64, |largest, u| largest.max(u.length()));
        trial.most(format!("what stays of {angle}°, in lengths"), left / 0.16, 1e-3);
    }
    Ok(())
}

/// H11.
pub fn stiffness_contrast(trial: &mut Trial<'_>) -> Result<(), Error> {
    let mut simulation = trial.start(&[])?;
    simulation.finish()?;
    // 1-D strain: modulus λ + 2μ = E (1 − ν)/((1 + ν)(1 − 2ν))
    let modulus = |young: f64| young * 0.7 / (1.3 * 0.4);
    let (joint, end) = (0.05 / modulus(3e7), 0.05 / modulus(3e7) + 0.05 / modulus(3e3));
    trial.near("displacement of the joint", simulation.probe("joint")?[0], joint, 0.01);
    trial.near("displacement of the end", simulation.probe("end")?[0], end, 0.01);
    Ok(())
}

/// H25.
pub fn thin_slab(trial: &mut Trial<'_>) -> Result<(), Error> {
    let mut sags = Vec::new();
    let mut share = 0.0;
    let compared = trial.is_thorough();
    for layers in if compared { &[1, 3][..] } else { &[1][..] } {
        let layers = *layers;
        let cells = if layers == 1 { "(20, 10, 1)" } else { "(60, 30, 3)" };
        let mut simulation = trial.start(&[format!("bodies.body.mesh.cells={cells}")])?;
        simulation.finish()?;
        if layers == 1 {
            let energies = simulation.energies()?;
            share = energies.hourglass / energies.strain;
        }
        sags.push(simulation.probe("middle")?[2]);
    }
    if let [one, three] = sags[..] {
        trial.near("sag of one layer beside three", one, three, 0.15);
    }
    trial.least("hourglass over strain energy of one layer, which tells", share, 0.1);
    Ok(())
}

/// H35.
pub fn buckling(trial: &mut Trial<'_>) -> Result<(), Error> {
    let mut deflections = Vec::new();
    let meshes = if trial.is_thorough() { &["(3, 3, 40)", "(4, 4, 54)"][..] } else { &["(2, 2, 26)"][..] };
    for cells in meshes {
        let mut simulation = trial.start(&[format!("bodies.body.mesh.cells={cells}")])?;
        simulation.finish()?;
        deflections.push(simulation.probe("middle")?[0]);
    }
    trial.least("deflection to the side, in lengths", deflections[0] / 0.15, 0.15);
    if let [coarse, fine] = deflections[..] {
        trial.near("deflection beside the finer mesh's", coarse, fine, 0.03);
    }
    Ok(())
}
