//! Pictures as PNG files.

use super::{Image, RenderError};
use sinew::output::{OutputError, replace};
use std::path::Path;

/// Writes a picture; the file appears when it is complete.
pub fn write_png(path: &Path, image: &Image) -> Result<(), RenderError> {
    let refused = |error: png::EncodingError| match error {
        png::EncodingError::IoError(source) => OutputError::system("write", path)(source),
        other => OutputError::Format { path: path.to_path_buf(), reason: other.to_string() },
    };
    replace(path, |file| {
        let mut encoder = png::Encoder::new(file, image.width as u32, image.height as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        let mut writer = encoder.write_header().map_err(refused)?;
        writer.write_image_data(image.pixels.as_flattened()).map_err(refused)?;
        writer.finish().map_err(refused)
    })?;
    Ok(())
}
