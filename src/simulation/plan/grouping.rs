//! Which neighbours of a schedule share a pass on a backend: from what systems are and what they touch.

use super::{Over, Pass};
use crate::components::{Displacement, DisplacementIncrement, Touched};
use crate::simulation::schedule::Scheduled;
use crate::systems::{OnDevice, OnHost, Phase, Repeat};
use bevy_ecs::prelude::World;
use bevy_ecs::system::SystemAccess;
use std::collections::VecDeque;

/// Groups neighbours of a schedule for a backend.
#[derive(Clone, Copy)]
pub(super) struct Grouping<'a> {
    pub schedule: &'a [Scheduled<'a>],
    pub access: &'a [SystemAccess],
    pub on_gpu: bool,
}

impl Grouping<'_> {
    /// Places in the order in which systems run, those together that share a pass.
    ///
    /// A system that says where constrained nodes go may wait until just before the nodes move, where nothing in
    /// between touches what it reads and writes: that is known of all systems, one's own too, from their queries.
    pub fn groups(&self) -> Vec<Vec<usize>> {
        let mut order: Vec<usize> = (0..self.schedule.len()).collect();
        let is_boundary = |&place: &usize| self.schedule[place].system.phase == Phase::Boundary;
        // where no system moves the nodes a solver does, which asks before all else where those go that are held
        let moves = (0..self.schedule.len()).any(|place| self.moves_nodes(&[place]));
        for place in (0..self.schedule.len()).filter(|place| moves && is_boundary(place)).rev() {
            self.put_off(place, &mut order);
        }
        let mut groups: Vec<Vec<usize>> = Vec::new();
        for place in order {
            match groups.last_mut().filter(|group| self.is_of_nodes(place) && self.is_of_nodes(group[0])) {
                Some(group) => group.push(place),
                None => groups.push(vec![place]),
            }
        }
        if self.on_gpu { groups } else { self.with_elements(groups) }
    }

    /// On the CPU the forces of elements belong to the pass that follows them, where that sums them and moves nodes:
    /// those inside a patch move with it.
    fn with_elements(&self, groups: Vec<Vec<usize>>) -> Vec<Vec<usize>> {
        let mut together: Vec<Vec<usize>> = Vec::new();
        for group in groups {
            let sums = self.schedule[group[0]].system.host.nodes().is_some_and(|first| first.sums_forces);
            match together.last_mut().filter(|before| sums && self.moves_nodes(&group) && self.is_of_elements(before)) {
                Some(before) => before.extend(group),
                None => together.push(group),
            }
        }
        together
    }

    /// On the CPU what concerns only nodes of surfaces (contact between them, glue) does not keep others from moving
    /// with their patch. Where all of that says beforehand, by where nodes are, whether it does something, and nobody
    /// in the pass moves nodes before it would, it may sleep.
    pub fn ahead(&self, passes: Vec<Pass>, world: &World) -> Vec<Pass> {
        let mut passes: VecDeque<Pass> = passes.into();
        let mut all = Vec::new();
        while let Some(mut elements) = passes.pop_front() {
            let sums =
                |pass: &Pass| self.schedule[pass.systems[0]].system.host.nodes().is_some_and(|of| of.sums_forces);
            let is_between = |pass: &Pass| {
                let of = &self.schedule[pass.systems[0]];
                pass.over == Over::Itself && of.every == 1 && of.interval.is_none() && (of.system.shared_only)(world)
            };
            let between = passes.iter().skip(1).take_while(|pass| is_between(pass)).count();
            let fits = self.is_of_elements(&elements.systems)
                && between > 0
                && sums(&passes[0])
                && passes.get(between + 1).is_some_and(|pass| self.moves_nodes(&pass.systems));
            if !fits {
                all.push(elements);
                continue;
            }
            elements.systems.extend(passes.pop_front().into_iter().flat_map(|sums| sums.systems));
            let between: Vec<Pass> = passes.drain(..between).collect();
            let may_sleep = |pass: &Pass| self.schedule[pass.systems[0]].system.may_sleep;
            let stays = |&place: &usize| !moves_nodes_by_itself(&self.access[place], world);
            if between.iter().all(may_sleep) && elements.systems.iter().all(stays) {
                elements.sleepers = between.len();
            }
            if let Some(mut moves) = passes.pop_front() {
                elements.ahead.clone_from(&moves.systems);
                (elements.over, moves.over) = (Over::Elements, Over::Shared);
                all.push(elements);
                all.extend(between);
                all.push(moves);
            }
        }
        all
    }

    /// Moves a system on to just before the first that it must not be exchanged with, if that one works node by node
    /// too.
    fn put_off(&self, place: usize, order: &mut [usize]) {
        let Some(from) = order.iter().position(|&other| other == place) else { return };
        let blocks = |&other: &usize| !may_be_exchanged(&self.access[place], &self.access[other]);
        let Some(steps) = order[from + 1..].iter().position(blocks) else { return };
        let to = from + 1 + steps;
        if self.is_of_nodes(place) && self.is_of_nodes(order[to]) {
            order[from..to].rotate_left(1);
        }
    }

    /// Whether the system of that place works node by node, in every step.
    fn is_of_nodes(&self, place: usize) -> bool {
        let Scheduled { every, interval, .. } = &self.schedule[place];
        self.goes_over_nodes(place) && *every == 1 && interval.is_none()
    }

    fn goes_over_nodes(&self, place: usize) -> bool {
        let system = self.schedule[place].system;
        match self.on_gpu {
            true => matches!(system.device, OnDevice::Stages(_)),
            false => system.host.nodes().is_some(),
        }
    }

    /// Whether these are the forces of elements alone.
    fn is_of_elements(&self, group: &[usize]) -> bool {
        matches!(group, [place] if match self.on_gpu {
            true => {
                let scheduled = &self.schedule[*place];
                scheduled.system.phase == Phase::ElementForces && scheduled.on_device
            }
            false => matches!(self.schedule[*place].system.host, OnHost::Elements(_)),
        })
    }

    fn moves_nodes(&self, group: &[usize]) -> bool {
        let of_nodes = |&place: &usize| self.schedule[place].system.host.nodes();
        group.iter().filter_map(of_nodes).any(|system| system.moves_nodes)
    }

    pub fn over(&self, group: &[usize]) -> Over {
        match self.goes_over_nodes(group[0]) {
            true => Over::Nodes,
            false if group.len() > 1 => Over::Elements,
            false => Over::Itself,
        }
    }

    /// What a step repeats of a pass: what does so shares it with nobody.
    pub fn repeat(&self, group: &[usize], world: &World) -> Option<Repeat> {
        let [place] = group else { return None };
        (self.schedule[*place].system.repeats)(world)
    }

    /// What only looks does so between steps.
    fn changes(&self, pass: &Pass) -> bool {
        !self.schedule[pass.systems[0]].system.observes
    }

    fn moves_in_a_pass(&self, pass: &Pass) -> bool {
        pass.over == Over::Nodes && pass.systems.len() > 1 && self.moves_nodes(&pass.systems)
    }

    /// See [`super::Plan::elements_then_nodes`].
    pub fn elements_then_nodes(&self, passes: &[Pass]) -> Result<[usize; 2], String> {
        let mut places = (0..passes.len()).filter(|&place| self.changes(&passes[place]));
        let of_elements = |&place: &usize| self.is_of_elements(&passes[place].systems);
        let elements = places.find(of_elements).ok_or("it has no element forces")?;
        match places.next() {
            Some(nodes) if self.moves_in_a_pass(&passes[nodes]) => Ok([elements, nodes]),
            Some(other) => Err(self.apart(&passes[other])),
            None => Err("nothing moves the nodes after element forces".into()),
        }
    }

    /// See [`super::Plan::nothing_but_elements_then_nodes`].
    pub fn nothing_but_elements_then_nodes(&self, passes: &[Pass]) -> Result<[usize; 2], String> {
        let is_other = |pass: &&Pass| !self.is_of_elements(&pass.systems) && !self.moves_in_a_pass(pass);
        match passes.iter().filter(|pass| self.changes(pass)).find(is_other) {
            Some(other) => Err(self.apart(other)),
            None => self.elements_then_nodes(passes),
        }
    }

    fn apart(&self, pass: &Pass) -> String {
        format!("`{}` does not share a pass over the nodes", self.schedule[pass.systems[0]].system.name)
    }
}

/// Whether a system that does not stand where nodes move writes where they are or how far they go.
fn moves_nodes_by_itself(access: &SystemAccess, world: &World) -> bool {
    let of_motion = [world.component_id::<Displacement>(), world.component_id::<DisplacementIncrement>()];
    of_motion.into_iter().flatten().any(|column| Touched(access).writes(column))
}

/// Whether neither writes what the other touches.
fn may_be_exchanged(one: &SystemAccess, other: &SystemAccess) -> bool {
    match (one, other) {
        (SystemAccess::None, _) | (_, SystemAccess::None) => true,
        (SystemAccess::Shared(one), SystemAccess::Shared(other)) => {
            one.combined_access().is_compatible(other.combined_access())
        }
        _ => false,
    }
}
