//! `pressure`: a pressure that follows the surface. `shaders/pressure.wgsl` is its twin.

use super::node_system::NodeSystem;
use super::node_views::{Before, ForceSlopes, NodesAtRest};
use super::places_within;
use super::rows::Rows;
use super::stage::Stage;
use super::system::{Phase, System};
use super::traction::with_alive;
use crate::backend::cpu::{Cpu, NodeColumns};
use crate::backend::face_kernel::{FaceLoad, face_loads};
use crate::components::*;
use crate::math::{Scalar, SimdScalar};
use crate::shader;
use bevy_ecs::prelude::*;
use glam::DVec3;
use serde::Serialize;
use std::sync::Arc;

/// A pressure (Pa), a signal, that follows faces of the surface and pushes inwards.
#[derive(Component, Clone, Debug, Serialize)]
pub struct Pressure {
    /// The faces, by the nodes they load.
    #[serde(skip)]
    pub faces: Arc<FaceCorners>,
    signal: usize,
}

/// Adds −p ∫ N_a n dA over the deformed faces, exact for triangles and for bilinear quadrilaterals; the force on a
/// curved face is exact, too, as the weighted sum of those on flat ones.
///
/// Each loaded node sums what its own faces bring, in a fixed order. A face of a removed element bears no load, and the
/// surface that removal uncovers is not loaded.
pub fn system() -> System {
    System::built_in_nodes::<Pressure>(
        "pressure",
        Phase::Loads,
        "adds pressures that follow the surface to the external forces",
        "`Pressure(...)` under `loads`",
        |world| super::registry::count::<Pressure>(world, "pressure", "pressures"),
    )
    .for_load(|on, signal| Some(Pressure { faces: on.faces()?.clone(), signal }))
    .with_shader::<Pressure>("shaders/pressure.wgsl", include_str!("../shaders/pressure.wgsl"))
}

impl NodeSystem for Pressure {
    type Columns = (&'static Displacement, &'static mut ExternalForce);
    /// The pressure (Pa).
    type Prepared = f64;
    const READS_ELSEWHERE: &'static [&'static str] = &[Displacement::NAME];

    fn rows(&self) -> Rows<'_> {
        Rows::List(&self.faces.rows)
    }

    /// Where elements can go, one for each block behind its faces.
    fn stages(&self, body: Entity, world: &World) -> Vec<Stage> {
        let of_block = |FaceLoad { faces, alive }: FaceLoad| {
            let face = |((&[a, b, c, d], behind), &weight): ((&[u32; 4], &(u32, u32)), &f64)| {
                [a, b, c, d, behind.1, (weight as f32).to_bits()]
            };
            let of_faces: Vec<u32> =
                faces.faces.iter().zip(&faces.elements).zip(&faces.weights).flat_map(face).collect();
            let stage = Stage::of(Rows::List(&faces.rows)).integers("starts", &faces.starts);
            let stage = stage.integers("corners", &faces.corners);
            with_alive(with_faces(stage, &faces.faces, &of_faces, body, world), alive)
        };
        face_loads(&self.faces, body, world).into_iter().map(of_block).collect()
    }

    fn prepare(&self, before: &Before<'_>) -> f64 {
        find_areas(&self.faces, before.rest, before.displacement);
        before.signals.values()[self.signal][0]
    }

    /// None is counted. Of a block of cells h, two or more across, −∂f/∂u of a pressure p over the masses has a norm of
    /// at most 4.7 p/(ρh²) (`stiffness_of_a_pressure…` below), and elements alone have an ω² of 4 M/(ρh²) or more, M =
    /// λ + 2μ: a pressure takes less than 0.6 p/M of the stable step, and at a `safety` of 0.9 any up to 0.19 M is
    /// stable. Such a one squeezes a body to five sixths; what makes elements stiffer there, the step follows.
    fn slopes(&self, _: &NodesAtRest<'_>) -> ForceSlopes {
        ForceSlopes::NONE
    }

    fn act<T: SimdScalar>(&self, pressure: &f64, _: &Cpu, nodes: &mut NodeColumns<'_, T>) {
        push(&self.faces, *pressure, nodes);
    }
}

/// Adds −p times the areas that fall to some nodes (m²) to the loads on them.
pub(super) fn push<T: SimdScalar>(faces: &FaceCorners, pressure: f64, nodes: &mut NodeColumns<'_, T>) {
    let first = nodes.first;
    let Some(external) = nodes.external_force_mut() else { return };
    let (areas, pressure) = (faces.deformed.read(), T::from_f64(pressure));
    let areas = areas.slice::<T>();
    for i in places_within(&faces.rows, first, external.len() / 3) {
        let mut sum = [T::default(); 3];
        for &corner in &faces.corners[faces.starts[i] as usize..faces.starts[i + 1] as usize] {
            let area = &areas[3 * corner as usize..3 * corner as usize + 3];
            for i in 0..3 {
                sum[i] += area[i];
            }
        }
        let row = faces.rows[i] as usize - first;
        for i in 0..3 {
            external[3 * row + i] -= pressure * sum[i];
        }
    }
}

