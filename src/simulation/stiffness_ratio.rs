//! How much stiffer a law can have become, by how far it is deformed: what makes frequencies rise during a run.
//!
//! In total Lagrangian form an element's gradients and volume stay those at rest, so all that can raise its frequencies
//! is the tangent ∂P/∂F of its law. For a deformation of the size s = max(tr C, tr C⁻¹, tr cof C)/3 the table holds the
//! largest eigenvalue of ∂P/∂F that was met at smaller or equal sizes among [`samples`], over that at rest: of the
//! whole, of the volumetric part, and of the isochoric part along changes that keep the volume (across F⁻ᵀ), whichever
//! has grown most. Elements that average the pressure feel these parts to different shares.
//!
//! That bounds an element's own frequency, where it is as long one way as another. The highest of all bodies, and that
//! of an element along its shortest way, may rise more, because what was not the stiffest change of F at rest may
//! become it: a plane wave, which changes F by a⊗b. Along a⊗b J is linear, so that of U(J) the wave feels U″ (a · cof F
//! b)², at most U″ times the largest eigenvalue of cof C = J² C⁻¹: λ⁻² across what is squeezed to λ at constant volume,
//! and more by J² where the volume has grown, as it does in what is drawn out. (Drawn out by 1.9, held across and free
//! in height, neo-Hookean tissue of ν = .3 has λ = .71 and J = 1.34: ω² is 3.50 times that at rest, λ⁻² is 2.0.) What
//! isochoric energies add grows faster than that, of a neo-Hookean one it is μ J^(−2/3) (5/9 tr C λ⁻² − 1/3). So there
//! is a second table: the largest (a⊗b) : ∂P/∂F : (a⊗b) along the axes, over that at rest, by the largest eigenvalue of
//! C⁻¹, or of cof C where that is larger, from stretches at constant volume and such as make it grow. What is pulled
//! without being squeezed as much counts by its size: St. Venant and Kirchhoff's law is quicker along a stretch.
//!
//! Exponential fibres stiffen by so much more that what they add is computed along their own directions.

mod table;

use crate::backend::cpu::{BlockLaw, LawParameters, sizes, with_identity};
use crate::components::FamilyDirection;
use crate::materials::{Elastic, ExponentialFibre};
use crate::math::Mat3;
use std::collections::BTreeSet;
use table::Table;

/// Stretches that laws are tried at: each so many times the one before.
const STRETCH_RATIO: f64 = 1.106;
/// How many of them: up to a thousand.
const STRETCHES: usize = 69;
/// Beyond all that was tried ω² is taken to grow with the square of the size, up to this.
const LARGEST_RATIO: f64 = 1e30;
/// Components of ∇u are changed by so much for a difference.
const CHANGE: f64 = 1e-6;
/// Multiplications by which the largest eigenvalue of a tangent is found, to a per mille where it stands out.
const MULTIPLICATIONS: usize = 40;

/// Stiffness ratio of ω² of a law, by how far it is deformed.
#[derive(Clone, Debug)]
pub(super) struct StiffnessRatio {
    /// The law without its exponential fibres, and what [`tangents`] gives of it at rest (Pa): of a body whose copies
    /// differ, those of its [`extremes`].
    laws: Vec<(BlockLaw<f64>, [f64; 4])>,
    /// Whether the law ends at J = 0: see [`StrainColumns`](crate::backend::cpu::StrainColumns).
    pub ends: bool,
    /// How many of the stretches it was tried at; what was not is not needed yet.
    tried: usize,
    /// By size, of an element alone.
    own: Table,
    /// By squeeze, of plane waves.
    waves: Table,
    /// By size, of plane waves in what is pulled.
    pulled: Table,
    /// Exponential fibres, and where they have their directions from.
    pub families: Vec<(ExponentialFibre<f64>, FamilyDirection<f64>)>,
    /// Families whose directions differ from element to element, quadratic ones included.
    pub varying: usize,
}

