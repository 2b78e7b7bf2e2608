//! Looking at a run: probes, energies, fields and guards, when they are due. Reads only.

mod energies;
mod fields;
mod guards;
mod probes;

pub use energies::{energies, mass};
pub use fields::{BodyFields, body_fields, internal_forces};
pub use probes::{header, observe_probe};

use crate::components::*;
use crate::error::Error;
use crate::output::{Folder, OutputError, Series, Table};
use bevy_ecs::prelude::*;
use std::collections::BTreeMap;

/// Steps between two looks at the guards, at most.
pub const GUARD_STEPS: u64 = 256;

/// What is observed when, and where it goes. A resource; the system `observe` runs it.
#[derive(Resource, Default)]
pub struct Observer {
    /// Steps between frames of fields; 0: none.
    pub fields_every: u64,
    /// Steps between rows of energies; 0: none.
    pub energies_every: u64,
    /// Whether the guards look at the balance of energy: when a step beyond the stable one is allowed.
    pub watch_energy: bool,
    /// The last step of the run, which is always observed.
    pub last_step: u64,
    files: Option<Files>,
    probes: Vec<(Entity, String, u64)>,
    /// What each probe saw last: time (s) and values.
    pub latest: BTreeMap<String, (f64, Vec<f64>)>,
    /// The energies as they were observed last.
    pub energies: Option<Energies>,
    /// Time up to which all was well (s).
    pub good_until: f64,
}

struct Files {
    series: Series,
    energies: Option<Table>,
    probes: BTreeMap<String, Table>,
}

impl Observer {
    /// Observes the probes of a world.
    pub fn watch_probes(&mut self, world: &mut World) {
        let mut probes: Vec<(Entity, String, u64)> = world
            .query::<(Entity, &Label, &Probe)>()
            .iter(world)
            .map(|(entity, label, probe)| (entity, label.0.clone(), probe.every))
            .collect();
        probes.sort_by(|a, b| a.1.cmp(&b.1));
        self.probes = probes;
    }

    /// Writes all that is observed from now on into a folder.
    ///
    /// # Errors
    /// Files that cannot be created.
    pub fn write_into(&mut self, folder: &mut Folder, world: &World) -> Result<(), OutputError> {
        let series = Series::create(folder)?;
        let energies = match self.energies_every {
            0 => None,
            _ => Some(Table::create(&folder.claim("energy.csv")?, &energies::HEADER)?),
        };
        let mut probes = BTreeMap::new();
        for (entity, name, _) in &self.probes {
            let Some(probe) = world.get::<Probe>(*entity) else { continue };
            let path = folder.claim(&format!("probe_{name}.csv"))?;
            probes.insert(name.clone(), Table::create(&path, &header(probe.what))?);
        }
        self.files = Some(Files { series, energies, probes });
        Ok(())
    }

    /// The next step, after `step`, at whose end something is due.
    pub fn next_due(&self, step: u64) -> u64 {
        let next = |every: u64| step.checked_div(every).map_or(u64::MAX, |whole| (whole + 1) * every);
        let mut due = next(GUARD_STEPS).min(next(self.fields_every)).min(next(self.energies_every));
        for (_, _, every) in &self.probes {
            due = due.min(next(*every));
        }
        if step < self.last_step { due.min(self.last_step) } else { due }
    }

    /// Observes what is due at the present step.
    ///
    /// # Errors
    /// That the simulation broke down, or that files cannot be written.
    pub fn observe(&mut self, world: &mut World) -> Result<(), Error> {
        let clock = *world.resource::<Clock>();
        let last = clock.step == self.last_step;
        let due = |every: u64| every != 0 && (clock.step.is_multiple_of(every) || last);
        guards::check(world, self.good_until, self.watch_energy)?;
        if self.watch_energy {
            guards::check_energy(world, self.good_until)?;
        }
        let probes: Vec<(Entity, String)> = self
            .probes
            .iter()
            .filter(|(_, _, every)| due(*every))
            .map(|(entity, name, _)| (*entity, name.clone()))
            .collect();
        for (entity, name) in probes {
            let values = observe_probe(world, entity)?;
            if let Some(table) = self.files.as_mut().and_then(|files| files.probes.get_mut(&name)) {
                let mut row = vec![clock.time()];
                row.extend(&values);
                table.row(&row)?;
            }
            self.latest.insert(name, (clock.time(), values));
        }
        if due(self.energies_every) {
            let energies = energies(world)?;
            if let Some(table) = self.files.as_mut().and_then(|files| files.energies.as_mut()) {
                table.row(&energies::row(clock.time(), &energies))?;
            }
            self.energies = Some(energies);
        }
        if due(self.fields_every)
            && let Some(files) = &mut self.files
        {
            fields::write(world, &mut files.series)?;
        }
        self.good_until = clock.time();
        Ok(())
    }
}
