//! What lies in a sharp corner of one body: both walls bear it, also where it has sunk in.

use crate::configurations::configurations;
use sinew::BackendChoice;
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
