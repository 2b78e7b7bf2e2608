//! Tools that suck and take.

use super::super::super::Trial;
use super::measures::mass;
use sinew::Error;
use sinew::Simulation;
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// H63.
pub fn suction(trial: &mut Trial<'_>) -> Result<(), Error> {
    // finer meshes of hexahedra are quick enough
    let all: &[(f64, f64)] = if trial.configuration.is_tets() { &[(6e-3, 1e3)] } else { &[(6e-3, 1e3), (4e-3, 4e3)] };
    for &(bore, pressure) in trial.some(all) {
        let cells = (20.0 * 6e-3 / bore) as u32;
        let elements = trial.configuration.elements_name();
        let holds = pressure * PI * bore * bore;
        let sets = |held: &str, loads: &str| {
            vec![
                format!(
                    "bodies.body.mesh=Box(size: (0.02, 0.02, 0.004), cells: ({cells}, {cells}, 2), elements: {elements})"
                ),
                format!("tools.tip.shape=Tube(length: 0.03, inner: {bore}, outer: 8e-3)"),
                format!("suction[0].pressure={pressure}"),
                format!("constraints={held}"),
                format!("loads={loads}"),
            ]
        };
        let what = |what: &str| format!("{what}, {bore} m and {pressure} Pa");
        let mut held = trial.start(&sets("[Fixed(on: Set(\"z0\"))]", "[]"))?;
        held.advance_to(0.15)?;
        trial.near(what("pull of a closed mouth (N)"), -held.tool("tip")?.force.z, holds, 0.03);
        // long runs, and the same whatever the elements
        let few = trial.configuration.is_tets() || bore < 6e-3 || trial.configuration.is_gpu() && !trial.full;
        let shares: &[f64] = if few { &[] } else { &[0.93, 1.06] };
        for &share in shares {
            let weight = mass(&mut held, "body")?;
            let loads = format!(
                "[Gravity(acceleration: (0, 0, {}), curve: Smooth(start: 0.05, end: 0.15))]",
                -share * holds / weight
            );
            let mut sets = sets("[Fixed(on: All, axes: [X, Y])]", &loads);
            // waves of a few steps a period are counted to a few percent
            sets.push("integration=(safety: 0.3)".into());
            let mut hangs = trial.start(&sets)?;
            hangs.finish()?;
            let low = hangs.displacements("body")?.iter().map(|u| u.z).fold(f64::INFINITY, f64::min);
            trial.holds(what(&format!("stays at {share} of it: {}", share < 1.0)), (low > -2e-4) == (share < 1.0));
        }
    }
    Ok(())
}

/// Edges of the surface that belong to an odd number of its triangles.
fn odd_edges(simulation: &mut Simulation) -> Result<usize, Error> {
    let mut edges: BTreeMap<[u32; 2], usize> = BTreeMap::new();
    for [a, b, c] in simulation.surface_triangles("body")? {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            *edges.entry([from.min(to), from.max(to)]).or_default() += 1;
        }
    }
    Ok(edges.values().filter(|count| *count % 2 == 1).count())
}

/// H64.
pub fn removal(trial: &mut Trial<'_>) -> Result<(), Error> {
    let of_a_cell = if trial.configuration.is_tets() { 6.0 } else { 1.0 };
    for &(cells, rate) in trial.some(&[(6, 2e-6), (4, 2e-6), (8, 3e-6)]) {
        let sets = [
            format!("bodies.body.mesh.cells=({cells}, {cells}, {cells})"),
            format!("removal[0].when=InTool(tool: \"tip\", reach: 6e-3, rate: {rate})"),
        ];
        let mut simulation = trial.start(&sets)?;
        let element = (0.02 / f64::from(cells)).powi(3) / of_a_cell;
        let (mut over, mut under, mut odd) = (f64::NEG_INFINITY, f64::NEG_INFINITY, 0);
        // looks are steps apart that may have been longer than the one that is taken now
        let (mut volume, mut longest) = (0.0, simulation.time_step());
        for sample in 1..=10 {
            simulation.advance_to(0.02 * f64::from(sample))?;
            longest = longest.max(simulation.time_step());
            volume = simulation.probe("hole")?[0];
            let (taken, late) = (rate * simulation.time(), rate * 20.0 * longest);
            over = over.max((volume - taken) / element);
            under = under.max((taken - late - volume) / element);
            odd += odd_edges(&mut simulation)?;
        }
        let what = |what: &str| format!("{what}, {cells} cells");
        trial.within(what("elements taken too many"), over, -1e9, trial.bound(1e-9, 1e-3));
        trial.within(what("elements not taken yet"), under, -1e9, 1.001);
        trial.most(what("edges of an odd number of faces"), odd as f64, 0.0);
        let summary = simulation.summary("finished")?;
        trial.least(what("elements gone"), summary.removed_elements as f64, 1.0);
        let gone = summary.removed_elements as f64 * element;
        trial.near(what("volume gone (m³)"), volume, gone, trial.bound(1e-9, 1e-4));
        trial.near(what("mass gone (kg)"), summary.removed_mass, 1000.0 * gone, trial.bound(1e-9, 1e-4));
    }
    Ok(())
}
