//! The tree of a scene's text with what parts hold beside what the scene itself holds.

use crate::scene::syntax::{Field, Kind, MapEntry, Node, Word};

/// Fields of a part that are names with what belongs to them.
const MAPS: [&str; 4] = ["bodies", "materials", "tools", "probes"];
/// Those that are lists.
const LISTS: [&str; 6] = ["constraints", "loads", "contacts", "attachments", "suction", "removal"];

/// The tree under the names that the scene knows: `bodies."eye.lens"` for `parts.eye.content.bodies.lens`, which is
/// there no more. Nothing where there are no parts.
pub fn merged(root: &Node) -> Option<Node> {
    let Kind::Fields(fields) = &root.kind else { return None };
    let parts = fields.iter().find(|field| field.name.text == "parts")?;
    let Kind::Map(entries) = &parts.value.kind else { return None };
    let mut fields: Vec<Field> = fields.iter().filter(|field| field.name.text != "parts").cloned().collect();
    // in the order in which lists of parts are joined
    let mut named: Vec<(&str, &Node)> = entries.iter().filter_map(name_and_value).collect();
    named.sort_by_key(|(name, _)| *name);
    let mut outer = parts.value.clone();
    for (name, part) in named {
        let Some(content) = content(part) else { continue };
        let content = merged(content).unwrap_or_else(|| content.clone());
        let Kind::Fields(inner) = content.kind else { continue };
        for field in inner {
            add(&mut fields, name, field, &parts.value);
        }
    }
    if let Kind::Map(entries) = &mut outer.kind {
        for entry in entries {
            if let Kind::Fields(fields) = &mut entry.value.kind {
                fields.retain(|field| field.name.text != "content");
            }
        }
    }
    fields.push(Field { name: parts.name.clone(), value: outer });
    Some(Node { kind: Kind::Fields(fields), ..root.clone() })
}

fn name_and_value(entry: &MapEntry) -> Option<(&str, &Node)> {
    if let Kind::Text(name) = &entry.key.kind { Some((name, &entry.value)) } else { None }
}

/// What a part holds.
fn content(part: &Node) -> Option<&Node> {
    let Kind::Fields(fields) = &part.kind else { return None };
    fields.iter().find(|field| field.name.text == "content").map(|field| field.value.inner())
}

/// Adds a field of a part to those of the scene, which has an empty one, without a place, where it had none.
fn add(fields: &mut Vec<Field>, part: &str, added: Field, parts: &Node) {
    let word = added.name.text.as_str();
    let empty = match word {
        _ if MAPS.contains(&word) => Kind::Map(Vec::new()),
        _ if LISTS.contains(&word) => Kind::List(Vec::new()),
        _ => return,
    };
    let number = fields.iter().position(|field| field.name.text == word).unwrap_or_else(|| {
        let at = parts.span.start..parts.span.start;
        let name = Word { text: word.to_string(), span: at.clone() };
        fields.push(Field { name, value: Node { span: at, name: None, kind: empty } });
        fields.len() - 1
    });
    match (&mut fields[number].value.kind, added.value.kind) {
        (Kind::List(all), Kind::List(items)) => all.extend(items),
        (Kind::Map(all), Kind::Map(entries)) => all.extend(entries.into_iter().map(|mut entry| {
            if let Kind::Text(name) = &mut entry.key.kind {
                *name = format!("{part}.{name}");
            }
            entry
        })),
        _ => {}
    }
}
