//! Devices at ports, without hardware: a mass that a hand's spring leads and a virtual coupling holds back, and threads
//! that run beside the engine.

use crate::configurations::{configurations, cpu_and_long_gpu, near};
use crate::ports::{above, hand};
use glam::DVec3;
use sinew::Simulation;
use sinew::port::{DevicePose, ToolPort, Touch, VirtualCoupling};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// A tick of the device (s).
const TICK: f64 = 1e-3;

/// Of the device and the hand together (N s/m).
const DAMPING: f64 = 13.0;

/// A device of .1 kg with 1 N s/m of its own, and a hand that leads it by 300 N/m and 12 N s/m.
struct Device {
    place: DVec3,
    velocity: DVec3,
    coupling: VirtualCoupling,
    time: f64,
}

impl Device {
    /// A tick: the force for the hand (N), and the energy that the coupling took in it (J).
    fn tick(&mut self, touch: &Touch, lead: DVec3) -> (DVec3, f64) {
        let force = self.coupling.force(touch, self.place, self.velocity, self.time);
        let hand = 300.0 * (lead - self.place) - DAMPING * self.velocity;
        let before = self.place;
        self.velocity += TICK * (hand + force) / 0.1;
        self.place += TICK * self.velocity;
        self.time += TICK;
        (force, -force.dot(self.place - before))
    }
}

/// Takes turns with the engine, a tick each: virtual time. What the hand did, each tick: force and energy taken.
fn together(
    simulation: &mut Simulation,
    port: &mut ToolPort,
    device: &mut Device,
    until: f64,
    lead: impl Fn(f64) -> DVec3,
) -> Vec<(DVec3, f64)> {
    let mut all = Vec::new();
    while device.time < until {
        let told = all.len();
        assert!(told < 100_000);
        port.send(&DevicePose { time: device.time, place: device.place, ..DevicePose::default() });
        simulation.advance_to(device.time + TICK).unwrap();
        all.push(device.tick(&port.touch(), lead(device.time)));
    }
    all
}

/// A hand presses into a block, holds, presses more, holds, leaves: while it holds the coupling gives nothing that it
/// was not given, and with a proxy gives less than it takes in all.
#[test]
#[ignore = "long"]
fn a_coupled_device_is_passive() {
    // on soft tissue, and on some that is stiffer than the coupling and the hand
    let modulus = |young: &'static str| move |run| (run, young);
    let others = ["3e3", "3e5"].into_iter().flat_map(|young| configurations().into_iter().take(1).map(modulus(young)));
    for (run, young) in configurations().into_iter().map(modulus("3e4")).chain(others) {
        for (port, feed_forward) in
            [("speed: 0.5, follow: Proxy(stiffness: 400, damping: 0.2)", 0.0), ("speed: 0.5", 1.0)]
        {
            let mut simulation = run.start(&above(port).replace("young: 3e4", &format!("young: {young}")));
            let mut port = simulation.open_port("hand").unwrap();
            let start = DVec3::new(0.01, 0.01, 0.0175);
            // touches are two ticks old
            let stiffness = 400.0;
            assert!(stiffness < VirtualCoupling::largest_stiffness(DAMPING, TICK, 2.0 * TICK));
            let mut coupling = VirtualCoupling::new(stiffness, 0.0, 3.0);
            coupling.feed_forward = feed_forward;
            let mut device = Device { place: start, velocity: DVec3::ZERO, coupling, time: 0.0 };
            let deep = |time: f64| match time {
                ..0.1 => 15.0 * time * time * (3.0 - 20.0 * time) / 75.0,
                ..0.3 => 2e-3,
                ..0.4 => 2e-3 + 1e-2 * (time - 0.3),
                ..0.6 => 3e-3,
                ..0.7 => 3e-3 - 3.5e-2 * (time - 0.6),
                _ => -5e-4,
            };
            let lead = |time: f64| start - DVec3::Z * deep(time);
            let all = together(&mut simulation, &mut port, &mut device, 0.9, lead);
            let at = |time: f64| (time / TICK).round() as usize;
            let largest = all.iter().map(|(force, _)| force.length()).fold(0.0, f64::max);
            // a tenth of a second after it stops
            for (from, until) in [(0.2, 0.3), (0.5, 0.6), (0.8, 0.9)] {
                let mut least = 0.0_f64;
                let mut window = 0.0_f64;
                for (_, taken) in &all[at(from)..at(until)] {
                    window = (window + taken).min(*taken);
                    least = least.min(window);
                }
                println!("{} {feed_forward}: from {from} s: {least:e} J", run.name);
                assert!(least >= -1e-6, "{} {feed_forward}: from {from} s it gave {least:e} J", run.name);
            }
            let sum: f64 = all.iter().map(|(_, taken)| taken).sum();
            println!("{} {feed_forward}: {sum:e} J in all, up to {largest} N", run.name);
            // a force that is passed on late is not passive: the hand's own damping has to take what it gives
            assert!(sum >= -1e-6 || feed_forward > 0.0, "{}, {young} Pa: {sum:e} J in all", run.name);
            assert!(largest > 5e-3 && largest < 3.0, "{}: {largest} N", run.name);
            // held at rest it feels what the tool feels
            let (held, _) = all[at(0.58)];
            let change = all[at(0.55)..at(0.59)].iter().map(|(force, _)| force.distance(held)).fold(0.0, f64::max);
            near(run.name, change, 0.0, held.length(), 0.02);
            assert!(held.z > 0.0 && all[at(0.85)].0.length() < 0.02 * largest, "{} {:?}", held, all[at(0.85)]);
        }
    }
}

