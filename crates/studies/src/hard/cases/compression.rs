//! Cubes pressed together.

use super::super::Trial;
use super::point::Law;
use sinew::Error;
use sinew::Simulation;
use sinew::observation::BodyFields;

const SHEAR: f64 = 1e4;

/// H01.
pub fn squeezed_cube(trial: &mut Trial<'_>) -> Result<(), Error> {
    let compared = trial.is_thorough();
    let ratios: &[f64] = if compared { &[0.49, 0.499, 0.4999] } else { &[0.49] };
    let mut steps = Vec::new();
    for &poisson in ratios {
        let bulk = 2.0 * SHEAR * (1.0 + poisson) / (3.0 * (1.0 - 2.0 * poisson));
        let sets = vec![format!("materials.tissue.neo_hookean=Moduli(shear: {SHEAR}, bulk: {bulk})")];
        let mut simulation = trial.start(&sets)?;
        steps.push(simulation.time_step() * bulk.sqrt());
        // everyday one of them is squeezed
        if !trial.full && compared && poisson != 0.499 {
            continue;
        }
        trial.run(&mut simulation, 0.01)?;
        let locks = matches!(trial.configuration.elements_name(), "Tet4");
        if !locks {
            let checkered = checkerboard(&simulation.fields("body")?, 6, trial.configuration.is_tets());
            trial.most(format!("checkerboard of pressures at ν {poisson}"), checkered, 0.05);
        }
        if !locks && compared {
            let force = simulation.probe("plate")?[2];
            let mut finer = sets.clone();
            finer.push("bodies.body.mesh.cells=(9, 9, 9)".into());
            let mut fine = trial.start(&finer)?;
            fine.finish()?;
            trial.near(format!("force at ν {poisson}"), force, fine.probe("plate")?[2], 0.05);
        }
    }
    if trial.is_implicit() {
        return Ok(());
    }
    let [least, most] = steps.iter().fold([f64::INFINITY, 0.0_f64], |[l, m], s| [l.min(*s), m.max(*s)]);
    trial.most("change of Δt √κ", most / least - 1.0, 0.05);
    Ok(())
}

/// How much of the pressures goes up and down from cell to cell, relative to their mean.
fn checkerboard(fields: &BodyFields, cells: usize, tets: bool) -> f64 {
    let a_cell = if tets { 6 } else { 1 };
    let pressure = |cell: usize| {
        let stresses = &fields.stress[cell * a_cell..(cell + 1) * a_cell];
        -stresses.iter().map(|s| s[0] + s[1] + s[2]).sum::<f64>() / (3 * a_cell) as f64
    };
    let sign = |cell: usize| {
        if (cell % cells + cell / cells % cells + cell / cells / cells).is_multiple_of(2) { 1.0 } else { -1.0 }
    };
    let count = cells.pow(3);
    let mean: f64 = (0..count).map(pressure).sum();
    (0..count).map(|cell| sign(cell) * pressure(cell)).sum::<f64>().abs() / mean.abs()
}

/// H07.
pub fn crushed_cube(trial: &mut Trial<'_>) -> Result<(), Error> {
    let area = 0.1 * 0.1;
    // steps small enough for what falls flat; free, a block of several cells would wrinkle
    let small = "integration.safety=0.2".to_string();
    let free = "constraints[1]=Fixed(on: Set(\"x0\"), axes: [X])".to_string();
    let one_cell = "bodies.body.mesh.cells=(1, 1, 1)".to_string();
    let law = Law::young(3000.0, 0.49);
    let pressed_free = vec![small.clone(), free, one_cell];
    for (name, sets, stress) in
        [("confined", vec![small], law.confined(0.05)), ("free", pressed_free.clone(), law.free(0.05))]
    {
        let mut simulation = trial.start(&sets)?;
        simulation.advance_to(1.2)?;
        trial.near(format!("force, {name}"), simulation.probe("plate")?[2], stress * area, 0.01);
        let back = come_back(&mut simulation)?;
        trial.most(format!("what stays of the displacement, {name}"), back, 1e-3);
    }
    // at a Poisson's ratio of .45 the law lets a free point give way at .106 of its height: there the equilibrium
    // beside rest ends, and the only one left is a point without volume. It may spring back or be given up, but not
    // rest elsewhere
    let soft = [pressed_free, vec!["materials.tissue.neo_hookean=Young(young: 3000, poisson: 0.45)".into()]].concat();
    if !trial.is_thorough() {
        return Ok(());
    }
    let mut gives_way = trial.start(&soft)?;
    match come_back(&mut gives_way) {
        Ok(back) => trial.most("what stays of the displacement of what gave way", back, 1e-3),
        Err(error) => trial.stops("what collapses", Err(error), &["element"]),
    }
    Ok(())
}

/// Takes the steps that are left; the largest displacement then, in lengths.
fn come_back(simulation: &mut Simulation) -> Result<f64, Error> {
    simulation.finish()?;
    let displacements = simulation.displacements("body")?;
    Ok(displacements.iter().fold(0.0_f64, |largest, u| largest.max(u.length())) / 0.1)
}
