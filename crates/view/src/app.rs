//! The viewer: a driver, what is seen of it, and what the user asks for.

use crate::camera::Orbit;
use crate::editor::{Bundle, Editor};
use crate::files::{Files, Opened};
use crate::films::Films;
use crate::marks::Marks;
use crate::mouse::{Drag, Frame};
use crate::panels::{KEYS, Values};
use crate::playback::Playback;
use crate::scene3d::Scene3d;
use crate::settings::Settings;
use crate::shot::Shot;
use crate::source::{Source, Steps};
use crate::stage;
use crate::surfaces::Scenery;
use crate::traces::Traces;
use eframe::egui_wgpu::RenderState;
use egui::{CentralPanel, Color32, Key, Rect, Sense, Ui, pos2};
use glam::Vec3;
use sinew::driver::{Command, State};
use sinew::scene::schema::OutputField;
use sinew::{Options, Snapshot};
use sinew_pictures::render::View;
use std::path::PathBuf;
use std::sync::Arc;

/// What the viewer begins with.
#[derive(Clone, Debug, Default)]
pub struct Start {
    /// The scene's file; one can be dropped later.
    pub scene: Option<PathBuf>,
    /// Values put into it, as by `--set`.
    pub sets: Vec<String>,
    /// A state of the scene that it begins with.
    pub resume: Option<Box<Snapshot>>,
    /// How it runs.
    pub options: Options,
    /// Whether it runs at once.
    pub run: bool,
    /// What is seen at first.
    pub settings: Settings,
    /// A picture of the window that is to be taken.
    pub shot: Option<Shot>,
    /// Scenes and files in memory, in place of a disk, whose text is edited in the window; `scene` is then the name of
    /// one of them, and the simulation runs in the window's frames.
    pub bundle: Option<Bundle>,
}

/// The viewer.
pub struct App {
    pub(crate) source: Source,
    pub(crate) state: Arc<State>,
    pub(crate) settings: Settings,
    pub(crate) orbit: Orbit,
    pub(crate) scenery: Scenery,
    pub(crate) traces: Traces,
    pub(crate) drag: Option<Drag>,
    /// All is to be seen in the next picture.
    pub(crate) to_fit: bool,
    /// What is told, and whether it is bad.
    pub(crate) news: Option<(String, bool)>,
    pub(crate) last_field: Option<OutputField>,
    /// Values at the ends of the colours in the last picture.
    pub(crate) seen_range: (f32, f32),
    pub(crate) shows_keys: bool,
    pub(crate) shows_plots: bool,
    pub(crate) wants_picture: bool,
    /// The numbers of the scene.
    pub(crate) values: Values,
    pub(crate) films: Films,
    pub(crate) files: Files,
    /// The text of the scene, where there is no disk.
    pub(crate) editor: Option<Editor>,
    pub(crate) shows_editor: bool,
    /// How simulations run.
    options: Options,
    context: egui::Context,
    pub(crate) picture: Option<Picture>,
    /// The field and the arrows that were asked for.
    asked: [Option<OutputField>; 2],
    /// Whether the camera has gone to where it broke down.
    been_there: bool,
    shot: Option<Shot>,
}

/// The picture on the screen's device.
pub(crate) struct Picture {
    pub(crate) screen: RenderState,
    pub(crate) scene3d: Scene3d,
    texture: egui::TextureId,
}

impl App {
    /// Starts; without a device (`screen`) all is there but the picture.
    pub fn new(context: &egui::Context, start: Start, screen: Option<RenderState>) -> Self {
        let name = start.scene.as_ref().map(|path| path.display().to_string());
        let editor = start.bundle.map(|bundle| Editor::new(bundle, name.as_deref()));
        let mut source = match editor {
            Some(_) => Source::framed(&start.options, context),
            None => Source::live(&start.options, context),
        };
        let lends = start.options.host.is_some();
        if lends {
            source.send(Command::Lend(true));
        }
        let picture = screen.map(|screen| {
            let scene3d = Scene3d::new(screen.device.clone(), screen.queue.clone(), (1, 1));
            let filter = wgpu::FilterMode::Linear;
            let texture = screen.renderer.write().register_native_texture(&screen.device, scene3d.texture(), filter);
            Picture { screen, scene3d, texture }
        });
        let mut app = Self {
            state: source.state(),
            source,
            settings: start.settings,
            orbit: Orbit::of(&View::upright(Vec3::new(1.0, -2.0, 0.8))),
            scenery: Scenery::new(lends, None),
            traces: Traces::default(),
            drag: None,
            to_fit: true,
            news: None,
            last_field: None,
            seen_range: (0.0, 1.0),
            shows_keys: false,
            shows_plots: false,
            wants_picture: false,
            values: Values::default(),
            films: Films::default(),
            files: Files::new(start.scene, start.sets),
            editor,
            shows_editor: true,
            options: start.options,
            context: context.clone(),
            picture,
            asked: [None; 2],
            been_there: false,
            shot: start.shot,
        };
        app.read_scene();
        if let Some(snapshot) = start.resume {
            app.source.send(Command::Restore(snapshot));
        }
        if start.run {
            app.source.send(Command::Run);
        }
        app
    }

