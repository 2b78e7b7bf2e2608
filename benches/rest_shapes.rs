//! What a tetrahedron costs with its rest shape from memory (40 bytes), and with the same computed from the places at
//! rest of a patch's nodes (12 bytes a node): `cargo bench --bench rest_shapes`. The element kernel alone, without what
//! follows at nodes, by turns, the best of each.
#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use glam::DVec3;
use pulp::{Simd, WithSimd};
use sinew::elements::{Element, MOST_NODES, Tet4};
use sinew::materials::{Elastic, NeoHookean};
use sinew::math::{LANES, Mat3, Real, Rows, Scratch, SimdScalar, dot, minor};
use std::time::Instant;

/// Groups of a patch.
const GROUPS: usize = 64;

/// One patch: cells of six tetrahedra each, whose lanes come from all over it.
struct Template {
    places: Vec<[f32; 3]>,
    /// Four rows a group, and ten.
    corners: Vec<[u16; LANES]>,
    shapes: Vec<[f32; LANES]>,
}

fn template() -> Template {
    const NODES: [usize; 3] = [6, 6, 8];
    let node = |[x, y, z]: [usize; 3]| (z * NODES[1] + y) * NODES[0] + x;
    let (mut places, mut elements) = (Vec::new(), Vec::new());
    for z in 0..NODES[2] {
        for y in 0..NODES[1] {
            for x in 0..NODES[0] {
                places.push([x, y, z].map(|i| i as f32 * 1e-3));
                if x + 1 < NODES[0] && y + 1 < NODES[1] && z + 1 < NODES[2] {
                    let corner = |i: usize| node([x + (i & 1), y + (i >> 1 & 1), z + (i >> 2 & 1)]);
                    for [a, b] in [[1, 3], [3, 2], [2, 6], [6, 4], [4, 5], [5, 1]] {
                        elements.push([0, a, b, 7].map(corner));
                    }
                }
            }
        }
    }
    let (mut corners, mut shapes) = (vec![[0; LANES]; 4 * GROUPS], vec![[0.0; LANES]; 10 * GROUPS]);
    for group in 0..GROUPS {
        for lane in 0..LANES {
            let element: [usize; 4] = elements[lane * GROUPS + group];
            let points = element.map(|node| DVec3::from_array(places[node].map(f64::from)));
            let shape = Tet4::rest_shape(&points, 1.0);
            (0..4).for_each(|i| corners[4 * group + i][lane] = element[i] as u16);
            (0..10).for_each(|i| shapes[10 * group + i][lane] = shape[i] as f32);
        }
    }
    Template { places, corners, shapes }
}

/// A patch.
struct Patch<'a> {
    corners: &'a [[u16; LANES]],
    shapes: &'a [[f32; LANES]],
    places: &'a [[f32; 3]],
    u: &'a [[f32; 3]],
    forces: &'a mut [[f32; 3]],
    scratch: &'a mut Scratch<f32>,
    at_rest: &'a mut Rows<f32>,
    law: NeoHookean<f32>,
    recomputed: bool,
}

impl WithSimd for Patch<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        if self.recomputed { self.run::<S, true>(simd) } else { self.run::<S, false>(simd) }
    }
}

impl Patch<'_> {
    #[inline(always)]
    fn run<S: Simd, const RECOMPUTED: bool>(self, simd: S) {
        let Self { scratch, at_rest, .. } = self;
        let law = self.law.map(
            #[inline(always)]
            |number| f32::splat(simd, number),
        );
        for (row, u) in scratch.read.iter_mut().zip(self.u) {
            *row = [u[0], u[1], u[2], 0.0];
        }
        if RECOMPUTED {
            for (row, x) in at_rest.iter_mut().zip(self.places) {
                *row = [x[0], x[1], x[2], 0.0];
            }
        }
        scratch.sums[..self.u.len()].fill([0.0; 4]);
        for group in 0..GROUPS {
            let corners = &self.corners[4 * group..][..4];
            let shapes = &self.shapes[10 * group..][..10];
            let mut at = 0;
            while at < LANES {
                let zero = f32::splat(simd, 0.0);
                macro_rules! load {
                    ($rows:expr, $corner:literal) => {{
                        let [x, y, z, _] = f32::load_rows(simd, $rows, &corners[$corner][at..]);
                        [x, y, z]
                    }};
                }
                let mut u = [[zero; 3]; MOST_NODES];
                u[0] = load!(&scratch.read, 0);
                u[1] = load!(&scratch.read, 1);
                u[2] = load!(&scratch.read, 2);
                u[3] = load!(&scratch.read, 3);
                let edges = Tet4::prepare(&u);
                let mut forces = [[zero; 3]; 4];
                if RECOMPUTED {
                    let mut x = [[zero; 3]; MOST_NODES];
                    x[0] = load!(at_rest, 0);
                    x[1] = load!(at_rest, 1);
                    x[2] = load!(at_rest, 2);
                    x[3] = load!(at_rest, 3);
                    by_places(&law, &edges, &Tet4::prepare(&x), &mut forces);
                } else {
                    let state = Tet4::at_point(
                        &edges,
                        0,
                        #[inline(always)]
                        |row: usize| f32::load(simd, &shapes[row][at..]),
                    );
                    let (stress, _) = law.direct_stress(&state.gradient, None, None);
                    Tet4::store_forces(
                        &edges,
                        &stress,
                        #[inline(always)]
                        |row: usize| f32::load(simd, &shapes[row][at..]),
                        #[inline(always)]
                        |corner, i, force| forces[corner][i] = force,
                    );
                }
                f32::add_to_rows(simd, &mut scratch.sums, &corners[1][at..], forces[1]);
                f32::add_to_rows(simd, &mut scratch.sums, &corners[2][at..], forces[2]);
                f32::add_to_rows(simd, &mut scratch.sums, &corners[3][at..], forces[3]);
                f32::add_to_rows(simd, &mut scratch.sums, &corners[0][at..], forces[0]);
                at += f32::width::<S>();
            }
        }
        for (force, sum) in self.forces.iter_mut().zip(scratch.sums.iter()) {
            force.copy_from_slice(&sum[..3]);
        }
    }
}

