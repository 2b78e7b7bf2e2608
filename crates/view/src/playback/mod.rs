//! A finished run, as `sinew run` has written it, seen as if it ran: states by their times.

mod frames;
mod pick;
mod tables;

use frames::Frames;
use glam::{DQuat, DVec3};
use sinew::SceneFile;
use sinew::driver::{Command, Loaded, Picked, Refusal, State, ToolState};
use sinew::observation::ToolReading;
use sinew::scene::schema::OutputField;
use sinew_pictures::render::Tools;
use std::path::{Path, PathBuf};
use std::sync::Arc;
pub use tables::Curves;
use web_time::Instant;

/// The scene of a run in its folder.
const SCENE: &str = "scene.ron";

/// A finished run.
pub struct Playback {
    frames: Frames,
    loaded: Arc<Loaded>,
    tools: Tools,
    /// What plots show.
    pub curves: Curves,
    state: Arc<State>,
    row: usize,
    running: bool,
    speed: f64,
    /// When it was started, and at which time of the run (s).
    since: (Instant, f64),
    field: Option<OutputField>,
    arrows: Option<OutputField>,
    picked: Option<Picked>,
    refusal: Option<Refusal>,
    commands: u64,
}

/// The folder of a run, of what a user names: the folder, or a file of it.
pub fn folder_of(path: &Path) -> Option<PathBuf> {
    match path.file_name().and_then(|name| name.to_str()) {
        _ if path.is_dir() => Some(path.to_path_buf()),
        Some(sinew::output::FIELDS | "sinew.json" | "summary.json") => path.parent().map(Path::to_path_buf),
        _ => None,
    }
}

impl Playback {
    /// Opens an output folder.
    ///
    /// # Errors
    /// What is missing, damaged or not a run, in words.
    pub fn open(folder: &Path) -> Result<Self, String> {
        let at = |error: &dyn std::fmt::Display| format!("{}: {error}", folder.display());
        if !folder.join("sinew.json").exists() {
            return Err(at(&"no output folder of sinew (it has no sinew.json): name what sinew run -o has written"));
        }
        let scene = SceneFile::load(folder.join(SCENE), &[])
            .map_err(|mistakes| at(&format!("its {SCENE} cannot be read\n{}", mistakes.render(false))))?;
        let names = |all: Vec<&String>| all.into_iter().cloned().collect::<Vec<_>>();
        let bodies = names(scene.scene.bodies.keys().collect());
        let materials = names(scene.scene.materials.keys().collect());
        let (frames, bodies) = Frames::open(folder, &bodies, &materials).map_err(|error| at(&error))?;
        let (tools, _) = Tools::of_scene(&scene, folder);
        let (curves, probes) = Curves::read(folder, scene.scene.probes.keys());
        let still = "the run did not write displacements (output.fields): bodies are seen where they rest";
        let loaded = Loaded {
            number: 0,
            backend: format!("a finished run, {} frames", frames.series.frames.len()),
            scene,
            bodies,
            probes,
            critical: Vec::new(),
            warnings: if frames.moves { Vec::new() } else { vec![still.into()] },
        };
        let mut playback = Self {
            frames,
            loaded: Arc::new(loaded),
            tools,
            curves,
            state: Arc::default(),
            row: 0,
            running: false,
            speed: 1.0,
            since: (Instant::now(), 0.0),
            field: None,
            arrows: None,
            picked: None,
            refusal: None,
            commands: 0,
        };
        playback.read(0);
        match playback.refusal.take() {
            Some(refusal) => Err(at(&refusal.reason)),
            None => Ok(playback),
        }
    }

    /// The times of its frames (s).
    pub fn times(&self) -> impl ExactSizeIterator<Item = f64> + '_ {
        self.frames.series.frames.iter().map(|frame| frame.0)
    }

    /// Does what a command asks as far as a run that is over can: it goes to other times, and shows other fields.
    pub fn send(&mut self, command: Command) {
        self.commands += 1;
        self.refusal = None;
        let last = self.frames.series.frames.len() - 1;
        let mut row = self.row;
        match command {
            Command::Run => {
                row = if row == last { 0 } else { row };
                self.running = true;
            }
            Command::Pause => self.running = false,
            Command::Step(count) => {
                self.running = false;
                row = row.saturating_add(usize::try_from(count).unwrap_or(last)).min(last);
            }
            Command::Reset => row = 0,
            Command::Rewind(time) => row = self.frames.series.nearest(Some(time)),
            Command::Speed(speed) if speed > 0.0 => self.speed = speed,
            Command::Field(field) => self.field = field,
            Command::Arrows(field) => self.arrows = field,
            Command::PickAt(picked) => {
                self.picked = picked.and_then(|picked| pick::about(&self.loaded.bodies, *picked));
            }
            Command::Release { .. } | Command::MoveGrab { .. } | Command::Lend(_) => {}
            _ => {
                let reason = "this run is over: it can be looked at. Open its scene to pull at it and change it";
                self.refusal = Some(Refusal::new("run", reason));
            }
        }
        self.read(row);
    }

    /// The state at the time that it has come to.
    pub fn state(&mut self) -> Arc<State> {
        if self.running {
            let passed = self.since.0.elapsed().as_secs_f64() * self.speed;
            let row = match self.speed.is_finite() {
                true => self.frames.series.frames.partition_point(|frame| frame.0 <= self.since.1 + passed).max(1) - 1,
                false => self.row + 1,
            };
            let last = self.frames.series.frames.len() - 1;
            if row != self.row {
                let since = self.since;
                self.running = row < last;
                self.read(row.min(last));
                self.since = since;
            }
        }
        self.state.clone()
    }

    /// Goes to a frame; what is wrong with it is told.
    fn read(&mut self, row: usize) {
        let time = self.frames.series.frames[row].0;
        let read = self.frames.read(row, &self.loaded.bodies, self.field, self.arrows);
        let bodies = match read {
            Ok(bodies) => bodies,
            Err(error) => {
                self.running = false;
                self.refusal = Some(Refusal::new("run", error.to_string()));
                self.state.bodies.clone()
            }
        };
        let lacks = |field: OutputField| {
            let named = "its scene's output.fields names what is written";
            Refusal::new("field", format!("the run did not write {}: {named}", field.array()))
        };
        let has_none = |of: &dyn Fn(&sinew::driver::BodyState) -> bool| bodies.iter().all(of);
        if let Some(field) = self.field.filter(|_| has_none(&|body| body.values.is_empty())) {
            self.refusal = Some(lacks(field));
        } else if let Some(field) = self.arrows.filter(|_| has_none(&|body| body.arrows.is_empty())) {
            self.refusal = Some(lacks(field));
        }
        self.row = row;
        self.since = (Instant::now(), time);
        let tool = |(name, place, rotation): (String, DVec3, DQuat)| ToolState {
            name,
            place,
            rotation,
            felt: ToolReading::default(),
        };
        self.state = Arc::new(State {
            loaded: Some(self.loaded.clone()),
            bodies,
            field: self.field,
            arrows: self.arrows,
            time,
            time_step: 0.0,
            step: row as u64,
            running: self.running,
            finished: row + 1 == self.frames.series.frames.len(),
            speed: self.speed,
            real_time_factor: self.running.then_some(self.speed).filter(|speed| speed.is_finite()),
            measured: time,
            tools: self.tools.poses(row, time).into_iter().map(tool).collect(),
            picked: self.picked.clone(),
            refusal: self.refusal.clone(),
            commands: self.commands,
            ..State::default()
        });
    }
}