    /// Starts in a window, or on the canvas of a page.
    pub fn on_screen(context: &eframe::CreationContext<'_>, start: Start) -> Self {
        Self::new(&context.egui_ctx, start, context.wgpu_render_state.clone())
    }

    /// The newest state that was drawn.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// What is seen and how.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Shows all of it.
    pub fn show(&mut self, ui: &mut Ui) {
        self.read_scene();
        self.source.frame();
        self.state = self.source.state();
        let is_behind = self.source.is_behind();
        if let Some(editor) = self.editor.as_mut().filter(|_| !is_behind) {
            let refusal = self.state.refusal.as_ref().filter(|refusal| refusal.command == "load");
            editor.note_refusal(refusal.map_or(&[], |refusal| &refusal.mistakes));
        }
        if self.scenery.follow(&self.state) {
            self.begin();
        }
        if self.source.finished().is_none() {
            self.traces.note(&self.state);
        }
        ui.ctx().set_visuals(if self.settings.dark { egui::Visuals::dark() } else { egui::Visuals::light() });
        for file in ui.input(|input| input.raw.dropped_files.clone()) {
            match &self.editor {
                Some(editor) => editor.drop_file(&file, ui.ctx()),
                None => self.files.open(file.path().to_path_buf()),
            }
        }
        self.keys(ui);
        self.panels(ui);
        CentralPanel::default().frame(egui::Frame::NONE).show(ui, |ui| self.picture(ui));
        let wanted = [self.settings.field, self.settings.arrows];
        if wanted != self.asked {
            self.asked = wanted;
            self.source.send(Command::Field(wanted[0]));
            self.source.send(Command::Arrows(wanted[1]));
        }
        self.follow_film(ui.ctx());
        if self.state.breakdown.is_none() {
            self.been_there = false;
        } else if !self.been_there {
            self.been_there = true;
            self.go_to_breakdown();
        }
        if let Some(shot) = &mut self.shot {
            shot.follow(ui);
        }
        // to see whether the file has changed
        ui.ctx().request_repaint_after(std::time::Duration::from_millis(500));
    }

    fn read_scene(&mut self) {
        if let Some(editor) = &mut self.editor {
            if let Some(told) = editor.take_dropped() {
                let bad = told.is_err();
                self.news = Some((told.unwrap_or_else(|why| why), bad));
            }
            if let Some(scene) = editor.take_scene() {
                self.source.send(Command::Load(scene));
            }
            return;
        }
        match self.files.poll() {
            Some(Ok(Opened::Scene(scene))) => {
                self.news = None;
                if self.source.finished().is_some() {
                    self.go_over(Source::live(&self.options, &self.context));
                }
                self.source.send(Command::Load(scene));
            }
            Some(Ok(Opened::Run(folder))) => match Playback::open(&folder) {
                Ok(run) => {
                    self.news = None;
                    self.go_over(Source::Finished(Box::new(run)));
                    self.scenery.folder = Some(folder);
                }
                Err(text) => self.news = Some((text, true)),
            },
            Some(Err(mistakes)) => self.news = Some((mistakes, true)),
            None => {}
        }
    }

    /// Goes over to where other states come from.
    fn go_over(&mut self, source: Source) {
        let lends = self.options.host.is_some();
        self.source = source;
        if lends && self.source.finished().is_none() {
            self.source.send(Command::Lend(true));
        }
        self.scenery = Scenery::new(lends, None);
        (self.traces, self.values, self.asked) = (Traces::default(), Values::default(), [None; 2]);
    }

    /// The frames in which the simulation takes its steps, to be taken by the caller from now on and not by those of
    /// the window; none where it has a thread of its own.
    pub fn steps(&self) -> Option<Steps> {
        self.source.take_over()
    }

    /// Begins with a scene: the first one is seen as its picture would be.
    fn begin(&mut self) {
        let Some(loaded) = &self.state.loaded else { return };
        if loaded.number == 0 {
            self.orbit = Orbit::of(&View::from(&loaded.scene.scene.picture));
            self.to_fit = true;
        }
    }

