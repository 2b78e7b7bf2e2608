//! Rigid tools: where they are, and what they touch.

use super::column::columns;
use super::signal::Use;
use super::{ContactSpring, Reals};
use crate::scene::schema::Curve;
use crate::tools::{Geometry, closest_approach};
use bevy_ecs::prelude::*;
use glam::{DMat3, DQuat, DVec3};
use std::collections::BTreeMap;

columns! {
    /// What tools do to the nodes that they may touch: for each of [`ToolContacts::rows`] and each of its tools
    /// [`TOUCH_NUMBERS`] numbers: the force on the node in the last step (N); 0 where it did not touch, 1 where it
    /// stuck to the tool, 2 where it slid; since the start the length it has slid (m), the work that the tool has done
    /// and what of that impact and friction have taken (J); how fast the tool went there in the last step in which it
    /// touched the node (m/s). Where a hand moves one of the tools, [`FELT_NUMBERS`] more: the sum of the forces since
    /// its batch of steps began (N). Exists where tools may touch the body.
    ToolTouch(Reals) = "tool_touch", State of Touch, Other;
}

/// Numbers of a node and a tool in [`ToolTouch`].
pub const TOUCH_NUMBERS: usize = 10;

/// Numbers more where a hand moves one of the body's tools.
pub const FELT_NUMBERS: usize = 3;

/// Guided tools with which nothing is done, by name: the first of six slots of [`Signals`](super::Signals). They are
/// drawn and told of where they are.
#[derive(Resource, Clone, Debug, Default)]
pub(crate) struct IdleTools(pub BTreeMap<String, usize>);

/// Where a tool is: a point y of its own is at rotation · y + at (m).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// From the tool's axes to the scene's.
    pub rotation: DMat3,
    /// Where its origin is (m).
    pub at: DVec3,
}

impl Pose {
    /// A point of the scene (m) in the tool's frame.
    pub fn inverse(&self, x: DVec3) -> DVec3 {
        self.rotation.transpose() * (x - self.at)
    }

    /// A point of the tool (m) in the scene; of a difference of poses, how far the point goes.
    pub fn place(&self, y: DVec3) -> DVec3 {
        self.rotation * y + self.at
    }

    /// What leads from another pose to this one.
    pub fn less(&self, other: &Self) -> Self {
        Self { rotation: self.rotation - other.rotation, at: self.at - other.at }
    }

    /// From three slots.
    pub fn of_slots(slots: &[[f64; 4]]) -> Self {
        let row = |i: usize| DVec3::new(slots[i][0], slots[i][1], slots[i][2]);
        let rotation = DMat3::from_cols(row(0), row(1), row(2)).transpose();
        Self { rotation, at: DVec3::new(slots[0][3], slots[1][3], slots[2][3]) }
    }

    /// As three slots: each a row of the rotation and a component of the place.
    pub(super) fn fill(&self, slots: &mut [[f64; 4]]) {
        for (i, slot) in slots.iter_mut().enumerate() {
            let row = self.rotation.row(i);
            *slot = [row.x, row.y, row.z, self.at[i]];
        }
    }
}

/// How a tool moves.
#[derive(Clone, Debug)]
pub struct ToolMotion {
    /// Places on its way: time (s), where the origin is (m), how it is turned. One at least, in the order of time;
    /// straight and evenly turned between them, at rest before the first and after the last.
    pub path: Vec<Key>,
    /// What is added to that: a displacement (m) and a rotation about the tool's origin (axis times angle, rad), each
    /// multiplied by its curve.
    pub moves: Vec<(DVec3, DVec3)>,
    /// Their curves.
    pub curves: Vec<Curve>,
    /// A point that its axis z goes through, wherever it is (m), as a shaft goes through a trocar.
    pub pivot: Option<DVec3>,
    /// The hand that moves it: then `path` is that of the present batch of steps, and at first where the tool is.
    pub hand: Option<Hand>,
}

