//! What node systems have of bodies for themselves: nodes that they choose, and numbers that they keep. Both are
//! columns of the body, which all systems share, so that steps, snapshots and devices know of two columns and not of
//! users.

use super::node_system::{NodeRows, NodeSystem};
use super::node_views::NodesAtRest;
use super::rows::Rows;
use crate::backend::cpu::NodeShare;
use crate::components::*;
use crate::error::Error;
use bevy_ecs::prelude::*;
use std::collections::BTreeMap;
use std::marker::PhantomData;

/// What a system has of a body, beside the component that calls for it.
#[derive(Component)]
pub(super) struct ShareOf<S: Send + Sync + 'static> {
    pub share: NodeShare,
    of: PhantomData<fn() -> S>,
}

impl<S: Send + Sync + 'static> ShareOf<S> {
    pub fn new(share: NodeShare) -> Self {
        Self { share, of: PhantomData }
    }
}

/// What a system would have of a body.
pub(super) struct WantedShare {
    caller: Entity,
    body: Entity,
    numbers: usize,
    /// Rows that it is for, where it is not for all.
    rows: Option<Vec<u32>>,
}

/// What calls for a system wants of its body; a row of a [list](Rows::List) that the body does not have, and how many
/// rows it has.
pub(super) fn wanted_shares<S: NodeSystem>(
    of_system: Option<OfSystem>,
    duration: f64,
    world: &mut World,
) -> Result<Vec<WantedShare>, [usize; 2]> {
    let mut callers = world.query::<(Entity, &S, Option<&OfBody>, Option<&OfSystem>)>();
    let mut wanted = Vec::new();
    for (caller, system, of, _) in callers.iter(world).filter(|caller| caller.3.copied() == of_system) {
        let body = of.map_or(caller, |of| of.0);
        let Some(nodes) = NodesAtRest::of(world, body, duration) else { continue };
        let all = nodes.mass.len();
        if let Rows::List(rows) = system.rows()
            && let Some(&row) = rows.iter().find(|&&row| row as usize >= all)
        {
            return Err([row as usize, all]);
        }
        let rows = system.choose(&nodes);
        if S::OWN_NUMBERS > 0 || rows.is_some() {
            wanted.push(WantedShare { caller, body, numbers: S::OWN_NUMBERS, rows });
        }
    }
    Ok(wanted)
}

/// What a system has of a body.
pub(super) fn share_of<S: NodeSystem>(world: &mut World, body: Entity) -> Option<NodeShare> {
    let mut callers = world.query::<(Entity, &ShareOf<S>, Option<&OfBody>)>();
    let found = callers.iter(world).find(|(caller, _, of)| of.map_or(*caller, |of| of.0) == body);
    found.map(|(_, of, _)| of.share)
}

/// Bits of a node.
const MOST_CHOOSING: u32 = u32::BITS;

/// Gives systems, by their names and in the order of a step, what they have of bodies for themselves.
///
/// # Errors
/// More than 32 systems of a body that choose their nodes; a row that is none.
pub(crate) fn give_shares<'a>(
    systems: impl Iterator<Item = (&'a str, NodeRows)>,
    duration: f64,
    precision: Precision,
    world: &mut World,
) -> Result<(), Error> {
    let mut of_bodies: BTreeMap<Entity, (usize, u32)> = BTreeMap::new();
    for (name, system) in systems {
        let wanted =
            system.wanted_shares(duration, world).map_err(|[row, nodes]| no_row(name, "is for", row, nodes))?;
        for WantedShare { caller, body, numbers, rows } in wanted {
            let (first, choosing) = of_bodies.entry(body).or_default();
            let mut share = NodeShare { first: *first, numbers, bit: 0 };
            *first += numbers;
            if let Some(rows) = rows {
                if *choosing == MOST_CHOOSING {
                    let message = format!("`{name}`: at most {MOST_CHOOSING} systems of a body can choose their nodes");
                    return Err(Error::Options(message));
                }
                share.bit = 1 << *choosing;
                *choosing += 1;
                mark(name, share.bit, rows.iter().map(|&row| row as usize), body, world)?;
            }
            system.give_share(world, caller, share);
        }
    }
    for (body, (numbers, _)) in of_bodies.into_iter().filter(|(_, (numbers, _))| *numbers > 0) {
        let nodes = world.get::<Mass>(body).map_or(0, |mass| mass.len());
        world.entity_mut(body).insert(OwnNumbers(Reals::zeros(precision, numbers * nodes)));
    }
    Ok(())
}

/// What a system does with a row that is none of the body's.
fn no_row(name: &str, does: &str, row: usize, nodes: usize) -> Error {
    Error::Options(format!("`{name}` {does} the node of row {row}, and the body has {nodes} rows, from 0"))
}

/// Has the nodes of these rows chosen by the system of a bit, and no others of the body.
///
/// # Errors
/// A row that is none.
pub(crate) fn mark(
    name: &str,
    bit: u32,
    rows: impl Iterator<Item = usize> + Clone,
    body: Entity,
    world: &mut World,
) -> Result<(), Error> {
    let nodes = world.get::<Mass>(body).map_or(0, |mass| mass.len());
    if let Some(row) = rows.clone().find(|&row| row >= nodes) {
        return Err(no_row(name, "chooses", row, nodes));
    }
    if world.get::<ChosenBy>(body).is_none() {
        world.entity_mut(body).insert(ChosenBy(vec![0; nodes]));
    }
    if let Some(mut chosen) = world.get_mut::<ChosenBy>(body) {
        chosen.iter_mut().for_each(|bits| *bits &= !bit);
        rows.for_each(|row| chosen[row] |= bit);
    }
    Ok(())
}