/// With the edges e of the rest shape as rows, cof e has the gradients of nodes 1 to 3 times det e = 6V as rows.
#[inline(always)]
fn by_places<R: Real, L: Elastic<R>>(law: &L, edges: &[[R; 3]; 3], e: &[[R; 3]; 3], forces: &mut [[R; 3]; 4]) {
    let one = e[0][0].constant(1.0);
    let cofactor = [
        [
            minor(e[1][1], e[1][2], e[2][1], e[2][2]),
            minor(e[1][2], e[1][0], e[2][2], e[2][0]),
            minor(e[1][0], e[1][1], e[2][0], e[2][1]),
        ],
        [
            minor(e[0][2], e[0][1], e[2][2], e[2][1]),
            minor(e[0][0], e[0][2], e[2][0], e[2][2]),
            minor(e[0][1], e[0][0], e[2][1], e[2][0]),
        ],
        [
            minor(e[0][1], e[0][2], e[1][1], e[1][2]),
            minor(e[0][2], e[0][0], e[1][2], e[1][0]),
            minor(e[0][0], e[0][1], e[1][0], e[1][1]),
        ],
    ];
    let inverse = one / dot(e[0], cofactor[0]);
    let mut gradient = Mat3::zero(one);
    for i in 0..3 {
        (0..3).for_each(
            #[inline(always)]
            |a| gradient.add_to_row(i, edges[a][i], cofactor[a]),
        );
    }
    let (stress, _) = law.direct_stress(&gradient.scaled(inverse), None, None);
    let stress = stress.scaled(one.constant(1.0 / 6.0));
    for i in 0..3 {
        let mut sum = one.constant(0.0);
        for a in 0..3 {
            let force = dot(stress.0[i], cofactor[a]);
            sum += force;
            forces[a + 1][i] = force;
        }
        forces[0][i] = -sum;
    }
}

fn main() {
    let one = template();
    let nodes = one.places.len();
    let arch = pulp::Arch::new();
    let law = NeoHookean { shear: 1000.0_f32, bulk: 10000.0 };
    for patches in [6, 46, 160, 1300, 4900] {
        let corners: Vec<[u16; LANES]> = one.corners.iter().cycle().take(4 * GROUPS * patches).copied().collect();
        let shapes: Vec<[f32; LANES]> = one.shapes.iter().cycle().take(10 * GROUPS * patches).copied().collect();
        let places: Vec<[f32; 3]> = one.places.iter().cycle().take(nodes * patches).copied().collect();
        let u: Vec<[f32; 3]> = places.iter().map(|x| [0.1 * x[1], 0.05 * x[0] + 0.02 * x[2], -0.03 * x[2]]).collect();
        let mut forces = [vec![[0.0_f32; 3]; u.len()], vec![[0.0; 3]; u.len()]];
        for threads in [1, 2] {
            let of_thread = patches / threads;
            let mut best = [f64::INFINITY; 2];
            for _ in 0..(30_000 / patches).clamp(8, 400) {
                for way in 0..2 {
                    let started = Instant::now();
                    std::thread::scope(|scope| {
                        for (thread, forces) in forces[way].chunks_mut(of_thread * nodes).enumerate() {
                            let (corners, shapes, places, u) = (&corners, &shapes, &places, &u);
                            let mut work = move || {
                                let (mut scratch, mut at_rest) = (Scratch::default(), Scratch::<f32>::default());
                                for (patch, forces) in forces.chunks_mut(nodes).enumerate() {
                                    let patch = thread * of_thread + patch;
                                    arch.dispatch(Patch {
                                        corners: &corners[4 * GROUPS * patch..][..4 * GROUPS],
                                        shapes: &shapes[10 * GROUPS * patch..][..10 * GROUPS],
                                        places: &places[nodes * patch..][..nodes],
                                        u: &u[nodes * patch..][..nodes],
                                        forces,
                                        scratch: &mut scratch,
                                        at_rest: &mut at_rest.read,
                                        law,
                                        recomputed: way == 1,
                                    });
                                }
                            };
                            if threads == 1 { work() } else { drop(scope.spawn(work)) }
                        }
                    });
                    best[way] = best[way].min(started.elapsed().as_secs_f64());
                }
            }
            let [stored, recomputed] = best.map(|time| time * 1e9 / (patches * GROUPS * LANES) as f64);
            println!(
                "{} tetrahedra, {threads} threads: {stored:.2} ns with rest shapes from memory, {recomputed:.2} recomputed",
                patches * GROUPS * LANES
            );
        }
        let [stored, recomputed] = &forces;
        let pairs = stored.as_flattened().iter().zip(recomputed.as_flattened());
        let apart = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        let largest = stored.as_flattened().iter().fold(0.0_f32, |largest, x| largest.max(x.abs()));
        assert!(apart < 1e-5 * largest, "{apart:e} of {largest:e}");
    }
}
