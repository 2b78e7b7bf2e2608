//! Snapshots: what goes on from one gives the same bits; what is damaged or foreign is refused with the reason.

use crate::configurations::{Configuration, configurations, cpu_and_long_gpu, scene_of};
use crate::grids::bits;
use proptest::prelude::*;
use sinew::bevy_ecs;
use sinew::bevy_ecs::prelude::*;
use sinew::components::{ConstrainedAxes, ExternalForce, Precision};
use sinew::systems::{Phase, Registry, System};
use sinew::{BackendChoice, Error, Options, Simulation, Snapshot};
use std::path::Path;

/// All that has a state: compensated sums, viscous memory of stress and pressure, damping, removal by time and
/// criterion, accumulated work, prescribed motion; pressure that asks which faces are left.
fn scene(elements: &str, further: &str) -> String {
    format!(
        "(duration: 100, bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (3, 3, 3), elements: {elements}),
            material: \"m\", spin: (1, 2, 3))}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45), damping: 2,
            prony: (terms: [(alpha: 0.3, tau: 0.05)], volumetric: [(alpha: 0.1, tau: 0.1)]))}},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0)),
            Prescribed(on: Plane(normal: (0, 0, 1), at: 0.1), axes: [X], displacement: (0.01, 0, 0), curve: Smooth(end: 0.05))],
        loads: [Gravity(acceleration: (0, 0, -9.81)), Pressure(on: Surface(normal: (1, 0, 0)), pressure: 200)],
        removal: [(on: Box(min: (0.06, 0, 0), max: (0.1, 0.1, 0.1)), when: During(start: 0.005, end: 0.06)),
            (when: StretchAbove(1.6))],
        integration: (step: 5e-4), output: (energies_every: 0.01) {further})"
    )
}

fn all_of(simulation: &mut Simulation) -> (Vec<[u64; 3]>, String, usize) {
    let (energies, removed) = (simulation.energies().unwrap(), simulation.summary("").unwrap().removed_elements);
    (bits(simulation, "b"), format!("{energies:?}"), removed)
}

#[test]
fn what_goes_on_from_a_snapshot_gives_the_same_bits() {
    for (run, elements) in cpu_and_long_gpu().iter().flat_map(|run| ["Tet4NodalPressure", "Hex8"].map(|e| (run, e))) {
        let text = scene(elements, "");
        let mut whole = run.start(&text);
        whole.advance(47).unwrap();
        let kept = whole.snapshot().unwrap();
        let before = all_of(&mut whole);
        whole.advance(60).unwrap();
        let end = all_of(&mut whole);
        assert!(end.2 > before.2 && before.2 > 0, "elements must go before and after: {} {}", before.2, end.2);
        // through a file's bytes, into another simulation
        let kept = Snapshot::from_bytes(&kept.to_bytes().unwrap()).unwrap();
        let mut other = run.start(&text);
        other.restore(&kept).unwrap();
        assert_eq!((other.step_count(), other.time()), (47, 47.0 * 5e-4));
        assert!(all_of(&mut other) == before, "{}, {elements}: another state", run.name);
        other.advance(60).unwrap();
        assert!(all_of(&mut other) == end, "{}, {elements}: another way on", run.name);
        // and back in the same one, whose elements have gone since
        whole.restore(&kept).unwrap();
        assert!(all_of(&mut whole) == before, "{}, {elements}: no way back", run.name);
        whole.advance(60).unwrap();
        assert!(all_of(&mut whole) == end, "{}, {elements}: another way from back there", run.name);
    }
}

#[derive(Resource, Clone, serde::Serialize, serde::Deserialize)]
struct Wind {
    gusts: u64,
    strength: f64,
}

