//! Wrong values in a scene whose words are wrong too, so that both are told in one go.

use super::diagnostic::{Diagnostic, Severity};
use super::load::SceneFile;
use super::syntax::{Kind, Node, Path, Span};
use super::validate::validate;

/// With more mistakes than these there is enough to do; comparing all with all takes its time.
const MOST_KNOWN: usize = 200;

/// The complaints about values that do not come from the stand-ins for what could not be read: errors only, and none
/// about brackets with something wrong in them, or about a value beside a wrong one.
pub(super) fn wrong_values(file: &SceneFile, known: &[Diagnostic]) -> Vec<Diagnostic> {
    let root = &file.tree().root;
    // without these two maps no name can be looked up
    let map = |name: &str| Path::from(name).find(root).is_ok_and(|node| matches!(node.kind, Kind::Map(_)));
    if known.len() > MOST_KNOWN || !file.tree().faults.is_empty() || !map("bodies") || !map("materials") {
        return Vec::new();
    }
    let mut found = file.diagnostics();
    validate(file, &mut found);
    let wrong: Vec<(&Span, &Node)> =
        known.iter().filter_map(|diagnostic| diagnostic.at.as_ref()).map(|span| (span, around(root, span).1)).collect();
    let certain = |at: &Span| {
        let (node, holder) = around(root, at);
        // what is said of brackets may come from anything in them, what is said of a value from those beside it
        let inside = |wrong: &Span| wrong.start < node.span.end && wrong.end > node.span.start;
        !wrong.iter().any(|(wrong, beside)| inside(wrong) || std::ptr::eq(*beside, holder))
    };
    let errors = found.list().into_iter().filter(|diagnostic| diagnostic.severity == Severity::Error);
    errors.filter(|diagnostic| diagnostic.at.as_ref().is_some_and(certain)).cloned().collect()
}

/// The innermost value at a place, and the innermost struct, map or list that holds the place.
fn around<'a>(root: &'a Node, at: &Span) -> (&'a Node, &'a Node) {
    let mut node = root;
    let mut holder = root;
    while let Some(child) = node.children().find(|child| child.span.start <= at.start && at.end <= child.span.end) {
        node = child;
        if let Kind::Fields(_) | Kind::Map(_) | Kind::List(_) = node.kind {
            holder = node;
        }
    }
    (node, holder)
}
