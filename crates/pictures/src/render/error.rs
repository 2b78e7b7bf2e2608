//! What can go wrong while pictures are made.

use crate::plot::PlotError;
use sinew::output::OutputError;
use sinew::scene::limits::PICTURE;
use std::io;
use std::path::{Path, PathBuf};

/// A picture could not be made.
#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    /// A file of the series could not be read.
    #[error("cannot read {}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The folder has no series.
    #[error("{} has no fields.pvd; name the output folder of a run (what `sinew run` wrote to)", path.display())]
    NoSeries {
        /// The folder.
        path: PathBuf,
    },
    /// The series has no frame yet.
    #[error("{} names no frame; the run wrote none", path.display())]
    NoFrames {
        /// The series file.
        path: PathBuf,
    },
    /// A file of the series is damaged, or was not written by sinew.
    #[error("{}: {reason}", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// There is no field of that name.
    #[error("no field \"{field}\" in {}; there are: {}", path.display(), if known.is_empty() { "none".into() } else { known.join(", ") })]
    UnknownField {
        /// The name asked for.
        field: String,
        /// The frame that was looked at.
        path: PathBuf,
        /// All names that could be asked for.
        known: Vec<String>,
    },
    /// Something that the picture is to be drawn with makes no sense.
    #[error("`picture`: {0}")]
    Picture(String),
    /// The names of bodies and materials are not known, so that none can be seen through.
    #[error("{}: which bodies and materials are to be seen through is not known: {reason}", path.display())]
    Names {
        /// The file with the names.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
    /// The legend could not be drawn.
    #[error("the legend cannot be drawn: {0}")]
    Legend(#[from] PlotError),
    /// The picture is too small or too large.
    #[error(
        "a picture of {} by {} pixels; allowed are {} by {} to {} by {}",
        size.0, size.1, PICTURE[0].start(), PICTURE[1].start(), PICTURE[0].end(), PICTURE[1].end()
    )]
    Size {
        /// Width and height (pixels).
        size: (u32, u32),
    },
    /// Nothing is there to be seen: all elements are removed, or no position is a finite number.
    #[error("{}: nothing to draw; every element is removed, or no position is a finite number", path.display())]
    Nothing {
        /// The series file.
        path: PathBuf,
    },
    /// The picture could not be written.
    #[error(transparent)]
    Write(#[from] OutputError),
}

impl RenderError {
    pub(super) fn damaged(path: &Path, reason: impl Into<String>) -> RenderError {
        RenderError::Damaged { path: path.to_path_buf(), reason: reason.into() }
    }
}
