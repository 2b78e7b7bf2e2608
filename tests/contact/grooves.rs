//! What lies in a sharp corner of one body: both walls bear it, also where it has sunk in.

use crate::configurations::{configurations, near};
use glam::DVec3;
use sinew::components::DisplacementIncrement;
use sinew::{BackendChoice, Simulation};
use std::fmt::Write;
use std::path::Path;

/// Writes a groove along y as one mesh: two slabs 8 mm wide and 4 mm thick at 45°, whose upper sides meet in a line.
fn write_groove(path: &Path) {
    let (across, deep, along) = (4, 2, 6);
    // out from the line along the wall, or back into the slab; slabs meet in the plane below the line
    let place = |side: f64, i: u32, k: u32, j: u32| {
        let (out, down) = (0.008 * f64::from(i) / f64::from(across), 0.004 * f64::from(k) / f64::from(deep));
        let (out, back) = (out - down * (1.0 - f64::from(i) / f64::from(across)), down);
        let half = 0.5_f64.sqrt();
        [side * half * (out + back), 0.05 * f64::from(j) / f64::from(along), half * (out - back)]
    };
    let (mut nodes, mut hexes) = (String::new(), String::new());
    let number = |wall: u32, i: u32, k: u32, j: u32| match (wall, i) {
        // those of the plane where both meet
        (_, 0) => 1 + k + (deep + 1) * j,
        _ => 1 + (deep + 1) * (along + 1) * (1 + wall * across + i - 1) + k + (deep + 1) * j,
    };
    for (wall, side) in [(0, 1.0), (1, -1.0)] {
        for (i, k, j) in (0..=across).flat_map(|i| (0..=deep).flat_map(move |k| (0..=along).map(move |j| (i, k, j)))) {
            if wall == 0 || i > 0 {
                let [x, y, z] = place(side, i, k, j);
                writeln!(nodes, "{} {x} {y} {z}", number(wall, i, k, j)).unwrap();
            }
            if i < across && k < deep && j < along {
                let mut face = [(i, k), (i + 1, k), (i + 1, k + 1), (i, k + 1)];
                if wall == 1 {
                    face.reverse();
                }
                let corners = [j, j + 1].map(|j| face.map(|(i, k)| number(wall, i, k, j).to_string()).join(" "));
                writeln!(hexes, "{} 5 2 1 1 {} {}", hexes.lines().count() + 1, corners[0], corners[1]).unwrap();
            }
        }
    }
    let counts = [nodes.lines().count(), hexes.lines().count()];
    let text = format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n{nodes}$EndNodes\n$Elements\n{}\n{hexes}$EndElements\n",
        counts[0], counts[1]
    );
    std::fs::write(path, text).unwrap();
}

