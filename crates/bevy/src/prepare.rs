//! From scenes to simulations: when they are loaded, and when they change.

use crate::mesh::BodyShape;
use crate::scene::SceneText;
use crate::simulation::*;
use bevy_asset::{AssetEvent, AssetId, Assets};
use bevy_ecs::prelude::*;
use bevy_mesh::{Mesh, Mesh3d};
use sinew::{Error, Simulation};
use std::collections::{BTreeMap, BTreeSet};

type Scene<'a> = (Entity, Ref<'a, SoftScene>, Ref<'a, SoftOptions>, Option<&'a Children>);

/// Makes simulations of scenes that are there now, or that have changed. Where the new one is wrong, the old one goes
/// on.
pub(crate) fn prepare(
    mut commands: Commands,
    mut events: MessageReader<AssetEvent<SceneText>>,
    mut tried: Local<BTreeMap<Entity, AssetId<SceneText>>>,
    mut made: Local<u64>,
    texts: Res<Assets<SceneText>>,
    mut meshes: ResMut<Assets<Mesh>>,
    scenes: Query<Scene>,
    bodies: Query<(&SoftBody, &Mesh3d)>,
    mut refused: MessageWriter<Refused>,
) {
    let changed = |event: &AssetEvent<SceneText>| match event {
        AssetEvent::Modified { id } => Some(*id),
        _ => None,
    };
    let modified: BTreeSet<AssetId<SceneText>> = events.read().filter_map(changed).collect();
    tried.retain(|scene, _| scenes.contains(*scene));
    for (entity, scene, options, children) in &scenes {
        let id = scene.0.id();
        if scene.is_changed() || options.is_changed() || modified.contains(&id) {
            tried.remove(&entity);
        }
        let Some(text) = texts.get(id).filter(|_| tried.get(&entity) != Some(&id)) else { continue };
        tried.insert(entity, id);
        match start(text, &options) {
            Ok((simulation, shapes)) => {
                let children = children.into_iter().flatten().copied();
                let there: Vec<(Entity, &str, &Mesh3d)> = children
                    .filter_map(|child| bodies.get(child).ok().map(|(body, mesh)| (child, body.name.as_str(), mesh)))
                    .collect();
                for (child, ..) in there.iter().filter(|(_, name, _)| !shapes.contains_key(*name)) {
                    commands.entity(*child).despawn();
                }
                for (name, shape) in shapes {
                    let mesh = shape.mesh(1.0);
                    // what is there keeps its material
                    if let Some((child, _, handle)) = there.iter().find(|(_, other, _)| *other == name) {
                        // a mesh that is not there any more is nobody's
                        let _ = meshes.insert(&handle.0, mesh);
                        commands.entity(*child).insert(shape);
                    } else {
                        let handle = Mesh3d(meshes.add(mesh));
                        commands.spawn((SoftBody { name }, shape, handle, ChildOf(entity)));
                    }
                }
                *made += 1;
                commands.entity(entity).insert(SoftSimulation::new(simulation, *made));
            }
            Err(error) => {
                refused.write(Refused { scene: entity, error: error.to_string() });
            }
        }
    }
}

/// A simulation, and its bodies as they are at first.
fn start(text: &SceneText, options: &SoftOptions) -> Result<(Simulation, BTreeMap<String, BodyShape>), Error> {
    let mut simulation = Simulation::new(&text.read(&options.sets)?, &options.options)?;
    let names: Vec<String> = simulation.scene().bodies.keys().cloned().collect();
    let mut shapes = BTreeMap::new();
    for name in names {
        shapes.insert(name.clone(), BodyShape::of(&mut simulation, &name)?);
    }
    Ok((simulation, shapes))
}
