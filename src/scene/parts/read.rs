//! Reads the files of parts into the text of a scene.

use crate::scene::diagnostic::{Diagnostic, TextFile};
use crate::scene::file_access::{FileAccess, FileKind, Outside, shortest};
use crate::scene::limits::{PART_DEPTH, PARTS, TEXT_BYTES};
use crate::scene::named_files::{named_in, values};
use crate::scene::set::{self, View};
use crate::scene::source::{Origin, Source, Stretches};
use crate::scene::suggest::choice;
use crate::scene::syntax::{Field, Kind, Node, Path, Segment, Span};
use std::path::Path as FilePath;
use std::sync::Arc;

/// A scene's text with its parts and all values put in.
pub struct Together {
    pub source: Source,
    pub view: View,
    /// What is wrong with files of parts and with values.
    pub mistakes: Vec<Diagnostic>,
    /// Whether all parts were read.
    pub is_whole: bool,
}

/// Puts the values of `--set` and the files of parts into a text. `name` is that of the scene's own file, by its path
/// from the folder that files are beside.
pub fn read(mut source: Source, sets: &[String], access: FileAccess<'_>, name: &str) -> Together {
    let texts = source.texts.clone();
    let mut reader = Reader {
        access,
        texts,
        chain: vec![shortest(name)],
        depth: 0,
        parts: 0,
        bytes: 0,
        mistakes: Vec::new(),
        is_whole: true,
    };
    let mut view = View::of(&source);
    if view.written().faults.is_empty() {
        let (first, then): (Vec<_>, Vec<_>) = sets.iter().enumerate().partition(|(_, set)| is_of_parts(set));
        reader.apply(&mut source, &mut view, &first);
        if reader.expand(&mut source, &view, "") {
            view = View::of(&source);
        }
        reader.apply(&mut source, &mut view, &then);
    }
    source.texts = reader.texts;
    Together { source, view, mistakes: reader.mistakes, is_whole: reader.is_whole }
}

/// Whether a value says what parts there are: others may be for what these hold.
fn is_of_parts(set: &str) -> bool {
    let way = Path::parse(set.split('=').next().unwrap_or_default()).unwrap_or_default();
    let name = |number: usize| {
        way.0.get(number).and_then(|segment: &Segment| match segment {
            Segment::Name(name) => Some(name.as_str()),
            Segment::Index(_) => None,
        })
    };
    name(0) == Some("parts") && name(2) != Some("content")
}

struct Reader<'a> {
    access: FileAccess<'a>,
    texts: Vec<Arc<TextFile>>,
    /// The files that are being read, outermost first.
    chain: Vec<String>,
    depth: usize,
    parts: usize,
    bytes: usize,
    mistakes: Vec<Diagnostic>,
    /// Whether all parts were read.
    is_whole: bool,
}

/// A value for a part, from the `set` of the file around it.
struct Override {
    path: String,
    /// Where the path begins.
    from: (usize, usize),
    value: Stretches,
    /// What to mark where it is wrong.
    at: (usize, Span),
}