/// How a hand may move a tool.
#[derive(Clone, Debug, PartialEq)]
pub struct Hand {
    /// The name of its port.
    pub port: String,
    /// How fast the tool goes at most (m/s).
    pub speed: f64,
    /// How fast it turns at most (rad/s).
    pub spin: f64,
}

/// A place on a tool's way: time (s), where the origin is (m), how it is turned.
pub type Key = (f64, DVec3, DQuat);

impl ToolMotion {
    /// Where it is meant to be at a time (s), by the values of its curves.
    pub fn meant(&self, time: f64) -> Pose {
        self.pose(time, |number| self.curves[number].value(time))
    }

    /// Where it is at a time (s) with such factors of its curves.
    pub fn pose(&self, time: f64, factor: impl Fn(usize) -> f64) -> Pose {
        let (mut at, mut turn) = self.on_path(time);
        for (number, (displacement, rotation)) in self.moves.iter().enumerate() {
            let factor = factor(number);
            at += *displacement * factor;
            turn = DQuat::from_scaled_axis(*rotation * factor) * turn;
        }
        if let Some(way) = self.pivot.and_then(|pivot| (pivot - at).try_normalize()) {
            turn = DQuat::from_rotation_arc((turn * DVec3::Z).normalize(), way) * turn;
        }
        Pose { rotation: DMat3::from_quat(turn), at }
    }

    /// Whether hands and programs move it: then nobody knows where it will be.
    pub fn is_led(&self) -> bool {
        self.hand.is_some() || self.curves.iter().any(|curve| matches!(curve, Curve::Input { .. }))
    }

    /// How near its origin may come to a point (m), at least, as far as the scene tells.
    fn nearest(&self, point: DVec3) -> f64 {
        let places: Vec<DVec3> = self.path.iter().map(|key| key.1).collect();
        let ranges = self.moves.iter().zip(&self.curves).map(|(part, curve)| (part.0, curve.range()));
        closest_approach(&places, &ranges.collect::<Vec<_>>(), point)
    }

    fn on_path(&self, time: f64) -> (DVec3, DQuat) {
        let after = self.path.partition_point(|key| key.0 <= time);
        match (after.checked_sub(1).map(|i| self.path[i]), self.path.get(after)) {
            (Some((t0, at, turn)), Some(&(t1, next, turned))) => {
                let share = (time - t0) / (t1 - t0);
                (at.lerp(next, share), turn.slerp(turned, share))
            }
            (Some((_, at, turn)), None) | (None, Some(&(_, at, turn))) => (at, turn),
            (None, None) => (DVec3::ZERO, DQuat::IDENTITY),
        }
    }

    /// How fast a point may go (m/s) that is so far from its origin (m), as far as the scene tells; jumps count as 0.
    pub fn fastest(&self, reach: f64) -> f64 {
        if let Some(hand) = &self.hand {
            return hand.speed + reach * hand.spin;
        }
        let leg = |pair: &[(f64, DVec3, DQuat)]| {
            let way = pair[0].1.distance(pair[1].1) + reach * pair[0].2.angle_between(pair[1].2);
            way / (pair[1].0 - pair[0].0)
        };
        let path = self.path.windows(2).map(leg).fold(0.0, f64::max);
        let moves = self.moves.iter().zip(&self.curves);
        let moves = moves.map(|((displacement, rotation), curve)| {
            (displacement.length() + reach * rotation.length()) * curve.fastest()
        });
        let fastest = path + moves.sum::<f64>();
        let Some(pivot) = self.pivot else { return fastest };
        // all of its way might go across the shaft; turned by up to 120°, it turns about itself too, up to as fast
        // again
        let speed = self.fastest_origin();
        fastest + if speed > 0.0 { 2.0 * reach * speed / self.nearest(pivot) } else { 0.0 }
    }

    /// How fast its origin may go (m/s), as far as the scene tells.
    fn fastest_origin(&self) -> f64 {
        let leg = |pair: &[Key]| pair[0].1.distance(pair[1].1) / (pair[1].0 - pair[0].0);
        let moves = self.moves.iter().zip(&self.curves).map(|(part, curve)| part.0.length() * curve.fastest());
        self.path.windows(2).map(leg).fold(0.0, f64::max) + moves.sum::<f64>()
    }

