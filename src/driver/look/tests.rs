#![allow(clippy::unwrap_used)]

use crate::driver::{Command, Session};
use crate::{BackendChoice, Options, SceneFile};
use std::path::Path;

const SCENE: &str = "(duration: 2,
    bodies: {\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (2, 2, 2), elements: Hex8), material: \"m\")},
    materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))},
    constraints: [Fixed(on: Set(\"z0\"))], integration: (step: 1e-3), output: (energies_every: 0.01),
    loads: [Gravity(acceleration: (0, 0, -9.81), curve: Input(name: \"weight\", initial: 1))],
    probes: {\"top\": (what: Displacement, on: Set(\"z1\"), every: 0.01)})";

fn session() -> Session {
    let mut session = Session::new(Options { backend: BackendChoice::Cpu, threads: 1, ..Options::default() });
    let scene = SceneFile::from_text("test.ron", SCENE, Path::new(""), &[]).unwrap();
    session.command(Command::Load(Box::new(scene)));
    session
}

/// Another state at the same step: of another run, and of other material.
#[test]
fn what_is_measured_is_of_the_state_that_is_seen() {
    let (mut one, mut other) = (session(), session());
    one.command(Command::Step(40));
    other.command(Command::Input { name: "weight".into(), value: -3.0 });
    other.command(Command::Step(40));
    let (seen, wanted) = (other.state(), one.state());
    assert!(seen.step == wanted.step && seen.probes != wanted.probes && seen.energies != wanted.energies);
    let kept = one.simulation().unwrap().snapshot().unwrap();
    other.command(Command::Restore(Box::new(kept)));
    let restored = other.state();
    assert_eq!((&restored.probes, restored.energies), (&wanted.probes, wanted.energies));
    other.command(Command::Set(vec!["materials.m.neo_hookean=Young(young: 6000, poisson: 0.45)".into()]));
    let told = other.state();
    assert!(told.refusal.is_none(), "{:?}", told.refusal);
    assert_eq!(told.energies, other.simulation().unwrap().energies().unwrap());
}
