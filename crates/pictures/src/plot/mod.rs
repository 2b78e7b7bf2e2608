//! Drawings of lines and letters, as SVG and as pixels: what plots and the legends of pictures are made of.
//!
//! ```text
//! drawing  shapes and letters on a page
//! svg      a drawing -> SVG                pixels   a drawing -> pixels, PNG
//! letters  outlines of letters             labels   places for labels that do not lie on each other
//! axis     logarithmic axes                panels   small multiples of few lines
//! ```

pub mod axis;
mod drawing;
mod labels;
mod letters;
pub mod panels;
mod pixels;
mod svg;

pub use drawing::{Anchor, Drawing};
pub use labels::{Area, Spot, place};
pub use labels::{LETTERS, width};
pub use pixels::overlay;
pub use pixels::{PlotError, png};
pub use svg::svg;
