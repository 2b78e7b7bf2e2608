//! The tree of a scene's text with what parts hold beside what the scene itself holds.

use crate::scene::syntax::{Field, Kind, MapEntry, Node, Path, Segment, Span, Word};

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

/// What to mark where something is said of the value at a path, and the value, if it is there. The path leads into
/// parts as they are written, `parts.eye.content`, and from the last of them on goes by the names that this knows: what
/// parts of it hold stands beside what it holds itself.
pub fn find(root: &Node, path: &Path) -> (Span, Option<Span>) {
    let is = |segment: &Segment, word: &str| matches!(segment, Segment::Name(name) if name == word);
    let (mut node, mut way) = (root, path.0.as_slice());
    while let [parts, part, content, rest @ ..] = way
        && is(parts, "parts")
        && is(content, "content")
        && let Some(held) = [parts, part, content].into_iter().try_fold(node, |node, segment| node.child(segment))
    {
        (node, way) = (held.inner(), rest);
    }
    let way = Path(way.to_vec());
    let marked = |found: &Node| (found.mark(), Some(found.span.clone()));
    // what a part holds itself comes first
    if let Ok(found) = way.find(node) {
        return marked(found);
    }
    let whole = merged(node).unwrap_or_else(|| node.clone());
    match way.find(&whole) {
        Ok(found) => marked(found),
        Err(_) => (way.span(&whole), None),
    }
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