/// Area vectors of each face's corners (m²), twelve numbers a face: of all faces before any node moves.
pub(super) fn find_areas(faces: &FaceCorners, rest: &RestPosition, displacement: &Displacement) {
    faces.deformed.renew(displacement.precision(), |areas| match (&displacement.0, areas) {
        (Reals::F32(u), Reals::F32(areas)) => find_areas_of(faces, rest, u, areas),
        (Reals::F64(u), Reals::F64(areas)) => find_areas_of(faces, rest, u, areas),
        _ => {}
    });
}

// each face once: its corners share most of the work. Written out: `map` over arrays costs seven times as much here
fn find_areas_of<T: Scalar>(faces: &FaceCorners, rest: &RestPosition, displacement: &[T], areas: &mut Vec<T>) {
    areas.clear();
    areas.reserve(12 * faces.faces.len());
    // from a corner of the face at rest: so areas keep their digits far from the origin
    let at = |node: u32, from: DVec3| {
        let (x, u) = (rest.0[node as usize] - from, &displacement[3 * node as usize..3 * node as usize + 3]);
        [T::from_f64(x.x) + u[0], T::from_f64(x.y) + u[1], T::from_f64(x.z) + u[2]]
    };
    let alive = faces.alive.read();
    for ((&[a, b, c, d], &weight), &alive) in faces.faces.iter().zip(&faces.weights).zip(&*alive) {
        let (there, weight, from) = (alive != 0, T::from_f64(weight), rest.0[a as usize]);
        let places = || [at(a, from), at(b, from), at(c, from), at(d, from)];
        let mut of_face = if there { corner_areas(places()) } else { [[T::default(); 3]; 4] };
        for number in of_face.as_flattened_mut() {
            *number = *number * weight;
        }
        areas.extend_from_slice(of_face.as_flattened());
    }
}

/// ∫ N_a n dA over a face: the area vector that falls to each corner. A triangle repeats its last node.
///
/// For a bilinear quadrilateral the integral of N_a (x_ξ × x_η) is exact in closed form: with e and d the edges and
/// diagonals, ¼ of the whole area vector plus what the corner's own corner area exceeds the mean by, a third of it.
#[inline(always)]
fn corner_areas<T: Scalar>([p, q, r, s]: [[T; 3]; 4]) -> [[T; 3]; 4] {
    if r == s {
        return [times(cross(minus(q, p), minus(r, p)), T::from_f64(1.0 / 6.0)); 4];
    }
    let [x, y, z] = times(cross(minus(r, p), minus(s, q)), T::from_f64(0.125));
    // area of each corner's own parallelogram
    let own_p = cross(minus(q, p), minus(s, p));
    let own_q = cross(minus(r, q), minus(p, q));
    let own_r = cross(minus(s, r), minus(q, r));
    let own_s = cross(minus(p, s), minus(r, s));
    let corner = |own: [T; 3], opposite: [T; 3]| {
        let [dx, dy, dz] = times(minus(own, opposite), T::from_f64(1.0 / 24.0));
        [x + dx, y + dy, z + dz]
    };
    [corner(own_p, own_r), corner(own_q, own_s), corner(own_r, own_p), corner(own_s, own_q)]
}

#[inline(always)]
fn minus<T: Scalar>(a: [T; 3], b: [T; 3]) -> [T; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
fn times<T: Scalar>(a: [T; 3], factor: T) -> [T; 3] {
    [a[0] * factor, a[1] * factor, a[2] * factor]
}

#[inline(always)]
fn cross<T: Scalar>(a: [T; 3], b: [T; 3]) -> [T; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Adds what finds the areas of deformed faces: six numbers of each, its nodes first, and where these are at rest, from
/// its first corner.
pub(super) fn with_faces(stage: Stage, nodes: &[[u32; 4]], faces: &[u32], body: Entity, world: &World) -> Stage {
    let rest = world.get::<RestPosition>(body).map_or(&[][..], |rest| &rest.0);
    let points_of =
        |face: &[u32; 4]| face.map(|node| (rest[node as usize] - rest[face[0] as usize]).as_vec3().to_array());
    let points: Vec<f32> = nodes.iter().flat_map(points_of).flatten().collect();
    stage.fragment(shader!("face_area")).integers("faces", faces).reals("face_points", &points)
}

#[cfg(test)]
mod tests;
