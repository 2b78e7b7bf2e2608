//! Pictures as an animated GIF.

use super::palette::{Palette, UNCHANGED};
use super::{Image, RenderError};
use sinew::output::{OutputError, replace};
use std::io::Write;
use std::path::Path;

/// Hundredths of a second that each of so many pictures is shown: four seconds for all together, but 10 to 25 pictures
/// a second; less only when two seconds cannot be filled otherwise.
pub fn delay(frames: usize) -> u16 {
    let frames = frames.max(1) as u16;
    (400 / frames).clamp(4, 10).max(200u16.div_ceil(frames)).min(50)
}

/// Hundredths of a second that the last picture stays before all begins anew.
const REST: u16 = 80;

/// The pictures whose colours stand for those of all.
fn typical(frames: usize) -> Vec<usize> {
    let last = frames.saturating_sub(1);
    let mut rows = vec![0, last / 3, last * 2 / 3, last];
    rows.dedup();
    rows
}

/// How many pictures [`write_gif`] asks for.
pub fn pictures(frames: usize) -> usize {
    frames + typical(frames).len()
}

/// The delays of so many pictures (1/100 s).
pub fn delays(frames: usize) -> Vec<u16> {
    let mut delays = vec![delay(frames); frames];
    delays.last_mut().into_iter().for_each(|last| *last += REST);
    delays
}

/// Writes an animation that loops for ever, a picture for each delay (1/100 s); the file appears when it is complete.
/// `picture` draws a picture of the series; some are drawn twice, because the colours have to be chosen first.
///
/// # Errors
/// What `picture` says; a file that cannot be written.
pub fn write_gif(
    path: &Path,
    delays: &[u16],
    size: (usize, usize),
    mut picture: impl FnMut(usize) -> Result<Image, RenderError>,
) -> Result<(), RenderError> {
    let mut samples = Vec::new();
    for row in typical(delays.len()) {
        samples.push(picture(row)?);
    }
    let mut palette = Palette::new(&samples);
    drop(samples);
    let mut stopped = None;
    let written = replace(path, |file| {
        let refused = |error: gif::EncodingError| match error {
            gif::EncodingError::Io(source) => OutputError::system("write", path)(source),
            other => OutputError::Format { path: path.to_path_buf(), reason: other.to_string() },
        };
        let (wide, high) = (size.0 as u16, size.1 as u16);
        let mut encoder = gif::Encoder::new(&mut *file, wide, high, &palette.bytes()).map_err(refused)?;
        encoder.set_repeat(gif::Repeat::Infinite).map_err(refused)?;
        let mut before = Vec::new();
        for (row, delay) in delays.iter().enumerate() {
            let image = match picture(row) {
                Ok(image) => image,
                Err(error) => {
                    stopped = Some(error);
                    return Err(OutputError::Format { path: path.to_path_buf(), reason: "a frame failed".into() });
                }
            };
            let now: Vec<u8> = image.pixels.iter().map(|pixel| palette.index(*pixel)).collect();
            let mut frame = changes(&before, &now, image.width);
            frame.delay = *delay;
            encoder.write_frame(&frame).map_err(refused)?;
            before = now;
        }
        drop(encoder);
        file.flush().map_err(OutputError::system("write", path))
    });
    match stopped {
        Some(error) => Err(error),
        None => Ok(written?),
    }
}

/// The smallest rectangle that holds all that differs, and in it only what differs.
fn changes(before: &[u8], now: &[u8], width: usize) -> gif::Frame<'static> {
    let height = now.len() / width;
    let differs = |x: usize, y: usize| before.get(y * width + x) != Some(&now[y * width + x]);
    let rows: Vec<usize> = (0..height).filter(|&y| (0..width).any(|x| differs(x, y))).collect();
    let (top, bottom) = (rows.first().copied().unwrap_or(0), rows.last().copied().unwrap_or(0));
    let columns: Vec<usize> = (0..width).filter(|&x| (top..=bottom).any(|y| differs(x, y))).collect();
    let (left, right) = (columns.first().copied().unwrap_or(0), columns.last().copied().unwrap_or(0));
    let pixel = |x: usize, y: usize| if differs(x, y) { now[y * width + x] } else { UNCHANGED };
    gif::Frame {
        left: left as u16,
        top: top as u16,
        width: (right - left + 1) as u16,
        height: (bottom - top + 1) as u16,
        transparent: Some(UNCHANGED),
        dispose: gif::DisposalMethod::Keep,
        buffer: (top..=bottom).flat_map(|y| (left..=right).map(move |x| (x, y))).map(|(x, y)| pixel(x, y)).collect(),
        ..gif::Frame::default()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
    use super::*;

    #[test]
    fn animations_last_two_to_six_seconds_where_the_number_of_pictures_allows() {
        for frames in 4..=150 {
            let hundredths = u32::from(delay(frames)) * frames as u32;
            assert!((200..=600).contains(&hundredths), "{frames} pictures: {hundredths}");
        }
        assert_eq!((delay(1), delay(40), delay(1000)), (50, 10, 4));
    }
}
