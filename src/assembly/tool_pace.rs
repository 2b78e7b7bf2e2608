//! Whether a tool takes what it is told to: how much it may take, and how far it goes, from one look to the next.

use super::contacts::{bounds, motion};
use super::glue::points_of;
use super::tool_looks::{FARTHEST, reach_of};
use super::tool_removal::volume;
use super::{Assembly, BodyParts};
use crate::components::*;
use crate::scene::diagnostic::Diagnostics;
use crate::scene::limits::MOST_BURST;
use crate::scene::schema::{Curve, When};
use bevy_ecs::prelude::*;
use glam::DVec3;
use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_4, PI};

/// How many times of a run it is looked at how far a tool goes from one look to the next, at most.
const MOST_LOOKS: f64 = 1e4;

/// What is in a tool's reach at this part of the way from its middle to where that ends is to be there at a look.
const WITHIN: f64 = 0.8;

/// A tool that takes elements, as the scene has it and as systems know it.
struct Taker<'a> {
    number: usize,
    tool: &'a str,
    curve: &'a Curve,
    removal: &'a ToolRemoval,
    body: &'a BodyParts,
    /// Time from one look at what is in its reach to the next (s).
    look: f64,
    /// A step (s).
    step: f64,
}

/// Warns of tools that cannot take what they are told to, and of those that leave gaps on their way.
pub(super) fn check(assembly: &Assembly<'_>, world: &World, diagnostics: &mut Diagnostics) {
    let (scene, clock) = (&assembly.scene.scene, world.resource::<Clock>());
    // what is wrong with an entry has left it out
    if clock.relaxation.is_some() || diagnostics.has_errors() {
        return;
    }
    let step = clock.time_step;
    let look = world.get_resource::<ToolLooks>().map_or(step, |looks| looks.0 as f64 * step);
    let mut of_body: BTreeMap<Entity, usize> = BTreeMap::new();
    for (number, entry) in scene.removal.iter().enumerate() {
        let (When::InTool { tool, curve, .. }, Some(body)) = (&entry.when, assembly.body(&entry.body)) else {
            continue;
        };
        let place = of_body.entry(body.entity).or_default();
        let removal = world.get::<ToolRemovals>(body.entity).and_then(|removals| removals.all.get(*place));
        *place += 1;
        let Some(removal) = removal else { continue };
        let taker = Taker { number, tool, curve, removal, body, look, step };
        taker.keeps_up(world, diagnostics);
        if let Some(tool) = scene.tools.get(tool) {
            taker.leaves_gaps(&motion(tool), scene.duration, world, diagnostics);
        }
    }
}

