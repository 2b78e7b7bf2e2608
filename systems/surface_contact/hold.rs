//! What closed tools hold: it goes where they take it, whatever pushes, so that the other side takes all of a
//! correction.

use super::body_slices::BodySlices;
use super::gather::Gathered;
use super::{ForeseenNodes, Surface};
use crate::backend::Buffers;
use crate::backend::cpu::IntegrationCoefficients;
use crate::backend::kernel::{Fragment, Kernel};
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
        let Self { set, slots, .. } = self;
        for (body, of_body) in (0..).zip(bodies) {
            let Some(grip) = &of_body.grip else { continue };
            // the place in the set, where it is near something
            let slot_of = |row: u32| {
                let node = surface.nodes.binary_search(&(body, row)).ok()?;
                let slot = slots[node] as usize;
                (surface.near.nodes.get(slot) == Some(&(node as u32))).then_some(slot)
            };
            grip.each_held(of_body, (coefficients, signals), slot_of, |slot, step| {
                (set.steps[slot], set.responses[slot]) = (step.extend(0.0), DVec4::ZERO);
            });
        }
    }
}

impl ForeseenNodes {
    /// The kernel that holds what closed tools hold of a body, after [`foresee`](Self::foresee); none where tools hold
    /// nothing of what is foreseen: what `number_of` has a number for, by rows.
    pub fn hold(
        &self,
        label: &str,
        body: Entity,
        number_of: impl Fn(u32) -> Option<u32>,
        world: &World,
        buffers: &mut dyn Buffers,
    ) -> Option<Kernel> {
        let (grasps, rest) = (world.get::<Grasps>(body)?, world.get::<RestPosition>(body)?);
        let words = |(place, &row): (usize, &u32)| {
            let [x, y, z] = (rest.0[row as usize] - grasps.reference).as_vec3().to_array().map(f32::to_bits);
            Some([number_of(row)?, row, place as u32, grasps.masks[place], x, y, z])
        };
        let holdable: Vec<[u32; 7]> = grasps.rows.iter().enumerate().filter_map(words).collect();
        if holdable.is_empty() {
            return None;
        }
        let slots = |grasp: &Grasp| [grasp.closed as u32, grasp.tool.signal as u32];
        let holds: Vec<[u32; 2]> = grasps.grasps.iter().map(slots).collect();
        let count = holdable.len();
        let counts = [("GRASPS", grasps.grasps.len()), ("NUMBERS", grasps.numbers_a_grasp()), ("HOLDABLE", count)];
        let counts = counts.map(|(name, count)| format!("const {name}: u32 = {count}u;\n")).concat();
        let kernel = Kernel::new(label, "surface_contact_hold")
            .fragment(shader!("surface_contact_hold"))
            .fragment(Fragment::new("generated: how many tools hold how much", counts))
            .fragment(shader!("row"))
            .bind("holds", buffers.constants("what may hold nodes".into(), bytemuck::cast_slice(&holds)))
            .bind("holdable", buffers.constants("nodes that may be held".into(), bytemuck::cast_slice(&holdable)))
            .bind("surface_nodes", self.nodes)
            .bind(ToolHold::NAME, buffers.column(body, ToolHold::NAME))
            .bind(Displacement::NAME, buffers.column(body, Displacement::NAME))
            .threads(count as u32);
        Some(with_step(kernel, world))
    }
}
