//! From a scene file to a [`Scene`].

use super::check::check;
use super::diagnostic::{Diagnostic, Diagnostics};
use super::file_access::{FileAccess, FileSource};
use super::limits::{self, Allowed};
use super::partial::wrong_values;
use super::parts::{self, Problem, Together};
use super::schema::Scene;
use super::source::Source;
use super::syntax::{Kind, Node, Path as Way, Segment, Span, Tree};
use crate::mesh::Mesh;
use glam::DVec3;
use ron::extensions::Extensions;
use std::collections::BTreeMap;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A scene with the text it was read from, so that later complaints can say where.
#[derive(Clone, Debug)]
pub struct SceneFile {
    /// The scene.
    pub scene: Scene,
    /// The file; for a scene that was not read from one, its name.
    pub path: PathBuf,
    /// The folder that mesh files are relative to.
    pub folder: PathBuf,
    /// Where those files are.
    pub files: FileSource,
    /// What the scene may ask for.
    pub allowed: Allowed,
    /// Where nodes of bodies are at rest (m), in the author's order, where a program knows better than the scene: in
    /// place of what `rest_shape` says.
    pub rest_shapes: BTreeMap<String, Vec<DVec3>>,
    /// Meshes that a program has made, by the names that `File(path: ...)` and `rest_shape` give them, before files of
    /// those names. They are taken as they are: `flip_inverted` turns nothing in them.
    pub meshes: BTreeMap<String, Arc<Mesh>>,
    source: Arc<Source>,
    tree: Arc<Tree>,
}

/// How RON is read: an optional value may be written without `Some`, and the fields of what a variant holds right in
/// the variant's brackets.
pub fn options() -> ron::Options {
    ron::Options::default().with_default_extension(Extensions::IMPLICIT_SOME | Extensions::UNWRAP_VARIANT_NEWTYPES)
}

impl SceneFile {
    /// Reads a scene file and puts in the values of `--set path=value`. Whether the values make sense is for
    /// [`validate`](super::validate()) to say.
    ///
    /// # Errors
    /// All mistakes in the words of the file, or that it cannot be read.
    pub fn load(path: impl AsRef<Path>, sets: &[String]) -> Result<Self, Diagnostics> {
        Self::load_allowing(path, sets, Allowed::default())
    }

    /// As [`Self::load`]; `allowed` is what the scene may ask for.
    ///
    /// # Errors
    /// As [`Self::load`].
    pub fn load_allowing(path: impl AsRef<Path>, sets: &[String], allowed: Allowed) -> Result<Self, Diagnostics> {
        let path = path.as_ref();
        let name = path.display().to_string();
        let file = std::fs::File::open(path)
            .map_err(|error| Diagnostics::of(format!("cannot read the scene {name}: {error}")))?;
        let folder = path.parent().map(Path::to_path_buf).unwrap_or_default();
        let mut scene = Self::read_allowing(&name, file, &folder, sets, allowed)?;
        scene.path = path.to_path_buf();
        Ok(scene)
    }

    /// As [`Self::load_allowing`], from whatever can be read, the standard input for instance; `folder` is what mesh
    /// files are relative to.
    ///
    /// # Errors
    /// As [`Self::load`].
    #[doc(hidden)]
    pub fn read_allowing(
        name: &str,
        from: impl Read,
        folder: &Path,
        sets: &[String],
        allowed: Allowed,
    ) -> Result<Self, Diagnostics> {
        let mut bytes = Vec::new();
        // one byte more than is allowed tells that there are too many, be it a device without end
        from.take(limits::TEXT_BYTES as u64 + 1)
            .read_to_end(&mut bytes)
            .map_err(|error| Diagnostics::of(format!("cannot read the scene {name}: {error}")))?;
        if bytes.len() > limits::TEXT_BYTES {
            return Err(Diagnostics::of(too_long(name)));
        }
        let text = String::from_utf8(bytes).map_err(|error| {
            let at = error.utf8_error().valid_up_to();
            Diagnostics::of(format!("the scene {name} is not a text in UTF-8 (byte {at}); is it the right file?"))
        })?;
        Self::from_text_allowing(name, &text, folder, sets, allowed)
    }

    /// As [`Self::load`], for a text that need not be a file; `folder` is what mesh files are relative to.
    ///
    /// # Errors
    /// All mistakes in the words of the text.
    pub fn from_text(name: &str, text: &str, folder: &Path, sets: &[String]) -> Result<Self, Diagnostics> {
        Self::from_text_allowing(name, text, folder, sets, Allowed::default())
    }

    /// As [`Self::from_text`]; `allowed` is what the scene may ask for.
    ///
    /// # Errors
    /// As [`Self::from_text`].
    pub fn from_text_allowing(
        name: &str,
        text: &str,
        folder: &Path,
        sets: &[String],
        allowed: Allowed,
    ) -> Result<Self, Diagnostics> {
        Self::from_parts(name, text, (folder, FileSource::Disk), sets, allowed)
    }

