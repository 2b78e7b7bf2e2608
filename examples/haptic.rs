//! A hand that feels tissue: a device's thread a thousand times a second beside an engine that keeps up with life.
//!
//! `cargo run --release --example haptic [SECONDS] [SCENE]` lets a simulated hand press a probe into a small block,
//! hold it, slide, and leave; with a scene of a lens (scenes/lens_pressed.ron) into that, from its front. The device is
//! a mass that the hand's arm leads and the force holds back; a real one is read and written where `Device::tick` is
//! (docs/interaction.md). It prints the force on the hand, how old what it is made of is, what a port costs, and
//! whether the same poses give the same bits again.

use sinew::glam::DVec3;
use sinew::port::{DevicePose, ToolPort, Touch, VirtualCoupling};
use sinew::{BackendChoice, Error, InputRecording, Options, SceneFile, Simulation};
use std::collections::VecDeque;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

const BLOCK: &str = r#"(
    title: "A probe that a hand moves presses a block",
    duration: 3600,
    bodies: {"block": (mesh: Box(size: (0.03, 0.03, 0.015), cells: (7, 7, 4)), material: "tissue")},
    materials: {"tissue": (density: 1000, neo_hookean: Young(young: 1e4, poisson: 0.45), damping: 30)},
    constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))],
    tools: {"probe": (
        shape: Sphere(radius: 0.006), at: (0.015, 0.015, 0.0215),
        port: (name: "device 0", speed: 0.3, follow: Proxy(stiffness: 400, damping: 0.1)),
    )},
    contacts: [Tool(tool: "probe", friction: 0.1)],
)"#;

/// What makes a scene of a lens one with a probe in a hand, in place of its loads.
const LENS: [&str; 4] = [
    "duration=3600",
    "loads=[]",
    r#"tools={"probe": (shape: Sphere(radius: 0.002), at: (0, 0, 0.0045),
        port: (name: "device 0", speed: 0.3, follow: Proxy(stiffness: 400, damping: 0.1)))}"#,
    r#"contacts=[Tool(tool: "probe", on: Set("front"), friction: 0.1)]"#,
];

/// What a hand touches, and how it goes.
pub struct Touched {
    path: Option<String>,
    /// Where the probe is at first (m): half a millimetre above what it touches.
    start: DVec3,
    /// How far the arm leads it down, and then aside (m).
    way: [f64; 2],
}

impl Touched {
    /// A block of 1.5 cm.
    pub fn block() -> Self {
        Self { path: None, start: DVec3::new(0.015, 0.015, 0.0215), way: [3.5e-3, 2e-3] }
    }

    /// The lens of a scene file.
    pub fn lens(path: &str) -> Self {
        Self { path: Some(path.into()), start: DVec3::new(0.0, 0.0, 0.0045), way: [1.5e-3, 0.5e-3] }
    }

    /// The scene, with further values.
    fn scene(&self, sets: &[&str]) -> Result<SceneFile, Error> {
        let sets = |more: &[&str]| sets.iter().chain(more).map(|set| set.to_string()).collect::<Vec<_>>();
        Ok(match &self.path {
            None => SceneFile::from_text("haptic", BLOCK, std::path::Path::new("."), &sets(&[]))?,
            Some(path) => SceneFile::load(path, &sets(&LENS))?,
        })
    }

    /// Where the arm leads (m): in, hold, slide, out.
    fn arm(&self, share: f64) -> DVec3 {
        let ramp = |from: f64, until: f64| ((share - from) / (until - from)).clamp(0.0, 1.0);
        let smooth = |x: f64| x * x * (3.0 - 2.0 * x);
        let [down, aside] = self.way;
        let depth = down * (smooth(ramp(0.05, 0.35)) - smooth(ramp(0.75, 0.95)));
        self.start + DVec3::new(aside * smooth(ramp(0.45, 0.65)), 0.0, -depth)
    }
}

/// A tick of the device.
const TICK: Duration = Duration::from_millis(1);
/// Damping of the device and the hand together (N s/m).
const DAMPING: f64 = 6.0;

/// A device of 100 g, and the hand that holds it.
struct Device {
    place: DVec3,
    velocity: DVec3,
    coupling: VirtualCoupling,
}

/// What a device saw in a tick.
#[derive(Clone, Copy)]
pub struct Felt {
    /// When (s).
    pub time: f64,
    /// How deep the hand is below where it was at first (m).
    pub depth: f64,
    /// The force on the hand (N).
    pub force: DVec3,
    /// How long ago the pose was sent that the tool went to by what is felt (s); `None` before the first.
    pub age: Option<f64>,
}

