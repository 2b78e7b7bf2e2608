//! Looking at a run: probes, energies, fields and guards, when they are due. Reads only.

mod attachments;
mod balance;
mod contact_fields;
mod contacts;
mod element_fields;
mod energies;
mod fields;
mod frame;
mod free_tools;
mod grasps;
mod guards;
mod heading;
mod overlaps;
mod path;
mod probes;
mod rounding;
mod sample;
mod skins;
mod tables;
mod tools;
mod track;

pub use attachments::{AttachmentReading, read_attachment};
pub use balance::{begin as begin_to_guard, held_for_long};
pub use contacts::{ContactReading, read_contact};
pub use energies::{energies, energy_header, mass, removed_momentum};
pub use fields::{BodyFields, body_fields, internal_forces};
pub use frame::{WrittenFields, field_of, write as write_fields, write_whole};
pub use guards::GuardSettings;
pub use heading::Heading;
pub use path::{PATH, columns_of_probe};
pub use probes::{header, observe_probe, volume_left, with_peaks};
pub use rounding::{Rounding, shortest_edge};
pub use sample::{GuardKernels, Sample, sample};
pub use skins::{SkinState, skin_of, write_skins};
pub use tools::{Felt, FreeReading, ToolReading, feel, read_tool, way_of};
pub use track::{Track, between, turn_of};

use self::track::Moment;
use crate::components::*;
use crate::error::{Criterion, Error, Instability};
use crate::output::{Folder, Lock, OutputError, Series, Table};
use crate::snapshot::Snapshot;
use bevy_ecs::prelude::*;
use std::collections::{BTreeMap, VecDeque};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

/// Steps between two checks for numbers that are not finite and for elements turned inside out, at most, on the host.
/// On a GPU its kernels look in every step, and the host asks them in every 256 at least; where systems of one's own
/// run on the host meanwhile, in every 16 there, too.
pub const HOST_GUARD_STEPS: u64 = 16;
/// The same where all systems run on the device.
pub const DEVICE_GUARD_STEPS: u64 = 256;

/// What is observed when, and where it goes. A resource; the system `observe` runs it.
#[derive(Resource, Default)]
pub struct Observer {
    /// How often fields are written.
    pub fields: Cadence,
    /// How energies are taken; `None`: not at all.
    pub energy: Option<Track>,
    /// Whether what contact takes is a column beside the energies.
    pub touches: bool,
    /// How often snapshots are written; `None`: never.
    pub snapshots: Option<Cadence>,
    /// How the run is guarded.
    pub guard_settings: GuardSettings,
    /// Whether steps are taken on a GPU.
    pub on_gpu: bool,
    /// Whether they are so without a system that runs on the host.
    pub all_on_device: bool,
    /// The last step that passed all guards in a check of energies and elements.
    pub checked_at: Option<u64>,
    /// The step at which the guards look again at what they are in doubt of.
    pub checks_again: Option<u64>,
    /// The last states that passed all guards, the oldest first.
    pub window: VecDeque<Snapshot>,
    /// The last step of the run, which is always observed. That of a static analysis is known when it is there.
    pub last_step: u64,
    /// Of a static analysis, where steps are taken back and time stands still: only the start, the last step, and what
    /// [`observe_on_the_way`](Observer::observe_on_the_way) is called for.
    pub to_rest: bool,
    /// Whether that follows a path of equilibria.
    pub follows_path: bool,
    on_the_way: f64,
    files: Option<Files>,
    probes: Vec<ProbeTrack>,
    /// What each probe saw last: time (s) and values.
    pub latest: BTreeMap<String, (f64, Vec<f64>)>,
    /// Time up to which all was well (s).
    pub good_until: f64,
    /// What observing and writing has taken so far, guards left out.
    pub writing: Duration,
}

/// A probe that is observed.
struct ProbeTrack {
    entity: Entity,
    name: String,
    track: Track,
}

struct Files {
    folder: PathBuf,
    _lock: Arc<Lock>,
    series: Series,
    energies: Option<Table>,
    probes: BTreeMap<String, Table>,
    convergence: Option<Table>,
    path: Option<Table>,
    /// Of bodies with a skin.
    skins: Vec<(Entity, Series)>,
}

/// The columns of `convergence.csv`, plain numbers all.
pub const CONVERGENCE: [&str; 5] = ["step", "load share", "residual", "remaining motion", "damping"];

impl Observer {
    /// Observes the probes of a world.
    pub fn track_probes(&mut self, world: &mut World) {
        let mut probes: Vec<ProbeTrack> = world
            .query::<(Entity, &Label, &Probe)>()
            .iter(world)
            .map(|(entity, label, probe)| {
                let track = Track::new(probe.every).with_turn(turn_of(&probe.what));
                ProbeTrack { entity, name: label.0.clone(), track }
            })
            .collect();
        probes.sort_by(|a, b| a.name.cmp(&b.name));
        self.probes = probes;
    }

    fn tracks(&self) -> impl Iterator<Item = &Track> {
        self.probes.iter().map(|probe| &probe.track).chain(&self.energy)
    }

