//! The texts that a law is compiled in.

use super::names::to_call;
use crate::backend::kernel::Fragment;
use crate::materials::J_FLOOR;
use crate::materials::program::KNOWN_BY_NAME;

/// Our fragments that a law may call, then the law.
pub(super) fn fragments(path: &str, text: &str) -> Vec<Fragment> {
    let mut fragments = to_call();
    fragments.push(Fragment::new("generated: constants", format!("const J_FLOOR: f32 = {J_FLOOR:e};\n")));
    fragments.push(Fragment::new(path, text.to_owned()));
    fragments
}

/// The same as one text that can be read in double precision; the law stands at its end.
pub(super) fn in_double_precision(text: &str) -> String {
    let mut whole = String::new();
    for fragment in fragments("", text).split_last().map_or(&[][..], |(_, ours)| ours) {
        whole.push_str(&without_bits(&fragment.text));
        whole.push('\n');
    }
    whole + text
}

/// Without the bodies of functions that the translation knows by their names, and without others that look at bits.
fn without_bits(text: &str) -> String {
    let mut parts = text.split("\nfn ");
    let mut whole = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (head, body) = part.split_once("{\n").unwrap_or((part, ""));
        let end = body.find("\n}").map_or(body.len(), |at| at + 2);
        let name = head.split('(').next().unwrap_or_default();
        whole.push('\n');
        if KNOWN_BY_NAME.contains(&name) {
            whole.push_str(&format!("fn {head}{{\n    return x;\n}}{}", &body[end..]));
        } else if body[..end].contains("bitcast") {
            whole.push_str(&body[end..]);
        } else {
            whole.push_str(&format!("fn {part}"));
        }
    }
    whole
}
