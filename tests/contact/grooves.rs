//! What lies in a sharp corner of one body: both walls bear it, also where it has sunk in.

use crate::configurations::{configurations, near};
use crate::written::Written;
use glam::DVec3;
use sinew::components::DisplacementIncrement;
use sinew::{BackendChoice, Simulation};
use std::collections::BTreeMap;
use std::path::Path;

/// Adds a groove along y above a place x: two slabs 8 mm wide and 4 mm thick, whose upper sides rise by an angle (°)
/// and meet in a line.
fn add_groove(mesh: &mut Written, middle: f64, rises: f64) {
    let (across, deep, along) = (4, 2, 6);
    let (sine, cosine) = rises.to_radians().sin_cos();
    // out from the line along the wall, or back into the slab; slabs meet in the plane below the line
    let place = |side: f64, i: u32, k: u32, j: u32| {
        let (out, back) = (0.008 * f64::from(i) / f64::from(across), 0.004 * f64::from(k) / f64::from(deep));
        let out = out - back * sine / cosine * (1.0 - f64::from(i) / f64::from(across));
        let y = 0.05 * f64::from(j) / f64::from(along);
        [middle + side * (out * cosine + back * sine), y, out * sine - back * cosine]
    };
    let mut numbers = BTreeMap::new();
    for (wall, side) in [(0, 1.0), (1, -1.0)] {
        let mut of = |mesh: &mut Written, i: u32, k: u32, j: u32| {
            // those of the plane where both meet
            let wall = if i == 0 { 0 } else { wall };
            *numbers.entry((wall, i, k, j)).or_insert_with(|| mesh.node(place(side, i, k, j)))
        };
        for (i, k, j) in (0..across).flat_map(|i| (0..deep).flat_map(move |k| (0..along).map(move |j| (i, k, j)))) {
            let mut face = [(i, k), (i + 1, k), (i + 1, k + 1), (i, k + 1)];
            if wall == 1 {
                face.reverse();
            }
            let [near, far] = [j, j + 1].map(|j| face.map(|(i, k)| of(mesh, i, k, j)));
            mesh.element([&near, &far]);
        }
    }
}

/// Writes a groove of 90° along y.
fn write_groove(path: &Path) {
    let mut mesh = Written::default();
    add_groove(&mut mesh, 0.0, 45.0);
    mesh.write(path);
}

/// Writes a plate on two knives along y, with edges of 40° at x = ±12 mm and z = 0: it cannot topple in two grooves.
fn write_knives(path: &Path) {
    let mut mesh = Written::default();
    let half = 0.009 * 20.0_f64.to_radians().tan();
    let slices: Vec<[usize; 10]> = (0..=8)
        .map(|j| {
            let y = 0.006 + 0.018 * f64::from(j) / 8.0;
            let x = [-0.012 - half, -0.012 + half, 0.012 - half, 0.012 + half];
            let edges = [-0.012, 0.012].map(|x| mesh.node([x, y, 0.0]));
            let [low, high] = [0.009, 0.012].map(|z| x.map(|x| mesh.node([x, y, z])));
            [edges.as_slice(), &low, &high].concat().try_into().unwrap()
        })
        .collect();
    for pair in slices.windows(2) {
        for corners in [&[0, 3, 2][..], &[1, 5, 4], &[2, 3, 7, 6], &[3, 4, 8, 7], &[4, 5, 9, 8]] {
            let [near, far] = [pair[0], pair[1]].map(|slice| corners.iter().map(|&i| slice[i]).collect::<Vec<_>>());
            mesh.element([&near, &far]);
        }
    }
    mesh.write(path);
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
        assert!(force > 0.01, "{}: it does not hit: {force} N", run.name);
        near(run.name, end.distance(momentum), 0.0, size, run.bound(1e-10, 1e-5));
        near(run.name, end_moment.distance(moment), 0.0, size * 0.05, run.bound(1e-6, 1e-4));
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

/// A plate on two knives comes to rest in two grooves, narrow and wide, and both walls bear half of it: in narrow ones
/// the kinematic law left the wall that a point was deeper in as it was, and pushed into it from the other, by 350 µm;
/// implicit steps forgave the second wall what the first pushed into it, and bodies crept by 50 to 100 µm/s.
#[test]
fn knives_in_grooves_rest() {
    let folder = tempfile::tempdir().unwrap();
    write_knives(&folder.path().join("k.msh"));
    let mesh = |rises: f64| {
        let mut mesh = Written::default();
        [-0.012, 0.012].into_iter().for_each(|middle| add_groove(&mut mesh, middle, rises));
        mesh.write(&folder.path().join(format!("v{rises}.msh")));
    };
    [60.0, 45.0, 30.0].into_iter().for_each(mesh);
    let springs = ", law: Penalty(share: 0.2, damping: 0.3)";
    let implicit = [("solver: Implicit(step: 5e-3),", springs), ("solver: Implicit(step: 2.5e-3),", springs)];
    for run in configurations() {
        for (rises, friction) in [(60.0, 0.3), (60.0, 0.0), (45.0, 0.3), (30.0, 0.3)] {
            for (solver, law) in [("", "")].into_iter().chain(implicit) {
                if !solver.is_empty() && (run.options.backend != BackendChoice::Cpu || friction == 0.0) {
                    continue;
                }
                let text = format!(
                    "(duration: 0.4, {solver} bodies: {{
                        \"v\": (mesh: File(path: \"v{rises}.msh\", hexes: Hex8MeanDilatation), material: \"m\"),
                        \"b\": (mesh: File(path: \"k.msh\", hexes: Hex8MeanDilatation), material: \"m\")}},
                    materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e5, poisson: 0.3), damping: 20)}},
                    constraints: [Fixed(body: \"v\", on: All)],
                    loads: [Gravity(body: \"b\", acceleration: (0, 0, -9.81), curve: Smooth(end: 0.1))],
                    contacts: [Between(bodies: (\"v\", \"b\"), friction: {friction}{law})])"
                );
                let what = format!("{}: {rises}°, {friction}, {solver}", run.name);
                let mut simulation = run.start_in(&text, folder.path());
                let weight = 9.81 * simulation.masses("b").unwrap().iter().sum::<f64>();
                let seen = [0.3, 0.4].map(|time| {
                    simulation.advance_to(time).unwrap();
                    let u = simulation.displacements("b").unwrap();
                    u.iter().sum::<DVec3>() / u.len() as f64
                });
                let force = simulation.contact("b").unwrap().force;
                assert!(force.x.abs() < 0.03 * weight, "{what}: {force} N beside {weight}");
                near(&what, force.z, weight, weight, 0.03);
                assert!(seen[1].x.abs() < 3e-6 && seen[1].z > -4e-5, "{what}: {} m", seen[1]);
                assert!((seen[1] - seen[0]).z.abs() < 1e-6, "{what}: {seen:?}");
            }
        }
    }
}