    /// As [`Self::from_text`], for a scene whose meshes and laws are in memory, by the names that it gives them:
    /// nothing is read from a disk.
    ///
    /// # Errors
    /// As [`Self::from_text`].
    pub fn from_memory(
        name: &str,
        text: &str,
        files: BTreeMap<String, Vec<u8>>,
        sets: &[String],
    ) -> Result<Self, Diagnostics> {
        Self::from_parts(name, text, (Path::new(""), FileSource::Memory(Arc::new(files))), sets, Allowed::default())
    }

    /// The same scene read from another text, with values put in as by `--set`.
    ///
    /// # Errors
    /// As [`Self::from_text`].
    pub(crate) fn again(&self, text: &str, sets: &[String]) -> Result<Self, Diagnostics> {
        let name = self.path.display().to_string();
        let again = Self::from_parts(&name, text, (&self.folder, self.files.clone()), sets, self.allowed)?;
        Ok(Self {
            path: self.path.clone(),
            rest_shapes: self.rest_shapes.clone(),
            meshes: self.meshes.clone(),
            ..again
        })
    }

    fn from_parts(
        name: &str,
        text: &str,
        (folder, files): (&Path, FileSource),
        sets: &[String],
        allowed: Allowed,
    ) -> Result<Self, Diagnostics> {
        if text.len() > limits::TEXT_BYTES {
            return Err(Diagnostics::of(too_long(name)));
        }
        if sets.len() > limits::SETS {
            let (found, most) = (sets.len(), limits::SETS);
            return Err(Diagnostics::of(format!("--set is given {found} times; at most {most} are allowed")));
        }
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let access = FileAccess { folder, files: &files, outside: allowed.outside };
        let own = Path::new(name).strip_prefix(folder).unwrap_or(Path::new(name)).display().to_string();
        let Together { source, view, mut mistakes, is_whole } =
            parts::read(Source::new(name, text, sets), sets, access, &own);
        let written = view.written();
        mistakes.extend(written.faults.iter().cloned().map(Diagnostic::from));
        let (partial, wrong_words) = check::<Scene>(&written.root, source.text());
        mistakes.extend(wrong_words);
        let tell = |problem: &Problem, known: &[Diagnostic]| {
            let (at, value) = parts::find(&written.root, &problem.path);
            let is_in = |value: &Span, wrong: &Span| value.start <= wrong.start && wrong.end <= value.end;
            let mut wrong = known.iter().filter_map(|mistake| mistake.at.as_ref());
            // of what could not be read a stand-in is here, of which there is nothing to be told
            if value.is_some_and(|value| wrong.any(|wrong| is_in(&value, wrong))) {
                return None;
            }
            let mut mistake = Diagnostic::error(at, problem.message.clone());
            mistake.note(problem.note.clone());
            Some(mistake)
        };
        let (source, tree) = (Arc::new(source), Arc::new(view.merged()));
        let mut diagnostics = Diagnostics::new(Arc::clone(&source), Arc::clone(&tree));
        let file = |scene| Self {
            scene,
            path: name.into(),
            folder: folder.to_path_buf(),
            files: files.clone(),
            allowed,
            rest_shapes: BTreeMap::new(),
            meshes: BTreeMap::new(),
            source,
            tree,
        };
        // without the parts that were not read, what names something of them is not wrong
        if let Some(mut scene) = partial.filter(|_| is_whole) {
            let is_sound = mistakes.is_empty();
            let problems = parts::flatten(&mut scene);
            let told: Vec<Diagnostic> = problems.iter().filter_map(|problem| tell(problem, &mistakes)).collect();
            mistakes.extend(told);
            if mistakes.is_empty() {
                return Ok(file(scene));
            }
            if !is_sound {
                let wrong = wrong_values(&file(scene), &mistakes);
                mistakes.extend(wrong);
            }
        }
        for mistake in mistakes {
            diagnostics.push(mistake);
        }
        Err(diagnostics)
    }

    /// The text of the scene with the values of `--set` and what its parts hold in it.
    pub fn text(&self) -> &str {
        self.source.text()
    }

    /// The syntax tree of [`Self::text`], in which what parts hold has the names that the scene knows it by.
    #[doc(hidden)]
    pub fn tree(&self) -> &Tree {
        &self.tree
    }

    /// The scene's parts: their names, and the files that they come from, empty where there is none.
    pub fn parts(&self) -> Vec<(&str, &str)> {
        let parts = Way::from("parts").find(&self.tree.root).ok();
        let Some(Kind::Map(entries)) = parts.map(|parts| &parts.kind) else { return Vec::new() };
        let scene = Segment::Name("scene".into());
        let file = entries.iter().map(|entry| entry.value.child(&scene).and_then(text).unwrap_or_default());
        entries.iter().zip(file).filter_map(|(entry, file)| Some((text(&entry.key)?, file))).collect()
    }

    /// An empty list for complaints about this scene.
    #[doc(hidden)]
    pub fn diagnostics(&self) -> Diagnostics {
        Diagnostics::new(Arc::clone(&self.source), Arc::clone(&self.tree))
    }
}

fn text(node: &Node) -> Option<&str> {
    if let Kind::Text(text) = &node.inner().kind { Some(text) } else { None }
}

fn too_long(name: &str) -> String {
    format!(
        "the scene {name} has more than {} bytes, the most that are allowed; long lists of nodes can be named sets of a mesh",
        limits::TEXT_BYTES
    )
}
