//! Pictures and films of what is seen that go into files: the window takes a picture each 1/25 s of the film, whatever
//! time on the wall that takes.

use crate::app::App;
use crate::camera::Orbit;
use crate::film::{Film, RATE};
use crate::scene3d::Scene3d;
use crate::settings::Settings;
use crate::stage;
use crate::surfaces::Scenery;
use sinew::driver::{Command, State};
use sinew_pictures::render::{Image, write_png};
use std::path::{Path, PathBuf};
use std::thread::JoinHandle;

/// A film that is being taken.
pub struct Recording {
    film: Film,
    scene3d: Scene3d,
    /// When the next picture is due (s), from picture to picture (s).
    due: f64,
    every: f64,
}

/// Films: one that is being taken, one that is being written.
#[derive(Default)]
pub struct Films {
    recording: Option<Recording>,
    writing: Option<JoinHandle<Result<String, String>>>,
}

/// How long a film of a whole scene lasts where speed has no bound (s).
const WHOLE: f64 = 10.0;

/// Simulated seconds from picture to picture of a film that shows a scene at a speed.
pub fn interval(state: &State, speed: f64) -> f64 {
    let duration = state.loaded.as_ref().map_or(0.0, |loaded| loaded.scene.scene.duration);
    if speed.is_finite() { speed / f64::from(RATE) } else { duration / (WHOLE * f64::from(RATE)) }
}

/// The steps to a time; one at least.
pub fn steps_to(due: f64, state: &State) -> u64 {
    ((due - state.time) / state.time_step).round().max(1.0) as u64
}

/// Whether a film ends with a state.
pub fn is_last(state: &State) -> bool {
    // pictures are half a step off at most
    let end = state.loaded.as_ref().map_or(0.0, |loaded| loaded.scene.scene.duration);
    let over = state.finished || (state.time_step > 0.0 && state.time + 0.5 * state.time_step >= end);
    over || state.breakdown.is_some() || state.refusal.is_some()
}

/// A picture of a state.
pub fn picture(
    scene3d: &mut Scene3d,
    scenery: &mut Scenery,
    (state, settings): (&State, &Settings),
    orbit: &Orbit,
) -> Option<Image> {
    let tissues = scenery.tissues.clone();
    let drawn = scenery.draw(state, settings);
    let size = scene3d.size();
    let camera = orbit.camera(glam::Vec2::new(size.0 as f32, size.1 as f32));
    stage::paint(scene3d, &drawn, &camera, (state, settings, &tissues), 1.0);
    scene3d.picture()
}

/// The first name `STEM_0001.ENDING`, `STEM_0002.ENDING` ... in a folder that no file has.
pub fn free_name(folder: &Path, stem: &str, ending: &str) -> PathBuf {
    let name = |number: u32| folder.join(format!("{stem}_{number:04}.{ending}"));
    (1..10_000).map(name).find(|path| !path.exists()).unwrap_or_else(|| name(0))
}

impl App {
    /// Writes the picture beside where the viewer was started.
    pub(crate) fn write_picture(&mut self) {
        let path = free_name(Path::new(""), &self.file_stem(), "png");
        self.news = Some(match self.picture.as_ref().and_then(|picture| picture.scene3d.picture()) {
            None => ("there is no picture without a graphics device; `sinew render` draws without one".into(), true),
            Some(image) => match write_png(&path, &image) {
                Ok(()) => (format!("wrote {}", path.display()), false),
                Err(error) => (error.to_string(), true),
            },
        });
    }

    /// Writes what is plotted beside where the viewer was started.
    pub(crate) fn write_table(&mut self) {
        let probes = self.state.loaded.iter().flat_map(|loaded| &loaded.probes);
        let table = self.traces.table(probes.map(|(name, numbers)| (name.as_str(), numbers.as_slice())));
        let path = free_name(Path::new(""), &self.file_stem(), "csv");
        self.news = Some(match std::fs::write(&path, table) {
            Ok(()) => (format!("wrote {}", path.display()), false),
            Err(error) => (format!("{}: {error}", path.display()), true),
        });
    }

