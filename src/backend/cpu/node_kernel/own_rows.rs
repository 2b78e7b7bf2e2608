//! What a node system has of the nodes for itself: those that it has chosen, and numbers of its own.

use super::declared::Declared;
use super::node_columns::{NodeColumns, first, first_mut};

/// What a node system has of its body's columns for itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NodeShare {
    /// The first of its numbers among those of a node.
    pub first: usize,
    /// How many it has.
    pub numbers: usize,
    /// Its bit in [`ChosenBy`](crate::components::ChosenBy); 0: it is for all nodes.
    pub bit: u32,
}

/// What all node systems have of some nodes for themselves, and whose turn it is.
#[derive(Debug, Default)]
pub struct OwnRows<'a, T> {
    numbers: &'a mut [T],
    /// Numbers a node.
    stride: usize,
    chosen: &'a [u32],
    share: NodeShare,
}

impl<'a, T> OwnRows<'a, T> {
    /// Those of so many nodes.
    pub fn of(numbers: &'a mut [T], chosen: &'a [u32], nodes: usize) -> Self {
        Self { stride: numbers.len() / nodes.max(1), numbers, chosen, share: NodeShare::default() }
    }

    /// Takes those of the first so many nodes away.
    pub(super) fn take(&mut self, rows: usize) -> Self {
        let Self { stride, share, .. } = *self;
        let numbers = first_mut(&mut self.numbers, stride * rows);
        Self { numbers, stride, chosen: first(&mut self.chosen, rows), share }
    }

    pub(super) fn again(&mut self) -> OwnRows<'_, T> {
        OwnRows { numbers: &mut *self.numbers, stride: self.stride, chosen: self.chosen, share: self.share }
    }
}

impl<'a, T> NodeColumns<'a, T> {
    /// It is the turn of a system that has such a share and has declared so much.
    #[inline(always)]
    pub(crate) fn turn_to(&mut self, share: NodeShare, declared: Declared) {
        self.own.share = share;
        self.declared = declared;
    }

    /// Those of these nodes that the system has [chosen](crate::systems::NodeSystem::choose), ascending; all where it
    /// has not.
    pub fn chosen(&self) -> impl Iterator<Item = usize> + use<'a, T> {
        let (chosen, bit) = (self.own.chosen, self.own.share.bit);
        (0..self.rows()).filter(move |&row| bit == 0 || chosen[row] & bit != 0)
    }

    /// The numbers that the system keeps of one of these nodes: as many as it
    /// [has](crate::systems::NodeSystem::OWN_NUMBERS); none where a program has put it on a body after the simulation
    /// was made.
    pub fn own(&mut self, row: usize) -> &mut [T] {
        let NodeShare { first, numbers, .. } = self.own.share;
        let from = row * self.own.stride + first;
        self.own.numbers.get_mut(from..from + numbers).unwrap_or_default()
    }
}
