//! The text of a scene in the window, with scenes and files in memory: where there is no disk, in a page.

use egui::{Context, DroppedFileHandle};
use sinew::SceneFile;
use sinew::scene::{Placed, Severity, validate};
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::{Arc, Mutex, PoisonError};

/// Scenes and files in memory, in place of a disk.
#[derive(Clone, Debug, Default)]
pub struct Bundle {
    /// Names and texts of scenes.
    pub scenes: Vec<(String, String)>,
    /// What scenes name: meshes, skins, parts.
    pub files: BTreeMap<String, Vec<u8>>,
}

/// A text that is being edited, and what is wrong with it.
#[derive(Debug, Default)]
pub struct Editor {
    /// Scenes to choose from, and files that all of them may name.
    pub bundle: Bundle,
    /// The name of the scene, as mistakes show it.
    pub name: String,
    /// Its text.
    pub text: String,
    /// What is wrong with it.
    pub mistakes: Vec<Mistake>,
    /// The text that was looked at last.
    checked: String,
    /// Whether it is not yet known what came of the last scene that was taken.
    is_loading: bool,
    /// What is to be loaded.
    scene: Option<Box<SceneFile>>,
    inbox: Inbox,
}

/// What is wrong at a place of the text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mistake {
    /// The bytes of the text; none where it is in another file, or in none.
    pub bytes: Option<Range<usize>>,
    /// Whether it keeps the scene from running.
    pub is_error: bool,
    /// File, line and column, and one sentence.
    pub line: String,
    /// The sentence, with the word on the place.
    pub message: String,
    /// What is allowed, what to do.
    pub notes: Vec<String>,
}

/// Names and bytes of files that were dropped, or why they cannot be read.
type Dropped = (String, Result<Vec<u8>, String>);

/// Files that arrive: in a page some time after they were dropped.
#[derive(Clone, Debug, Default)]
struct Inbox(Arc<Mutex<Vec<Dropped>>>);

impl Inbox {
    fn put(&self, name: String, bytes: Result<Vec<u8>, String>) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push((name, bytes));
    }

    fn take(&self) -> Vec<Dropped> {
        std::mem::take(&mut *self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }

    #[cfg(not(target_arch = "wasm32"))]
    fn read(&self, file: &DroppedFileHandle, _: &Context) {
        self.put(name_of(file), file.bytes());
    }

    #[cfg(target_arch = "wasm32")]
    fn read(&self, file: &DroppedFileHandle, context: &Context) {
        let (inbox, file, context) = (self.clone(), Arc::clone(file), context.clone());
        wasm_bindgen_futures::spawn_local(async move {
            let bytes = file.bytes_async().await;
            inbox.put(name_of(&file), bytes);
            context.request_repaint();
        });
    }
}

