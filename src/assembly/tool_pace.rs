//! Whether a tool takes what it is told to: how much it may take, and how far it goes, from one look to the next.

use super::contacts::{bounds, motion, way};
use super::glue::points_of;
use super::tool_looks::{FARTHEST, quickest, reach_of};
use super::tool_removal::volume;
use super::{Assembly, BodyParts};
use crate::components::*;
use crate::scene::diagnostic::Diagnostics;
use crate::scene::limits::MOST_BURST;
use crate::scene::schema::{Curve, When};
use crate::systems::criterion_steps;
use bevy_ecs::prelude::*;
use glam::DVec3;
use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_4, PI};

/// How many times of a run it is looked at how far a tool goes from one look to the next, at most.
const MOST_LOOKS: f64 = 1e4;

/// A tool's way from one look to the next is walked in pieces of about this part of how far it reaches, as long as
/// these are not too many.
const PIECE: f64 = 0.5;

/// Pieces of a leg of a way, and legs of one from one look to the next, at most.
const MOST_PIECES: f64 = 1e3;

/// Places on its way where it is sought what comes in a tool's reach, at most.
const MOST_STOPS: usize = 300;

/// What is in a tool's reach at this part of the way from its middle to where that ends is to be there at a look.
const WITHIN: f64 = 0.8;

/// A tool that takes elements, as the scene has it and as systems know it.
struct Taker<'a> {
    number: usize,
    tool: &'a str,
    curve: &'a Curve,
    removal: &'a ToolRemoval,
    body: &'a BodyParts,
    /// How it moves, if the scene tells.
    motion: Option<&'a ToolMotion>,
    /// How long the scene goes on (s).
    duration: f64,
    /// Time from one look at what is in its reach to the next (s).
    look: f64,
    /// How many steps that is at most.
    rarest: f64,
    /// What it is at most where a mouth is quick and steps are short (s).
    quickest: f64,
}

/// Where a tool goes on without a corner.
struct Leg {
    /// When it begins (s), and how long it takes (s).
    time: (f64, f64),
    /// How far the middle of what takes elements goes (m).
    way: f64,
    /// How fast it goes at most (m/s).
    speed: f64,
}

/// Warns of tools that cannot take what they are told to, and of those that leave gaps on their way.
pub(super) fn check(assembly: &Assembly<'_>, world: &mut World, diagnostics: &mut Diagnostics) {
    let (scene, clock) = (&assembly.scene.scene, *world.resource::<Clock>());
    // what is wrong with an entry has left it out
    if clock.relaxation.is_some() || diagnostics.has_errors() {
        return;
    }
    let (step, rarest, quickest) = (clock.time_step, criterion_steps(&clock) as f64, quickest(assembly, world));
    let (world, duration) = (&*world, scene.duration);
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
        let Some(of_scene) = scene.tools.get(tool) else { continue };
        let moves = motion(of_scene);
        // where hands, programs and forces will move it nobody knows
        let motion = Some(&moves).filter(|motion| !motion.is_led() && of_scene.free.is_none());
        let taker = Taker { number, tool, curve, removal, body, motion, duration, look, rarest, quickest };
        taker.keeps_up(world, diagnostics);
        taker.leaves_gaps(&moves, world, diagnostics);
    }
}

