//! What depends on time alone: courses of loads and motions, and their values in a step.

use super::input::Input;
use super::tool::{Key, Pose, ToolMotion, poses};
use crate::scene::schema::{Curve, Load};
use bevy_ecs::prelude::*;
use glam::{DMat3, DVec3};

/// Numbers that depend on time alone.
#[derive(Clone, Debug)]
pub enum Signal {
    /// A curve's mean over the window in which the load acts, times a vector: one slot.
    Load {
        /// Course in time.
        curve: Curve,
        /// What it multiplies; a scalar load uses the first component.
        amplitude: DVec3,
    },
    /// Rows of the affine motion u = A·(X − center) + b at the end of the step: three slots (A's row, b's component).
    Motion {
        /// Course in time.
        curve: Curve,
        /// Displacement of the centre (m).
        displacement: DVec3,
        /// Displacement gradient.
        gradient: DMat3,
        /// Axis times angle (rad).
        rotation: DVec3,
    },
    /// Where a tool is at the end of the step, as seen from a point, and then how it differs from where it was at its
    /// beginning: of each three slots (a row of the rotation, a component of the place).
    Pose {
        /// How it moves.
        motion: ToolMotion,
        /// The point (m).
        reference: DVec3,
    },
    /// A curve at the beginning of the step, and 1 where that is ½ or more, else 0: one slot. On the way to rest it is
    /// as at the end.
    Factor {
        /// Course in time.
        curve: Curve,
    },
}

/// What a curve is the course of.
#[derive(Clone, Copy)]
pub(super) enum Use {
    Load,
    Motion,
    /// At the beginning of the step.
    MotionBefore,
    Factor,
}

impl Signal {
    /// How many slots it fills.
    pub fn slots(&self) -> usize {
        match self {
            Signal::Load { .. } | Signal::Factor { .. } => 1,
            Signal::Motion { .. } => 3,
            Signal::Pose { .. } => 6,
        }
    }

    /// Its courses in time, as the scene has them.
    fn curves(&self) -> &[Curve] {
        match self {
            Signal::Load { curve, .. } | Signal::Motion { curve, .. } | Signal::Factor { curve } => {
                std::slice::from_ref(curve)
            }
            Signal::Pose { motion, .. } => &motion.curves,
        }
    }

    /// Whether it ever moves anything.
    fn moves(&self) -> bool {
        match self {
            Signal::Load { .. } | Signal::Factor { .. } => false,
            Signal::Motion { displacement, gradient, rotation, .. } => {
                (*displacement, *gradient, *rotation) != (DVec3::ZERO, DMat3::ZERO, DVec3::ZERO)
            }
            Signal::Pose { motion, .. } => motion.path.len() > 1 || !motion.moves.is_empty() || motion.hand.is_some(),
        }
    }

    /// Fills its slots, for a step between two times, from the factors of its curves.
    fn fill(&self, times: [f64; 2], factor: impl Fn(usize, Use) -> f64, slots: &mut [[f64; 4]]) {
        match self {
            Signal::Load { amplitude, .. } => {
                let v = *amplitude * factor(0, Use::Load);
                slots[0] = [v.x, v.y, v.z, 0.0];
            }
            Signal::Motion { displacement, gradient, rotation, .. } => {
                let factor = factor(0, Use::Motion);
                let a = *gradient * factor + rotation_less_identity(*rotation * factor);
                let b = *displacement * factor;
                for i in 0..3 {
                    let row = a.row(i);
                    slots[i] = [row.x, row.y, row.z, b[i]];
                }
            }
            Signal::Pose { motion, reference } => {
                let [end, begin] = poses(motion, times, factor);
                Pose { at: end.at - *reference, ..end }.fill(&mut slots[..3]);
                end.less(&begin).fill(&mut slots[3..6]);
            }
            Signal::Factor { .. } => {
                let now = factor(0, Use::Factor);
                slots[0] = [now, f64::from(now >= 0.5), 0.0, 0.0];
            }
        }
    }
}

/// R − I by Rodrigues' formula, exact for small angles too: sin θ K + 2 sin²(θ/2) K².
fn rotation_less_identity(rotation: DVec3) -> DMat3 {
    let angle = rotation.length();
    if angle == 0.0 {
        return DMat3::ZERO;
    }
    let k = rotation / angle;
    let cross = DMat3::from_cols(DVec3::new(0.0, k.z, -k.y), DVec3::new(-k.z, 0.0, k.x), DVec3::new(k.y, -k.x, 0.0));
    cross * angle.sin() + cross * cross * (2.0 * (0.5 * angle).sin().powi(2))
}

