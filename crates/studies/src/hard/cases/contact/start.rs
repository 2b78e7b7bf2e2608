//! Starts that are no good: overlaps, surfaces that are none, needles that are too fast.

use super::super::super::Trial;
use super::measures::{of_waves, places};
use glam::DVec3;
use sinew::Error;

/// H54.
pub fn tunnelling(trial: &mut Trial<'_>) -> Result<(), Error> {
    for &(radius, way, step, young) in trial.some(&[(2e-4, 1e-3, 2e-5, 1e5), (3e-4, 1.2e-3, 4e-5, 3e4)]) {
        needle(trial, (radius, way, step), young)?;
    }
    Ok(())
}

/// A needle of a radius (m) that goes so far (m), some radii in each step (s), at a slab of a modulus (Pa).
fn needle(trial: &mut Trial<'_>, (radius, way, step): (f64, f64, f64), young: f64) -> Result<(), Error> {
    // from half a radius above the slab
    let (from, to) = (1.5 * radius, 1.5 * radius - way);
    for (radii, aside) in [(0.1, 0.0), (0.4, 0.0), (1.0, 0.0), (2.0, 0.0), (5.0, 0.0), (0.1, 5e-4)] {
        let time = way / (radii * radius / step);
        let sets = [
            format!("duration={time}"),
            format!("integration.step={step}"),
            format!(
                "tools.needle.path=[(t: 0, at: ({aside}, {aside}, {from})), (t: {time}, at: ({aside}, {aside}, {to}))]"
            ),
            format!("tools.needle.shape=Capsule(length: 0.02, radius: {radius})"),
            format!("materials.tissue.neo_hookean=Young(young: {young}, poisson: 0.4)"),
        ];
        let what = format!("{radius} m, {radii} radii a step, {aside} m beside a node");
        let mut simulation = match trial.start(&sets) {
            Ok(simulation) => simulation,
            Err(error) => {
                trial.refused(&what, Err(error), &["needle", "m a step"]);
                continue;
            }
        };
        let warned = simulation.warnings().lines().iter().any(|line| line.contains("may slip between nodes"));
        trial.holds(format!("{what}: warned of"), warned);
        match simulation.finish() {
            Err(error) => trial.stops(&what, Err(error), &["element"]),
            Ok(()) if aside == 0.0 => {
                let tip = DVec3::new(0.0, 0.0, to);
                // whoever is behind the tip and within the needle has let it through
                let through = |place: &&DVec3| place.truncate().length() < 0.99 * radius && place.z > tip.z + radius;
                let count = places(&mut simulation, "body")?.iter().filter(through).count();
                trial.most(format!("{what}: nodes within the needle"), count as f64, 0.0);
            }
            Ok(()) => {}
        }
    }
    Ok(())
}