impl Device {
    /// A tick of the servo loop: last touch in, force out. In place of the motion here a real device is read.
    fn tick(&mut self, touch: &Touch, arm: DVec3, time: f64) -> DVec3 {
        let force = self.coupling.force(touch, self.place, self.velocity, time);
        let tick = TICK.as_secs_f64();
        self.velocity += tick * (300.0 * (arm - self.place) - DAMPING * self.velocity + force) / 0.1;
        self.place += tick * self.velocity;
        force
    }
}

/// The device's thread: never waits for the engine.
fn servo(touched: &Touched, mut port: ToolPort, seconds: f64, done: &AtomicBool) -> Vec<Felt> {
    // no stiffer than the hand can hold by a proxy that is two ticks old
    let stiffness = VirtualCoupling::largest_stiffness(DAMPING, 1e-3, 2e-3).min(400.0);
    let mut device =
        Device { place: touched.start, velocity: DVec3::ZERO, coupling: VirtualCoupling::new(stiffness, 0.0, 3.0) };
    let (mut all, mut sent) = (Vec::new(), VecDeque::new());
    let started = Instant::now();
    while started.elapsed().as_secs_f64() < seconds {
        let time = started.elapsed().as_secs_f64();
        let pose = DevicePose { time, place: device.place, velocity: device.velocity, ..DevicePose::default() };
        sent.push_back((port.send(&pose), time));
        let touch = port.touch();
        while sent.front().is_some_and(|(number, _)| *number < touch.answers) {
            sent.pop_front();
        }
        let age = sent.front().filter(|(number, _)| *number == touch.answers).map(|(_, sent)| time - sent);
        let force = device.tick(&touch, touched.arm(time / seconds), time);
        all.push(Felt { time, depth: touched.start.z - device.place.z, force, age });
        let next = TICK * all.len() as u32;
        std::thread::sleep(next.saturating_sub(started.elapsed()));
    }
    done.store(true, Ordering::Release);
    all
}

/// Runs for so long (s) at the pace of life or of this machine; what the hand felt, the recording, and the state.
pub fn press(
    touched: &Touched,
    options: &Options,
    seconds: f64,
) -> Result<(Vec<Felt>, InputRecording, Simulation), Error> {
    let mut simulation = Simulation::new(&touched.scene(&["real_time=true"])?, options)?;
    let port = simulation.open_port("device 0")?;
    simulation.record_inputs();
    let done = AtomicBool::new(false);
    let felt = std::thread::scope(|scope| {
        let device = scope.spawn(|| servo(touched, port, seconds, &done));
        while !done.load(Ordering::Acquire) {
            simulation.advance_to(simulation.time() + 0.01)?;
        }
        Ok::<_, Error>(device.join().unwrap_or_default())
    })?;
    let recording = simulation.stop_recording_inputs().unwrap_or_default();
    Ok((felt, recording, simulation))
}

/// Whether the same poses give the same bits, as fast as it goes.
pub fn replays(
    touched: &Touched,
    options: &Options,
    recording: &InputRecording,
    simulation: &mut Simulation,
) -> Result<bool, Error> {
    let scene = touched.scene(&[])?;
    let mut again = Simulation::new(&scene, options)?;
    again.replay_inputs(recording)?;
    again.advance(simulation.step_count())?;
    for body in scene.scene.bodies.keys() {
        if again.displacements(body)? != simulation.displacements(body)? {
            return Ok(false);
        }
    }
    Ok(again.tool("probe")? == simulation.tool("probe")?)
}

/// A plot of so many columns and rows, with the largest figure at its top.
fn plot(what: &str, unit: &str, figures: &[f64], seconds: f64) {
    const COLUMNS: usize = 72;
    const ROWS: usize = 12;
    let most = figures.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let mean = |column: usize| {
        let of = &figures[column * figures.len() / COLUMNS..(column + 1) * figures.len() / COLUMNS];
        of.iter().sum::<f64>() / of.len().max(1) as f64
    };
    let heights: Vec<f64> = (0..COLUMNS).map(|column| ROWS as f64 * mean(column) / most).collect();
    println!("{what}, up to {most:.3} {unit}");
    for row in (0..ROWS).rev() {
        let line: String = heights
            .iter()
            .map(|height| match height - row as f64 {
                part if part > 0.6 => '#',
                part if part > 0.1 => '.',
                _ => ' ',
            })
            .collect();
        println!("  {:6.3} |{}", most * (row + 1) as f64 / ROWS as f64, line.trim_end());
    }
    println!("         +{}> {seconds} s", "-".repeat(COLUMNS));
}