impl StiffnessRatio {
    /// Of a law.
    pub fn of(law: &BlockLaw<f64>) -> Self {
        let varying = law.varying_families();
        let alone = law.fibres.is_none() && law.exponential.is_empty() && law.prony.is_empty();
        let ends = !alone || law.elastic.ends_at_no_volume();
        let families = stiffest_families(law);
        let at_rest = |mut law: BlockLaw<f64>| {
            let rest = tangents(&law, &[1.0; 3]);
            law.exponential.clear();
            (law, rest)
        };
        let laws = extremes(law).into_iter().map(at_rest).collect();
        let [own, waves, pulled] = [(); 3].map(|()| Table::new());
        let mut new = Self { laws, ends, tried: 0, own, waves, pulled, families, varying };
        // what is pressed flat or through itself is no limit there
        for stretch in FLAT.into_iter().filter(|_| !ends) {
            for (kind, stretches) in [[stretch, 1.0, 1.0], [1.0, stretch, 1.0]].into_iter().enumerate() {
                let [size, own, waves] = new.tried_at(stretches);
                new.own.add(SAMPLES + kind, (size, own));
                new.waves.add(SAMPLES + kind, (size, waves));
            }
        }
        new.own.sort();
        new.waves.sort();
        new
    }

    /// Tries the law at all stretches up to a size and a squeeze (see [`Strain`](crate::backend::cpu::Strain)): before
    /// [`StiffnessRatio::own`] or [`StiffnessRatio::of_all`] is asked for that.
    pub fn reach(&mut self, size: f64, squeeze: f64) {
        let before = self.tried;
        let mut s = STRETCH_RATIO.powi(self.tried as i32);
        // the least size of samples of a stretch s is (s² + 2/s)/3; one more, so that all up to this are between two
        while self.tried < STRETCHES && ((s * s + 2.0 / s) / 3.0 <= size || s * s <= squeeze) {
            self.tried += 1;
            s = STRETCH_RATIO.powi(self.tried as i32);
            // those of one direction alone are small by the measure of a law that does not end: they have been tried
            let count = if self.ends { SAMPLES } else { SAMPLES - ALONE };
            let found = samples(s).map(|stretches| self.tried_at(stretches));
            let found = &found[..count];
            if found.iter().flatten().any(|number| !number.is_finite()) {
                // where numbers end there is nothing to try
                self.tried = STRETCHES;
                break;
            }
            for (kind, &[size, own, waves]) in found.iter().enumerate() {
                self.own.add(kind, (size, own));
                // those that are pulled are squeezed less, and stiffer for another reason
                if kind < PULLED {
                    self.pulled.add(kind, (size, waves));
                } else {
                    self.waves.add(kind, (s * s, waves));
                }
            }
        }
        if self.tried > before {
            [&mut self.own, &mut self.waves, &mut self.pulled].into_iter().for_each(Table::sort);
        }
    }

    /// Size of a sample, and the ratio of an element alone and of plane waves.
    fn tried_at(&self, stretches: [f64; 3]) -> [f64; 3] {
        let mut gradient = Mat3::zero(0.0);
        (0..3).for_each(|i| gradient.0[i][i] = stretches[i] - 1.0);
        let [first, inverse, _] = sizes(&with_identity(&gradient), self.ends);
        // max forgets what is no number
        let larger = |most: f64, ratio: f64| if ratio.is_nan() || most.is_nan() { f64::NAN } else { most.max(ratio) };
        let [mut own, mut waves] = [0.0; 2];
        for (law, rest) in &self.laws {
            let found = tangents(law, &stretches);
            let ratio = |i: usize| if rest[i] > 0.0 { found[i] / rest[i] } else { 1.0 };
            own = (0..3).map(ratio).fold(own, larger);
            waves = larger(waves, ratio(3));
        }
        [first.max(inverse), own, waves]
    }

    /// Stiffness ratio of an element's own ω² at most without exponential fibres, for a size within
    /// [`StiffnessRatio::reach`].
    pub fn own(&self, size: f64) -> f64 {
        self.own.at(size)
    }

    /// The same of ω² of all bodies, for a size and a squeeze.
    pub fn of_all(&self, size: f64, squeeze: f64) -> f64 {
        self.own.at(size).max(self.pulled.at(size)).max(self.waves.at(squeeze))
    }

    /// Up to which size and which squeeze no element's own ω² grows beyond `own`, and that of all not beyond `of_all`,
    /// without exponential fibres.
    pub fn until(&self, own: f64, of_all: f64) -> [f64; 2] {
        [self.own.until(own.min(of_all)).min(self.pulled.until(of_all)), self.waves.until(of_all)]
    }

