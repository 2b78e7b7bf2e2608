//! Cubes that their weight presses into a tray, on its floor and against two walls.

use crate::configurations::{configurations, cpu_and_long_gpu};
use crate::written::Written;
use std::collections::BTreeMap;
use std::path::Path;

/// Writes a tray: three slabs of 4 mm, 16 mm wide, that meet at the origin, and go on along x, y and z from there.
fn write_tray(path: &Path) {
    let (mut mesh, mut numbers) = (Written::default(), BTreeMap::new());
    let cells = (0..4).flat_map(|i| (0..4).flat_map(move |j| (0..4).map(move |k| [i, j, k])));
    for [i, j, k] in cells.filter(|cell| cell.contains(&0)) {
        let mut of = |i: u32, j: u32, k: u32| {
            let place = [i, j, k].map(|number| 0.004 * (f64::from(number) - 1.0));
            *numbers.entry([i, j, k]).or_insert_with(|| mesh.node(place))
        };
        let [low, high] = [k, k + 1].map(|k| [of(i, j, k), of(i + 1, j, k), of(i + 1, j + 1, k), of(i, j + 1, k)]);
        mesh.element([&low, &high]);
    }
    mesh.write(path);
}

/// A cube of so many cells along each side, of a law, off the walls (m), in a tray that lies in a folder, pulled so;
/// with a contact's law.
fn cube((cells, elastic, damping, off): (u32, &str, u32, f64), (steps, pull, law): (&str, &str, &str)) -> String {
    format!(
        "(duration: 0.6, {steps} bodies: {{
            \"t\": (mesh: File(path: \"t.msh\", hexes: Hex8MeanDilatation), material: \"m\"),
            \"b\": (mesh: Box(size: (0.008, 0.008, 0.008), cells: ({cells}, {cells}, {cells}),
                elements: Hex8MeanDilatation), material: \"m\", translate: ({off}, {off}, 0))}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young({elastic}), damping: {damping})}},
        constraints: [Fixed(body: \"t\", on: All)],
        loads: [Gravity(body: \"b\", acceleration: {pull}, curve: Smooth(end: 0.1))],
        contacts: [Between(bodies: (\"t\", \"b\"){law})])"
    )
}

/// Where walls share the masses of nodes with the floor and let go by turns, contact takes energy and makes none: at
/// the default step cubes were thrown about, and ended the run by energy from nothing.
#[test]
fn cubes_are_not_thrown_about_in_trays() {
    let folder = tempfile::tempdir().unwrap();
    write_tray(&folder.path().join("t.msh"));
    for run in cpu_and_long_gpu() {
        for of in [(2, "young: 1e4, poisson: 0.3", 30, 0.0), (4, "young: 1e4, poisson: 0.3", 30, 0.0)] {
            let text = cube(of, ("", "(-1, -2, -9)", ", friction: 0"));
            let mut simulation = run.start_in(&text, folder.path());
            simulation.advance_to(0.6).unwrap();
            let (energies, told) = (simulation.energies().unwrap(), simulation.summary("").unwrap().guards.warnings);
            let (kinetic, loss) = (energies.kinetic, energies.contact_loss.unwrap());
            println!("{}, {of:?}: moves with {kinetic:.2e} J, {loss:.2e} J lost", run.name);
            // of some 4e-8 J of strain
            assert!(kinetic < 4e-10 && loss > 0.0 && loss < 4e-8, "{}, {of:?}: {kinetic}, {loss} J", run.name);
            assert!(told.is_empty(), "{}, {of:?}: {told:?}", run.name);
        }
    }
}

/// Of 72 cubes how many end, with these steps, friction and law.
fn ends(folder: &Path, (steps, law): (&str, &str)) -> usize {
    let mut ends = 0;
    let run = &configurations()[0];
    for pull in ["(-1, -2, -9)", "(0, 0, -9.81)"] {
        for cells in [2, 3, 4] {
            for elastic in ["young: 3e3, poisson: 0.45", "young: 1e4, poisson: 0.3"] {
                for (damping, off) in
                    [30, 0].into_iter().flat_map(|damping| [0.0, 1e-6, 1e-5].map(|off| (damping, off)))
                {
                    let text = cube((cells, elastic, damping, off), (steps, pull, law));
                    let mut simulation = run.start_in(&text, folder);
                    ends += usize::from(simulation.advance_to(0.6).is_err());
                }
            }
        }
    }
    println!("{steps} {law}: {ends} of 72 end");
    ends
}

#[test]
#[ignore = "long"]
fn cubes_rest_in_trays() {
    let folder = tempfile::tempdir().unwrap();
    write_tray(&folder.path().join("t.msh"));
    let of = |steps, law| ends(folder.path(), (steps, law));
    for law in [", friction: 0", ", friction: 0, sweeps: 2", ", friction: 0.1"] {
        assert_eq!(of("", law), 0, "{law}");
    }
    // springs know nothing of what they hold
    of("", ", friction: 0, law: Penalty(share: 0.2, damping: 0.3)");
    assert_eq!(of("integration: (safety: 0.5),", ", friction: 0"), 0);
}
