//! What stages have in common in which tools act on nodes.

use super::row::{ToolRow, row_of};
use crate::backend::Buffers;
use crate::backend::kernel::{Fragment, Uniform};
use crate::backend::node_stage::{NodeStage, rows_of};
use crate::components::*;
use crate::shader;
use crate::systems::integrate::damping_fragment;
use crate::tools::Geometry;
use bevy_ecs::prelude::*;
use glam::DVec3;

/// Some tools and the nodes of a body that they may act on.
pub(in crate::systems) struct ToolNodes<'a> {
    /// The system, whose twin says what a tool does to a node.
    pub system: &'static str,
    /// That twin.
    pub twin: Fragment,
    /// How many tools there are, and how many numbers of each.
    pub counts: String,
    /// The tools.
    pub tools: Vec<&'a ToolContact>,
    /// A point near the body (m), from which places are counted.
    pub reference: DVec3,
    /// The nodes, ascending.
    pub rows: &'a [u32],
    /// Of each of them, which tools: bit i is tool i.
    pub masks: &'a [u32],
    /// The twin's name of both.
    pub nodes: &'static str,
    /// What is kept of nodes and tools.
    pub column: &'static str,
}

/// A stage for a body; what else the twin binds is the system's affair.
pub(in crate::systems) fn stage(
    body: Entity,
    of: ToolNodes<'_>,
    world: &mut World,
    buffers: &mut dyn Buffers,
) -> NodeStage {
    let damped = world.get::<DampingCoefficient>(body).is_some();
    let relaxed = world.resource::<Clock>().relaxation.is_some();
    // bits of floats: those of a mask would be a float so small that a device may take it for 0
    let place = |(&row, &mask): (&u32, &u32)| {
        let rest = world.get::<RestPosition>(body).map_or(DVec3::ZERO, |rest| rest.0[row as usize]);
        let [x, y, z] = (rest - of.reference).as_vec3().to_array().map(f32::to_bits);
        [x, y, z, mask]
    };
    let places: Vec<[u32; 4]> = of.rows.iter().zip(of.masks).map(place).collect();
    let (mut grids, mut tools) = (Vec::<f32>::new(), Vec::<u8>::new());
    for tool in of.tools {
        tools.extend(row_of(tool, grids.len() as u32).bytes());
        if let Geometry::Grid(grid) = &tool.geometry {
            grids.extend(grid.values());
        }
    }
    let named = |what: &str| format!("{what} of {}", of.system);
    let mut stage = NodeStage::new(of.system, of.system, body, rows_of(body, world), of.twin)
        .own(shader!("tool_row"))
        .own(shader!("tool_shape"))
        .own(shader!("foreseen"))
        .own(Fragment::new("generated: how many tools", of.counts))
        .own(damping_fragment(damped, relaxed))
        .bind_uniform::<ToolRow>("tools", buffers.uniform(named("tools"), &tools))
        .bind(of.nodes, buffers.constants(named("nodes"), bytemuck::cast_slice(&places)))
        .of_rows(of.rows.to_vec());
    let mass = if world.get::<InertialMass>(body).is_some() { InertialMass::NAME } else { Mass::NAME };
    stage = stage.column(Mass::NAME, buffers.column(body, mass));
    for column in [ConstrainedAxes::NAME, Displacement::NAME, DisplacementIncrement::NAME, of.column] {
        stage = stage.column(column, buffers.column(body, column));
    }
    for column in [InternalForce::NAME, ExternalForce::NAME] {
        stage = stage.column(column, buffers.column(body, column));
    }
    if damped {
        stage = stage.column(DampingCoefficient::NAME, buffers.column(body, DampingCoefficient::NAME));
    }
    stage = if grids.is_empty() {
        stage.own(no_grid())
    } else {
        let values = buffers.constants(named("distances"), bytemuck::cast_slice(&grids));
        stage.own(shader!("tool_grid")).own(shader!("tool_of_grid")).bind("tool_grid_values", values)
    };
    stage.with_step(world).loaded(true).that_asks_for_forces()
}

/// What takes the place of distances to grids where there are none.
fn no_grid() -> Fragment {
    let text = "fn grid_distance(row: ToolRow, y: vec3<f32>) -> vec4<f32> {\n    return vec4<f32>(0.0);\n}\n";
    Fragment::new("generated: no tool is a grid", text)
}
