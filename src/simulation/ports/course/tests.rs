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
        state.end(&port, Felt::default(), clock.step);
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
        let felt = Felt { force: DVec3::new(force, 1.0, 0.0), in_contact: true, ..Felt::default() };
        state.end(&port, felt, clock.step);
        assert!(state.is_sound() && state.stiffness().is_finite(), "{force}: {state:?}");
    }
}

/// A mass that the tool carries, on a spring: the force of a batch is that of both. Were that not learned, the proxy
/// would be unstable from g = m/T²/(K + k) = ½ on: here g is .1 to 42.
#[test]
fn a_proxy_without_mass_holds_still_whatever_mass_it_carries() {
    let (spring, hold, every) = (100.0, 0.002, 1e-3);
    for stiffness in [20.0, 100.0, 400.0] {
        let follow = Follow::Proxy { stiffness, damping: 0.0 };
        let port = Port { name: "hand".into(), speed: 0.3, spin: 360.0, every, follow };
        for mass in [5e-5, 5e-4, 5e-3] {
            let mut state = PortState::at((0.0, DVec3::ZERO, DQuat::IDENTITY));
            let (mut clock, mut before) = (Clock::with_step(2e-4), 0.0);
            let mut last = [0.0; 2];
            for batch in 0..3000 {
                let aim = hold * (f64::from(batch) / 100.0).min(1.0);
                state.target(&DevicePose { place: DVec3::X * aim, ..DevicePose::default() });
                state.begin(&port, &clock);
                let [start, end] = state.path.map(|key| key.1.x);
                let inertia = mass * (end - start - before) / (every * every);
                let force = -DVec3::X * (spring * 0.5 * (start + end) + inertia);
                before = end - start;
                clock.step = state.ends;
                state.end(&port, Felt { force, in_contact: true, ..Felt::default() }, clock.step);
                last = [end, force.x];
            }
            // two springs in series
            let expected = hold * stiffness / (stiffness + spring);
            assert!((last[0] / expected - 1.0).abs() < 1e-3, "{stiffness} N/m, {mass} kg: {last:?}, not {expected}");
            assert!((last[1] / (-spring * expected) - 1.0).abs() < 1e-2, "{stiffness} N/m, {mass} kg: {last:?}");
        }
    }
}

/// A tool that stands still learns nothing from what rounding changes.
#[test]
fn the_stiffness_told_stays_while_nothing_moves() {
    let port = Port { name: "hand".into(), speed: 0.3, spin: 360.0, every: 1e-3, follow: Follow::Position };
    let mut state = PortState::at((0.0, DVec3::ZERO, DQuat::IDENTITY));
    let mut clock = Clock::with_step(1e-3);
    for batch in 0..5000 {
        // 2 mm in 50 ms, and then some bits to and fro
        let place = if batch < 50 { 4e-5 * f64::from(batch) } else { 2e-3 + 1e-18 * f64::from(batch % 7) };
        state.target(&DevicePose { place: DVec3::X * place, ..DevicePose::default() });
        state.begin(&port, &clock);
        let middle = 0.5 * (state.path[0].1.x + state.path[1].1.x);
        clock.step = state.ends;
        let force = -DVec3::X * (300.0 * middle + 1e-9 * f64::from(batch % 5));
        state.end(&port, Felt { force, in_contact: middle > 0.0, ..Felt::default() }, clock.step);
    }
    assert!((state.stiffness() - 300.0).abs() < 1.0, "{} N/m", state.stiffness());
}

/// What was learned of hard tissue, going far in each batch, is not told of soft tissue that is touched a second later.
#[test]
fn what_is_touched_next_may_be_other_tissue() {
    let port = Port { name: "hand".into(), speed: 0.3, spin: 360.0, every: 1e-3, follow: Follow::Position };
    let mut state = PortState::at((0.0, DVec3::ZERO, DQuat::IDENTITY));
    let (mut clock, mut depth) = (Clock::with_step(1e-3), 0.0);
    for (stiffness, way, batches) in [(1000.0, 1e-4, 50), (0.0, 0.0, 1000), (50.0, 2e-5, 11)] {
        for _ in 0..batches {
            depth = if stiffness == 0.0 { 0.0 } else { depth + way };
            state.target(&DevicePose { place: DVec3::X * depth, ..DevicePose::default() });
            state.begin(&port, &clock);
            let [start, end] = state.path.map(|key| key.1.x);
            clock.step = state.ends;
            let force = DVec3::X * (-0.5 * stiffness * (start + end));
            state.end(&port, Felt { force, in_contact: stiffness > 0.0, ..Felt::default() }, clock.step);
        }
    }
    assert!((state.stiffness() / 50.0 - 1.0).abs() < 0.01, "{} N/m", state.stiffness());
}
