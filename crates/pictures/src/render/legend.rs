//! The colour bar with its numbers, the time, what surfaces mean, and the axes.

use super::RenderError;
use super::camera::Camera;
use super::colour;
use super::image::Image;
use super::light::Light;
use super::picture::Picture;
use crate::plot::{Anchor, Drawing, overlay};
use glam::Vec3;

/// The ground of the legend where surfaces end above it.
pub const PANEL: [u8; 3] = [247, 248, 250];
const INK: &str = "#20262e";
/// How long a pointed end of the bar is, in letters' heights.
const POINT: f64 = 0.8;
/// Red, green and blue for x, y and z.
const AXES: [(&str, Vec3, &str); 3] = [("x", Vec3::X, "#c03447"), ("y", Vec3::Y, "#2f7d45"), ("z", Vec3::Z, "#2a5ea8")];

/// What the legend explains beside colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Key {
    /// Surfaces that were bared when elements were removed.
    Bared,
    /// The shape at rest.
    Ghost,
}

/// Sizes of a legend (pixels).
struct Layout {
    /// Of letters.
    em: f64,
    width: f64,
    height: f64,
}

impl Layout {
    fn new((width, height): (usize, usize)) -> Layout {
        let em = (0.025 * (height.min(width * 3 / 4)) as f64).max(13.0);
        Layout { em, width: width as f64, height: (4.6 * em).ceil() }
    }

    /// About the width of a text.
    fn wide(&self, text: &str) -> f64 {
        0.56 * self.em * text.chars().count() as f64
    }

    /// The base line of the last line.
    fn base(&self) -> f64 {
        self.height - 0.85 * self.em
    }
}

/// The row of a picture where its legend begins.
pub fn top(size: (usize, usize)) -> usize {
    size.1.saturating_sub(Layout::new(size).height as usize)
}

/// Draws all of it into a finished picture.
///
/// # Errors
/// That letters cannot be drawn.
pub fn draw(image: &mut Image, picture: &Picture<'_>, camera: &Camera) -> Result<(), RenderError> {
    let size = (image.width, image.height);
    let (layout, top) = (Layout::new(size), top(size));
    let mut page = Drawing::clear((layout.width, layout.height));
    if picture.panel {
        page.line((0.0, 0.5), (layout.width, 0.5), "#c9cfd6", 1.0, &[]);
    }
    let column = column(&mut page, picture, &layout);
    // between axes and caption; narrow pictures leave less for the bar, and not in the middle
    let (least, most) = (5.2 * layout.em, layout.width - column - 1.6 * layout.em);
    let half = (0.23 * layout.width).min((most - least) / 2.0).max(2.0 * layout.em);
    let middle = (layout.width / 2.0).min(most - half).max(least + half);
    let (left, right) = ((middle - half).round(), (middle + half).round());
    bar(&mut page, picture, &layout, (left, right));
    axes(&mut page, camera, &layout);
    let pixels = overlay(&page)?;
    let below = image.pixels.iter_mut().skip(top * size.0);
    for (pixel, [red, green, blue, cover]) in below.zip(pixels) {
        for (old, new) in pixel.iter_mut().zip([red, green, blue]) {
            *old = new + ((u16::from(*old) * u16::from(255 - cover) + 127) / 255) as u8;
        }
    }
    Ok(())
}

/// The caption and what surfaces mean, at the right; how wide that is.
fn column(page: &mut Drawing, picture: &Picture<'_>, layout: &Layout) -> f64 {
    let (em, right) = (layout.em, layout.width - 0.8 * layout.em);
    page.strong((right, layout.base()), picture.caption, em, INK, Anchor::End);
    let texts = picture.keys.iter().map(|key| layout.wide(key.words().0)).fold(0.0, f64::max) * 0.9;
    let left = right - texts - 1.5 * em;
    for (line, key) in picture.keys.iter().enumerate() {
        let (text, fill) = key.words();
        let base = layout.base() - 1.4 * em * (line + 1) as f64;
        let swatch =
            [left.round() + 0.5, (base - 0.8 * em).round() + 0.5, (left + 1.1 * em).round() + 0.5, base.round() + 0.5];
        page.area(swatch, &fill);
        page.frame(swatch, "#59626e");
        page.strong((left + 1.5 * em, base), text, em, INK, Anchor::Start);
    }
    let keys = if picture.keys.is_empty() { 0.0 } else { layout.width - left };
    f64::max(layout.wide(picture.caption) + 0.8 * em, keys)
}

