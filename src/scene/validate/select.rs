//! Selections, as far as they make no sense for any mesh.

use super::{Validator, show};
use crate::scene::limits::NAME_BYTES;
use crate::scene::schema::Select;
use crate::scene::syntax::Path;

pub(super) fn validate(validator: &mut Validator, path: &Path, select: &Select) {
    match select {
        Select::All => {}
        Select::Set(name) => {
            if name.is_empty() {
                validator.out.error_at(path, "the name of the set is empty");
            }
            if name.len() > NAME_BYTES {
                let message = format!("{} bytes in a name; at most {NAME_BYTES} are allowed", name.len());
                validator.out.error_at(path, message);
            }
        }
        Select::Plane { normal, tolerance, .. } => {
            validator.has_direction(&path.name("normal"), *normal);
            if let Some(tolerance) = tolerance {
                validator.not_negative(&path.name("tolerance"), *tolerance, "m");
            }
        }
        Select::Box { min, max, .. } => {
            for (i, (min, max)) in min.to_array().into_iter().zip(max.to_array()).enumerate() {
                if min > max {
                    let axis = ["x", "y", "z"][i];
                    let message =
                        format!("the box is empty: in {axis}, `min` is {} and `max` {}", show(min), show(max));
                    validator.out.error_at(path.name("min").index(i), message);
                }
            }
        }
        Select::Sphere { radius, .. } => validator.above_zero(&path.name("radius"), *radius, "m"),
        Select::Cylinder { from, to, radius } => {
            validator.above_zero(&path.name("radius"), *radius, "m");
            if from == to {
                validator.out.error_at(path.name("to"), "both ends of the cylinder's axis are the same point");
            }
        }
        Select::Ellipsoid { radii, .. } => {
            for (i, radius) in radii.to_array().into_iter().enumerate() {
                validator.above_zero(&path.name("radii").index(i), radius, "m");
            }
        }
        Select::Surface { normal, within } => {
            if let Some(normal) = normal {
                validator.has_direction(&path.name("normal"), *normal);
            }
            if *within <= 0.0 || *within > 180.0 {
                validator.must(&path.name("within"), "above 0 and at most 180 degrees", show(*within));
            }
        }
        Select::Nodes(numbers) => not_empty(validator, path, "Nodes", numbers.is_empty()),
        Select::Elements(numbers) => not_empty(validator, path, "Elements", numbers.is_empty()),
        Select::And(parts) | Select::Or(parts) => {
            let word = if let Select::And(_) = select { "And" } else { "Or" };
            not_empty(validator, path, word, parts.is_empty());
            for (i, part) in parts.iter().enumerate() {
                validate(validator, &path.index(i), part);
            }
        }
        // the path goes through the word `Not`
        Select::Not(part) => validate(validator, path, part),
    }
}

fn not_empty(validator: &mut Validator, path: &Path, word: &str, empty: bool) {
    if empty {
        validator.out.error_at(path, format!("`{word}` has an empty list: it selects nothing"));
    }
}