    /// What a family of exponential fibres adds to the ratio, for a C and its direction: k₁ e^x (4 (1 + 2x) M + 2Ē)
    /// with x = k₂Ē² and M = κ_d tr C + (1 − 3κ_d) I₄, which bounds its part of ∂P/∂F, over the isochoric part at rest.
    pub fn of_family(&self, family: &ExponentialFibre<f64>, c: [f64; 6], [x, y, z]: [f64; 3]) -> f64 {
        let along = c[0] * x * x + c[1] * y * y + c[2] * z * z + 2.0 * (c[3] * x * y + c[4] * y * z + c[5] * x * z);
        let trace = c[0] + c[1] + c[2];
        let measure = family.dispersion * trace + (1.0 - 3.0 * family.dispersion) * along;
        let strain = (measure - 1.0).max(0.0);
        let exponent = (family.k2 * strain * strain).min(40.0);
        let tangent = family.k1 * exponent.exp() * (4.0 * (1.0 + 2.0 * exponent) * measure + 2.0 * strain);
        // at rest it is part of what the ratio is measured by
        let softest = self.laws.iter().map(|(_, rest)| rest[0]).fold(f64::INFINITY, f64::min);
        ((tangent - 4.0 * family.k1) / softest).max(0.0)
    }
}

/// Laws of which one is taken to stiffen most, of all copies: those in which a number, by itself or over the shear
/// modulus at small strains, is the least or the largest. Without copies the law itself.
fn extremes(law: &BlockLaw<f64>) -> Vec<BlockLaw<f64>> {
    let Some(copies) = &law.copies else { return vec![law.clone()] };
    let numbers = |copy: usize| {
        let of_copy = &copies.of_copy[copy];
        let shear = of_copy.elastic.small_strain_moduli()[0];
        of_copy
            .numbers()
            .into_iter()
            .take(copies.of_law)
            .flat_map(|number| [number, number / shear])
            .collect::<Vec<f64>>()
    };
    let of_each: Vec<Vec<f64>> = (0..copies.of_copy.len()).map(numbers).collect();
    let mut chosen = BTreeSet::new();
    for k in 0..of_each.first().map_or(0, Vec::len) {
        let by = |a: &usize, b: &usize| of_each[*a][k].total_cmp(&of_each[*b][k]);
        chosen.extend((0..of_each.len()).min_by(by));
        chosen.extend((0..of_each.len()).max_by(by));
    }
    let of_copy = |copy: usize| {
        let LawParameters { elastic, fibres, exponential, .. } = copies.of_copy[copy].clone();
        let directions = law.exponential.iter().map(|(_, from)| *from);
        BlockLaw {
            elastic,
            fibres: fibres.zip(law.fibres.as_ref().map(|(_, from)| *from)),
            exponential: exponential.into_iter().zip(directions).collect(),
            copies: None,
            ..law.clone()
        }
    };
    chosen.into_iter().map(of_copy).collect()
}

/// The families of exponential fibres, each with the largest k₁ and k₂ of all copies.
fn stiffest_families(law: &BlockLaw<f64>) -> Vec<(ExponentialFibre<f64>, FamilyDirection<f64>)> {
    let mut families = law.exponential.clone();
    for of_copy in law.copies.iter().flat_map(|copies| &copies.of_copy) {
        for ((family, _), of_copy) in families.iter_mut().zip(&of_copy.exponential) {
            (family.k1, family.k2) = (family.k1.max(of_copy.k1), family.k2.max(of_copy.k2));
        }
    }
    families
}

/// How many samples there are of a stretch; the first of them are pulled, the others squeezed, or have a cof C as if
/// they were, the last in one direction alone.
const SAMPLES: usize = 14;
const PULLED: usize = 2;
const ALONE: usize = 2;
/// Stretches in one direction alone at which laws that do not end at J = 0 are tried.
const FLAT: [f64; 9] = [0.8, 0.6, 0.4, 0.2, 0.1, 0.0, -0.2, -0.5, -1.0];

/// Principal stretches that are tried: of constant volume pulled, squeezed and sheared, along the fibres and across, of
/// a volume that has grown, and of one direction alone. Of all but those that are pulled the largest eigenvalue of C⁻¹,
/// or of cof C where that is larger, is s².
fn samples(s: f64) -> [[f64; 3]; SAMPLES] {
    let (r, root) = (1.0 / s, s.sqrt());
    let thin = 1.0 / root;
    [
        [s, thin, thin],
        [thin, s, thin],
        [r, root, root],
        [root, r, root],
        [s, r, 1.0],
        [r, s, 1.0],
        [1.0, s, r],
        [s, 1.0, 1.0],
        [1.0, s, 1.0],
        [root, root, 1.0],
        [1.0, root, root],
        [root, root, root],
        [r, 1.0, 1.0],
        [1.0, r, 1.0],
    ]
}

