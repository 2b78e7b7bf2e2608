//! The kernels of conjugate gradients on a device, as data; `shaders/conjugate_gradients.wgsl` says how they follow
//! each other.

use super::super::axes::Axes;
use crate::backend::Buffers;
use crate::backend::kernel::{BufferId, Fragment, Kernel, Uniform, uniform};
use crate::components::*;
use crate::shader;
use bevy_ecs::prelude::*;

/// Invocations of a workgroup whose sums are one partial sum.
pub(super) const GROUP: usize = 64;

/// The sizes that all kernels know.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub(super) struct Extent {
    pub nodes: u32,
    pub groups: u32,
    pub image_groups: u32,
    pub aggregates: u32,
    pub unknowns: u32,
    pub stiffness: f32,
}
uniform!(Extent { nodes, groups, image_groups, aggregates, unknowns, stiffness });

/// A body among all.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
struct Part {
    first: u32,
    nodes: u32,
    first_group: u32,
    groups: u32,
}
uniform!(Part { first, nodes, first_group, groups });

/// The label of the uniform of [`Extent`].
pub(super) const EXTENT: &str = "extent of conjugate gradients";

/// Buffers that a solve fills and reads, by the names of their variables.
#[derive(Clone, Copy)]
pub(super) struct Vectors {
    pub solve: BufferId,
    pub solution: BufferId,
    pub residual: BufferId,
    pub place: BufferId,
    pub place_step: BufferId,
    pub net_force: BufferId,
    pub inertia: BufferId,
    pub node_blocks: BufferId,
    preconditioned: BufferId,
    direction: BufferId,
    image: BufferId,
    heights: BufferId,
    partials: BufferId,
    extent: BufferId,
}

/// Buffers of the coarse level.
#[derive(Clone, Copy)]
pub(super) struct CoarseBuffers {
    pub arms: BufferId,
    pub turns: BufferId,
    pub aggregate_nodes: BufferId,
    pub coarse_rows: BufferId,
    pub coarse_inverse: BufferId,
    coarse_forces: BufferId,
    coarse_motions: BufferId,
}

/// How much room the buffers of the coarse level have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Room {
    pub aggregates: usize,
    pub entries: usize,
}

impl Extent {
    /// Of bodies.
    pub fn of(axes: &Axes, stiffness: f64) -> Self {
        let nodes = axes.len() / 3;
        let image_groups: usize = axes.each().map(|(_, range)| (range.len() / 3).div_ceil(GROUP)).sum();
        Self {
            nodes: nodes as u32,
            groups: nodes.div_ceil(GROUP) as u32,
            image_groups: image_groups as u32,
            aggregates: 0,
            unknowns: 0,
            stiffness: stiffness as f32,
        }
    }
}

impl Vectors {
    /// Makes them; heights (m) are those at axes.
    pub fn new(axes: &Axes, extent: &Extent, buffers: &mut dyn Buffers) -> Self {
        let nodes = extent.nodes as usize;
        let mut numbers = |label: &str, count: usize| {
            buffers.constants(format!("{label} of conjugate gradients"), &vec![0; size_of::<f32>() * count])
        };
        let mut vector = |label: &str| numbers(label, 3 * nodes);
        let [solution, residual, preconditioned, direction] =
            ["solution", "residual", "preconditioned", "direction"].map(&mut vector);
        let [image, place, place_step, net_force, inertia] =
            ["image", "place", "place_step", "net_force", "inertia"].map(&mut vector);
        let solve = numbers("numbers", SOLVE_WORDS);
        let node_blocks = numbers("node_blocks", 6 * nodes);
        let partials = numbers("partials", 2 * extent.groups.max(extent.image_groups) as usize);
        // where a node has no element nothing is strained
        let height = |height: f64| if height > 0.0 && height.is_finite() { height as f32 } else { f32::MAX };
        let heights: Vec<f32> = (0..nodes).map(|node| height(axes.heights.get(node))).collect();
        Self {
            solve,
            solution,
            residual,
            place,
            place_step,
            net_force,
            inertia,
            node_blocks,
            preconditioned,
            direction,
            image,
            partials,
            heights: buffers.constants("heights of conjugate gradients".into(), bytemuck::cast_slice(&heights)),
            extent: buffers.uniform(EXTENT.into(), &extent.bytes()),
        }
    }

    fn kernel(&self, entry: &'static str, threads: usize) -> Kernel {
        let endings = super::endings();
        Kernel::new(entry, entry)
            .fragment(shader!("row"))
            .fragment(shader!("conjugate_gradients"))
            .fragment(Fragment::new("generated: how solves end", endings))
            .bind("solve", self.solve)
            .bind("partials", self.partials)
            .bind_uniform::<Extent>("extent", self.extent)
            .threads(u32::try_from(threads).unwrap_or(u32::MAX))
    }

    /// What one workgroup does.
    pub fn scalars(&self, entry: &'static str) -> Kernel {
        self.kernel(entry, 1).fragment(shader!("gradient_scalars"))
    }

    /// What is done to the vectors, node by node.
    pub fn vectors(&self, entry: &'static str, nodes: usize) -> Kernel {
        self.kernel(entry, nodes)
            .fragment(shader!("gradient_vectors"))
            .bind("solution", self.solution)
            .bind("residual", self.residual)
            .bind("preconditioned", self.preconditioned)
            .bind("direction", self.direction)
            .bind("image", self.image)
            .bind("heights", self.heights)
    }

