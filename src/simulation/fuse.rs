//! Which neighbours of a schedule share one pass: over the nodes, or on the CPU over patches of elements and then the
//! other nodes.

use super::schedule::Scheduled;
use crate::systems::{ELEMENT_FORCES, OnDevice, Phase};
use bevy_ecs::system::SystemAccess;

/// The places of the scheduled systems in the order in which they run, those together that share a pass. Without `fuse`
/// each by itself.
///
/// A system that says where constrained nodes go may wait until just before the nodes move, where nothing in between
/// touches what it reads and writes: that is known of all systems, one's own too, from their queries.
pub fn groups(schedule: &[Scheduled<'_>], access: &[SystemAccess], fuse: bool, on_gpu: bool) -> Vec<Vec<usize>> {
    let mut order: Vec<usize> = (0..schedule.len()).collect();
    if !fuse {
        return order.into_iter().map(|place| vec![place]).collect();
    }
    for place in (0..schedule.len()).filter(|&place| schedule[place].system.phase == Phase::Boundary).rev() {
        put_off(place, &mut order, schedule, access, on_gpu);
    }
    let of_nodes = |place: usize| is_of_nodes(schedule, place, on_gpu);
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for place in order {
        match groups.last_mut().filter(|group| of_nodes(place) && of_nodes(group[0])) {
            Some(group) => group.push(place),
            None => groups.push(vec![place]),
        }
    }
    if on_gpu { groups } else { with_elements(groups, schedule) }
}

/// On the CPU the forces of elements belong to the pass that follows them, where that sums them and moves nodes: those
/// inside a patch move with it.
fn with_elements(groups: Vec<Vec<usize>>, schedule: &[Scheduled<'_>]) -> Vec<Vec<usize>> {
    let mut together: Vec<Vec<usize>> = Vec::new();
    let of_elements = |group: &[usize]| match group {
        [place] => {
            let Scheduled { system, every, .. } = &schedule[*place];
            system.name == ELEMENT_FORCES && !system.custom && *every == 1
        }
        _ => false,
    };
    for group in groups {
        let of_nodes = |place: &usize| schedule[*place].system.host.nodes();
        let whole = of_nodes(&group[0]).is_some_and(|first| first.sums_forces)
            && group.iter().filter_map(of_nodes).any(|system| system.moves_nodes);
        match together.last_mut().filter(|before| whole && of_elements(before)) {
            Some(before) => before.extend(group),
            None => together.push(group),
        }
    }
    together
}

/// Whether the system of that place works node by node, in every step.
fn is_of_nodes(schedule: &[Scheduled<'_>], place: usize, on_gpu: bool) -> bool {
    let Scheduled { system, every, interval, .. } = &schedule[place];
    let of_nodes = match on_gpu {
        true => matches!(system.device, OnDevice::Stages(_)),
        false => system.host.nodes().is_some(),
    };
    of_nodes && *every == 1 && interval.is_none()
}

/// Moves a system on to just before the first that it must not be exchanged with, if that one works node by node too.
fn put_off(place: usize, order: &mut [usize], schedule: &[Scheduled<'_>], access: &[SystemAccess], on_gpu: bool) {
    let Some(from) = order.iter().position(|&other| other == place) else { return };
    let blocks = |&other: &usize| !may_be_exchanged(&access[place], &access[other]);
    let Some(steps) = order[from + 1..].iter().position(blocks) else { return };
    let to = from + 1 + steps;
    if is_of_nodes(schedule, place, on_gpu) && is_of_nodes(schedule, order[to], on_gpu) {
        order[from..to].rotate_left(1);
    }
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
