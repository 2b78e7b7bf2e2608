//! A step on the CPU asks the system for no memory once the first steps are taken: all that passes need comes from
//! where it was in the step before.
//!
//! Two kinds of steps ask for some, and no more than is said here: those in which bodies touch, for the columns of all
//! bodies that meet (2 calls) and, now and then, for a new look at what is near what; and implicit ones, whose
//! iterations have no length that is known beforehand.
//!
//! Counted are steps after which nobody looks: guards, probes, looks at the stable step and the removal of elements
//! make what they tell of. One test, for the count is of the whole program.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use sinew::components::{Alive, Precision};
use sinew::observation::Observer;
use sinew::{BackendChoice, Options, SceneFile, Simulation};
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};
use std::alloc::System;
use std::path::Path;

#[global_allocator]
static COUNTED: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// Steps before the first counted one: each arena has grown to what its largest pass needs by then.
const WARM: u64 = 96;
/// Steps among which the counted ones are.
const COUNTED_STEPS: u64 = 160;

/// Calls from outside of the pool that crossbeam's queue has room for before it takes another block.
const CALLS_A_BLOCK: u64 = 63;

/// A list of 16 bytes a step doubles at step 128 of one scene; whose it is has not been found out.
const DOUBLED: u64 = 1;

/// What shipped scenes are tried with: steps of one length, so that none is looked for; no probes, whose tables grow.
const SCENES: [(&str, &str, &[&str]); 7] = [
    ("nothing but elements", "cube_under_gravity", &["duration=10", "integration=(when_unstable: Watch)", "probes={}"]),
    (
        "means around nodes",
        "cube_under_gravity",
        &[
            "duration=10",
            "integration=(when_unstable: Watch)",
            "probes={}",
            "bodies.cube.mesh.elements=Tet4NodalPressure",
        ],
    ),
    (
        "fibres, viscosity and pressure",
        "lens_pressed",
        &["duration=10", "integration=(when_unstable: Watch)", "probes={}"],
    ),
    (
        "prescribed motion and viscosity",
        "retracted_lobe",
        &["duration=10", "integration=(when_unstable: Watch)", "probes={}"],
    ),
    (
        "between removals",
        "lens_tets",
        &[
            "duration=10",
            "integration=(when_unstable: Watch)",
            "probes={}",
            "removal=[(on: Set(\"core\"), when: During(start: 0, end: 0.8))]",
        ],
    ),
    ("tools", "probe", &["duration=10", "integration=(when_unstable: Watch)"]),
    ("an energy", "../examples/energy_law", &["duration=10", "integration=(when_unstable: Watch)", "probes={}"]),
];

/// Five bodies that threads share.
const BODIES: &str = r#"(duration: 10, materials: {"m": (density: 1000, neo_hookean: Young(young: 3000, poisson: 0.45))},
    bodies: {
        "a": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (5, 5, 5), elements: Tet4), material: "m"),
        "b": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (4, 4, 4), elements: Hex8), material: "m", translate: (1, 0, 0)),
        "c": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (12, 12, 12), elements: Tet4), material: "m", translate: (2, 0, 0)),
        "d": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (2, 2, 2), elements: Hex8), material: "m", translate: (3, 0, 0)),
        "e": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (9, 9, 9), elements: Hex8), material: "m", translate: (4, 0, 0)),
    },
    loads: [Gravity(acceleration: (0, 0, -2))], integration: (when_unstable: Watch))"#;

/// Bodies that are glued, tied, sutured and grasped.
const ATTACHED: &str = r#"(duration: 10, materials: {"m": (density: 1000, neo_hookean: Young(young: 3000, poisson: 0.45))},
    bodies: {
        "low": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (6, 6, 6)), material: "m"),
        "up": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (9, 9, 9), elements: Tet4), material: "m", translate: (0, 0, 0.1)),
        "side": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (3, 3, 3)), material: "m", translate: (0.102, 0, 0)),
    },
    constraints: [Fixed(body: "low", on: Plane(normal: (0, 0, 1), at: 0))], loads: [Gravity(acceleration: (0, 0, -2))],
    tools: {"forceps": (shape: Sphere(radius: 0.01), at: (0.15, 0.05, 0.1))},
    attachments: [
        Glue(bodies: ("up", "low"), normal: 1e5),
        Tie(from: (body: "side", at: (0.102, 0.05, 0.05)), to: (body: "low", at: (0.1, 0.05, 0.05))),
        Suture(from: (body: "side", at: (0.12, 0.05, 0.09)), to: (body: "up", at: (0.09, 0.05, 0.12)), stiffness: 5, strength: 100),
        Grasp(tool: "forceps", body: "side", on: Plane(normal: (0, 0, 1), at: 0.1), closed: Step()),
    ],
    integration: (when_unstable: Watch))"#;

/// Two bodies that lie on each other and on a table, all pressed together by gravity.
const TOUCHING: &str = r#"(duration: 10, materials: {"m": (density: 1000, neo_hookean: Young(young: 3e4, poisson: 0.45), damping: 12)},
    bodies: {
        "low": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (6, 6, 6), elements: Hex8MeanDilatation), material: "m"),
        "up": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (5, 5, 5), elements: Tet4), material: "m", translate: (0.003, 0.002, 0.020001)),
    },
    loads: [Gravity(acceleration: (0, 0, -100))],
    tools: {"table": (shape: Plane())},
    contacts: [Tool(tool: "table", body: "low", friction: 0.5), Between(bodies: ("low", "up"), friction: 0.5)],
    integration: (when_unstable: Watch))"#;

