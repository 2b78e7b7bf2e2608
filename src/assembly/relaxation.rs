//! What a static analysis needs to know of meshes: inertial masses, and how many steps a push takes from end to end.

use super::Assembly;
use super::body_columns::stiffnesses;
use super::time_step::square_frequency;
use crate::components::*;
use crate::elements::{Stiffness, mass_shares, node_count};
use crate::evaluation::rest_volume;
use crate::math::lane_place;
use crate::systems::SurfaceContacts;
use bevy_ecs::prelude::*;

/// Loads grow over at least so many pseudo-steps.
const FEWEST_LOAD_STEPS: u64 = 100;
/// Pseudo-steps for each element between what is held and what is farthest from it: a push passes about an element in a
/// step, and must be able to spread while it grows.
const STEPS_AN_ELEMENT: f64 = 5.0;
/// The same where nodes are moved as told, in times that a shear wave takes through an element: what is turned or bent
/// by them must follow, or comes to rest elsewhere.
const SHEAR_STEPS_AN_ELEMENT: f64 = 10.0;

/// Gives every body [`InertialMass`]: each element weighs ω²Δt²/4 of its mass, ω its frequency bound, so that Δt is
/// the bound of the stable step of all elements, whatever their size, stiffness and density.
pub(super) fn insert_inertial_masses(assembly: &Assembly<'_>, world: &mut World) {
    let time_step = world.resource::<Clock>().time_step;
    for parts in assembly.bodies.values() {
        let mut mass = vec![0.0; parts.node_rows.len()];
        for &entity in &parts.blocks {
            let (Some(block), Some(connectivity), Some(shape)) =
                (world.get::<Block>(entity), world.get::<Connectivity>(entity), world.get::<RestShape>(entity))
            else {
                continue;
            };
            let Some(frequency) = square_frequency(world, entity, block) else { continue };
            let inertia = ElementInertia::of(world, entity);
            let shares = mass_shares(block.kind);
            for row in 0..block.count {
                let density = inertia.of_row(row)[0];
                let whole = density * rest_volume(block, row, shape) * 0.25 * frequency(row) * time_step * time_step;
                for (corner, share) in shares.iter().enumerate() {
                    mass[connectivity[lane_place(row, shares.len(), corner)] as usize] += whole * share;
                }
            }
        }
        // what springs at a node are stable with at this step
        if let Some(sutured) = world.get::<Sutured>(parts.entity) {
            for (&row, stiffness) in sutured.rows.iter().zip(&sutured.stiffness) {
                mass[row as usize] += 0.25 * stiffness * time_step * time_step;
            }
        }
        of_springs(world, parts.entity, &mut mass);
        let mass = Reals::from_f64(assembly.precision, mass.into_iter());
        world.entity_mut(parts.entity).insert(InertialMass(mass));
    }
}

/// Facets around a node of a surface of triangles, about; of quadrilaterals they are four.
const FACETS: f64 = 6.0;

