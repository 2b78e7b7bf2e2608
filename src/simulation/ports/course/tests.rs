use super::*;

/// Steps become shorter, or longer, within a batch: the next one begins where the tool is.
#[test]
fn no_tool_jumps_when_the_step_changes_within_a_batch() {
    let port = Port { name: "hand".into(), speed: 10.0, spin: 1e4, every: 0.01, follow: Follow::Position };
    for (step, expected) in [(0.5e-3, 0.75), (4e-3, 1.0)] {
        let mut state = PortState::at((0.0, DVec3::ZERO, DQuat::IDENTITY));
        let aim = (DVec3::X * 0.01, DQuat::from_rotation_z(0.4));
        state.target(&DevicePose { place: aim.0, orientation: aim.1, ..DevicePose::default() });
        let mut clock = Clock::with_step(1e-3);
        assert!(state.begin(&port, &clock) && state.ends == 10 && state.is_sound());
        clock.step = 5;
        clock.change_step(step);
        clock.step = state.ends;
        let (place, turn) = state.pose(clock.time());
        assert!((place.x - 0.01 * expected).abs() < 1e-15, "{step}: {place}");
        assert!((turn.angle_between(DQuat::IDENTITY) - 0.4 * expected).abs() < 1e-7, "{step}: {turn}");
        state.end(Felt::default(), clock.step);
        assert!(!state.begin(&port, &clock), "no quicker than before");
        assert_eq!((state.path[0].0, state.path[0].1), (clock.time(), place));
        assert_eq!(state.path[1].1, aim.0);
    }
}

/// Bodies that break down push with what is no number, or beyond all numbers once it is multiplied.
#[test]
fn what_breaks_down_leaves_a_state_that_can_be_taken_up() {
    let follow = Follow::Proxy { stiffness: 2.0, damping: 0.0 };
    let port = Port { name: "hand".into(), speed: 10.0, spin: 1e4, every: 0.01, follow };
    let mut state = PortState::at((0.0, DVec3::ZERO, DQuat::IDENTITY));
    state.target(&DevicePose { place: DVec3::X, ..DevicePose::default() });
    let mut clock = Clock::with_step(1e-3);
    for force in [1.0, 1e200, -1e300, f64::INFINITY, f64::NAN, 1e308, 1.0] {
        state.begin(&port, &clock);
        clock.step = state.ends;
        state.end(Felt { force: DVec3::new(force, 1.0, 0.0), in_contact: true, ..Felt::default() }, clock.step);
        assert!(state.is_sound() && state.stiffness().is_finite(), "{force}: {state:?}");
    }
}
