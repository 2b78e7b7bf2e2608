//! A drawing as pixels.

use resvg::{tiny_skia, usvg};
use std::sync::{Arc, LazyLock};

/// Why a drawing could not be turned into pixels.
#[derive(Debug, thiserror::Error)]
#[error("the plot cannot be drawn: {0}")]
pub struct PlotError(String);

/// The letters that sinew brings along.
static LETTERS: LazyLock<Arc<usvg::fontdb::Database>> = LazyLock::new(|| {
    let mut fonts = usvg::fontdb::Database::new();
    fonts.load_font_data(epaint_default_fonts::UBUNTU_LIGHT.to_vec());
    fonts.load_font_data(epaint_default_fonts::HACK_REGULAR.to_vec());
    Arc::new(fonts)
});

/// A PNG file of an SVG drawing, `zoom` pixels a unit.
///
/// # Errors
/// That it is no SVG, or too large for memory.
pub fn png(svg: &str, zoom: f32) -> Result<Vec<u8>, PlotError> {
    page(svg, zoom)?.encode_png().map_err(|error| PlotError(error.to_string()))
}

/// An SVG drawing as red, green, blue and how much is covered, one pixel a unit, row by row; colours are those of the
/// covered part times its share.
///
/// # Errors
/// That it is no SVG, or too large for memory.
pub fn overlay(svg: &str) -> Result<Vec<[u8; 4]>, PlotError> {
    Ok(page(svg, 1.0)?.data().as_chunks::<4>().0.to_vec())
}

fn page(svg: &str, zoom: f32) -> Result<tiny_skia::Pixmap, PlotError> {
    let fontdb = Arc::clone(&LETTERS);
    let options = usvg::Options { fontdb, font_family: "Ubuntu".into(), ..usvg::Options::default() };
    let tree = usvg::Tree::from_str(svg, &options).map_err(|error| PlotError(error.to_string()))?;
    let size = tree.size();
    let (width, height) = ((size.width() * zoom) as u32, (size.height() * zoom) as u32);
    let mut page = tiny_skia::Pixmap::new(width, height).ok_or_else(|| PlotError("it is too large".into()))?;
    resvg::render(&tree, tiny_skia::Transform::from_scale(zoom, zoom), &mut page.as_mut());
    Ok(page)
}