fn name_of(file: &DroppedFileHandle) -> String {
    file.path().file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

impl Mistake {
    /// A mistake as it is seen from the text of a scene.
    fn of(placed: &Placed, scene: &str) -> Self {
        let Placed { text, bytes, place, diagnostic } = placed;
        let colon = if place.is_empty() { "" } else { ": " };
        let label = if diagnostic.label.is_empty() { String::new() } else { format!(" ({})", diagnostic.label) };
        Self {
            bytes: (text == scene).then(|| bytes.clone()),
            is_error: diagnostic.severity == Severity::Error,
            line: format!("{place}{colon}{}", diagnostic.message),
            message: format!("{}{label}", diagnostic.message),
            notes: diagnostic.notes.clone(),
        }
    }
}

impl Editor {
    /// The first scene of a bundle, or the one of that name, which is loaded.
    pub fn new(bundle: Bundle, scene: Option<&str>) -> Self {
        let mut editor = Self { bundle, ..Self::default() };
        let of_name = editor.bundle.scenes.iter().find(|(name, _)| Some(name.as_str()) == scene);
        if let Some((name, text)) = of_name.or(editor.bundle.scenes.first()).cloned() {
            editor.open(name, text);
        }
        editor
    }

    /// Goes over to another scene, and loads it.
    pub fn open(&mut self, name: String, text: String) {
        (self.name, self.text) = (name, text);
        self.load(&[]);
    }

    /// Looks for what is wrong with the text, if it is another one than it was, without the meshes that it names.
    pub fn check(&mut self) {
        if self.checked != self.text {
            self.read(&[]);
        }
    }

    /// Loads the text, with values put in as by `--set`, unless something is wrong with it.
    pub fn load(&mut self, sets: &[String]) {
        self.scene = self.read(sets).map(Box::new);
    }

    /// The scene that is to be loaded, once.
    pub fn take_scene(&mut self) -> Option<Box<SceneFile>> {
        self.is_loading |= self.scene.is_some();
        self.scene.take()
    }

    /// Takes note of what was found when the scene that was taken was loaded; nothing if it was taken as it is.
    pub fn note_refusal(&mut self, mistakes: &[Placed]) {
        if std::mem::take(&mut self.is_loading) && !mistakes.is_empty() {
            self.mistakes = mistakes.iter().map(|placed| Mistake::of(placed, &self.name)).collect();
        }
    }

    /// Reads a file that was dropped on the window.
    pub fn drop_file(&self, file: &DroppedFileHandle, context: &Context) {
        self.inbox.read(file, context);
    }

    /// Takes in what was dropped: a scene is opened, files of other kinds and those that the text names are kept for
    /// scenes. Gives what is to be told.
    pub fn take_dropped(&mut self) -> Option<Result<String, String>> {
        let mut told = None;
        for (name, bytes) in self.inbox.take() {
            told = Some(bytes.and_then(|bytes| self.take_in(&name, bytes)).map_err(|why| format!("{name}: {why}")));
        }
        told
    }

    fn take_in(&mut self, name: &str, bytes: Vec<u8>) -> Result<String, String> {
        // a part of the scene is no scene
        if name.ends_with(".ron") && !self.text.contains(name) {
            let text = String::from_utf8(bytes).map_err(|_| "it is not a text in UTF-8".to_string())?;
            self.open(name.to_string(), text);
            return Ok(format!("opened {name}"));
        }
        self.bundle.files.insert(name.to_string(), bytes);
        // what named it in vain may be right now
        self.checked.clear();
        Ok(format!("scenes can name the file {name} now, as in `mesh: File(path: \"{name}\")`"))
    }

    fn read(&mut self, sets: &[String]) -> Option<SceneFile> {
        self.checked.clone_from(&self.text);
        let read = SceneFile::from_memory(&self.name, &self.text, self.bundle.files.clone(), sets);
        let (scene, wrong) = match read {
            Err(wrong) => (None, wrong),
            Ok(scene) => {
                let mut wrong = scene.diagnostics();
                validate(&scene, &mut wrong);
                (Some(scene).filter(|_| !wrong.has_errors()), wrong)
            }
        };
        self.mistakes = wrong.placed().iter().map(|placed| Mistake::of(placed, &self.name)).collect();
        scene
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    const CUBE: &str = include_str!("../../../scenes/cube_under_gravity.ron");

    fn editor(text: &str) -> Editor {
        let scenes = vec![("cube.ron".into(), text.into())];
        Editor::new(Bundle { scenes, ..Bundle::default() }, None)
    }

    #[test]
    fn mistakes_stand_where_they_are() {
        let mut editor = editor(CUBE);
        assert!(editor.take_scene().is_some() && editor.take_scene().is_none());
        assert_eq!(editor.mistakes, []);
        editor.text = CUBE.replace("duration: 1,", "durations: 1,");
        editor.check();
        let mistake = editor.mistakes[0].clone();
        assert_eq!(&editor.text[mistake.bytes.unwrap()], "durations");
        assert!(mistake.is_error && mistake.line.starts_with("cube.ron:") && mistake.message.contains("duration"));
        // a value that makes no sense
        editor.text = CUBE.replace("duration: 1,", "duration: -1,");
        editor.load(&[]);
        assert_eq!(&editor.text[editor.mistakes[0].bytes.clone().unwrap()], "-1");
        assert!(editor.take_scene().is_none());
        editor.load(&["duration=2".into()]);
        assert_eq!(editor.take_scene().unwrap().scene.duration, 2.0);
    }

    #[test]
    fn what_loading_finds_stands_there_until_the_text_is_another() {
        let mut editor = editor(CUBE);
        assert!(editor.take_scene().is_some());
        let found = SceneFile::from_text("cube.ron", "(duration: x)", std::path::Path::new(""), &[]).unwrap_err();
        editor.note_refusal(&found.placed());
        assert!(!editor.mistakes.is_empty());
        editor.text.push(' ');
        editor.check();
        assert_eq!(editor.mistakes, []);
        editor.note_refusal(&found.placed());
        assert_eq!(editor.mistakes, []);
    }

    #[test]
    fn dropped_files_are_named_by_scenes_and_scenes_are_opened() {
        let mut editor = editor(CUBE);
        editor.text = CUBE.replace("Box(size", "File(path: \"lens.msh\", size");
        editor.inbox.put("lens.msh".into(), Ok(vec![1]));
        assert!(editor.take_dropped().unwrap().unwrap().contains("lens.msh"));
        assert_eq!(editor.bundle.files["lens.msh"], [1]);
        editor.inbox.put("other.ron".into(), Ok(CUBE.replace("duration: 1,", "duration: 3,").into_bytes()));
        assert!(editor.take_dropped().unwrap().is_ok() && editor.take_dropped().is_none());
        assert_eq!(editor.take_scene().unwrap().scene.duration, 3.0);
        assert_eq!(editor.name, "other.ron");
        editor.inbox.put("bad.ron".into(), Ok(vec![0xff]));
        assert!(editor.take_dropped().unwrap().unwrap_err().contains("bad.ron: it is not a text"));
        assert_eq!(editor.name, "other.ron");
    }
}
