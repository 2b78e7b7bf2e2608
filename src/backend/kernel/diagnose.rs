//! What can be wrong with a kernel, said with the fragment's own file, line and column.

use std::ops::Range;

use codespan_reporting::diagnostic::{Diagnostic, Label};
use codespan_reporting::files::{Files, SimpleFiles};
use codespan_reporting::term;
use naga::front::wgsl::ParseError;
use naga::valid::ValidationError;
use naga::{Span, WithSpan};

use super::Fragment;

/// What is wrong with a kernel.
#[derive(Clone, Debug, thiserror::Error)]
pub enum KernelError {
    /// The WGSL does not parse or is not valid.
    #[error("{report}")]
    Wgsl {
        /// Path of the fragment at fault.
        path: String,
        /// Line in that fragment, from 1; 0 when the place is unknown.
        line: usize,
        /// Column in that line, in characters, from 1; 0 when the place is unknown.
        column: usize,
        /// One line: what is wrong.
        message: String,
        /// The whole text for a person, with the source lines.
        report: String,
        /// Fragment, bytes in it, and a word on each place that matters; the place at fault first.
        places: Vec<(String, Range<usize>, String)>,
        /// More on what is wrong.
        notes: Vec<String>,
    },
    /// The entry point is not there.
    #[error("kernel `{label}`: no compute entry point `{entry}` in {paths}; there is {}", listed(found))]
    NoEntry {
        /// The kernel.
        label: String,
        /// The entry point asked for.
        entry: String,
        /// The fragments.
        paths: String,
        /// The entry points there are.
        found: Vec<String>,
    },
    /// A function that others call is not there.
    #[error("no function `{name}` in {paths}; there is {}", listed(found))]
    NoFunction {
        /// The function.
        name: String,
        /// The fragments that should have it.
        paths: String,
        /// The functions there are.
        found: Vec<String>,
    },
    /// Buffers and variables do not match by name.
    #[error(transparent)]
    Bindings(#[from] Box<NameMismatch>),
    /// A variable that is no buffer, or a `step` that is no uniform.
    #[error(
        "WGSL variable `{variable}`: {problem}; kernels use var<storage, read>, var<storage, read_write> and var<uniform>"
    )]
    Variable {
        /// The WGSL variable.
        variable: String,
        /// What is wrong with it.
        problem: String,
    },
    /// A struct that no fragment declares.
    #[error("no WGSL struct `{name}`; there is {}", listed(found))]
    NoStruct {
        /// The struct asked for.
        name: String,
        /// The structs there are.
        found: Vec<String>,
    },
}

/// Buffers and variables that do not match by name: all of both, so that a slip of the pen shows.
#[derive(Clone, Debug, thiserror::Error)]
#[error(
    "kernel `{label}` (`{entry}` in {paths}): buffers and variables do not match\n  \
     variables without a buffer: {}\n  buffers without a variable: {}\n  \
     `{entry}` uses: {}\n  declared: {}\n  the kernel gives: {}",
    listed(without_buffer),
    listed(without_variable),
    listed(used),
    listed(declared),
    listed(given)
)]
pub struct NameMismatch {
    /// The kernel.
    pub label: String,
    /// The entry point.
    pub entry: String,
    /// The fragments.
    pub paths: String,
    /// Variables that the entry point uses and no buffer is given for.
    pub without_buffer: Vec<String>,
    /// Buffers given for variables that no fragment declares (or twice).
    pub without_variable: Vec<String>,
    /// Variables that the entry point uses.
    pub used: Vec<String>,
    /// Variables that the fragments declare.
    pub declared: Vec<String>,
    /// Variables that the kernel gives buffers for.
    pub given: Vec<String>,
}

/// `a, b, c`, or `none`.
fn listed(names: &[String]) -> String {
    if names.is_empty() { "none".to_owned() } else { names.join(", ") }
}

/// The fragments in one text, and the way back from the text to the fragments.
pub(super) struct Sources {
    text: String,
    files: SimpleFiles<String, String>,
    /// Bytes of `text` that each file covers.
    ranges: Vec<Range<usize>>,
}

