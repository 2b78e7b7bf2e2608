//! WGSL texts as lists of declarations, as far as putting kernels together needs it: the engine's own fragments begin
//! every declaration at the beginning of a line.

use crate::materials::program::words;
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
    c.is_alphanumeric() || c == '_'
}

/// A text with other names for what it declares outside of functions; members of structs keep theirs.
pub fn renamed(text: &str, names: &BTreeMap<String, String>) -> String {
    if names.is_empty() {
        return text.to_owned();
    }
    let all: Vec<&str> = words(text).map(|range| &text[range]).collect();
    let says = |word: &str| !(word.trim().is_empty() || word.starts_with("//") || word.starts_with("/*"));
    let mut result = String::with_capacity(text.len());
    // the two words before, and whether a struct's members are being declared
    let (mut before, mut members) = (["", ""], Members::Elsewhere);
    for (place, &word) in all.iter().enumerate() {
        let kept = match before {
            [_, "."] | [_, "@"] | ["var", "<"] => true,
            _ if members == Members::Here => all[place + 1..].iter().find(|word| says(word)) == Some(&":"),
            _ => false,
        };
        result += names.get(word).filter(|_| !kept).map_or(word, String::as_str);
        if says(word) {
            members = match (members, word) {
                (_, "struct") => Members::Next,
                (Members::Next, "{") => Members::Here,
                (Members::Here, "}") => Members::Elsewhere,
                (members, _) => members,
            };
            before = [before[1], word];
        }
    }
    result
}

/// Whether the members of a struct are being declared.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Members {
    Elsewhere,
    Next,
    Here,
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
        assert!(text.contains("    load: u32, // slot\n"), "{text}");
    }

    #[test]
    fn a_text_may_be_laid_out_in_any_way() {
        let text = "struct Gust { pull : array<Load, read>, @align(16) group: f32 } struct Load { x: f32 }\n\
                    const read = 2; @group(0) @binding(0) var<uniform> group: Gust; /* pull */ fn pull(g: Gust) -> f32 {\n\
                    let of = g . pull[0].x; let pull: f32 = of; return pull * group.group; }";
        let names = ["pull", "group", "read", "uniform", "Load"].map(|name| (name.to_owned(), format!("{name}_2")));
        let expected = "struct Gust { pull : array<Load_2, read_2>, @align(16) group: f32 } struct Load_2 { x: f32 }\n\
                        const read_2 = 2; @group(0) @binding(0) var<uniform> group_2: Gust; /* pull */ fn pull_2(g: Gust) -> f32 {\n\
                        let of = g . pull[0].x; let pull_2: f32 = of; return pull_2 * group_2.group; }";
        assert_eq!(renamed(text, &BTreeMap::from(names)), expected);
    }
}