/// Its strength depends on how often it has blown.
fn blow(mut wind: ResMut<Wind>, mut bodies: Query<(&mut ExternalForce, &mut ConstrainedAxes)>) {
    wind.gusts += 1;
    wind.strength = (wind.strength * 1.1 + 0.1) % 0.013;
    for (mut force, mut axes) in &mut bodies {
        let last = force.len() - 3;
        force.set(last, wind.strength);
        // what no system of the engine writes belongs to the state too
        axes[0] = (wind.gusts % 7) as u32;
    }
}

#[test]
fn state_of_custom_systems_goes_along_where_they_declare_one() {
    for run in cpu_and_long_gpu() {
        let text = scene("Hex8", "").replace("energies_every: 0.01", "").replace(
            "integration:",
            "schedule: [\"boundary\", \"element_forces\", \"gather\", \"gravity\", \"pressure\", \"wind\", \"integrate\",
             \"element_removal\", \"observe\"], integration:",
        );
        let registry = |kept: bool| {
            let system = System::custom("wind", Phase::Loads, "blows", blow).every(3);
            Registry::default().with(if kept { system.with_state::<Wind>() } else { system })
        };
        let start = |kept: bool| {
            let file = scene_of(&text, Path::new("."));
            let mut simulation = Simulation::with_systems(&file, &run.options, &registry(kept)).unwrap();
            simulation.world_mut().insert_resource(Wind { gusts: 0, strength: 0.01 });
            simulation
        };
        let (mut whole, mut other) = (start(true), start(true));
        whole.advance(20).unwrap();
        let kept = whole.snapshot().unwrap();
        whole.advance(20).unwrap();
        other.restore(&kept).unwrap();
        other.advance(20).unwrap();
        assert!(bits(&mut whole, "b") == bits(&mut other, "b"), "{}", run.name);
        assert_eq!(other.world().resource::<Wind>().gusts, 14);
        let refused = start(false).restore(&kept).unwrap_err().to_string();
        assert!(refused.contains("the state of the systems [wind], here there are []"), "{refused}");
    }
}

#[test]
fn snapshot_of_the_cpu_fits_the_gpu() {
    let all = configurations();
    let [_, cpu, gpu] = &all[..] else { return };
    let text = scene("Hex8", "");
    let mut whole = cpu.start(&text);
    whole.advance(30).unwrap();
    let mut other = gpu.start(&text);
    other.restore(&whole.snapshot().unwrap()).unwrap();
    assert_eq!(bits(&mut whole, "b"), bits(&mut other, "b"));
    whole.advance(30).unwrap();
    other.advance(30).unwrap();
    let (a, b) = (whole.displacements("b").unwrap(), other.displacements("b").unwrap());
    let apart = a.iter().zip(&b).fold(0.0_f64, |worst, (a, b)| worst.max((*a - *b).length()));
    assert!(apart > 0.0 && apart < 1e-6, "{apart}");
}

fn cpu(precision: Precision) -> Configuration {
    let options = Options { backend: BackendChoice::Cpu, precision, threads: 1, ..Options::default() };
    Configuration { name: "CPU", options }
}

