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
mod tests {
    use super::*;
    use glam::{DQuat, DVec3};

    #[test]
    fn what_is_sent_comes_out_at_the_other_end_to_the_last_bit() {
        let (mut device, mut engine) = open();
        assert_eq!((engine.pose(), device.touch()), (None, Touch::default()));
        let pose = DevicePose {
            time: 0.1,
            place: DVec3::new(1.0, -2.5e-300, f64::MAX),
            orientation: DQuat::from_scaled_axis(DVec3::new(0.3, 0.2, -0.7)),
            velocity: DVec3::new(0.1, 0.2, 0.3),
            spin: DVec3::new(4.0, 5.0, 6.0),
            buttons: 0xf00f,
            sequence: 99,
        };
        assert_eq!((device.send(&pose), device.send(&pose)), (1, 2));
        assert_eq!((engine.pose(), engine.pose()), (Some(DevicePose { sequence: 2, ..pose }), None));
        let touch = Touch {
            time: 0.1,
            place: DVec3::X,
            orientation: pose.orientation,
            velocity: DVec3::Y,
            force: DVec3::Z,
            torque: DVec3::new(1.0, 2.0, 3.0),
            normal: -DVec3::X,
            stiffness: 120.0,
            in_contact: true,
            real_time_factor: 0.4,
            sequence: 7,
            step: 1 << 40,
            answers: 2,
        };
        engine.tell(&touch);
        assert_eq!((device.touch(), device.touch()), (touch, touch));
    }

    /// A message with its number and a checksum.
    fn message(number: u64) -> [u64; 26] {
        let mut words = std::array::from_fn(|place| number.wrapping_mul(place as u64 + 1));
        words[25] = words[..25].iter().fold(number, |sum, word| sum.rotate_left(7) ^ word);
        words
    }

    /// Two threads as fast as they can: nothing is torn, nothing comes twice or out of order, the last one is there.
    #[test]
    fn messages_between_threads_are_whole_and_in_order() {
        const LAST: u64 = 300_000;
        let (mut writer, mut reader) = triple_buffer();
        let thread = std::thread::spawn(move || (1..=LAST).for_each(|number| writer.write(&message(number))));
        let (mut last, mut taken) = (0, 0_u64);
        while last < LAST {
            let Some(words) = reader.read() else { continue };
            assert_eq!(words, message(words[0]), "torn");
            assert!(words[0] > last, "{} after {last}", words[0]);
            (last, taken) = (words[0], taken + 1);
        }
        assert!(thread.join().is_ok() && reader.read().is_none());
        println!("{taken} of {LAST} were read");
    }
}
