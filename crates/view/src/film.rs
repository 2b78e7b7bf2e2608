//! Films: pictures in the course of simulated time, as a GIF, as PNG files, or as MP4 by the program ffmpeg.

use sinew_pictures::render::{Image, write_gif, write_png};
use std::fs::File;
use std::io::{ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

/// Pictures a second.
pub const RATE: u32 = 25;

/// A film that is being taken.
pub struct Film {
    path: PathBuf,
    /// Width and height (pixels), both even: what films are made of has half as many colours.
    pub size: (u32, u32),
    /// How many pictures there are.
    pub count: usize,
    reel: Reel,
}

/// Where its pictures are.
enum Reel {
    /// Files in a folder.
    Pngs,
    /// One after the other in a file, until all are there and their colours can be chosen.
    Gif(File, PathBuf),
    /// In the hands of ffmpeg.
    Mp4(Child),
}

impl Film {
    /// Begins a film of a size (pixels), which is made even: a GIF or MP4 by its ending, else a folder of PNG files.
    ///
    /// # Errors
    /// An ending that is none of those; no ffmpeg; a file that cannot be written. In words.
    pub fn begin(path: &Path, (width, height): (u32, u32)) -> Result<Self, String> {
        let size = ((width & !1).max(2), (height & !1).max(2));
        let at = |error: std::io::Error| format!("{}: {error}", path.display());
        let reel = match path.extension().and_then(|ending| ending.to_str()) {
            Some("gif") => {
                let spool = std::env::temp_dir().join(format!("sinew-film-{}.rgb", std::process::id()));
                let spool = free(&spool);
                let file = File::options().read(true).write(true).create_new(true).open(&spool).map_err(at)?;
                Reel::Gif(file, spool)
            }
            Some("mp4") => Reel::Mp4(ffmpeg(path, size)?),
            None => {
                std::fs::create_dir_all(path).map_err(at)?;
                Reel::Pngs
            }
            Some(_) => {
                return Err(format!(
                    "{}: a film is a file that ends in .gif or .mp4, or a folder (a name without an ending), into which \
                     PNG files go",
                    path.display()
                ));
            }
        };
        Ok(Self { path: path.into(), size, count: 0, reel })
    }

    /// Adds a picture of the film's size.
    ///
    /// # Errors
    /// Another size; what cannot be written. In words.
    pub fn add(&mut self, image: &Image) -> Result<(), String> {
        if (image.width, image.height) != (self.size.0 as usize, self.size.1 as usize) {
            let (width, height) = self.size;
            return Err(format!("a picture of {} × {}, not {width} × {height}", image.width, image.height));
        }
        self.count += 1;
        let bytes = image.pixels.as_flattened();
        match &mut self.reel {
            Reel::Pngs => {
                let file = self.path.join(format!("{:05}.png", self.count));
                write_png(&file, image).map_err(|error| error.to_string())
            }
            Reel::Gif(spool, path) => spool.write_all(bytes).map_err(|error| format!("{}: {error}", path.display())),
            Reel::Mp4(child) => {
                let into = child.stdin.as_mut().ok_or("ffmpeg takes no pictures")?;
                into.write_all(bytes).map_err(|error| format!("ffmpeg has stopped: {error}"))
            }
        }
    }

    /// Ends it, which takes its time for a GIF: what was written, in words.
    ///
    /// # Errors
    /// That there are no pictures; what cannot be written; what ffmpeg says. In words.
    pub fn end(mut self) -> Result<String, String> {
        if self.count == 0 {
            return Err("a film of no picture is not written".into());
        }
        let (width, height) = self.size;
        match &mut self.reel {
            Reel::Pngs => {}
            Reel::Gif(spool, _) => {
                let bytes = width as usize * height as usize * 3;
                let picture = |row: usize| {
                    let mut pixels = vec![[0; 3]; bytes / 3];
                    let at = SeekFrom::Start((row * bytes) as u64);
                    let read = spool.seek(at).and_then(|_| spool.read_exact(pixels.as_flattened_mut()));
                    let failed = |source| sinew_pictures::render::RenderError::Read { path: self.path.clone(), source };
                    read.map_err(failed)?;
                    Ok(Image { width: width as usize, height: height as usize, pixels })
                };
                let delays = vec![(100 / RATE) as u16; self.count];
                let size = (width as usize, height as usize);
                write_gif(&self.path, &delays, size, picture).map_err(|error| error.to_string())?;
            }
            Reel::Mp4(child) => {
                drop(child.stdin.take());
                let mut told = String::new();
                let _ = child.stderr.take().map(|mut stderr| stderr.read_to_string(&mut told));
                let ended = child.wait().map_err(|error| format!("ffmpeg: {error}"))?;
                if !ended.success() {
                    return Err(format!("ffmpeg could not write {}: {}", self.path.display(), told.trim()));
                }
            }
        }
        Ok(format!("wrote {}: {} pictures of {width} × {height}", self.path.display(), self.count))
    }
}

impl Drop for Film {
    fn drop(&mut self) {
        match &mut self.reel {
            Reel::Pngs => {}
            Reel::Gif(_, spool) => drop(std::fs::remove_file(spool)),
            // where it was ended it is no longer there
            Reel::Mp4(child) => {
                drop(child.stdin.take());
                let _ = child.wait();
            }
        }
    }
}

/// A name that no file has.
fn free(path: &Path) -> PathBuf {
    let name = |number: u32| path.with_extension(format!("{number}.rgb"));
    (0..10_000).map(name).find(|path| !path.exists()).unwrap_or_else(|| path.into())
}

/// Starts ffmpeg, which takes pictures from its input.
fn ffmpeg(path: &Path, (width, height): (u32, u32)) -> Result<Child, String> {
    let size = format!("{width}x{height}");
    let rate = RATE.to_string();
    let raw = ["-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", &size, "-r", &rate, "-i", "-"];
    let mut command = Command::new("ffmpeg");
    command.args(raw).args(["-an", "-pix_fmt", "yuv420p"]).arg(path);
    command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
    command.spawn().map_err(|error| match error.kind() {
        ErrorKind::NotFound => {
            "MP4 is written by the program ffmpeg, which is not installed; a name that ends in .gif, or a folder for PNG \
             files, needs none"
                .into()
        }
        _ => format!("ffmpeg cannot be started: {error}"),
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn image(grey: u8) -> Image {
        Image { width: 16, height: 8, pixels: vec![[grey, grey, 255 - grey]; 128] }
    }

    fn film(path: &Path) -> Result<String, String> {
        let mut film = Film::begin(path, (17, 9))?;
        for grey in [0, 100, 200] {
            film.add(&image(grey))?;
        }
        assert!(film.add(&Image { width: 8, height: 8, pixels: vec![[0; 3]; 64] }).is_err());
        film.end()
    }

    #[test]
    fn a_film_is_a_gif_or_a_folder_of_pictures() {
        let folder = tempfile::tempdir().unwrap();
        let gif = folder.path().join("film.gif");
        assert!(film(&gif).unwrap().ends_with("3 pictures of 16 × 8"));
        let bytes = std::fs::read(&gif).unwrap();
        assert!(bytes.starts_with(b"GIF89a"));
        // 4/100 s before each of three pictures: control blocks 21 F9 04, flags, delay
        let delays = bytes.windows(6).filter(|bytes| bytes[..3] == [0x21, 0xF9, 4] && bytes[4..] == [4, 0]);
        assert_eq!(delays.count(), 3);
        let pngs = folder.path().join("film");
        film(&pngs).unwrap();
        assert_eq!(std::fs::read_dir(&pngs).unwrap().count(), 3);
        assert!(film(&folder.path().join("film.avi")).unwrap_err().contains("ends in .gif or .mp4"));
        assert!(Film::begin(&gif, (16, 8)).unwrap().end().is_err());
    }

    #[test]
    fn mp4_needs_ffmpeg_and_without_it_a_text_says_so() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("film.mp4");
        match film(&path) {
            Ok(_) => assert!(std::fs::metadata(&path).unwrap().len() > 0),
            Err(text) => assert!(text.contains("ffmpeg, which is not installed"), "{text}"),
        }
    }
}
