//! What is drawn over the picture: hands and their forces, supports, what was picked, the colour bar, the axes.

use crate::mouse::Frame;
use crate::panels::number;
use crate::settings::{Settings, about, components, title};
use crate::surfaces::Drawn;
use egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Stroke, pos2, vec2};
use glam::Vec3;
use sinew::driver::State;
use sinew_pictures::render::{Camera, Scale};

const HAND: Color32 = Color32::from_rgb(255, 176, 32);
const PICKED: Color32 = Color32::from_rgb(40, 190, 255);
const SUPPORT: Color32 = Color32::from_rgb(36, 120, 210);
/// So many supports are marked; more would hide what they hold.
const MOST: usize = 4000;

/// Draws over a picture.
pub struct Marks<'a> {
    /// Where.
    pub painter: &'a Painter,
    /// The picture.
    pub frame: Frame,
    /// Its camera.
    pub camera: &'a Camera,
    /// Of letters.
    pub colour: Color32,
}

impl Marks<'_> {
    /// All of a state.
    pub fn draw(&self, state: &State, settings: &Settings, drawn: &Drawn<'_>) {
        if settings.supports {
            self.supports(state, settings);
        }
        self.hands(state);
        self.picked(state);
        self.axes();
        if let Some(field) = state.field.filter(|field| settings.field == Some(*field)) {
            let part = components(field).get(settings.component).filter(|part| **part != "length");
            let name = part.map_or_else(|| title(field), |part| format!("{} {part}", title(field)));
            self.colour_bar(&drawn.scale, &name, about(field, settings.component).unit);
        }
    }

    /// Where a point is on the screen, if it is before the eye.
    fn at(&self, point: Vec3) -> Option<Pos2> {
        let seen = self.camera.project(point);
        (seen.is_finite() && seen.z > 0.0).then(|| self.frame.on_screen(seen.truncate()))
    }

    fn supports(&self, state: &State, settings: &Settings) {
        let Some(loaded) = &state.loaded else { return };
        for (body, now) in loaded.bodies.iter().zip(&state.bodies) {
            let held = body.constrained.iter().zip(&now.positions).zip(&body.rest).filter(|((axes, _), _)| **axes != 0);
            for ((axes, place), rest) in held.take(MOST) {
                let rest = Vec3::from_array(*rest);
                let place = rest + (Vec3::from_array(*place) - rest) * settings.deformation;
                let Some(at) = self.at(place) else { continue };
                // fixed along all axes, or along some
                let fill = if *axes == 7 { SUPPORT } else { Color32::TRANSPARENT };
                self.painter.circle(at, 2.5, fill, Stroke::new(1.0, SUPPORT));
            }
        }
    }

    fn hands(&self, state: &State) {
        for held in &state.held {
            let (Some(from), Some(to)) = (self.at(held.point.as_vec3()), self.at(held.target.as_vec3())) else {
                continue;
            };
            let way = to - from;
            let across = vec2(-way.y, way.x).normalized() * 4.0;
            // a spring
            let turns = 12;
            let coil = |turn: i32| {
                let side = if turn == 0 || turn == turns { 0.0 } else { f32::from(i8::from(turn % 2 == 1) * 2 - 1) };
                from + way * (turn as f32 / turns as f32) + across * side
            };
            self.painter.line((0..=turns).map(coil).collect(), Stroke::new(2.0, HAND));
            self.painter.circle_filled(from, 4.0, HAND);
            self.painter.circle_stroke(to, 5.0, Stroke::new(2.0, HAND));
            self.label(to + vec2(10.0, -10.0), &format!("{} N", number(held.force.length())));
        }
    }

    fn picked(&self, state: &State) {
        let node = state.picked.as_ref().and_then(|picked| {
            let loaded = state.loaded.as_ref()?;
            let number = loaded.bodies.iter().position(|body| body.name == picked.pick.body)?;
            let corners = picked.pick.nodes.map(|node| state.bodies.get(number)?.positions.get(node as usize));
            let [a, b, c] = corners.map(|place| place.map(|place| Vec3::from_array(*place)));
            let weights = picked.pick.weights.map(|weight| weight as f32);
            Some(a? * weights[0] + b? * weights[1] + c? * weights[2])
        });
        if let Some(at) = node.and_then(|place| self.at(place)) {
            self.painter.circle_stroke(at, 6.0, Stroke::new(2.5, PICKED));
            self.painter.circle_filled(at, 2.0, PICKED);
        }
    }

    fn axes(&self) {
        let origin = self.frame.rect.left_bottom() + vec2(38.0, -38.0);
        let mut axes = [(Vec3::X, "x", (214, 60, 60)), (Vec3::Y, "y", (56, 150, 56)), (Vec3::Z, "z", (60, 100, 220))];
        // what points away is drawn first
        axes.sort_by(|a, b| self.camera.turn(a.0).z.total_cmp(&self.camera.turn(b.0).z));
        for (axis, name, (r, g, b)) in axes {
            let seen = self.camera.turn(axis) * 24.0;
            let tip = origin + vec2(seen.x, -seen.y);
            let colour = Color32::from_rgb(r, g, b);
            self.painter.line_segment([origin, tip], Stroke::new(2.0, colour));
            self.painter.text(
                tip + (tip - origin) * 0.3,
                Align2::CENTER_CENTER,
                name,
                FontId::proportional(12.0),
                colour,
            );
        }
    }

    fn colour_bar(&self, scale: &Scale, name: &str, unit: &str) {
        let rect = self.frame.rect;
        let height = (rect.height() * 0.5).clamp(60.0, 320.0);
        let bar = Rect::from_min_size(pos2(rect.right() - 92.0, rect.top() + 40.0), vec2(16.0, height));
        let (low, high) = scale.range;
        let steps = 128;
        for step in 0..steps {
            let share = (step as f32 + 0.5) / steps as f32;
            let [r, g, b] = (scale.srgb(high + (low - high) * share) * 255.0).to_array().map(|part| part as u8);
            let top = bar.top() + height * step as f32 / steps as f32;
            let strip = Rect::from_min_size(pos2(bar.left(), top), vec2(16.0, height / steps as f32 + 0.7));
            self.painter.rect_filled(strip, 0.0, Color32::from_rgb(r, g, b));
        }
        for tick in 0..=4 {
            let share = tick as f32 / 4.0;
            let at = pos2(bar.right() + 6.0, bar.bottom() - height * share);
            let text = number(f64::from(low + (high - low) * share));
            self.painter.text(at, Align2::LEFT_CENTER, text, FontId::proportional(12.0), self.colour);
        }
        let head = if unit.is_empty() { name.to_string() } else { format!("{name} ({unit})") };
        let at = pos2(rect.right() - 12.0, rect.top() + 20.0);
        self.painter.text(at, Align2::RIGHT_CENTER, head, FontId::proportional(13.0), self.colour);
    }

    /// Letters that can be read on anything.
    fn label(&self, at: Pos2, text: &str) {
        let font = FontId::proportional(15.0);
        let galley = self.painter.layout_no_wrap(text.into(), font, Color32::BLACK);
        let rect = Rect::from_min_size(at - vec2(0.0, galley.size().y), galley.size()).expand(3.0);
        self.painter.rect_filled(rect, 3.0, HAND);
        self.painter.galley(rect.min + vec2(3.0, 3.0), galley, Color32::BLACK);
    }
}
