//! From an output folder to a picture or an animation.

use super::camera::View;
use super::colour::Scale;
use super::frame::FrameFile;
use super::legend::top;
use super::picture::{Picture, paint, stage};
use super::range::SeenValues;
use super::series::Series;
use super::state::Reader;
use super::tools::Tools;
use super::{Fit, Image, RenderError, animation, encode};
use glam::DVec3;
use sinew::scene::limits::{PICTURE, ZOOM};
use sinew::scene::schema;
use std::f32::consts::TAU;
use std::path::{Path, PathBuf};

/// What to draw, and how.
#[derive(Clone, Debug)]
pub struct RenderOptions {
    /// How: as a scene says it.
    pub picture: schema::Picture,
    /// Another field than the picture's: an array of the frames, or a component of one (`displacement.z`, `stress.xy`).
    pub field: Option<String>,
    /// The frame nearest to this time (s) is drawn, the last one when left out. An animation ends there.
    pub at: Option<f64>,
    /// Draw all frames as an animated GIF, instead of one as PNG.
    pub animate: bool,
    /// The file to write.
    pub out: PathBuf,
    /// What stands below each frame, in their order; the time when left out.
    pub captions: Vec<String>,
    /// The tools of the scene, drawn where the picture wants them and frames do not swing.
    pub tools: Tools,
    /// Frames are shapes that swing about the one at rest: so many pictures of each; 0 shows each once as it is.
    pub swing: usize,
}

impl RenderOptions {
    /// A picture of the last frame, as a scene says it.
    pub fn new(picture: schema::Picture, out: PathBuf) -> RenderOptions {
        let (captions, tools) = (Vec::new(), Tools::default());
        RenderOptions { picture, field: None, at: None, animate: false, out, captions, tools, swing: 0 }
    }
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
    /// What stands below it.
    pub caption: String,
    /// The values that the colours span, in SI units.
    pub range: (f32, f32),
}

/// Draws the series of an output folder. Camera and colours are the same for all frames.
///
/// # Errors
/// Options that make no sense, files that are missing, damaged or cannot be written.
pub fn draw(folder: &Path, options: &RenderOptions) -> Result<Drawn, RenderError> {
    draw_with_progress(folder, options, &mut |_, _| ())
}

