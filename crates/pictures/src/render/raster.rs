//! Triangles to samples: a depth buffer over a strip of the picture, and before it the sheets that can be seen through.

use super::colour::Ramp;
use super::light::Light;
use glam::{Vec2, Vec3};

/// What a surface is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Finish {
    /// Coloured by values.
    Plain,
    /// Bared where elements were removed: values shine through a tint.
    Bared,
    /// Coloured by values, and lets through all but this share of light seen from straight above.
    Sheet(f32),
    /// Without a value: the shape at rest.
    Ghost,
    /// A tool.
    Steel,
    /// A tool that is a plane, seen from the side where bodies are.
    Table,
    /// The same from its back, through which bodies are seen.
    Pane,
}

/// A triangle in the picture.
pub struct Triangle {
    /// Places (samples) and inverse distances from the eye.
    pub places: [Vec3; 3],
    /// Normals as the eye sees them, turned towards it.
    pub normals: [Vec3; 3],
    /// What is coloured.
    pub values: [f32; 3],
    /// How far the corners are beyond the plane that cuts (m); what is, is not drawn.
    pub beyond: [f32; 3],
    /// Which sides are element edges: that opposite to the first corner, and so on.
    pub edges: [bool; 3],
    /// How dark its element edges are, 0 to 1.
    pub ink: f32,
    /// What it is made of.
    pub finish: Finish,
}

/// What the triangles of one picture share.
pub struct Shading<'a> {
    /// Colours of values.
    pub ramp: &'a Ramp,
    /// The light.
    pub light: &'a Light,
    /// Half the width of element edges (samples).
    pub edge: f32,
}

/// Something that can be seen through, before what is solid.
#[derive(Clone, Copy, Default)]
pub struct Sheet {
    /// Inverse distance (1/m), 0 where there is none.
    nearness: f32,
    /// The share of what lies behind that it hides.
    cover: f32,
    light: Vec3,
}

/// So many sheets are told apart at a place, the nearest ones.
const SHEETS: usize = 6;

/// Some rows of samples.
pub struct Strip {
    /// Samples a row.
    pub width: usize,
    /// The first row's number in the whole picture.
    pub top: usize,
    /// Light towards the eye; no meaning where nothing is.
    pub light: Vec<Vec3>,
    /// Normals as the eye sees them; no meaning where nothing is.
    pub normal: Vec<Vec3>,
    /// Inverse distance of what is seen (1/m), 0 where nothing is.
    pub nearness: Vec<f32>,
    /// Sheets, the nearest first; empty when there are none.
    sheets: Vec<[Sheet; SHEETS]>,
}

impl Finish {
    /// Whether what lies behind is seen.
    pub fn is_clear(self) -> bool {
        matches!(self, Finish::Sheet(_) | Finish::Ghost | Finish::Pane)
    }

    /// Whether it is that of a tool.
    pub fn is_tool(self) -> bool {
        matches!(self, Finish::Steel | Finish::Table | Finish::Pane)
    }
}

impl Strip {
    /// An empty strip, with or without room for sheets.
    pub fn new(width: usize, top: usize, rows: usize, sheets: bool) -> Strip {
        let samples = width * rows;
        Strip {
            width,
            top,
            light: vec![Vec3::ZERO; samples],
            normal: vec![Vec3::Z; samples],
            nearness: vec![0.0; samples],
            sheets: vec![[Sheet::default(); SHEETS]; if sheets { samples } else { 0 }],
        }
    }

    /// What is seen at a sample through all sheets before it; `behind` is what is seen without them.
    pub fn through_sheets(&self, at: usize, behind: Vec3) -> Vec3 {
        let Some(sheets) = self.sheets.get(at) else { return behind };
        let before = sheets.iter().rev().filter(|sheet| sheet.nearness > self.nearness[at]);
        before.fold(behind, |light, sheet| light.lerp(sheet.light, sheet.cover))
    }

