//! The same bits as before: hashes of how the shipped scenes end, kept in `golden.ron`.
//!
//! What is meant to change no numbers changes none of these; a commit that changes one says why, and writes them anew:
//! `SINEW_GOLDEN=write cargo test --test scenes golden`. Instruction sets that the machine has not are told of and left
//! as they are; where the others' hashes change, theirs are no longer known, and go. A set whose hash is not known is
//! told of on a machine that has it.

use super::scene;
use super::shipped::SCENES;
use sinew::backend::cpu::{Cpu, Instructions};
use sinew::components::Precision;
use sinew::{BackendChoice, Options, Simulation};
use std::collections::{BTreeMap, BTreeSet};
use std::hash::Hasher;
use twox_hash::XxHash64;

/// By scene, precision and instruction set.
type Hashes = BTreeMap<String, BTreeMap<String, String>>;

fn path() -> String {
    format!("{}/tests/scenes/golden.ron", env!("CARGO_MANIFEST_DIR"))
}

/// Scenes by implicit steps, of both schemes, and at rest by Newton's iterations: what is told of them, which scene it
/// is, and what makes it so.
const SOLVED: [(&str, &str, &[&str]); 3] = [
    ("lens_pressed by implicit Euler", "lens_pressed", &["duration=0.1", "solver=Implicit(step: 0.01)"]),
    (
        "cube_under_gravity by generalised-α",
        "cube_under_gravity",
        &[
            "bodies.cube.mesh.cells=(5, 5, 5)",
            "duration=0.2",
            "solver=Implicit(scheme: GeneralizedAlpha(), step: 0.01)",
        ],
    ),
    (
        "cube_under_gravity at rest",
        "cube_under_gravity",
        &["bodies.cube.mesh.cells=(5, 5, 5)", "analysis=Static(method: Newton)"],
    ),
];

/// Of all that a run ends with: displacements and forces of all bodies in the author's order, and how many steps it
/// took.
fn hash(simulation: &mut Simulation) -> String {
    let mut hasher = XxHash64::with_seed(0);
    hasher.write_u64(simulation.step_count());
    hasher.write_u64(simulation.time().to_bits());
    let bodies: Vec<String> = simulation.scene().bodies.keys().cloned().collect();
    for body in bodies {
        let vectors = [simulation.displacements(&body).unwrap(), simulation.internal_forces(&body).unwrap()];
        for vector in vectors.iter().flatten() {
            vector.to_array().iter().for_each(|number| hasher.write_u64(number.to_bits()));
        }
    }
    format!("{:016x}", hasher.finish())
}

#[test]
#[ignore = "long"]
fn golden_hashes_of_shipped_scenes() {
    let mut kept: Hashes = ron::from_str(&std::fs::read_to_string(path()).unwrap_or_else(|_| "{}".into())).unwrap();
    let writes = std::env::var("SINEW_GOLDEN").is_ok_and(|what| what == "write");
    let (mut wrong, mut there, mut unknown) = (Vec::new(), BTreeSet::new(), Vec::new());
    let explicit = SCENES.into_iter().map(|(name, sets)| (name, name, sets));
    for (name, file, sets) in explicit.chain(SOLVED) {
        let scene = scene(file, sets);
        for precision in [Precision::F32, Precision::F64] {
            let known = kept.get(&format!("{name} {precision:?}")).cloned().unwrap_or_default();
            for instructions in [Instructions::Widest, Instructions::Avx2, Instructions::Portable] {
                let options =
                    Options { backend: BackendChoice::Cpu, precision, instructions, threads: 2, ..Options::default() };
                let mut simulation = Simulation::new(&scene, &options).unwrap();
                let set = simulation.world().resource::<Cpu>().instruction_set();
                let of_scene = kept.entry(format!("{name} {precision:?}")).or_default();
                if !there.insert((name, precision as u8, set.clone())) {
                    continue;
                }
                simulation.finish().unwrap_or_else(|error| panic!("{name}: {error}"));
                let now = hash(&mut simulation);
                match known.get(&set) {
                    Some(before) if *before == now => {
                        of_scene.insert(set, now);
                    }
                    Some(_) if writes => {
                        // what stands there of others is of before
                        of_scene.retain(|other, hash| known.get(other) != Some(hash));
                        of_scene.insert(set, now);
                    }
                    Some(before) => wrong.push(format!("{name} {precision:?} {set}: {now}, was {before}")),
                    None if writes => {
                        of_scene.insert(set, now);
                    }
                    // portable code is known of every scene
                    None if set == "scalar" => wrong.push(format!("{name} {precision:?} {set}: {now}, was none")),
                    None => unknown.push(format!("{name} {precision:?} {set}")),
                }
            }
        }
    }
    let sets: BTreeSet<&String> = there.iter().map(|(.., set)| set).collect();
    let left: BTreeSet<&String> = kept.values().flat_map(BTreeMap::keys).filter(|set| !sets.contains(set)).collect();
    println!("compared: {sets:?}; not on this machine: {left:?}; not known: {unknown:?}");
    if writes {
        let pretty = ron::ser::PrettyConfig::default();
        std::fs::write(path(), ron::ser::to_string_pretty(&kept, pretty).unwrap() + "\n").unwrap();
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
