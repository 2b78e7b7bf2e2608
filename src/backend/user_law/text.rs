//! The texts that one of the user's own is compiled in.

use super::form::Form;
use crate::backend::kernel::Fragment;

/// Our fragments that a text may call, then the text.
pub(super) fn fragments(form: &Form, path: &str, text: &str) -> Vec<Fragment> {
    let own = Fragment::new(path, text.to_owned());
    form.ours.iter().cloned().chain([own]).collect()
}

/// The same as one text that can be read in double precision; the user's stands at its end. Functions that look at the
/// bits of numbers have no twin there: the translation knows them by their names.
pub(super) fn in_double_precision(form: &Form, text: &str) -> String {
    let mut whole = String::new();
    for fragment in &form.ours {
        match OF_BITS.iter().find(|(path, _)| *path == fragment.path) {
            Some((_, functions)) => {
                let without_body = functions.iter().map(|name| format!("fn {name}(x: f32) -> f32 {{ return x; }}\n"));
                whole.extend(without_body);
            }
            None => whole.extend([fragment.text.as_ref(), "\n"]),
        }
    }
    whole + text
}

/// Our fragments that look at the bits of numbers, with those of their functions that a text may call.
const OF_BITS: [(&str, &[&str]); 2] = [
    ("shaders/inverse_cbrt.wgsl", &["inverse_cbrt"]),
    ("shaders/elementary.wgsl", &["exponential", "exponential_less_one", "logarithm_of_one_plus"]),
];

#[cfg(test)]
mod tests;