impl Taker<'_> {
    /// Warns of a rate of which the most elements that may go at a look are less than what is taken in until then.
    fn keeps_up(&self, world: &World, diagnostics: &mut Diagnostics) {
        let rate = self.removal.fastest;
        let (sum, mean, of_way) = self.volumes(world);
        let room = f64::from(self.removal.burst) * mean;
        // of more than is there at once nothing waits
        let wanted = (rate * self.look).min(most_in_reach(self.removal)).min(sum);
        // also where there is nothing to take; rounding of what just fits is none that waits
        if wanted.is_nan() || room.is_nan() || wanted <= room * (1.0 + 1e-6) {
            return;
        }
        let message = format!(
            "`{}` takes in up to {rate:.3e} m³/s, of which `burst` lets {:.3e} go: {} of {mean:.3e} m³ in the mean \
             {}every {:.3e} s; the rest waits",
            self.tool,
            room / self.look,
            if self.removal.burst == 1 { "one element".into() } else { format!("{} elements", self.removal.burst) },
            if of_way { "on its way " } else { "" },
            self.look,
        );
        let needed = (wanted / mean * (1.0 - 1e-6)).ceil();
        let burst = match needed <= f64::from(MOST_BURST) {
            true => format!("`burst: {needed}` keeps up"),
            false => format!("no `burst` keeps up, which is {MOST_BURST} at most"),
        };
        let slower = below(room / (self.look * self.curve.largest(self.duration)));
        // shorter steps may be more from one look to the next; a quick mouth may keep that from being as long in any
        let longest = room / rate;
        let shorter = below(longest / if longest >= self.quickest { 1.0 } else { self.rarest });
        diagnostics.warn_at(format!("removal[{}].when.rate", self.number).as_str(), message).note(format!(
            "{burst}; so does a `rate` of at most {slower:.3e} m³/s, and so do steps of at most {shorter:.3e} s"
        ));
    }

    /// Warns of a tool that passes places which are in its reach at no look.
    fn leaves_gaps(&self, motion: &ToolMotion, world: &World, diagnostics: &mut Diagnostics) {
        let (arm, reach) = reach_of(self.removal);
        let fastest = motion.fastest(arm);
        let farthest = fastest * self.look;
        if farthest <= reach || middle_of(&self.removal.mouth).is_none() {
            return;
        }
        let (way, speed, how) = match motion.is_led() {
            true => (farthest, fastest, "may go up to"),
            false => match self.longest_gap(motion, reach, bounds(&points_of(self.body, true, world))) {
                Some((way, speed)) => (way, speed, "goes"),
                None => return,
            },
        };
        let message = format!(
            "`{}` {how} {way:.3e} m from one look at what is in its reach to the next, in {:.3e} s, and reaches \
             {reach:.3e} m from its middle: it leaves what it passes between them",
            self.tool, self.look,
        );
        // as far as it may go where it is looked oftener by itself
        let shorter = below(FARTHEST * reach / speed);
        diagnostics.warn_at(format!("removal[{}].when.reach", self.number).as_str(), message).note(format!(
            "steps of at most {shorter:.3e} s leave no gaps; a slower tool, or a larger `reach`, does, too"
        ));
    }

    /// The longest way (m) from one look to the next on which a tool passes a place that is in its reach at neither,
    /// between two corners of a body, as that is at the start, and how fast it goes there at most (m/s); `None` where
    /// it passes none.
    fn longest_gap(&self, motion: &ToolMotion, reach: f64, (low, high): (DVec3, DVec3)) -> Option<(f64, f64)> {
        let middle = middle_of(&self.removal.mouth)?;
        let looks = (self.duration / self.look).ceil();
        let stride = (looks / MOST_LOOKS).max(1.0);
        let (mut longest, mut fastest): (Option<f64>, f64) = (None, 0.0);
        for number in 0..(looks / stride).ceil() as u32 {
            let time = (f64::from(number) * stride).floor() * self.look;
            let legs = legs(motion, middle, (time, time + self.look));
            let way = legs.iter().map(|leg| leg.way).sum::<f64>();
            // what is within its reach along its way is so at one end of that
            if way <= reach {
                continue;
            }
            let ends = [motion.meant(time), motion.meant(time + self.look)];
            let is_known = longest.is_some_and(|longest| way <= longest);
            let mut is_left = false;
            for leg in &legs {
                // it would make neither longer nor faster what is known
                if is_known && leg.speed <= fastest {
                    continue;
                }
                for places in self.passed(motion, middle, leg, (PIECE * reach, low, high)) {
                    fastest = fastest.max(leg.speed);
                    let is_reached = |place: &DVec3| ends.iter().any(|pose| self.reaches(pose.inverse(*place)));
                    is_left |= !is_known && !is_left && !places.iter().all(is_reached);
                }
            }
            if is_left {
                longest = Some(way);
            }
        }
        longest.map(|longest| (longest, fastest))
    }

    /// Places between two corners (m) that are within its reach across its way, at the ends of pieces of a leg that are
    /// so long (m), where there are any and it takes something.
    fn passed(
        &self,
        motion: &ToolMotion,
        middle: DVec3,
        leg: &Leg,
        (piece, low, high): (f64, DVec3, DVec3),
    ) -> Vec<Vec<DVec3>> {
        // an even number of them: it is looked halfway, too
        let (begin, span) = leg.time;
        let pieces = 2.0 * (0.5 * leg.speed * span / piece).ceil().clamp(1.0, 0.5 * MOST_PIECES);
        let ball = around(&self.removal.mouth) + self.removal.reach;
        let mut before = motion.meant(begin).place(middle);
        let mut all = Vec::new();
        for number in 1..=pieces as u32 {
            let time = begin + span * (f64::from(number) / pieces);
            let pose = motion.meant(time);
            let through = pose.place(middle);
            let along = (pose.rotation.transpose() * (through - before)).try_normalize();
            before = through;
            let may_take = matches!(self.curve, Curve::Input { .. }) || self.curve.value(time) > 0.0;
            let Some(along) = along.filter(|_| may_take && through.distance(through.clamp(low, high)) <= ball) else {
                continue;
            };
            let (right, up) = along.any_orthonormal_pair();
            let place = |eighth: u32| {
                let (sin, cos) = (f64::from(eighth) * FRAC_PI_4).sin_cos();
                let across = cos * right + sin * up;
                pose.place(middle + WITHIN * self.end_of_reach(middle, across) * across)
            };
            let is_there = |place: &DVec3| place.cmpge(low).all() && place.cmple(high).all();
            let places: Vec<DVec3> = (0..8).map(place).filter(is_there).collect();
            if !places.is_empty() {
                all.push(places);
            }
        }
        all
    }

    /// The volume of all elements that may go (m³); the mean of those that come within its reach on its way, as the
    /// body is at the start, and else of all (m³); whether there are such on its way.
    fn volumes(&self, world: &World) -> (f64, f64, bool) {
        let points = points_of(self.body, true, world);
        let stops = self.stops(bounds(&points));
        let ball = around(&self.removal.mouth) + self.removal.reach;
        let (mut all, mut near) = ([0.0_f64; 2], [0.0_f64; 2]);
        for (element, &(block, row)) in self.body.element_rows.iter().enumerate() {
            if self.removal.numbers[block as usize][row as usize] == u32::MAX {
                continue;
            }
            let volume = volume(self.body, (block, row), world);
            all = [all[0] + volume, all[1] + 1.0];
            let nodes = self.body.placed.mesh.element(element);
            let centroid = nodes.iter().map(|&node| points[node as usize]).sum::<DVec3>() / nodes.len() as f64;
            let comes = |(pose, middle): &(Pose, DVec3)| {
                middle.distance_squared(centroid) <= ball * ball && self.reaches(pose.inverse(centroid))
            };
            if stops.iter().any(comes) {
                near = [near[0] + volume, near[1] + 1.0];
            }
        }
        let of_way = near[1] > 0.0;
        let [sum, count] = if of_way { near } else { all };
        (all[0], sum / count, of_way)
    }

    /// Where it is on its way while it may reach something between two corners (m), and where its middle is there (m).
    fn stops(&self, (low, high): (DVec3, DVec3)) -> Vec<(Pose, DVec3)> {
        let Some(motion) = self.motion else { return Vec::new() };
        let middle = middle_of(&self.removal.mouth).unwrap_or(DVec3::ZERO);
        let ball = around(&self.removal.mouth) + self.removal.reach;
        let meets = |(_, place): &(Pose, DVec3)| place.distance(place.clamp(low, high)) <= ball;
        let stops = way(motion, self.duration).map(|pose| (pose, pose.place(middle)));
        let mut stops: Vec<(Pose, DVec3)> = stops.filter(meets).collect();
        stops.dedup();
        let stride = stops.len().div_ceil(MOST_STOPS).max(1);
        stops.into_iter().step_by(stride).collect()
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

/// The legs of a tool's way between two times (s), as a point of it goes (m, in its frame): jumps between them are none
/// of it.
fn legs(motion: &ToolMotion, middle: DVec3, (from, to): (f64, f64)) -> Vec<Leg> {
    let corner_after = |time: f64| {
        let of_path = motion.path.get(motion.path.partition_point(|key| key.0 <= time)).map(|key| key.0);
        let of_curves = motion.curves.iter().filter_map(|curve| curve.corner_after(time));
        of_path.into_iter().chain(of_curves).reduce(f64::min).filter(|corner| *corner < to)
    };
    let corners = std::iter::successors(corner_after(from), |&corner| corner_after(corner));
    let mut begin = from;
    let leg = |end: f64| {
        let start = std::mem::replace(&mut begin, end);
        // until just before its end, where it may jump
        let span = (end - start) * (1.0 - 1e-9);
        let places: [DVec3; 9] =
            std::array::from_fn(|eighth| motion.meant(start + span * (eighth as f64 / 8.0)).place(middle));
        let ways = || places.windows(2).map(|pair| pair[0].distance(pair[1]));
        Leg { time: (start, span), way: ways().sum(), speed: 8.0 * ways().fold(0.0, f64::max) / span }
    };
    corners.take(MOST_PIECES as usize).chain([to]).map(leg).collect()
}

/// Cut to the digits that are told, so that what is at most that much is so by these, too.
fn below(value: f64) -> f64 {
    let digit = 10.0_f64.powf(value.log10().floor() - 3.0);
    // what rounding took is no digit less
    (value / digit * (1.0 + 1e-9)).floor() * digit
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
