//! Systems of the scene's own, read from the files that it names: loads in WGSL.

use super::{Assembly, BodyParts, own_texts};
use crate::backend::user_law::{check_load, read_load};
use crate::components::*;
use crate::scene::SceneFile;
use crate::scene::diagnostic::{Diagnostics, TextFile};
use crate::scene::schema::{Curve, OwnSystem, Select};
use crate::scene::syntax::Path;
use bevy_ecs::prelude::*;
use glam::DVec3;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Nodes of each body that a load is tried on when a scene is read.
const TRIED: usize = 1000;

/// A system that has been read, with its file.
pub(super) struct Read {
    text: Arc<LoadText>,
    file: Arc<TextFile>,
}

/// The systems of a scene by name. Complaints go to `diagnostics`.
pub(super) fn read(scene: &SceneFile, diagnostics: &mut Diagnostics) -> BTreeMap<String, Read> {
    let mut found = BTreeMap::new();
    for (name, system) in &scene.scene.systems {
        let place = place_of(name);
        if diagnostics.has_error_in(place.clone()) {
            continue;
        }
        let Some(file) = own_texts::read(scene, &system.file, &place, diagnostics) else { continue };
        match read_load(name, &system.file, &file.text, &system.parameters) {
            Ok(text) => {
                found.insert(name.clone(), Read { text: Arc::new(text), file });
            }
            Err(complaints) => {
                for complaint in complaints {
                    own_texts::tell(complaint, &file, &place, diagnostics);
                }
            }
        }
    }
    found
}

fn place_of(name: &str) -> Path {
    Path::default().name("systems").name(name)
}

/// Spawns what has been read, on each body that it acts on, and tries it on the nodes there. Complaints go to
/// `diagnostics`.
pub(super) fn spawn(
    assembly: &Assembly<'_>,
    read: &BTreeMap<String, Read>,
    world: &mut World,
    diagnostics: &mut Diagnostics,
) {
    for (number, (name, system)) in assembly.scene.scene.systems.iter().enumerate() {
        let Some(Read { text, file }) = read.get(name) else { continue };
        let place = place_of(name);
        let signal = Signal::Load { curve: system.curve.clone(), amplitude: DVec3::X };
        let signal = world.resource_mut::<Signals>().add(signal);
        let named = system.body.as_ref().and_then(|name| assembly.bodies.get(name));
        let bodies: Vec<&BodyParts> = named.map_or(assembly.bodies.values().collect(), |body| vec![body]);
        let mut tried = Vec::new();
        for body in bodies {
            let Some(rows) = rows_of(assembly, body, (name, system), diagnostics) else { continue };
            tried.extend(nodes_at_rest(body, rows.as_deref(), world));
            world.spawn((OwnLoad { text: Arc::clone(text), rows, signal }, OfBody(body.entity), OfSystem(number)));
        }
        for complaint in check_load(text, tried, system.curve != Curve::default()) {
            own_texts::tell(complaint, file, &place, diagnostics);
        }
    }
}

/// Rows of the nodes of a body that a system acts on; within, none: all of them.
fn rows_of(
    assembly: &Assembly<'_>,
    body: &BodyParts,
    (name, system): (&str, &OwnSystem),
    diagnostics: &mut Diagnostics,
) -> Option<Option<Vec<u32>>> {
    if system.on == Select::All {
        return Some(None);
    }
    let on = format!("systems.\"{name}\".on");
    let picked = assembly.pick(body, &system.on, &on, diagnostics)?;
    match picked.nodes(&body.placed) {
        Ok(marks) => Some(Some(body.rows_of(&marks))),
        Err(problem) => {
            diagnostics.error_at(on.as_str(), problem.message).notes(problem.notes);
            None
        }
    }
}

/// Some of the nodes that a load acts on, evenly from all of them, with the author's numbers.
fn nodes_at_rest(body: &BodyParts, rows: Option<&[u32]>, world: &World) -> Vec<(u64, NodeAtRest)> {
    let entity = world.entity(body.entity);
    let (Some(rest), Some(mass), Some(authoring)) =
        (entity.get::<RestPosition>(), entity.get::<Mass>(), entity.get::<Authoring>())
    else {
        return Vec::new();
    };
    let count = rows.map_or(rest.0.len(), <[u32]>::len);
    let row_of = |place: usize| rows.map_or(place, |rows| rows[place] as usize);
    let mut numbers = vec![0; rest.0.len()];
    for (node, &row) in authoring.node_rows.iter().enumerate() {
        numbers[row as usize] = authoring.node_ids.of(node);
    }
    let every = count.div_ceil(TRIED).max(1);
    let of_row = |row: usize| {
        (numbers[row], NodeAtRest { rest_position: rest.0[row], mass: mass.get(row), curve: 1.0, time: 0.0 })
    };
    (0..count).step_by(every).map(row_of).filter(|&row| mass.get(row) > 0.0).map(of_row).collect()
}