impl Taker<'_> {
    /// Warns of a rate of which the most elements that may go at a look are less than what is taken in until then.
    fn keeps_up(&self, world: &World, diagnostics: &mut Diagnostics) {
        let rate = self.removal.fastest;
        let is_marked = |&&(block, row): &&(u32, u32)| self.removal.numbers[block as usize][row as usize] != u32::MAX;
        let marked = self.body.element_rows.iter().filter(is_marked);
        let (sum, count) =
            marked.fold((0.0, 0.0), |(sum, count), &at| (sum + volume(self.body, at, world), count + 1.0));
        let mean: f64 = sum / count;
        let room = f64::from(self.removal.burst) * mean;
        // of more than is there at once nothing waits
        let wanted = (rate * self.look).min(most_in_reach(self.removal)).min(sum);
        // also where there is nothing to take; rounding of what just fits is none that waits
        if wanted.is_nan() || room.is_nan() || wanted <= room * (1.0 + 1e-6) {
            return;
        }
        let message = format!(
            "`{}` takes in up to {rate:.3e} m³/s, of which `burst` lets {:.3e} go: {} of {mean:.3e} m³ in the mean \
             every {:.3e} s; the rest waits",
            self.tool,
            room / self.look,
            if self.removal.burst == 1 { "one element".into() } else { format!("{} elements", self.removal.burst) },
            self.look,
        );
        let needed = (wanted / mean * (1.0 - 1e-6)).ceil();
        let burst = match needed <= f64::from(MOST_BURST) {
            true => format!("`burst: {needed}` keeps up"),
            false => format!("no `burst` keeps up, which is {MOST_BURST} at most"),
        };
        let slower = room / (self.look * self.curve.range()[1]);
        let shorter = self.step * room / (rate * self.look);
        diagnostics.warn_at(format!("removal[{}].when.rate", self.number).as_str(), message).note(format!(
            "{burst}; so does a `rate` of at most {slower:.3e} m³/s, and so do steps of at most {shorter:.3e} s"
        ));
    }

    /// Warns of a tool that passes places which are in its reach at no look.
    fn leaves_gaps(&self, motion: &ToolMotion, duration: f64, world: &World, diagnostics: &mut Diagnostics) {
        let (arm, reach) = reach_of(self.removal);
        let farthest = motion.fastest(arm) * self.look;
        if farthest <= reach || middle_of(&self.removal.mouth).is_none() {
            return;
        }
        let (way, how) = match motion.is_led() {
            true => (farthest, "may go up to"),
            false => match self.longest_gap(motion, duration, bounds(&points_of(self.body, true, world))) {
                Some(way) => (way, "goes"),
                None => return,
            },
        };
        let message = format!(
            "`{}` {how} {way:.3e} m from one look at what is in its reach to the next, in {:.3e} s, and reaches \
             {reach:.3e} m from its middle: it leaves what it passes between them",
            self.tool, self.look,
        );
        // as far as it may go where it is looked oftener by itself
        let shorter = self.step * FARTHEST * reach / way;
        diagnostics.warn_at(format!("removal[{}].when.reach", self.number).as_str(), message).note(format!(
            "steps of at most {shorter:.3e} s leave no gaps; a slower tool, or a larger `reach`, does, too"
        ));
    }

    /// The longest way (m) from one look to the next on which a tool passes a place that is in its reach at neither,
    /// between two corners of a body, as that is at the start; `None` where it passes none.
    fn longest_gap(&self, motion: &ToolMotion, duration: f64, (low, high): (DVec3, DVec3)) -> Option<f64> {
        let middle = middle_of(&self.removal.mouth)?;
        let looks = (duration / self.look).ceil();
        let stride = (looks / MOST_LOOKS).max(1.0);
        let mut longest: Option<f64> = None;
        for number in 0..(looks / stride).ceil() as u32 {
            let time = (f64::from(number) * stride).floor() * self.look;
            let [before, between, after] = [0.0, 0.5, 1.0].map(|share| motion.meant(time + share * self.look));
            let [from, through, to] = [before, between, after].map(|pose| pose.place(middle));
            let way = from.distance(through) + through.distance(to);
            let may_take = matches!(self.curve, Curve::Input { .. }) || self.curve.value(time + 0.5 * self.look) > 0.0;
            if !may_take || longest.is_some_and(|longest| way <= longest) {
                continue;
            }
            let Some(along) = (between.rotation.transpose() * (through - from)).try_normalize() else { continue };
            let (right, up) = along.any_orthonormal_pair();
            let is_left = (0..8).any(|eighth| {
                let (sin, cos) = (f64::from(eighth) * FRAC_PI_4).sin_cos();
                let across = cos * right + sin * up;
                let place = between.place(middle + WITHIN * self.end_of_reach(middle, across) * across);
                let is_there = place.cmpge(low).all() && place.cmple(high).all();
                is_there && ![before, after].iter().any(|pose| self.reaches(pose.inverse(place)))
            });
            if is_left {
                longest = Some(way);
            }
        }
        longest
    }

    /// Whether a place in the tool's frame (m) is in its reach.
    fn reaches(&self, place: DVec3) -> bool {
        self.removal.mouth.distance(place) <= self.removal.reach
    }

    /// How far from its middle a tool reaches along a direction (m), all in its frame.
    fn end_of_reach(&self, middle: DVec3, along: DVec3) -> f64 {
        let (mut inside, mut outside) = (0.0, around(&self.removal.mouth) + self.removal.reach);
        for _ in 0..20 {
            let half = 0.5 * (inside + outside);
            if self.reaches(middle + half * along) {
                inside = half;
            } else {
                outside = half;
            }
        }
        inside
    }
}

/// The middle of what takes elements, in the tool's frame (m); a plane has none.
fn middle_of(mouth: &Mouth) -> Option<DVec3> {
    match mouth {
        Mouth::Disc(_) => Some(DVec3::ZERO),
        Mouth::Tool(solid) => Some(solid.bounding_sphere()?.0),
    }
}

/// How far from its middle what takes elements ends at most (m).
fn around(mouth: &Mouth) -> f64 {
    match mouth {
        Mouth::Disc(radius) => *radius,
        Mouth::Tool(solid) => solid.bounding_sphere().map_or(f64::INFINITY, |(_, radius)| radius),
    }
}

/// The volume (m³) that is in a tool's reach, or more: of a disc by Steiner's formula, of other shapes that of a ball
/// around them.
fn most_in_reach(removal: &ToolRemoval) -> f64 {
    let (radius, reach) = (around(&removal.mouth), removal.reach);
    match removal.mouth {
        Mouth::Disc(_) => {
            PI * (2.0 * radius * radius * reach + PI * radius * reach * reach + 4.0 / 3.0 * reach.powi(3))
        }
        Mouth::Tool(_) => 4.0 / 3.0 * PI * (radius + reach).powi(3),
    }
}
