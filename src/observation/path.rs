//! Paths of equilibria: `path.csv`, a row a point.

use super::Observer;
use super::heading::Heading;
use super::probes::{header, observe_probe};
use crate::components::Probe;
use crate::error::Error;
use crate::scene::schema::Quantity;
use bevy_ecs::prelude::*;

/// The columns before those of probes.
pub const PATH: [(&str, &str); 5] =
    [("point", "1"), ("load factor", "1"), ("length", "m"), ("iterations", "1"), ("unstable", "1")];

/// The columns of a probe, without the time.
pub fn columns_of_probe(probe: &Quantity) -> Vec<Heading> {
    header(probe).split_off(1)
}

impl Observer {
    /// The columns of `path.csv`.
    pub(super) fn path_header(&self, world: &World) -> Vec<String> {
        let of_probes = self.probes.iter().filter_map(|of| Some((&of.name, world.get::<Probe>(of.entity)?)));
        let of_probes = of_probes.flat_map(|(name, probe)| {
            columns_of_probe(&probe.what).into_iter().map(move |column| format!("{name}: {column}"))
        });
        Heading::texts(&Heading::all(&PATH)).into_iter().chain(of_probes).collect()
    }

    /// Notes a point of a path where bodies are: what the first columns of `path.csv` hold.
    ///
    /// # Errors
    /// What the GPU says; files that cannot be written.
    pub fn note_path(&mut self, world: &mut World, point: [f64; PATH.len()]) -> Result<(), Error> {
        let Some(table) = self.files.as_mut().and_then(|files| files.path.as_mut()) else { return Ok(()) };
        let mut row = point.to_vec();
        for probe in &self.probes {
            row.extend(observe_probe(world, probe.entity)?);
        }
        table.row(&row)?;
        Ok(())
    }
}
