//! A picture as pixels.

/// An opaque picture, row by row from the top, sRGB.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// Pixels a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Red, green, blue.
    pub pixels: Vec<[u8; 3]>,
}

impl Image {
    /// A picture of one colour.
    pub fn new(width: usize, height: usize, colour: [u8; 3]) -> Image {
        Image { width, height, pixels: vec![colour; width * height] }
    }

    /// Of a PNG file, without what it says of transparency; grey values and palettes are taken as colours.
    ///
    /// # Errors
    /// That it is none, or has more than `most` pixels, in words.
    pub fn from_png(bytes: &[u8], most: usize) -> Result<Image, String> {
        let mut decoder = png::Decoder::new(std::io::Cursor::new(bytes));
        decoder.set_transformations(png::Transformations::normalize_to_color8());
        let mut reader = decoder.read_info().map_err(|error| error.to_string())?;
        let (width, height) = (reader.info().width as usize, reader.info().height as usize);
        if width.saturating_mul(height) > most {
            return Err(format!("it has {width} × {height} pixels, and {most} are as many as are taken"));
        }
        let size = reader.output_buffer_size().ok_or("it is too large")?;
        let mut numbers = vec![0; size];
        let info = reader.next_frame(&mut numbers).map_err(|error| error.to_string())?;
        let colour = |pixel: &[u8]| match *pixel {
            [grey] | [grey, _] => [grey; 3],
            [r, g, b, ..] => [r, g, b],
            [] => [0; 3],
        };
        let pixels = numbers[..info.buffer_size()].chunks_exact(info.color_type.samples()).map(colour).collect();
        Ok(Image { width, height, pixels })
    }

    /// The colour of a pixel inside the picture.
    pub fn at(&self, x: usize, y: usize) -> [u8; 3] {
        self.pixels[y * self.width + x]
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn what_is_written_is_read_again_and_what_is_none_is_told() {
        let mut image = Image::new(3, 2, [10, 200, 30]);
        image.pixels[4] = [255, 0, 7];
        let file = tempfile::tempdir().unwrap().path().with_extension("png");
        crate::render::write_png(&file, &image).unwrap();
        let bytes = std::fs::read(&file).unwrap();
        std::fs::remove_file(&file).unwrap();
        assert_eq!(Image::from_png(&bytes, 6).unwrap(), image);
        assert!(Image::from_png(&bytes, 5).unwrap_err().contains("3 × 2 pixels"));
        assert!(Image::from_png(b"GIF89a", 6).is_err() && Image::from_png(&bytes[..40], 6).is_err());
        let mut grey = Vec::new();
        let mut encoder = png::Encoder::new(&mut grey, 1, 2);
        encoder.set_color(png::ColorType::Grayscale);
        encoder.write_header().unwrap().write_image_data(&[0, 128]).unwrap();
        assert_eq!(Image::from_png(&grey, 2).unwrap().pixels, [[0; 3], [128; 3]]);
    }
}
