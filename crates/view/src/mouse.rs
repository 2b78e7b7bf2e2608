//! What the mouse does in the picture.

use crate::app::App;
use egui::{PointerButton, Pos2, Rect, Response, Ui};
use glam::{Vec2, Vec3};
use sinew::Pick;
use sinew::driver::Command;

/// The hand of the mouse.
pub const HAND: u32 = 0;

/// What a drag that goes on does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drag {
    /// Turns the eye.
    Turn,
    /// Moves what is seen.
    Pan,
    /// Pulls at a body, if one was met.
    Grab(Option<Grip>),
}

/// What the mouse holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grip {
    /// Where it rests (m).
    pub rest: Vec3,
    /// Where it was when it was taken hold of (m).
    pub from: Vec3,
    /// How far away it was drawn then, along the line of sight (m).
    depth: f32,
}

/// Where the picture is on the screen.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// In points of the screen.
    pub rect: Rect,
    /// Pixels a point.
    pub scale: f32,
}

impl Frame {
    /// Width and height (pixels).
    pub fn size(&self) -> Vec2 {
        let size = (self.rect.size() * self.scale).max(egui::Vec2::splat(1.0)).round();
        Vec2::new(size.x, size.y)
    }

    /// The pixel at a point of the screen.
    pub fn pixel(&self, at: Pos2) -> Vec2 {
        let at = (at - self.rect.min) * self.scale;
        Vec2::new(at.x, at.y)
    }

    /// The point of the screen at a pixel.
    pub fn on_screen(&self, pixel: Vec2) -> Pos2 {
        self.rect.min + egui::vec2(pixel.x, pixel.y) / self.scale
    }
}

impl App {
    /// Does what the mouse asks for.
    pub(crate) fn mouse(&mut self, ui: &Ui, response: &Response, frame: &Frame) {
        let (modifiers, scroll, zoom, pressed) = ui.input(|input| {
            (input.modifiers, input.smooth_scroll_delta, input.zoom_delta(), input.pointer.press_origin())
        });
        if response.drag_started() {
            let first = response.drag_started_by(PointerButton::Primary);
            self.drag = Some(match () {
                () if first && (modifiers.ctrl || modifiers.command) => Drag::Grab(None),
                () if first && !modifiers.shift => Drag::Turn,
                () => Drag::Pan,
            });
            if let (Some(Drag::Grab(_)), Some(at)) = (self.drag, pressed.or(response.interact_pointer_pos())) {
                self.drag = Some(Drag::Grab(self.grab(at, frame)));
            }
        }
        let by = response.drag_delta();
        match self.drag {
            Some(Drag::Turn) => self.orbit.turn(Vec2::new(by.x, by.y)),
            Some(Drag::Pan) => self.orbit.pan(Vec2::new(by.x, by.y) * frame.scale, frame.size()),
            Some(Drag::Grab(Some(grip))) => self.pull(&grip, response, frame),
            Some(Drag::Grab(None)) | None => {}
        }
        let is_over =
            response.drag_stopped() || (self.drag.is_some() && !response.dragged() && !response.drag_started());
        if is_over && let Some(Drag::Grab(_)) = self.drag.take() {
            self.source.send(Command::Release { hand: HAND });
        }
        if response.hovered() {
            self.orbit.zoom((0.004 * scroll.y).exp() * zoom);
        }
        let at = response.interact_pointer_pos().or_else(|| ui.input(|input| input.pointer.interact_pos()));
        if let Some(at) = at.filter(|_| response.clicked()) {
            let pick = self.pick(at, frame).map(Box::new);
            self.source.send(Command::PickAt(pick));
        }
        if response.double_clicked() {
            self.to_fit = true;
        }
    }

    /// Takes hold of what is drawn at a point of the screen.
    fn grab(&mut self, at: Pos2, frame: &Frame) -> Option<Grip> {
        let pick = self.pick(at, frame)?;
        let body = self.state.loaded.as_ref()?.bodies.iter().find(|body| body.name == pick.body)?;
        let corner = |(node, weight): (&u32, f64)| {
            body.rest.get(*node as usize).map(|place| Vec3::from_array(*place) * weight as f32)
        };
        let rest: Vec3 = pick.nodes.iter().zip(pick.weights).filter_map(corner).sum();
        let from = pick.point.as_vec3();
        let depth = 1.0 / self.orbit.camera(frame.size()).project(self.settings.seen(rest, from)).z;
        self.source.send(Command::GrabAt { hand: HAND, pick: Box::new(pick) });
        (depth > 0.0).then_some(Grip { rest, from, depth })
    }

    /// Moves what the hand pulls towards below the mouse, as far away as what it took hold of was drawn. Where
    /// deformation is drawn enlarged, ways are so many times shorter than they look.
    fn pull(&mut self, grip: &Grip, response: &Response, frame: &Frame) {
        let camera = self.orbit.camera(frame.size());
        if let Some(at) = response.interact_pointer_pos() {
            let seen = camera.eye() + camera.ray(frame.pixel(at)) * grip.depth;
            let way = seen - self.settings.seen(grip.rest, grip.from);
            let target = grip.from + way / self.settings.deformation.max(1.0);
            self.source.send(Command::MoveGrab { hand: HAND, target: target.into() });
        }
    }

    /// What is drawn at a point of the screen.
    fn pick(&self, at: Pos2, frame: &Frame) -> Option<Pick> {
        let camera = self.orbit.camera(frame.size());
        self.scenery.pick(&self.state, &self.settings, camera.eye().into(), camera.ray(frame.pixel(at)).into())
    }
}
