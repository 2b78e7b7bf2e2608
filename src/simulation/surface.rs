//! The surface of a body, for programs that draw it.

use super::Simulation;
use crate::components::*;
use crate::error::Error;
use crate::mesh::SurfaceFace;
use bevy_ecs::prelude::*;

impl Simulation {
    /// Triangles of a body's surface: places in [`displacements`](Simulation::displacements) and
    /// [`rest_positions`](Simulation::rest_positions), counter-clockwise seen from outside. A quadrilateral is two of
    /// them; faces that removed elements lay bare count. They change only when [`elements_left`](Self::elements_left)
    /// or [`times_restored`](Self::times_restored) does.
    ///
    /// # Errors
    /// No such body; what the GPU says.
    pub fn surface_triangles(&mut self, body: &str) -> Result<Vec<[u32; 3]>, Error> {
        let body = self.body(body)?;
        crate::backend::device::bring_to_host(&mut self.world, |_, name| name == Alive::NAME)?;
        Ok(self.surface_faces(body).iter().flat_map(SurfaceFace::triangles).collect())
    }

    /// Elements of a body that have not been removed.
    ///
    /// # Errors
    /// No such body; what the GPU says.
    pub fn elements_left(&mut self, body: &str) -> Result<usize, Error> {
        let body = self.body(body)?;
        crate::backend::device::bring_to_host(&mut self.world, |_, name| name == Alive::NAME)?;
        let Some(authoring) = self.world.get::<Authoring>(body) else { return Ok(0) };
        let alive = |&&(block, row): &&(u32, u32)| {
            let alive = self.world.get::<Alive>(authoring.blocks[block as usize]);
            alive.is_none_or(|alive| alive[row as usize] == 1)
        };
        Ok(authoring.element_rows.iter().filter(alive).count())
    }

    /// Faces of a body's surface, by places in the author's order; elements are what is known of on the host.
    pub(super) fn surface_faces(&self, body: Entity) -> Vec<SurfaceFace> {
        let Some(authoring) = self.world.get::<Authoring>(body) else { return Vec::new() };
        let alive = |block: u32, row: u32| {
            let alive = self.world.get::<Alive>(authoring.blocks[block as usize]);
            alive.is_none_or(|alive| alive[row as usize] == 1)
        };
        authoring.surface(alive)
    }
}
