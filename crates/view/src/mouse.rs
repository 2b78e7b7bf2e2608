//! What the mouse does in the picture.

use crate::app::App;
use egui::{PointerButton, Pos2, Rect, Response, Ui};
use glam::{DVec3, Vec2};
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
    /// Pulls at a body; how far away that is along the line of sight (m), once it is held.
    Grab(Option<f32>),
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
                let (origin, direction) = self.ray(at, frame);
                self.source.send(Command::Grab { hand: HAND, origin, direction });
            }
        }
        let by = response.drag_delta();
        match self.drag {
            Some(Drag::Turn) => self.orbit.turn(Vec2::new(by.x, by.y)),
            Some(Drag::Pan) => self.orbit.pan(Vec2::new(by.x, by.y) * frame.scale, frame.size()),
            Some(Drag::Grab(depth)) => self.pull(depth, response, frame),
            None => {}
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
            let (origin, direction) = self.ray(at, frame);
            self.source.send(Command::Pick { origin, direction });
        }
        if response.double_clicked() {
            self.to_fit = true;
        }
    }

    /// Moves what the hand pulls towards below the mouse, as far away as what it took hold of.
    fn pull(&mut self, depth: Option<f32>, response: &Response, frame: &Frame) {
        let camera = self.orbit.camera(frame.size());
        let depth = depth.or_else(|| {
            let held = self.state.held.iter().find(|held| held.hand == HAND)?;
            Some(1.0 / camera.project(held.point.as_vec3()).z).filter(|depth| *depth > 0.0)
        });
        self.drag = Some(Drag::Grab(depth));
        if let (Some(depth), Some(at)) = (depth, response.interact_pointer_pos()) {
            let target = camera.eye() + camera.ray(frame.pixel(at)) * depth;
            self.source.send(Command::MoveGrab { hand: HAND, target: target.into() });
        }
    }

    /// From the eye through a point of the screen.
    fn ray(&self, at: Pos2, frame: &Frame) -> (DVec3, DVec3) {
        let camera = self.orbit.camera(frame.size());
        (camera.eye().into(), camera.ray(frame.pixel(at)).into())
    }
}