    fn cadences(&mut self) -> impl Iterator<Item = &mut Cadence> {
        let tracks = self.probes.iter_mut().map(|probe| &mut probe.track).chain(&mut self.energy);
        tracks.map(|track| &mut track.every).chain(&mut self.snapshots).chain([&mut self.fields])
    }

    /// Will go on with steps of another length (s) from here; the run ends with `last_step`. The clock and the columns
    /// are still those of the last step.
    ///
    /// # Errors
    /// What the GPU says; that what is observed is not finite.
    pub fn change_step(&mut self, world: &mut World, time_step: f64, last_step: u64) -> Result<(), Error> {
        let step = world.resource::<Clock>().step;
        self.cadences().for_each(|cadence| cadence.change_step(step, time_step));
        self.last_step = last_step;
        // a longer step may go beyond a time that is asked for
        self.keep_what_precedes(world)
    }

    /// Goes on at the clock's time, wherever steps had another length before.
    ///
    /// # Errors
    /// What the GPU says; that what is observed is not finite.
    pub fn go_on(&mut self, world: &mut World, last_step: u64) -> Result<(), Error> {
        let clock = *world.resource::<Clock>();
        self.cadences().for_each(|cadence| cadence.go_on(clock.since, clock.time_step));
        self.probes.iter_mut().map(|probe| &mut probe.track).chain(&mut self.energy).for_each(Track::forget);
        self.last_step = last_step;
        self.checks_again = world.get_resource::<GuardMemory>().and_then(GuardMemory::checks_again);
        // rows within the next step are as they would have been
        self.keep_what_precedes(world)
    }

    /// Writes all that is observed from now on into a folder.
    ///
    /// # Errors
    /// Files that cannot be created.
    pub fn write_into(&mut self, folder: &mut Folder, world: &World) -> Result<(), OutputError> {
        let series = Series::create(folder)?;
        let energies = match self.energy {
            None => None,
            Some(_) => Some(Table::create(
                &folder.claim("energy.csv")?,
                &Heading::texts(&energy_header(
                    self.to_rest,
                    world.resource::<Clock>().velocities_at_ends,
                    self.touches,
                )),
            )?),
        };
        let mut probes = BTreeMap::new();
        for ProbeTrack { entity, name, .. } in &self.probes {
            let Some(probe) = world.get::<Probe>(*entity) else { continue };
            let path = folder.claim(&format!("probe_{name}.csv"))?;
            probes.insert(name.clone(), Table::create(&path, &Heading::texts(&header(&probe.what)))?);
        }
        let convergence = match world.resource::<Clock>().relaxation {
            None => None,
            Some(_) => Some(Table::create(&folder.claim("convergence.csv")?, &CONVERGENCE)?),
        };
        let path = match self.follows_path {
            false => None,
            true => Some(Table::create(&folder.claim("path.csv")?, &self.path_header(world))?),
        };
        let mut skins = Vec::new();
        for (body, name) in skins::with_skins(world) {
            let name = format!("skin_{name}");
            folder.claim(&format!("{name}.pvd"))?;
            skins.push((body, Series::named(folder.path(), &name)?));
        }
        let (folder, _lock) = (folder.path().to_path_buf(), folder.lock());
        self.files = Some(Files { folder, _lock, series, energies, probes, convergence, path, skins });
        Ok(())
    }

    /// The next step, after `step`, at whose end something is due: at powers of two how large energies are, for what
    /// begins suddenly has come and gone before the first check.
    pub fn next_due(&self, step: u64) -> u64 {
        let flags = if self.all_on_device { DEVICE_GUARD_STEPS } else { HOST_GUARD_STEPS };
        let mut due = (step / flags + 1) * flags;
        if !self.to_rest {
            due = due.min((step / self.guard_settings.limits.every + 1) * self.guard_settings.limits.every);
            due = due.min((step + 1).next_power_of_two());
            due = self.checks_again.filter(|&again| again > step).map_or(due, |again| due.min(again));
        }
        if !self.to_rest {
            let files = self.snapshots.iter().chain([&self.fields]).map(|cadence| cadence.next_after(step));
            due = self.tracks().map(|track| track.next_sample(step)).chain(files).fold(due, u64::min);
        }
        if step < self.last_step { due.min(self.last_step) } else { due }
    }

    /// The folder for the snapshot that is due at a step, if one is: in each interval, and at the end.
    pub fn snapshot_folder(&self, step: u64) -> Option<&Path> {
        let due = self.snapshots?.is_due(step) || step == self.last_step;
        self.files.as_ref().filter(|_| due && step > 0).map(|files| files.folder.as_path())
    }

    /// What the guards find at the present step.
    ///
    /// # Errors
    /// What the GPU says.
    pub fn trouble(&self, world: &mut World) -> Result<Option<Instability>, Error> {
        guards::find(world, self.good_until, &self.guard_settings)
    }

    /// Whether a state is to be kept after the present step, because it has just passed all guards and may be the last.
    /// Bringing it from a GPU takes time: there it is done in every sixteenth check.
    pub fn keeps_state(&self, step: u64) -> bool {
        let checks = step / self.guard_settings.limits.every.max(1);
        let wanted = self.guard_settings.limits.window > 0 && self.files.is_some() && self.checked_at == Some(step);
        wanted && !self.to_rest && (!self.on_gpu || checks.is_multiple_of(16))
    }

