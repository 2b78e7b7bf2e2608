//! What a simulation is: hashes of all that its motion depends on, so that a snapshot is not put into another one.

use crate::backend::cpu::BlockLaw;
use crate::components::*;
use crate::materials::ElasticLaw;
use crate::scene::schema::{InitialState, Scene, Solver};
use crate::tools::Geometry;
use bevy_ecs::prelude::*;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::hash::Hasher;
use twox_hash::XxHash64;

/// Hashes of a simulation's parts as texts, by the part's name in scenes. Titles, probes, outputs, pictures and guards
/// are no parts: they may differ, but for what they have work counted for, which is in the columns of the state.
pub type Identity = BTreeMap<String, String>;

const MESHES: &str = "meshes (with their named sets and fields)";
const TOOLS: &str = "tools, contacts and attachments";
const TIME_STEP: &str = "time step (from `duration` and `integration`)";

/// The identity of a scene and the world that was made of it, before its first step.
pub fn identity(scene: &Scene, world: &mut World) -> Identity {
    let mut parts = Identity::new();
    let mut add = |name: &str, hash: u64| parts.insert(name.into(), format!("{hash:016x}"));
    add("bodies", of_text(&scene.bodies));
    // what it does is in the columns, unless nothing has been done yet
    if scene.start != InitialState::default() {
        add("start", of_text(&scene.start));
    }
    // explicit steps are told by their length
    if scene.solver != Solver::default() {
        add("solver", of_text(&scene.solver));
    }
    add("constraints", of_text(&scene.constraints));
    add("loads", of_text(&scene.loads));
    if !scene.systems.is_empty() {
        let mut systems = XxHash64::default();
        systems.write_u64(of_text(&scene.systems));
        let mut loads: Vec<&OwnLoad> = world.query::<&OwnLoad>().iter(world).collect();
        loads.sort_by(|a, b| a.text.name.cmp(&b.text.name));
        for load in loads {
            // the scene only names the file
            systems.write(load.text.text.as_bytes());
            systems.write(&load.text.uniform);
        }
        add("systems", systems.finish());
    }
    if !scene.tools.is_empty() || !scene.contacts.is_empty() || !scene.attachments.is_empty() {
        let mut tools = XxHash64::default();
        tools.write_u64(of_text(&(&scene.tools, &scene.contacts)));
        if !scene.suction.is_empty() {
            tools.write_u64(of_text(&scene.suction));
        }
        if !scene.attachments.is_empty() {
            tools.write_u64(of_text(&scene.attachments));
        }
        // the scene only names the file
        let mut of_tool = |geometry: &Geometry| {
            if let Geometry::Grid(grid) = geometry {
                tools.write(bytemuck::cast_slice(grid.values()));
            }
        };
        for contacts in world.query::<&ToolContacts>().iter(world) {
            contacts.tools.iter().for_each(|contact| of_tool(&contact.geometry));
        }
        if let Some(free) = world.get_resource::<FreeTools>() {
            free.all.iter().for_each(|tool| of_tool(&tool.geometry));
        }
        for grasps in world.query::<&Grasps>().iter(world) {
            grasps.grasps.iter().for_each(|grasp| of_tool(&grasp.tool.geometry));
        }
        add(TOOLS, tools.finish());
    }
    add("removal", of_text(&scene.removal));
    add("integration", of_text(&scene.integration));
    add("schedule", of_text(&scene.schedule));
    add("parameters", of_text(&scene.parameters));
    // a longer scene has the same steps where `step` is named; else they fit its duration
    add(TIME_STEP, world.resource::<Clock>().time_step.to_bits());
    let (mut meshes, mut laws) = (XxHash64::default(), XxHash64::default());
    let columns = all_columns();
    for (_, place) in super::state_columns::places(world) {
        // fields of elements too: fibres of another file pull otherwise
        for column in columns.iter().filter(|column| matches!(column.role, Role::Structure | Role::Given)) {
            if let Some(bytes) = (column.bytes)(world, place) {
                meshes.write(column.name.as_bytes());
                meshes.write(bytes);
            }
        }
        let entity = world.entity(place);
        if let Some(rest) = entity.get::<RestPosition>() {
            meshes.write(bytemuck::cast_slice(&rest.0));
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
    meshes.write_u64(sets_in_use(world));
    add(MESHES, meshes.finish());
    laws.write_u64(of_text(&scene.materials));
    add("materials", laws.finish());
    parts
}

/// The rows that constraints, loads and removal act on, as they were found by the names of sets or by place.
fn sets_in_use(world: &mut World) -> u64 {
    let mut all: Vec<u64> = Vec::new();
    let mut note = |kind: &str, number: usize, parts: &[&[u8]]| {
        let mut hash = XxHash64::default();
        hash.write(kind.as_bytes());
        hash.write_usize(number);
        parts.iter().for_each(|part| hash.write(part));
        all.push(hash.finish());
    };
    fn bytes<T: bytemuck::NoUninit>(rows: &[T]) -> &[u8] {
        bytemuck::cast_slice(rows)
    }
    world.query::<&Fixed>().iter(world).for_each(|c| note("fixed", c.axes as usize, &[bytes(&c.rows)]));
    world.query::<&Prescribed>().iter(world).for_each(|c| {
        note("prescribed", c.signal, &[&c.axes.to_le_bytes(), bytes(&c.rows), bytes(&c.arms)]);
    });
    world.query::<&SceneLoad>().iter(world).for_each(|load| match &load.on {
        LoadedRows::All(factors) if factors.is_empty() => {}
        LoadedRows::All(factors) => note(load.name, load.signal, &[bytes(factors)]),
        LoadedRows::Nodes(nodes) => note(load.name, load.signal, &[bytes(&nodes.rows), bytes(&nodes.factors)]),
        LoadedRows::Faces(faces) => note(load.name, load.signal, &[bytes(&faces.faces), bytes(&faces.factors)]),
    });
    world.query::<&OwnLoad>().iter(world).for_each(|l| {
        note("system", l.signal, &[bytes(l.rows.as_deref().unwrap_or_default())]);
    });
    if let Some(glue) = world.get_resource::<Glue>() {
        for tie in &glue.ties {
            let nodes: Vec<u8> =
                tie.nodes.iter().flat_map(|(row, weight)| [bytes(&[*row]), bytes(&[*weight])].concat()).collect();
            let behind: Vec<u8> =
                tie.behind.iter().flat_map(|(row, weight)| [bytes(&[*row]), bytes(&[*weight])].concat()).collect();
            let face = [bytes(&tie.corners), bytes(&tie.weights), &behind].concat();
            note("tie", tie.number, &[&nodes, &face, bytes(&tie.gap.to_array())]);
        }
    }
    world.query::<&RemovalCriterion>().iter(world).for_each(|r| {
        note("removal", r.measure as usize, &[bytes(&r.rows), &r.limit.to_le_bytes()]);
    });
    world.query::<&RemovalTime>().iter(world).for_each(|r| note("removal in time", 0, &[bytes(&r.0)]));
    // entities come in no order that a scene knows of
    all.sort_unstable();
    XxHash64::oneshot(0, bytes(&all))
}

/// A hash of a part of a scene as it would be written.
pub(crate) fn of_text<T: Serialize>(part: &T) -> u64 {
    // what cannot be written has no part in two scenes being the same
    XxHash64::oneshot(0, ron::to_string(part).unwrap_or_default().as_bytes())
}

/// What is made of meshes knows of these, too.
const OF_MESHES: [&str; 6] = ["materials", "constraints", "loads", "systems", TOOLS, "removal"];

/// The parts in which two identities differ; meshes only where nothing does that they know of.
pub fn differences(a: &Identity, b: &Identity) -> Vec<String> {
    let differs = |name: &str| a.get(name) != b.get(name);
    let follows = |name: &str| name == MESHES && OF_MESHES.iter().any(|of| differs(of));
    let names: BTreeSet<&String> = a.keys().chain(b.keys()).collect();
    names.into_iter().filter(|name| differs(name) && !follows(name)).cloned().collect()
}