    /// Draws a triangle as far as it lies in the strip and is nearer than what is there.
    pub fn draw(&mut self, triangle: &Triangle, shading: &Shading<'_>) {
        let [a, b, c] = triangle.places.map(Vec3::truncate);
        let rows = self.nearness.len() / self.width;
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let top = (low.y - 0.5).ceil().max(self.top as f32);
        let bottom = (high.y - 0.5).floor().min((self.top + rows) as f32 - 1.0);
        let doubled = (b - a).perp_dot(c - a);
        // as a negation, so that a triangle of unknown place (NaN) ends here too
        if !(top <= bottom && doubled.abs() > 1e-9 && high.x >= 0.0) {
            return;
        }
        let left = (low.x - 0.5).ceil().max(0.0) as usize;
        let right = (high.x - 0.5).floor().min(self.width as f32 - 1.0);
        if right < left as f32 {
            return;
        }
        let heights = [(b, c), (c, a), (a, b)].map(|(from, to)| doubled.abs() / from.distance(to));
        let cut = triangle.beyond.iter().any(|&beyond| beyond > 0.0);
        for row in top as usize..=bottom as usize {
            for column in left..=right as usize {
                let at = Vec2::new(column as f32 + 0.5, row as f32 + 0.5);
                let wb = (at - a).perp_dot(c - a) / doubled;
                let wc = (b - a).perp_dot(at - a) / doubled;
                let share = Vec3::new(1.0 - wb - wc, wb, wc);
                if share.min_element() < 0.0 {
                    continue;
                }
                let place = (row - self.top) * self.width + column;
                let inverses = Vec3::from_array(triangle.places.map(|corner| corner.z));
                let nearness = share.dot(inverses);
                if nearness <= self.nearness[place] {
                    continue;
                }
                // shares on the surface itself, which perspective changes
                let share_there = share * inverses / nearness;
                if cut && share_there.dot(Vec3::from_array(triangle.beyond)) > 0.0 {
                    continue;
                }
                let ink = ink(triangle, shading.edge, share, heights);
                let (light, normal, cover) = sample(triangle, shading, share_there, ink);
                match cover {
                    Some(cover) => self.put(place, Sheet { nearness, cover, light }),
                    None => {
                        self.nearness[place] = nearness;
                        self.light[place] = light;
                        self.normal[place] = normal;
                    }
                }
            }
        }
    }

    /// Puts a sheet among those at a sample.
    fn put(&mut self, at: usize, sheet: Sheet) {
        let Some(sheets) = self.sheets.get_mut(at) else { return };
        let place = sheets.partition_point(|other| other.nearness >= sheet.nearness);
        // on a side that two triangles share both of them are met, at the same distance but for rounding
        let same = |other: &Sheet| (other.nearness - sheet.nearness).abs() <= 2e-6 * sheet.nearness;
        let met = sheets.get(place).is_some_and(same) || place > 0 && same(&sheets[place - 1]);
        if place < SHEETS && !met {
            sheets.copy_within(place..SHEETS - 1, place + 1);
            sheets[place] = sheet;
        }
    }
}

/// How dark element edges are at a sample; `share` is of the corners in the picture.
fn ink(triangle: &Triangle, edge: f32, share: Vec3, heights: [f32; 3]) -> f32 {
    let mut ink = 0.0f32;
    for corner in 0..3 {
        if triangle.edges[corner] {
            ink = ink.max(edge + 0.5 - share[corner] * heights[corner]);
        }
    }
    ink.clamp(0.0, 1.0) * triangle.ink
}

/// The light of one sample, its normal, and of a sheet what it hides; `share` is of the corners on the surface.
fn sample(triangle: &Triangle, shading: &Shading<'_>, share: Vec3, ink: f32) -> (Vec3, Vec3, Option<f32>) {
    let [l, m, n] = triangle.normals;
    let normal = (l * share.x + m * share.y + n * share.z).normalize_or(Vec3::Z);
    let value = || shading.ramp.light(share.dot(Vec3::from_array(triangle.values)));
    // light has a longer way through what it meets askew
    let askew = |opacity: f32| 1.0 - (1.0 - opacity).powf(1.0 / normal.z.abs().clamp(0.2, 1.0));
    let lit = |colour: Vec3| shading.light.on(normal, colour) * (1.0 - ink);
    match triangle.finish {
        Finish::Plain => (lit(value()), normal, None),
        Finish::Bared => (lit(shading.light.bared(value())), normal, None),
        Finish::Sheet(opacity) => {
            let cover = askew(opacity);
            (lit(value()), normal, Some(cover + (1.0 - cover) * ink * 0.6 * opacity.sqrt()))
        }
        Finish::Steel => (shading.light.steel(normal), normal, None),
        Finish::Table => (lit(shading.light.table()), normal, None),
        Finish::Pane => {
            let cover = askew(0.12);
            (lit(shading.light.table()), normal, Some(cover + (1.0 - cover) * 0.6 * ink))
        }
        Finish::Ghost => {
            let cover = askew(0.07);
            (lit(shading.light.ghost()), normal, Some(cover + (1.0 - cover) * ink))
        }
    }
}
