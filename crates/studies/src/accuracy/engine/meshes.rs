//! The meshes that a scene can have.

use super::Engine;
use super::curvature;
use super::variant::{Finer, cells, divides, finer, variant};
use crate::accuracy::advice::percent;
use crate::accuracy::configuration::{Configuration, Factor, Processor};
use crate::accuracy::solver::Refusal;
use sinew::Simulation;
use sinew::assembly::mesh_of;

/// How fine meshes can be against the scene's: each has twice the cells of the one before.
const MESHES: [Factor; 6] =
    [Factor::new(1, 4), Factor::new(1, 2), Factor::ONE, Factor::new(2, 1), Factor::new(4, 1), Factor::new(8, 1)];

impl Engine<'_> {
    /// How fine meshes can be: coarser ones have all nodes that the scene speaks of.
    pub(super) fn sound_meshes(&mut self) -> Result<Vec<Factor>, Refusal> {
        if let Some(known) = &self.meshes {
            return Ok(known.clone());
        }
        let scene = &self.file.scene;
        let fits = |factor: &Factor| match finer(scene) {
            Finer::Cut => factor.down == 1 && factor.up.is_power_of_two(),
            Finer::Cells => scene.bodies.values().all(|body| divides(&body.mesh, *factor)),
        };
        let own = self.base(self.kinds.as_deref().unwrap_or_default());
        let mut meshes = Vec::new();
        for mesh in MESHES.into_iter().filter(|factor| factor.value() <= self.finest && fits(factor)) {
            self.check_time()?;
            let kind = Configuration { mesh, place: Processor::Cpu, ..own.clone() };
            let sound = || Simulation::new(&variant(self.file, &kind, None), &self.options(&kind)).is_ok();
            if mesh >= Factor::ONE || sound() {
                meshes.push(mesh);
            }
        }
        self.meshes = Some(meshes.clone());
        Ok(meshes)
    }

    /// Those of the meshes that have a single layer of cells where the scene's own has more.
    pub(super) fn single_layers(&self) -> Vec<Factor> {
        let counts: Vec<u32> = self.file.scene.bodies.values().flat_map(|body| cells(&body.mesh)).collect();
        let single = |factor: &Factor| counts.iter().any(|&count| count > 1 && factor.times(count) == Some(1));
        let meshes = self.meshes.iter().flatten().copied();
        meshes.filter(|factor| *factor < Factor::ONE && single(factor)).collect()
    }

    /// What finer meshes do not show: elements are cut, and the surface stays the polyhedron it is.
    pub(super) fn unseen(&self) -> Result<Vec<String>, Refusal> {
        let scene = &self.file.scene;
        if finer(scene) != Finer::Cut {
            return Ok(Vec::new());
        }
        let mut unseen = Vec::new();
        for (name, body) in &scene.bodies {
            let mesh = mesh_of(body, self.file).map_err(|error| Refusal::Refused(error.to_string()))?;
            if let Some(share) = curvature::left_out(&mesh) {
                unseen.push(format!(
                    "this is the error against a body with the flat faces of {name}'s mesh: finer meshes cut its elements and \
                     keep its surface. If that stands for a curved one, faces and surface hold about {} of the volume between \
                     them, and what that changes is not seen here: a finer mesh from where this one was made would show it",
                    percent(share)
                ));
            }
        }
        Ok(unseen)
    }
}
