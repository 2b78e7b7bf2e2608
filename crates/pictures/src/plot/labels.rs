//! Labels that do not lie on each other.

/// A rectangle: left, top, right, bottom (pixels).
pub type Area = [f64; 4];

/// Height of letters (pixels).
pub const LETTERS: f64 = 13.0;

/// Where a label stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// The left end of its base line.
    pub x: f64,
    /// Its base line.
    pub y: f64,
    /// Whether it is far enough from its point to need a line to it.
    pub far: bool,
}

/// Width of a text (pixels), about.
pub fn width(text: &str) -> f64 {
    0.53 * LETTERS * text.chars().count() as f64
}

fn overlap(a: &Area, b: &Area) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}

/// Places labels beside their points, in order; those that come first have the better places. `taken`: what is there
/// already, the points themselves for instance; `page`: where labels may stand. `None` for a label that has no place.
pub fn place(labels: &[((f64, f64), &str)], mut taken: Vec<Area>, page: Area) -> Vec<Option<Spot>> {
    let mut spots = Vec::new();
    for &((x, y), text) in labels {
        let (wide, high) = (width(text), LETTERS);
        let found = candidates(wide, high).into_iter().find_map(|(dx, dy, far)| {
            let area = [x + dx, y + dy, x + dx + wide, y + dy + high];
            let inside = area[0] >= page[0] && area[1] >= page[1] && area[2] <= page[2] && area[3] <= page[3];
            (inside && !taken.iter().any(|other| overlap(&area, other))).then_some((area, far))
        });
        if let Some((area, _)) = found {
            taken.push([area[0] - 2.0, area[1] - 1.0, area[2] + 2.0, area[3] + 1.0]);
        }
        spots.push(found.map(|(area, far)| Spot { x: area[0], y: area[3] - 0.22 * high, far }));
    }
    spots
}

/// Offsets of a label's upper left corner from its point: right, left, above, below, then wider circles.
fn candidates(wide: f64, high: f64) -> Vec<(f64, f64, bool)> {
    let near = 10.0;
    let mut list = vec![
        (near, -0.5 * high, false),
        (-near - wide, -0.5 * high, false),
        (-0.5 * wide, -near - high, false),
        (-0.5 * wide, near, false),
        (near - 3.0, -near - high + 3.0, false),
        (near - 3.0, near - 3.0, false),
        (-near - wide + 3.0, -near - high + 3.0, false),
        (-near - wide + 3.0, near - 3.0, false),
    ];
    for ring in 2..9 {
        let reach = 14.0 * f64::from(ring);
        for turn in 0..16 {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(turn) / 16.0).sin_cos();
            let dx = reach * cos
                + if cos < -0.1 {
                    -wide
                } else if cos > 0.1 {
                    0.0
                } else {
                    -0.5 * wide
                };
            list.push((dx, reach * sin - 0.5 * high, true));
        }
    }
    list
}