    pub(crate) fn run_or_pause(&mut self) {
        self.source.send(if self.state.running { Command::Pause } else { Command::Run });
    }

    fn keys(&mut self, ui: &Ui) {
        if !self.settings.keys || ui.ctx().text_edit_focused() {
            return;
        }
        let (pressed, shift) = ui.input(|input| {
            let pressed: Vec<Key> = KEYS.iter().map(|key| key.0).filter(|key| input.key_pressed(*key)).collect();
            (if input.modifiers.ctrl { Vec::new() } else { pressed }, input.modifiers.shift)
        });
        let settings = &mut self.settings;
        for key in pressed {
            match key {
                Key::Space => self.source.send(if self.state.running { Command::Pause } else { Command::Run }),
                Key::ArrowRight => self.source.send(Command::Step(if shift { 100 } else { 1 })),
                Key::R => self.source.send(Command::Reset),
                Key::F => self.to_fit = true,
                Key::W => settings.wireframe = !settings.wireframe,
                Key::G => settings.ghost = !settings.ghost,
                Key::C => settings.cut = !settings.cut,
                Key::N => settings.nodes = !settings.nodes,
                Key::S => settings.supports = !settings.supports,
                Key::D => settings.dark = !settings.dark,
                Key::L => {
                    settings.arrows = if settings.arrows.is_some() { None } else { Some(OutputField::ExternalForce) }
                }
                Key::P => self.wants_picture = true,
                Key::T if settings.field.is_some() => settings.field = None,
                Key::T => settings.field = self.last_field.or(Some(OutputField::VonMises)),
                _ => self.shows_keys = !self.shows_keys,
            }
        }
    }

    /// The picture, and what the mouse does in it.
    fn picture(&mut self, ui: &mut Ui) {
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, "Picture of the scene"));
        let frame = Frame { rect, scale: ui.ctx().pixels_per_point() };
        self.mouse(ui, &response, &frame);
        let tissues = self.scenery.tissues.clone();
        let drawn = self.scenery.draw(&self.state, &self.settings);
        self.seen_range = drawn.scale.range;
        if self.to_fit && !drawn.all.is_nothing() {
            self.orbit.fit(&drawn.all, frame.size());
            self.to_fit = false;
        }
        let camera = self.orbit.camera(frame.size());
        let painter = ui.painter_at(rect);
        if let Some(picture) = &mut self.picture {
            picture.resize(frame.size());
            let seen = (&*self.state, &self.settings, &tissues[..]);
            stage::paint(&mut picture.scene3d, &drawn, &camera, seen, frame.scale);
            let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            painter.image(picture.texture, rect, whole, Color32::WHITE);
        }
        let colour = ui.visuals().strong_text_color();
        let held = if let Some(Drag::Grab(grip)) = self.drag { grip.map(|grip| grip.rest) } else { None };
        Marks { painter: &painter, frame, camera: &camera, colour, held }.draw(&self.state, &self.settings, &drawn);
        drop(drawn);
        if std::mem::take(&mut self.wants_picture) {
            self.write_picture();
        }
    }

    /// What is wrong with the text that is edited in the window: file, line, column and a sentence each.
    pub fn mistakes(&self) -> Vec<String> {
        self.editor.iter().flat_map(|editor| &editor.mistakes).map(|mistake| mistake.line.clone()).collect()
    }

    /// What draws the picture: name and interface of the device; empty without one.
    pub fn drawn_by(&self) -> String {
        self.picture.as_ref().map_or_else(String::new, |picture| {
            let about = picture.screen.device.adapter_info();
            format!("{} ({:?})", about.name, about.backend).trim().into()
        })
    }
}

impl Picture {
    /// Goes over to a size (pixels).
    fn resize(&mut self, size: glam::Vec2) {
        if self.scene3d.resize((size.x as u32, size.y as u32)) {
            let mut renderer = self.screen.renderer.write();
            let filter = wgpu::FilterMode::Linear;
            let (device, texture) = (&self.screen.device, self.scene3d.texture());
            renderer.update_egui_texture_from_wgpu_texture(device, texture, filter, self.texture);
        }
    }
}

impl eframe::App for App {
    fn ui(&mut self, ui: &mut Ui, _: &mut eframe::Frame) {
        self.show(ui);
    }

    /// So that a page reaches what it has begun.
    #[cfg(target_arch = "wasm32")]
    fn as_any_mut(&mut self) -> Option<&mut dyn std::any::Any> {
        Some(self)
    }
}
