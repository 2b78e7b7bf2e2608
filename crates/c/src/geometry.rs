//! What a program draws: places of nodes, normals, triangles.

use crate::handle::{SinewSimulation, State, with};
use crate::memory::{fill, put, text};
use crate::status::{Outcome, SinewStatus, entry};
use glam::DVec3;
use std::ffi::c_char;

impl State {
    /// Normals at nodes: the mean of those of their triangles by area; 0 where a node is in none.
    fn normals(&mut self, body: &str) -> Outcome<Vec<DVec3>> {
        let places = self.simulation.positions(body)?;
        Ok(sinew::skins::normals(&places, &self.simulation.surface_triangles(body)?))
    }

    fn generation(&mut self, body: &str) -> Outcome<u64> {
        let now = self.simulation.elements_left(body)?;
        let (left, generation) = self.generations.entry(body.to_string()).or_insert((Some(now), 0));
        if *left != Some(now) {
            (*left, *generation) = (Some(now), *generation + 1);
        }
        Ok(*generation)
    }
}

/// Vectors as numbers of 32 bits, three each.
pub(crate) fn numbers(vectors: &[DVec3]) -> Vec<f32> {
    vectors.iter().flat_map(|vector| vector.as_vec3().to_array()).collect()
}

/// How many nodes a body has. It stays the same, also when elements are removed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_node_count(
    simulation: *const SinewSimulation,
    body: *const c_char,
    count: *mut usize,
) -> SinewStatus {
    // SAFETY: as the header asks of callers
    entry(|| unsafe {
        let body = text(body, "body")?;
        let nodes = with(simulation, |state, _| Ok(state.simulation.rest_positions(body)?.len()))?;
        put(count, nodes, "count")
    })
}

/// Where a body's nodes are (m): x, y, z of each, in the author's order.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_positions(
    simulation: *mut SinewSimulation,
    body: *const c_char,
    buffer: *mut f32,
    capacity: usize,
    count: *mut usize,
) -> SinewStatus {
    // SAFETY: as the header asks of callers
    entry(|| unsafe {
        let body = text(body, "body")?;
        fill(&numbers(&with(simulation, |state, _| Ok(state.simulation.positions(body)?))?), buffer, capacity, count)
    })
}

/// Outward normals of the surface at a body's nodes, of length 1: x, y, z of each; 0, 0, 0 at those within.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_normals(
    simulation: *mut SinewSimulation,
    body: *const c_char,
    buffer: *mut f32,
    capacity: usize,
    count: *mut usize,
) -> SinewStatus {
    // SAFETY: as the header asks of callers
    entry(|| unsafe {
        let body = text(body, "body")?;
        fill(&numbers(&with(simulation, |state, _| state.normals(body))?), buffer, capacity, count)
    })
}

/// Triangles of a body's surface: three places of nodes each, counter-clockwise seen from outside. They change only
/// when `sinew_topology_generation` does.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_triangles(
    simulation: *mut SinewSimulation,
    body: *const c_char,
    buffer: *mut u32,
    capacity: usize,
    count: *mut usize,
) -> SinewStatus {
    // SAFETY: as the header asks of callers
    entry(|| unsafe {
        let body = text(body, "body")?;
        let triangles = with(simulation, |state, _| Ok(state.simulation.surface_triangles(body)?))?;
        fill(triangles.as_flattened(), buffer, capacity, count)
    })
}

/// A number that is another one than the last that was asked for whenever elements of the body have been removed since,
/// or have come back.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_topology_generation(
    simulation: *mut SinewSimulation,
    body: *const c_char,
    generation: *mut u64,
) -> SinewStatus {
    // SAFETY: as the header asks of callers
    entry(|| unsafe {
        let body = text(body, "body")?;
        put(generation, with(simulation, |state, _| state.generation(body))?, "generation")
    })
}