/// Two bodies of several patches that are far from each other, so that contact sleeps.
const APART: &str = r#"(duration: 10, materials: {"m": (density: 1000, neo_hookean: Young(young: 3e4, poisson: 0.45))},
    bodies: {
        "low": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (9, 9, 9)), material: "m"),
        "up": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (8, 8, 8), elements: Tet4), material: "m", translate: (0, 0, 0.1)),
    },
    loads: [Gravity(body: "up", acceleration: (0, 0, -0.01))], contacts: [Between(bodies: ("low", "up"), friction: 0.5)],
    integration: (when_unstable: Watch))"#;

/// Implicit steps of a bar that sags.
const IMPLICIT: &str = r#"(duration: 10, materials: {"m": (density: 1000, neo_hookean: Young(young: 3e4, poisson: 0.45))},
    bodies: {"bar": (mesh: Box(size: (0.1, 0.02, 0.02), cells: (10, 3, 3)), material: "m")},
    constraints: [Fixed(on: Plane(normal: (1, 0, 0), at: 0))], loads: [Gravity(acceleration: (0, 0, -2))],
    solver: Implicit(step: 0.005))"#;

/// What steps of a scene may ask for.
#[derive(Clone, Copy)]
struct Asks {
    /// Calls in every step.
    usual: usize,
    /// Calls in one that does more, such as to look at what is near what.
    most: usize,
    /// How many of them do.
    of_steps: f64,
}

const NOTHING: Asks = Asks { usual: 0, most: 0, of_steps: 0.0 };
/// As counted on one thread: 2, and 61 to 71 in 4 steps of 136.
const CONTACT: Asks = Asks { usual: 2, most: 73, of_steps: 0.05 };
/// As counted: 49 to 65.
const NEWTON: Asks = Asks { usual: 65, most: 0, of_steps: 0.0 };

fn alive(simulation: &mut Simulation) -> u64 {
    let world = simulation.world_mut();
    world.query::<&Alive>().iter(world).map(|alive| alive.iter().map(|&there| u64::from(there)).sum::<u64>()).sum()
}

fn looks_at_the_step(simulation: &Simulation) -> u64 {
    simulation.step_history().map_or(0, |history| history.checks)
}

/// Calls for memory in steps after which nobody looks, and how many these are.
fn count(scene: &SceneFile, precision: Precision, threads: usize) -> (Vec<(u64, usize)>, u64) {
    let options = Options { backend: BackendChoice::Cpu, precision, threads, ..Options::default() };
    let mut simulation = Simulation::new(scene, &options).unwrap_or_else(|wrong| panic!("{wrong}"));
    simulation.advance(WARM).unwrap();
    let (mut found, mut counted) = (Vec::new(), 0);
    for _ in 0..COUNTED_STEPS {
        let step = simulation.step_count();
        let observes = simulation.world().resource::<Observer>().next_due(step) == step + 1;
        let before = (alive(&mut simulation), looks_at_the_step(&simulation));
        let region = Region::new(COUNTED);
        simulation.step().unwrap();
        let change = region.change();
        if observes || (alive(&mut simulation), looks_at_the_step(&simulation)) != before {
            continue;
        }
        counted += 1;
        let calls = change.allocations + change.reallocations;
        if calls > 0 {
            found.push((step, calls));
        }
    }
    (found, counted)
}

#[test]
fn a_step_asks_for_no_memory() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut scenes: Vec<(&str, SceneFile, Asks)> = Vec::new();
    for (what, name, sets) in SCENES {
        let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
        let scene = SceneFile::load(root.join("scenes").join(format!("{name}.ron")), &sets);
        scenes.push((what, scene.unwrap_or_else(|wrong| panic!("{}", wrong.render(false))), NOTHING));
    }
    let texts = [
        ("five bodies", BODIES, NOTHING),
        ("attachments", ATTACHED, NOTHING),
        ("bodies that touch", TOUCHING, CONTACT),
        ("bodies far from each other", APART, NOTHING),
        ("implicit steps", IMPLICIT, NEWTON),
    ];
    for (what, text, asks) in texts {
        let bodies = SceneFile::from_text("bodies.ron", text, root, &[]);
        scenes.push((what, bodies.unwrap_or_else(|wrong| panic!("{}", wrong.render(false))), asks));
    }
    let mut wrong = Vec::new();
    for (what, scene, asks) in &scenes {
        for (precision, threads) in [(Precision::F32, 1), (Precision::F64, 1), (Precision::F32, 2), (Precision::F64, 2)]
        {
            let (found, counted) = count(scene, precision, threads);
            println!("{what}, {precision:?} on {threads}: {counted} steps counted, {found:?}");
            assert!(counted > COUNTED_STEPS / 2, "{what}: only {counted} steps are counted");
            // each step is a call from outside here; `advance` makes one of many steps
            let blocks = if threads > 1 { counted / CALLS_A_BLOCK + 1 } else { 0 };
            // and a thread that finds its first work late gets its place for a patch then
            let places = if threads > 1 { 2 * threads as u64 } else { 0 };
            let does_more = |calls: usize| asks.most > 0 && 2 * calls > asks.most;
            let (more, usual): (Vec<_>, Vec<_>) = found.iter().partition(|(_, calls)| does_more(*calls));
            let calls: usize = usual.iter().map(|(_, calls)| calls.saturating_sub(asks.usual)).sum();
            let too_many = calls as u64 > DOUBLED + blocks + places;
            let too_often = more.len() as f64 > asks.of_steps * counted as f64;
            // what threads ask for beside it they may ask for in any step
            let most = asks.most + (blocks + places) as usize;
            if too_many || too_often || more.iter().any(|(_, calls)| *calls > most) {
                wrong.push(format!("{what}, {precision:?} on {threads}: {found:?}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
