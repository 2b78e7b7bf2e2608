//! What closed tools hold: it goes where they take it, whatever pushes, so that the other side takes all of a
//! correction.

use super::body_slices::{BodySlices, vector};
use super::gather::Gathered;
use super::{Surface, SurfaceContacts};
use crate::backend::Buffers;
use crate::backend::cpu::IntegrationCoefficients;
use crate::backend::kernel::{BufferId, Fragment, Kernel, Uniform, uniform};
use crate::backend::step::with_step;
use crate::components::*;
use crate::math::Scalar;
use crate::shader;
use bevy_ecs::prelude::*;
use glam::DVec4;

impl Gathered {
    /// Holds what closed tools hold, of nodes that are foreseen.
    pub fn hold<T: Scalar>(
        &mut self,
        surface: &Surface,
        (coefficients, signals): (&IntegrationCoefficients<f64>, &Signals),
        bodies: &[BodySlices<'_, T>],
    ) {
        for (body, of_body) in (0..).zip(bodies) {
            let Some(grip) = &of_body.grip else { continue };
            for (node, &row) in grip.grasps.rows.iter().enumerate() {
                let Some(slot) = self.slot_of(surface, (body, row)) else { continue };
                let row = row as usize;
                let place = of_body.rest[row] - grip.grasps.reference + vector(of_body.u, row);
                let foreseen = of_body.foresee(row, coefficients);
                if let Some(step) = grip.step_of(signals.values(), node, place, &foreseen) {
                    (self.set.steps[slot], self.set.responses[slot]) = (step.extend(0.0), DVec4::ZERO);
                }
            }
        }
    }

    /// The place in the set of a node of such a body and row, where it is near something.
    fn slot_of(&self, surface: &Surface, node: (u32, u32)) -> Option<usize> {
        let node = surface.nodes.binary_search(&node).ok()?;
        let slot = self.slots[node] as usize;
        (surface.near.nodes.get(slot) == Some(&(node as u32))).then_some(slot)
    }
}

/// A tool that may hold nodes, as the kernel sees it.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
struct HoldRow {
    closed: u32,
    signal: u32,
    unused: u32,
    unused_too: u32,
}
uniform!(HoldRow { closed, signal, unused, unused_too });

/// The kernel for a body, after where its nodes would go is known; none where tools hold nothing of its surface.
pub(super) fn kernel(
    contacts: &SurfaceContacts,
    body: usize,
    nodes: BufferId,
    world: &World,
    buffers: &mut dyn Buffers,
) -> Option<Kernel> {
    let entity = contacts.bodies[body];
    let (grasps, rest) = (world.get::<Grasps>(entity)?, world.get::<RestPosition>(entity)?);
    let words = |(place, &row): (usize, &u32)| {
        let node = contacts.surface.nodes.binary_search(&(body as u32, row)).ok()? as u32;
        let [x, y, z] = (rest.0[row as usize] - grasps.reference).as_vec3().to_array().map(f32::to_bits);
        Some([node, row, place as u32, grasps.masks[place], x, y, z])
    };
    let holdable: Vec<[u32; 7]> = grasps.rows.iter().enumerate().filter_map(words).collect();
    if holdable.is_empty() {
        return None;
    }
    let row = |grasp: &Grasp| HoldRow {
        closed: grasp.closed as u32,
        signal: grasp.tool.signal as u32,
        unused: 0,
        unused_too: 0,
    };
    let holds: Vec<u8> = grasps.grasps.iter().flat_map(|grasp| row(grasp).bytes()).collect();
    let counts = [("GRASPS", grasps.grasps.len()), ("NUMBERS", grasps.numbers_a_grasp()), ("HOLDABLE", holdable.len())];
    let counts = counts.map(|(name, count)| format!("const {name}: u32 = {count}u;\n")).concat();
    let kernel = Kernel::new("surface_contact_hold", "surface_contact_hold")
        .fragment(shader!("surface_contact_hold"))
        .fragment(Fragment::new("generated: how many tools hold how much", counts))
        .fragment(shader!("row"))
        .bind_uniform::<HoldRow>("holds", buffers.uniform("what may hold a surface".into(), &holds))
        .bind("holdable", buffers.constants("what may be held of a surface".into(), bytemuck::cast_slice(&holdable)))
        .bind("surface_nodes", nodes)
        .bind(ToolHold::NAME, buffers.column(entity, ToolHold::NAME))
        .bind(Displacement::NAME, buffers.column(entity, Displacement::NAME))
        .threads(holdable.len() as u32);
    Some(with_step(kernel, world))
}
