//! How far the elements of a block are deformed, and how fast; a register full at a time. The stable step is followed
//! by it.

use super::Cpu;
use super::element_kernel::{corner_registers, group_vectors};
use crate::elements::{Element, MOST_NODES};
use crate::math::{LANES, Mat3, Real, SimdScalar};
use pulp::{Simd, WithSimd};
use std::marker::PhantomData;
use std::ops::Range;

/// The columns that strains are taken from; layouts as in [`components`](crate::components).
pub struct StrainColumns<'a, T> {
    /// The body's displacements (m).
    pub displacement: &'a [T],
    /// Their change in the last step (m).
    pub step: &'a [T],
    /// Nodes of each element.
    pub connectivity: &'a [u32],
    /// Rest shapes.
    pub rest_shape: &'a [T],
    /// Whether the law ends at J = 0, so that it pushes without bound where C is nearly singular: else what is said of
    /// C⁻¹ is of cof C = J² C⁻¹ whatever J, and is 1 + (1 − J)² at least.
    pub ends: bool,
}

/// An element's deformation; the largest of its integration points. C⁻¹ stands for max(1, J²) C⁻¹, that is for the
/// larger one of C⁻¹ and cof C: waves through what is drawn out, which gains volume, are as quick as cof C says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Strain {
    /// Row of the element.
    pub row: usize,
    /// max(tr C, tr C⁻¹)/3: 1 at rest; infinite for what is flat, or no number.
    pub size: f64,
    /// At least the largest eigenvalue of C⁻¹, at constant volume the inverse square of the least stretch, and no more
    /// than that where one axis is squeezed: tr C⁻¹/3 + √(2/3 D : D) with its deviator D; infinite for what is flat, or
    /// no number.
    pub squeeze: f64,
    /// √(ΔE : ΔE) times [`squeeze`](Self::squeeze), with the change ΔE of Green's strain in a step: at least the change
    /// of a length over that length; infinite for what is no number.
    pub speed: f64,
    /// √(ΔE : ΔE) tr C⁻¹/3: the same over all axes; infinite for what is no number.
    pub mean_speed: f64,
    /// What was asked for of its C.
    pub more: f64,
}

impl Strain {
    /// Of what is not deformed.
    const AT_REST: Self = Self { row: 0, size: 1.0, squeeze: 1.0, speed: 0.0, mean_speed: 0.0, more: 0.0 };
}

/// What is asked for beside: a number from an element's row and its C (xx, yy, zz, xy, yz, xz).
pub type OfStretch<'a> = &'a (dyn Fn(usize, [f64; 6]) -> f64 + Sync);

/// Takes some elements at a time.
pub type Visit<'a> = &'a mut dyn FnMut(&[Strain]);

/// Where the size and the squeeze of each element of some groups are kept, row after row from the first: 0 of what is
/// not there, no number where one is none. What more is asked for is kept where that is asked for.
pub struct Kept<'a, T> {
    /// [`Strain::size`] of each.
    pub size: &'a mut [T],
    /// [`Strain::squeeze`] of each.
    pub squeeze: &'a mut [T],
    /// [`Strain::more`] of each.
    pub more: &'a mut [f64],
}

/// Visits the elements of some groups that are there, in their order, some at a time, and keeps what they come to where
/// that is wanted. What they come to, were one of them the largest in everything (its row says nothing), and how many
/// they are.
pub fn strains<E: Element, T: SimdScalar>(
    cpu: &Cpu,
    columns: &StrainColumns<'_, T>,
    groups: Range<usize>,
    more: Option<OfStretch<'_>>,
    visit: Option<Visit<'_>>,
    kept: Option<Kept<'_, T>>,
) -> (Strain, usize) {
    cpu.dispatch(Groups::<E, T> { columns, groups, more, visit, kept, element: PhantomData })
}

struct Groups<'a, 'v, 'k, E, T> {
    columns: &'a StrainColumns<'a, T>,
    groups: Range<usize>,
    more: Option<OfStretch<'a>>,
    visit: Option<Visit<'v>>,
    kept: Option<Kept<'k, T>>,
    element: PhantomData<E>,
}

