//! Whether the values of a scene make sense, as far as that can be said without its meshes.

use super::diagnostic::Diagnostics;
use super::load::SceneFile;

/// Adds all that is wrong with the values of a scene.
pub fn validate(_file: &SceneFile, _diagnostics: &mut Diagnostics) {}
