//! What is due at a moment goes into tables and frames.

use super::probes::{keep_peaks, with_peaks};
use super::track::{Moment, Row};
use super::{Observer, ProbeTrack, energies, observe_probe, overlaps, skins, write_fields, write_whole};
use crate::components::Clock;
use crate::error::Error;
use crate::output::WHOLE;
use bevy_ecs::prelude::*;
use web_time::Instant;

impl Observer {
    /// Observes all that is due. The guards have looked before: a GPU has nothing left to do, and what this takes is
    /// its own.
    pub(super) fn observe_at(&mut self, moment: Moment, world: &mut World) -> Result<(), Error> {
        let started = Instant::now();
        let observed = self.observe_all(moment, world);
        self.writing += started.elapsed();
        observed
    }

    fn observe_all(&mut self, moment: Moment, world: &mut World) -> Result<(), Error> {
        let clock = *world.resource::<Clock>();
        for place in 0..self.probes.len() {
            if moment.observes(&self.probes[place].track) {
                let row = self.probe_row(place, world)?;
                let ProbeTrack { entity, track, .. } = &self.probes[place];
                let (entity, is_on_time, rows) = (*entity, moment.is_on_time(track), moment.rows(track, &row));
                for (time, values) in rows {
                    let values = with_peaks(world, entity, values);
                    if is_on_time {
                        keep_peaks(world, entity, &values);
                    }
                    self.write_probe(place, (time, values))?;
                }
                self.probes[place].track.keep(clock.step, row);
            }
        }
        if self.energy.as_ref().is_some_and(|track| moment.observes(track)) {
            let row = self.energy_row(world)?;
            let rows = self.energy.as_ref().map(|track| moment.rows(track, &row)).unwrap_or_default();
            if let Some(table) = self.files.as_mut().and_then(|files| files.energies.as_mut()) {
                rows.iter().try_for_each(|row| table.row(&with_time(row)))?;
            }
            if let Some(track) = &mut self.energy {
                track.keep(clock.step, row);
            }
        }
        if moment.is_due(&self.fields)
            && let Some(files) = &self.files
            && files.series.frame_count() == 0
        {
            write_whole(world, &files.folder.join(WHOLE))?;
        }
        if moment.is_due(&self.fields)
            && let Some(files) = &mut self.files
            && let Some(what) = write_fields(world, &mut files.series)?
        {
            self.finite(world, [f64::NAN].into_iter(), || what.clone())?;
        }
        if moment.is_due(&self.fields)
            && let Some(files) = &mut self.files
        {
            files.skins.iter_mut().try_for_each(|(body, series)| skins::write(world, *body, series))?;
        }
        if moment.is_due(&self.fields) && (self.files.is_some() || clock.step == 0) {
            overlaps::check(world)?;
        }
        self.good_until = clock.time();
        Ok(())
    }

    /// Observes what the next step goes on from, where it is needed for times within it.
    pub(super) fn keep_what_precedes(&mut self, world: &mut World) -> Result<(), Error> {
        let step = world.resource::<Clock>().step;
        for place in 0..self.probes.len() {
            if self.probes[place].track.precedes(step) {
                let row = self.probe_row(place, world)?;
                self.probes[place].track.keep(step, row);
            }
        }
        if self.energy.as_ref().is_some_and(|track| track.precedes(step)) {
            let row = self.energy_row(world)?;
            if let Some(track) = &mut self.energy {
                track.keep(step, row);
            }
        }
        Ok(())
    }

    /// What a probe sees now.
    fn probe_row(&self, place: usize, world: &mut World) -> Result<Row, Error> {
        let probe = &self.probes[place];
        let values = observe_probe(world, probe.entity)?;
        self.finite(world, values.iter().copied(), || format!("the probe {}", probe.name))?;
        Ok((world.resource::<Clock>().time(), values))
    }

    fn write_probe(&mut self, place: usize, row: Row) -> Result<(), Error> {
        let name = &self.probes[place].name;
        if let Some(table) = self.files.as_mut().and_then(|files| files.probes.get_mut(name)) {
            table.row(&with_time(&row))?;
        }
        self.latest.insert(name.clone(), row);
        Ok(())
    }

    /// The energies now.
    fn energy_row(&self, world: &mut World) -> Result<Row, Error> {
        let values = energies::values(&energies(world)?, self.touches);
        self.finite(world, values.iter().copied(), || "the energies".into())?;
        Ok((world.resource::<Clock>().time(), values))
    }
}

fn with_time((time, values): &Row) -> Vec<f64> {
    [&[*time], &values[..]].concat()
}
