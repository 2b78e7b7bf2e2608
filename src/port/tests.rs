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
