use super::*;

const TICK: f64 = 1e-3;
const DAMPING: f64 = 1.0;

/// A mass with a damper under a force that is held for a tick, exactly: place and velocity after it.
fn tick(mass: f64, (x, v): (f64, f64), force: f64) -> (f64, f64) {
    let (rest, rate) = (force / DAMPING, DAMPING / mass);
    let decay = (-rate * TICK).exp();
    (x + rest * TICK + (v - rest) * (1.0 - decay) / rate, rest + (v - rest) * decay)
}

/// Whether the swings of a device, moved out of rest, are larger after some seconds.
fn grows(mass: f64, mut force: impl FnMut(f64, f64, f64) -> f64) -> bool {
    let (mut state, mut late) = ((1e-3, 0.0), 0.0_f64);
    for step in 0..16_000 {
        state = tick(mass, state, force(state.0, state.1, f64::from(step) * TICK));
        if step >= 8000 {
            late = late.max(state.0.abs());
        }
    }
    assert!(late.is_finite());
    late > 1e-3
}

#[test]
fn the_largest_stiffness_is_that_of_the_sampled_device() {
    for (mass, ticks) in [0.02, 0.1, 0.3].into_iter().flat_map(|mass| [0, 1, 2, 5].map(|ticks| (mass, ticks))) {
        let unstable = |stiffness: f64| {
            let mut past = vec![1e-3; ticks];
            grows(mass, |x, _, _| {
                past.push(x);
                (-stiffness * past.remove(0)).clamp(-1e3, 1e3)
            })
        };
        let (mut low, mut high) = (10.0, 1e4);
        assert!(!unstable(low) && unstable(high));
        while high - low > 1e-3 * low {
            let middle = 0.5 * (low + high);
            if unstable(middle) { high = middle } else { low = middle }
        }
        let share = low / VirtualCoupling::largest_stiffness(DAMPING, TICK, ticks as f64 * TICK);
        let most = if mass < 0.1 { 1.05 } else { 1.01 };
        assert!(share > 0.999 && share < most, "{mass} kg, {ticks} ticks: {low} N/m, {share} of the formula");
    }
}

/// A wall: the proxy stays. At .9 of the bound the device comes to rest at it, at 1.2 it never does.
#[test]
fn against_a_wall_the_coupling_settles_below_the_bound_and_not_above() {
    let touch = Touch { sequence: 1, in_contact: true, ..Touch::default() };
    let bound = VirtualCoupling::largest_stiffness(DAMPING, TICK, 0.0);
    for (share, expected) in [(0.9, false), (1.2, true)] {
        let mut coupling = VirtualCoupling::new(share * bound, 0.0, 100.0);
        (coupling.fastest, coupling.decay) = (1e3, f64::INFINITY);
        let swings = grows(0.1, |x, v, t| coupling.force(&touch, DVec3::X * x, DVec3::X * v, t).x);
        assert_eq!(swings, expected, "at {share} of {bound} N/m");
    }
}

/// The engine pauses: the force goes to 0, and nowhere by more than its slew.
#[test]
fn when_no_touch_comes_any_more_the_force_decays_without_a_jump() {
    let mut coupling = VirtualCoupling::new(500.0, 0.5, 2.0);
    let mut touch = Touch { place: DVec3::X * 2e-3, velocity: DVec3::X * 0.1, ..Touch::default() };
    let mut last = coupling.force(&touch, DVec3::ZERO, DVec3::ZERO, 0.0);
    assert_eq!(last, DVec3::ZERO, "before the first touch there is none");
    let mut forces = Vec::new();
    for step in 1..3000_u32 {
        // nothing from .5 to 1.5 s, and then from elsewhere
        match step {
            ..500 => touch.sequence += 1,
            1500.. => touch = Touch { sequence: touch.sequence + 1, place: DVec3::new(0.0, -0.1, 0.0), ..touch },
            _ => {}
        }
        let force = coupling.force(&touch, DVec3::ZERO, DVec3::X * 0.1, f64::from(step) * TICK);
        let slew = coupling.stiffness * coupling.fastest * TICK;
        assert!((force - last).length() <= slew * (1.0 + 1e-12), "{step}: from {last} to {force}");
        assert!(force.length() <= 2.0 * (1.0 + 1e-12), "{step}: {force}");
        last = force;
        forces.push(force);
    }
    // K x − B v
    assert!((forces[490].x - (500.0 * 2e-3 - 0.05)).abs() < 1e-12, "{}", forces[490]);
    // for 2 ms as it was (carried on by .1 mm), half of it after 27, nothing after 52
    let held = 500.0 * 2.1e-3 - 0.05;
    assert!((forces[500].x - held).abs() < 1e-12 && (forces[525].x - 0.5 * held).abs() < 1e-9, "{:?}", forces[525]);
    assert!(forces[551..1498].iter().all(|force| *force == DVec3::ZERO), "{}", forces[552]);
    assert!((forces[2900] + DVec3::Y * 2.0).length() < 3e-3, "{}", forces[2900]);
}

