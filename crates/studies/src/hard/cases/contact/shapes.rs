//! Shapes that are hard to keep apart: edges, columns wound round each other, piles.

use super::super::super::Trial;
use super::measures::{gone, mass, places};
use glam::DVec3;
use sinew::Error;
use sinew::Simulation;
use sinew::assembly::mesh_of;
use sinew::mesh::Locator;

const G: f64 = 9.81;
const EDGE: f64 = 5e-3;

/// H57.
pub fn edges(trial: &mut Trial<'_>) -> Result<(), Error> {
    let top = 0.01 * 2.0_f64.sqrt();
    let elements = trial.configuration.elements_name();
    let bar = format!("Box(size: (0.03, 0.01, 0.01), cells: (6, 2, 2), elements: {elements})");
    let cube = format!("Box(size: (0.01, 0.01, 0.01), cells: (2, 2, 2), elements: {elements})");
    let corner = -(0.5_f64.sqrt().atan().to_degrees());
    for (name, mesh, rotate, along) in [
        ("edge across edge", &bar, "(45, 0, 90)".to_string(), -0.015),
        ("corner on edge", &cube, format!("(45, {corner}, 0)"), 0.0),
    ] {
        let all = [(0.0, false), (0.5 * EDGE, true), (0.0, true), (0.5 * EDGE, false)];
        // in software two take long enough
        let few = trial.configuration.is_gpu() && !trial.full;
        for &(aside, crossing) in if few { &all[..2] } else { &all[..] } {
            let sets = [
                format!("contacts[0].edges={crossing}"),
                format!("bodies.body.translate=({}, 0, 0)", aside - 0.015),
                format!("bodies.other.mesh={mesh}"),
                format!("bodies.other.rotate={rotate}"),
                format!(
                    "bodies.other.translate=(0, {}, {})",
                    along + if along < 0.0 { aside } else { 0.0 },
                    top + 2e-4
                ),
            ];
            let mut simulation = trial.start(&sets)?;
            let weight = G * mass(&mut simulation, "other")?;
            let ended = simulation.finish();
            let where_to = if aside == 0.0 { "where nodes meet" } else { "between nodes" };
            let edges = if crossing { ", with edges" } else { "" };
            let what = |what: &str| format!("{name} {where_to}{edges}: {what}");
            if aside > 0.0 && !crossing {
                // surfaces meet in points against faces: an edge is felt once a node of it is inside
                let depth = if ended.is_ok() { depth(&mut simulation, along < 0.0)? } else { f64::INFINITY };
                trial.report(what("deep in edges"), depth / EDGE);
                continue;
            }
            ended?;
            trial.near(what("weight borne (N)"), simulation.contact("other")?.force.z, weight, 1e-3);
            trial.most(what("deep in edges"), depth(&mut simulation, along < 0.0)?.max(0.0) / EDGE, 0.1);
        }
    }
    Ok(())
}

/// How deep the lowest of the upper body is below the lower one's edge where they cross (m).
fn depth(simulation: &mut Simulation, across: bool) -> Result<f64, Error> {
    let top = 0.01 * 2.0_f64.sqrt();
    let edge = |simulation: &mut Simulation, body: &str, height: f64, axis: usize| -> Result<f64, Error> {
        let (rest, now) = (simulation.rest_positions(body)?, places(simulation, body)?);
        let of_edge = rest.iter().zip(now).filter(|(rest, _)| (rest.z - height).abs() < 1e-6);
        let mut nodes: Vec<DVec3> = of_edge.map(|(_, now)| now).collect();
        nodes.sort_by(|a, b| a[axis].total_cmp(&b[axis]));
        let at = nodes.windows(2).find(|pair| pair[0][axis] <= 1e-9 && pair[1][axis] >= -1e-9);
        let height = |pair: &[DVec3]| {
            let share = (-pair[0][axis] / (pair[1][axis] - pair[0][axis])).clamp(0.0, 1.0);
            pair[0].z + share * (pair[1].z - pair[0].z)
        };
        Ok(at.map_or_else(|| nodes.first().map_or(f64::NAN, |node| node.z), height))
    };
    let below = edge(simulation, "body", top, 0)?;
    let above = edge(simulation, "other", top + 2e-4, if across { 1 } else { 0 })?;
    Ok(below - above)
}

