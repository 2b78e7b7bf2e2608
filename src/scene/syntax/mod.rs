//! The syntax tree of a RON text: what stands where. It knows nothing of scenes.
//!
//! [`ron`] reads a scene; this tree exists to say where in the file a thing stands, to find all mistakes instead of the
//! first, and to put in the values of `--set`.

mod parse;
mod path;
mod scan;

pub use parse::parse;
pub use path::{Lost, Path, Segment};

use std::ops::Range;

/// Bytes of a text.
pub type Span = Range<usize>;

/// How deep values may be nested.
pub const DEEPEST: usize = 64;

/// A value and where it stands.
#[derive(Clone, Debug)]
pub struct Node {
    /// The whole value, with its name and brackets.
    pub span: Span,
    /// The word before the brackets, or the word alone: `Box` of `Box(size: ...)`.
    pub name: Option<Word>,
    /// What the value is.
    pub kind: Kind,
}

/// A bare word.
#[derive(Clone, Debug)]
pub struct Word {
    /// The word.
    pub text: String,
    /// Where it stands.
    pub span: Span,
}

/// What a value is.
#[derive(Clone, Debug)]
pub enum Kind {
    /// A number; its text is the span's.
    Number,
    /// A text in quotes, decoded.
    Text(String),
    /// A single character, or bytes: no scene has a use for them.
    Char,
    /// `true` or `false`.
    Bool(bool),
    /// A word alone, such as `All`.
    Word,
    /// `[a, b]`.
    List(Vec<Node>),
    /// `{"a": 1}`.
    Map(Vec<MapEntry>),
    /// `(a, b)`, also `()`.
    Tuple(Vec<Node>),
    /// `(a: 1, b: 2)`.
    Fields(Vec<Field>),
    /// Something that could not be read and has been complained about.
    Bad,
}

/// One entry of a map.
#[derive(Clone, Debug)]
pub struct MapEntry {
    /// The key.
    pub key: Node,
    /// The value.
    pub value: Node,
}

/// One field of a struct.
#[derive(Clone, Debug)]
pub struct Field {
    /// The name.
    pub name: Word,
    /// The value.
    pub value: Node,
}

/// A text that is not RON: what is wrong, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Where.
    pub span: Span,
    /// What.
    pub message: String,
    /// What to do about it, for the place itself.
    pub label: String,
    /// A second place that matters, and why.
    pub also: Option<(Span, String)>,
}

/// The tree of a text, as far as it could be read, with all that is wrong with it.
#[derive(Clone, Debug)]
pub struct Tree {
    /// The only value at the top.
    pub root: Node,
    /// What is not RON. Empty for a sound text.
    pub faults: Vec<Fault>,
}

impl Node {
    /// The values inside, in the order of the text.
    pub fn children(&self) -> Box<dyn Iterator<Item = &Node> + '_> {
        match &self.kind {
            Kind::List(items) | Kind::Tuple(items) => Box::new(items.iter()),
            Kind::Map(entries) => Box::new(entries.iter().flat_map(|entry| [&entry.key, &entry.value])),
            Kind::Fields(fields) => Box::new(fields.iter().map(|field| &field.value)),
            _ => Box::new(std::iter::empty()),
        }
    }

    /// This value, or what is inside when it only wraps another one: `Some(x)`, `Not(x)`, `Table([...])`.
    pub fn inner(&self) -> &Node {
        let mut node = self;
        while let (Some(_), Kind::Tuple(items)) = (&node.name, &node.kind) {
            let [only] = items.as_slice() else { break };
            node = only;
        }
        node
    }

    /// What the value is, in a few words.
    pub fn describe(&self) -> &'static str {
        match (&self.kind, &self.name) {
            (Kind::Number, _) => "a number",
            (Kind::Text(_), _) => "a text",
            (Kind::Char, _) => "a character",
            (Kind::Bool(_), _) => "true or false",
            (Kind::Word, _) => "a word",
            (Kind::List(_), _) => "a list [ ]",
            (Kind::Map(_), _) => "a map { }",
            (Kind::Tuple(_) | Kind::Fields(_), Some(_)) => "a word with brackets",
            (Kind::Tuple(items), None) if items.is_empty() => "empty brackets ( )",
            (Kind::Tuple(_), None) => "values in brackets ( )",
            (Kind::Fields(_), None) => "fields in brackets ( )",
            (Kind::Bad, _) => "something unreadable",
        }
    }
}
