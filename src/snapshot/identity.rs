//! What a simulation is: hashes of all that its motion depends on, so that a snapshot is not put into another one.

use crate::backend::cpu::BlockLaw;
use crate::components::*;
use crate::materials::ElasticLaw;
use crate::scene::schema::Scene;
use bevy_ecs::prelude::*;
use serde::Serialize;
use std::collections::BTreeMap;
use std::hash::Hasher;
use twox_hash::XxHash64;

/// Hashes of a simulation's parts as texts, by the part's name in scenes. Titles, probes, outputs, pictures and guards are no
/// parts: they may differ.
pub type Identity = BTreeMap<String, String>;

/// The identity of a scene and the world that was made of it, before its first step.
pub fn identity(scene: &Scene, world: &mut World) -> Identity {
    let mut parts = Identity::new();
    let mut add = |name: &str, hash: u64| parts.insert(name.into(), format!("{hash:016x}"));
    add("bodies", of_text(&scene.bodies));
    add("constraints", of_text(&scene.constraints));
    add("loads", of_text(&scene.loads));
    add("removal", of_text(&scene.removal));
    add("integration", of_text(&scene.integration));
    add("schedule", of_text(&scene.schedule));
    add("parameters", of_text(&scene.parameters));
    // a longer scene has the same steps where `step` is named; else they fit its duration
    add("time step (from `duration` and `integration`)", world.resource::<Clock>().time_step.to_bits());
    let (mut meshes, mut laws) = (XxHash64::default(), XxHash64::default());
    for (_, entity) in super::columns::places(world) {
        let entity = world.entity(entity);
        if let Some(rest) = entity.get::<RestPosition>() {
            meshes.write(bytemuck::cast_slice(&rest.0));
        }
        if let Some(connectivity) = entity.get::<Connectivity>() {
            meshes.write(connectivity.bytes());
        }
        if let Some(block) = entity.get::<Block>() {
            meshes.write(format!("{:?} {}", block.kind, block.count).as_bytes());
        }
        if let Some(law) = entity.get::<BlockLaw<f64>>() {
            laws.write(format!("{law:?}").as_bytes());
            // of a law of one's own that only names the file
            if let ElasticLaw::UserLaw(law) = &law.elastic {
                laws.write(law.parts().text.as_bytes());
                laws.write(&law.parts().uniform);
            }
        }
    }
    add("meshes", meshes.finish());
    laws.write_u64(of_text(&scene.materials));
    add("materials", laws.finish());
    parts
}

fn of_text<T: Serialize>(part: &T) -> u64 {
    // what cannot be written has no part in two scenes being the same
    XxHash64::oneshot(0, ron::to_string(part).unwrap_or_default().as_bytes())
}

/// The parts in which two identities differ.
pub fn differences(a: &Identity, b: &Identity) -> Vec<String> {
    let names: std::collections::BTreeSet<&String> = a.keys().chain(b.keys()).collect();
    names.into_iter().filter(|name| a.get(*name) != b.get(*name)).cloned().collect()
}