/// How old what is felt is: half milliseconds.
fn ages(felt: &[Felt]) {
    let mut all: Vec<f64> = felt.iter().filter_map(|felt| felt.age).map(|age| 1e3 * age).collect();
    all.sort_by(f64::total_cmp);
    let (Some(longest), count) = (all.last(), all.len()) else { return };
    println!("age of what the force is made of, from pose to force, in {count} ticks:");
    for bin in 0..12 {
        let (from, until) = (0.5 * f64::from(bin), if bin == 11 { f64::INFINITY } else { 0.5 * f64::from(bin + 1) });
        let found = all.iter().filter(|age| (from..until).contains(*age)).count();
        let bar = "#".repeat((60 * found).div_ceil(count.max(1)));
        println!("  {from:4.1} ms {found:6} {bar}");
    }
    let at = |share: f64| all[((count - 1) as f64 * share) as usize];
    println!("  median {:.2} ms, 99 % below {:.2} ms, longest {longest:.2} ms", at(0.5), at(0.99));
}

/// What a tick costs the device (ns): a pose that is sent, a touch that is taken, a force that is made of it.
fn overhead(touched: &Touched, options: &Options) -> Result<[f64; 3], Error> {
    let mut port = Simulation::new(&touched.scene(&[])?, options)?.open_port("device 0")?;
    let mut coupling = VirtualCoupling::new(400.0, 0.0, 3.0);
    let (pose, touch) = (DevicePose::default(), port.touch());
    let each = |part: &mut dyn FnMut(f64) -> f64| {
        let (started, many) = (Instant::now(), 1_000_000);
        let sum: f64 = (0..many).map(|tick| part(1e-3 * f64::from(tick))).sum();
        std::hint::black_box(sum);
        1e9 * started.elapsed().as_secs_f64() / f64::from(many)
    };
    Ok([
        each(&mut |time| port.send(&DevicePose { time, ..std::hint::black_box(pose) }) as f64),
        each(&mut |_| std::hint::black_box(port.touch()).time),
        each(&mut |time| coupling.force(std::hint::black_box(&touch), pose.place, pose.velocity, time).z),
    ])
}

#[allow(dead_code)]
fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1);
    let seconds = arguments.next().map_or(Ok(3.0), |word| word.parse());
    let Some(seconds) = seconds.ok().filter(|seconds: &f64| *seconds > 0.0 && seconds.is_finite()) else {
        eprintln!("haptic [SECONDS] [SCENE]: SECONDS is a number above 0");
        return ExitCode::from(2);
    };
    match feel(seconds, arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn feel(seconds: f64, mut arguments: impl Iterator<Item = String>) -> Result<(), Error> {
    let touched = arguments.next().map_or_else(Touched::block, |path| Touched::lens(&path));
    let options = Options { backend: BackendChoice::Cpu, threads: 1, ..Options::default() };
    let (felt, recording, mut simulation) = press(&touched, &options, seconds)?;
    let forces: Vec<f64> = felt.iter().map(|felt| felt.force.length()).collect();
    plot("force on the hand", "N", &forces, seconds);
    let depths: Vec<f64> = felt.iter().map(|felt| 1e3 * felt.depth.max(0.0)).collect();
    plot("depth of the hand", "mm", &depths, seconds);
    ages(&felt);
    let used = &simulation.ports()["device 0"];
    let (steps, step) = (simulation.step_count(), simulation.time_step());
    println!("{} ticks of the device, {} batches, {steps} steps of {:.0} µs", felt.len(), used.batches, 1e6 * step);
    let summary = simulation.summary("left")?;
    if let Some(kept) = summary.real_time {
        println!("{:.2} s of life simulated; {} of {} ticks late", summary.simulated, kept.late, kept.ticks);
    }
    println!("real-time factor {:.3}", summary.real_time_factor);
    let [sent, taken, made] = overhead(&touched, &options)?;
    println!("a pose sent: {sent:.0} ns; a touch taken: {taken:.0} ns; a force made of it: {made:.0} ns");
    println!("replayed from {} poses: the same bits: {}", recording.poses.len(), {
        replays(&touched, &options, &recording, &mut simulation)?
    });
    Ok(())
}
