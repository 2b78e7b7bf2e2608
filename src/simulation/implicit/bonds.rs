//! Which threads and ties hold: where one lets go in a step, the next begins without its force.

use super::axes::Axes;
use crate::components::*;
use bevy_ecs::prelude::*;

/// Whether each held at the beginning of the step, threads before ties.
#[derive(Default)]
pub(super) struct Bonds(Vec<bool>);

impl Bonds {
    /// Notes which hold.
    pub fn note(&mut self, world: &World) {
        self.0.clear();
        self.0.extend(each(world).map(|bond| bond.holds(world)));
    }

    /// Whether one that held has let go since.
    pub fn has_let_go(&self, world: &World) -> bool {
        self.gone(world).next().is_some()
    }

    /// Nodes that those have pulled which have let go since: their places among all, ascending.
    pub fn let_go(&self, world: &World, axes: &Axes) -> Vec<usize> {
        let first_node = |body: Entity| axes.each().find(|(other, _)| *other == body).map(|(_, range)| range.start / 3);
        let all = self.gone(world).flat_map(|bond| bond.nodes());
        let mut nodes: Vec<usize> = all.filter_map(|(body, row)| Some(first_node(body)? + row as usize)).collect();
        nodes.sort_unstable();
        nodes
    }

    fn gone<'w>(&self, world: &'w World) -> impl Iterator<Item = Bond<'w>> {
        each(world).zip(&self.0).filter(move |(bond, held)| **held && !bond.holds(world)).map(|(bond, _)| bond)
    }
}

/// Whether there is a thread or a tie that may be drawn until it lets go.
pub(super) fn may_let_go(world: &World) -> bool {
    each(world).any(|bond| match bond {
        Bond::Thread(suture) => suture.strength.is_finite(),
        Bond::Tie(_, tie) => tie.strength != Strength::Any,
    })
}

/// A thread, or a tie.
#[derive(Clone, Copy)]
enum Bond<'w> {
    Thread(&'w Suture),
    Tie(&'w Glue, &'w TiedPoint),
}

/// Each that there is.
fn each(world: &World) -> impl Iterator<Item = Bond<'_>> {
    let threads = world.get_resource::<Sutures>().into_iter().flat_map(|sutures| &sutures.all);
    let ties = world.get_resource::<Glue>().into_iter();
    let ties = ties.flat_map(|glue| glue.ties.iter().map(move |tie| Bond::Tie(glue, tie)));
    threads.map(Bond::Thread).chain(ties)
}

impl Bond<'_> {
    fn holds(self, world: &World) -> bool {
        let state = match self {
            Bond::Thread(suture) => {
                let state = world.get::<SutureState>(suture.ends[0].body);
                state.map(|state| state.get(SUTURE_NUMBERS * suture.place))
            }
            Bond::Tie(glue, tie) => {
                let state = world.get::<TieState>(glue.bodies[tie.bodies[0]]);
                state.map(|state| state.get(TIE_NUMBERS * tie.place))
            }
        };
        state == Some(0.0)
    }

    /// The nodes that it pulls: bodies, and rows there.
    fn nodes(self) -> Vec<(Entity, u32)> {
        match self {
            Bond::Thread(suture) => {
                let of_end = |end: &Anchor| {
                    let body = end.body;
                    end.nodes.iter().map(|&(row, _)| (body, row)).collect::<Vec<_>>()
                };
                suture.ends.iter().flat_map(of_end).collect()
            }
            Bond::Tie(glue, tie) => {
                let [of, onto] = tie.bodies.map(|body| glue.bodies[body]);
                let points = tie.nodes.iter().map(|&(row, _)| (of, row));
                points.chain(tie.bearers().map(|(row, _)| (onto, row))).collect()
            }
        }
    }
}
