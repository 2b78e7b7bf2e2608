//! The largest frequency of a whole scene at rest: what its pseudo-steps may outdo the bound of the elements by.

use crate::components::*;
use crate::systems::HostSystem;
use bevy_ecs::prelude::*;

/// Evaluations of the forces: the largest eigenvalue is found to about a hundredth.
const EVALUATIONS: usize = 24;
/// Displacements that forces are made of, as a share of the shortest element edge: small beside what would turn them, and
/// large beside rounding.
const AMPLITUDE: f64 = 1e-4;

/// The largest eigenvalue of Δt²/4 M⁻¹K with the fictitious masses M, at rest and without held axes, by Lanczos' recursion;
/// at most 1, which the bound of the elements says it is. `forces` are the systems that find internal forces; columns
/// they write are left at rest.
pub(super) fn largest_eigenvalue(mut forces: Vec<&mut HostSystem>, world: &mut World) -> f64 {
    let clock = *world.resource::<Clock>();
    let amplitude = AMPLITUDE * shortest_edge(world);
    let roots = roots_of_mass(world, 0.5 * clock.time_step);
    let mut previous = vec![0.0; roots.len()];
    let mut vector = noise(&roots);
    let (mut diagonal, mut beside): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    for _ in 0..EVALUATIONS {
        let length = norm(&vector);
        if !(length > 0.0 && length.is_finite() && amplitude.is_finite()) {
            break;
        }
        beside.push(length);
        vector.iter_mut().for_each(|x| *x /= length);
        let Some(mut image) = image(&vector, &roots, amplitude, &mut forces, world) else { break };
        let along: f64 = image.iter().zip(&vector).map(|(a, b)| a * b).sum();
        diagonal.push(along);
        for i in 0..image.len() {
            image[i] -= along * vector[i] + if diagonal.len() > 1 { length * previous[i] } else { 0.0 };
        }
        previous = std::mem::replace(&mut vector, image);
    }
    set_displacements(&vec![0.0; roots.len()], world);
    let _ = run(&mut forces, world);
    let largest = largest_of_tridiagonal(&diagonal, beside.get(1..).unwrap_or(&[]));
    if largest > 0.0 && largest < 1.0 { largest } else { 1.0 }
}

/// M^(−½) K M^(−½) x, in units of the factor that is in the roots.
fn image(
    x: &[f64],
    roots: &[f64],
    amplitude: f64,
    forces: &mut [&mut HostSystem],
    world: &mut World,
) -> Option<Vec<f64>> {
    let mut u: Vec<f64> = x.iter().zip(roots).map(|(x, root)| x * root).collect();
    let largest = u.iter().fold(0.0_f64, |largest, u| largest.max(u.abs()));
    let scale = amplitude / largest;
    u.iter_mut().for_each(|u| *u *= scale);
    set_displacements(&u, world);
    run(forces, world)?;
    let mut image = Vec::with_capacity(u.len());
    for body in bodies(world) {
        let internal = world.get::<InternalForce>(body)?;
        image.extend((0..internal.len()).map(|i| internal.get(i)));
    }
    image.iter_mut().zip(roots).for_each(|(force, root)| *force *= root / scale);
    Some(image)
}

fn run(forces: &mut [&mut HostSystem], world: &mut World) -> Option<()> {
    for system in forces {
        system.run((), world).ok()?.ok()?;
    }
    for mut found in world.query::<&mut FirstInverted>().iter_mut(world) {
        found[0] = u32::MAX;
    }
    Some(())
}

/// Bodies in a fixed order.
fn bodies(world: &mut World) -> Vec<Entity> {
    let mut bodies: Vec<Entity> = world.query_filtered::<Entity, With<FictitiousMass>>().iter(world).collect();
    bodies.sort();
    bodies
}

fn set_displacements(u: &[f64], world: &mut World) {
    let mut from = 0;
    for body in bodies(world) {
        let Some(mut column) = world.get_mut::<Displacement>(body) else { continue };
        let length = column.len();
        (0..length).for_each(|i| column.set(i, u[from + i]));
        from += length;
    }
}

/// `factor`/√M of every free axis, 0 of held and parked ones.
fn roots_of_mass(world: &mut World, factor: f64) -> Vec<f64> {
    let mut roots = Vec::new();
    for body in bodies(world) {
        let (Some(mass), Some(axes)) = (world.get::<FictitiousMass>(body), world.get::<ConstrainedAxes>(body)) else {
            continue;
        };
        let root = |i: usize| {
            let free = axes[i / 3] >> (i % 3) & 1 == 0 && mass.get(i / 3) > 0.0;
            if free { factor / mass.get(i / 3).sqrt() } else { 0.0 }
        };
        roots.extend((0..3 * mass.len()).map(root));
    }
    roots
}

/// The shortest distance of two corners of an element (m).
fn shortest_edge(world: &mut World) -> f64 {
    let mut shortest = f64::INFINITY;
    let mut blocks = world.query::<(&Block, &Connectivity)>();
    for (block, connectivity) in blocks.iter(world) {
        let Some(rest) = world.get::<RestPosition>(block.body) else { continue };
        let nodes = crate::evaluation::node_count(block.kind);
        for row in 0..block.count {
            let corner = |a: usize| rest.0[connectivity[crate::evaluation::lane_place(row, nodes, a)] as usize];
            for a in 1..nodes {
                shortest = (0..a).map(|b| corner(a).distance(corner(b))).fold(shortest, f64::min);
            }
        }
    }
    shortest
}

/// A start that has a part of every mode, the same everywhere.
fn noise(roots: &[f64]) -> Vec<f64> {
    let mut state = 1_u64;
    let mut next = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    roots.iter().map(|&root| if root > 0.0 { next() } else { 0.0 }).collect()
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// By bisection: as many eigenvalues are above x as the pivots of T − x that are positive.
fn largest_of_tridiagonal(diagonal: &[f64], beside: &[f64]) -> f64 {
    let above = |x: f64| {
        let mut pivot = f64::INFINITY;
        diagonal.iter().enumerate().any(|(i, d)| {
            let off = if i > 0 { beside[i - 1] } else { 0.0 };
            pivot = d - x - off * off / pivot;
            pivot > 0.0
        })
    };
    let side = |i: usize| beside.get(i).copied().unwrap_or(0.0).abs();
    let bound = |(i, d): (usize, &f64)| d + side(i) + if i > 0 { side(i - 1) } else { 0.0 };
    let (mut low, mut high) = (0.0, diagonal.iter().enumerate().map(bound).fold(0.0, f64::max));
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if above(middle) { low = middle } else { high = middle }
    }
    high
}
