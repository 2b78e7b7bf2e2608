//! `element_forces`.

use super::kernel_worlds::{
    ALONG, AROUND, Effects, FAMILIES, FRAMED, GROWING, LAWS, VARIED, scale_strains, small_strains,
};
use super::magnitude::{OGDEN_ROUNDINGS, ROUNDINGS, magnitude};
use super::pair::{Pair, UNIT, entities, run};
use bevy_ecs::prelude::*;
use sinew::components::*;
use sinew::elements::{node_count, point_count};
use sinew::evaluation::{ElementState, deactivate, row_count};
use sinew::math::lane_place;
use sinew::mesh::ElementKind;
use std::collections::{BTreeMap, BTreeSet};

/// For each number of a body's element forces that a block writes the rows of the elements in it: one in the scheme of
/// two passes, in patches all that meet in a node.
fn summed(world: &World, block: Entity) -> BTreeMap<usize, Vec<usize>> {
    let (data, patches) = (world.get::<Block>(block).unwrap(), world.get::<Patches>(block));
    let nodes = node_count(data.kind);
    let mut rows: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for row in 0..data.count {
        for corner in 0..nodes {
            let (at, stride) = match patches {
                None => (lane_place(row, 3 * nodes, 3 * corner), 16),
                Some(patches) => {
                    let first = patches.starts[row / (16 * patch_groups(data.kind))] as usize;
                    (3 * (first + usize::from(patches.connectivity[lane_place(row, nodes, corner)])), 1)
                }
            };
            (0..3).for_each(|axis| rows.entry(data.force_offset + at + axis * stride).or_default().push(row));
        }
    }
    rows
}

/// Makes numbers that no element writes zero: fill-up lanes, which one backend leaves and the other makes so.
fn clear_others(pair: &mut Pair) {
    let mut written = BTreeSet::new();
    for block in entities::<Block>(pair.host.world_mut()) {
        let body = pair.before().get::<Block>(block).unwrap().body;
        written.extend(summed(pair.before(), block).into_keys().map(|at| (body, at)));
    }
    for body in entities::<ElementForce>(pair.host.world_mut()) {
        for simulation in [&mut pair.host, &mut pair.device] {
            let mut column = simulation.world_mut().get_mut::<ElementForce>(body).unwrap();
            (0..column.len()).filter(|i| !written.contains(&(body, *i))).for_each(|i| column.set(i, 0.0));
        }
    }
}

/// Compares forces in which n elements are summed: Σ of their magnitudes, each as many times as it `counts`, to the
/// roundings of each and n of the sum, whose order differs.
fn agree_in_force(pair: &mut Pair, roundings: f64, counts: impl Fn(&World, Entity, usize) -> f64) {
    clear_others(pair);
    let mut bounds = BTreeMap::new();
    for block in entities::<Block>(pair.host.world_mut()) {
        let body = pair.before().get::<Block>(block).unwrap().body;
        let force = |row: usize| magnitude(pair.before(), block, row).force;
        let forces: Vec<f64> = (0..pair.before().get::<Block>(block).unwrap().count).map(force).collect();
        for (at, rows) in summed(pair.before(), block) {
            let sum: f64 = rows.iter().map(|&row| counts(pair.host(), block, row) * forces[row]).sum();
            bounds.insert((body, at), (roundings + rows.len() as f64) * UNIT * sum);
        }
    }
    pair.agree::<ElementForce>(|_, body, i| bounds.get(&(body, i)).copied().unwrap_or(0.0));
}

