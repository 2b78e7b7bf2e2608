//! What differs from copy to copy of a body: places of numbers, and materials that each copy can have.

use super::{Validator, material, scene, show};
use crate::scene::copied_material::{CopiedMaterial, Part, numbers_of, parameters, split};
use crate::scene::load::SceneFile;
use crate::scene::schema::{Body, Load, LoadParts, Material, PerCopy, Scene};
use crate::scene::suggest::choice;
use crate::scene::syntax::Path;
use glam::DVec3;
use std::collections::BTreeSet;

pub(super) fn validate(file: &SceneFile, validator: &mut Validator) {
    for (name, body) in &file.scene.bodies {
        let path = scene("bodies").name(name).name("per_copy");
        if body.per_copy.is_empty() {
            continue;
        }
        if !has_copies(validator, &path, body) {
            continue;
        }
        let mut places = BTreeSet::new();
        let mut all_well = true;
        for (key, values) in &body.per_copy {
            let path = path.name(key);
            for key in numbers_of(key, values, 0).into_iter().map(|(key, _)| key) {
                if let Err((message, notes)) = place(&file.scene, (name, body), &key, &mut places) {
                    validator.out.error_at(&path, message).notes(notes);
                    all_well = false;
                    break;
                }
            }
            all_well &= numbers(validator, &path, values, body.copies);
        }
        if all_well {
            materials(file, body, &path, validator);
        }
    }
}

/// Looks at what an action on a body, the only one where none is named, is multiplied with in each copy.
pub(super) fn of_body(
    scene_: &Scene,
    validator: &mut Validator,
    path: &Path,
    name: Option<&String>,
    values: Option<&PerCopy>,
) {
    let body = name.map_or(scene_.bodies.values().next(), |name| scene_.bodies.get(name));
    let (Some(body), Some(values)) = (body, values) else { return };
    let path = path.name("per_copy");
    if has_copies(validator, &path, body) {
        numbers(validator, &path, values, body.copies);
    }
}

/// Looks at what a load is multiplied with in each copy.
pub(super) fn of_load(scene_: &Scene, validator: &mut Validator, path: &Path, load: &Load) {
    let LoadParts { body, on, name, .. } = load.parts();
    let Some(values) = on.per_copy() else { return };
    let place = path.name("per_copy");
    if values.is_vector() && !load.is_vector() {
        validator
            .out
            .error_at(&place, format!("a {name} has no direction of its own: one number a copy"))
            .note("Linear(...), Uniform(...), LogUniform(...) or Values([...])");
    }
    if on.select().is_none() && body.is_none() {
        let told = validator.out.error_at(place, format!("{name} on all bodies is the same in all copies"));
        told.note("name the `body` whose copies it differs in");
        return;
    }
    of_body(scene_, validator, path, body, Some(values));
    if load.is_vector() {
        of_directions(validator, path, load.amplitude(), values);
    }
}

/// Warns where random directions multiply a vector whose components differ: each component has a factor of its own, so
/// that what comes out is neither as large in all copies nor each way alike.
pub(super) fn of_directions(validator: &mut Validator, path: &Path, vector: DVec3, values: &PerCopy) {
    let is_even = vector.x == vector.y && vector.y == vector.z;
    if !matches!(values, PerCopy::Directions { .. }) || is_even || !vector.is_finite() {
        return;
    }
    let [x, y, z] = vector.to_array().map(show);
    let size = show(vector.length());
    let message = format!("`Directions` multiplies ({x}, {y}, {z}) component by component: that does not turn it");
    let note = format!("({size}, {size}, {size}) is of that size some way of its own in each copy");
    validator.out.warn_at(path.name("per_copy"), message).note(note);
}

/// Whether a body has copies that may differ.
fn has_copies(validator: &mut Validator, path: &Path, body: &Body) -> bool {
    if body.copies < 2 {
        let told = validator.out.error_at(path, "the body has one copy only");
        told.note("give the body `copies`, or leave `per_copy` out");
    }
    body.copies > 1
}

/// Looks whether a key leads to a parameter that may differ, and nothing else has led there.
fn place(
    scene_: &Scene,
    (body_name, body): (&str, &Body),
    key: &str,
    places: &mut BTreeSet<(String, String)>,
) -> Result<(), (String, Vec<String>)> {
    let example = vec!["such as \"tissue.fibres.eta\", a parameter of the material `tissue`".to_string()];
    let (name, way) = split(key).map_err(|message| (message, example))?;
    let used: Vec<&str> = body.materials().collect();
    let Some(found) = scene_.materials.get(&name).filter(|_| used.contains(&name.as_str())) else {
        return Err((format!("the body has no material `{name}`"), choice(&name, used)));
    };
    let (parsed, way, allowed) = (way.clone(), way.to_string(), parameters(found));
    if !allowed.contains(&way) {
        let message = format!("`{way}` of the material `{name}` cannot differ from copy to copy");
        let mut notes = choice(&way, allowed.iter().map(String::as_str));
        if found.law.is_some() && (Part::of(&parsed) == Part::Memory || way.starts_with("law")) {
            notes.push("a law of your own, and what its elements remember, are the same in all copies".to_string());
        }
        return Err((message, notes));
    }
    if let Some(what) = has_no_weight(found, &way) {
        let message = format!("the material `{name}` has {what}: what has no weight does not exist");
        return Err((message, vec!["give it a number above 0 there, of any size".to_string()]));
    }
    if Part::of(&parsed) == Part::Inertia && scene_.may_lose_elements(body_name) {
        let message = format!("`{way}` cannot differ in a body that loses elements");
        let note = "what takes elements away knows one density and damping for all of a material";
        return Err((message, vec![note.to_string()]));
    }
    if !places.insert((name, way)) {
        return Err((format!("`{key}` stands here twice, written otherwise"), Vec::new()));
    }
    Ok(())
}

