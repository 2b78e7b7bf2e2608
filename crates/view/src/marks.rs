//! What is drawn over the picture: hands and their forces, supports, what was picked, the colour bar, the axes.

use crate::elements::find;
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
/// So many nodes of a body are marked; more would hide what they are of.
const MOST: usize = 4000;

const SET: Color32 = Color32::from_rgb(150, 70, 200);
const ARROW: Color32 = Color32::from_rgb(30, 150, 70);
const CRITICAL: Color32 = Color32::from_rgb(220, 40, 60);
/// So many arrows are drawn, the longest.
const MOST_ARROWS: usize = 1500;

/// Where a node is drawn, by where it rests and where it is.
fn seen(rest: [f32; 3], place: [f32; 3], settings: &Settings) -> Vec3 {
    settings.seen(Vec3::from_array(rest), Vec3::from_array(place))
}

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
    /// Where what the mouse holds rests (m).
    pub held: Option<Vec3>,
}

impl Marks<'_> {
    /// All of a state.
    pub fn draw(&self, state: &State, settings: &Settings, drawn: &Drawn<'_>) {
        if settings.nodes {
            self.nodes(state, settings);
        }
        if settings.supports {
            self.supports(state, settings);
        }
        if let Some(name) = &settings.set {
            self.set(state, settings, name);
        }
        if settings.arrows.is_some() && state.arrows == settings.arrows {
            self.arrows(state, settings, drawn.bodies.diagonal());
        }
        if settings.critical {
            self.critical(state, settings);
        }
        self.hands(state, settings);
        self.picked(state, settings);
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

    /// Of a body with more nodes than are marked every second one, or third, and so on.
    fn nodes(&self, state: &State, settings: &Settings) {
        let Some(loaded) = &state.loaded else { return };
        for (body, now) in loaded.bodies.iter().zip(&state.bodies) {
            let every = body.rest.len().div_ceil(MOST).max(1);
            for (rest, place) in body.rest.iter().zip(&now.positions).step_by(every) {
                if let Some(at) = self.at(seen(*rest, *place, settings)) {
                    self.painter.circle_filled(at, 1.5, self.colour);
                }
            }
        }
    }

    fn supports(&self, state: &State, settings: &Settings) {
        let Some(loaded) = &state.loaded else { return };
        for (body, now) in loaded.bodies.iter().zip(&state.bodies) {
            let held = body.constrained.iter().zip(&now.positions).zip(&body.rest).filter(|((axes, _), _)| **axes != 0);
            for ((axes, place), rest) in held.take(MOST) {
                let Some(at) = self.at(seen(*rest, *place, settings)) else { continue };
                // fixed along all axes, or along some
                let fill = if *axes == 7 { SUPPORT } else { Color32::TRANSPARENT };
                self.painter.circle(at, 2.5, fill, Stroke::new(1.0, SUPPORT));
            }
        }
    }

    /// The nodes of a set of the mesh.
    fn set(&self, state: &State, settings: &Settings, name: &str) {
        let Some(loaded) = &state.loaded else { return };
        for (body, now) in loaded.bodies.iter().zip(&state.bodies) {
            for node in body.sets.get(name).into_iter().flatten().take(MOST) {
                let (rest, place) = (body.rest.get(*node as usize), now.positions.get(*node as usize));
                let at = rest.zip(place).and_then(|(rest, place)| self.at(seen(*rest, *place, settings)));
                if let Some(at) = at {
                    self.painter.circle_filled(at, 2.5, SET);
                }
            }
        }
    }

    /// The longest vectors of a field, the longest of them an eighth of the bodies' diagonal (m) long.
    fn arrows(&self, state: &State, settings: &Settings, diagonal: f32) {
        let Some(loaded) = &state.loaded else { return };
        let mut all: Vec<(Vec3, Vec3)> = Vec::new();
        for (body, now) in loaded.bodies.iter().zip(&state.bodies) {
            let known = body.rest.iter().zip(&now.positions).zip(&now.arrows);
            let known = known.map(|((rest, place), arrow)| (seen(*rest, *place, settings), Vec3::from_array(*arrow)));
            all.extend(known.filter(|(_, arrow)| arrow.is_finite() && *arrow != Vec3::ZERO));
        }
        all.sort_by(|a, b| b.1.length_squared().total_cmp(&a.1.length_squared()));
        let Some(longest) = all.first().map(|(_, arrow)| arrow.length()) else { return };
        for (place, arrow) in all.into_iter().take(MOST_ARROWS) {
            let end = place + arrow * (diagonal / (8.0 * longest));
            let (Some(from), Some(to)) = (self.at(place), self.at(end)) else { continue };
            self.painter.circle_filled(from, 2.0, ARROW);
            if from.distance(to) > 3.0 {
                self.painter.arrow(from, to - from, Stroke::new(1.5, ARROW));
            }
        }
        let unit = settings.arrows.map_or("", |field| field.unit());
        let text = format!("longest arrow: {} {unit}", number(f64::from(longest)));
        let at = self.frame.rect.left_top() + vec2(14.0, 14.0);
        self.painter.text(at, Align2::LEFT_TOP, text, FontId::proportional(13.0), self.colour);
    }

    /// The elements that set the stable step, the first the largest.
    fn critical(&self, state: &State, settings: &Settings) {
        let critical = state.loaded.iter().flat_map(|loaded| &loaded.critical).enumerate();
        for (number, critical) in critical {
            let found = find(state, &critical.body, critical.element);
            let Some(at) = found.and_then(|found| self.at(settings.seen(found.rest, found.place))) else { continue };
            self.painter.circle_stroke(at, if number == 0 { 9.0 } else { 6.0 }, Stroke::new(2.0, CRITICAL));
            let text = (number + 1).to_string();
            self.painter.text(at + vec2(9.0, -9.0), Align2::LEFT_BOTTOM, text, FontId::proportional(12.0), CRITICAL);
        }
    }

    fn hands(&self, state: &State, settings: &Settings) {
        for held in &state.held {
            let drawn = |place: Vec3| self.held.map_or(place, |rest| settings.seen(rest, place));
            let ends = [held.point, held.target].map(|place| self.at(drawn(place.as_vec3())));
            let [Some(from), Some(to)] = ends else { continue };
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

    fn picked(&self, state: &State, settings: &Settings) {
        let place = state.picked.as_ref().and_then(|picked| {
            let loaded = state.loaded.as_ref()?;
            let number = loaded.bodies.iter().position(|body| body.name == picked.pick.body)?;
            let (body, now) = (loaded.bodies.get(number)?, state.bodies.get(number)?);
            let [a, b, c] = picked.pick.nodes.map(|node| {
                let node = node as usize;
                Some(seen(*body.rest.get(node)?, *now.positions.get(node)?, settings))
            });
            let weights = picked.pick.weights.map(|weight| weight as f32);
            Some(a? * weights[0] + b? * weights[1] + c? * weights[2])
        });
        if let Some(at) = place.and_then(|place| self.at(place)) {
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