/// All signals of a scene and their values in the present step; loads and constraints know their slots.
#[derive(Resource, Clone, Debug, Default)]
pub struct Signals {
    /// Each with the places of the inputs that its curves are, where they are.
    sources: Vec<(Signal, Vec<Option<usize>>)>,
    values: Vec<[f64; 4]>,
    inputs: Vec<Input>,
    /// Loads of the scene: number, place among the sources, and by what their amplitude is divided.
    loads: Vec<(usize, usize, f64)>,
}

impl Signals {
    /// Adds a signal and returns its first slot.
    #[doc(hidden)]
    pub fn add(&mut self, signal: Signal) -> usize {
        let slot = self.values.len();
        self.values.resize(slot + signal.slots(), [0.0; 4]);
        let inputs = signal.curves().iter().map(|curve| self.declare(curve)).collect();
        self.sources.push((signal, inputs));
        slot
    }

    /// Adds the signal of the scene's load of a number, whose amplitude is divided by `parts`; its slot.
    #[doc(hidden)]
    pub fn add_load(&mut self, number: usize, load: &Load, parts: f64) -> usize {
        self.loads.push((number, self.sources.len(), parts));
        self.add(Signal::Load { curve: load.curve().clone(), amplitude: load.amplitude() / parts })
    }

    /// Takes the amplitudes of the scene's loads as they are now.
    #[doc(hidden)]
    pub fn renew_loads(&mut self, all: &[Load]) {
        for &(number, place, parts) in &self.loads {
            if let (Some(load), Some((Signal::Load { amplitude, .. }, _))) =
                (all.get(number), self.sources.get_mut(place))
            {
                *amplitude = load.amplitude() / parts;
            }
        }
    }

    /// Takes note of the input that a curve may be; its place.
    #[doc(hidden)]
    pub fn declare(&mut self, curve: &Curve) -> Option<usize> {
        let Curve::Input { name, initial, rate } = curve else { return None };
        let known = self.inputs.iter().position(|input| input.name == *name);
        Some(known.unwrap_or_else(|| {
            self.inputs.push(Input::new(name, *initial, *rate));
            self.inputs.len() - 1
        }))
    }

    /// What a program may set.
    #[doc(hidden)]
    pub fn inputs(&self) -> &[Input] {
        &self.inputs
    }

    /// The same, to set.
    #[doc(hidden)]
    pub fn inputs_mut(&mut self) -> &mut [Input] {
        &mut self.inputs
    }

    /// The largest size that the input of a slot has had or goes to, 1 at least; 1 where it has none.
    #[doc(hidden)]
    pub fn largest_input(&self, slot: usize) -> f64 {
        let mut first = 0;
        for (source, inputs) in &self.sources {
            if (first..first + source.slots()).contains(&slot) {
                let largest = inputs.iter().flatten().map(|&input| self.inputs[input].largest());
                return largest.fold(1.0, f64::max);
            }
            first += source.slots();
        }
        1.0
    }

    /// Evaluates all signals for a step between two times (s): of loads the mean over a window (s), see
    /// [`Clock::window_at`](super::Clock::window_at), of motions where they are at the end of the step.
    #[doc(hidden)]
    pub fn evaluate(&mut self, window: (f64, f64), times: [f64; 2]) {
        self.fill(times, |curve, of| match of {
            Use::Load => curve.mean(window),
            Use::Motion => curve.value(times[1]),
            Use::MotionBefore | Use::Factor => curve.value(times[0]),
        });
    }

    /// Takes shares, before and after a step, of what all signals are at a time (s): of a rotation, of its angle; of a
    /// path, of the time that it takes.
    #[doc(hidden)]
    pub fn approach(&mut self, time: f64, shares: [f64; 2]) {
        self.fill(shares.map(|share| share * time), |curve, of| match of {
            Use::Load | Use::Motion => shares[1] * curve.value(time),
            Use::MotionBefore => shares[0] * curve.value(time),
            Use::Factor => curve.value(time),
        });
    }

