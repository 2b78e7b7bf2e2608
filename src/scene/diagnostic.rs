//! What is wrong with a scene, where, and how it is shown.

use super::excerpt::Excerpts;
use super::limits::MISTAKES;
use super::source::Source;
use super::syntax::{Fault, Node, Path, Span, Tree};
use codespan_reporting::diagnostic::{Diagnostic as Shown, Label, Severity as Grade};
use codespan_reporting::term::{self, Config, StylesWriter, termcolor::Ansi};
use std::fmt;
use std::sync::Arc;

/// Whether a scene can run in spite of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// It cannot run.
    Error,
    /// It can, but probably not as meant.
    Warning,
}

/// A file beside the scene that mistakes can be in.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TextFile {
    /// Its path, as messages show it.
    pub name: String,
    /// What it holds.
    pub text: String,
}

/// One mistake.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// How bad it is.
    pub severity: Severity,
    /// What is wrong: one sentence without a full stop.
    pub message: String,
    /// Where it stands in the scene's text, or in `file`; none for what has no place there.
    pub at: Option<Span>,
    /// Another file that it is about.
    pub file: Option<Arc<TextFile>>,
    /// A word on the place.
    pub label: String,
    /// Other places that matter, each with a word.
    pub also: Vec<(Span, String)>,
    /// What is allowed, what to do.
    pub notes: Vec<String>,
}

/// A mistake with where it stands in the text that its author wrote.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Placed {
    /// The name of that text: the scene's, that of another file, or `--set`; empty for what has no place.
    pub text: String,
    /// The bytes of it.
    pub bytes: Span,
    /// The same as line and column: `cube.ron:3:15`; empty for what has no place.
    pub place: String,
    /// What is wrong.
    pub diagnostic: Diagnostic,
}

impl Diagnostic {
    /// An error at a place.
    #[doc(hidden)]
    pub fn error(at: impl Into<Option<Span>>, message: impl Into<String>) -> Self {
        Self {
            severity: Severity::Error,
            message: shortened(message.into(), LONGEST),
            at: at.into(),
            file: None,
            label: String::new(),
            also: Vec::new(),
            notes: Vec::new(),
        }
    }

    /// Adds a word on the place.
    #[doc(hidden)]
    pub fn label(&mut self, label: impl Into<String>) -> &mut Self {
        self.label = shortened(label.into(), LONGEST_LABEL);
        self
    }

    /// Adds a note: what is allowed, what to do.
    #[doc(hidden)]
    pub fn note(&mut self, note: impl Into<String>) -> &mut Self {
        self.notes.push(shortened(note.into(), LONGEST));
        self
    }

    /// Adds notes.
    #[doc(hidden)]
    pub fn notes(&mut self, notes: impl IntoIterator<Item = String>) -> &mut Self {
        self.notes.extend(notes.into_iter().map(|note| shortened(note, LONGEST)));
        self
    }

    /// Adds a second place.
    #[doc(hidden)]
    pub fn also(&mut self, at: Span, label: impl Into<String>) -> &mut Self {
        self.also.push((at, shortened(label.into(), LONGEST_LABEL)));
        self
    }
}

impl From<Fault> for Diagnostic {
    fn from(fault: Fault) -> Self {
        let mut diagnostic = Self::error(fault.span, fault.message);
        diagnostic.label(fault.label);
        if let Some((at, label)) = fault.also {
            diagnostic.also(at, label);
        }
        diagnostic
    }
}

/// The longest sentence that is told (bytes).
const LONGEST: usize = 4000;
/// The longest word on a place, which stands beside a line that is cut to fit.
const LONGEST_LABEL: usize = 400;

/// The beginning of a text that is too long to be read: a word of a scene that is repeated may be of any length.
fn shortened(mut text: String, most: usize) -> String {
    if text.len() > most {
        text.truncate(text.floor_char_boundary(most));
        text.push_str("...");
    }
    text
}

/// `cube.ron:3:15`: a file, a line and a column of it.
fn numbered(file: &TextFile, start: usize) -> String {
    let before = &file.text[..start];
    let line = before.matches('\n').count() + 1;
    let column = before.chars().rev().take_while(|c| *c != '\n').count() + 1;
    format!("{}:{line}:{column}", file.name)
}

/// How many mistakes are shown in one go.
const MOST_SHOWN: usize = 50;

/// All that is wrong with one scene.
#[derive(Clone, Debug, Default)]
pub struct Diagnostics {
    source: Option<Arc<Source>>,
    tree: Option<Arc<Tree>>,
    list: Vec<Diagnostic>,
    /// Whether errors gave way to later ones.
    lost_errors: bool,
}

impl Diagnostics {
    /// Nothing wrong yet with this text.
    #[doc(hidden)]
    pub fn new(source: Arc<Source>, tree: Arc<Tree>) -> Self {
        Self { source: Some(source), tree: Some(tree), ..Self::default() }
    }

