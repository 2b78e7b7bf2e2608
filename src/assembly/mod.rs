//! From a scene to a world of entities: meshes are made or read, renumbered for locality and turned into bodies; names
//! and places become rows.

mod anchors;
mod body;
mod body_columns;
mod constraints;
mod contacts;
mod element_removal;
mod fibres;
mod frames;
mod free_tools;
mod glue;
mod grasps;
mod loads;
mod locality;
mod material;
mod meshes;
mod observation;
mod own_systems;
mod own_texts;
mod patches;
mod relaxation;
mod renew;
mod select;
mod skins;
mod start;
mod suction;
mod surface_contacts;
mod surface_overlaps;
mod sutures;
mod time_step;
mod tool_looks;
mod tool_overlaps;
mod tool_pace;
mod tool_removal;
mod user_laws;

pub use body::BodyParts;
pub use body_columns::insert_laws;
pub use contacts::motion;
pub use element_removal::step_of;
pub use meshes::{PlacedMesh, mesh_of};
pub use observation::steps_of;
pub use patches::insert_forces;
pub use relaxation::load_steps;
pub use renew::renew_materials;
pub use select::Selection;
pub(crate) use time_step::square_wave_frequencies;
pub use time_step::{
    CriticalElement, SquaresAtRest, StableStep, alike_in_any_precision, author_of, damped, damping_times, element_step,
    square_frequencies, stable_step, undamped_square_frequencies,
};

use crate::backend::user_law::NamedLaw;
use crate::components::*;
use crate::scene::SceneFile;
use crate::scene::diagnostic::Diagnostics;
use crate::scene::schema;
use bevy_ecs::prelude::*;
use std::collections::BTreeMap;

/// What is known of a scene while its world is being put together.
pub struct Assembly<'a> {
    /// The scene.
    pub scene: &'a SceneFile,
    /// The run's precision.
    pub precision: Precision,
    /// How element forces are summed.
    pub scheme: Scheme,
    /// The bodies' meshes in the author's numbering, by name.
    pub bodies: BTreeMap<String, BodyParts>,
    /// The materials, by name.
    pub materials: BTreeMap<String, Entity>,
}

/// Puts a scene's world together, without a time step yet. Complaints go to `diagnostics`. `None` when the bodies
/// cannot be made; there may be errors all the same when they can. `laws` are those in Rust that it may name.
pub fn assemble<'a>(
    scene: &'a SceneFile,
    precision: Precision,
    scheme: Scheme,
    laws: &[NamedLaw],
    world: &mut World,
    diagnostics: &mut Diagnostics,
) -> Option<Assembly<'a>> {
    if !crate::scene::validate(scene, diagnostics) {
        return None;
    }
    let meshes = meshes::meshes(scene, diagnostics);
    let mut laws = user_laws::read(scene, laws, diagnostics);
    let systems = own_systems::read(scene, diagnostics);
    if diagnostics.has_errors() {
        return None;
    }
    let materials = material::spawn(&scene.scene, &mut laws, world);
    let mut signals = Signals::default();
    for (_, curve) in scene.scene.curves() {
        signals.declare(curve);
    }
    world.insert_resource(signals);
    let mut assembly = Assembly { scene, precision, scheme, bodies: BTreeMap::new(), materials };
    for (name, mesh) in meshes {
        if let Some(parts) = body::spawn(&assembly, &name, mesh, world, diagnostics) {
            assembly.bodies.insert(name, parts);
        }
    }
    if diagnostics.has_errors() {
        return None;
    }
    // what is wrong with these does not keep other mistakes from being found
    constraints::spawn(&assembly, world, diagnostics);
    loads::spawn(&assembly, world, diagnostics);
    contacts::spawn(&assembly, world, diagnostics);
    free_tools::spawn(&assembly, world, diagnostics);
    surface_contacts::spawn(&assembly, world);
    grasps::spawn(&assembly, world, diagnostics);
    sutures::spawn(&assembly, world, diagnostics);
    glue::spawn(&assembly, world, diagnostics);
    own_systems::spawn(&assembly, &systems, world, diagnostics);
    Some(assembly)
}

/// What depends on the time step: removal by time, probes, the laws' history.
pub fn assemble_in_time(assembly: &Assembly<'_>, world: &mut World, diagnostics: &mut Diagnostics) {
    element_removal::spawn(assembly, world, diagnostics);
    observation::spawn(assembly, world, diagnostics);
    insert_laws(assembly.precision, world);
    start::deform(assembly, world, diagnostics);
    glue::spawn_elsewhere(assembly, world, diagnostics);
    // turning is about where bodies are then
    body_columns::start(assembly, world);
    let begin_inside = [
        contacts::check(assembly, world, diagnostics),
        free_tools::check(assembly, world, diagnostics),
        surface_overlaps::check(assembly, world, diagnostics),
    ];
    if begin_inside.contains(&true) {
        world.insert_resource(BeginsInside);
    }
    grasps::check(assembly, world, diagnostics);
    sutures::measure(assembly, world, diagnostics);
    let scene = &assembly.scene.scene;
    if scene.when_unstable() == schema::WhenUnstable::Remove && !scene.is_static() {
        let blocks = assembly.bodies.values().flat_map(|body| &body.blocks);
        blocks.for_each(|&block| element_removal::insert_columns(assembly.precision, block, world));
    }
    suction::spawn(assembly, world, diagnostics);
    tool_looks::insert(assembly, world);
    tool_pace::check(assembly, world, diagnostics);
    contacts::spawn_idle(assembly, world);
    if scene.is_static() {
        relaxation::insert_inertial_masses(assembly, world);
    }
}

impl Assembly<'_> {
    /// The body that an item names, or the only one. Validation has seen to it that there is one.
    pub fn body(&self, name: &Option<String>) -> Option<&BodyParts> {
        match name {
            Some(name) => self.bodies.get(name),
            None => self.bodies.values().next(),
        }
    }

    /// What a selection picks on a body, or complaints at `path`; an empty pick is an error.
    pub fn pick(
        &self,
        body: &BodyParts,
        select: &schema::Select,
        path: &str,
        diagnostics: &mut Diagnostics,
    ) -> Option<Selection> {
        match select::pick(&body.placed, select) {
            Ok(picked) => Some(picked),
            Err(problem) => {
                diagnostics.error_at(path, problem.message).notes(problem.notes);
                None
            }
        }
    }
}
