//! The systems and the laws in Rust that a scene may name.

use super::system::System;
use crate::backend::user_law::NamedLaw;
use crate::materials::RustLaw;
use bevy_ecs::prelude::*;

/// The systems and the laws in Rust that a scene may name.
pub struct Registry {
    systems: Vec<System>,
    laws: Vec<NamedLaw>,
}

impl Default for Registry {
    fn default() -> Self {
        Self { systems: super::standard(), laws: Vec::new() }
    }
}

impl Registry {
    /// Adds a system, behind all others of its phase; one of the same name is replaced. A scene that writes no
    /// `schedule` has it there, as far as [it takes part](System::when).
    pub fn with(mut self, system: System) -> Self {
        self.systems.retain(|s| s.name != system.name);
        let place = self.systems.iter().position(|s| s.phase > system.phase).unwrap_or(self.systems.len());
        self.systems.insert(place, system);
        self
    }

    /// Adds a law in Rust, which materials name by `law: (rust: "name", parameters: {…})`; one of the same name is
    /// replaced.
    pub fn with_law<L: RustLaw>(mut self, name: impl Into<String>) -> Self {
        let law = NamedLaw::of::<L>(name);
        self.laws.retain(|known| known.name != law.name);
        self.laws.push(law);
        self
    }

    /// The laws that were added.
    pub fn laws(&self) -> &[NamedLaw] {
        &self.laws
    }

    /// All systems in the order of the step.
    pub fn systems(&self) -> &[System] {
        &self.systems
    }

    /// The system of a name.
    pub fn get(&self, name: &str) -> Option<&System> {
        self.systems.iter().find(|s| s.name == name)
    }
}

/// "3 loads", "1 load", or nothing for none: how often a component occurs in a world.
pub(crate) fn count<C: Component>(world: &mut World, one: &str, many: &str) -> Option<String> {
    match world.query::<&C>().iter(world).count() {
        0 => None,
        1 => Some(format!("1 {one}")),
        n => Some(format!("{n} {many}")),
    }
}