/// A device that opens the port anew begins to count anew, and no pose is answered that came before the run went back.
#[test]
fn touches_are_counted_from_the_opening_and_answer_no_pose_from_before_the_run_went_back() {
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(&above("speed: 0.3"));
        let mut port = simulation.open_port("hand").unwrap();
        // the last touch after two batches and more, each of a thousandth of a second
        let after = |simulation: &mut Simulation, port: &mut ToolPort| {
            let before = port.touch().sequence;
            simulation.advance_to(simulation.time() + 3e-3).unwrap();
            let touch = port.touch();
            assert!(touch.sequence > before, "{}: {touch:?}", run.name);
            touch
        };
        assert_eq!([0.0, 1e-3].map(|time| port.send(&hand(time))), [1, 2]);
        simulation.advance_to(0.01).unwrap();
        let touch = port.touch();
        assert!(touch.answers == 2 && touch.sequence > 6, "{}: {touch:?}", run.name);
        let snapshot = simulation.snapshot().unwrap();

        let mut anew = simulation.open_port("hand").unwrap();
        let touch = after(&mut simulation, &mut anew);
        assert!(touch.answers == 0 && touch.sequence < 6, "{}: {touch:?}", run.name);
        anew.send(&hand(2e-3));
        assert_eq!(after(&mut simulation, &mut anew).answers, 1, "{}", run.name);
        simulation.restore(&snapshot).unwrap();
        assert_eq!(after(&mut simulation, &mut anew).answers, 0, "{}", run.name);
        anew.send(&hand(3e-3));
        assert_eq!(after(&mut simulation, &mut anew).answers, 2, "{}", run.name);
        simulation.reset().unwrap();
        assert_eq!(after(&mut simulation, &mut anew).answers, 0, "{}", run.name);
    }
}

/// A thread a thousand times a second beside a busy engine: whatever it gets is whole and in order.
#[test]
fn a_device_in_its_own_thread_gets_whole_touches_in_order() {
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(&above("speed: 0.3, every: 5e-4"));
        let mut port = simulation.open_port("hand").unwrap();
        let done = AtomicBool::new(false);
        std::thread::scope(|scope| {
            let device = scope.spawn(|| {
                let (mut last, mut got, mut sent) = (Touch::default(), 0, 0);
                let started = Instant::now();
                while !done.load(Ordering::Acquire) {
                    // the hand's way in the tissue's time: a busy engine is no hand that shakes
                    let time = started.elapsed().as_secs_f64();
                    sent = port.send(&DevicePose { time, ..hand(last.time) });
                    let touch = port.touch();
                    assert!(touch.sequence >= last.sequence && touch.answers >= last.answers && touch.answers <= sent);
                    assert_eq!(touch == last, touch.sequence == last.sequence, "{touch:?} after {last:?}");
                    assert_eq!(touch.in_contact, touch.force != DVec3::ZERO);
                    assert!(touch.step >= last.step && touch.time >= last.time);
                    got += u64::from(touch.sequence > last.sequence);
                    last = touch;
                    std::thread::sleep(Duration::from_micros(900));
                }
                (got, sent)
            });
            let ended = simulation.advance_to(0.1);
            // however it ended, or the device would wait for ever
            done.store(true, Ordering::Release);
            let (got, sent) = device.join().unwrap();
            ended.unwrap();
            let used = simulation.ports()["hand"].clone();
            println!("{}: {} batches, {} poses of {sent}, {got} touches seen", run.name, used.batches, used.poses);
            assert!(used.batches >= 150 && used.poses > 0 && used.refused == 0 && got > 0);
        });
    }
}

