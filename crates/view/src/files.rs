//! The scene's file: read, and read again when it has changed.

use sinew::SceneFile;
use std::path::PathBuf;
use std::time::{Duration, SystemTime};
use web_time::Instant;

/// How often the file is looked at.
const EVERY: Duration = Duration::from_millis(400);

/// What a file or folder has in it.
#[derive(Debug)]
pub enum Opened {
    /// A scene.
    Scene(Box<SceneFile>),
    /// A run that is over, in a folder.
    Run(PathBuf),
}

/// A scene's file, which may change, or the folder of a run.
#[derive(Debug)]
pub struct Files {
    /// The file.
    pub path: Option<PathBuf>,
    sets: Vec<String>,
    changed: Option<SystemTime>,
    looked: Instant,
}

impl Files {
    /// A file, if there is one yet, and the values that are put into it.
    pub fn new(path: Option<PathBuf>, sets: Vec<String>) -> Self {
        Self { path, sets, changed: None, looked: Instant::now() }
    }

    /// Reads it again with more values put in.
    pub fn put_in(&mut self, sets: Vec<String>) {
        self.sets.extend(sets);
        self.changed = None;
    }

    /// Goes over to another file, without values put in.
    pub fn open(&mut self, path: PathBuf) {
        (self.path, self.sets, self.changed) = (Some(path), Vec::new(), None);
    }

    /// The scene, if the file has changed since it was read last, or what is wrong with it.
    pub fn poll(&mut self) -> Option<Result<Opened, String>> {
        if self.changed.is_some() && self.looked.elapsed() < EVERY {
            return None;
        }
        self.looked = Instant::now();
        let path = self.path.as_ref()?;
        let changed = std::fs::metadata(path).and_then(|about| about.modified());
        // one that is not there just now is being written
        let changed = changed.unwrap_or(self.changed.unwrap_or(SystemTime::UNIX_EPOCH));
        if self.changed == Some(changed) {
            return None;
        }
        self.changed = Some(changed);
        if let Some(folder) = crate::playback::folder_of(path) {
            return Some(Ok(Opened::Run(folder)));
        }
        let scene = SceneFile::load(path, &self.sets).map_err(|mistakes| mistakes.render(false));
        Some(scene.map(|scene| Opened::Scene(Box::new(scene))))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_file_is_read_when_it_has_changed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.ron");
        let mut files = Files::new(Some(path.clone()), Vec::new());
        assert!(files.poll().unwrap().unwrap_err().contains("cannot read the scene"));
        let cube = include_str!("../../../scenes/cube_under_gravity.ron");
        std::fs::write(&path, cube).unwrap();
        std::thread::sleep(EVERY);
        let duration = |opened: Opened| match opened {
            Opened::Scene(scene) => scene.scene.duration,
            Opened::Run(_) => f64::NAN,
        };
        assert_eq!(duration(files.poll().unwrap().unwrap()), 1.0);
        files.put_in(vec!["duration=2".into()]);
        assert_eq!(duration(files.poll().unwrap().unwrap()), 2.0);
        files.open(path.clone());
        assert_eq!(duration(files.poll().unwrap().unwrap()), 1.0);
        assert!(files.poll().is_none());
        std::fs::write(&path, cube.replace("duration: 1,", "durations: 1,")).unwrap();
        let later = SystemTime::now() + Duration::from_secs(5);
        std::fs::File::open(&path).unwrap().set_modified(later).unwrap();
        std::thread::sleep(EVERY);
        assert!(files.poll().unwrap().unwrap_err().contains("durations"));
    }
}
