//! Systems of the scene's own, as far as can be said without their files.

use super::{Validator, scene, select};
use crate::scene::schema::Scene;

pub(super) fn validate(scene_: &Scene, validator: &mut Validator) {
    for (name, system) in &scene_.systems {
        let path = scene("systems").name(name);
        let word = |letter: char| letter.is_alphanumeric() || letter == '_';
        if !name.chars().all(word) || !name.starts_with(|first: char| first.is_alphabetic()) {
            validator
                .out
                .error_at(&path, format!("the system `{name}` needs another name: a function in its file is called so"))
                .note("letters, digits and _, with a letter first");
        }
        if system.file.is_empty() {
            validator.out.error_at(path.name("file"), "the path of the system is empty");
        }
        select::validate(validator, &path.name("on"), &system.on);
    }
}
