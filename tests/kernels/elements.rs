//! `element_forces`.

use super::kernel_worlds::{ALONG, AROUND, Effects, FAMILIES, LAWS};
use super::magnitude::{OGDEN_ROUNDINGS, ROUNDINGS, magnitude};
use super::pair::{UNIT, entities, run};
use bevy_ecs::prelude::*;
use sinew::components::*;
use sinew::evaluation::{lane_place, node_count, point_count};

fn compare_element_forces(effects: &Effects, change: impl Fn(&mut World)) {
    let Some(mut pair) = run("element_forces", effects, 3, change) else { return };
    let ogden = effects.law.is_some_and(|law| law.starts_with("ogden"));
    let roundings = if ogden { ROUNDINGS + OGDEN_ROUNDINGS } else { ROUNDINGS };
    // for every place of the body's column the bound of its element
    let mut bounds = std::collections::BTreeMap::new();
    let blocks = entities::<Block>(pair.host.world_mut());
    for block in blocks {
        let data = pair.before().get::<Block>(block).unwrap();
        let numbers = 3 * node_count(data.kind);
        for row in 0..data.count {
            let force = roundings * UNIT * magnitude(pair.before(), block, row).force;
            (0..numbers).for_each(|k| {
                bounds.insert((data.body, data.force_offset + lane_place(row, numbers, k)), force);
            });
        }
    }
    // fill-up lanes: both leave or make them zero, so clear them here
    for body in entities::<ElementForce>(pair.host.world_mut()) {
        for simulation in [&mut pair.host, &mut pair.device] {
            let mut column = simulation.world_mut().get_mut::<ElementForce>(body).unwrap();
            (0..column.len()).filter(|i| !bounds.contains_key(&(body, *i))).for_each(|i| column.set(i, 0.0));
        }
    }
    pair.agree::<ElementForce>(|_, body, i| bounds.get(&(body, i)).copied().unwrap_or(0.0));
    if effects.prony > 0 || effects.volumetric {
        pair.agree::<ViscousMemory>(|pair, block, i| {
            let data = pair.before().get::<Block>(block).unwrap();
            let law = pair.before().get::<sinew::backend::cpu::BlockLaw<f64>>(block).unwrap();
            let row = i / (16 * law.memory_numbers(point_count(data.kind))) * 16 + i % 16;
            if row >= data.count {
                return f64::INFINITY;
            }
            // q + rate (aim S − q): four roundings of the history, and those of the stress in proportion
            let terms = law.prony.iter().chain(&law.volumetric);
            let part = terms.map(|term| (term.rate * term.aim).abs()).fold(0.0, f64::max);
            UNIT * (4.0 * 200.0 + roundings * part * magnitude(pair.before(), block, row).stress)
        });
    }
    pair.identical::<FirstInverted>();
}

#[test]
fn elements_exert_the_same_forces() {
    for fibres in [None, Some(ALONG), Some(AROUND)] {
        for (prony, tension_only, backward_euler) in
            [(0, false, false), (0, true, false), (1, false, true), (2, true, false)]
        {
            for averaged in [false, true] {
                let effects = Effects { fibres, prony, tension_only, backward_euler, averaged, ..Effects::default() };
                compare_element_forces(&effects, |_| {});
            }
        }
    }
}

#[test]
fn laws_of_the_ladder_exert_the_same_forces() {
    for law in LAWS {
        for averaged in [false, true] {
            compare_element_forces(&Effects { law: Some(law), averaged, ..Effects::default() }, |_| {});
            let families = (!law.starts_with("linear")).then_some(FAMILIES);
            let viscous =
                Effects { law: Some(law), averaged, families, prony: 1, reproject: true, ..Effects::default() };
            compare_element_forces(&viscous, |_| {});
        }
    }
}