    /// z = B r.
    pub fn precondition(&self, nodes: usize, coarse: Option<&CoarseBuffers>) -> Kernel {
        let kernel = self
            .kernel("precondition", nodes)
            .fragment(shader!("precondition"))
            .bind("node_blocks", self.node_blocks)
            .bind("residual", self.residual)
            .bind("preconditioned", self.preconditioned)
            .bind("inertia", self.inertia);
        let Some(coarse) = coarse else {
            let none = "fn coarse_motion_of(node: u32) -> vec3<f32> {\n    return vec3<f32>(0.0);\n}\n";
            return kernel.fragment(Fragment::new("generated: no coarse level", none));
        };
        coarse.of(kernel).fragment(shader!("coarse_motion")).bind("coarse_motions", coarse.coarse_motions)
    }

    /// What the coarse level does, a workgroup an aggregate or an unknown.
    pub fn coarse(&self, entry: &'static str, groups: usize, coarse: &CoarseBuffers) -> Kernel {
        coarse
            .of(self.kernel(entry, GROUP * groups))
            .fragment(shader!("coarse_solve"))
            .bind("residual", self.residual)
            .bind("aggregate_nodes", coarse.aggregate_nodes)
            .bind("coarse_forces", coarse.coarse_forces)
            .bind("coarse_rows", coarse.coarse_rows)
            .bind("coarse_inverse", coarse.coarse_inverse)
            .bind("coarse_motions", coarse.coarse_motions)
    }

    /// `displace` and `image_of` of each body; `step_slope` where loads look at velocities, what a displacement changes
    /// of the step that these are told by.
    pub fn bodies(
        &self,
        axes: &Axes,
        step_slope: Option<f64>,
        world: &World,
        buffers: &mut dyn Buffers,
    ) -> [Vec<Kernel>; 2] {
        let mut made = [Vec::new(), Vec::new()];
        let mut first_group = 0;
        for (body, range) in axes.each() {
            let nodes = range.len() / 3;
            let groups = nodes.div_ceil(GROUP);
            let part = Part {
                first: (range.start / 3) as u32,
                nodes: nodes as u32,
                first_group: first_group as u32,
                groups: groups as u32,
            };
            first_group += groups;
            let part = buffers.uniform("part of conjugate gradients".into(), &part.bytes());
            for (made, entry) in made.iter_mut().zip(["displace", "image_of"]) {
                let kernel = self.kernel(entry, nodes).bind_uniform::<Part>("part", part);
                made.push(self.of_body(kernel, body, step_slope, world, buffers));
            }
        }
        made
    }

    fn of_body(
        &self,
        kernel: Kernel,
        body: Entity,
        step_slope: Option<f64>,
        world: &World,
        buffers: &mut dyn Buffers,
    ) -> Kernel {
        let kernel = kernel
            .fragment(shader!("gradient_image"))
            .bind("direction", self.direction)
            .bind("place", self.place)
            .bind("net_force", self.net_force)
            .bind("inertia", self.inertia)
            .bind("image", self.image)
            .bind(Displacement::NAME, buffers.column(body, Displacement::NAME))
            .bind(InternalForce::NAME, buffers.column(body, InternalForce::NAME));
        let kernel = match world.get::<ExternalForce>(body) {
            Some(_) => kernel
                .fragment(shader!("external_force"))
                .bind(ExternalForce::NAME, buffers.column(body, ExternalForce::NAME)),
            None => kernel.fragment(Fragment::new(
                "generated: no loads",
                "fn external_force_of(node: u32) -> vec3<f32> {\n    return vec3<f32>(0.0);\n}\n",
            )),
        };
        match step_slope {
            Some(slope) => kernel
                .fragment(shader!("gradient_velocity"))
                .fragment(Fragment::new("generated: slope", format!("const STEP_SLOPE: f32 = {:e};\n", slope as f32)))
                .bind("place_step", self.place_step)
                .bind(DisplacementIncrement::NAME, buffers.column(body, DisplacementIncrement::NAME)),
            None => kernel.fragment(Fragment::new(
                "generated: loads look at no velocity",
                "fn displace_velocity(own: u32, at: u32, moved: f32) {}\n",
            )),
        }
    }
}

/// Words of what kernels keep of a solve.
pub(super) const SOLVE_WORDS: usize = 8;

impl CoarseBuffers {
    /// Makes them with room for so much.
    pub fn new(nodes: usize, room: Room, buffers: &mut dyn Buffers) -> Self {
        let mut numbers = |label: &str, count: usize| {
            buffers.constants(format!("{label} of the coarse level"), &vec![0; size_of::<f32>() * count])
        };
        Self {
            arms: numbers("arms", 4 * nodes),
            turns: numbers("turns", 9 * room.aggregates),
            aggregate_nodes: numbers("aggregate_nodes", room.aggregates + 1 + nodes),
            coarse_rows: numbers("coarse_rows", 3 * 6 * room.aggregates),
            coarse_inverse: numbers("coarse_inverse", room.entries),
            coarse_forces: numbers("coarse_forces", 6 * room.aggregates),
            coarse_motions: numbers("coarse_motions", 6 * room.aggregates),
        }
    }

    fn of(&self, kernel: Kernel) -> Kernel {
        kernel.fragment(shader!("coarse_level")).bind("arms", self.arms).bind("turns", self.turns)
    }
}
