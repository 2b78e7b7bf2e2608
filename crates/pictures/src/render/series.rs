//! A run's series of frames: `fields.pvd` and what it names.

use super::RenderError;
use sinew::output::FIELDS;
use std::fs;
use std::path::{Path, PathBuf};

/// The frames of an output folder, in order of time.
pub struct Series {
    /// The series file.
    pub path: PathBuf,
    /// Time (s) and file of each frame; at least one.
    pub frames: Vec<(f64, PathBuf)>,
}

impl Series {
    /// Reads the series file of an output folder.
    pub fn open(folder: &Path) -> Result<Series, RenderError> {
        let path = folder.join(FIELDS);
        if !path.exists() {
            return Err(RenderError::NoSeries { path: folder.to_path_buf() });
        }
        let text = fs::read_to_string(&path).map_err(|source| RenderError::Read { path: path.clone(), source })?;
        let document =
            roxmltree::Document::parse(&text).map_err(|error| RenderError::damaged(&path, error.to_string()))?;
        let mut frames = Vec::new();
        for entry in document.descendants().filter(|node| node.has_tag_name("DataSet")) {
            let time = entry.attribute("timestep").and_then(|text| text.parse::<f64>().ok());
            match (time, entry.attribute("file")) {
                (Some(time), Some(file)) if time.is_finite() => frames.push((time, folder.join(file))),
                _ => return Err(RenderError::damaged(&path, "an entry has no file or no time that is a number")),
            }
        }
        frames.sort_by(|a, b| a.0.total_cmp(&b.0));
        if frames.is_empty() { Err(RenderError::NoFrames { path }) } else { Ok(Series { path, frames }) }
    }

    /// The row of the frame nearest to a time; the last one when none is given.
    pub fn nearest(&self, time: Option<f64>) -> usize {
        let last = self.frames.len() - 1;
        let Some(time) = time else { return last };
        (0..=last)
            .min_by(|&a, &b| (self.frames[a].0 - time).abs().total_cmp(&(self.frames[b].0 - time).abs()))
            .unwrap_or(last)
    }

    /// Writes a time (s) with a prefix and as many digits as the whole series needs: "t = 12.5 ms".
    pub fn caption(&self, time: f64) -> String {
        let last = self.frames.iter().fold(0.0, |longest: f64, (time, _)| longest.max(time.abs()));
        let (prefix, factor) = match last {
            0.1.. => ("", 1.0),
            _ => super::legend::prefix(last as f32),
        };
        let digits = if last > 0.0 { (2.0 - (last * factor).log10().floor()).clamp(0.0, 6.0) as usize } else { 0 };
        format!("t = {:.digits$} {prefix}s", time * factor)
    }
}
