//! Paths such as `bodies.cube.mesh.cells` or `loads[0].acceleration`, and the way along them.

use super::{Kind, Node, Span};
use std::fmt;

/// A way into a tree.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Path(pub Vec<Segment>);

/// One step of a [`Path`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Segment {
    /// To a field of a struct or an entry of a map.
    Name(String),
    /// To an item of a list or of brackets, from 0.
    Index(usize),
}

/// Where a way into a tree ends.
pub struct Lost<'a> {
    /// The last value that is there.
    pub node: &'a Node,
    /// How many segments led to it.
    pub reached: usize,
}

impl Path {
    /// Reads a path; a name with odd characters stands in quotes: `bodies."left lung".mesh`.
    ///
    /// # Errors
    /// What is wrong, in one sentence.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut segments = Vec::new();
        let mut rest = text.trim();
        while !rest.is_empty() {
            rest = if let Some(inside) = rest.strip_prefix('[') {
                let (number, after) = inside.split_once(']').ok_or(format!("`{text}`: a ] is missing"))?;
                let number =
                    number.trim().parse().map_err(|_| format!("`{text}`: [{number}] is not a number from 0"))?;
                segments.push(Segment::Index(number));
                after
            } else if let Some(inside) = rest.strip_prefix('"') {
                let (name, after) = inside.split_once('"').ok_or(format!("`{text}`: a \" is missing"))?;
                segments.push(Segment::Name(name.to_string()));
                after
            } else {
                let end = rest.find(['.', '[']).unwrap_or(rest.len());
                if end == 0 {
                    return Err(format!("`{text}`: a name is missing"));
                }
                segments.push(Segment::Name(rest[..end].trim().to_string()));
                &rest[end..]
            };
            rest = match rest.strip_prefix('.') {
                Some("") => return Err(format!("`{text}`: a name is missing after the last dot")),
                Some(after) => after,
                None if rest.is_empty() || rest.starts_with('[') => rest,
                None => return Err(format!("`{text}`: expected a dot or [ before `{rest}`")),
            };
        }
        Ok(Self(segments))
    }

    /// Follows the path. Words before brackets (`Box(...)`, `Some(...)`) do not count.
    ///
    /// # Errors
    /// How far the path leads when it does not lead to a value.
    pub fn find<'a>(&self, root: &'a Node) -> Result<&'a Node, Lost<'a>> {
        let mut node = root;
        for (reached, segment) in self.0.iter().enumerate() {
            node = node.child(segment).ok_or(Lost { node, reached })?;
        }
        Ok(node)
    }

    /// The place of the value, or of what should hold it and does not.
    pub fn span(&self, root: &Node) -> Span {
        match self.find(root) {
            Ok(node) => node.span.clone(),
            Err(lost) if lost.reached == 0 => root.span.start..root.span.start,
            Err(lost) => lost.node.mark(),
        }
    }
}

impl Node {
    /// One step down a path.
    pub fn child(&self, segment: &Segment) -> Option<&Node> {
        let node = match &self.kind {
            // `Along(0, 0, 1)[2]` is an index into the brackets, `Not(Sphere(...)).radius` and `And([...])[1]` are not
            Kind::Tuple(items) if items.len() == 1 && self.name.is_some() => self.inner(),
            _ => self,
        };
        match (segment, &node.kind) {
            (Segment::Name(name), Kind::Fields(fields)) => {
                fields.iter().find(|field| field.name.text == *name).map(|field| &field.value)
            }
            (Segment::Name(name), Kind::Map(entries)) => {
                entries.iter().find(|entry| matches!(&entry.key.kind, Kind::Text(key) if key == name)).map(|e| &e.value)
            }
            (Segment::Index(index), Kind::List(items) | Kind::Tuple(items)) => items.get(*index),
            (Segment::Index(0), _) if !std::ptr::eq(node, self) => Some(node),
            _ => None,
        }
    }

    /// What to mark of a value when the value as a whole is meant: its name, or its opening bracket.
    pub fn mark(&self) -> Span {
        match (&self.name, &self.kind) {
            (Some(name), _) => name.span.clone(),
            (None, Kind::List(_) | Kind::Map(_) | Kind::Tuple(_) | Kind::Fields(_)) => {
                self.span.start..self.span.start + 1
            }
            _ => self.span.clone(),
        }
    }
}

impl fmt::Display for Path {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, segment) in self.0.iter().enumerate() {
            let dot = if i == 0 { "" } else { "." };
            match segment {
                Segment::Index(index) => write!(f, "[{index}]")?,
                Segment::Name(name) if name.is_empty() || name.contains(['.', '[', '"', ' ', '=']) => {
                    write!(f, "{dot}\"{name}\"")?;
                }
                Segment::Name(name) => write!(f, "{dot}{name}")?,
            }
        }
        Ok(())
    }
}

impl From<&str> for Path {
    /// Reads a path; one that is not a path leads nowhere.
    fn from(text: &str) -> Self {
        Path::parse(text).unwrap_or_default()
    }
}

impl From<String> for Path {
    fn from(text: String) -> Self {
        text.as_str().into()
    }
}

impl From<&Path> for Path {
    fn from(path: &Path) -> Self {
        path.clone()
    }
}

impl Path {
    /// The way to a field or entry of the value this path leads to.
    pub fn name(&self, name: impl Into<String>) -> Self {
        let mut path = self.clone();
        path.0.push(Segment::Name(name.into()));
        path
    }

    /// The way to an item of the value this path leads to.
    pub fn index(&self, index: usize) -> Self {
        let mut path = self.clone();
        path.0.push(Segment::Index(index));
        path
    }
}
