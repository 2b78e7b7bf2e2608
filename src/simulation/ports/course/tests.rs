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