#[test]
fn foreign_snapshots_are_refused_with_the_reason() {
    let (run, text) = (cpu(Precision::F32), scene("Hex8", ""));
    let mut simulation = run.start(&text);
    simulation.advance(5).unwrap();
    let kept = simulation.snapshot().unwrap();
    let refused = |other: &mut Simulation| {
        let before = bits(other, "b");
        let error = other.restore(&kept).unwrap_err();
        assert!(matches!(error, Error::Snapshot(_)), "{error}");
        assert!(bits(other, "b") == before && other.step_count() == 0, "it has changed all the same");
        error.to_string()
    };
    let said = refused(&mut cpu(Precision::F64).start(&text));
    assert!(said.contains("its numbers are F32, here they are F64"), "{said}");
    let changes = [
        ("density: 1000", "density: 1001", "materials"),
        ("pressure: 200", "pressure: 201", "loads"),
        ("axes: [X]", "axes: [Y]", "constraints"),
        ("cells: (3, 3, 3)", "cells: (3, 3, 4)", "bodies, meshes"),
        ("StretchAbove(1.6)", "StretchAbove(1.7)", "removal"),
        ("step: 5e-4", "step: 4e-4", "integration, materials, time step"),
    ];
    for (from, to, part) in changes {
        assert!(text.contains(from));
        let said = refused(&mut run.start(&text.replace(from, to)));
        assert!(said.contains("of another simulation") && said.contains(part), "{from} to {to}: {said}");
        // and no part that is as it was
        let named = ["materials", "loads", "constraints", "meshes", "removal"].map(|name| said.contains(name));
        assert_eq!(
            named,
            ["materials", "loads", "constraints", "meshes", "removal"].map(|name| part.contains(name)),
            "{said}"
        );
    }
    // what does not move anything may differ
    let further =
        text.replace("duration: 100", "duration: 200").replace("energies_every: 0.01", "energies_every: 0.02");
    run.start(&further.replace("(duration", "(title: \"longer\", duration")).restore(&kept).unwrap();
    let still =
        text.replace("integration:", "analysis: Static(), integration:").replace("removal: [", "probes: {}, //");
    if let Ok(file) = sinew::SceneFile::from_text("still", &still, Path::new("."), &[])
        && let Ok(mut still) = Simulation::new(&file, &run.options)
    {
        let said = still.snapshot().unwrap_err().to_string();
        assert!(said.contains("a static analysis has no snapshots"), "{said}");
    }
}

/// What is counted is a part of the state: which fields of a scene say so is told, and not which columns there are.
#[test]
fn a_snapshot_with_other_work_counted_is_refused_with_what_asks_for_it() {
    let (run, text) = (cpu(Precision::F32), scene("Hex8", ""));
    let named = "output: (energies_every: 0.01)";
    assert!(text.contains(named));
    let scenes = [text.clone(), text.replace(named, ""), text.replace(named, "guards: (off: [Energy])")];
    let words = ["`output` names `energies_every`", "for the guard `Energy`", "`guards` has `Energy` in `off`"];
    for (theirs, from) in scenes.iter().enumerate() {
        let mut simulation = run.start(from);
        simulation.advance(3).unwrap();
        let kept = simulation.snapshot().unwrap();
        for (here, into) in scenes.iter().enumerate() {
            match run.start(into).restore(&kept) {
                Ok(()) => assert_eq!(theirs, here),
                Err(error) => {
                    let said = error.to_string();
                    assert!(theirs != here && said.contains("of another simulation"), "{said}");
                    assert!(said.contains(words[theirs]) && said.contains(words[here]), "{theirs}, {here}: {said}");
                }
            }
        }
    }
}

/// Two blocks, one above the other, and how they meet.
fn blocks(contacts: &str) -> String {
    let block = |z: f64| {
        format!(
            "(mesh: Box(size: (0.02, 0.02, 0.02), cells: (2, 2, 2), elements: Hex8), material: \"m\",
             translate: (0, 0, {z:?}))"
        )
    };
    format!(
        "(duration: 1, bodies: {{\"a\": {}, \"b\": {}}},
         materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e4, poisson: 0.4))}},
         contacts: [{contacts}])",
        block(0.0),
        block(0.021)
    )
}

/// Where a scene has neither tools nor attachments, too.
#[test]
fn a_snapshot_of_other_contacts_between_bodies_is_refused() {
    let run = cpu(Precision::F32);
    for kind in ["Between(bodies: (\"a\", \"b\")", "Itself(body: \"a\""] {
        let text = blocks(&format!("{kind}, friction: 0.5, thickness: 1e-4, sweeps: 2)"));
        let mut simulation = run.start(&text);
        simulation.advance(3).unwrap();
        let kept = simulation.snapshot().unwrap();
        let changes = [
            ("friction: 0.5", "friction: 0.4"),
            ("thickness: 1e-4", "thickness: 2e-4"),
            ("sweeps: 2", "sweeps: 3"),
            ("sweeps: 2", "law: Penalty(share: 0.1)"),
        ];
        let others = changes.map(|(from, to)| {
            assert!(text.contains(from));
            text.replace(from, to)
        });
        for other in others.into_iter().chain([blocks("")]) {
            let mut simulation = run.start(&other);
            let said = simulation.restore(&kept).unwrap_err().to_string();
            let told = said.contains("of another simulation") && said.contains("tools, contacts and attachments");
            assert!(told && simulation.step_count() == 0, "{other}: {said}");
        }
        let mut same = run.start(&text);
        same.restore(&kept).unwrap();
        assert_eq!(same.step_count(), 3);
    }
}