/// The engine stands still for a second: the hand is let go, without a jump.
#[test]
fn while_the_engine_pauses_the_force_goes_away() {
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(&above("speed: 0.3"));
        let mut port = simulation.open_port("hand").unwrap();
        let start = DVec3::new(0.01, 0.01, 0.0175);
        let mut coupling = VirtualCoupling::new(200.0, 0.0, 3.0);
        coupling.feed_forward = 1.0;
        let slew = coupling.stiffness * coupling.fastest * TICK;
        let mut device = Device { place: start, velocity: DVec3::ZERO, coupling, time: 0.0 };
        let lead = |time: f64| start - DVec3::Z * (2e-2 * time).min(2e-3);
        let mut all = together(&mut simulation, &mut port, &mut device, 0.2, lead);
        let held = all[all.len() - 1].0;
        assert!(held.length() > 5e-3, "{}: {held}", run.name);
        for _ in 0..1000 {
            let force = device.tick(&port.touch(), lead(device.time));
            all.push(force);
        }
        assert!(all[260..].iter().all(|(force, _)| *force == DVec3::ZERO), "{}", run.name);
        while simulation.time() < 0.4 {
            port.send(&DevicePose { place: device.place, ..DevicePose::default() });
            simulation.advance_to(simulation.time() + TICK).unwrap();
            all.push(device.tick(&port.touch(), lead(device.time)));
        }
        let jump = all.windows(2).map(|pair| pair[0].0.distance(pair[1].0)).fold(0.0, f64::max);
        assert!(jump <= slew * (1.0 + 1e-12), "{}: {jump} N in a tick, at most {slew}", run.name);
        near(run.name, all[all.len() - 1].0.distance(held), 0.0, held.length(), 0.02);
    }
}

/// At the pace of life a run takes as long as it lasts, or longer, and has the same bits.
#[test]
fn a_run_in_real_time_waits_for_life_and_has_the_same_bits() {
    for run in cpu_and_long_gpu() {
        let of = |pace: &str| {
            let mut simulation = run.start(&above("speed: 0.3").replacen("(duration", &format!("({pace} duration"), 1));
            let started = Instant::now();
            simulation.advance_to(0.05).unwrap();
            (started.elapsed(), simulation.summary("finished").unwrap(), simulation.displacements("b").unwrap())
        };
        let (took, summary, paced) = of("real_time: true,");
        let (_, free, unpaced) = of("");
        assert!(paced == unpaced && free.real_time.is_none(), "{}", run.name);
        let kept = summary.real_time.unwrap();
        // the last tick is not waited for
        assert!(took >= Duration::from_secs_f64(0.049), "{}: {took:?}", run.name);
        assert!((40..=60).contains(&kept.ticks) && kept.late <= kept.ticks, "{}: {kept:?}", run.name);
        assert!(summary.solving_seconds + kept.waited <= summary.run_seconds + 1e-9, "{}: {kept:?}", run.name);
    }
}

/// Who gives a budget keeps the pace: nothing is waited for, and who asks for no budget later waits from there on.
#[test]
fn steps_in_a_budget_do_not_wait_for_life() {
    let run = &configurations()[0];
    let mut simulation = run.start(&above("speed: 0.3").replacen("(duration", "(real_time: true, duration", 1));
    let advanced = simulation.advance_for(Duration::from_secs(3600), 0.1).unwrap();
    assert_eq!(advanced.why, sinew::Ended::Reached);
    let kept = simulation.summary("finished").unwrap().real_time.unwrap();
    assert_eq!((kept.ticks, kept.waited), (0, 0.0));
    let started = Instant::now();
    simulation.advance_to(0.12).unwrap();
    // neither the first tick nor the last is waited for
    assert!(started.elapsed() >= Duration::from_secs_f64(0.017), "{:?}", started.elapsed());
    let kept = simulation.summary("finished").unwrap().real_time.unwrap();
    assert!(kept.ticks >= 15 && kept.waited < 0.1, "{kept:?}");
}