    /// The largest angle (rad) by which nodes are turned as told, of what they are at a time (s).
    #[doc(hidden)]
    pub fn largest_turn(&self, time: f64) -> f64 {
        let turn = |(source, inputs): &(Signal, Vec<Option<usize>>)| match source {
            Signal::Motion { rotation, curve, .. } => {
                let curve = inputs[0].map_or(curve, |input| self.inputs[input].course());
                rotation.length() * curve.value(time).abs()
            }
            _ => 0.0,
        };
        self.sources.iter().map(turn).fold(0.0, f64::max)
    }

    fn fill(&mut self, times: [f64; 2], factor: impl Fn(&Curve, Use) -> f64) {
        let mut slot = 0;
        for (source, inputs) in &self.sources {
            let curves = source.curves();
            let course = |number: usize| inputs[number].map_or(&curves[number], |input| self.inputs[input].course());
            source.fill(times, |number, of| factor(course(number), of), &mut self.values[slot..]);
            slot += source.slots();
        }
    }

    /// Leads the tools of a port along a path, from its first place to its last.
    #[doc(hidden)]
    pub fn lead(&mut self, port: &str, path: &[Key]) {
        for (source, _) in &mut self.sources {
            if let Signal::Pose { motion, .. } = source
                && motion.hand.as_ref().is_some_and(|hand| hand.port == port)
            {
                motion.path = path.to_vec();
            }
        }
    }

    /// Where tools are at a time (s), each with its slot and seen from the point of its signal.
    #[doc(hidden)]
    pub fn poses_at(&self, time: f64) -> Vec<(usize, Pose)> {
        self.poses(time, &|curve| curve.value(time))
    }

    /// The same on the way to where they are at a time (s), in a static analysis.
    #[doc(hidden)]
    pub fn poses_at_share(&self, time: f64, share: f64) -> Vec<(usize, Pose)> {
        self.poses(share * time, &|curve| share * curve.value(time))
    }

    fn poses(&self, time: f64, factor: &dyn Fn(&Curve) -> f64) -> Vec<(usize, Pose)> {
        let (mut slot, mut all) = (0, Vec::new());
        for (source, inputs) in &self.sources {
            if let Signal::Pose { motion, reference } = source {
                let course =
                    |number: usize| inputs[number].map_or(&motion.curves[number], |input| self.inputs[input].course());
                let pose = motion.pose(time, |number| factor(course(number)));
                all.push((slot, Pose { at: pose.at - *reference, ..pose }));
            }
            slot += source.slots();
        }
        all
    }

    /// The first time after one (s) from which on a load or a motion may be quicker than ever before.
    #[doc(hidden)]
    pub fn quickens_after(&self, time: f64) -> Option<f64> {
        let of_source = |source: &Signal| {
            let corner = match source {
                Signal::Pose { motion, .. } => motion.corner_after(time),
                _ => None,
            };
            source.curves().iter().filter_map(|curve| curve.quickens_after(time)).chain(corner).reduce(f64::min)
        };
        self.sources.iter().filter_map(|(source, _)| of_source(source)).reduce(f64::min)
    }

    /// The first time after one (s) at which two pieces of a curve or of a tool's path meet.
    #[doc(hidden)]
    pub fn corner_after(&self, time: f64) -> Option<f64> {
        let of_source = |(source, inputs): &(Signal, Vec<Option<usize>>)| {
            let corner = match source {
                Signal::Pose { motion, .. } => motion.corner_after(time),
                _ => None,
            };
            let course = |(curve, input): (&'_ Curve, &Option<usize>)| match input {
                Some(input) => self.inputs[*input].course().corner_after(time),
                None => curve.corner_after(time),
            };
            source.curves().iter().zip(inputs).filter_map(course).chain(corner).reduce(f64::min)
        };
        self.sources.iter().filter_map(of_source).reduce(f64::min)
    }

    /// Whether nodes have been moved as told by a jump until a time (s).
    #[doc(hidden)]
    pub fn have_jumped(&self, until: f64) -> bool {
        let any = |(source, inputs): &(Signal, Vec<Option<usize>>)| {
            // a tool may be anywhere at the start, nodes are at rest
            let begins_there = matches!(source, Signal::Pose { .. });
            source.curves().iter().zip(inputs).any(|(curve, input)| match (curve, input) {
                (Curve::Step { start, .. }, _) => *start <= until && !(begins_there && *start <= 0.0),
                (_, Some(input)) => self.inputs[*input].has_jumped(),
                _ => false,
            })
        };
        self.sources.iter().any(|source| source.0.moves() && any(source))
    }

    /// Values of all slots in the present step.
    pub fn values(&self) -> &[[f64; 4]] {
        &self.values
    }
}