/// What has no weight in a material and therefore does not exist, where a way leads to it.
fn has_no_weight(material: &Material, way: &str) -> Option<&'static str> {
    let starts = |place: String| way.starts_with(&place);
    let families = material.exponential_fibres.iter().flatten().enumerate();
    let of_family = families.filter(|(_, family)| family.k1 == 0.0);
    let prony = material.prony.iter();
    let terms = prony.flat_map(|prony| [("terms", &prony.terms), ("volumetric", &prony.volumetric)]);
    let mut terms = terms.flat_map(|(word, terms)| terms.iter().enumerate().map(move |(i, term)| (word, i, term)));
    if material.fibres.as_ref().is_some_and(|fibres| fibres.eta == 0.0) && starts("fibres.".into())
        || of_family.into_iter().any(|(number, _)| starts(format!("exponential_fibres[{number}].")))
    {
        return Some("fibres of no stiffness");
    }
    if terms.any(|(word, number, term)| term.alpha == 0.0 && starts(format!("prony.{word}[{number}]."))) {
        return Some("a term of viscosity of no share");
    }
    let is_zero = |rate: Option<f64>, word: &str| rate == Some(0.0) && way == word;
    let damping = is_zero(material.damping, "damping") || is_zero(material.stiffness_damping, "stiffness_damping");
    damping.then_some("damping of 0")
}

/// Whether there is a number for each copy.
fn numbers(validator: &mut Validator, path: &Path, values: &PerCopy, copies: u32) -> bool {
    match values {
        PerCopy::Values(values) if values.len() != copies as usize => {
            let message = format!("there are {} values for {copies} copies", values.len());
            validator.out.error_at(path, message).note("give one a copy");
            false
        }
        PerCopy::LogUniform { from, to, .. } if !(*from > 0.0 && *to > 0.0) => {
            let found = format!("{} and {}", show(*from), show(*to));
            validator.out.error_at(path, format!("`LogUniform` lies between numbers above 0, found {found}"));
            false
        }
        PerCopy::Uniform { from, to, .. } | PerCopy::LogUniform { from, to, .. } if from > to => {
            let message = format!("`from` must not be above `to`, found {} and {}", show(*from), show(*to));
            validator.out.error_at(path, message);
            false
        }
        PerCopy::Axes { x, y, z } => [("x", x), ("y", y), ("z", z)].into_iter().all(|(axis, values)| {
            let path = path.name(axis);
            if values.is_vector() {
                validator.out.error_at(&path, "a component of a vector is one number a copy");
                return false;
            }
            numbers(validator, &path, values, copies)
        }),
        _ => true,
    }
}

/// Looks at the materials of all copies, and tells of the first that is wrong.
fn materials(file: &SceneFile, body: &Body, path: &Path, validator: &mut Validator) {
    for name in body.materials().collect::<BTreeSet<&str>>() {
        let Some(material) = file.scene.materials.get(name) else { continue };
        let Some(copied) = CopiedMaterial::of(body, name, material) else { continue };
        let mut of_all = file.diagnostics();
        material::validate_material(
            &mut Validator { out: &mut of_all },
            &scene("materials").name(name),
            name,
            material,
        );
        if of_all.has_errors() {
            // told already
            continue;
        }
        for copy in 0..body.copies as usize {
            let mut told = file.diagnostics();
            let of_copy = copied.of_copy(copy);
            if let Some(of_copy) = &of_copy {
                let place = scene("materials").name(name);
                material::validate_material(&mut Validator { out: &mut told }, &place, name, of_copy);
            }
            if of_copy.is_some() && !told.has_errors() {
                continue;
            }
            let (key, found) = copied.parameters(copy);
            let first = told.list().into_iter().find(|told| told.severity == crate::scene::Severity::Error);
            let message = first.map_or("the material cannot be read", |told| &told.message);
            let notes = first.map_or(Vec::new(), |told| told.notes.clone());
            let told = validator.out.error_at(path.name(key), format!("copy {copy}, with {found}: {message}"));
            told.notes(notes);
            break;
        }
    }
}