    /// The first time after one (s) at which it turns a corner of its path; where a hand will turn nobody knows.
    pub fn corner_after(&self, time: f64) -> Option<f64> {
        let known = if self.hand.is_some() { &[] } else { &self.path[..] };
        known.iter().map(|key| key.0).find(|corner| *corner > time)
    }
}

/// What a tool may do to a body.
#[derive(Clone, Debug)]
pub struct ToolContact {
    /// The tool's name.
    pub tool: String,
    /// Its shape.
    pub geometry: Geometry,
    /// The first of six slots of [`Signals`](super::Signals): see [`Signal::Pose`](super::Signal::Pose), from
    /// [`ToolContacts::reference`].
    pub signal: usize,
    /// Coefficients of friction: while it sticks, and while it slides.
    pub friction: [f64; 2],
    /// The spring that keeps nodes out, in place of the kinematic law.
    pub spring: Option<ContactSpring>,
    /// How far a node must go in a step against the tool (m) for its way to be looked at, and not only where it ends;
    /// 0: it never is, for springs push by where nodes are, and a plane has no other side.
    pub swept: f64,
}

/// What may touch a body's nodes. On the body.
#[derive(Component, Clone, Debug)]
pub struct ToolContacts {
    /// The tools.
    pub tools: Vec<ToolContact>,
    /// A point near the body (m), from which places are counted: so they keep their digits far from the scene's origin.
    pub reference: DVec3,
    /// The nodes that a tool may touch, ascending.
    pub rows: Vec<u32>,
    /// Of each of them, which tools: bit i is tool i.
    pub masks: Vec<u32>,
    /// What each [`ToolContacts::TOGETHER`] of them, one after the other, lie within at rest (m, from the reference):
    /// the least and the largest coordinates.
    pub boxes: Vec<[DVec3; 2]>,
    /// Length of an edge of the surface (m): who is farther off cannot be there within a step.
    pub edge: f64,
    /// How fast nodes that are inside a tool at the start are pushed out (m/s).
    pub settling: f64,
    /// Whether a hand moves one of the tools, which wants the mean of what it feels.
    pub felt: bool,
}

impl ToolContacts {
    /// Tools that one body may meet: bits of a mask.
    pub const MOST: usize = crate::scene::limits::TOOLS_OF_A_BODY;

    /// Nodes of which it is looked together whether tools are near.
    pub const TOGETHER: usize = 64;

    /// What nodes lie within at rest, from places of all (m): see [`ToolContacts::boxes`].
    pub fn boxes_of(rows: &[u32], rest: &[DVec3], reference: DVec3) -> Vec<[DVec3; 2]> {
        let places = |rows: &[u32]| {
            let places = || rows.iter().filter_map(|&row| rest.get(row as usize)).map(|place| *place - reference);
            [places().fold(DVec3::INFINITY, DVec3::min), places().fold(DVec3::NEG_INFINITY, DVec3::max)]
        };
        rows.chunks(Self::TOGETHER).map(places).collect()
    }

    /// Numbers a node in [`ToolTouch`].
    pub fn numbers(&self) -> usize {
        self.numbers_a_tool() * self.tools.len()
    }

    /// Numbers a node and a tool.
    pub fn numbers_a_tool(&self) -> usize {
        TOUCH_NUMBERS + if self.felt { FELT_NUMBERS } else { 0 }
    }
}

/// Where it is at the end of a step and at its beginning (s), with such factors of its curves.
pub(super) fn poses(motion: &ToolMotion, times: [f64; 2], factor: impl Fn(usize, Use) -> f64) -> [Pose; 2] {
    [(times[1], Use::Motion), (times[0], Use::MotionBefore)]
        .map(|(time, of)| motion.pose(time, |number| factor(number, of)))
}