impl Key {
    /// What it is called, and the colour of its swatch.
    fn words(self) -> (&'static str, String) {
        let light = Light::new();
        let hex = |light: Vec3| {
            let [red, green, blue] = colour::bytes(light);
            format!("#{red:02x}{green:02x}{blue:02x}")
        };
        match self {
            Key::Bared => ("bared by removal", hex(light.bared(Vec3::splat(0.2)))),
            Key::Ghost => ("shape at rest", hex(light.ghost().lerp(Vec3::ONE, 0.75))),
        }
    }
}

/// The bar from `left` to `right`, its numbers below and what it means above.
fn bar(page: &mut Drawing, picture: &Picture<'_>, layout: &Layout, (left, right): (f64, f64)) {
    let em = layout.em;
    let (foot, head) = ((layout.base() - 1.2 * em).round(), (layout.base() - 2.0 * em).round());
    let (low, high) = picture.scale.range;
    let (prefix, factor) = if picture.unit.is_empty() { ("", 1.0) } else { prefix(low.abs().max(high.abs())) };
    // values beyond the ends stand where the bar would be, if they leave most of it
    let beyond = beyond(picture.scale.range, picture.seen);
    let texts = beyond.map(|value| value.map(|value| three_digits(f64::from(value) * factor)));
    let wide = texts.iter().flatten().map(|text| layout.wide(text)).sum::<f64>();
    let has_room = wide < 0.4 * (right - left);
    let room = |text: &Option<String>| {
        text.as_ref().map_or(0.0, |text| POINT * em + if has_room { layout.wide(text) + 0.3 * em } else { 0.0 })
    };
    let (left, right) = ((left + room(&texts[0])).round(), (right - room(&texts[1])).round());
    let columns = (right - left) as usize;
    for column in 0..columns {
        let share = column as f32 / (columns - 1).max(1) as f32;
        let at = left + column as f64;
        page.area([at, head, at + 1.0, foot], &hex(picture.scale.srgb(low + (high - low) * share)));
    }
    page.frame([left - 0.5, head - 0.5, right + 0.5, foot + 0.5], "#59626e");
    for (text, (end, towards, anchor, value)) in
        texts.iter().zip([(left, -1.0, Anchor::End, low), (right, 1.0, Anchor::Start, high)])
    {
        let Some(text) = text else { continue };
        let (tip, middle) = (end + towards * POINT * em, (head + foot) / 2.0);
        page.band(&[(end, head), (tip, middle), (end, foot)], &hex(picture.scale.srgb(value)), 1.0);
        let side = end + 0.5 * towards;
        page.path(&[(side, head - 0.5), (tip, middle), (side, foot + 0.5)], "#59626e", 1.0, 1.0);
        if has_room {
            page.strong((tip + 0.3 * towards * em, middle + 0.35 * em), text, em, INK, anchor);
        }
    }
    let (low, high) = (f64::from(low) * factor, f64::from(high) * factor);
    for (value, text) in ticks(low, high, ((right - left) / (0.56 * em)) as usize) {
        let x = left + ((value - low) / (high - low) * (right - left - 1.0)).round() + 0.5;
        page.line((x, foot), (x, foot + 0.28 * em), INK, 1.0, &[]);
        page.strong((x, layout.base()), &text, em, INK, Anchor::Middle);
    }
    let unit = if picture.unit.is_empty() { String::new() } else { format!(" ({prefix}{})", picture.unit) };
    let line = format!("{}{unit}", picture.quantity);
    page.strong(((left + right) / 2.0, head - 0.45 * em), &line, em, INK, Anchor::Middle);
}

/// A colour (sRGB in 0 to 1) as drawings take it.
fn hex(srgb: Vec3) -> String {
    let [red, green, blue] = srgb.to_array().map(|c| (c * 255.0).round() as u8);
    format!("#{red:02x}{green:02x}{blue:02x}")
}

/// The least and the largest value of those seen, where they lie below and above the range by more than a hundredth of
/// it.
fn beyond((low, high): (f32, f32), (least, most): (f32, f32)) -> [Option<f32>; 2] {
    let more = 0.01 * (high - low);
    [(least < low - more).then_some(least), (most > high + more).then_some(most)]
}

/// Three digits of a number.
fn three_digits(value: f64) -> String {
    if value == 0.0 {
        return "0".into();
    }
    let before = value.abs().log10().floor() as i32 + 1;
    match before {
        -1..=6 => format!("{value:.*}", (3 - before).max(0) as usize),
        _ => format!("{value:.2e}"),
    }
}

