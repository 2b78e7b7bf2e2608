//! Free pairs: two bodies that fly at each other, which nothing holds and no tool touches, and what they do to each
//! other and to themselves. Whatever that is, their linear momentum stays, and contact makes no energy.

use crate::dice::{Dice, number as drawn, one_of, vector};
use crate::{number, surgery, whole};
use glam::DVec3;
use sinew::components::{DisplacementIncrement, Precision};
use sinew::{BackendChoice, Options, SceneFile, Simulation};
use std::path::Path;

/// Scenes of the everyday test; `SINEW_FUZZ_SCENES` says how many instead, `SINEW_FUZZ_SEED` where to begin.
const EVERYDAY: usize = 24;

const ELEMENTS: [&str; 6] = ["Tet4", "Tet4NodalPressure", "Hex8", "Hex8MeanDilatation", "Wedge6", "Tet10"];

/// The scene of a seed.
fn scene(seed: u64) -> String {
    // mild ones alone: others break down, each in its way
    let r = &mut Dice::of(8 * seed);
    let size = 0.02;
    let mut body = |name: &str, at: DVec3, velocity: DVec3| {
        let elements = one_of(r, &ELEMENTS);
        let [x, y, z] = [0; 3].map(|_| r.u8(1..=3));
        let edge = size * drawn(r, 0.6, 1.0);
        let rotate = vector(r, 40.0);
        let spin = vector(r, 10.0);
        format!(
            "\"{name}\": (mesh: Box(size: ({edge:?}, {edge:?}, {edge:?}), cells: ({x}, {y}, {z}), elements: {elements}),
                material: \"m\", rotate: {rotate}, translate: ({:?}, {:?}, {:?}), velocity: ({:?}, {:?}, {:?}), spin: {spin})",
            at.x, at.y, at.z, velocity.x, velocity.y, velocity.z
        )
    };
    let one = body("b0", DVec3::ZERO, DVec3::new(0.05, 0.02, 0.3));
    let other = body("b1", DVec3::new(0.004, -0.003, 0.045), DVec3::new(-0.02, 0.0, -0.4));
    let mut contacts = vec![format!("Between(bodies: (\"b0\", \"b1\"){})", surgery::surfaces(false, r))];
    if r.u8(..3) == 0 {
        contacts.push(format!("Itself(body: \"b0\"{})", surgery::surfaces(false, r)));
    }
    let attachments = match r.u8(..4) {
        0 => {
            "Suture(from: (body: \"b0\", at: (0.005, 0.005, 0.005)), to: (body: \"b1\", at: (0.009, 0.002, 0.05)),
            stiffness: 5, tighten: 0.005)"
        }
        _ => "",
    };
    let (young, poisson) = (drawn(r, 1e3, 2e4), drawn(r, 0.0, 0.45));
    format!(
        "(duration: 0.12, bodies: {{{one}, {other}}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: {young:?}, poisson: {poisson:?}))}},
        contacts: [{}], attachments: [{attachments}], integration: (safety: 0.5))",
        contacts.join(", ")
    )
}

/// Momentum of both bodies (kg m/s), and the sum of its sizes at all nodes.
fn momentum(simulation: &mut Simulation) -> Result<(DVec3, f64), String> {
    let (mut sum, mut sizes, rate) = (DVec3::ZERO, 0.0, 1.0 / simulation.time_step());
    for body in ["b0", "b1"] {
        let masses = simulation.masses(body).map_err(|e| e.to_string())?;
        let view = simulation.column::<DisplacementIncrement>(body).map_err(|e| e.to_string())?;
        for (mass, &row) in masses.iter().zip(view.node_rows()) {
            let of_node = view.values().vector(row as usize) * rate * *mass;
            (sum, sizes) = (sum + of_node, sizes + of_node.length());
        }
    }
    Ok((sum, sizes))
}

/// What is wrong with the scene of a seed, if anything; whether the bodies have met, `None` where it is refused.
fn attempt(seed: u64, precision: Precision) -> Result<Option<bool>, String> {
    let text = scene(seed);
    let file = SceneFile::from_text("made", &text, Path::new("."), &[]);
    let Ok(file) = file else { return Ok(None) };
    let options = Options { backend: BackendChoice::Cpu, precision, threads: 1, ..Options::default() };
    // springs too stiff for the step
    let Ok(mut simulation) = Simulation::new(&file, &options) else { return Ok(None) };
    simulation.advance(1).map_err(|e| e.to_string())?;
    let (start, mut scale) = momentum(&mut simulation)?;
    let (bound, mut met) = (if precision == Precision::F64 { 1e-10 } else { 1e-5 }, false);
    while !simulation.is_finished() {
        let ended = simulation.advance_towards_end(20);
        if let Err(error) = ended {
            let what = error.to_string();
            // elements may be crushed; contact may not make energy
            return if what.contains(whole::CONTACT_MADE_ENERGY) { Err(what) } else { Ok(Some(met)) };
        }
        met |= simulation.contact("b1").map_err(|e| e.to_string())?.force.length() > 0.0;
        // rounding is of what nodes have, also where an element inside out throws them about until it is seen
        let (now, sizes) = momentum(&mut simulation)?;
        scale = scale.max(sizes);
        let off = (now - start).length() / scale;
        if off.is_nan() || off > bound {
            return Err(format!("momentum is {off:.2e} off after {} steps\n{text}", simulation.step_count()));
        }
    }
    Ok(Some(met))
}

#[test]
fn free_pairs_keep_their_momentum() {
    let count = number("SINEW_FUZZ_SCENES", EVERYDAY) as u64;
    let first = number("SINEW_FUZZ_SEED", 0) as u64 * 1_000_000;
    let (mut wrong, mut refused, mut met) = (Vec::new(), 0, 0);
    for seed in first..first + count {
        for precision in [Precision::F64, Precision::F32] {
            match attempt(seed, precision) {
                Ok(None) => refused += 1,
                Ok(Some(have_met)) => met += usize::from(have_met),
                Err(what) => wrong.push(format!("seed {seed}, {precision:?}: {what}")),
            }
        }
    }
    println!("{count} pairs twice: {met} met, {refused} refused, {} findings", wrong.len());
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(met as u64 > count, "{met} of twice {count} met, {refused} were refused");
}