/// No spring, or a soft one, and what the tool feels is passed on: it comes, and goes when no touch comes any more,
/// by as much in a tick as it takes for that, wherever the hand goes meanwhile.
#[test]
fn a_force_that_is_passed_on_needs_no_spring() {
    let most = 2.0 / 0.05 * TICK;
    for stiffness in [0.0, 10.0] {
        let mut coupling = VirtualCoupling::new(stiffness, 0.0, 2.0);
        coupling.feed_forward = 1.0;
        let mut touch = Touch { force: DVec3::X * 1.9, ..Touch::default() };
        let mut last = DVec3::ZERO;
        for step in 0..600_u32 {
            touch.sequence += u64::from(step < 500);
            // from where it began to 10 cm beside it, which the spring pulls at as long as there are touches
            let place = DVec3::Y * if step < 500 { 0.0 } else { -0.1 };
            let force = coupling.force(&touch, place, DVec3::ZERO, f64::from(step) * TICK);
            assert!((force - last).length() <= most * (1.0 + 1e-9), "{stiffness} N/m, {step}: from {last} to {force}");
            if step == 499 {
                assert!((force - touch.force).length() < 1e-12, "{stiffness} N/m: {force}");
            }
            // from 2 ms after the last touch, in tick 499, over 50 ms
            let left = 1.0 - (f64::from(step) - 501.0).max(0.0) / 50.0;
            assert!(force.length() <= 2.0 * left.max(0.0) + 1e-9, "{stiffness} N/m, {step}: {force}");
            last = force;
        }
    }
}

/// A device's clock may have gone for a day: the first touch comes by the slew, as where it begins with 0.
#[test]
fn a_clock_that_begins_late_lets_nothing_jump() {
    let touch = Touch { sequence: 5, place: DVec3::X * 0.05, ..Touch::default() };
    for begins in [0.0, 1e5] {
        let mut coupling = VirtualCoupling::new(400.0, 0.0, 3.0);
        let force = |tick: u32| coupling.force(&touch, DVec3::ZERO, DVec3::ZERO, begins + f64::from(tick) * TICK).x;
        for (tick, force) in (1..5).map(force).enumerate() {
            assert!((force - 0.4 * tick as f64).abs() < 1e-6, "from {begins} s: {force} N in tick {tick}");
        }
    }
}

#[test]
fn a_device_gets_numbers_whatever_comes() {
    let mut coupling = VirtualCoupling::new(500.0, 0.5, 2.0);
    for (time, (place, touched)) in
        (0..).zip([(f64::NAN, 1.0), (0.0, f64::INFINITY), (f64::MAX, -f64::MAX), (f64::NAN, 1.0), (0.0, f64::MAX)])
    {
        let touch = Touch { sequence: 1, place: DVec3::splat(touched), ..Touch::default() };
        let force = coupling.force(&touch, DVec3::splat(place), DVec3::ZERO, f64::from(time));
        assert!(force.is_finite() && force.length() <= 2.0 + 1e-9, "{force}");
    }
}
