//! How the scene is drawn.

use super::{Validator, scene, show};
use crate::scene::limits::{OPACITIES, PICTURE, ZOOM};
use crate::scene::schema::{Opacity, Scene};
use crate::scene::suggest::choice;
use crate::scene::syntax::Path;

pub(super) fn validate(scene_: &Scene, validator: &mut Validator) {
    let (path, picture) = (scene("picture"), &scene_.picture);
    for (i, pixels) in [picture.size.0, picture.size.1].into_iter().enumerate() {
        let (allowed, what) = (&PICTURE[i], ["wide", "high"][i]);
        if !allowed.contains(&pixels) {
            let allowed = format!("from {} to {} pixels {what}", allowed.start(), allowed.end());
            validator.must(&path.name("size").index(i), &allowed, pixels);
        }
    }
    validator.has_direction(&path.name("from"), picture.from);
    validator.has_direction(&path.name("up"), picture.up);
    if !ZOOM.contains(&picture.zoom) {
        validator.must(&path.name("zoom"), &format!("from {} to {}", ZOOM.start(), ZOOM.end()), show(picture.zoom));
    }
    if let Some((low, high)) = picture.range {
        // colours are looked up in single precision
        let rises = (low as f32) < high as f32;
        if !rises {
            let message = format!("`range` is empty: from {} to {}", show(low), show(high));
            let note = "the value of the first colour, and a larger one of the last: (0, 0.02), in the field's SI unit";
            validator.out.error_at(path.name("range"), message).note(note);
        }
    }
    if let Some(cut) = picture.cut {
        validator.has_direction(&path.name("cut").name("normal"), cut.normal);
    }
    if picture.opacity.len() > OPACITIES {
        validator.must(&path.name("opacity"), &format!("a list of at most {OPACITIES}"), picture.opacity.len());
        return;
    }
    for (i, entry) in picture.opacity.iter().enumerate() {
        opacity(scene_, validator, &path.name("opacity").index(i), entry);
    }
}

fn opacity(scene_: &Scene, validator: &mut Validator, path: &Path, entry: &Opacity) {
    if !(0.0..=1.0).contains(&entry.opacity) {
        validator.must(&path.name("opacity"), "between 0 and 1", show(entry.opacity));
    }
    if let Some(name) = entry.body.as_ref().filter(|name| !scene_.bodies.contains_key(*name)) {
        let bodies = scene_.bodies.keys().map(String::as_str);
        validator.out.error_at(path.name("body"), format!("there is no body `{name}`")).notes(choice(name, bodies));
    }
    if let Some(name) = entry.material.as_ref().filter(|name| !scene_.materials.contains_key(*name)) {
        let materials = scene_.materials.keys().map(String::as_str);
        let message = format!("there is no material `{name}`");
        validator.out.error_at(path.name("material"), message).notes(choice(name, materials));
    }
}
