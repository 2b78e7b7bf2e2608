//! How long frames take, without a window: a body is pulled at, simulated for a sixtieth of a second, and drawn.

use crate::app::Start;
use crate::headless::{device, first_look, scene};
use crate::mouse::HAND;
use crate::scene3d::Scene3d;
use crate::stage;
use crate::surfaces::Scenery;
use glam::{DVec3, Vec2};
use sinew::driver::{Command, Session, State};
use sinew::{BackendChoice, Host};
use std::time::Duration;
use web_time::Instant;

/// A frame's time on the wall.
const FRAME: Duration = Duration::from_nanos(16_666_667);
/// No frame is cut short.
const BUDGET: Duration = Duration::from_secs(60);
/// How far the hand goes, of the bodies' diagonal, and how many frames it takes to and fro.
const WAY: (f64, f64) = (0.05, 60.0);

/// Milliseconds of each part of each frame.
#[derive(Default)]
struct Times([Vec<f64>; 4]);

const PARTS: [&str; 4] = ["steps", "state", "drawing", "all"];

impl Times {
    fn add(&mut self, marks: [Instant; 4]) {
        let between = |a: usize, b: usize| (marks[b] - marks[a]).as_secs_f64() * 1e3;
        let all = [between(0, 1), between(1, 2), between(2, 3), between(0, 3)];
        self.0.iter_mut().zip(all).for_each(|(times, time)| times.push(time));
    }

    /// Median, 95th of 100, and the longest of each part.
    fn table(&mut self) -> String {
        let mut text = String::from("ms a frame    median    95 %   longest\n");
        for (name, times) in PARTS.iter().zip(&mut self.0) {
            times.sort_by(f64::total_cmp);
            let at = |share: f64| times[((times.len() - 1) as f64 * share).round() as usize];
            text += &format!("{name:<12}{:>8.2}{:>8.2}{:>10.2}\n", at(0.5), at(0.95), at(1.0));
        }
        text
    }
}

/// Pulls at the body in the middle of the picture, simulates, draws, and says how long that took. On the GPU steps
/// are taken on the device that draws, and what it draws from stays there.
///
/// # Errors
/// What is wrong with the scene; no graphics device; no frames. In words.
pub fn frame_times(start: &Start, frames: usize, size: (u32, u32), speed: f64) -> Result<String, String> {
    if frames == 0 {
        return Err("--frame-times 0: one frame at least is wanted".into());
    }
    let host = device()?;
    let mut options = start.options.clone();
    if options.backend != BackendChoice::Cpu {
        options.host = Some(host.clone());
    }
    let lends = options.host.is_some();
    let mut session = Session::new(options);
    let mut scenery = Scenery::new(lends, None);
    session.command(Command::Lend(lends));
    session.command(Command::Load(Box::new(scene(start)?)));
    session.command(Command::Field(start.settings.field));
    session.command(Command::Speed(speed));
    let mut state = checked(session.state())?;
    scenery.follow(&state);
    let orbit = first_look(&state, &mut scenery, &start.settings, size);
    let camera = orbit.camera(Vec2::new(size.0 as f32, size.1 as f32));
    let mut extent = sinew_pictures::render::Extent::NOTHING;
    state.bodies.iter().flat_map(|body| &body.positions).for_each(|place| extent.add(glam::Vec3::from_array(*place)));
    let (eye, middle): (DVec3, DVec3) = (camera.eye().into(), extent.middle().into());
    session.command(Command::Grab { hand: HAND, origin: eye, direction: middle - eye });
    state = checked(session.state())?;
    let point = state.held.first().map(|held| held.point).ok_or("nothing is in the middle that could be pulled at")?;
    let towards = (eye - point).normalize_or_zero() * (WAY.0 * f64::from(extent.diagonal()));
    let mut scene3d = Scene3d::new(host.device.clone(), host.queue.clone(), size);
    let (mut times, begun) = (Times::default(), (state.step, state.time));
    let tissues = scenery.tissues.clone();
    // the first frames make pipelines and learn how many steps fit into a submission
    let warm = frames.min(10);
    for frame in 0..frames + warm {
        let share = 0.5 - 0.5 * (frame as f64 / WAY.1 * std::f64::consts::TAU).cos();
        session.command(Command::MoveGrab { hand: HAND, target: point + towards * share });
        if !session.is_running() {
            // at the end of the scene it pauses once
            session.command(Command::Run);
        }
        let started = Instant::now();
        session.advance(FRAME, BUDGET);
        let stepped = Instant::now();
        state = checked(session.state())?;
        let looked = Instant::now();
        let drawn = scenery.draw(&state, &start.settings);
        stage::paint(&mut scene3d, &drawn, &camera, (&state, &start.settings, &tissues), 1.0);
        scene3d.wait();
        if frame >= warm {
            times.add([started, stepped, looked, Instant::now()]);
        }
    }
    Ok(report(&state, &host, (frames, warm, size), (begun.0, begun.1), &mut times))
}

/// A state, if nothing went wrong.
fn checked(state: State) -> Result<State, String> {
    match (&state.refusal, &state.breakdown) {
        (Some(refusal), _) => Err(refusal.reason.clone()),
        (None, Some(broken)) => Err(broken.to_string()),
        (None, None) => Ok(state),
    }
}

fn report(
    state: &State,
    host: &Host,
    (frames, warm, size): (usize, usize, (u32, u32)),
    (step, time): (u64, f64),
    times: &mut Times,
) -> String {
    let all = (frames + warm) as f64;
    let bodies = state.loaded.iter().flat_map(|loaded| &loaded.bodies);
    let (elements, nodes) = bodies.fold((0, 0), |sum, body| (sum.0 + body.cells.len(), sum.1 + body.rest.len()));
    let backend = state.loaded.as_ref().map(|loaded| loaded.backend.clone()).unwrap_or_default();
    let about = host.adapter.get_info();
    format!(
        "{elements} elements, {nodes} nodes; steps on {backend}; drawn at {} × {} by {} ({} {})\n{frames} frames of {:.2} ms, \
         {:.1} steps each\n{}",
        size.0,
        size.1,
        about.name,
        about.driver,
        about.driver_info,
        1e3 * (state.time - time) / all,
        (state.step - step) as f64 / all,
        times.table().trim_end(),
    )
}