fn bytes() -> Vec<u8> {
    let mut simulation = cpu(Precision::F32).start(&scene("Hex8", ""));
    simulation.advance(5).unwrap();
    simulation.snapshot().unwrap().to_bytes().unwrap()
}

/// With a checksum and a length that fit again: what someone could write who means harm.
fn sealed(mut bytes: Vec<u8>) -> Vec<u8> {
    bytes.truncate(bytes.len().saturating_sub(8).max(24));
    bytes.resize(bytes.len().max(24), 0);
    let length = bytes.len() as u64 + 8;
    bytes[16..24].copy_from_slice(&length.to_le_bytes());
    let check = twox_hash::XxHash64::oneshot(0, &bytes);
    bytes.extend(check.to_le_bytes());
    bytes
}

#[test]
fn damaged_snapshots_say_what_is_wrong() {
    let good = bytes();
    let said = |bytes: &[u8]| Snapshot::from_bytes(bytes).unwrap_err().to_string();
    assert!(said(b"").contains("too short"));
    assert!(said(&[0; 64]).contains("does not begin as one"));
    assert!(said(&good[..good.len() - 1]).contains("cut short"));
    assert!(said(&[&good[..], b"x"].concat()).contains("added to"));
    let mut flipped = good.clone();
    flipped[good.len() / 2] ^= 4;
    assert!(said(&flipped).contains("damaged"));
    let mut newer = good.clone();
    newer[8] = 99;
    assert!(said(&newer).contains("version 99"));
    // lengths that lie are found before anything of their size is made
    let mut head = good.clone();
    head[12..16].copy_from_slice(&u32::MAX.to_le_bytes());
    assert!(said(&sealed(head)).contains("longer than the whole"));
    let text = String::from_utf8_lossy(&good[24..]).into_owned();
    let column = text.find("bytes:").unwrap() + 24 + 6;
    let mut huge = good.clone();
    huge[column] = b'9';
    assert!(said(&sealed(huge)).contains("columns are not"));
    // a clock whose step began to count after the present one would stand still
    let mut clock = good.clone();
    let since = text.find("since:(0,").unwrap() + 24 + 7;
    clock[since] = b'9';
    let said = said(&sealed(clock));
    assert!(said.contains("clock cannot be that of a motion"), "{said}");
    assert!(Snapshot::from_bytes(&sealed(good.clone())).unwrap() == Snapshot::from_bytes(&good).unwrap());
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    #[test]
    fn mutated_snapshots_are_refused_and_never_crash(
        cut in 0.0..1.0_f64,
        changes in proptest::collection::vec((0.0..1.0_f64, 1..=255_u8), 1..6),
        in_front in any::<bool>(),
        seal in any::<bool>(),
    ) {
        static GOOD: std::sync::LazyLock<Vec<u8>> = std::sync::LazyLock::new(bytes);
        let mut bytes = GOOD.clone();
        let reach = if in_front { 2000 } else { bytes.len() };
        for (at, change) in changes {
            bytes[(at * reach as f64) as usize] ^= change;
        }
        if cut < 0.3 {
            bytes.truncate((cut / 0.3 * bytes.len() as f64) as usize);
        }
        if !seal {
            let same = bytes == *GOOD;
            prop_assert_eq!(Snapshot::from_bytes(&bytes).is_ok(), same);
        } else if let Ok(snapshot) = Snapshot::from_bytes(&sealed(bytes)) {
            // whole by its checksum: it fits, or it is refused; steps from it end well or with an error
            let mut simulation = cpu(Precision::F32).start(&scene("Hex8", ""));
            if simulation.restore(&snapshot).is_ok() {
                let _ = simulation.advance(3);
            }
        }
    }
}