/// H58.
pub fn wound(trial: &mut Trial<'_>) -> Result<(), Error> {
    let sets = trial.elements_of(&["other"]);
    let mut simulation = trial.start(&sets)?;
    let (mut volume, mut touching) = ([1.0_f64; 2], 0);
    for sample in 1..=10 {
        simulation.advance_to(0.1 * f64::from(sample))?;
        for body in ["body", "other"] {
            let ratios = simulation.fields(body)?.volume_ratio;
            let mean = ratios.iter().sum::<f64>() / ratios.len() as f64;
            volume = [volume[0].min(mean), volume[1].max(mean)];
        }
        touching = touching.max(simulation.contact("body")?.points);
    }
    trial.least("nodes that touch", touching as f64, 10.0);
    trial.least("volume over that at rest, least", volume[0], 0.97);
    trial.most("volume over that at rest, largest", volume[1], 1.03);
    let file = trial.scene(&sets)?;
    let mut inside = 0;
    for [of, other] in [["body", "other"], ["other", "body"]] {
        let mut meshes = Vec::new();
        for body in [of, other] {
            let Ok(mut mesh) = mesh_of(&file.scene.bodies[body], &file) else { continue };
            mesh.points = places(&mut simulation, body)?;
            meshes.push(mesh);
        }
        let [own, theirs] = &meshes[..] else { continue };
        let locator = Locator::new(theirs);
        for element in 0..own.element_count() {
            let corners = own.element(element).iter().map(|&node| own.points[node as usize]);
            let centroid = corners.clone().sum::<DVec3>() / own.element(element).len() as f64;
            // a tenth of an element below its corners
            inside += corners.filter(|corner| locator.holds(corner.lerp(centroid, 0.1)).is_some()).count();
        }
    }
    trial.most("corners of elements that are in the other", inside as f64, 0.0);
    Ok(())
}

/// H59.
pub fn pile(trial: &mut Trial<'_>) -> Result<(), Error> {
    let bodies = ["body", "next", "low", "high"];
    // a thousand once, where they take the least time
    let copies = if trial.full && trial.configuration.is_quickest() { 250 } else { 3 };
    let mut sets = trial.elements_of(&bodies[1..]);
    sets.extend(bodies.map(|body| format!("bodies.{body}.copies={copies}")));
    if trial.configuration.is_gpu() && !trial.full {
        sets.push("duration=0.1".into());
    }
    let mut simulation = trial.start(&sets)?;
    let mut weight = 0.0;
    for body in bodies {
        weight += G * mass(&mut simulation, body)?;
    }
    let end = simulation.scene().duration;
    let mut all = f64::INFINITY;
    let mut gained = 0.0_f64;
    let mut scale = 0.0_f64;
    for sample in 1..=20 {
        simulation.advance_to(end * f64::from(sample) / 20.0)?;
        let energies = simulation.energies()?;
        let mut now = energies.kinetic + energies.strain + energies.hourglass;
        scale = scale.max(now);
        for body in bodies {
            now += G * mass(&mut simulation, body)? * gone(&mut simulation, body)?.z;
        }
        (gained, all) = (gained.max(now - all), now);
    }
    trial.most("energy gained between two samples, over the largest", gained / scale, 0.01);
    if end > 0.5 {
        let felt = -simulation.tool("table")?.force.z;
        trial.near("weight on the table (N)", felt, weight, 0.01);
    }
    if trial.is_thorough() && copies == 3 {
        let mut options = trial.configuration.options.clone();
        options.threads = 2;
        let mut again = Simulation::new(&trial.scene(&sets)?, &options)?;
        again.advance_to(end)?;
        let mut same = true;
        for body in bodies {
            same &= simulation.displacements(body)? == again.displacements(body)?;
        }
        trial.holds("the same bits on two threads", same);
    }
    Ok(())
}