/// Adds what springs of contact at a body's nodes are stable with (kg). One of a tool acts on its node alone. One
/// between surfaces moves a point of weights w, and (Σ w x)² ≤ Σ|w| Σ|w| x², with Σ|w| = 2: each node bears twice its
/// own spring, and about twice that of the heaviest point that may meet it. Points of faces share the nodes of their
/// facets: those of each facet around a node make one spring of it.
fn of_springs(world: &World, body: Entity, inertia: &mut [f64]) {
    let clock = world.resource::<Clock>();
    let (Some(springs), Some(mass)) = (clock.springs, world.get::<Mass>(body)) else { return };
    let of_share = |share: f64, mass: f64| 0.25 * share * mass * (clock.time_step / springs.step).powi(2);
    if let Some(contacts) = world.get::<ToolContacts>(body) {
        for (&row, &mask) in contacts.rows.iter().zip(&contacts.masks) {
            let of_node = contacts.tools.iter().enumerate().filter(|(tool, _)| mask >> tool & 1 == 1);
            let share: f64 = of_node.filter_map(|(_, tool)| tool.spring).map(|spring| spring.share).sum();
            inertia[row as usize] += of_share(share, mass.get(row as usize));
        }
    }
    let Some(contacts) = world.get_resource::<SurfaceContacts>() else { return };
    let (Some(rows), Some(share)) = (world.get::<SurfaceRows>(body), contacts.largest_share(body)) else { return };
    let of_body = |body: &Entity| {
        let (Some(rows), Some(mass)) = (world.get::<SurfaceRows>(*body), world.get::<Mass>(*body)) else { return 0.0 };
        rows.0.iter().map(|&row| mass.get(row as usize)).fold(0.0, f64::max)
    };
    let heaviest = contacts.bodies.iter().map(of_body).fold(0.0, f64::max);
    let has_face_points = (0..contacts.bodies.len()).any(|body| contacts.has_face_points(body));
    let points = if has_face_points { FACETS } else { 1.0 };
    for &row in &rows.0 {
        inertia[row as usize] += 2.0 * points * of_share(share, mass.get(row as usize) + heaviest);
    }
}

/// Pseudo-steps over which loads should grow: by the elements that lie between nodes that are held or moved and the
/// node farthest from any of them. A body that nothing holds counts from its first node.
pub fn load_steps(world: &mut World) -> u64 {
    let bodies: Vec<(Vec<Entity>, Vec<u32>)> = world
        .query::<(&Authoring, &ConstrainedAxes)>()
        .iter(world)
        .map(|(authoring, axes)| {
            let held = |axes: &u32| if *axes == 0 { u32::MAX } else { 0 };
            (authoring.blocks.clone(), axes.iter().map(held).collect())
        })
        .collect();
    let slowness = if world.query::<&Prescribed>().iter(world).next().is_none() {
        STEPS_AN_ELEMENT
    } else {
        SHEAR_STEPS_AN_ELEMENT * slowest_shear(world)
    };
    let mut farthest = 0;
    for (blocks, mut distance) in bodies {
        if distance.iter().all(|&d| d > 0) {
            distance.iter_mut().take(1).for_each(|d| *d = 0);
        }
        while blocks.iter().any(|&block| spread(world, block, &mut distance)) {}
        farthest = farthest.max(distance.into_iter().filter(|&d| d < u32::MAX).max().unwrap_or(0));
    }
    FEWEST_LOAD_STEPS.max((slowness * f64::from(farthest)) as u64)
}

/// The largest ratio √((λ + 2μ)/μ) of the speeds of pressure and shear waves.
fn slowest_shear(world: &mut World) -> f64 {
    let blocks: Vec<Entity> = world.query_filtered::<Entity, With<Block>>().iter(world).collect();
    let ratio = |found: Stiffness| ((found.lambda + found.deviatoric()) / (0.5 * found.deviatoric())).sqrt();
    blocks.iter().flat_map(|&block| stiffnesses(world, block)).map(ratio).fold(1.0, f64::max)
}

/// Carries distances on from corner to corner of each element; whether one became shorter.
fn spread(world: &World, block: Entity, distance: &mut [u32]) -> bool {
    let (Some(kind), Some(connectivity)) = (world.get::<Block>(block), world.get::<Connectivity>(block)) else {
        return false;
    };
    let (nodes, mut shorter) = (node_count(kind.kind), false);
    for row in 0..kind.count {
        let node = |corner: usize| connectivity[lane_place(row, nodes, corner)] as usize;
        let nearest = (0..nodes).map(|corner| distance[node(corner)]).min().unwrap_or(u32::MAX);
        for corner in 0..nodes {
            if distance[node(corner)] > nearest.saturating_add(1) {
                distance[node(corner)] = nearest + 1;
                shorter = true;
            }
        }
    }
    shorter
}