    /// One mistake that is not in a text: a file that cannot be read.
    #[doc(hidden)]
    pub fn of(message: impl Into<String>) -> Self {
        let mut diagnostics = Self::default();
        diagnostics.push(Diagnostic::error(None, message));
        diagnostics
    }

    /// The text they are about; empty when there is none.
    #[doc(hidden)]
    pub fn text(&self) -> &str {
        self.source.as_ref().map_or("", |source| source.text())
    }

    /// Adds a mistake.
    #[doc(hidden)]
    pub fn push(&mut self, diagnostic: Diagnostic) -> &mut Diagnostic {
        // of more than anybody reads the last one gives way
        if self.list.len() >= MISTAKES {
            self.lost_errors |= self.list.pop().is_some_and(|lost| lost.severity == Severity::Error);
        }
        self.list.push(diagnostic);
        let last = self.list.len() - 1;
        &mut self.list[last]
    }

    /// Adds an error about the value at a path such as `schedule[2]` or `bodies.cube.mesh`. When the file does not
    /// have that value (a default), what should hold it is marked.
    #[doc(hidden)]
    pub fn error_at(&mut self, path: impl Into<Path>, message: impl Into<String>) -> &mut Diagnostic {
        let at = self.span(&path.into());
        self.push(Diagnostic::error(at, message))
    }

    /// Adds an error about some bytes of the text `value` that stands at a path; about all of it where it is not
    /// written as it is, but with backslashes.
    #[doc(hidden)]
    pub fn error_within(
        &mut self,
        path: impl Into<Path>,
        value: &str,
        bytes: Span,
        message: impl Into<String>,
    ) -> &mut Diagnostic {
        let path = path.into();
        let found =
            self.tree.as_ref().and_then(|tree| path.find(&tree.root).ok().map(|node| node.inner().span.clone()));
        let text = self.source.as_ref().map_or("", |source| source.text());
        let within = found.and_then(|span| {
            let start = span.start + text.get(span)?.find(value)? + bytes.start;
            Some(start..start + bytes.len())
        });
        let at = within.or_else(|| self.span(&path));
        self.push(Diagnostic::error(at, message))
    }

    /// As [`Self::error_at`], for what does not keep the scene from running.
    #[doc(hidden)]
    pub fn warn_at(&mut self, path: impl Into<Path>, message: impl Into<String>) -> &mut Diagnostic {
        let diagnostic = self.error_at(path, message);
        diagnostic.severity = Severity::Warning;
        diagnostic
    }

    /// Adds an error without a place.
    pub fn error(&mut self, message: impl Into<String>) -> &mut Diagnostic {
        self.push(Diagnostic::error(None, message))
    }

    /// Whether an error has been told about the value at a path, or a part of it.
    #[doc(hidden)]
    pub fn has_error_in(&self, path: impl Into<Path>) -> bool {
        let Some(tree) = self.tree.as_ref() else { return false };
        let within = path.into().span(&tree.root);
        let inside = |at: &Span| within.start <= at.start && at.end <= within.end;
        let told =
            |d: &Diagnostic| d.severity == Severity::Error && d.file.is_none() && d.at.as_ref().is_some_and(inside);
        self.list.iter().any(told)
    }

    /// Whether a part of the scene brings what is at a path.
    #[doc(hidden)]
    pub fn is_of_part(&self, path: impl Into<Path>) -> bool {
        let Some(tree) = self.tree.as_ref() else { return false };
        let (path, parts): (Path, Path) = (path.into(), Path::default().name("parts"));
        // the text of what a part holds stands where the part does
        match (path.find(&tree.root), parts.find(&tree.root)) {
            (Ok(node), Ok(parts)) => parts.span.start <= node.span.start && node.span.end <= parts.span.end,
            _ => false,
        }
    }

    fn span(&self, path: &Path) -> Option<Span> {
        let tree = self.tree.as_ref()?;
        let span = path.span(&tree.root);
        let text = self.source.as_ref()?.text();
        // of a value that goes over several lines its beginning is marked
        match path.find(&tree.root) {
            Ok(node) if text[span.clone()].contains('\n') => Some(Node::mark(node)),
            _ => Some(span),
        }
    }

    /// Whether one of them keeps the scene from running.
    pub fn has_errors(&self) -> bool {
        self.lost_errors || self.list.iter().any(|diagnostic| diagnostic.severity == Severity::Error)
    }

    /// Whether nothing is wrong.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// The mistakes, in the order of the file.
    pub fn list(&self) -> Vec<&Diagnostic> {
        self.sorted()
    }

    /// One line for each, in the order of the file, as editors read them: `cube.ron:3:15: error: ...`.
    pub fn lines(&self) -> Vec<String> {
        self.sorted().into_iter().map(|diagnostic| self.line(diagnostic)).collect()
    }

