//! The texts that one of the user's own is compiled in.

use super::form::Form;
use crate::backend::kernel::Fragment;
use crate::materials::program::KNOWN_BY_NAME;

/// Our fragments that a text may call, then the text.
pub(super) fn fragments(form: &Form, path: &str, text: &str) -> Vec<Fragment> {
    let own = Fragment::new(path, text.to_owned());
    form.ours.iter().cloned().chain([own]).collect()
}

/// The same as one text that can be read in double precision; the user's stands at its end.
pub(super) fn in_double_precision(form: &Form, text: &str) -> String {
    let mut whole = String::new();
    for fragment in &form.ours {
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
