//! From an output folder to a picture or an animation.

use super::colour::Scale;
use super::field::Field;
use super::frame::{FrameFile, Place};
use super::picture::{Colouring, Picture, paint, stage};
use super::range::Seen;
use super::series::Series;
use super::surface::Faces;
use super::{Fit, Image, RenderError, animation, encode};
use crate::scene::limits::PICTURE;
use glam::Vec3;
use std::path::{Path, PathBuf};

/// What to draw, and how.
#[derive(Clone, Debug)]
pub struct Options {
    /// The field that gives the colour: an array of the frames, or a component of one (`displacement.z`, `stress.xy`).
    pub field: String,
    /// Where the eye stands, seen from the middle of the body; z is up.
    pub from: Vec3,
    /// Width and height (pixels).
    pub size: (u32, u32),
    /// The frame nearest to this time (s) is drawn, the last one when left out. An animation ends there.
    pub at: Option<f64>,
    /// Draw all frames as an animated GIF, instead of one as PNG.
    pub animate: bool,
    /// The file to write.
    pub out: PathBuf,
    /// The values that the colours span; from the data of the whole series when left out.
    pub range: Option<(f32, f32)>,
    /// Whether the elements' edges are drawn.
    pub edges: bool,
}

/// What was drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawn {
    /// The file.
    pub out: PathBuf,
    /// How many frames it shows.
    pub frames: usize,
    /// Time of the (last) frame (s).
    pub time: f64,
    /// The values that the colours span, in SI units.
    pub range: (f32, f32),
}

/// Draws the series of an output folder. Camera and colours are the same for all frames.
pub fn draw(folder: &Path, options: &Options) -> Result<Drawn, RenderError> {
    draw_with_progress(folder, options, &mut |_, _| ())
}

/// As [`draw`]; tells after each step how many of how many are done.
pub fn draw_with_progress(
    folder: &Path,
    options: &Options,
    progress: &mut dyn FnMut(usize, usize),
) -> Result<Drawn, RenderError> {
    check(options)?;
    let series = Series::open(folder)?;
    let field = Field::find(&FrameFile::open(&series.frames[0].1)?, &options.field)?;
    let last = series.nearest(options.at);
    let frames = if options.animate { last + 1 } else { 1 };
    let pictures = if options.animate { animation::pictures(frames) } else { 1 };
    let total = series.frames.len() + pictures;
    let size = (options.size.0 as usize, options.size.1 as usize);
    let (left_top, right_bottom) = stage(size);
    let (mut mesh, mut seen, mut fit) = (None, Seen::default(), Fit::new(options.from, left_top, right_bottom));
    for (row, (_, path)) in series.frames.iter().enumerate() {
        let state = State::read(path, &field, &mut mesh)?;
        state.look(&mut seen, &mut fit);
        progress(row + 1, total);
    }
    let mut done = series.frames.len();
    let camera = fit.camera().ok_or_else(|| RenderError::Nothing { path: series.path.clone() })?;
    let scale = match options.range {
        Some(range) => Scale { range, centre: field.centre.filter(|centre| range.0 < *centre && *centre < range.1) },
        None => seen.scale(field.centre, field.centre.is_none()),
    };
    let mut picture = |row: usize| -> Result<Image, RenderError> {
        let (time, path) = &series.frames[row];
        let state = State::read(path, &field, &mut mesh)?;
        let (quantity, unit, caption) = (&*field.quantity, field.unit, &*series.caption(*time));
        let (vertices, faces, values) = (&*state.vertices, &*state.faces, state.colouring(&field));
        let picture = Picture { vertices, faces, values, scale, quantity, unit, caption, edges: options.edges };
        let image = paint(&picture, &camera, size);
        done += 1;
        progress(done, total);
        Ok(image)
    };
    if options.animate {
        animation::write_gif(&options.out, frames, size, picture)?;
    } else {
        encode::write_png(&options.out, &picture(last)?)?;
    }
    Ok(Drawn { out: options.out.clone(), frames, time: series.frames[last].0, range: scale.range })
}

fn check(options: &Options) -> Result<(), RenderError> {
    if !options.from.is_finite() || options.from.normalize_or_zero() == Vec3::ZERO {
        return Err(RenderError::From { from: options.from.to_array() });
    }
    match options.range {
        Some((low, high)) if !(low < high && low.is_finite() && high.is_finite()) => {
            return Err(RenderError::Range { low, high });
        }
        _ => (),
    }
    let (wide, high) = options.size;
    match PICTURE[0].contains(&wide) && PICTURE[1].contains(&high) {
        true => Ok(()),
        false => Err(RenderError::Size { size: options.size }),
    }
}

/// The mesh, which is the same in all frames of a series.
struct Mesh {
    faces: Faces,
    points: usize,
    cells: usize,
}

/// One frame, ready to be drawn.
struct State {
    vertices: Vec<Vec3>,
    faces: Vec<[u32; 4]>,
    /// One a point, or one a face.
    values: Vec<f32>,
    per_face: bool,
}

impl State {
    fn read(path: &Path, field: &Field, mesh: &mut Option<Mesh>) -> Result<State, RenderError> {
        let frame = FrameFile::open(path)?;
        let mesh = match mesh {
            Some(mesh) if (mesh.points, mesh.cells) == (frame.points, frame.cells) => mesh,
            // the first frame, or one of another mesh
            _ => {
                let (corners, tets) = frame.corners()?;
                mesh.insert(Mesh { faces: Faces::new(&corners, tets), points: frame.points, cells: frame.cells })
            }
        };
        let alive = frame.entry(Place::Cells, "alive").filter(|entry| entry.components == 1);
        let alive = alive.map(|entry| frame.floats(entry)).transpose()?;
        let (faces, cells) = mesh.faces.surface(alive.as_deref());
        let missing = || RenderError::damaged(path, "the array Points is missing");
        let mut vertices = frame.vectors(frame.entry(Place::Mesh, "Points").ok_or_else(missing)?)?;
        if let Some(entry) = frame.entry(Place::Points, "displacement") {
            frame.vectors(entry)?.iter().zip(&mut vertices).for_each(|(by, point)| *point += *by);
        }
        let values = field.values(&frame)?;
        let per_face = field.place == Place::Cells;
        let values = if per_face { cells.iter().map(|cell| values[*cell as usize]).collect() } else { values };
        Ok(State { vertices, faces, values, per_face })
    }

    fn colouring(&self, field: &Field) -> Colouring<'_> {
        match field.place {
            Place::Cells => Colouring::Faces(&self.values),
            _ => Colouring::Vertices(&self.values),
        }
    }

    /// Adds what this frame shows.
    fn look(&self, seen: &mut Seen, fit: &mut Fit) {
        for (row, face) in self.faces.iter().enumerate() {
            face.iter().for_each(|point| fit.see(self.vertices[*point as usize]));
            match self.per_face {
                true => seen.value(self.values[row]),
                false => face.iter().for_each(|point| seen.value(self.values[*point as usize])),
            }
        }
    }
}