impl<E: Element, T: SimdScalar> WithSimd for Groups<'_, '_, '_, E, T> {
    type Output = (Strain, usize);

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        let Self { columns, groups, more, mut visit, mut kept, .. } = self;
        let first = groups.start;
        let (zero, one) = (T::splat(simd, T::default()), T::splat(simd, T::from_f64(1.0)));
        // size, squeeze, both speeds, what is no number, and how many are there
        let mut widest = [one, one, zero, zero, zero, zero];
        let mut more_of_all = 0.0_f64;
        for group in groups {
            let nodes = &columns.connectivity[group * E::NODES * LANES..(group + 1) * E::NODES * LANES];
            let shape = &columns.rest_shape[group * E::ROWS * LANES..(group + 1) * E::ROWS * LANES];
            let u = group_vectors::<E, T>(nodes, columns.displacement);
            let d = group_vectors::<E, T>(nodes, columns.step);
            let (mut lanes, mut largest) = ([[T::default(); LANES]; 5], [0.0_f64; LANES]);
            let mut at = 0;
            while at < LANES {
                let rows = more.map(|more| (more, group * LANES + at, &mut largest[at..]));
                let found = register::<E, T, S>(simd, [&u, &d], (shape, columns.ends), at, rows);
                let volume = T::load(simd, &shape[E::VOLUME_ROW * LANES + at..]);
                widest[0] = widest[0].max(volume.if_positive(found[0], one));
                widest[1] = widest[1].max(volume.if_positive(found[1], one));
                widest[2] = widest[2].max(volume.if_positive(found[2], zero));
                widest[3] = widest[3].max(volume.if_positive(found[3], zero));
                widest[4] += volume.if_positive(found[4], zero);
                widest[5] += volume.if_positive(one, zero);
                if visit.is_some() {
                    (0..5).for_each(|i| T::store(found[i], &mut lanes[i][at..]));
                }
                if let Some(kept) = &mut kept {
                    let row = (group - first) * LANES + at;
                    T::store(volume.if_positive(found[0] + found[4], zero), &mut kept.size[row..]);
                    T::store(volume.if_positive(found[1] + found[4], zero), &mut kept.squeeze[row..]);
                }
                at += T::width::<S>();
            }
            if visit.is_none() && more.is_none() {
                continue;
            }
            if let Some(kept) = &mut kept {
                let row = (group - first) * LANES;
                kept.more[row..row + LANES].copy_from_slice(&largest);
            }
            let mut found = [Strain::AT_REST; LANES];
            let mut count = 0;
            for lane in (0..LANES).filter(|lane| shape[E::VOLUME_ROW * LANES + lane] > T::default()) {
                let [size, squeeze, speed, mean_speed] = sound(lanes.map(|of| of[lane]));
                found[count] =
                    Strain { row: group * LANES + lane, size, squeeze, speed, mean_speed, more: largest[lane] };
                more_of_all = more_of_all.max(largest[lane]);
                count += 1;
            }
            if let Some(visit) = &mut visit {
                visit(&found[..count]);
            }
        }
        let mut all = Strain { more: more_of_all, ..Strain::AT_REST };
        let mut count = 0.0;
        let mut lanes = [[T::default(); LANES]; 6];
        (0..6).for_each(|i| T::store(widest[i], &mut lanes[i]));
        for lane in 0..T::width::<S>() {
            let [size, squeeze, speed, mean_speed] = sound([0, 1, 2, 3, 4].map(|i: usize| lanes[i][lane]));
            all.size = all.size.max(size);
            all.squeeze = all.squeeze.max(squeeze);
            all.speed = all.speed.max(speed);
            all.mean_speed = all.mean_speed.max(mean_speed);
            count += lanes[5][lane].to_f64();
        }
        (all, count as usize)
    }
}

/// Size, squeeze and both speeds; infinite where they are no numbers.
fn sound<T: SimdScalar>([size, squeeze, speed, mean_speed, non_finite]: [T; 5]) -> [f64; 4] {
    let number = |of: T| if non_finite == T::default() { of.to_f64() } else { f64::INFINITY };
    [size, squeeze, speed, mean_speed].map(number)
}

