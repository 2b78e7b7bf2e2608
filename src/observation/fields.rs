//! Fields of a body in the author's order, evaluated on the host in f64.

use crate::backend::cpu::{Cpu, ROWS_A_TASK};
use crate::backend::device::bring_to_host;
use crate::components::*;
use crate::elements::{MOST_NODES, node_count};
use crate::error::Error;
use crate::evaluation::BlockView;
use bevy_ecs::prelude::*;
use glam::DVec3;

/// Fields of one body: nodes and elements in the author's order (tetrahedra, then hexahedra).
#[derive(Clone, Debug, Default)]
pub struct BodyFields {
    /// Displacement of each node (m).
    pub displacement: Vec<DVec3>,
    /// Velocity of each node in the middle of the last step (m/s).
    pub velocity: Vec<DVec3>,
    /// Volume ratio J of each element.
    pub volume_ratio: Vec<f64>,
    /// Cauchy stress of each element (Pa): xx, yy, zz, xy, yz, xz. Zero once removed.
    pub stress: Vec<[f64; 6]>,
    /// 1 while an element is there.
    pub alive: Vec<u8>,
}

const COLUMNS: [&str; 5] =
    [Displacement::NAME, DisplacementIncrement::NAME, RestShape::NAME, ViscousMemory::NAME, Alive::NAME];

/// What an element contributes: J, Cauchy stress, whether it is there, nodal forces.
type ElementRow = (f64, [f64; 6], u8, [[f64; 3]; MOST_NODES]);

/// The fields of a body at the present step.
///
/// # Errors
/// What the GPU says.
pub fn body_fields(world: &mut World, body: Entity) -> Result<BodyFields, Error> {
    bring_to_host(world, |_, name| COLUMNS.contains(&name))?;
    let rate = world.resource::<Clock>().rate();
    let mut fields = BodyFields::default();
    let Some(authoring) = world.get::<Authoring>(body) else { return Ok(fields) };
    if let (Some(u), Some(step)) = (world.get::<Displacement>(body), world.get::<DisplacementIncrement>(body)) {
        fields.displacement = authoring.node_rows.iter().map(|&row| u.vector(row as usize)).collect();
        fields.velocity = authoring.node_rows.iter().map(|&row| step.vector(row as usize) * rate).collect();
    }
    let blocks: Vec<Vec<ElementRow>> = authoring.blocks.iter().map(|&block| elements_of(world, block)).collect();
    for &(block, row) in &authoring.element_rows {
        let (ratio, stress, alive, _) = blocks[block as usize][row as usize];
        fields.volume_ratio.push(ratio);
        fields.stress.push(stress);
        fields.alive.push(alive);
    }
    Ok(fields)
}

/// Internal force of each node (N) at the present displacements, in the author's order.
///
/// # Errors
/// What the GPU says.
pub fn internal_forces(world: &mut World, body: Entity) -> Result<Vec<DVec3>, Error> {
    bring_to_host(world, |_, name| COLUMNS.contains(&name))?;
    let Some(authoring) = world.get::<Authoring>(body) else { return Ok(Vec::new()) };
    let mut by_row = vec![DVec3::ZERO; authoring.node_rows.len()];
    for &entity in &authoring.blocks {
        let (Some(block), Some(connectivity)) = (world.get::<Block>(entity), world.get::<Connectivity>(entity)) else {
            continue;
        };
        for (row, element) in elements_of(world, entity).iter().enumerate() {
            for corner in 0..node_count(block.kind) {
                let node = connectivity[crate::math::lane_place(row, node_count(block.kind), corner)];
                by_row[node as usize] += DVec3::from_array(element.3[corner]);
            }
        }
    }
    Ok(authoring.node_rows.iter().map(|&row| by_row[row as usize]).collect())
}

/// What holds a node of a body (N), by its row: internal less external force along axes that are fixed or moved as
/// told, 0 along free ones. Columns are on the host.
pub(super) fn reaction(body: EntityRef<'_>, row: usize) -> DVec3 {
    let internal = body.get::<InternalForce>().map_or(DVec3::ZERO, |force| force.vector(row));
    let external = body.get::<ExternalForce>().map_or(DVec3::ZERO, |force| force.vector(row));
    let axes = body.get::<ConstrainedAxes>().map_or(0, |axes| axes[row]);
    let held = |axis: u32| f64::from(axes >> axis & 1);
    (internal - external) * DVec3::new(held(0), held(1), held(2))
}

fn elements_of(world: &World, entity: Entity) -> Vec<ElementRow> {
    let all = (|| {
        let view = BlockView::now(world, entity)?;
        let alive = world.get::<Alive>(entity);
        let element = |row: usize| {
            if alive.is_some_and(|alive| alive[row] == 0) {
                return (1.0, [0.0; 6], 0, [[0.0; 3]; MOST_NODES]);
            }
            let state = view.element(row);
            (state.volume_ratio(), view.cauchy(row, &state), 1, view.forces(row, &state))
        };
        let task = |task: usize| {
            (task * ROWS_A_TASK..view.block.count.min((task + 1) * ROWS_A_TASK))
                .map(element)
                .collect::<Vec<ElementRow>>()
        };
        Some(world.resource::<Cpu>().map(view.block.count.div_ceil(ROWS_A_TASK), task).concat())
    })();
    all.unwrap_or_default()
}
