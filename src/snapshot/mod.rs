//! Snapshots: the whole state of a simulation between two steps, to go back to it, to keep it in a file, and to go on
//! from it in another process. What goes on from a snapshot gives the same bits as what was never interrupted, on the
//! same backend.
//!
//! A snapshot holds the columns that steps carry on (compensation, viscous memory, removed elements and accumulated
//! work among them), the clock, and the state that custom systems [declare](crate::systems::System::with_state). What a
//! scene says stays in the scene: a snapshot fits only simulations of the same [`Identity`].

mod error;
mod format;
mod identity;
mod packed;
mod state_columns;

pub use error::SnapshotError;
pub use packed::PackedSnapshot;

pub(crate) use identity::of_text as hash_of;

#[doc(hidden)]
pub use format::VERSION;
#[doc(hidden)]
pub use identity::{Identity, identity};
#[doc(hidden)]
pub use state_columns::ColumnOwner;

use crate::backend::device::{bring_to_host, send_to_device};
use crate::components::*;
use crate::error::Error;
use crate::output::{OutputError, replace};
use bevy_ecs::prelude::*;
use serde::{Deserialize, Serialize};
use state_columns::{state_columns, update_faces};
use std::collections::BTreeMap;
use std::io::Write;
use std::path::Path;

/// The state of a simulation between two steps.
#[derive(Clone, Debug, PartialEq)]
pub struct Snapshot {
    head: Head,
    /// The columns' bytes, one after the other.
    data: Vec<u8>,
}

/// What a snapshot's file begins with.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
struct Head {
    byte_order: String,
    precision: Precision,
    identity: Identity,
    clock: Clock,
    columns: Vec<ColumnEntry>,
    guards: GuardMemory,
    /// The states of custom systems, as RON.
    systems: BTreeMap<String, String>,
    /// How the simulation goes on from here: the simulation's own words, as RON.
    resume_state: String,
}

impl PartialEq for Head {
    fn eq(&self, other: &Self) -> bool {
        // numbers by their digits: what is written is what counts
        ron::to_string(self).ok() == ron::to_string(other).ok()
    }
}

#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
struct ColumnEntry {
    place: ColumnOwner,
    name: String,
    bytes: u64,
}

/// What a world must know to be kept: inserted when a simulation is made.
#[derive(Resource, Default)]
pub struct Keeping {
    /// Which simulation it is.
    pub identity: Identity,
    /// The number type.
    pub precision: Precision,
    /// Columns that custom systems write.
    pub written: Vec<&'static str>,
    /// Custom systems that declare a state, by name.
    pub systems: BTreeMap<String, StateAccess>,
}

/// How the state of a custom system is kept and taken back.
#[derive(Clone, Copy)]
pub struct StateAccess {
    /// The state as RON.
    pub keep: fn(&World) -> Result<String, String>,
    /// Puts it back.
    pub take_back: fn(&str, &mut World) -> Result<(), String>,
}

impl Snapshot {
    /// The present state of a world.
    ///
    /// # Errors
    /// That the world is one of a static analysis; a custom system's state that cannot be kept; what the GPU says.
    #[doc(hidden)]
    pub fn take(world: &mut World) -> Result<Self, Error> {
        let clock = *world.resource::<Clock>();
        if clock.relaxation.is_some() {
            return Err(SnapshotError::Static.into());
        }
        let Some(keeping) = world.remove_resource::<Keeping>() else { return Err(SnapshotError::Static.into()) };
        let taken = take(world, &keeping, clock);
        world.insert_resource(keeping);
        taken
    }

    /// Puts the state into a world of the same identity.
    ///
    /// # Errors
    /// What does not fit; then the world is as it was. A custom system's state that cannot be taken back; what the GPU
    /// says.
    #[doc(hidden)]
    pub fn put(&self, world: &mut World) -> Result<(), Error> {
        let Some(keeping) = world.remove_resource::<Keeping>() else { return Err(SnapshotError::Static.into()) };
        let put = put(self, world, &keeping);
        world.insert_resource(keeping);
        put
    }

