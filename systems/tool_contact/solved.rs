//! Tools in implicit steps: springs, whose forces are those at the end of the step that is solved for.

use super::{ContactStep, SLIDES, STICKS, ToolInStep, along_surface};
use crate::backend::cpu::NodeColumns;
use crate::components::*;
use crate::math::SimdScalar;
use bevy_ecs::prelude::*;
use glam::{DMat3, DVec3};
use smallvec::smallvec;

/// A node where it is tried.
struct At {
    /// The place (m, from the reference), the step that led there (m), and the axes that are free (1, else 0).
    place: DVec3,
    step: DVec3,
    free: DVec3,
    mass: f64,
}

/// What a tool did to a node at the end of the last step.
struct Last {
    force: DVec3,
    state: f64,
}

/// What it does.
struct Press {
    force: DVec3,
    /// [`TouchingSpring::slopes`].
    slopes: [DMat3; 2],
    state: f64,
}

/// Finds the springs of tools at nodes where they are, in a step whose signals are there. `first_axis` is that of a
/// body.
pub(crate) fn find(world: &mut World, first_axis: impl Fn(Entity) -> Option<usize>, found: &mut Vec<TouchingSpring>) {
    type Bodies<'a> = (
        Entity,
        (&'a ToolContacts, &'a ToolTouch, &'a Mass, &'a ConstrainedAxes),
        (&'a RestPosition, &'a Displacement, &'a DisplacementIncrement),
    );
    let mut bodies = world.query::<Bodies<'_>>();
    let (clock, signals) = (world.resource::<Clock>(), world.resource::<Signals>());
    let Some(springs) = &clock.springs else { return };
    for (body, (contacts, touch, mass, axes), (rest, u, step)) in bodies.iter(world) {
        let Some(first) = first_axis(body) else { continue };
        let in_step = contacts.in_step(clock, signals);
        for (number, (&row, &mask)) in contacts.rows.iter().zip(&contacts.masks).enumerate() {
            let row = row as usize;
            let place = rest.0[row] - contacts.reference + u.vector(row);
            let near = in_step.near(mask & contacts.all(), place);
            let mass = mass.get(row);
            if near == 0 || mass <= 0.0 {
                continue;
            }
            let at = At { place, step: step.vector(row), free: free_axes(axes[row]), mass };
            for tool in (0..contacts.tools.len()).filter(|tool| near >> tool & 1 == 1) {
                let kept = contacts.numbers() * number + contacts.numbers_a_tool() * tool;
                let last = Last { force: touch.vector_at(kept), state: touch.get(kept + 3) };
                let press = contacts.press_of((&in_step, springs), tool, &at, &last);
                found.extend(press.map(|Press { force, slopes, .. }| TouchingSpring {
                    parts: smallvec![(first + 3 * row, 1.0)],
                    force,
                    slopes,
                }));
            }
        }
    }
}

/// 1 along axes that are free, else 0.
fn free_axes(constrained: u32) -> DVec3 {
    DVec3::from_array([0, 1, 2].map(|i| f64::from(1 - (constrained >> i & 1))))
}

impl ToolContacts {
    /// What tools do to one node at the end of a step. Elastic slip is in the tangential force of the last one.
    pub(super) fn press<T: SimdScalar>(
        &self,
        (step, springs): (&ContactStep, &SolvedSprings),
        (row, mask): (usize, u32),
        nodes: &mut NodeColumns<'_, T>,
        values: &mut [T],
    ) {
        let place = nodes.rest[row] - self.reference + nodes.displacement(row);
        let near = step.near(mask & self.all(), place);
        if near == 0 && !self.is_touched(values) {
            return;
        }
        let numbers = self.numbers_a_tool();
        let at = At {
            place,
            step: DVec3::from_array([0, 1, 2].map(|i| nodes.increments()[3 * row + i].to_f64())),
            free: free_axes(nodes.axes()[row]),
            // at rest another one is slow to move
            mass: nodes.mass()[row].to_f64(),
        };
        for (tool, of_tool) in values.chunks_exact_mut(numbers).enumerate() {
            let force = DVec3::from_array([0, 1, 2].map(|i| of_tool[i].to_f64()));
            let last = Last { force, state: of_tool[3].to_f64() };
            let press = match near >> tool & 1 == 1 && at.mass > 0.0 {
                true => self.press_of((step, springs), tool, &at, &last),
                false => None,
            };
            if let Some(press) = &press {
                nodes.add_load(row, press.force);
            }
            if press.is_some() || last.state != 0.0 {
                note(of_tool, press);
            }
        }
    }