/// H55.
pub fn overlap(trial: &mut Trial<'_>) -> Result<(), Error> {
    for &(share, young, layers) in trial.some(&[(0.3, 3e3, 4), (0.05, 3e3, 4), (0.2, 2e4, 3)]) {
        let (elements, side) = (trial.configuration.elements_name(), 0.02);
        let edge = side / f64::from(layers);
        let c = (of_waves(young, 0.45) / 1000.0_f64).sqrt();
        let depth = share * edge;
        for table in [true, false] {
            let mesh = |body: &str, cells: u32| {
                format!(
                    "bodies.{body}.mesh=Box(size: ({side}, {side}, {side}), cells: ({cells}, {cells}, {layers}), elements: {elements})"
                )
            };
            let mut sets = vec![
                mesh("body", layers),
                mesh("other", layers - 1),
                format!("materials.tissue.neo_hookean=Young(young: {young}, poisson: 0.45)"),
            ];
            sets.push(match table {
                true => format!("tools.table.at=(0, 0, {depth})"),
                false => format!("bodies.other.translate=(0, 0, {})", side - depth),
            });
            let mut simulation = trial.start(&sets)?;
            // pushed out by half an edge in the time of a wave through the body: a wave of stress ρ c v goes up
            // meanwhile
            let pushed = 0.5 * edge * c / (side * 3.0_f64.sqrt());
            let bound = 1000.0 * c * pushed * side * side * depth;
            let mut most = 0.0_f64;
            while simulation.time() < 0.2 {
                simulation.advance(5)?;
                let energies = simulation.energies()?;
                most = most.max(energies.kinetic + energies.strain + energies.hourglass);
            }
            let by = if table { "a table" } else { "another cube" };
            let what = |what: &str| format!("{what}, {share} of an edge inside {by}, {young} Pa");
            trial.most(what("energy gained over that of a wave"), most / bound, 1.0);
            let left = match table {
                true => simulation.tool("table")?.penetration,
                false => simulation.contact("other")?.penetration.max(simulation.contact("body")?.penetration),
            };
            let allowed = if table { trial.bound(1e-12, 1e-8) } else { 0.1 * depth };
            trial.depth(what("inside at the end (m)"), left, allowed);
        }
    }
    let (side, edge) = (0.02, 0.005);
    let deep = 0.6 * edge;
    let table = trial.start(&[format!("tools.table.at=(0, 0, {deep})")]);
    trial.refused(".6 of an edge inside a table", table, &["inside the tool `table`", "nodes: "]);
    let mut sets = trial.elements_of(&["other"]);
    sets.push(format!("bodies.other.translate=(0, 0, {})", side - deep));
    let other = trial.start(&sets);
    trial.refused(".6 of an edge inside another cube", other, &["inside `", "nodes"]);
    let inside =
        trial.start(&["bodies.other.scale=0.25".into(), "bodies.other.translate=(0.0073, 0.0071, 0.0077)".into()]);
    trial.refused("one altogether inside another", inside, &["`other`", "inside `body`"]);
    Ok(())
}

/// An octahedron of 10 mm (OBJ): its sides first, then the upper and the lower corner.
const CORNERS: &str = "v 10 0 0\nv 0 10 0\nv -10 0 0\nv 0 -10 0\nv 0 0 10\nv 0 0 -10\n";
/// All faces but the last, between the corners 4, 1 and 5.
const FACES: &str = "f 1 2 5\nf 2 3 5\nf 3 4 5\nf 2 1 6\nf 3 2 6\nf 4 3 6\nf 1 4 6\n";

/// H56.
pub fn bad_surface(trial: &mut Trial<'_>) -> Result<(), Error> {
    let whole = format!("{CORNERS}{FACES}f 4 1 5\n");
    // a corner on an edge, and one a millionth of it beside: the faces there have next to no area
    let split = |x: f64| format!("{CORNERS}v {x} -5 0\n{}f 4 7 5\nf 7 1 5\nf 4 1 7\n", FACES);
    let mut forces = Vec::new();
    for (name, surface) in [("whole", whole.clone()), ("a face without area", split(5.0)), ("a sliver", split(5.00001))]
    {
        let mut simulation = trial.start_beside("pick.obj", &surface, &[trial.elements_of(&["body"])[0].clone()])?;
        simulation.finish()?;
        let finite = simulation.displacements("body")?.iter().all(|u| u.is_finite());
        trial.holds(format!("{name}: all are numbers"), finite);
        forces.push(simulation.tool("pick")?.force.z);
    }
    trial.least("force (N)", forces[0], 1e-3);
    trial.near("force with a face without area (N)", forces[1], forces[0], 1e-3);
    trial.near("force with a sliver (N)", forces[2], forces[0], 1e-3);
    let open = format!("{CORNERS}{FACES}");
    let twice = format!("{whole}f 4 1 5\n");
    let three = format!("{whole}v 20 20 20\nf 1 2 7\n");
    for (name, surface, words) in [
        ("a hole", open, &["pick.obj"]),
        ("a face twice", twice, &["pick.obj"]),
        ("an edge of three faces", three, &["pick.obj"]),
    ] {
        let made = trial.start_beside("pick.obj", &surface, &[]);
        trial.refused(name, made, words);
    }
    Ok(())
}