    /// Whether the state fits a world.
    ///
    /// # Errors
    /// What does not.
    pub(crate) fn fits(&self, world: &mut World) -> Result<(), SnapshotError> {
        let Some(keeping) = world.remove_resource::<Keeping>() else { return Err(SnapshotError::Static) };
        let columns = state_columns(world, &keeping.written);
        let fits = check(self, world, &keeping, &columns);
        world.insert_resource(keeping);
        fits
    }

    /// How the simulation goes on from here.
    pub(crate) fn resume_state(&self) -> &str {
        &self.head.resume_state
    }

    /// Sets it.
    pub(crate) fn set_resume_state(&mut self, resume_state: String) {
        self.head.resume_state = resume_state;
    }

    /// The time (s).
    pub fn time(&self) -> f64 {
        self.head.clock.time()
    }

    /// Steps taken until then.
    pub fn step(&self) -> u64 {
        self.head.clock.step
    }

    /// The name of its file in an output folder.
    pub fn file_name(&self) -> String {
        format!("snapshot_{:09}.sinew", self.step())
    }

    /// The snapshot as a file has it.
    ///
    /// # Errors
    /// A custom system's state that cannot be written.
    pub fn to_bytes(&self) -> Result<Vec<u8>, SnapshotError> {
        format::write(&self.head, &self.data)
    }

    /// The snapshot of a file's bytes.
    ///
    /// # Errors
    /// Bytes that are no snapshot, of another version, cut short, damaged, or senseless.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, SnapshotError> {
        let (head, data) = format::read(bytes)?;
        if !head.clock.is_sound() {
            return Err(SnapshotError::Senseless("its clock cannot be that of a motion".into()));
        }
        Ok(Self { head, data })
    }

    /// In which parts two snapshots differ: columns by name and place, or the head.
    pub fn differences(&self, other: &Self) -> Vec<String> {
        let parts = |snapshot: &Self| {
            let mut data = snapshot.data.as_slice();
            let mut parts = BTreeMap::new();
            for column in &snapshot.head.columns {
                let (bytes, rest) = data.split_at((column.bytes as usize).min(data.len()));
                let block = column.place.block.map_or(String::new(), |block| format!(", block {block}"));
                parts.insert(format!("{} of {}{block}", column.name, column.place.body), bytes.to_vec());
                data = rest;
            }
            let text = |text: Result<String, ron::Error>| text.unwrap_or_default().into_bytes();
            parts.insert("clock".into(), text(ron::to_string(&snapshot.head.clock)));
            parts.insert("guards".into(), text(ron::to_string(&snapshot.head.guards)));
            parts.insert("systems".into(), text(ron::to_string(&snapshot.head.systems)));
            parts.insert("resume_state".into(), snapshot.head.resume_state.clone().into_bytes());
            parts.insert("identity".into(), text(ron::to_string(&snapshot.head.identity)));
            parts
        };
        let (ours, theirs) = (parts(self), parts(other));
        let names: std::collections::BTreeSet<&String> = ours.keys().chain(theirs.keys()).collect();
        names.into_iter().filter(|name| ours.get(*name) != theirs.get(*name)).cloned().collect()
    }

    /// Writes the snapshot; the file appears when it is complete.
    ///
    /// # Errors
    /// Files that cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), Error> {
        let bytes = self.to_bytes()?;
        Ok(replace(path, |file| file.write_all(&bytes).map_err(OutputError::system("write", path)))?)
    }

    /// Reads a snapshot.
    ///
    /// # Errors
    /// As [`Snapshot::from_bytes`], and files that cannot be read.
    pub fn read(path: &Path) -> Result<Self, Error> {
        Ok(Self::from_bytes(&format::read_file(path)?)?)
    }
}

fn take(world: &mut World, keeping: &Keeping, clock: Clock) -> Result<Snapshot, Error> {
    let columns = state_columns(world, &keeping.written);
    bring_to_host(world, |entity, name| columns.iter().any(|c| c.entity == entity && c.access.name == name))?;
    let (mut entries, mut data) = (Vec::new(), Vec::new());
    for column in columns {
        let Some(bytes) = (column.access.bytes)(world, column.entity) else { continue };
        let (name, length) = (column.access.name.to_string(), bytes.len() as u64);
        entries.push(ColumnEntry { place: column.place, name, bytes: length });
        data.extend_from_slice(bytes);
    }
    let mut systems = BTreeMap::new();
    for (system, state) in &keeping.systems {
        let refused = |reason| SnapshotError::System { system: system.clone(), done: "kept", reason };
        systems.insert(system.clone(), (state.keep)(world).map_err(refused)?);
    }
    let head = Head {
        byte_order: format::BYTE_ORDER.into(),
        precision: keeping.precision,
        identity: keeping.identity.clone(),
        clock,
        columns: entries,
        guards: world.get_resource::<GuardMemory>().cloned().unwrap_or_default(),
        systems,
        resume_state: String::new(),
    };
    Ok(Snapshot { head, data })
}

