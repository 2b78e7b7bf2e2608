//! How a run sums element forces: as it is told, or as its GPU can.

use crate::backend::patch_lists::pack;
use crate::components::*;
use bevy_ecs::prelude::*;
use std::collections::BTreeMap;
use std::fmt::{Display, Formatter};

/// Patches that fill a GPU. Fewer leave most of it idle while each workgroup sums round after round, and two passes,
/// whose elements and nodes are all independent, take half to three quarters of the time in spite of their traffic;
/// from about here on patches win, threefold in the end (docs/performance.md, measured on an H200 of 132
/// multiprocessors).
const FILLING: usize = 256;

/// Makes room for the element forces of all bodies, in another scheme than before.
pub(super) fn sum_forces(scheme: Scheme, world: &mut World) {
    let bodies: Vec<Entity> = world.query_filtered::<Entity, With<ElementForce>>().iter(world).collect();
    bodies.into_iter().for_each(|body| crate::assembly::insert_forces(scheme, body, world));
}

/// Bodies by name, and how the forces of their elements are summed.
#[derive(Clone, Debug, Default)]
pub(super) struct Summed(Vec<(String, Scheme)>);

/// How those of all bodies are summed, as it was decided.
pub(super) fn summed(world: &mut World) -> Summed {
    let mut bodies: BTreeMap<Entity, Scheme> = BTreeMap::new();
    for (block, patches) in world.query::<(&Block, Option<&Patches>)>().iter(world) {
        bodies.insert(block.body, if patches.is_some() { Scheme::Patches } else { Scheme::TwoPass });
    }
    let name = |body: Entity| world.get::<Label>(body).map_or_else(String::new, |label| label.0.clone());
    Summed(bodies.into_iter().map(|(body, scheme)| (name(body), scheme)).collect())
}

impl Display for Summed {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        let words =
            [(Scheme::Patches, "patch by patch"), (Scheme::TwoPass, "in two passes, at corners and then at nodes")];
        let of = |scheme: Scheme| self.0.iter().filter(move |(_, of)| *of == scheme).map(|(name, _)| name.as_str());
        let used = words.into_iter().filter(|(scheme, _)| of(*scheme).next().is_some());
        let used: Vec<String> = match used.clone().count() {
            0 | 1 => used.map(|(_, word)| word.to_owned()).collect(),
            _ => {
                used.map(|(scheme, word)| format!("{word} of {}", of(scheme).collect::<Vec<_>>().join(", "))).collect()
            }
        };
        write!(f, "forces are summed {}", used.join("; "))
    }
}

/// Sums the forces of bodies in two passes whose patches no workgroup can sum. Says of which and why.
pub(super) fn fit_workgroups(world: &mut World) -> String {
    let blocks: Vec<(Entity, String)> = world
        .query::<(&Block, &Patches)>()
        .iter(world)
        .filter_map(|(block, patches)| Some((block.body, pack(block, patches).err()?)))
        .collect();
    let mut said = String::new();
    for (body, reason) in blocks {
        let name = world.get::<Label>(body).map_or_else(String::new, |label| label.0.clone());
        if !said.contains(&format!("of `{name}`")) {
            said += &format!("; forces of `{name}` are summed in two passes: {reason}");
            crate::assembly::insert_forces(Scheme::TwoPass, body, world);
        }
    }
    said
}

/// Sums the forces of bodies in two passes that have too few patches to fill a GPU. Those of one patch stay: they take
/// many steps in a dispatch. Says of which.
pub(super) fn fill_gpu(world: &mut World) -> String {
    let mut counts: BTreeMap<Entity, usize> = BTreeMap::new();
    for (block, patches) in world.query::<(&Block, &Patches)>().iter(world) {
        *counts.entry(block.body).or_default() += patches.count();
    }
    counts.retain(|_, count| (2..FILLING).contains(count));
    let mut said = String::new();
    for (body, count) in counts {
        let name = world.get::<Label>(body).map_or_else(String::new, |label| label.0.clone());
        said += &format!("; forces of `{name}` are summed in two passes: {count} patches do not fill a GPU");
        crate::assembly::insert_forces(Scheme::TwoPass, body, world);
    }
    said
}