/// The largest eigenvalues (Pa) of ∂P/∂F for F with these diagonals and fibres along x: of the isochoric stress along
/// changes that keep the volume, of the volumetric stress, and of both together; then the largest (a⊗b) : ∂P/∂F : (a⊗b)
/// along the axes.
fn tangents(law: &BlockLaw<f64>, stretches: &[f64; 3]) -> [f64; 4] {
    let mut gradient = Mat3::zero(0.0);
    (0..3).for_each(|i| gradient.0[i][i] = stretches[i] - 1.0);
    let stresses = |gradient: &Mat3<f64>| {
        let k = law.elastic.kinematics(gradient);
        let mut isochoric = law.elastic.isochoric(&k);
        let along = [1.0, 0.0, 0.0];
        if let Some((fibres, _)) = &law.fibres {
            isochoric = isochoric.plus(&fibres.isochoric(&k, along));
        }
        for (family, _) in &law.exponential {
            isochoric = isochoric.plus(&family.isochoric(&k, along));
        }
        let pressure = law.elastic.pressure(law.elastic.volume_measure(&k));
        let without = law.elastic.first_stress(gradient, &k, &isochoric, 0.0);
        let mut volumetric = law.elastic.first_stress(gradient, &k, &isochoric, pressure);
        for (row, less) in volumetric.0.iter_mut().zip(&without.0) {
            row.iter_mut().zip(less).for_each(|(x, less)| *x -= less);
        }
        [without, volumetric]
    };
    let before = stresses(&gradient);
    let mut tangents = [[[0.0; 9]; 9]; 2];
    for column in 0..9 {
        let mut moved = gradient;
        moved.0[column / 3][column % 3] += CHANGE;
        let after = stresses(&moved);
        for part in 0..2 {
            for row in 0..9 {
                let [a, b] = [&after, &before].map(|all| all[part].0[row / 3][row % 3]);
                tangents[part][row][column] = (a - b) / CHANGE;
            }
        }
    }
    let [isochoric, volumetric] = tangents;
    let whole: [[f64; 9]; 9] = std::array::from_fn(|i| std::array::from_fn(|j| isochoric[i][j] + volumetric[i][j]));
    let keeping = across(&isochoric, stretches);
    let wave = (0..9).fold(0.0_f64, |most, i| most.max(whole[i][i]));
    [largest_eigenvalue(&keeping), largest_eigenvalue(&volumetric), largest_eigenvalue(&whole), wave]
}

/// A tangent along changes of F across F⁻ᵀ: (1 − n nᵀ) A (1 − n nᵀ).
fn across(a: &[[f64; 9]; 9], stretches: &[f64; 3]) -> [[f64; 9]; 9] {
    let mut n = [0.0; 9];
    (0..3).for_each(|i| n[4 * i] = 1.0 / stretches[i]);
    let length = n.iter().map(|n| n * n).sum::<f64>().sqrt();
    let onto: [[f64; 9]; 9] =
        std::array::from_fn(|i| std::array::from_fn(|j| f64::from(u8::from(i == j)) - n[i] * n[j] / (length * length)));
    let times = |x: &[[f64; 9]; 9], y: &[[f64; 9]; 9]| -> [[f64; 9]; 9] {
        std::array::from_fn(|i| std::array::from_fn(|j| (0..9).map(|k| x[i][k] * y[k][j]).sum()))
    };
    times(&times(&onto, a), &onto)
}

/// The largest magnitude of an eigenvalue, by the power method.
fn largest_eigenvalue(a: &[[f64; 9]; 9]) -> f64 {
    // a start that has a part of every symmetric and skew pattern
    let mut x: [f64; 9] = std::array::from_fn(|i| 1.0 + 0.37 * (i as f64 * 1.7).sin());
    let mut length = 0.0;
    for _ in 0..MULTIPLICATIONS {
        let y: [f64; 9] = std::array::from_fn(|i| (0..9).map(|j| a[i][j] * x[j]).sum());
        length = y.iter().map(|y| y * y).sum::<f64>().sqrt();
        if !(length > 0.0 && length.is_finite()) {
            return length;
        }
        x = y.map(|y| y / length);
    }
    length
}

#[cfg(test)]
mod tests;
