//! Drawings of lines and letters, as SVG and as pixels: what plots and the legends of pictures are made of.
//!
//! ```text
//! svg      shapes, letters -> SVG          pixels   SVG -> pixels, PNG, with letters that sinew brings along
//! axis     logarithmic axes                labels   places for labels that do not lie on each other
//! panels   small multiples of few lines
//! ```

pub mod axis;
mod labels;
pub mod panels;
mod pixels;
pub mod svg;

pub use labels::{Area, Spot, place};
pub use labels::{LETTERS, width};
pub use pixels::overlay;
pub use pixels::{PlotError, png};