/// The same tissue with fibres along x in one file and along y in the other, and a set that holds other nodes.
#[test]
fn other_fields_or_sets_of_a_mesh_are_another_simulation() {
    let place = tempfile::tempdir().unwrap();
    let mesh = |fibres: [f64; 3], top: &str| {
        format!(
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n0 1 \"top\"\n3 2 \"all\"\n$EndPhysicalNames\n\
             $Nodes\n5\n1 0 0 0\n2 .1 0 0\n3 0 .1 0\n4 0 0 .1\n5 .1 .1 .1\n$EndNodes\n\
             $Elements\n3\n1 15 2 1 1 {top}\n2 4 2 2 2 1 2 3 4\n3 4 2 2 2 2 3 4 5\n$EndElements\n\
             $ElementData\n1\n\"fibres\"\n1\n0\n3\n0\n3\n2\n2 {x} {y} {z}\n3 {x} {y} {z}\n$EndElementData\n",
            x = fibres[0],
            y = fibres[1],
            z = fibres[2]
        )
    };
    let scene = "(duration: 1, bodies: {\"b\": (mesh: File(path: \"m.msh\"), material: \"m\")},
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.3),
            fibres: (eta: 1e3, direction: Field(\"fibres\")))},
        constraints: [Fixed(on: Set(\"top\"))], integration: (step: 1e-4))";
    let start = |text: String| {
        std::fs::write(place.path().join("m.msh"), text).unwrap();
        cpu(Precision::F32).start_in(scene, place.path())
    };
    let mut first = start(mesh([1.0, 0.0, 0.0], "4"));
    first.advance(3).unwrap();
    let kept = first.snapshot().unwrap();
    start(mesh([1.0, 0.0, 0.0], "4")).restore(&kept).unwrap();
    for other in [mesh([0.0, 1.0, 0.0], "4"), mesh([1.0, 0.0, 0.0], "5")] {
        let said = start(other).restore(&kept).unwrap_err().to_string();
        assert!(said.contains("meshes (with their named sets and fields)"), "{said}");
    }
}

/// Nothing of the world outside is in them: not how long something took.
#[test]
fn two_snapshots_of_a_state_are_the_same_bytes() {
    let soft =
        scene("Tet4", "").replace("integration: (step: 5e-4)", "integration: ()").replace("young: 3e3", "young: 2e3");
    let run = || {
        let mut simulation = cpu(Precision::F32).start(&soft);
        simulation.advance(40).unwrap();
        simulation.snapshot().unwrap().to_bytes().unwrap()
    };
    assert!(run() == run());
}

#[test]
fn what_is_no_file_is_not_read_to_its_end() {
    let said = |path: &Path| Snapshot::read(path).unwrap_err().to_string();
    if Path::new("/dev/zero").exists() {
        assert!(said(Path::new("/dev/zero")).contains("is no file"));
    }
    let place = tempfile::tempdir().unwrap();
    assert!(said(place.path()).contains("is no file"));
    // two gigabytes that hold nothing, and the same behind the beginning of a snapshot
    let path = place.path().join("large");
    let large = std::fs::File::create(&path).unwrap();
    large.set_len(2 << 30).unwrap();
    assert!(said(&path).contains("does not begin as one"));
    std::fs::write(&path, &bytes()[..200]).unwrap();
    std::fs::File::options().write(true).open(&path).unwrap().set_len(2 << 30).unwrap();
    assert!(said(&path).contains("cut short or has been added to"));
}
