//! Compares a tree with the words that a Rust type allows, and tells all mistakes at once.
//!
//! serde stops at the first mistake. Here a value that is wrong is noted and a stand-in is handed on in its place, so
//! that the rest is read too. That a field must be there serde tells only by refusing a struct that lacks it: then the
//! tree is read once more, with that known.

mod access;
mod stand_in;
mod value;
mod wording;

use super::diagnostic::Diagnostic;
use super::limits::MISTAKES;
use super::source::Source;
use super::syntax::{Kind, Node, Span, parse};
use serde::de::DeserializeOwned;
use std::cell::{RefCell, RefMut};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use value::Value;

/// All that keeps a tree from being a `T`.
///
/// The `T` that comes with it holds what could be read, and stand-ins for the rest: good for finding more mistakes and
/// nothing else.
pub fn check<T: DeserializeOwned>(root: &Node, text: &str) -> (Option<T>, Vec<Diagnostic>) {
    let mut all = Vec::new();
    twice(root, text, &mut all);
    let (value, about) = read::<T>(root, text);
    all.extend(about.found.take());
    (value, all)
}

/// Whether the value at `span` must be a text and is something else.
pub fn wants_text<T: DeserializeOwned>(source: &Source, span: &Span) -> bool {
    let tree = parse(source.text());
    read::<T>(&tree.root, source.text()).1.texts_wanted.take().contains(span)
}

/// Where maps must be and something else is.
pub fn wants_maps<T: DeserializeOwned>(source: &Source) -> Vec<Span> {
    let tree = parse(source.text());
    read::<T>(&tree.root, source.text()).1.maps_wanted.take()
}

/// Reads the tree as a `T`, as often as it takes to learn which fields are required.
fn read<'a, T: DeserializeOwned>(root: &'a Node, text: &'a str) -> (Option<T>, About<'a>) {
    let mut about = About {
        text,
        texts_wanted: RefCell::default(),
        maps_wanted: RefCell::default(),
        said_before: RefCell::new(Diagnostic::error(None, "")),
        found: RefCell::default(),
        required: BTreeSet::new(),
    };
    loop {
        about.found.take();
        match T::deserialize(Value { node: root, about: &about, subject: "the scene", is_content: false }) {
            Ok(value) => return (Some(value), about),
            // a type tells of each of its fields once, so this ends
            Err(Stop::Missing { of: Some(field), .. }) if about.required.insert(field.clone()) => {}
            Err(stop) => {
                about.found.borrow_mut().push(Diagnostic::error(root.mark(), stop.to_string()));
                return (None, about);
            }
        }
    }
}

/// What all values of one reading share.
struct About<'a> {
    text: &'a str,
    /// Where something else stands than the text that must stand there.
    texts_wanted: RefCell<Vec<Span>>,
    /// The same of maps.
    maps_wanted: RefCell<Vec<Span>>,
    /// Takes what would be said about a value the parser has complained about.
    said_before: RefCell<Diagnostic>,
    found: RefCell<Vec<Diagnostic>>,
    required: BTreeSet<Required>,
}

impl About<'_> {
    /// Notes a mistake; one too many is lost.
    fn tell(&self, diagnostic: Diagnostic) -> RefMut<'_, Diagnostic> {
        let mut found = self.found.borrow_mut();
        if found.len() >= MISTAKES {
            let mut lost = self.said_before.borrow_mut();
            *lost = diagnostic;
            return lost;
        }
        found.push(diagnostic);
        let last = found.len() - 1;
        RefMut::map(found, |found| &mut found[last])
    }
}

/// A field that must be there.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord)]
struct Required {
    /// The struct or variant.
    owner: String,
    /// All its fields; variants of two enums may share a name.
    fields: &'static [&'static str],
    field: &'static str,
}

/// Why a reading ended early.
enum Stop {
    /// A field is missing of which nobody knew yet that it must be there.
    Missing {
        field: &'static str,
        of: Option<Required>,
    },
    Other(String),
}

impl serde::de::Error for Stop {
    fn custom<T: fmt::Display>(message: T) -> Self {
        Stop::Other(message.to_string())
    }

    fn missing_field(field: &'static str) -> Self {
        Stop::Missing { field, of: None }
    }
}

impl std::error::Error for Stop {}

impl fmt::Debug for Stop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl fmt::Display for Stop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Stop::Missing { field, .. } => write!(f, "the field `{field}` is missing"),
            Stop::Other(message) => f.write_str(message),
        }
    }
}

/// Notes names that stand twice in one struct or map, anywhere in the tree: the second would silently win.
fn twice(node: &Node, text: &str, found: &mut Vec<Diagnostic>) {
    let mut seen: BTreeMap<&str, Span> = BTreeMap::new();
    let mut see = |name: &'_ str, span: &Span, first: Option<Span>| {
        let Some(first) = first.filter(|_| found.len() < MISTAKES) else { return };
        let mut diagnostic = Diagnostic::error(span.clone(), format!("`{name}` stands here twice"));
        diagnostic.label("the second time").also(first, "the first time").note("keep one of the two");
        found.push(diagnostic);
    };
    match &node.kind {
        Kind::Fields(fields) => {
            for field in fields {
                let first = seen.get(field.name.text.as_str()).cloned();
                see(&field.name.text, &field.name.span, first);
                seen.entry(&field.name.text).or_insert(field.name.span.clone());
            }
        }
        Kind::Map(entries) => {
            for entry in entries {
                let key = match &entry.key.kind {
                    Kind::Text(key) => key,
                    _ => &text[entry.key.span.clone()],
                };
                let first = seen.get(key).cloned();
                see(key, &entry.key.span, first);
                seen.entry(key).or_insert(entry.key.span.clone());
            }
        }
        _ => {}
    }
    for child in node.children() {
        twice(child, text, found);
    }
}
