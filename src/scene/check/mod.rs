//! Compares a tree with the words that a Rust type allows, and tells all mistakes at once.
//!
//! serde stops at the first mistake. Here a value that is wrong is noted and a stand-in is handed on in its place, so
//! that the rest is read too. A missing field is known only when a whole struct has been read; it is noted, and the
//! tree is read once more with a stand-in for it.

mod access;
mod stand_in;
mod value;
mod wording;

use super::diagnostic::Diagnostic;
use super::source::Source;
use super::syntax::{Kind, Node, Span, parse};
use serde::de::DeserializeOwned;
use std::cell::RefCell;
use std::collections::{BTreeMap, HashMap};
use std::fmt;
use value::Value;

/// How many missing fields are told in one go: each costs one more reading of the tree.
const MOST_MISSING: usize = 100;

/// All that keeps a tree from being a `T`.
pub fn check<T: DeserializeOwned>(root: &Node, text: &str) -> Vec<Diagnostic> {
    let mut all = Vec::new();
    twice(root, text, &mut all);
    all.extend(read::<T>(root, text).found.take());
    all
}

/// Whether the value at `span` must be a text and is something else.
pub fn wants_text<T: DeserializeOwned>(source: &Source, span: &Span) -> bool {
    let tree = parse(source.text());
    read::<T>(&tree.root, source.text()).texts_wanted.take().contains(span)
}

/// Reads the tree as a `T`, as often as it takes to stand in for all missing fields.
fn read<'a, T: DeserializeOwned>(root: &'a Node, text: &'a str) -> About<'a> {
    let mut missing = Vec::new();
    let mut about = About::new(text);
    for _ in 0..MOST_MISSING {
        about.found.take();
        match T::deserialize(Value { node: root, about: &about, subject: "the scene" }) {
            Err(Stop::Missing { field, of: Some((node, diagnostic)) }) => {
                about.supplied.entry(node).or_default().push(field);
                missing.extend(diagnostic.map(|diagnostic| *diagnostic));
            }
            Err(Stop::Missing { .. }) | Ok(_) => break,
            Err(Stop::Other(message)) => {
                about.found.borrow_mut().push(Diagnostic::error(root.mark(), message));
                break;
            }
        }
    }
    about.found.borrow_mut().extend(missing);
    about
}

/// What all values of one reading share.
struct About<'a> {
    text: &'a str,
    /// Where something else stands than the text that must stand there.
    texts_wanted: RefCell<Vec<Span>>,
    /// Takes what would be said about a value the parser has complained about.
    said_before: RefCell<Diagnostic>,
    found: RefCell<Vec<Diagnostic>>,
    /// Missing fields that have been noted, by the struct they are missing in.
    supplied: HashMap<NodeId, Vec<&'static str>>,
}

impl<'a> About<'a> {
    fn new(text: &'a str) -> Self {
        Self {
            text,
            texts_wanted: RefCell::default(),
            said_before: RefCell::new(Diagnostic::error(None, "")),
            found: RefCell::default(),
            supplied: HashMap::new(),
        }
    }
}

/// Which node of a tree; the tree does not move while it is read.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct NodeId(usize);

impl NodeId {
    fn of(node: &Node) -> Self {
        Self(std::ptr::from_ref(node).addr())
    }
}

/// Why a reading ended early.
enum Stop {
    /// A field that is missing, in which struct, and what is said of it.
    Missing {
        field: &'static str,
        of: Option<(NodeId, Option<Box<Diagnostic>>)>,
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
        let Some(first) = first else { return };
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