impl Reader<'_> {
    fn apply(&mut self, source: &mut Source, view: &mut View, sets: &[(usize, &String)]) {
        for (number, set) in sets {
            match set::apply(source, view, (*number, set)) {
                Ok(()) => *view = View::of(source),
                Err(mistake) => self.mistakes.push(*mistake),
            }
        }
    }

    fn apply_overrides(&mut self, source: &mut Source, view: &mut View, overrides: &[&Override]) {
        for Override { path, from, value, at } in overrides {
            let value: Vec<(&str, Origin)> = value.iter().map(|(text, from)| (text.as_str(), *from)).collect();
            match set::put(source, view, (path, *from), &value) {
                Ok(()) => *view = View::of(source),
                Err((message, notes)) => drop(self.tell(at.clone(), format!("`set`: {message}")).notes(notes)),
            }
        }
    }

    /// Notes a mistake in one of the texts.
    fn tell(&mut self, (text, span): (usize, Span), message: String) -> &mut Diagnostic {
        let mut mistake = Diagnostic::error(span, message);
        mistake.file = self.texts.get(text).cloned();
        self.is_whole = false;
        self.mistakes.push(mistake);
        let last = self.mistakes.len() - 1;
        &mut self.mistakes[last]
    }

    /// Reads the files of all parts that a text names, theirs among them; `folder` is what they are relative to, with
    /// a slash at its end. Whether there are any.
    fn expand(&mut self, source: &mut Source, view: &View, folder: &str) -> bool {
        let Kind::Fields(fields) = &view.written().root.kind else { return false };
        let Some(parts) = field(fields, "parts") else { return false };
        let Kind::Map(entries) = &parts.value.kind else { return false };
        let mut edits: Vec<(Span, Stretches)> = Vec::new();
        for entry in entries {
            let Kind::Fields(fields) = &entry.value.kind else { continue };
            self.part(source, fields, folder, &mut edits);
        }
        edits.sort_by_key(|(span, _)| span.start);
        for (span, new) in edits.into_iter().rev() {
            let new: Vec<(&str, Origin)> = new.iter().map(|(text, from)| (text.as_str(), *from)).collect();
            source.replace(span, &new);
        }
        true
    }

    /// What becomes of the text of one part.
    fn part(&mut self, source: &Source, fields: &[Field], folder: &str, edits: &mut Vec<(Span, Stretches)>) {
        let place = |span: &Span| {
            let place = source.place(span);
            (place.text, place.span)
        };
        let glue = |text: &str, span: &Span| {
            let (number, span) = place(span);
            (text.to_string(), Origin::put_in(number, span.start))
        };
        let set = field(fields, "set").map(|set| &set.value);
        let overrides = set.map(|set| overrides(source, set)).unwrap_or_default();
        let (content, scene) = (field(fields, "content"), field(fields, "scene"));
        let marked = content.or(scene).map_or(0..0, |field| field.value.mark());
        self.parts += 1;
        if self.parts > PARTS {
            if self.parts == PARTS + 1 {
                self.tell(place(&marked), format!("the scene has more than {PARTS} parts, the most that are allowed"));
            }
            return;
        }
        if self.depth == PART_DEPTH {
            self.tell(
                place(&marked),
                format!("parts of parts of parts: at most {PART_DEPTH} within each other are allowed"),
            );
            return;
        }
        self.depth += 1;
        if let Some(content) = content {
            let span = &content.value.span;
            let part = Source::made_of(&source.stretches(span));
            if let Some(found) = self.put_together(part, folder, &overrides) {
                edits.push((span.clone(), found));
            }
        } else if let Some((scene, Kind::Text(name))) = scene.map(|scene| (scene, &scene.value.inner().kind)) {
            let at = place(&scene.value.span);
            if let Some(found) = self.file(name, folder, at, &overrides) {
                let before = scene.name.span.start;
                let stretches = [vec![glue("content: ", &marked)], found, vec![glue(", ", &marked)]].concat();
                edits.push((before..before, stretches));
            }
        }
        self.depth -= 1;
        if let Some(set) = set.filter(|_| !overrides.is_empty()) {
            edits.push((set.span.clone(), vec![glue("{}", &set.span)]));
        }
    }

    /// What a file of a part holds, whole.
    fn file(&mut self, name: &str, folder: &str, at: (usize, Span), overrides: &[Override]) -> Option<Stretches> {
        let full = if is_absolute(name) { name.to_string() } else { shortest(&format!("{folder}{name}")) };
        if name.is_empty() || name.contains(['"', '\\']) {
            let message =
                if name.is_empty() { "the path of the part is empty" } else { "a path of a part has no \" or \\" };
            self.tell(at, message.to_string()).note("relative to this file, with slashes: \"tools/probe.ron\"");
            return None;
        }
        if let Some(first) = self.chain.iter().position(|file| *file == full) {
            let circle = [&self.chain[first..], std::slice::from_ref(&full)].concat().join(" → ");
            self.tell(at, format!("`{full}` is a part of itself")).note(circle);
            return None;
        }
        let text = match self.access.bytes(&full, (TEXT_BYTES - self.bytes) as u64) {
            Ok(bytes) => String::from_utf8(bytes.into_owned()),
            Err(error) => {
                self.unreadable(&full, at, &error);
                return None;
            }
        };
        let Ok(text) = text else {
            self.tell(at, format!("`{full}` is not a text in UTF-8; is it the right file?"));
            return None;
        };
        self.bytes += text.len();
        let text = text.strip_prefix('\u{feff}').map(str::to_string).unwrap_or(text);
        let shown = self.access.file(&full).map_or(full.clone(), |path| path.display().to_string());
        let known = self.texts.iter().position(|file| file.name == shown && file.text == text);
        let number = known.unwrap_or_else(|| {
            self.texts.push(Arc::new(TextFile { name: shown, text: text.clone() }));
            self.texts.len() - 1
        });
        let inner = full.rfind('/').map_or("", |slash| &full[..=slash]).to_string();
        self.chain.push(full);
        let found = self.put_together(Source::of(number, text), &inner, overrides);
        self.chain.pop();
        // names in it are relative to its own folder, those in the scene to the scene's
        let ahead = name.rfind('/').map_or("", |slash| &name[..=slash]);
        found.map(|found| if ahead.is_empty() { found } else { ahead_of_paths(&found, ahead) })
    }

    fn unreadable(&mut self, full: &str, at: (usize, Span), error: &std::io::Error) {
        use std::io::ErrorKind;
        match self.access.look_up(full) {
            Err(_) => drop(self.tell(at, format!("`{full}` lies outside the scene's folder")).note(Outside::HOW)),
            Ok((FileKind::Nothing, there)) => {
                let wanted = full.rsplit('/').next().unwrap_or(full);
                let scenes: Vec<&str> =
                    there.iter().map(String::as_str).filter(|name| name.ends_with(".ron")).collect();
                let notes = if scenes.is_empty() { Vec::new() } else { choice(wanted, scenes) };
                self.tell(at, format!("there is no file `{full}`")).notes(notes);
            }
            Ok(_) if error.kind() == ErrorKind::FileTooLarge => {
                let message =
                    format!("with `{full}` the scene has more than {TEXT_BYTES} bytes, the most that are allowed");
                self.tell(at, message);
            }
            Ok(_) => drop(self.tell(at, format!("the part `{full}` cannot be read: {error}"))),
        }
    }

    /// Puts values and parts into the text of a part.
    fn put_together(&mut self, mut source: Source, folder: &str, overrides: &[Override]) -> Option<Stretches> {
        let mut view = View::of(&source);
        if !view.written().faults.is_empty() {
            for fault in &view.written().faults {
                let place = source.place(&fault.span);
                let message = fault.message.clone();
                self.tell((place.text, place.span), message).label(fault.label.clone());
            }
            return None;
        }
        let (first, then): (Vec<_>, Vec<_>) = overrides.iter().partition(|value| is_of_parts(&value.path));
        self.apply_overrides(&mut source, &mut view, &first);
        if self.expand(&mut source, &view, folder) {
            view = View::of(&source);
        }
        self.apply_overrides(&mut source, &mut view, &then);
        Some(source.stretches(&view.written().root.span))
    }
}

