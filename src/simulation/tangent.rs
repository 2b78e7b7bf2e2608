//! Internal forces of all bodies in f64, whatever the run's precision and wherever it runs, and by their differences
//! the tangent stiffness at the present state. Reads the world only.

use super::block_forces::BlockForces;
use crate::backend::cpu::{BlockLaw, Cpu};
use crate::components::*;
use crate::elements::node_count;
use crate::materials::PronyTerm;
use crate::math::lane_place;
use crate::systems::sum_corners;
use bevy_ecs::prelude::*;

/// How far displacements are changed for a difference, as a share of the height of the flattest element: curvature of
/// the law is then below 1e-6 of its slope, and rounding in f64 as well.
const CHANGE: f64 = 1e-7;

/// Internal forces of all bodies as a function of all displacements, bodies one after the other.
pub(super) struct Tangent<'w> {
    cpu: &'w Cpu,
    bodies: Vec<BodyForces<'w>>,
    /// The present displacements (m), and the forces they make (N).
    present: (Vec<f64>, Vec<f64>),
    change: f64,
}

struct BodyForces<'w> {
    corners: &'w Corners,
    element_force: Vec<f64>,
    /// Where the body's part of all numbers begins, and how many it has.
    from: usize,
    length: usize,
    blocks: Vec<BlockForces<'w>>,
}

impl<'w> Tangent<'w> {
    /// At the present displacements. The host's columns must be up to date: see [`Tangent::columns`].
    pub fn at_present(world: &'w World, bodies: &[Entity]) -> Option<Self> {
        let mut all = Vec::new();
        let mut u = Vec::new();
        for &body in bodies {
            let displacement = world.get::<Displacement>(body)?;
            let blocks = &world.get::<Authoring>(body)?.blocks;
            let blocks =
                blocks.iter().map(|&block| BlockForces::of(world, block, at_an_instant)).collect::<Option<Vec<_>>>()?;
            let (corners, forces) = (world.get::<Corners>(body)?, world.get::<ElementForce>(body)?.len());
            let (from, length) = (u.len(), displacement.len());
            all.push(BodyForces { corners, element_force: vec![0.0; forces], from, length, blocks });
            u.extend((0..length).map(|i| displacement.get(i)));
        }
        let mut tangent = Self {
            cpu: world.resource::<Cpu>(),
            bodies: all,
            present: (Vec::new(), Vec::new()),
            change: CHANGE * least_height(world, bodies),
        };
        let mut forces = vec![0.0; u.len()];
        tangent.forces(&u, &mut forces);
        tangent.present = (u, forces);
        (tangent.change.is_finite() && tangent.change > 0.0).then_some(tangent)
    }

    /// Whether [`Tangent::at_present`] reads a column that a run changes.
    pub fn reads(column: &ColumnAccess) -> bool {
        let subjects = [Subject::Motion, Subject::Shape, Subject::Memory, Subject::Mass];
        subjects.contains(&column.subject) && column.increments == Increments::None
    }

    /// K x (N) for displacements x, of any length: (F(u + hx) − F(u))/h.
    pub fn times(&mut self, x: &[f64], image: &mut [f64]) {
        let largest = x.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
        if largest == 0.0 {
            image.fill(0.0);
            return;
        }
        let h = self.change / largest;
        let moved: Vec<f64> = self.present.0.iter().zip(x).map(|(u, x)| u + h * x).collect();
        self.forces(&moved, image);
        image.iter_mut().zip(&self.present.1).for_each(|(force, before)| *force = (*force - before) / h);
    }

    /// Internal forces (N) under displacements (m).
    fn forces(&mut self, u: &[f64], forces: &mut [f64]) {
        for body in &mut self.bodies {
            let own = body.from..body.from + body.length;
            for block in &mut body.blocks {
                block.forces(self.cpu, &u[own.clone()], &mut body.element_force);
            }
            sum_corners(self.cpu, body.corners, &body.element_force, &mut forces[own]);
        }
    }
}

/// A law as it answers to what is sudden: stresses relaxed so far are there, nothing relaxes further, and fibres that
/// could be pulled taut at any moment push back as well.
pub(super) fn at_an_instant(law: &BlockLaw<f64>) -> BlockLaw<f64> {
    let mut law = law.with_terms(|_, _, term| {
        if term.rate > 0.0 {
            // what damps is no force of a state at rest
            let memory = if term.is_damping() { 0.0 } else { term.memory };
            PronyTerm { stress: 0.0, memory, rate: 0.0, aim: term.aim }
        } else {
            // relaxed for good: that of a static analysis
            *term
        }
    });
    law.fibres.iter_mut().for_each(|(fibres, _)| fibres.tension_only = 0.0);
    law.exponential.iter_mut().for_each(|(family, _)| family.tension_only = 0.0);
    law
}

/// About the height (m) of the flattest element.
fn least_height(world: &World, bodies: &[Entity]) -> f64 {
    let heights = bodies.iter().filter_map(|&body| heights_at_nodes(world, body));
    heights.flatten().fold(f64::INFINITY, f64::min)
}

/// At each node of a body about the height (m) of the flattest element there: its volume at rest over the square of its
/// longest edge. Infinite at a node without elements.
pub(super) fn heights_at_nodes(world: &World, body: Entity) -> Option<Vec<f64>> {
    let (authoring, rest) = (world.get::<Authoring>(body)?, world.get::<RestPosition>(body)?);
    let mut heights = vec![f64::INFINITY; rest.0.len()];
    for &entity in &authoring.blocks {
        let (Some(block), Some(connectivity), Some(shape)) =
            (world.get::<Block>(entity), world.get::<Connectivity>(entity), world.get::<RestShape>(entity))
        else {
            continue;
        };
        let nodes = node_count(block.kind);
        for row in 0..block.count {
            let node = |a: usize| connectivity[lane_place(row, nodes, a)] as usize;
            let corner = |a: usize| rest.0[node(a)];
            let pairs = (1..nodes).flat_map(|a| (0..a).map(move |b| (a, b)));
            let longest = pairs.map(|(a, b)| corner(a).distance_squared(corner(b))).fold(0.0, f64::max);
            let volume = crate::evaluation::rest_volume(block, row, shape);
            if volume > 0.0 {
                (0..nodes).for_each(|a| heights[node(a)] = heights[node(a)].min(volume / longest));
            }
        }
    }
    Some(heights)
}