    /// The device of the picture, and its size (pixels).
    fn screen(&self) -> Option<(wgpu::Device, wgpu::Queue, (u32, u32))> {
        let picture = self.picture.as_ref()?;
        Some((picture.screen.device.clone(), picture.screen.queue.clone(), picture.scene3d.size()))
    }

    /// What files that are written are called.
    fn file_stem(&self) -> String {
        let name = self.editor.as_ref().map(|editor| Path::new(&editor.name));
        let stem = name
            .or(self.files.path.as_deref())
            .and_then(|path| path.file_stem())
            .map(|stem| stem.to_string_lossy().into_owned());
        stem.filter(|stem| !stem.is_empty()).unwrap_or_else(|| "sinew".into())
    }

    /// How many pictures the film has that is being taken.
    pub(crate) fn pictures_taken(&self) -> Option<usize> {
        self.films.recording.as_ref().map(|recording| recording.film.count)
    }

    /// Begins a film whose file or folder has an ending: from where the simulation is to its end, or until it is asked
    /// to stop.
    pub(crate) fn begin_film(&mut self, ending: &str) {
        let name = self.file_stem();
        let path = match ending {
            "" => free_name(Path::new(""), &name, "film").with_extension(""),
            ending => free_name(Path::new(""), &name, ending),
        };
        let Some((device, queue, size)) = self.screen() else {
            self.news = Some(("there is no picture without a graphics device".into(), true));
            return;
        };
        match Film::begin(&path, size) {
            Err(text) => self.news = Some((text, true)),
            Ok(film) => {
                let scene3d = Scene3d::new(device, queue, film.size);
                let every = interval(&self.state, self.state.speed);
                self.source.send(Command::Pause);
                self.films.recording = Some(Recording { film, scene3d, due: self.state.time, every });
            }
        }
    }

    /// Ends the film that is being taken; it is written meanwhile.
    pub(crate) fn end_film(&mut self) {
        if let Some(recording) = self.films.recording.take() {
            self.news = Some(("writing the film".into(), false));
            self.films.writing = Some(std::thread::spawn(move || recording.film.end()));
        }
    }

    /// Takes the next picture when the simulation has come to its time, and sends it on.
    pub(crate) fn follow_film(&mut self, context: &egui::Context) {
        if let Some(written) = self.films.writing.take_if(|writing| writing.is_finished()) {
            self.news = Some(match written.join() {
                Ok(Ok(text)) => (text, false),
                Ok(Err(text)) => (text, true),
                Err(_) => ("the film was not written, by a mistake of sinew's own".into(), true),
            });
        }
        if self.films.recording.is_none() {
            return;
        }
        context.request_repaint();
        let newest = self.source.state().commands;
        if self.source.is_behind() || self.state.commands != newest {
            return;
        }
        let state = self.state.clone();
        let Some(recording) = &mut self.films.recording else { return };
        let seen = (&*state, &self.settings);
        let taken = match picture(&mut recording.scene3d, &mut self.scenery, seen, &self.orbit) {
            Some(image) => recording.film.add(&image),
            None => Err("the graphics device is lost".into()),
        };
        if let Err(text) = taken {
            self.films.recording = None;
            self.news = Some((text, true));
            return;
        }
        recording.due += recording.every;
        let steps = if self.source.finished().is_some() { 1 } else { steps_to(recording.due, &state) };
        match is_last(&state) {
            true => self.end_film(),
            false => self.source.send(Command::Step(steps)),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::free_name;

    #[test]
    fn no_picture_is_written_over() {
        let folder = tempfile::tempdir().unwrap();
        let first = free_name(folder.path(), "cube", "png");
        assert!(first.ends_with("cube_0001.png"));
        std::fs::write(first, "").unwrap();
        assert!(free_name(folder.path(), "cube", "png").ends_with("cube_0002.png"));
    }
}
