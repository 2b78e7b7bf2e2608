//! The port of a device that a hand holds: poses go to the engine, what the tool feels comes back, and neither side
//! waits for the other.
//!
//! The device's thread owns a [`ToolPort`] and, a thousand times a second or more, sends where the hand is, takes the
//! last [`Touch`] and makes of it the force for the hand, by a [`VirtualCoupling`]. The engine owns the other end
//! ([`Simulation::open_port`](crate::Simulation::open_port)).

mod buffer;
mod coupling;
mod messages;
mod sync;

pub use coupling::VirtualCoupling;
pub use messages::{DevicePose, Touch};

use buffer::{Reader, Writer, triple_buffer};
use messages::{POSE_WORDS, TOUCH_WORDS};

/// The device's end of a port. Wait-free: neither sending nor taking blocks, allocates or calls the system.
#[derive(Debug)]
pub struct ToolPort {
    poses: Writer<POSE_WORDS>,
    touches: Reader<TOUCH_WORDS>,
    last: Touch,
    sent: u64,
}

/// The engine's end.
#[derive(Debug)]
pub(crate) struct EngineEnd {
    poses: Reader<POSE_WORDS>,
    touches: Writer<TOUCH_WORDS>,
}

/// Both ends of a new port.
pub(crate) fn open() -> (ToolPort, EngineEnd) {
    let (poses, read) = triple_buffer();
    let (write, touches) = triple_buffer();
    (ToolPort { poses, touches, last: Touch::default(), sent: 0 }, EngineEnd { poses: read, touches: write })
}

impl ToolPort {
    /// Says where the device is, in the scene's axes; gives the pose its number, which it returns: 1, 2, 3 ... The
    /// engine takes the last one when a batch of steps begins. What has a number that is not finite, or no orientation,
    /// is ignored there and counted.
    pub fn send(&mut self, pose: &DevicePose) -> u64 {
        self.sent += 1;
        self.poses.write(&DevicePose { sequence: self.sent, ..*pose }.words());
        self.sent
    }

    /// The last touch that came; before the first one all of it is 0.
    pub fn touch(&mut self) -> Touch {
        if let Some(words) = self.touches.read() {
            self.last = Touch::of_words(&words);
        }
        self.last
    }
}

impl EngineEnd {
    /// The last pose, if it has not been taken yet.
    pub fn pose(&mut self) -> Option<DevicePose> {
        self.poses.read().map(|words| DevicePose::of_words(&words))
    }

    /// Tells the device.
    pub fn tell(&mut self, touch: &Touch) {
        self.touches.write(&touch.words());
    }
}

#[cfg(test)]
mod tests;