#[test]
fn pressures_relax_alike() {
    for averaged in [false, true] {
        for prony in [0, 2] {
            let effects = Effects { volumetric: true, averaged, prony, fibres: Some(AROUND), ..Effects::default() };
            compare_element_forces(&effects, |_| {});
            compare_element_forces(&Effects { families: Some(FAMILIES), ..effects }, |_| {});
        }
    }
}

/// Turns some displacements up until elements are squeezed to nothing and inside out.
fn crush(world: &mut World) {
    for body in entities::<Displacement>(world) {
        let mut u = world.get_mut::<Displacement>(body).unwrap();
        for i in 60..120 {
            let value = u.get(i);
            u.set(i, 12.0 * value);
        }
    }
}

#[test]
fn inverted_elements_are_found_and_make_no_nan() {
    let effects = Effects { fibres: Some(ALONG), ..Effects::default() };
    let Some(mut pair) = run("element_forces", &effects, 3, crush) else { return };
    pair.identical::<FirstInverted>();
    assert!(pair.changed::<FirstInverted>() >= 2);
    for body in entities::<ElementForce>(pair.device.world_mut()) {
        let force = pair.device.world().get::<ElementForce>(body).unwrap();
        assert!((0..force.len()).all(|i| force.get(i).is_finite()));
    }
}

/// Elements that are to be removed when inverted get their step and exert nothing, the same ones both ways.
#[test]
fn inverted_elements_are_removed_alike() {
    for averaged in [false, true] {
        let effects = Effects { inversion: Some("Remove"), averaged, ..Effects::default() };
        let Some(mut pair) = run("element_forces", &effects, 3, crush) else { return };
        pair.identical::<RemovalStep>();
        let mut gone = 0;
        for block in entities::<RemovalStep>(pair.host.world_mut()) {
            let data = pair.before().get::<Block>(block).unwrap().clone();
            let numbers = 3 * node_count(data.kind);
            for simulation in [&pair.host, &pair.device] {
                let world = simulation.world();
                let force = world.get::<ElementForce>(data.body).unwrap();
                let steps = world.get::<RemovalStep>(block).unwrap();
                for row in (0..data.count).filter(|&row| steps[row] != u32::MAX) {
                    assert_eq!(steps[row], 4, "the step after the third");
                    gone += 1;
                    let at = |k| data.force_offset + lane_place(row, numbers, k);
                    assert!((0..numbers).all(|k| force.get(at(k)) == 0.0), "element {row} still pushes");
                }
            }
        }
        assert!(gone >= 4, "{gone}");
    }
}

/// A node's θ is a mean of up to 24 products, each of θ (|∇u| ≤ h to 16 roundings) and a volume; the sums err by 24 more.
#[test]
fn volumes_around_nodes_change_alike() {
    let effects = Effects { averaged: true, ..Effects::default() };
    let Some(mut pair) = run("nodal_volume", &effects, 3, |_| {}) else { return };
    let blocks = entities::<NodalVolumeChange>(pair.host.world_mut());
    let mut largest: f64 = 0.0;
    for block in blocks {
        let means = pair.host.world().get::<NodalVolumeChange>(block).unwrap();
        largest = (0..means.len()).fold(largest, |largest, i| largest.max(means.get(i).abs()));
    }
    assert!((0.01..0.5).contains(&largest), "{largest}");
    pair.agree::<NodalVolumeChange>(|_, _, _| 64.0 * UNIT * 3.0 * largest);
    pair.agree::<ElementVolume>(|pair, block, i| {
        let count = pair.before().get::<Block>(block).unwrap().count;
        if i / 32 * 16 + i % 16 >= count {
            return f64::INFINITY;
        }
        let volumes = pair.host().get::<ElementVolume>(block).unwrap();
        let products = (0..volumes.len()).filter(|i| i % 32 >= 16).map(|i| volumes.get(i).abs());
        if i % 32 < 16 { 0.0 } else { 16.0 * UNIT * 3.0 * products.fold(0.0, f64::max) }
    });
}
