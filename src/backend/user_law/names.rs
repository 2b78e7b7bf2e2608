//! What WGSL texts declare, by name and place.

use crate::backend::kernel::Fragment;
use crate::materials::program::{is_name, words};
use crate::shader;
use std::collections::HashMap;
use std::ops::Range;

/// Something declared outside of all functions.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Declared {
    /// `fn`, `struct`, `var`, `const`, `alias`, `override`.
    pub(super) kind: String,
    pub(super) name: String,
    /// Where the name stands.
    pub(super) at: Range<usize>,
}

/// What a text declares.
pub(super) fn declared(text: &str) -> Vec<Declared> {
    let mut found = Vec::new();
    let (mut depth, mut template) = (0_usize, 0_usize);
    let mut kind: Option<&str> = None;
    for range in words(text) {
        let word = &text[range.clone()];
        match word {
            "{" | "(" => depth += 1,
            "}" | ")" => depth = depth.saturating_sub(1),
            // var<storage, read> x
            "<" if kind.is_some() => template += 1,
            ">" if kind.is_some() => template = template.saturating_sub(1),
            "fn" | "struct" | "var" | "const" | "alias" | "override" if depth == 0 => {
                (kind, template) = (Some(word), 0)
            }
            _ if is_name(word) && depth == 0 && template == 0 => {
                if let Some(kind) = kind.take() {
                    found.push(Declared { kind: kind.to_owned(), name: word.to_owned(), at: range });
                }
            }
            _ => {}
        }
    }
    found
}

/// The names of what a text declares, however it is laid out.
fn declared_names(text: &str) -> impl Iterator<Item = String> {
    declared(text).into_iter().map(|declared| declared.name)
}

/// Where a member of a struct stands, else the struct itself.
pub(super) fn member(text: &str, of: &Declared, member: &str) -> Range<usize> {
    let behind = words(text).skip_while(|range| range.start < of.at.end);
    let within = behind.take_while(|range| &text[range.clone()] != "}");
    let mut names = within.filter(|range| is_name(&text[range.clone()]));
    names.find(|range| &text[range.clone()] == member).unwrap_or_else(|| of.at.clone())
}

/// The fragments that a law may call, and with which it is compiled.
pub(super) fn callable_fragments() -> Vec<Fragment> {
    vec![
        shader!("tensor"),
        shader!("inverse_cbrt"),
        shader!("kinematics"),
        shader!("elementary"),
        shader!("eigen"),
        shader!("invariants"),
    ]
}

/// The names that fragments declare, each with its file.
pub(super) fn owners_among(fragments: &[Fragment]) -> HashMap<String, String> {
    let mut owners = HashMap::new();
    for fragment in fragments {
        for name in declared_names(&fragment.text) {
            owners.entry(name).or_insert_with(|| fragment.path.clone());
        }
    }
    owners
}

#[cfg(test)]
mod tests;
