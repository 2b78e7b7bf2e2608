//! The colour bar with its numbers, the time, and the axes.

use super::camera::Camera;
use super::image::Image;
use super::picture::Picture;
use super::text::{Anchor, Letters};
use glam::{Vec2, Vec3};

const INK: [u8; 3] = [44, 50, 58];
/// Red, green and blue for x, y and z.
const AXES: [(&str, Vec3, [u8; 3]); 3] =
    [("x", Vec3::X, [200, 62, 77]), ("y", Vec3::Y, [66, 145, 82]), ("z", Vec3::Z, [52, 104, 178])];

/// Height of the legend at the bottom of a picture of the given width and height (pixels).
pub fn height(size: (usize, usize)) -> f32 {
    let letters = Letters::new(size);
    (letters.height() * 2 + bar_height(&letters) + 3 * gap(&letters)) as f32
}

fn gap(letters: &Letters) -> i32 {
    letters.height() * 2 / 5
}

fn bar_height(letters: &Letters) -> i32 {
    letters.height() * 7 / 10
}

/// Draws all of it into a finished picture.
pub fn draw(image: &mut Image, picture: &Picture<'_>, camera: &Camera) {
    let letters = Letters::new((image.width, image.height));
    let (width, bottom, margin) = (image.width as i32, image.height as i32 - gap(&letters), letters.height());
    // narrow pictures leave less for the bar, so that its last number does not run into the caption
    let caption = picture.caption.chars().count() as i32 * letters.width();
    let half = (width * 23 / 100).min(width / 2 - margin - caption - 3 * letters.width()).max(width / 10);
    bar(image, picture, &letters, (width / 2 - half, width / 2 + half), bottom);
    letters.write(image, picture.caption, (width - margin, bottom - letters.height()), Anchor::Right, INK);
    axes(image, camera, &letters);
}

/// The bar from `left` to `right`, its numbers below and what it means above.
fn bar(image: &mut Image, picture: &Picture<'_>, letters: &Letters, (left, right): (i32, i32), bottom: i32) {
    let foot = bottom - letters.height() - gap(letters) / 2;
    let head = foot - bar_height(letters);
    let (low, high) = picture.scale.range;
    for x in left..right {
        let share = (x - left) as f32 / (right - left - 1) as f32;
        let colour = picture.scale.srgb(low + (high - low) * share).to_array().map(|c| (c * 255.0).round() as u8);
        (head..foot).for_each(|y| image.set(x, y, colour));
    }
    let (prefix, factor) = if picture.unit.is_empty() { ("", 1.0) } else { prefix(low.abs().max(high.abs())) };
    let (low, high) = (f64::from(low) * factor, f64::from(high) * factor);
    for (value, text) in ticks(low, high, ((right - left) / letters.width()) as usize) {
        let x = left + ((value - low) / (high - low) * f64::from(right - left - 1)).round() as i32;
        (foot..foot + gap(letters) / 2).for_each(|y| image.set(x, y, INK));
        letters.write(image, &text, (x, foot + gap(letters) / 2), Anchor::Middle, INK);
    }
    let unit = if picture.unit.is_empty() { String::new() } else { format!(" ({prefix}{})", picture.unit) };
    let line = format!("{}{unit}", picture.quantity);
    letters.write(image, &line, ((left + right) / 2, head - gap(letters) / 2 - letters.height()), Anchor::Middle, INK);
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
fn axes(image: &mut Image, camera: &Camera, letters: &Letters) {
    let length = letters.height() as f32 * 1.45;
    let origin = Vec2::new(length * 1.75, image.height as f32 - length * 1.6);
    let mut axes = AXES.map(|(name, axis, colour)| (name, camera.turn(axis), colour));
    axes.sort_by(|a, b| a.1.z.total_cmp(&b.1.z));
    for (name, axis, colour) in axes {
        let flat = Vec2::new(axis.x, -axis.y);
        image.stroke(origin, origin + flat * length, letters.height() as f32 * 0.14, colour);
        // an axis that points at the eye still has its letter beside it
        let place = origin + flat * length + flat.normalize_or(Vec2::new(0.7, 0.7)) * letters.height() as f32 * 0.6;
        let corner = (place.x.round() as i32, place.y.round() as i32 - letters.height() / 2);
        letters.write(image, name, corner, Anchor::Middle, colour);
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
    fn prefixes_leave_one_to_three_digits() {
        for (largest, name) in
            [(0.0, ""), (3.2, ""), (1000.0, "k"), (0.012, "m"), (2.5e-5, "µ"), (1e-12, "n"), (7e8, "M")]
        {
            assert_eq!(prefix(largest).0, name, "{largest}");
        }
    }
}