/// The prefix that gives a number one to three digits before the point, and the factor that belongs to it.
pub fn prefix(largest: f32) -> (&'static str, f64) {
    const PREFIXES: [(&str, i32); 7] = [("n", -9), ("µ", -6), ("m", -3), ("", 0), ("k", 3), ("M", 6), ("G", 9)];
    let power = f64::from(largest).log10();
    let fits = PREFIXES.iter().rev().find(|(_, exponent)| power >= f64::from(*exponent) - 1e-6);
    let (name, exponent) = fits.copied().unwrap_or(if largest > 0.0 { PREFIXES[0] } else { PREFIXES[3] });
    (name, 10f64.powi(-exponent))
}

/// Round numbers from `low` to `high`, at most seven and as many as have room in that many letters.
fn ticks(low: f64, high: f64, letters: usize) -> Vec<(f64, String)> {
    let rough = 10f64.powf(((high - low) / 10.0).log10().floor());
    for step in [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0].map(|factor| factor * rough) {
        // a step is a power of ten times 1, 2 or 5 and needs that many digits behind the point
        let digits = (-step.log10().floor()).clamp(0.0, 12.0) as usize;
        let first = (low / step - 1e-6).ceil() as i64;
        let last = (high / step + 1e-6).floor() as i64;
        let texts: Vec<_> = (first..=last)
            .take(8)
            .map(|count| (count as f64 * step, format!("{:.digits$}", count as f64 * step + 0.0)))
            .collect();
        let longest = texts.iter().map(|(_, text)| text.len()).max().unwrap_or(0);
        if texts.len() <= 7 && step / (high - low) * letters as f64 >= longest as f64 + 1.0 {
            return texts;
        }
    }
    Vec::new()
}

/// The directions of x, y and z in the lower left corner, the nearest drawn last.
fn axes(page: &mut Drawing, camera: &Camera, layout: &Layout) {
    let em = layout.em;
    let length = 1.5 * em;
    let origin = (2.4 * em, layout.height - 2.3 * em);
    let mut axes = AXES.map(|(name, axis, colour)| (name, camera.turn(axis), colour));
    axes.sort_by(|a, b| a.1.z.total_cmp(&b.1.z));
    for (name, axis, colour) in axes {
        let (x, y) = (f64::from(axis.x), -f64::from(axis.y));
        let end = (origin.0 + x * length, origin.1 + y * length);
        page.line(origin, end, colour, 0.13 * em, &[]);
        // an axis that points at the eye still has its letter beside it
        let flat = x.hypot(y);
        let (x, y) = if flat > 1e-3 { (x / flat, y / flat) } else { (0.7, 0.7) };
        page.strong((end.0 + 0.55 * em * x, end.1 + 0.55 * em * y + 0.3 * em), name, em, colour, Anchor::Middle);
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
    use super::*;

    #[test]
    fn numbers_at_the_bar_are_round_and_have_room() {
        let texts =
            |low, high, letters| ticks(low, high, letters).into_iter().map(|(_, text)| text).collect::<Vec<_>>();
        assert_eq!(texts(0.0, 12.3, 44), ["0", "2", "4", "6", "8", "10", "12"]);
        assert_eq!(texts(-1.0, 1.0, 44), ["-1.0", "-0.5", "0.0", "0.5", "1.0"]);
        assert_eq!(texts(0.0, 12.3, 10), ["0", "5", "10"]);
        assert_eq!(texts(0.9996, 1.0004, 30), ["0.9996", "0.9998", "1.0000", "1.0002", "1.0004"]);
    }

    #[test]
    fn what_lies_beyond_the_bar_is_known_by_more_than_a_hundredth() {
        assert_eq!(beyond((0.0, 2.0), (-0.01, 2.01)), [None, None]);
        assert_eq!(beyond((0.0, 2.0), (-0.5, 7.0)), [Some(-0.5), Some(7.0)]);
        assert_eq!(beyond((0.0, 2.0), (f32::INFINITY, f32::NEG_INFINITY)), [None, None]);
        let texts = [0.0, 12345.0, -4.2567, 0.05, 1e33, -2e-9].map(three_digits);
        assert_eq!(texts, ["0", "12345", "-4.26", "0.0500", "1.00e33", "-2.00e-9"]);
    }

    #[test]
    fn prefixes_leave_one_to_three_digits() {
        for (largest, name) in
            [(0.0, ""), (3.2, ""), (1000.0, "k"), (0.012, "m"), (2.5e-5, "µ"), (1e-12, "n"), (7e8, "M")]
        {
            assert_eq!(prefix(largest).0, name, "{largest}");
        }
    }
}
