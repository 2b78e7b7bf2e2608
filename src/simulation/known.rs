//! The systems that a scene may name: those of a registry, and those that it has of its own.

use crate::backend::user_law::NamedLaw;
use crate::scene::Diagnostics;
use crate::scene::schema::Scene;
use crate::scene::syntax::Path;
use crate::systems::{Phase, Registry, System};

/// The systems that a scene may name.
pub struct Known<'a> {
    registry: &'a Registry,
    own: Vec<System>,
}

impl<'a> Known<'a> {
    /// Those of a scene and a registry.
    pub fn of(registry: &'a Registry, scene: &Scene) -> Self {
        Self { registry, own: crate::systems::of_scene(scene) }
    }

    /// The laws in Rust.
    pub fn laws(&self) -> &[NamedLaw] {
        self.registry.laws()
    }

    /// All systems in the order of the step; the scene's own come after the other loads.
    pub fn systems(&self) -> impl Iterator<Item = &System> {
        let all = self.registry.systems();
        let loads = all.iter().position(|system| system.phase > Phase::Loads).unwrap_or(all.len());
        all[..loads].iter().chain(&self.own).chain(&all[loads..])
    }

    /// The system of a name.
    pub fn get(&self, name: &str) -> Option<&System> {
        self.registry.get(name).or_else(|| self.own.iter().find(|system| system.name == name))
    }

    /// Whether a system is one of the scene's own.
    pub fn is_own(&self, name: &str) -> bool {
        self.own.iter().any(|system| system.name == name)
    }

    /// Looks for names that two systems would have.
    pub fn check(&self, diagnostics: &mut Diagnostics) {
        for System { name, .. } in &self.own {
            if let Some(other) = self.registry.get(name) {
                let whose = if other.custom { "the program's own" } else { "sinew's own" };
                let path = Path::default().name("systems").name(name);
                diagnostics
                    .error_at(path, format!("`{name}` is a system of {whose}: {}", other.does))
                    .note("choose another name, and give it to the function in the file");
            }
        }
    }
}
