//! The viewer without a window: films, and how long frames take.

use crate::app::Start;
use crate::camera::Orbit;
use crate::film::Film;
use crate::films::{interval, is_last, picture, steps_to};
use crate::playback::{Playback, folder_of};
use crate::scene3d::Scene3d;
use crate::settings::Settings;
use crate::surfaces::Scenery;
use sinew::driver::{Command, Session, State};
use sinew::{Host, SceneFile};
use sinew_pictures::render::View;
use std::path::Path;
use std::sync::Arc;

/// Opens a graphics device without a window, with all that a simulation needs of it.
///
/// # Errors
/// That there is none, in words.
pub fn device() -> Result<Host, String> {
    let mut instance = wgpu::InstanceDescriptor::new_without_display_handle();
    instance.flags = wgpu::InstanceFlags::empty();
    let instance = wgpu::Instance::new(instance);
    let none = |reason: &dyn std::fmt::Display| {
        format!("no graphics device: {reason}; a Vulkan, Metal or DX12 driver is needed (Mesa's lavapipe will do)")
    };
    let wanted = wgpu::RequestAdapterOptions {
        power_preference: wgpu::PowerPreference::HighPerformance,
        ..wgpu::RequestAdapterOptions::default()
    };
    let adapter = pollster::block_on(instance.request_adapter(&wanted)).map_err(|error| none(&error))?;
    let opened = pollster::block_on(adapter.request_device(&Host::device_descriptor(&adapter)));
    let (device, queue) = opened.map_err(|error| none(&error))?;
    Ok(Host { adapter, device, queue })
}

/// Reads the scene that the viewer is to begin with.
///
/// # Errors
/// That none is named; what is wrong with it, in words.
pub fn scene(start: &Start) -> Result<SceneFile, String> {
    let path = start.scene.as_ref().ok_or("a scene is missing: sinew view SCENE --film FILE")?;
    SceneFile::load(path, &start.sets).map_err(|mistakes| mistakes.render(false))
}

/// Sees all of the first state from where its scene's picture is taken.
pub fn first_look(state: &State, scenery: &mut Scenery, settings: &Settings, size: (u32, u32)) -> Orbit {
    let view = state.loaded.as_ref().map(|loaded| View::from(&loaded.scene.scene.picture));
    let mut orbit = Orbit::of(&view.unwrap_or_else(|| View::upright(glam::Vec3::NEG_Y)));
    orbit.fit(&scenery.draw(state, settings).all, glam::Vec2::new(size.0 as f32, size.1 as f32));
    orbit
}

/// Films a scene from its start to its end, or a finished run; `speed`: simulated seconds a second of the film.
///
/// # Errors
/// What is wrong with the scene or the run; no graphics device; what cannot be written. In words.
pub fn film(start: &Start, to: &Path, size: (u32, u32), speed: f64) -> Result<String, String> {
    let host = device()?;
    let mut film = Film::begin(to, size)?;
    let mut scene3d = Scene3d::new(host.device, host.queue, film.size);
    let finished = start.scene.as_deref().and_then(folder_of);
    let mut scenery = Scenery::new(false, finished.clone());
    let mut orbit = None;
    let mut take = |state: &State| {
        scenery.follow(state);
        let look = || first_look(state, &mut scenery, &start.settings, film.size);
        let orbit = *orbit.get_or_insert_with(look);
        let image = picture(&mut scene3d, &mut scenery, (state, &start.settings), &orbit);
        film.add(&image.ok_or("the graphics device is lost")?)
    };
    let told = match finished {
        Some(folder) => of_run(&folder, start, &mut take)?,
        None => of_scene(start, speed, &mut take)?,
    };
    let written = film.end()?;
    Ok(match told {
        Some(told) => format!("{written}\n{told}"),
        None => written,
    })
}

/// Every frame of a finished run.
fn of_run(
    folder: &Path,
    start: &Start,
    take: &mut dyn FnMut(&State) -> Result<(), String>,
) -> Result<Option<String>, String> {
    let mut run = Playback::open(folder)?;
    run.send(Command::Field(start.settings.field));
    loop {
        let state: Arc<State> = run.state();
        if let Some(refusal) = &state.refusal {
            return Err(refusal.reason.clone());
        }
        take(&state)?;
        if state.finished {
            return Ok(None);
        }
        run.send(Command::Step(1));
    }
}

/// A scene while it runs; how it broke down, if it did.
fn of_scene(
    start: &Start,
    speed: f64,
    take: &mut dyn FnMut(&State) -> Result<(), String>,
) -> Result<Option<String>, String> {
    let scene = scene(start)?;
    let mut session = Session::new(start.options.clone());
    session.command(Command::Load(Box::new(scene)));
    if let Some(snapshot) = &start.resume {
        session.command(Command::Restore(snapshot.clone()));
    }
    session.command(Command::Field(start.settings.field));
    let mut due = session.state().time;
    loop {
        let state = session.state();
        if let Some(refusal) = &state.refusal {
            return Err(refusal.reason.clone());
        }
        take(&state)?;
        if is_last(&state) {
            return Ok(state.breakdown.map(|broken| broken.to_string()));
        }
        due += interval(&state, speed);
        session.command(Command::Step(steps_to(due, &state)));
    }
}
