//! Colours for numbers.

use glam::Vec3;

/// A range of colours of even perceptual steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Map {
    /// Viridis, violet over green to yellow, for what has an order only; without its darkest tenth, on which neither
    /// shadows nor mesh lines would be seen.
    Sequential,
    /// Moreland's cool to warm: blue over grey to red, for what lies on two sides of a middle.
    Diverging,
}

const VIRIDIS: [u32; 10] =
    [0x482475, 0x414487, 0x355f8d, 0x2a788e, 0x21918c, 0x22a884, 0x44bf70, 0x7ad151, 0xbddf26, 0xfde725];
const COOL_WARM: [u32; 11] =
    [0x3b4cc0, 0x5977e3, 0x7b9ff9, 0x9ebeff, 0xc0d4f5, 0xdddcdc, 0xf2cbb7, 0xf7ac8e, 0xee8468, 0xd65244, 0xb40426];
/// For values that are not numbers.
const NOT_FINITE: u32 = 0xff00c8;

impl Map {
    /// The colour at 0 to 1, sRGB in 0 to 1.
    pub fn srgb(self, at: f32) -> Vec3 {
        if at.is_nan() {
            return unpack(NOT_FINITE);
        }
        let anchors: &[u32] = match self {
            Map::Sequential => &VIRIDIS,
            Map::Diverging => &COOL_WARM,
        };
        let at = at.clamp(0.0, 1.0) * (anchors.len() - 1) as f32;
        let below = (at as usize).min(anchors.len() - 2);
        unpack(anchors[below]).lerp(unpack(anchors[below + 1]), at - below as f32)
    }
}

/// Which value gets which colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// The values at the ends; beyond them the colour stays.
    pub range: (f32, f32),
    /// Left out: sequential colours over the range. Else diverging ones about this value, equally steep on both sides.
    pub centre: Option<f32>,
}

impl Scale {
    /// The colour of a value, sRGB in 0 to 1.
    pub fn srgb(&self, value: f32) -> Vec3 {
        let (low, high) = self.range;
        match self.centre {
            None => Map::Sequential.srgb((value - low) / (high - low)),
            Some(centre) => {
                let reach = (high - centre).abs().max((low - centre).abs());
                Map::Diverging.srgb(0.5 + (value - centre) / (2.0 * reach))
            }
        }
    }

    /// The colours of 1024 even steps over the range, as light.
    pub fn ramp(&self) -> Ramp {
        let (low, high) = self.range;
        let colour = |step: usize| linear(self.srgb(low + (high - low) * step as f32 / (STEPS - 1) as f32));
        Ramp {
            colours: (0..STEPS).map(colour).collect(),
            low,
            steps: (STEPS - 1) as f32 / (high - low),
            not_finite: linear(unpack(NOT_FINITE)),
        }
    }
}

const STEPS: usize = 1024;

/// A [`Scale`] looked up once for all.
pub struct Ramp {
    colours: Vec<Vec3>,
    low: f32,
    steps: f32,
    not_finite: Vec3,
}

impl Ramp {
    /// The colour of a value as light (linear RGB).
    pub fn light(&self, value: f32) -> Vec3 {
        if !value.is_finite() {
            return self.not_finite;
        }
        let step = ((value - self.low) * self.steps + 0.5).clamp(0.0, (STEPS - 1) as f32);
        self.colours[step as usize]
    }
}

fn unpack(colour: u32) -> Vec3 {
    Vec3::new((colour >> 16 & 255) as f32, (colour >> 8 & 255) as f32, (colour & 255) as f32) / 255.0
}

/// Light from a colour as screens take it (sRGB).
pub fn linear(srgb: Vec3) -> Vec3 {
    Vec3::from_array(srgb.to_array().map(|c| if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }))
}

/// The colour (sRGB, bytes) of light.
pub fn bytes(light: Vec3) -> [u8; 3] {
    light.to_array().map(|c| {
        let c = c.clamp(0.0, 1.0);
        let srgb = if c <= 0.0031308 { c * 12.92 } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 };
        (srgb * 255.0 + 0.5) as u8
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
    use super::*;

    #[test]
    fn ends_and_middle_have_the_colours_of_the_table() {
        let scale = Scale { range: (2.0, 4.0), centre: None };
        let colour = |scale: &Scale, value| bytes(linear(scale.srgb(value)));
        assert_eq!(colour(&scale, 2.0), [0x48, 0x24, 0x75]);
        assert_eq!(colour(&scale, 2.0 + 8.0 / 9.0), [0x21, 0x91, 0x8c]);
        assert_eq!(colour(&scale, 9.0), [0xfd, 0xe7, 0x25]);
        assert_eq!(colour(&scale, f32::NAN), [0xff, 0x00, 0xc8]);
        let scale = Scale { range: (-1.0, 3.0), centre: Some(0.0) };
        assert_eq!(colour(&scale, 0.0), [0xdd, 0xdc, 0xdc]);
        assert_eq!(colour(&scale, 3.0), [0xb4, 0x04, 0x26]);
    }

    #[test]
    fn lightness_rises_evenly_along_the_sequential_map() {
        let lightness = |at: f32| linear(Map::Sequential.srgb(at)).dot(Vec3::new(0.2126, 0.7152, 0.0722)).cbrt();
        let steps: Vec<f32> =
            (0..20).map(|step| lightness((step + 1) as f32 / 20.0) - lightness(step as f32 / 20.0)).collect();
        assert!(steps.iter().all(|&step| step > 0.01 && step < 0.07), "{steps:?}");
    }
}
