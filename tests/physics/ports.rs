//! Tools that hands move: where they go, what comes back, and that a run is the same whenever it is replayed.

use crate::configurations::{Configuration, configurations, cpu_and_long_gpu, near, scene_of};
use glam::{DQuat, DVec3};
use sinew::port::{DevicePose, Touch};
use sinew::{InputRecording, Options, Simulation};
use std::path::Path;

/// A ball above a block; the port's words.
pub fn above(port: &str) -> String {
    format!(
        "(duration: 1, bodies: {{\"b\": (mesh: Box(size: (0.02, 0.02, 0.01), cells: (6, 6, 3)), material: \"m\")}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e4, poisson: 0.4), damping: 50)}},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))],
        tools: {{\"ball\": (shape: Sphere(radius: 0.007), at: (0.01, 0.01, 0.0175), port: (name: \"hand\", {port}))}},
        contacts: [Tool(tool: \"ball\", friction: 0.2)])"
    )
}

/// A hand that presses by 2 mm, slides and turns.
pub fn hand(time: f64) -> DevicePose {
    let press = 0.5 - 0.5 * (time * 90.0).cos();
    DevicePose {
        time,
        place: DVec3::new(0.01 + 1e-3 * (time * 50.0).sin(), 0.01, 0.0175 - 2.5e-3 * press),
        orientation: DQuat::from_rotation_y(0.2 * press),
        ..DevicePose::default()
    }
}

const PROXY: &str = "speed: 0.2, follow: Proxy(stiffness: 500, damping: 0.05)";

fn bits(simulation: &mut Simulation) -> Vec<u64> {
    let felt = simulation.tool("ball").unwrap();
    let u = simulation.displacements("b").unwrap();
    let numbers = u.iter().flat_map(|u| u.to_array()).chain(felt.force.to_array()).chain(felt.place.to_array());
    numbers.chain([felt.work.unwrap(), felt.loss.unwrap()]).map(f64::to_bits).collect()
}

#[test]
fn a_tool_goes_where_the_hand_is_no_faster_than_its_port_allows() {
    for run in configurations() {
        let mut simulation = run.start(&above("speed: 0.25, spin: 90"));
        let mut port = simulation.open_port("hand").unwrap();
        let (from, to) = (DVec3::new(0.01, 0.01, 0.0175), DVec3::new(0.013, 0.014, 0.0175));
        let turn = DQuat::from_rotation_z(2.0_f64.to_radians());
        let mut before = from;
        let mut answered = Vec::new();
        while simulation.time() < 0.03 {
            // a fifth faster than the tool may
            let place = from + (to - from) * (0.3 * simulation.time() / 5e-3).min(1.0);
            port.send(&DevicePose { place, orientation: turn, ..DevicePose::default() });
            simulation.advance(1).unwrap();
            let place = simulation.tool("ball").unwrap().place;
            let way = before.distance(place);
            assert!(way <= 0.25 * simulation.time_step() * (1.0 + 1e-6) + 1e-12, "{}: {way} m in a step", run.name);
            before = place;
            let touch = port.touch();
            if touch.sequence as usize > answered.len() {
                answered.push(touch);
            }
        }
        near(run.name, before.distance(to), 0.0, 5e-3, 1e-12);
        // 5 mm at .25 m/s, from the second batch on
        let late = answered.iter().find(|touch| touch.place.distance(to) < 1e-9).unwrap();
        let batch = answered[0].time;
        near(run.name, late.time, 0.02 + batch, batch, 1.0 + 1e-9);
        assert_eq!(answered[0].velocity, DVec3::ZERO);
        near(run.name, answered[3].velocity.length(), 0.25, 0.25, 1e-9);
        // 2° at 90°/s
        let turned = |touch: &Touch| touch.orientation.angle_between(turn).to_degrees();
        let [early, there] = [5, answered.len() - 1].map(|i| turned(&answered[i]));
        near(run.name, early, 2.0 - 90.0 * answered[5].time, 2.0, 1e-6);
        near(run.name, there, 0.0, 2.0, 1e-6);
        // one touch a batch, in order, each of the pose that the batch began with
        assert!(
            answered.windows(2).all(|pair| pair[1].sequence == pair[0].sequence + 1 && pair[1].step > pair[0].step)
        );
        assert!(answered.windows(2).all(|pair| pair[1].answers > pair[0].answers), "{}", run.name);
        assert!(answered.iter().all(|touch| !touch.in_contact && touch.force == DVec3::ZERO && touch.stiffness == 0.0));
        near(run.name, batch, 1e-3, simulation.time_step(), 0.5);
    }
}

/// The mean over a batch is that of what each step felt.
#[test]
fn a_touch_is_the_mean_of_what_the_tool_felt() {
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(&above("speed: 0.2"));
        let mut port = simulation.open_port("hand").unwrap();
        let (mut sum, mut steps, mut seen, mut touched) = (DVec3::ZERO, 0.0, 0, 0);
        while simulation.time() < 0.06 {
            port.send(&hand(simulation.time()));
            simulation.advance(1).unwrap();
            sum += simulation.tool("ball").unwrap().force;
            steps += 1.0;
            let touch = port.touch();
            if touch.sequence == seen {
                continue;
            }
            let mean = sum / steps;
            let bound = run.bound(1e-12, 1e-5);
            near(run.name, touch.force.distance(mean), 0.0, mean.length().max(1e-6), bound);
            assert_eq!(touch.in_contact, touch.force != DVec3::ZERO);
            if touch.in_contact {
                touched += 1;
                near(run.name, touch.normal.dot(touch.force), touch.force.length(), touch.force.length(), 1e-12);
                // forces of a ball without much friction pass by its middle, at most μ R beside
                assert!(touch.torque.length() <= 0.2 * 0.0071 * touch.force.length() * 1.1, "{touch:?}");
            }
            (sum, steps, seen) = (DVec3::ZERO, 0.0, touch.sequence);
        }
        assert!(touched > 20, "{}: {touched} batches touched", run.name);
    }
}

/// What a tool sucks draws at the hand, and takes a proxy along to it.
#[test]
fn a_hand_feels_what_its_tool_sucks() {
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(
            "(duration: 1, bodies: {\"b\": (mesh: Box(size: (0.01, 0.01, 0.002), cells: (4, 4, 1)), material: \"m\",
                translate: (-0.005, -0.005, -0.002))},
            materials: {\"m\": (density: 1000, neo_hookean: Young(young: 5e4, poisson: 0.3), damping: 500)},
            constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: -0.002))],
            tools: {\"tip\": (shape: Tube(length: 0.02, inner: 0.002, outer: 0.003), at: (3e-4, 0, 1e-4),
                port: (name: \"hand\", speed: 0.1, follow: Proxy(stiffness: 200)))},
            suction: [(tool: \"tip\", pressure: 1000, reach: 0.001)])",
        );
        let mut port = simulation.open_port("hand").unwrap();
        let place = DVec3::new(3e-4, 0.0, 1e-4);
        let (mut seen, mut last) = (0, Touch::default());
        while simulation.time() < 0.02 {
            port.send(&DevicePose { place, ..DevicePose::default() });
            simulation.advance(1).unwrap();
            last = port.touch();
            if last.sequence == seen {
                continue;
            }
            seen = last.sequence;
            let reading = simulation.tool("tip").unwrap();
            // nothing else is felt
            near(run.name, last.force.distance(reading.suction), 0.0, reading.suction.length(), 1e-12);
            near(run.name, last.torque.distance(reading.torque), 0.0, 0.002 * reading.suction.length(), 1e-12);
            assert!(last.in_contact && last.force.z < -5e-3 && last.normal.z < -0.9, "{}: {last:?}", run.name);
        }
        // Δp π r² is 12.6 mN
        assert!(seen > 15 && last.place.z < place.z - 3e-5, "{}: {last:?}", run.name);
    }
}

/// A proxy at rest: the spring's force is what it feels, and hand and tissue are two springs in series.
#[test]
#[ignore = "long"]
fn a_proxy_and_tissue_are_two_springs_in_series() {
    for run in configurations() {
        let pressed = |port: &str, place: DVec3| {
            // with friction rest depends on the way there
            let mut simulation = run.start(&above(port).replace("friction: 0.2", "friction: 0"));
            let mut port = simulation.open_port("hand").unwrap();
            port.send(&DevicePose { place, ..DevicePose::default() });
            simulation.advance_to(0.5).unwrap();
            (port.touch(), simulation.tool("ball").unwrap())
        };
        let (start, deep) = (DVec3::new(0.01, 0.01, 0.0175), DVec3::new(0.01, 0.01, 0.0155));
        let (proxy, reading) = pressed("speed: 0.05, follow: Proxy(stiffness: 200, damping: 0.1)", deep);
        let force = proxy.force.z;
        assert!(force > 1e-2 && proxy.place.z > deep.z + 1e-4, "{}: {proxy:?}", run.name);
        near(run.name, 200.0 * (proxy.place.z - deep.z), force, force, run.bound(1e-5, 1e-4));
        near(run.name, reading.force.z, force, force, run.bound(1e-5, 1e-3));
        // who is put where the proxy ended feels the same
        let (put, _) = pressed("speed: 0.05", proxy.place);
        near(run.name, put.force.z, force, force, run.bound(1e-3, 2e-3));
        // K k/(K + k), k from the start of contact to there
        let [tissue, both] = [start.z - proxy.place.z, start.z - deep.z].map(|way| force / (way - 5e-4));
        near(run.name, both, 200.0 * tissue / (200.0 + tissue), both, run.bound(1e-4, 1e-3));
        assert!(proxy.velocity.length() < 1e-5, "{}: {proxy:?}", run.name);
    }
}

/// The stiffness along the normal: of a plate on a bar without Poisson's effect it is E A/L.
#[test]
fn the_stiffness_told_is_that_of_a_bar() {
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(
            "(duration: 1, bodies: {\"b\": (mesh: Box(size: (0.01, 0.01, 0.01), cells: (2, 2, 2)), material: \"m\")},
            materials: {\"m\": (density: 1000, neo_hookean: Young(young: 1e5, poisson: 0), damping: 200)},
            constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))],
            tools: {\"plate\": (shape: Box(size: (0.04, 0.04, 0.01)), at: (0.005, 0.005, 0.015),
                port: (name: \"hand\", speed: 1))},
            contacts: [Tool(tool: \"plate\")])",
        );
        let mut port = simulation.open_port("hand").unwrap();
        // 1 % in .2 s, some twenty times slower than waves
        while simulation.time() < 0.2 {
            let place = DVec3::new(0.005, 0.005, 0.015 - 1e-4 * simulation.time() / 0.2);
            port.send(&DevicePose { place, ..DevicePose::default() });
            simulation.advance(1).unwrap();
        }
        // 1.5 % stiffer where it is 1 % shorter
        let touch = port.touch();
        near(run.name, touch.stiffness, 1e5 * 1e-4 / 0.01, 1000.0, 0.03);
        near(run.name, touch.normal.z, 1.0, 1.0, 1e-6);
        // and it stays that while the tool stands still
        simulation.advance_to(0.4).unwrap();
        near(run.name, port.touch().stiffness, 1e5 * 1e-4 / 0.01, 1000.0, 0.05);
    }
}

#[test]
fn a_port_that_nobody_feeds_leaves_its_tool_and_is_told() {
    for run in cpu_and_long_gpu() {
        for opened in [false, true] {
            let mut simulation = run.start(&above(PROXY));
            let mut port = opened.then(|| simulation.open_port("hand").unwrap());
            simulation.advance_to(0.01).unwrap();
            let place = simulation.tool("ball").unwrap().place;
            near(run.name, place.distance(DVec3::new(0.01, 0.01, 0.0175)), 0.0, 0.01, 1e-14);
            let summary = simulation.summary("finished").unwrap();
            assert_eq!(summary.ports["hand"].warning, "nobody has fed it: `ball` stays where it starts");
            assert!(summary.ports["hand"].batches >= 9 && summary.real_time.is_none());
            assert!(port.as_mut().is_none_or(|port| port.touch().sequence >= 9 && port.touch().answers == 0));
        }
        // what is no place is not gone to
        let mut simulation = run.start(&above(PROXY));
        let mut port = simulation.open_port("hand").unwrap();
        for broken in [
            DevicePose { place: DVec3::new(f64::NAN, 0.0, 0.0), ..DevicePose::default() },
            DevicePose { place: DVec3::new(0.0, 1e300, 0.0), ..DevicePose::default() },
            DevicePose { orientation: DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0), ..DevicePose::default() },
            DevicePose { velocity: DVec3::INFINITY, ..DevicePose::default() },
        ] {
            port.send(&broken);
            simulation.advance_to(simulation.time() + 2e-3).unwrap();
        }
        let used = &simulation.ports()["hand"];
        assert_eq!((used.poses, used.refused), (0, 4));
        assert!(used.warning.starts_with("4 poses had numbers that are not finite"), "{}", used.warning);
        assert_eq!(simulation.tool("ball").unwrap().place, DVec3::new(0.01, 0.01, 0.0175));
        let unknown = simulation.open_port("glove").unwrap_err().to_string();
        assert_eq!(unknown, "there is no port named \"glove\"; there is hand");
    }
}

/// Feeds a hand for so many steps, so many at a time.
fn feed(simulation: &mut Simulation, steps: u64, at_once: u64) -> Vec<Touch> {
    let mut port = simulation.open_port("hand").unwrap();
    let (end, mut touches) = (simulation.step_count() + steps, Vec::new());
    while simulation.step_count() < end {
        port.send(&hand(simulation.time()));
        simulation.advance(at_once.min(end - simulation.step_count())).unwrap();
        touches.push(Touch { real_time_factor: 0.0, sequence: 0, ..port.touch() });
    }
    touches
}

/// What a hand did is replayed by the steps that its poses began with: however steps are asked for, on any number of
/// threads, from the start or from a snapshot within a batch.
#[test]
fn a_replay_has_the_same_bits() {
    for run in cpu_and_long_gpu() {
        let start = |options: &Options| Simulation::new(&scene_of(&above(PROXY), Path::new(".")), options).unwrap();
        let mut first = start(&run.options);
        first.record_inputs();
        feed(&mut first, 103, 7);
        let snapshot = first.snapshot().unwrap();
        let early = first.stop_recording_inputs().unwrap();
        first.record_inputs();
        feed(&mut first, 200, 9);
        let late = first.stop_recording_inputs().unwrap();
        let expected = bits(&mut first);
        assert!(first.tool("ball").unwrap().force.length() > 1e-4, "{}: nothing is touched", run.name);
        assert!(early.poses.len() > 3 && late.poses.len() > 7, "{early:?}");

        let again = |options: &Options, at_once: u64| {
            let mut second = start(options);
            let text = early.to_ron().unwrap();
            second.replay_inputs(&InputRecording::from_ron(&text).unwrap()).unwrap();
            while second.step_count() < 103 {
                second.advance(at_once.min(103 - second.step_count())).unwrap();
            }
            second.replay_inputs(&late).unwrap();
            second.advance(200).unwrap();
            bits(&mut second)
        };
        assert!(again(&run.options, 103) == expected, "{}: replayed", run.name);
        assert!(again(&run.options, 1) == expected, "{}: replayed step by step", run.name);
        if !run.name.starts_with("GPU") {
            let threads = Options { threads: 3, ..run.options.clone() };
            assert!(again(&threads, 10) == expected, "{}: on three threads", run.name);
        }
        let mut resumed = start(&run.options);
        resumed.restore(&snapshot).unwrap();
        resumed.replay_inputs(&late).unwrap();
        resumed.advance(200).unwrap();
        assert!(bits(&mut resumed) == expected, "{}: resumed", run.name);
        // and back
        first.restore(&snapshot).unwrap();
        first.replay_inputs(&late).unwrap();
        first.advance(200).unwrap();
        assert!(bits(&mut first) == expected, "{}: taken back", run.name);
        let felt = first.tool("ball").unwrap();
        first.reset().unwrap();
        assert_eq!(first.tool("ball").unwrap().place, DVec3::new(0.01, 0.01, 0.0175));
        first.replay_inputs(&early).unwrap();
        first.advance(103).unwrap();
        first.replay_inputs(&late).unwrap();
        first.advance(200).unwrap();
        assert!(bits(&mut first) == expected && first.tool("ball").unwrap() == felt, "{}: from the start", run.name);
        refusals(&run, &mut first, &late);
    }
}

fn refusals(run: &Configuration, simulation: &mut Simulation, late: &InputRecording) {
    let told = |recording: &InputRecording, simulation: &mut Simulation| {
        simulation.replay_inputs(recording).unwrap_err().to_string()
    };
    assert!(told(late, simulation).starts_with("the recording began after 103 steps"), "{}", run.name);
    let mut other = InputRecording { from: simulation.step_count(), ..late.clone() };
    assert!(told(&other, simulation).starts_with("the recording cannot move \"hand\" at step 1"), "{}", run.name);
    other.poses.drain(1..);
    (other.poses[0].step, other.poses[0].port) = (other.from, "glove".into());
    assert_eq!(told(&other, simulation), "the recording has a port \"glove\"; in the scene there is hand");
}

/// Both ways to the same place: a device's rounding is the only difference.
#[test]
fn backends_agree_on_what_a_hand_does() {
    let mut all = cpu_and_long_gpu().into_iter().map(|run| {
        let mut simulation = run.start(&above(PROXY));
        (run.name, feed(&mut simulation, 300, 10))
    });
    let (_, exact) = all.next().unwrap();
    for (name, found) in all {
        let scale = exact.iter().map(|touch| touch.force.length()).fold(0.0, f64::max);
        assert!(scale > 1e-3 && exact.len() == found.len());
        for (exact, found) in exact.iter().zip(&found) {
            assert_eq!(exact.step, found.step);
            near(name, found.place.distance(exact.place), 0.0, 2.5e-3, 1e-3);
            near(name, found.force.distance(exact.force), 0.0, scale, 5e-3);
        }
    }
}