/// Size, squeeze and both speeds of a register full of elements, and what is not 0 where either is no number. `rows`:
/// what more is asked for, of which row on, and where it goes.
#[inline(always)]
fn register<E: Element, T: SimdScalar, S: Simd>(
    simd: S,
    [u, d]: [&[[[T; LANES]; 3]; MOST_NODES]; 2],
    (shape, ends): (&[T], bool),
    at: usize,
    mut rows: Option<(OfStretch<'_>, usize, &mut [f64])>,
) -> [T::Vector<S>; 5] {
    let u = E::prepare(&corner_registers::<E, T, S>(simd, u, at));
    let d = E::prepare(&corner_registers::<E, T, S>(simd, d, at));
    let zero = T::splat(simd, T::default());
    let (mut size, mut squeeze, mut speed, mut mean_speed, mut non_finite) = (zero, zero, zero, zero, zero);
    for point in 0..E::POINTS {
        let state = E::at_point(
            &u,
            point,
            #[inline(always)]
            |row: usize| T::load(simd, &shape[row * LANES + at..]),
        );
        let change = E::at_point(
            &d,
            point,
            #[inline(always)]
            |row: usize| T::load(simd, &shape[row * LANES + at..]),
        );
        let f = with_identity(&state.gradient);
        if let Some((more, row, largest)) = &mut rows {
            let c = right_cauchy_green(&f);
            let mut lanes = [[T::default(); LANES]; 6];
            for i in 0..6 {
                T::store(c[i], &mut lanes[i]);
            }
            for lane in 0..T::width::<S>() {
                let c = [0, 1, 2, 3, 4, 5].map(|i: usize| lanes[i][lane].to_f64());
                largest[lane] = largest[lane].max(more(*row + lane, c));
            }
        }
        let [first, inverse, squeezed] = sizes(&f, ends);
        let change = change_of_strain(&f, &change.gradient).sqrt();
        size = size.max(first.max(inverse));
        squeeze = squeeze.max(squeezed);
        speed = speed.max(change * squeezed);
        mean_speed = mean_speed.max(change * inverse);
        // what is no number, or infinite, stays none
        non_finite += (inverse + change * squeezed) * zero;
    }
    [size, squeeze, speed, mean_speed, non_finite]
}

/// F = I + ∇u.
#[inline(always)]
pub(crate) fn with_identity<R: Real>(gradient: &Mat3<R>) -> [[R; 3]; 3] {
    let mut f = gradient.0;
    for i in 0..3 {
        f[i][i] += f[i][i].constant(1.0);
    }
    f
}

/// tr C/3, tr C⁻¹/3 and a bound of the largest eigenvalue of C⁻¹ (see [`Strain::squeeze`]), C⁻¹ times max(1, J²): |F|²,
/// and cof F over min(1, J), which lose no digits where C is nearly singular. Where a law does not end at J = 0, of cof
/// C in place of C⁻¹, and 1 + (1 − J)² at least.
#[inline(always)]
pub(crate) fn sizes<R: Real>(f: &[[R; 3]; 3], ends: bool) -> [R; 3] {
    let third = f[0][0].constant(1.0 / 3.0);
    let zero = f[0][0].constant(0.0);
    let (mut first, mut j) = (zero, zero);
    let mut cofactors = [[zero; 3]; 3];
    for a in 0..3 {
        let (b, c) = ((a + 1) % 3, (a + 2) % 3);
        for i in 0..3 {
            let (k, l) = ((i + 1) % 3, (i + 2) % 3);
            cofactors[a][i] = f[b][k].mul_add(f[c][l], -(f[b][l] * f[c][k]));
            first = f[a][i].mul_add(f[a][i], first);
            if a == 0 {
                j = f[a][i].mul_add(cofactors[a][i], j);
            }
        }
    }
    // `map` of an array would call a function compiled without wide registers
    let inverse = [
        product(&cofactors, &cofactors, 0, 0),
        product(&cofactors, &cofactors, 1, 1),
        product(&cofactors, &cofactors, 2, 2),
    ];
    let mean = (inverse[0] + inverse[1] + inverse[2]) * third;
    let mut square = zero;
    for i in 0..3 {
        let (along, across) = (inverse[i] - mean, product(&cofactors, &cofactors, i, (i + 1) % 3));
        square = along.mul_add(along, square);
        square = (across + across).mul_add(across, square);
    }
    let one = f[0][0].constant(1.0);
    let (per_square, least) = match ends {
        true => (one / (j * j).min(one), zero),
        false => (one, (one - j).mul_add(one - j, one)),
    };
    let deviator = (square * f[0][0].constant(2.0 / 3.0)).sqrt() * per_square;
    [first * third, (mean * per_square).max(least), (mean * per_square + deviator).max(least)]
}

/// (AᵀB)_ij.
#[inline(always)]
fn product<R: Real>(a: &[[R; 3]; 3], b: &[[R; 3]; 3], i: usize, j: usize) -> R {
    a[2][i].mul_add(b[2][j], a[1][i].mul_add(b[1][j], a[0][i] * b[0][j]))
}

/// C: xx, yy, zz, xy, yz, xz.
#[inline(always)]
fn right_cauchy_green<R: Real>(f: &[[R; 3]; 3]) -> [R; 6] {
    [
        product(f, f, 0, 0),
        product(f, f, 1, 1),
        product(f, f, 2, 2),
        product(f, f, 0, 1),
        product(f, f, 1, 2),
        product(f, f, 0, 2),
    ]
}

/// ΔE : ΔE with ΔE = sym(Fᵀ Δ∇u): turning is none.
#[inline(always)]
fn change_of_strain<R: Real>(f: &[[R; 3]; 3], change: &Mat3<R>) -> R {
    let mut square = f[0][0].constant(0.0);
    for i in 0..3 {
        let j = (i + 1) % 3;
        let along = product(f, &change.0, i, i);
        let shear = product(f, &change.0, i, j) + product(f, &change.0, j, i);
        square = along.mul_add(along, square);
        square = (shear * shear).mul_add(shear.constant(0.5), square);
    }
    square
}

#[cfg(test)]
mod tests;
