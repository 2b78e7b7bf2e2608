//! Numbers anywhere in the scene, also in the parameters of custom systems, whose meaning is not known here.

use super::{Validator, called};
use crate::scene::diagnostic::Diagnostic;
use crate::scene::load::SceneFile;
use crate::scene::syntax::{Kind, Node, Path};

/// The engine computes in single precision, which ends at 3.4e38; products of numbers must stay below.
const LARGEST: f64 = 1e30;

pub(super) fn validate(file: &SceneFile, validator: &mut Validator) {
    walk(&file.tree().root, &Path::default(), file.text(), validator);
}

fn walk(node: &Node, path: &Path, text: &str, validator: &mut Validator) {
    match &node.kind {
        Kind::Number => {
            let token = &text[node.span.clone()];
            match ron::from_str::<f64>(token) {
                Ok(number) if !number.is_finite() => {
                    let message = format!("{} must be finite, found {token}", called(path));
                    validator.out.push(Diagnostic::error(node.span.clone(), message));
                }
                Ok(number) if number.abs() > LARGEST => {
                    let message = format!("{} is too large: {token}", called(path));
                    validator
                        .out
                        .push(Diagnostic::error(node.span.clone(), message))
                        .note("numbers up to 1e30 are allowed: the engine computes in single precision");
                }
                _ => {}
            }
        }
        Kind::List(items) | Kind::Tuple(items) => {
            for (i, item) in items.iter().enumerate() {
                walk(item, &path.index(i), text, validator);
            }
        }
        Kind::Fields(fields) => {
            for field in fields {
                walk(&field.value, &path.name(&field.name.text), text, validator);
            }
        }
        Kind::Map(entries) => {
            for entry in entries {
                let name = if let Kind::Text(name) = &entry.key.kind { name } else { &text[entry.key.span.clone()] };
                walk(&entry.value, &path.name(name), text, validator);
            }
        }
        _ => {}
    }
}