fn put(snapshot: &Snapshot, world: &mut World, keeping: &Keeping) -> Result<(), Error> {
    let columns = state_columns(world, &keeping.written);
    check(snapshot, world, keeping, &columns)?;
    let ours = |entity: Entity, name: &'static str| {
        columns.iter().any(|column| column.entity == entity && column.access.name == name)
    };
    // what the device has alone would be brought over what is written now
    bring_to_host(world, ours)?;
    let mut data = snapshot.data.as_slice();
    for column in &columns {
        let length = (column.access.bytes)(world, column.entity).map_or(0, <[u8]>::len);
        let (bytes, rest) = data.split_at(length);
        (column.access.write)(world, column.entity, bytes);
        data = rest;
    }
    world.insert_resource(snapshot.head.clock);
    world.insert_resource(snapshot.head.guards.clone());
    update_faces(world);
    for (system, state) in &keeping.systems {
        let refused = |reason| SnapshotError::System { system: system.clone(), done: "taken back", reason };
        let kept = snapshot.head.systems.get(system).map_or("", String::as_str);
        (state.take_back)(kept, world).map_err(refused)?;
    }
    send_to_device(world, ours)
}

/// Which work is counted where there are columns of some names, and why: what is counted is a part of the state.
fn counted(has: &dyn Fn(&str) -> bool) -> &'static str {
    if has(Work::NAME) {
        "all work is counted, as `output` names `energies_every`"
    } else if has(InternalWork::NAME) {
        "work is counted for the guard `Energy` alone, as `output` does not name `energies_every`"
    } else {
        "no work is counted, as `guards` has `Energy` in `off` and `output` does not name `energies_every`"
    }
}

/// Whether a snapshot fits a world in all that can be compared.
fn check(
    snapshot: &Snapshot,
    world: &World,
    keeping: &Keeping,
    columns: &[state_columns::StateColumn],
) -> Result<(), SnapshotError> {
    let head = &snapshot.head;
    let foreign = |reason: String| Err(SnapshotError::Foreign(reason));
    if head.precision != keeping.precision {
        return foreign(format!("its numbers are {:?}, here they are {:?}", head.precision, keeping.precision));
    }
    let different = identity::differences(&head.identity, &keeping.identity);
    if !different.is_empty() {
        return foreign(format!("these differ: {}", different.join(", ")));
    }
    let names = |systems: Vec<&String>| systems.into_iter().cloned().collect::<Vec<_>>().join(", ");
    if !head.systems.keys().eq(keeping.systems.keys()) {
        let (theirs, here) = (names(head.systems.keys().collect()), names(keeping.systems.keys().collect()));
        return foreign(format!("it keeps the state of the systems [{theirs}], here there are [{here}]"));
    }
    let theirs = counted(&|name| head.columns.iter().any(|column| column.name == name));
    let here = counted(&|name| columns.iter().any(|column| column.access.name == name));
    if theirs != here {
        return foreign(format!("there {theirs}, here {here}"));
    }
    if head.columns.len() != columns.len() {
        return foreign(format!("it has {} columns, here there are {}", head.columns.len(), columns.len()));
    }
    for (theirs, here) in head.columns.iter().zip(columns) {
        let length = (here.access.bytes)(world, here.entity).map_or(0, <[u8]>::len) as u64;
        if theirs.place != here.place || theirs.name != here.access.name || theirs.bytes != length {
            return foreign(format!(
                "where it has {} with {} bytes in {}, here is {} with {length} bytes",
                theirs.name, theirs.bytes, theirs.place.body, here.access.name
            ));
        }
    }
    Ok(())
}