    fn line(&self, diagnostic: &Diagnostic) -> String {
        let grade = match diagnostic.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        };
        let message = &diagnostic.message;
        match (&diagnostic.file, &diagnostic.at) {
            (Some(file), None) => format!("{}: {grade}: {message}", file.name),
            (_, None) => format!("{grade}: {message}"),
            (_, Some(at)) => match self.text_at(diagnostic, at) {
                Some((file, bytes)) => format!("{}: {grade}: {message}", numbered(file, bytes.start)),
                None => format!("{grade}: {message}"),
            },
        }
    }

    /// The mistakes with where they stand in what their author wrote, in the order of the file: for editors.
    pub fn placed(&self) -> Vec<Placed> {
        let placed = |diagnostic: &Diagnostic| {
            let found = diagnostic.at.as_ref().and_then(|at| self.text_at(diagnostic, at));
            let (text, place, bytes) = match found {
                Some((file, bytes)) => (file.name.clone(), numbered(file, bytes.start), bytes),
                None => (String::new(), String::new(), 0..0),
            };
            Placed { text, bytes, place, diagnostic: diagnostic.clone() }
        };
        self.sorted().into_iter().map(placed).collect()
    }

    /// The file that a place of a mistake is in, and its bytes there.
    fn text_at<'a>(&'a self, diagnostic: &'a Diagnostic, at: &Span) -> Option<(&'a TextFile, Span)> {
        if let Some(file) = &diagnostic.file {
            return Some((file, at.clone()));
        }
        let source = self.source.as_ref()?;
        let place = source.place(at);
        Some((source.texts.get(place.text)?, place.span))
    }

    fn sorted(&self) -> Vec<&Diagnostic> {
        let mut sorted: Vec<&Diagnostic> = self.list.iter().collect();
        let file = |diagnostic: &Diagnostic| diagnostic.file.as_ref().map(|file| file.name.clone());
        sorted.sort_by_key(|diagnostic| (file(diagnostic), diagnostic.at.as_ref().map(|span| span.start)));
        sorted
    }

    /// All of them as text for people, in the order of the file, errors and warnings mixed; `color` for terminals.
    pub fn render(&self, color: bool) -> String {
        let mut texts: Vec<(&str, &str)> = Vec::new();
        if let Some(source) = &self.source {
            texts.extend(source.texts.iter().map(|text| (text.name.as_str(), text.text.as_str())));
        }
        let own = texts.len();
        let sorted = self.sorted();
        let mut text = String::new();
        for diagnostic in sorted.iter().take(MOST_SHOWN) {
            let mut shown = self.shown(diagnostic);
            texts.truncate(own);
            if let (Some(file), Some(at)) = (&diagnostic.file, &diagnostic.at) {
                shown.labels.push(Label::primary(own, at.clone()).with_message(&diagnostic.label));
                texts.push((&file.name, &file.text));
            }
            let files = Excerpts::of(&texts, &mut shown.labels);
            let config = Config::default();
            let written = if color {
                let mut bytes = Vec::new();
                let styles = term::Styles::default();
                term::emit_to_write_style(
                    &mut StylesWriter::new(Ansi::new(&mut bytes), &styles),
                    &config,
                    &files,
                    &shown,
                )
                .map(|()| text.push_str(&String::from_utf8_lossy(&bytes)))
            } else {
                term::emit_to_string(&mut text, &config, &files, &shown)
            };
            if written.is_err() {
                // a place that cannot be shown must not swallow the message
                text.push_str(&format!("{}\n", diagnostic.message));
            }
        }
        if sorted.len() > MOST_SHOWN {
            text.push_str(&format!("and {} more\n", sorted.len() - MOST_SHOWN));
        }
        // trailing blanks are of no use to anyone who compares or pastes
        text.lines().map(|line| format!("{}\n", line.trim_end())).collect()
    }

    fn shown(&self, diagnostic: &Diagnostic) -> Shown<usize> {
        let grade = match diagnostic.severity {
            Severity::Error => Grade::Error,
            Severity::Warning => Grade::Warning,
        };
        let mut labels = Vec::new();
        if let (Some(source), Some(at), None) = (&self.source, &diagnostic.at, &diagnostic.file) {
            let place = source.place(at);
            labels.push(Label::primary(place.text, place.span).with_message(&diagnostic.label));
            for (span, label) in &diagnostic.also {
                let place = source.place(span);
                labels.push(Label::secondary(place.text, place.span).with_message(label));
            }
        }
        let message = match (&diagnostic.file, &diagnostic.at) {
            (Some(file), None) => format!("{}: {}", file.name, diagnostic.message),
            _ => diagnostic.message.clone(),
        };
        Shown::new(grade).with_message(message).with_labels(labels).with_notes(diagnostic.notes.clone())
    }
}

impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render(false))
    }
}

impl std::error::Error for Diagnostics {}
