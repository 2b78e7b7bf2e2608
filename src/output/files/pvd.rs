//! The series of frames: `fields_000000.vtu` and so on, and `fields.pvd`, which gives ParaView their times.

use super::{Folder, write_vtu};
use crate::output::{Frame, OutputError};
use std::fs::File;
use std::io::{Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// The series file's name.
pub const FIELDS: &str = "fields.pvd";

const HEAD: &str = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n  <Collection>\n";
const TAIL: &str = "  </Collection>\n</VTKFile>\n";

/// A growing series of frames. `fields.pvd` is complete after every frame: the closing tags are written over with the
/// new line and themselves, in one call, so that a long series costs no more a frame than a short one.
pub struct Series {
    folder: PathBuf,
    name: String,
    path: PathBuf,
    file: File,
    /// Where the closing tags begin.
    tail: u64,
    frames: usize,
}

impl Series {
    /// Begins an empty series in an output folder.
    pub fn create(folder: &Folder) -> Result<Series, OutputError> {
        Self::named(folder.path(), "fields")
    }

    /// Begins an empty series of another name: `NAME.pvd`, `NAME_000000.vtu` and so on.
    pub fn named(folder: &Path, name: &str) -> Result<Series, OutputError> {
        let path = folder.join(format!("{name}.pvd"));
        let mut file = File::create(&path).map_err(OutputError::system("create", &path))?;
        file.write_all(format!("{HEAD}{TAIL}").as_bytes()).map_err(OutputError::system("write", &path))?;
        Ok(Series {
            folder: folder.to_path_buf(),
            name: name.to_string(),
            path,
            file,
            tail: HEAD.len() as u64,
            frames: 0,
        })
    }

    /// Writes the next frame and enters it in the series; returns its file.
    pub fn write(&mut self, frame: &Frame<'_>) -> Result<PathBuf, OutputError> {
        let name = format!("{}_{:06}.vtu", self.name, self.frames);
        let path = self.folder.join(&name);
        write_vtu(&path, frame)?;
        self.enter(&format!("    <DataSet timestep=\"{:?}\" file=\"{name}\"/>\n", frame.time))
            .map_err(OutputError::system("write", &self.path))?;
        self.frames += 1;
        Ok(path)
    }

    /// How many frames the series has.
    pub fn frame_count(&self) -> usize {
        self.frames
    }

    fn enter(&mut self, line: &str) -> std::io::Result<()> {
        self.file.seek(SeekFrom::Start(self.tail))?;
        if let Err(error) = self.file.write_all(format!("{line}{TAIL}").as_bytes()) {
            // a full disk: the room of the old tail is still ours, so the series can be closed as it was
            self.file.seek(SeekFrom::Start(self.tail))?;
            self.file.write_all(TAIL.as_bytes())?;
            self.file.set_len(self.tail + TAIL.len() as u64)?;
            return Err(error);
        }
        self.tail += line.len() as u64;
        Ok(())
    }
}