/// As [`draw`]; tells after each step how many of how many are done.
///
/// # Errors
/// As [`draw`].
pub fn draw_with_progress(
    folder: &Path,
    options: &RenderOptions,
    progress: &mut dyn FnMut(usize, usize),
) -> Result<Drawn, RenderError> {
    check(options)?;
    let series = Series::open(folder)?;
    let how = &options.picture;
    let mut reader = Reader::new(folder, &FrameFile::open(&series.frames[0].1)?, options)?;
    let last = series.nearest(options.at);
    let phases = options.swing.max(1);
    let frames = if options.animate { (last + 1) * phases } else { 1 };
    let pictures = if options.animate { animation::pictures(frames) } else { 1 };
    let total = series.frames.len() + pictures;
    let size = (how.size.0 as usize, how.size.1 as usize);
    let (left_top, right_bottom) = stage(size);
    let (mut seen, mut fit) = (SeenValues::default(), Fit::new(&View::from(how), left_top, right_bottom));
    let mut keys_of_all = Vec::new();
    for (row, (_, path)) in series.frames.iter().enumerate() {
        let mut state = reader.read(path)?;
        state.measure(&reader, &mut seen, &mut fit);
        if options.swing > 0 {
            state.scale(-1.0);
            state.measure(&reader, &mut seen, &mut fit);
        }
        if row <= last {
            keys_of_all = [keys_of_all, state.keys(&reader)].into_iter().max_by_key(Vec::len).unwrap_or_default();
        }
        progress(row + 1, total);
    }
    let mut done = series.frames.len();
    let nothing = || RenderError::Nothing { path: series.path.clone() };
    let no_tools = Tools::default();
    let drawn = how.tools && options.swing == 0 && !fit.extent().is_nothing();
    let tools = if drawn { &options.tools } else { &no_tools };
    let times: Vec<f64> = series.frames.iter().map(|frame| frame.0).collect();
    let spanned = tools.measure(&times, &mut fit);
    let placed = |row: usize| tools.placed(row, times[row], &spanned);
    let camera = fit.camera().ok_or_else(nothing)?;
    let mut shown = if options.animate { 0..=last } else { last..=last };
    let bottom = top(size) as f32;
    let low = shown.any(|row| placed(row).iter().any(|tool| tool.reaches(&camera, bottom)));
    let centre = reader.field().centre;
    let extremes = seen.extremes();
    let scale = match how.range.map(|(low, high)| (low as f32, high as f32)) {
        Some(range) => Scale { range, centre: centre.filter(|centre| range.0 < *centre && *centre < range.1) },
        None => seen.scale(centre, centre.is_none()),
    };
    let (quantity, unit) = (reader.field().quantity.clone(), reader.field().unit);
    let caption = |row: usize| {
        let of_time = || series.caption(series.frames[row].0);
        options.captions.get(row).cloned().unwrap_or_else(of_time)
    };
    let mut picture = |row: usize, phase: usize| -> Result<Image, RenderError> {
        let mut state = reader.read(&series.frames[row].1)?;
        if options.animate && options.swing > 0 {
            state.scale((TAU * phase as f32 / phases as f32).sin());
        }
        // the legend of an animation does not change on the way
        let keys = if options.animate { keys_of_all.clone() } else { state.keys(&reader) };
        let placed = placed(row);
        let tools = placed.iter().map(|tool| tool.layer(&camera, &spanned, |normal| state.depth(normal)));
        let picture = Picture {
            layers: reader.layers(&state, how.edges).into_iter().chain(tools).collect(),
            scale,
            seen: extremes,
            quantity: &quantity,
            unit,
            caption: &caption(row),
            keys: &keys,
            plane: reader.plane(),
            ground: how.shadow.then(|| fit.ground()),
            // enlarged or looking elsewhere, surfaces may reach into the legend, as tools may
            panel: how.zoom > 1.0 || how.look_at.is_some() || low,
        };
        let image = paint(&picture, &camera, size)?;
        done += 1;
        progress(done, total);
        Ok(image)
    };
    if options.animate {
        let delays = animation::delays(frames);
        animation::write_gif(&options.out, &delays, size, |number| picture(number / phases, number % phases))?;
    } else {
        encode::write_png(&options.out, &picture(last, 0)?)?;
    }
    let (out, time, caption) = (options.out.clone(), series.frames[last].0, caption(last));
    Ok(Drawn { out, frames, time, caption, range: scale.range })
}

/// What a scene is checked for as well, with its place; here for those who draw from a program.
fn check(options: &RenderOptions) -> Result<(), RenderError> {
    let picture = &options.picture;
    let direction = |name: &str, of: DVec3| match of.try_normalize() {
        Some(_) => Ok(()),
        None => {
            Err(RenderError::Picture(format!("`{name}` is {of}, which is no direction: three numbers, not all zero")))
        }
    };
    direction("from", picture.from)?;
    direction("up", picture.up)?;
    if let Some(cut) = picture.cut {
        direction("cut.normal", cut.normal)?;
    }
    let points = [picture.look_at, picture.cut.map(|cut| cut.point)];
    if points.into_iter().flatten().any(|point| !point.as_vec3().is_finite()) {
        return Err(RenderError::Picture("`look_at` and `cut.point` must be finite numbers".into()));
    }
    if let Some((low, high)) = picture.range.map(|(low, high)| (low as f32, high as f32))
        && !(low < high && low.is_finite() && high.is_finite())
    {
        return Err(RenderError::Picture(format!(
            "`range` is from {low} to {high}; the first number must be below the second"
        )));
    }
    if !ZOOM.contains(&picture.zoom) {
        let (least, most) = (ZOOM.start(), ZOOM.end());
        return Err(RenderError::Picture(format!("`zoom` is {}; allowed are {least} to {most}", picture.zoom)));
    }
    if picture.opacity.iter().any(|entry| !(0.0..=1.0).contains(&entry.opacity)) {
        return Err(RenderError::Picture("an `opacity` is not between 0 and 1".into()));
    }
    let (wide, high) = picture.size;
    match PICTURE[0].contains(&wide) && PICTURE[1].contains(&high) {
        true => Ok(()),
        false => Err(RenderError::Size { size: picture.size }),
    }
}
