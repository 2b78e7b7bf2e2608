//! The 256 colours of an animation.

use super::Image;
use std::cmp::Reverse;
use std::collections::HashMap;

/// Colours that stand for all others, at most 255; the last index means "as before".
pub struct Palette {
    colours: Vec<[u8; 3]>,
    /// The nearest colour of those already asked for.
    nearest: HashMap<[u8; 3], u8>,
}

/// How many colours may be kept as they are.
const MOST_KEPT: usize = 28;
/// The index that leaves a pixel as it was.
pub const UNCHANGED: u8 = 255;

impl Palette {
    /// Chooses colours for some pictures. Those that fill more than a thousandth of them (background, letters) stay as
    /// they are. Of the others, the group of colours with the largest error is cut in two at its mean, along its
    /// longest side, until there are 255 colours; each group is represented by its mean.
    pub fn new<'a>(images: impl IntoIterator<Item = &'a Image>) -> Palette {
        let mut counts = HashMap::<[u8; 3], u64>::new();
        for pixel in images.into_iter().flat_map(|image| &image.pixels) {
            *counts.entry(*pixel).or_default() += 1;
        }
        let mut all: Vec<_> = counts.into_iter().collect();
        // a map's order differs from run to run
        all.sort_unstable_by_key(|(colour, count)| (Reverse(*count), *colour));
        let total: u64 = all.iter().map(|(_, count)| count).sum();
        let frequent = all.iter().take(MOST_KEPT).take_while(|(_, count)| count * 1000 > total).count();
        let mut colours: Vec<_> = all.drain(..frequent).map(|(colour, _)| colour).collect();
        let mut groups = vec![Group::new(all)];
        while groups.len() + colours.len() < 255 {
            let worst = (0..groups.len()).max_by(|&a, &b| groups[a].error.total_cmp(&groups[b].error)).unwrap_or(0);
            if groups[worst].error <= 0.0 {
                break;
            }
            let (first, second) = groups.swap_remove(worst).cut();
            groups.extend([first, second]);
        }
        colours.extend(groups.iter().map(Group::colour));
        Palette { colours, nearest: HashMap::new() }
    }

    /// Red, green and blue of all 256 entries.
    pub fn bytes(&self) -> Vec<u8> {
        let mut bytes = self.colours.concat();
        bytes.resize(256 * 3, 0);
        bytes
    }

    /// The entry nearest to a colour.
    pub fn index(&mut self, colour: [u8; 3]) -> u8 {
        let colours = &self.colours;
        *self.nearest.entry(colour).or_insert_with(|| {
            let distance =
                |entry: &[u8; 3]| (0..3).map(|c| (i32::from(entry[c]) - i32::from(colour[c])).pow(2)).sum::<i32>();
            (0..colours.len()).min_by_key(|&row| distance(&colours[row])).unwrap_or(0) as u8
        })
    }
}

/// Some colours and how often each occurs.
struct Group {
    colours: Vec<([u8; 3], u64)>,
    mean: [f64; 3],
    /// Sum of squared distances from the mean, along the axis where it is largest.
    error: f64,
    axis: usize,
}

impl Group {
    fn new(colours: Vec<([u8; 3], u64)>) -> Group {
        // seldom colours count for more than their share: a small bright spot matters to the eye
        let weight = |count: u64| (count as f64).sqrt();
        let total: f64 = colours.iter().map(|(_, count)| weight(*count)).sum();
        let (mut mean, mut errors) = ([0.0; 3], [0.0; 3]);
        for axis in 0..3 {
            mean[axis] =
                colours.iter().map(|(c, count)| f64::from(c[axis]) * weight(*count)).sum::<f64>() / total.max(1.0);
            errors[axis] =
                colours.iter().map(|(c, count)| (f64::from(c[axis]) - mean[axis]).powi(2) * weight(*count)).sum();
        }
        let axis = (0..3).max_by(|&a, &b| f64::total_cmp(&errors[a], &errors[b])).unwrap_or(0);
        Group { colours, mean, error: errors[axis], axis }
    }

    fn cut(self) -> (Group, Group) {
        let (axis, mean) = (self.axis, self.mean[self.axis]);
        let (below, above) = self.colours.into_iter().partition(|(colour, _)| f64::from(colour[axis]) <= mean);
        (Group::new(below), Group::new(above))
    }

    fn colour(&self) -> [u8; 3] {
        self.mean.map(|mean| mean.round() as u8)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
    use super::*;

    #[test]
    fn large_areas_keep_their_colour_and_gradients_stay_near_theirs() {
        let mut image = Image::new(200, 200, [250, 251, 253]);
        for (at, pixel) in image.pixels.iter_mut().take(20_000).enumerate() {
            *pixel = [(at % 200) as u8, (at / 100) as u8, 60];
        }
        let mut palette = Palette::new([&image]);
        let bytes = palette.bytes();
        assert_eq!(bytes.len(), 768);
        for pixel in &image.pixels {
            let index = usize::from(palette.index(*pixel));
            assert!(index < usize::from(UNCHANGED));
            let worst = (0..3).map(|c| bytes[3 * index + c].abs_diff(pixel[c])).max().unwrap();
            assert!(worst <= if pixel[2] == 253 { 0 } else { 12 }, "{pixel:?}: off by {worst}");
        }
    }
}