fn field<'a>(fields: &'a [Field], name: &str) -> Option<&'a Field> {
    fields.iter().find(|field| field.name.text == name)
}

/// The values of a `set`, with where their paths stand.
fn overrides(source: &Source, set: &Node) -> Vec<Override> {
    let Kind::Map(entries) = &set.kind else { return Vec::new() };
    let values = entries.iter().filter_map(|entry| {
        let Kind::Text(path) = &entry.key.kind else { return None };
        let at = source.place(&entry.key.span);
        Some(Override {
            path: path.clone(),
            // behind the quotation mark
            from: (at.text, at.span.start + 1),
            value: source.stretches(&entry.value.span),
            at: (at.text, at.span),
        })
    });
    values.collect()
}

/// The text of a part with a folder ahead of the paths in it.
fn ahead_of_paths(text: &Stretches, folder: &str) -> Stretches {
    let mut source = Source::made_of(text);
    let view = View::of(&source);
    let root = &view.written().root;
    let mut found = Vec::new();
    named_files(root, &mut found);
    found.sort_by_key(|span| span.start);
    for span in found.into_iter().rev() {
        let Some(quote) = source.text()[span.clone()].find('"') else { continue };
        let at = span.start + quote + 1;
        let place = source.place(&span);
        source.replace(at..at, &[(folder, Origin::put_in(place.text, place.span.start))]);
    }
    let all = 0..source.text().len();
    source.stretches(&all)
}

/// Where a part and its parts name files.
fn named_files(content: &Node, found: &mut Vec<Span>) {
    let named = named_in(content).into_iter().filter(|(_, name, _)| !is_absolute(name));
    found.extend(named.map(|(_, _, node)| node.span.clone()));
    let mut parts = Vec::new();
    values(content, &["parts", "*", "content"], Path::default(), &mut parts);
    parts.into_iter().for_each(|(_, part)| named_files(part, found));
}

fn is_absolute(name: &str) -> bool {
    FilePath::new(name).is_absolute()
}