    /// What a tool does to a node; `None` where it does not touch.
    fn press_of(
        &self,
        (step, springs): (&ContactStep, &SolvedSprings),
        tool: usize,
        at: &At,
        last: &Last,
    ) -> Option<Press> {
        let contact = &self.tools[tool];
        let spring = contact.spring?;
        let ToolInStep { pose, earlier, change, .. } = &step.tools[tool];
        let of_tool = pose.inverse(at.place);
        let (distance, normal) = contact.geometry.distance(of_tool);
        if distance > 0.0 {
            return None;
        }
        let normal = pose.rotation * normal;
        // held along the normal: nobody can push it there
        if normal.dot(at.free * normal) <= 1e-9 {
            return None;
        }
        // how it goes past the tool, and how it was rubbed, turn with the tool
        let turned = |vector: DVec3| pose.rotation * (earlier.rotation.transpose() * vector);
        let relative = turned(at.step - change.place(of_tool));
        let press = spring.press(springs, at.mass, distance, [normal.dot(relative), step.time]);
        let friction = contact.friction[usize::from(last.state == SLIDES)];
        let mut slip = along_surface(relative, normal);
        if friction > 0.0 && last.state != 0.0 {
            let before = contact.geometry.distance(earlier.inverse(at.place - at.step)).1;
            let rubbed = turned(along_surface(last.force, earlier.rotation * before));
            slip -= along_surface(rubbed, normal) / press.stiffness;
        }
        let rubbing = press.rub(normal, slip, friction);
        let (force, slopes) = press.with(normal, &rubbing);
        let state = if rubbing.slides { SLIDES } else { STICKS };
        Some(Press { force, slopes, state })
    }
}

/// Notes what a tool does at the end of a step.
fn note<T: SimdScalar>(of_tool: &mut [T], press: Option<Press>) {
    let (force, state) = press.map_or((DVec3::ZERO, 0.0), |press| (press.force, press.state));
    for i in 0..3 {
        of_tool[i] = T::from_f64(force[i]);
    }
    of_tool[3] = T::from_f64(state);
    for (i, felt) in of_tool[TOUCH_NUMBERS..].iter_mut().enumerate() {
        *felt += T::from_f64(force[i]);
    }
}

/// Counts what tools do in a step that is found, what they take of that, and how far nodes slide. Forces work with the
/// mean of those at both ends, as all in implicit steps: `last` is [`ToolTouch`] as it was before those at the end were
/// noted. `first_axis` is that of a body, and `moved` says how far the node goes whose first axis it is (m).
pub(crate) fn count_work(
    world: &mut World,
    last: &[(Entity, Reals)],
    first_axis: impl Fn(Entity) -> Option<usize>,
    moved: impl Fn(usize) -> DVec3,
) {
    type Bodies<'a> = (Entity, &'a ToolContacts, &'a ToolTouch, &'a RestPosition, &'a Displacement);
    let mut bodies = world.query::<Bodies<'_>>();
    let (clock, signals) = (world.resource::<Clock>(), world.resource::<Signals>());
    let mut counted = Vec::new();
    for (body, contacts, touch, rest, u) in bodies.iter(world) {
        let last = last.iter().find(|(other, _)| *other == body);
        let (Some(first), Some((_, last))) = (first_axis(body), last) else { continue };
        let in_step = contacts.in_step(clock, signals);
        for (number, &row) in contacts.rows.iter().enumerate() {
            let row = row as usize;
            for tool in 0..contacts.tools.len() {
                let at = contacts.numbers() * number + contacts.numbers_a_tool() * tool;
                let state = touch.get(at + 3);
                if state == 0.0 && last.get(at + 3) == 0.0 {
                    continue;
                }
                let ToolInStep { pose, change, .. } = &in_step.tools[tool];
                let of_tool = pose.inverse(rest.0[row] - contacts.reference + u.vector(row));
                let (tool_step, moved) = (change.place(of_tool), moved(first + 3 * row));
                let mean = 0.5 * (last.vector_at(at) + touch.vector_at(at));
                let work = mean.dot(tool_step);
                let mut slid = 0.0;
                if state == SLIDES {
                    let normal = pose.rotation * contacts.tools[tool].geometry.distance(of_tool).1;
                    slid = along_surface(moved - tool_step, normal).length();
                }
                counted.push((body, at + 4, [slid, work, work - mean.dot(moved)]));
            }
        }
    }
    for (body, at, parts) in counted {
        let Some(mut touch) = world.get_mut::<ToolTouch>(body) else { continue };
        for (number, part) in (at..).zip(parts) {
            let sum = touch.get(number) + part;
            touch.set(number, sum);
        }
    }
}