fn compare_element_forces(effects: &Effects, change: impl Fn(&mut World)) {
    let Some(mut pair) = run("element_forces", effects, 3, change) else { return };
    let ogden = effects.law.is_some_and(|law| law.starts_with("ogden"));
    let roundings = if ogden { ROUNDINGS + OGDEN_ROUNDINGS } else { ROUNDINGS };
    agree_in_force(&mut pair, roundings, |_, _, _| 1.0);
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
#[ignore = "long"]
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

/// Parallelepipeds have fewer numbers, also with viscosity, in two passes, and with elements gone.
#[test]
fn parallelepipeds_exert_the_same_forces() {
    let cells = Effects { cells: true, ..Effects::default() };
    compare_element_forces(&cells, |world| {
        let mut blocks = world.query::<&Block>();
        assert!(blocks.iter(world).filter(|block| block.kind == ElementKind::Hex8).all(|block| block.simple));
    });
    compare_element_forces(
        &Effects { fibres: Some(AROUND), prony: 2, scheme: Scheme::TwoPass, ..cells.clone() },
        |_| {},
    );
    compare_element_forces(&Effects { removal: true, prony: 1, ..cells }, deactivate_some);
}

/// Wedges with every effect, in both schemes, and with elements gone.
#[test]
#[ignore = "long"]
fn wedges_exert_the_same_forces() {
    others_exert_the_same_forces("Wedge6", 1.0);
}

/// The same of curved tetrahedra of second order. Their nodes are half as far apart, and strains of second order grow
/// towards corners: the noise that other elements bear would turn points inside out.
#[test]
#[ignore = "long"]
fn ten_node_tetrahedra_exert_the_same_forces() {
    others_exert_the_same_forces("Tet10", 0.2);
}

fn others_exert_the_same_forces(kind: &'static str, of_noise: f64) {
    let others = Effects { others: Some(kind), ..Effects::default() };
    let calm = |world: &mut World| scale_strains(world, of_noise);
    for (fibres, prony) in [(None, 0), (Some(ALONG), 0), (Some(AROUND), 2)] {
        compare_element_forces(&Effects { fibres, prony, ..others.clone() }, calm);
        compare_element_forces(&Effects { fibres, prony, scheme: Scheme::TwoPass, ..others.clone() }, calm);
    }
    for law in LAWS {
        compare_element_forces(&Effects { law: Some(law), volumetric: true, prony: 1, ..others.clone() }, calm);
    }
    compare_element_forces(&Effects { removal: true, prony: 1, ..others }, |world| {
        calm(world);
        deactivate_some(world);
    });
}

/// The scheme of two passes, with a law that has all effects and with the plain one.
#[test]
fn elements_exert_the_same_forces_in_two_passes() {
    for averaged in [false, true] {
        let plain = Effects { scheme: Scheme::TwoPass, averaged, ..Effects::default() };
        compare_element_forces(&Effects { fibres: Some(AROUND), prony: 2, ..plain.clone() }, |_| {});
        compare_element_forces(&plain, |_| {});
    }
}

fn deactivate_some(world: &mut World) {
    for block in entities::<Alive>(world) {
        let data = world.get::<Block>(block).unwrap().clone();
        let mut shape = world.get_mut::<RestShape>(block).unwrap();
        (0..data.count).filter(|row| row % 7 < 3).for_each(|row| deactivate(&data, row, &mut shape));
    }
}

/// Elements that are gone have no volume; they may be any of a patch.
#[test]
fn elements_that_are_left_exert_the_same_forces() {
    for averaged in [false, true] {
        let effects = Effects { removal: true, averaged, prony: 1, ..Effects::default() };
        compare_element_forces(&effects, deactivate_some);
    }
}

/// Also where the elements that fill up a block's last group have volumes: they take no turns.
#[test]
fn patches_give_the_same_bits_from_run_to_run() {
    let give_volumes_to_fill_up_lanes = |world: &mut World| {
        let mut given = 0;
        for block in entities::<Block>(world) {
            let data = world.get::<Block>(block).unwrap().clone();
            let numbers = row_count(&data);
            let mut shape = world.get_mut::<RestShape>(block).unwrap();
            for row in data.count..shape.len() / numbers {
                for at in (0..numbers).map(|k| lane_place(row, numbers, k)) {
                    let value = shape.get(at);
                    shape.set(at, if value == 0.0 { 1e-6 } else { value });
                }
                given += 1;
            }
        }
        assert!(given > 0);
    };
    for averaged in [false, true] {
        let effects = Effects { averaged, ..Effects::default() };
        let first = run("element_forces", &effects, 3, |_| {});
        let second = run("element_forces", &effects, 3, give_volumes_to_fill_up_lanes);
        let (Some(mut first), Some(second)) = (first, second) else { return };
        assert!(first.changed::<ElementForce>() > 1000);
        first.host = second.device;
        first.identical::<ElementForce>();
    }
}

#[test]
#[ignore = "long"]
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

/// Parameters that differ from copy to copy, with every built-in law: alone, and with all that a material can have.
#[test]
#[ignore = "long"]
fn copies_of_differing_laws_exert_the_same_forces() {
    copies_exert_the_same_forces(&VARIED);
}

#[test]
fn copies_that_differ_exert_the_same_forces() {
    copies_exert_the_same_forces(&VARIED[..2]);
}

fn copies_exert_the_same_forces(laws: &[(&'static str, &'static str)]) {
    for (number, &(law, varied)) in laws.iter().enumerate() {
        let averaged = number % 2 == 1;
        let own = Effects { copies: true, law: Some(law), varied: Some(varied), averaged, ..Effects::default() };
        compare_element_forces(&own, |_| {});
        let fibrous = !law.starts_with("linear");
        let (fibres, families) = (fibrous.then_some(ALONG), fibrous.then_some(FAMILIES));
        compare_element_forces(
            &Effects { fibres, families, volumetric: true, prony: 2, averaged: false, ..own },
            |_| {},
        );
    }
}

/// A law in frames of edges, each element's own: alone, viscous, in parallelepipeds and with elements gone.
#[test]
fn laws_in_frames_of_edges_exert_the_same_forces() {
    let framed = Effects { law: Some(FRAMED), ..Effects::default() };
    compare_element_forces(&framed, |_| {});
    compare_element_forces(&Effects { volumetric: true, prony: 2, ..framed.clone() }, small_strains);
    compare_element_forces(&Effects { cells: true, scheme: Scheme::TwoPass, ..framed.clone() }, |_| {});
    compare_element_forces(&Effects { removal: true, ..framed }, deactivate_some);
}

/// Strains of 1e-4, at which an energy is 1e-8 of the numbers in its formula.
#[test]
fn laws_from_an_energy_exert_the_same_forces_at_small_strains() {
    for law in [GROWING, LAWS[7]] {
        for averaged in [false, true] {
            compare_element_forces(&Effects { law: Some(law), averaged, ..Effects::default() }, small_strains);
        }
    }
}

#[test]
#[ignore = "long"]
fn pressures_relax_alike() {
    for averaged in [false, true] {
        for prony in [0, 2] {
            let effects = Effects { volumetric: true, averaged, prony, fibres: Some(AROUND), ..Effects::default() };
            compare_element_forces(&effects, |_| {});
            compare_element_forces(&Effects { families: Some(FAMILIES), ..effects }, |_| {});
        }
    }
}

/// The smallest J of an element.
fn volume_ratio(world: &World, block: Entity, row: usize) -> f64 {
    let data = world.get::<Block>(block).unwrap();
    let (shape, u) = (world.get::<RestShape>(block).unwrap(), world.get::<Displacement>(data.body).unwrap());
    let law = world.get::<sinew::backend::cpu::BlockLaw<f64>>(block).unwrap();
    let state = ElementState::of(data, row, world.get::<Connectivity>(block).unwrap(), shape, u, law.elastic_of(row));
    state.points().iter().map(|point| point.kinematics.true_j).fold(f64::INFINITY, f64::min)
}

/// Turns some displacements up until elements are squeezed to nothing and inside out.
fn crush(world: &mut World) {
    for body in entities::<Displacement>(world) {
        let mut u = world.get_mut::<Displacement>(body).unwrap();
        for i in (0..u.len()).filter(|i| i / 3 % 8 == 0) {
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
    for (averaged, scheme) in
        [(false, Scheme::Patches), (true, Scheme::Patches), (false, Scheme::TwoPass), (true, Scheme::TwoPass)]
    {
        let effects = Effects { inversion: Some("Remove"), averaged, scheme, ..Effects::default() };
        let Some(mut pair) = run("element_forces", &effects, 3, crush) else { return };
        pair.identical::<RemovalStep>();
        let step = |world: &World, block, row: usize| world.get::<RemovalStep>(block).map_or(u32::MAX, |s| s[row]);
        let mut gone = 0;
        for block in entities::<RemovalStep>(pair.host.world_mut()) {
            let steps = pair.host().get::<RemovalStep>(block).unwrap();
            let all = steps.iter().filter(|&&step| step != u32::MAX);
            assert!(all.clone().all(|&step| step == 4), "the step after the third");
            gone += all.count();
        }
        assert!(gone >= 4, "{gone} of {effects:?}");
        // what is gone exerts nothing; of what is squeezed to nothing J has no digits in f32
        agree_in_force(&mut pair, ROUNDINGS, |world, block, row| match volume_ratio(world, block, row) {
            _ if step(world, block, row) != u32::MAX => 0.0,
            squeezed if squeezed < 0.1 => f64::INFINITY,
            _ => 1.0,
        });
    }
}

/// A node's θ is a mean of up to 24 products, each of θ (|∇u| ≤ h to 16 roundings) and a volume; the sums err by 24
/// more.
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
