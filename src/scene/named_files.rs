//! The files that a scene names.

use super::file_access::beside;
use super::load::SceneFile;
use super::syntax::{Kind, Node, Path};
use crate::mesh::Triangles;
use std::cell::RefCell;

/// Fields that name files, in a scene or a part; a star stands for any name. A test counts them in the schema's docs.
const FIELDS: [&[&str]; 7] = [
    &["bodies", "*", "mesh", "path"],
    &["bodies", "*", "rest_shape"],
    &["bodies", "*", "skin", "file"],
    &["bodies", "*", "skin", "image"],
    &["materials", "*", "law", "file"],
    &["systems", "*", "file"],
    &["tools", "*", "mesh", "path"],
];

/// A file that a scene names.
#[doc(hidden)]
pub struct NamedFile {
    /// The field that names it.
    pub field: Path,
    /// Its name there.
    pub name: String,
    /// Files that it names itself, as it names them, beside it: the numbers of a glTF.
    pub beside: Vec<String>,
}

impl NamedFile {
    /// What the scene calls it and those that it names, in their order.
    pub fn names(&self) -> impl Iterator<Item = String> + '_ {
        let others = self.beside.iter().map(|other| beside(&self.name, other));
        std::iter::once(self.name.clone()).chain(others)
    }
}

impl SceneFile {
    /// All files that a run of the scene reads. Those of its parts are not among them, for what these hold is in the
    /// scene's text, nor are tables that `sinew accuracy` compares with.
    #[doc(hidden)]
    pub fn named_files(&self) -> Vec<NamedFile> {
        let all = named_in(&self.tree().root).into_iter();
        all.map(|(field, name, _)| NamedFile { field, name: name.into(), beside: self.named_by(name) }).collect()
    }

    /// The triangles that a file holds which the scene names, with what that names itself, its path relative to the
    /// file's folder.
    ///
    /// # Errors
    /// In words: as [`Self::bytes`], or what is wrong with the file.
    #[doc(hidden)]
    pub fn surface(&self, name: &str) -> Result<Triangles, String> {
        self.surface_by(name, &|other| self.bytes_beside(name, other))
    }

    fn surface_by(&self, name: &str, beside: &dyn Fn(&str) -> Result<Vec<u8>, String>) -> Result<Triangles, String> {
        let bytes = self.bytes(name, u64::MAX).map_err(|error| format!("{name}: {error}"))?;
        Triangles::from_bytes_beside(name, &bytes, beside).map_err(|error| error.to_string())
    }

    /// What a file names when its triangles are read; nothing of what holds none.
    fn named_by(&self, name: &str) -> Vec<String> {
        let asked = RefCell::new(Vec::new());
        // what is wrong with it is for those to say who need it
        let _ = self.surface_by(name, &|other| {
            asked.borrow_mut().push(other.to_string());
            self.bytes_beside(name, other)
        });
        asked.into_inner()
    }
}

/// The fields of a scene or a part, without its parts, that name files: the way there, the name, and the value.
pub(super) fn named_in(root: &Node) -> Vec<(Path, &str, &Node)> {
    let mut found = Vec::new();
    for field in FIELDS {
        values(root, field, Path::default(), &mut found);
    }
    let mut named = Vec::new();
    for (path, node) in found {
        if let Kind::Text(name) = &node.kind
            && !name.is_empty()
        {
            named.push((path, name.as_str(), node));
        }
    }
    named
}

/// All values that a field leads to, what wraps them taken off, each with the way there.
pub(super) fn values<'a>(node: &'a Node, field: &[&str], at: Path, found: &mut Vec<(Path, &'a Node)>) {
    let node = node.inner();
    match (field.split_first(), &node.kind) {
        (None, _) => found.push((at, node)),
        (Some((&"*", rest)), Kind::Map(entries)) => {
            for entry in entries {
                if let Kind::Text(name) = &entry.key.kind {
                    values(&entry.value, rest, at.name(name), found);
                }
            }
        }
        (Some((name, rest)), Kind::Fields(fields)) => {
            if let Some(field) = fields.iter().find(|field| field.name.text == *name) {
                values(&field.value, rest, at.name(*name), found);
            }
        }
        _ => {}
    }
}

#[cfg(test)]
mod tests;