/// A square prism of 6 mm that lies in the groove edge down, tilted along it by an angle (°), with friction .3: it
/// slides from tan⁻¹(√2 · .3) = 23° on.
fn lies(tilt: f64, (solver, law): (&str, &str)) -> String {
    let (sine, cosine) = tilt.to_radians().sin_cos();
    format!(
        "(duration: 0.4, {solver} bodies: {{
            \"v\": (mesh: File(path: \"v.msh\", hexes: Hex8MeanDilatation), material: \"m\"),
            \"b\": (mesh: Box(size: (0.006, 0.02, 0.006), cells: (1, 8, 1), elements: Hex8MeanDilatation),
                material: \"m\", rotate: (0, 45, 0), translate: (-0.00424264, 0.015, 0.00424265))}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e5, poisson: 0.3), damping: 10)}},
        constraints: [Fixed(body: \"v\", on: All)],
        loads: [Gravity(body: \"b\", acceleration: (0, {}, {}), curve: Smooth(end: 0.1))],
        contacts: [Between(bodies: (\"v\", \"b\"), friction: 0.3{law})])",
        9.81 * sine,
        -9.81 * cosine
    )
}

/// Momentum of both bodies in the middle of the last step, and its moment about the origin (kg m²/s).
fn moments(simulation: &mut Simulation) -> [DVec3; 2] {
    let rate = 1.0 / simulation.time_step();
    let mut sums = [DVec3::ZERO; 2];
    for body in ["v", "b"] {
        let (rest, u) = (simulation.rest_positions(body).unwrap().to_vec(), simulation.displacements(body).unwrap());
        let masses = simulation.masses(body).unwrap();
        let view = simulation.column::<DisplacementIncrement>(body).unwrap();
        for (i, &row) in view.node_rows().iter().enumerate() {
            let momentum = masses[i] * rate * view.values().vector(row as usize);
            sums[0] += momentum;
            sums[1] += (rest[i] + u[i]).cross(momentum);
        }
    }
    sums
}

/// A prism that is thrown into the corner of a groove, beside its middle, both free and without friction: what walls do
/// to each other acts along one line, also on nodes that have sunk in behind the line where walls meet. Borne at that
/// line by the normals of the walls, the moment changed by a thousandth of momentum times length.
#[test]
fn what_is_thrown_into_a_free_groove_keeps_momentum_and_its_moment() {
    let folder = tempfile::tempdir().unwrap();
    write_groove(&folder.path().join("v.msh"));
    let text = "(duration: 0.02, bodies: {
            \"v\": (mesh: File(path: \"v.msh\", hexes: Hex8MeanDilatation), material: \"m\"),
            \"b\": (mesh: Box(size: (0.006, 0.02, 0.006), cells: (1, 8, 1), elements: Hex8MeanDilatation),
                material: \"m\", rotate: (0, 45, 0), translate: (-0.00424264, 0.002, 0.00524265),
                velocity: (0, 0, -0.5))},
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 1e4, poisson: 0.3))},
        contacts: [Between(bodies: (\"v\", \"b\"))])";
    for run in configurations() {
        let mut simulation = run.start_in(text, folder.path());
        simulation.advance(1).unwrap();
        let [momentum, moment] = moments(&mut simulation);
        let size = momentum.length();
        assert!(size > 1e-4, "{}: {size} kg m/s", run.name);
        let mut force = 0.0_f64;
        while simulation.time() < 0.02 {
            simulation.advance(20).unwrap();
            force = force.max(simulation.contact("b").unwrap().force.length());
        }
        let [end, end_moment] = moments(&mut simulation);
        assert!(force > 0.01, "{}: {force} N", run.name);
        near(&run.name, end.distance(momentum), 0.0, size, run.bound(1e-10, 1e-5));
        near(&run.name, end_moment.distance(moment), 0.0, size * 0.05, run.bound(1e-6, 1e-4));
    }
}

/// A prism in a groove rests, however its springs and steps are chosen: it went up to 1 mm/s along it, since a node
/// behind the line where walls meet was pushed by one of them alone, now by one and now by the other.
#[test]
fn what_lies_in_a_groove_rests() {
    let folder = tempfile::tempdir().unwrap();
    write_groove(&folder.path().join("v.msh"));
    let springs = |share: f64| format!(", law: Penalty(share: {share}, damping: 0.3)");
    let implicit = |step: f64| format!("solver: Implicit(step: {step}),");
    let mut cases = vec![(15.0, "integration: (safety: 0.5),".to_string(), String::new())];
    cases.extend(
        [(0.08, 5e-3), (0.12, 5e-3), (0.2, 5e-3), (0.1, 2.5e-3)].map(|of| (20.0, implicit(of.1), springs(of.0))),
    );
    for run in configurations() {
        for (tilt, solver, law) in &cases {
            if !solver.is_empty() && run.options.backend != BackendChoice::Cpu {
                continue;
            }
            let mut simulation = run.start_in(&lies(*tilt, (solver, law)), folder.path());
            let seen = [0.2, 0.4].map(|time| {
                simulation.advance_to(time).unwrap();
                let u = simulation.displacements("b").unwrap();
                u.iter().map(|u| u.y).sum::<f64>() / u.len() as f64
            });
            let creeps = (seen[1] - seen[0]) / 0.2;
            assert!(creeps.abs() < 1e-6, "{}: {tilt}°, {solver}{law}: {creeps} m/s", run.name);
        }
    }
}
