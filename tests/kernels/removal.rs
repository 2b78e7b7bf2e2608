//! `element_removal`.

use super::kernel_worlds::{ALONG, AROUND, Effects, GROWING, LAWS, small_strains};
use super::magnitude::{ROUNDINGS, magnitude};
use super::pair::{Pair, UNIT, entities, run};
use bevy_ecs::prelude::World;
use sinew::components::*;

#[test]
fn the_same_elements_are_removed() {
    for effects in [
        Effects { removal: true, damping: true, fibres: Some(AROUND), ..Effects::default() },
        Effects::all(),
        Effects { cells: true, ..Effects::all() },
        Effects { averaged: true, ..Effects::all() },
    ] {
        for step in [0, 9] {
            let Some(mut pair) = run("element_removal", &effects, step, |_| {}) else { return };
            pair.identical::<Alive>();
            pair.identical::<RestShape>();
            // some by time; of the criteria of every tenth step far more
            let removed = pair.changed::<Alive>();
            assert!((if step == 9 { 100 } else { 10 }..1500).contains(&removed), "{removed} removed in step {step}");
            energies_agree(&mut pair);
            // 300 kg/m³ under 10 cm³ at 1 m/s
            pair.agree::<RemovedMomentum>(|_, _, _| ROUNDINGS * UNIT * 3e-3);
            assert!(pair.changed::<RemovedMomentum>() > 10);
            // sums of up to 24 shares
            pair.agree::<Mass>(|pair, body, i| 24.0 * UNIT * pair.host().get::<Mass>(body).unwrap().get(i));
            pair.agree::<DampingCoefficient>(|pair, body, i| {
                26.0 * UNIT * pair.host().get::<DampingCoefficient>(body).unwrap().get(i)
            });
        }
    }
}

fn energies_agree(pair: &mut Pair) {
    pair.agree::<RemovedEnergy>(|pair, block, i| {
        let data = pair.before().get::<Block>(block).unwrap();
        if i >= data.count {
            return 0.0;
        }
        let magnitude = magnitude(pair.before(), block, i);
        // a stress along a strain, plus forces along displacements, plus 300 kg/m³ under 10 cm³ at 1 m/s
        ROUNDINGS * UNIT * (magnitude.force * 0.01 + 1e-5)
    });
    // its part along constrained axes: 300 kg/m³ under 10 cm³ at 1 m/s
    pair.agree::<RemovedWork>(|_, _, _| ROUNDINGS * UNIT * 1e-5);
}

/// Where mass is scaled, what was added to elements goes with them, in the same step, and its kinetic energy.
#[test]
fn added_mass_goes_with_the_same_elements() {
    let scale = |world: &mut World| {
        for block in entities::<Block>(world) {
            let count = world.get::<Block>(block).unwrap().count;
            let added = (0..count).map(|row| 1e-4 * ((row % 7) as f64 + 1.0 / 3.0)).collect();
            world.entity_mut(block).insert(AddedMass(added));
        }
        for body in entities::<Mass>(world) {
            let mass = world.get::<Mass>(body).unwrap().0.clone();
            world.entity_mut(body).insert(InertialMass(mass));
        }
    };
    for damping in [false, true] {
        let effects = Effects { removal: true, damping, moved: true, ..Effects::default() };
        let Some(mut pair) = run("element_removal", &effects, 9, scale) else { return };
        assert!(pair.changed::<Alive>() > 100);
        energies_agree(&mut pair);
        assert!(pair.changed::<RemovedWork>() > 10);
        // sums of up to 48 numbers
        pair.agree::<InertialMass>(|pair, body, i| 50.0 * UNIT * pair.host().get::<InertialMass>(body).unwrap().get(i));
        assert!(pair.changed::<InertialMass>() > 100);
    }
}

#[test]
fn each_criterion_alone_finds_the_same_elements() {
    for criterion in
        ["StretchAbove(1.07)", "VolumeRatioAbove(1.02)", "VolumeRatioBelow(0.98)", "EnergyDensityAbove(120)"]
    {
        let effects = Effects { criterion: Some(criterion), fibres: Some(ALONG), ..Effects::default() };
        let Some(mut pair) = run("element_removal", &effects, 9, |_| {}) else { return };
        pair.identical::<Alive>();
        let removed = pair.changed::<Alive>();
        assert!((200..1300).contains(&removed), "{removed} by {criterion}");
    }
}

/// Energies of 1e-8 of the moduli, from formulas in which all but that cancels.
#[test]
fn energies_of_small_strains_find_the_same_elements() {
    for (law, averaged) in [(GROWING, false), (GROWING, true), (LAWS[7], false)] {
        let criterion = Some("EnergyDensityAbove(1.2e-4)");
        let effects = Effects { criterion, law: Some(law), averaged, ..Effects::default() };
        let Some(mut pair) = run("element_removal", &effects, 9, small_strains) else { return };
        pair.identical::<Alive>();
        let removed = pair.changed::<Alive>();
        assert!((200..1300).contains(&removed), "{removed} of {law}");
    }
}
