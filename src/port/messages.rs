//! What goes through a port.

use glam::{DQuat, DVec3};
use serde::{Deserialize, Serialize};

/// Where a device is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DevicePose {
    /// When, by the device's own clock (s). The engine keeps it and does not use it.
    pub time: f64,
    /// Where it is, in the scene's axes (m): a program that maps the device's workspace to the scene does so before.
    pub place: DVec3,
    /// How it is turned: from the tool's axes to the scene's.
    pub orientation: DQuat,
    /// How fast it goes (m/s); kept, not used by the engine.
    pub velocity: DVec3,
    /// How fast it turns (rad/s); kept, not used by the engine.
    pub spin: DVec3,
    /// Buttons that are pressed, a bit each; kept, not used by the engine.
    pub buttons: u64,
    /// Its number, which [`ToolPort::send`](super::ToolPort::send) gives.
    pub sequence: u64,
}

/// What the tool did and felt in the last batch of steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// Simulated time at the end of the batch (s).
    pub time: f64,
    /// Where the tool is: the proxy (m).
    pub place: DVec3,
    /// How it is turned.
    pub orientation: DQuat,
    /// How fast it went during the batch (m/s).
    pub velocity: DVec3,
    /// The force on it, the mean over the batch (N); of what it sucks that of the batch's last step.
    pub force: DVec3,
    /// The moment of that force about the tool's origin (N m).
    pub torque: DVec3,
    /// The direction of the force: out of the tissue, or into it where that is sucked; 0 where the tool feels nothing.
    pub normal: DVec3,
    /// By how much the force along the normal grows for each metre that the tool goes in (N/m), from the last batches;
    /// 0 where it touches nothing or has not moved yet.
    pub stiffness: f64,
    /// Whether it touched or held anything during the batch, or sucks at something at its end.
    pub in_contact: bool,
    /// What the batch took on the clock on the wall over its simulated time: above 1 life goes slower than the hand
    /// (in an [`Advanced`](crate::Advanced) it is the other way round).
    pub real_time_factor: f64,
    /// Its number: 1, 2, 3 ...; 0 before the first.
    pub sequence: u64,
    /// Steps taken until then.
    pub step: u64,
    /// The number of the pose that the batch went to; 0 where none had come since the port was opened and since the
    /// run last went back.
    pub answers: u64,
}

impl Default for DevicePose {
    fn default() -> Self {
        let zero = DVec3::ZERO;
        Self {
            time: 0.0,
            place: zero,
            orientation: DQuat::IDENTITY,
            velocity: zero,
            spin: zero,
            buttons: 0,
            sequence: 0,
        }
    }
}

impl Default for Touch {
    fn default() -> Self {
        let zero = DVec3::ZERO;
        Self {
            time: 0.0,
            place: zero,
            orientation: DQuat::IDENTITY,
            velocity: zero,
            force: zero,
            torque: zero,
            normal: zero,
            stiffness: 0.0,
            in_contact: false,
            real_time_factor: 0.0,
            sequence: 0,
            step: 0,
            answers: 0,
        }
    }
}

/// Words of a [`DevicePose`].
pub const POSE_WORDS: usize = 16;
/// Words of a [`Touch`].
pub const TOUCH_WORDS: usize = 26;

impl DevicePose {
    /// Whether a tool can be there: finite numbers, and an orientation that is one.
    pub fn is_sound(&self) -> bool {
        let [velocity, spin] = [self.velocity, self.spin].map(DVec3::is_finite);
        let length = self.orientation.length();
        let turned = length.is_finite() && length > 0.0 && self.orientation.normalize().is_finite();
        // also in f32, the columns of a GPU
        let there = self.place.to_array().iter().all(|x| (*x as f32).is_finite());
        self.time.is_finite() && there && turned && velocity && spin
    }

    pub(super) fn words(&self) -> [u64; POSE_WORDS] {
        let mut words = [0; POSE_WORDS];
        let numbers = [self.time].into_iter().chain(self.place.to_array()).chain(self.orientation.to_array());
        let numbers = numbers.chain(self.velocity.to_array()).chain(self.spin.to_array()).map(f64::to_bits);
        let all = numbers.chain([self.buttons, self.sequence]);
        words.iter_mut().zip(all).for_each(|(place, word)| *place = word);
        words
    }

    pub(super) fn of_words(words: &[u64; POSE_WORDS]) -> Self {
        let number = |at: usize| f64::from_bits(words[at]);
        let vector = |at: usize| DVec3::new(number(at), number(at + 1), number(at + 2));
        Self {
            time: number(0),
            place: vector(1),
            orientation: DQuat::from_xyzw(number(4), number(5), number(6), number(7)),
            velocity: vector(8),
            spin: vector(11),
            buttons: words[14],
            sequence: words[15],
        }
    }
}

impl Touch {
    pub(super) fn words(&self) -> [u64; TOUCH_WORDS] {
        let mut words = [0; TOUCH_WORDS];
        let vectors = [self.place, self.velocity, self.force, self.torque, self.normal];
        let numbers = vectors.into_iter().flat_map(|vector| vector.to_array()).chain(self.orientation.to_array());
        let numbers = numbers.chain([self.time, self.stiffness, self.real_time_factor]).map(f64::to_bits);
        let all = numbers.chain([u64::from(self.in_contact), self.sequence, self.step, self.answers]);
        words.iter_mut().zip(all).for_each(|(place, word)| *place = word);
        words
    }

    pub(super) fn of_words(words: &[u64; TOUCH_WORDS]) -> Self {
        let number = |at: usize| f64::from_bits(words[at]);
        let vector = |at: usize| DVec3::new(number(at), number(at + 1), number(at + 2));
        Self {
            place: vector(0),
            velocity: vector(3),
            force: vector(6),
            torque: vector(9),
            normal: vector(12),
            orientation: DQuat::from_xyzw(number(15), number(16), number(17), number(18)),
            time: number(19),
            stiffness: number(20),
            real_time_factor: number(21),
            in_contact: words[22] != 0,
            sequence: words[23],
            step: words[24],
            answers: words[25],
        }
    }
}
