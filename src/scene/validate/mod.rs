//! Whether the values of a scene make sense, as far as that can be said without its meshes.

mod action;
mod analysis;
mod attachment;
mod elastic_law;
mod free;
mod friction;
mod geometry;
mod limits;
mod material;
mod names;
mod numbers;
mod output;
mod own_system;
mod per_copy;
mod picture;
mod select;
mod solver;
mod suction;
mod time;
mod tool;

use super::diagnostic::{Diagnostic, Diagnostics};
use super::load::SceneFile;
use super::syntax::{Path, Segment};
use crate::materials::complaints::{number as show, with_unit};
use glam::DVec3;

/// Adds all that is wrong with the values of a scene, each mistake with its place, the value found and what is allowed.
/// Gives whether it makes sense to go on: a scene with more of something than is allowed is not looked at further.
pub fn validate(file: &SceneFile, diagnostics: &mut Diagnostics) -> bool {
    let mut validator = Validator { out: diagnostics };
    if !limits::validate(file, &mut validator) {
        return false;
    }
    limits::elements(file, &mut validator);
    numbers::validate(file, &mut validator);
    names::validate(file, &mut validator);
    material::validate(&file.scene, &mut validator);
    geometry::validate(file, &mut validator);
    per_copy::validate(file, &mut validator);
    action::validate(&file.scene, &mut validator);
    own_system::validate(&file.scene, &mut validator);
    tool::validate(file, &mut validator);
    free::validate(&file.scene, &mut validator);
    attachment::validate(&file.scene, &mut validator);
    time::validate(&file.scene, &mut validator);
    analysis::validate(&file.scene, &mut validator);
    solver::validate(&file.scene, &mut validator);
    output::validate(&file.scene, &mut validator);
    picture::validate(&file.scene, &mut validator);
    true
}

/// Adds what is wrong with how a scene is drawn, and nothing else: of a scene that has been run already.
pub fn validate_picture(file: &SceneFile, diagnostics: &mut Diagnostics) {
    picture::validate(&file.scene, &mut Validator { out: diagnostics });
}

/// Notes mistakes of the common kinds.
struct Validator<'a> {
    out: &'a mut Diagnostics,
}

/// The way to a field of the scene.
fn scene(field: &str) -> Path {
    Path::default().name(field)
}

/// The field a path leads to, as sentences begin with it.
fn called(path: &Path) -> String {
    let name = path.0.iter().rev().find_map(|segment| match segment {
        Segment::Name(name) => Some(name.as_str()),
        Segment::Index(_) => None,
    });
    format!("`{}`", name.unwrap_or("the scene"))
}

impl Validator<'_> {
    /// Notes that a value must be something else.
    fn must(&mut self, path: &Path, be: &str, found: impl std::fmt::Display) -> &mut Diagnostic {
        self.out.error_at(path, format!("{} must be {be}, found {found}", called(path)))
    }

    fn above_zero(&mut self, path: &Path, value: f64, unit: &str) {
        if value <= 0.0 {
            self.must(path, "above 0", with_unit(value, unit));
        }
    }

    fn not_negative(&mut self, path: &Path, value: f64, unit: &str) {
        if value < 0.0 {
            self.must(path, "0 or above", with_unit(value, unit));
        }
    }

    fn all_above_zero(&mut self, path: &Path, value: DVec3, unit: &str) {
        for (i, part) in value.to_array().into_iter().enumerate() {
            self.above_zero(&path.index(i), part, unit);
        }
    }

    /// A vector that has a direction: its length must be neither zero nor lost to underflow.
    fn has_direction(&mut self, path: &Path, value: DVec3) {
        if value.try_normalize().is_none() {
            let message = format!("{} has no direction: its length is 0", called(path));
            self.out.error_at(path, message).note("its length does not matter, but it must point somewhere: (0, 0, 1)");
        }
    }
}
