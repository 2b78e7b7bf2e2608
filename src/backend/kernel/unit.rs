//! Pieces of a kernel that are read apart from each other, so that each may name things as it likes.

use super::{Fragment, Kernel};
use std::borrow::Cow;

/// WGSL that is read by itself. What it declares is its own, whatever other units call theirs, but for buffers that
/// are to be one and for what all units have in common.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Unit {
    /// Pieces that other units have too: what they declare is there once in the kernel.
    pub common: Vec<Fragment>,
    /// Its own pieces.
    pub own: Vec<Fragment>,
    /// Its buffer variables, each with its name in the kernel: those of one name there are one buffer.
    pub variables: Vec<(Cow<'static, str>, Cow<'static, str>)>,
    /// Its functions whose bodies are elsewhere.
    pub links: Vec<Link>,
}

/// A unit's place in [`Kernel::units`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct UnitId(pub usize);

/// A function that a unit declares without doing anything in it: it calls functions of earlier units one after the
/// other, each with all its arguments, and gives what the last one gives.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Link {
    /// The function.
    pub function: Cow<'static, str>,
    /// What it calls.
    pub calls: Vec<(UnitId, Cow<'static, str>)>,
}

impl Unit {
    /// All its pieces, those that it has in common with others first.
    pub(super) fn fragments(&self) -> impl Iterator<Item = &Fragment> {
        self.common.iter().chain(&self.own)
    }

    /// A function of its own with the piece that has it, for people.
    fn told(&self, function: &str) -> String {
        let declared = format!("fn {function}(");
        let piece = self.own.iter().find(|piece| piece.text.contains(&declared));
        piece.map_or_else(|| function.to_owned(), |piece| format!("`{function}` of {}", piece.path))
    }

    /// What it is known by: its text, and which uniforms each invocation has for itself.
    pub(super) fn key(&self) -> String {
        let mut key: String = self.fragments().flat_map(|fragment| [fragment.text.as_ref(), "\n"]).collect();
        key.extend(self.fragments().flat_map(|fragment| &fragment.private).flat_map(|name| ["\0", name]));
        key
    }
}

impl Kernel {
    /// What `fragments`, `common` and `links` say, as a unit.
    pub(super) fn root(&self) -> Unit {
        let (common, own, links) = (self.common.clone(), self.fragments.clone(), self.links.clone());
        Unit { common, own, variables: Vec::new(), links }
    }

    /// Every fragment once, those of its units first.
    pub fn all_fragments(&self) -> Vec<&Fragment> {
        let mut all: Vec<&Fragment> = Vec::new();
        let own = self.common.iter().chain(&self.fragments);
        for fragment in self.units.iter().flat_map(Unit::fragments).chain(own) {
            if !all.contains(&fragment) {
                all.push(fragment);
            }
        }
        all
    }

    /// Its whole text, for people: which function of which piece each function without a body stands for, then every
    /// piece behind its path, the kernel's own first.
    pub fn listing(&self) -> String {
        let mut text = format!("// {}: entry point {}\n", self.label, self.entry);
        let root = self.root();
        for unit in [&root].into_iter().chain(&self.units) {
            for Link { function, calls } in &unit.links {
                let name = |(unit, name): &(UnitId, Cow<'static, str>)| match self.units.get(unit.0) {
                    Some(unit) => unit.told(name),
                    None => name.to_string(),
                };
                let calls: Vec<String> = calls.iter().map(name).collect();
                let calls = if calls.is_empty() { "nothing".into() } else { calls.join(", then ") };
                text += &format!("// {} calls {calls}\n", unit.told(function));
            }
        }
        let mut seen: Vec<&Fragment> = Vec::new();
        for fragment in root.fragments().chain(self.units.iter().rev().flat_map(Unit::fragments)) {
            if !seen.contains(&fragment) {
                text += &format!("\n// ---- {}\n\n{}\n", fragment.path, fragment.text.trim_end());
                seen.push(fragment);
            }
        }
        text
    }

    /// What makes it a kernel of its own: the texts, and how they are put together.
    pub(crate) fn key(&self) -> String {
        let mut key = String::new();
        for unit in self.units.iter().chain([&self.root()]) {
            key += &format!("{}\0{}{:?}{:?}\0", unit.key(), unit.common.len(), unit.variables, unit.links);
        }
        key
    }
}