    /// Keeps a state, and lets go of the oldest.
    pub fn keep_state(&mut self, state: Snapshot) {
        self.window.push_back(state);
        while self.window.len() as u64 > self.guard_settings.limits.window {
            self.window.pop_front();
        }
    }

    /// The folder that is written into, if one is.
    pub fn folder(&self) -> Option<&Path> {
        self.files.as_ref().map(|files| files.folder.as_path())
    }

    /// Notes how a static analysis converges: what the columns of `convergence.csv` hold.
    ///
    /// # Errors
    /// Files that cannot be written.
    pub fn note_convergence(&mut self, row: [f64; 5]) -> Result<(), Error> {
        if let Some(table) = self.files.as_mut().and_then(|files| files.convergence.as_mut()) {
            table.row(&row)?;
        }
        Ok(())
    }

    /// Observes what is due at the present step.
    ///
    /// # Errors
    /// That the simulation broke down, or that files cannot be written.
    pub fn observe(&mut self, world: &mut World) -> Result<(), Error> {
        let clock = *world.resource::<Clock>();
        let (last, to_rest) = (clock.step == self.last_step, self.to_rest);
        match guards::find(world, self.good_until, &self.guard_settings)? {
            None => {}
            // the steps since the last check of the residual will be taken back
            Some(_) if clock.relaxation.is_some() => return Ok(()),
            Some(found) => return Err(Error::Unstable(Box::new(found))),
        }
        let due = |cadence: Cadence| !to_rest && cadence.is_due(clock.step);
        let shown = last || self.files.is_some() && (due(self.fields) || self.snapshots.is_some_and(due));
        if shown && let Some(found) = guards::find_in_result(world, self.good_until, &self.guard_settings)? {
            return Err(Error::Unstable(Box::new(found)));
        }
        let regular = clock.step.is_multiple_of(self.guard_settings.limits.every.max(1));
        if (regular || last || self.checks_again == Some(clock.step)) && clock.step > 0 && !to_rest {
            let passed = guards::check_balance(world, self.good_until, &self.guard_settings, last)?;
            self.checks_again = world.get_resource::<GuardMemory>().and_then(GuardMemory::checks_again);
            self.checked_at = if passed { Some(clock.step) } else { self.checked_at };
        } else if clock.step.is_power_of_two() && !to_rest {
            guards::look(world)?;
        }
        let moment = match to_rest {
            false => Moment::Step(clock.step, last),
            true if last || clock.step == 0 => Moment::Rest,
            true => {
                // steps on the way are no times of the scene
                self.good_until = clock.time();
                return Ok(());
            }
        };
        self.observe_at(moment, world)
    }

    /// Observes what is due at the present time of a static analysis whose loads still grow.
    ///
    /// # Errors
    /// Files that cannot be written.
    pub fn observe_on_the_way(&mut self, world: &mut World) -> Result<(), Error> {
        let clock = *world.resource::<Clock>();
        let (before, now) = (self.on_the_way, clock.time() / clock.time_step);
        self.on_the_way = now.max(before);
        self.observe_at(Moment::OnTheWay(before, now), world)
    }

    /// Refuses results that are not finite.
    fn finite(
        &self,
        world: &mut World,
        mut values: impl Iterator<Item = f64>,
        what: impl Fn() -> String,
    ) -> Result<(), Error> {
        let Some(value) = values.find(|value| !value.is_finite()) else { return Ok(()) };
        Err(self.refused(world, "", format!("{} would be {value}", what()), Criterion::of("result")))
    }

    /// That an implicit step was not found; `rubs`: where something touched with friction.
    pub fn unsolved(&self, world: &World, (found, rubs): (String, bool), criterion: Criterion) -> Error {
        let cause = if rubs {
            "a step too long for how bodies move (smaller `step` of `solver`, or `adaptive` ones, which become shorter where \
             one is not found), springs of contact that stick and slide by turns (a smaller `share`, less `friction`, or \
             such steps), a load or motion too large for the mesh, or bodies that give way: buckling, a law that softens"
        } else {
            "a step too long for how bodies move (smaller `step` of `solver`, or `adaptive` ones, which become shorter where \
             one is not found), a load or motion too large for the mesh, or bodies that give way: buckling, a law that \
             softens"
        };
        let nowhere = String::new();
        let broken =
            guards::instability(world, &self.guard_settings, nowhere, found, cause, criterion, self.good_until);
        Error::Unstable(Box::new(broken))
    }

    /// That a result of a body, or of all, cannot be handed out because it is not finite.
    pub fn refused(&self, world: &World, body: &str, found: String, criterion: Criterion) -> Error {
        let cause = "numbers beyond what can be expressed: loads, moduli or motions too large, or a system of one's own that \
                     writes what is no number";
        let broken =
            guards::instability(world, &self.guard_settings, body.into(), found, cause, criterion, self.good_until);
        Error::Unstable(Box::new(broken))
    }
}
