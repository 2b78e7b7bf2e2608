//! WGSL texts as lists of declarations, as far as putting kernels together needs it: the engine's own fragments begin
//! every declaration at the beginning of a line.

use std::collections::{BTreeMap, BTreeSet};

/// A declaration with the comments and attributes before it.
pub struct Item<'a> {
    /// What it declares, if anything.
    pub name: Option<&'a str>,
    /// Whether that is a struct.
    pub is_struct: bool,
    lines: Vec<&'a str>,
}

/// The declarations of a text, in order.
pub struct Items<'a>(pub Vec<Item<'a>>);

impl<'a> Items<'a> {
    /// Takes a text apart.
    pub fn of(text: &'a str) -> Self {
        let mut items: Vec<Item<'a>> = Vec::new();
        for line in text.lines() {
            let name = declared(line);
            let begins = name.is_some() && items.last().is_none_or(|item| item.name.is_some());
            if begins || items.is_empty() {
                items.push(Item { name: None, is_struct: false, lines: Vec::new() });
            }
            if let Some(item) = items.last_mut() {
                item.lines.push(line);
                if name.is_some() {
                    item.name = name;
                    item.is_struct = line.starts_with("struct ");
                }
            }
        }
        Self(items)
    }

    /// The structs by name, with their texts.
    pub fn structs(&self) -> Vec<(String, String)> {
        let named = |item: &Item| Some((item.name?.to_owned(), item.lines.join("\n")));
        self.0.iter().filter(|item| item.is_struct).filter_map(named).collect()
    }

    /// The text without some of the structs.
    pub fn without(&self, structs: &BTreeSet<String>) -> String {
        let left = self.0.iter().filter(|item| !(item.is_struct && item.name.is_some_and(|n| structs.contains(n))));
        left.flat_map(|item| item.lines.iter().flat_map(|line| [line, "\n"])).collect()
    }
}

/// What a line declares.
fn declared(line: &str) -> Option<&str> {
    let rest = match storage_variable(line) {
        Some((name, ..)) => return Some(name),
        None => {
            line.strip_prefix("fn ").or_else(|| line.strip_prefix("struct ")).or_else(|| line.strip_prefix("const "))
        }
    };
    let rest = rest.or_else(|| line.contains("var<").then(|| line.split_once("> ").map(|(_, rest)| rest))?);
    let rest = rest.filter(|_| !line.starts_with([' ', '/']))?;
    let end = rest.find(|c: char| !is_of_a_name(c)).unwrap_or(rest.len());
    Some(&rest[..end]).filter(|name| !name.is_empty())
}

/// Name, whether it is written, and type of the storage variable that a line declares.
pub fn storage_variable(line: &str) -> Option<(&str, bool, &str)> {
    let (_, rest) = line.strip_prefix("@group")?.split_once("var<storage, ")?;
    let (access, rest) = rest.split_once("> ")?;
    let (name, rest) = rest.split_once(": ")?;
    let (of, _) = rest.split_once(';')?;
    Some((name, access == "read_write", of))
}

fn is_of_a_name(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_'
}

/// A text with other names.
pub fn renamed(text: &str, names: &BTreeMap<String, String>) -> String {
    if names.is_empty() {
        return text.to_owned();
    }
    let mut result = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(start) = rest.find(is_of_a_name) {
        let end = rest[start..].find(|c| !is_of_a_name(c)).map_or(rest.len(), |length| start + length);
        let word = &rest[start..end];
        result += &rest[..start];
        // a member is no declaration
        let member = result.ends_with('.');
        result += names.get(word).filter(|_| !member).map_or(word, String::as_str);
        rest = &rest[end..];
    }
    result + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "// A load.
struct Load {
    load: u32, // slot
}
@group(0) @binding(0) var<uniform> load: Load;
@group(0) @binding(1) var<storage, read> mass: array<f32>;
var<private> sum: f32;

// Pulls.
fn pull(node: u32) {
    sum += mass[node] * f32(load.load) * overload(node);
}
";

    #[test]
    fn declarations_are_found_by_name() {
        let items = Items::of(TEXT);
        let names: Vec<&str> = items.0.iter().filter_map(|item| item.name).collect();
        assert_eq!(names, ["Load", "load", "mass", "sum", "pull"]);
        assert_eq!(items.structs().len(), 1);
        assert!(!items.without(&["Load".to_owned()].into()).contains("slot"));
        assert_eq!(items.without(&BTreeSet::new()), TEXT);
        assert_eq!(storage_variable(TEXT.lines().nth(5).unwrap_or_default()), Some(("mass", false, "array<f32>")));
    }

    #[test]
    fn whole_names_are_renamed_and_members_are_not() {
        let names =
            BTreeMap::from([("load".to_owned(), "load_1".to_owned()), ("pull".to_owned(), "pull_1".to_owned())]);
        let text = renamed(TEXT, &names);
        assert!(text.contains("f32(load_1.load) * overload(node)") && text.contains("fn pull_1("), "{text}");
    }
}