impl Sources {
    /// Concatenates the fragments, each starting on a line of its own.
    pub(super) fn new<'a>(fragments: impl IntoIterator<Item = &'a Fragment>) -> Self {
        let mut sources = Self { text: String::new(), files: SimpleFiles::new(), ranges: Vec::new() };
        for fragment in fragments {
            let start = sources.text.len();
            sources.text.push_str(&fragment.text);
            sources.ranges.push(start..sources.text.len());
            sources.text.push('\n');
            sources.files.add(fragment.path.clone(), fragment.text.clone().into_owned());
        }
        sources
    }

    /// The concatenated text.
    pub(super) fn text(&self) -> &str {
        &self.text
    }

    /// A parse error, mapped to its fragments.
    pub(super) fn parse_error(&self, error: &ParseError) -> KernelError {
        let labels = error.labels().map(|(span, text)| (span, text.to_owned())).collect();
        self.error(error.message().to_owned(), labels, error.notes().map(str::to_owned).collect())
    }

    /// A validation error, mapped to its fragments. naga's outer messages only say "function is invalid": the chain of
    /// causes goes into the notes and its last link into the message.
    pub(super) fn validation_error(&self, error: &WithSpan<ValidationError>) -> KernelError {
        let mut chain = vec![error.as_inner().to_string()];
        let mut cause = std::error::Error::source(error.as_inner());
        while let Some(inner) = cause {
            chain.push(inner.to_string());
            cause = inner.source();
        }
        let message = chain.pop().unwrap_or_default();
        // names of naga's own types ("naga::ir::Expression [3]") mean nothing to the author of a shader
        let mut labels: Vec<_> = error
            .spans()
            .map(|(span, text)| (*span, if text.starts_with("naga::") { String::new() } else { text.clone() }))
            .collect();
        labels.sort_by_key(|(span, _)| span.to_range().map_or(usize::MAX, |range| range.len()));
        self.error(message, labels, chain)
    }

    /// An error at one place.
    pub(super) fn error_at(&self, message: String, span: Span, notes: &[String]) -> KernelError {
        self.error(message, vec![(span, String::new())], notes.to_vec())
    }

    fn error(&self, message: String, labels: Vec<(Span, String)>, notes: Vec<String>) -> KernelError {
        let mut places = Vec::new();
        for (span, text) in labels {
            // a whole function underlined without a word hides the place
            if text.is_empty() && !places.is_empty() {
                continue;
            }
            if let Some((file, range)) = span.to_range().and_then(|range| self.place(range)) {
                let label = if places.is_empty() { Label::primary } else { Label::secondary };
                places.push(label(file, range).with_message(text));
            }
        }
        let (path, line, column) = match places.first() {
            Some(place) => self.position(place.file_id, place.range.start),
            None => (String::new(), 0, 0),
        };
        let named = |place: &Label<usize>| {
            (self.files.name(place.file_id).unwrap_or_default(), place.range.clone(), place.message.clone())
        };
        let found = places.iter().map(named).collect();
        let diagnostic = Diagnostic::error().with_message(&message).with_labels(places).with_notes(notes.clone());
        let report = term::emit_into_string(&term::Config::default(), &self.files, &diagnostic);
        let report = report.map_or_else(|_| format!("{path}:{line}:{column}: {message}"), |r| r.trim_end().to_owned());
        KernelError::Wgsl { path, line, column, message, report, places: found, notes }
    }

    /// The fragment, and the bytes in it, that a range of the whole text begins in.
    fn place(&self, range: Range<usize>) -> Option<(usize, Range<usize>)> {
        // an error at the end of the text lies behind the last fragment's last byte: it is that fragment's
        let file = self.ranges.iter().position(|r| range.start <= r.end).or(self.ranges.len().checked_sub(1))?;
        let whole = &self.ranges[file];
        let start = range.start.clamp(whole.start, whole.end) - whole.start;
        Some((file, start..(range.end.min(whole.end).saturating_sub(whole.start)).max(start)))
    }

    fn position(&self, file: usize, byte: usize) -> (String, usize, usize) {
        let path = self.files.name(file).unwrap_or_default();
        self.files.location(file, byte).map_or((path.clone(), 0, 0), |at| (path, at.line_number, at.column_number))
    }
}
