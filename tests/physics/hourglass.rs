//! Hourglass control of the one-point hexahedron.
//!
//! f = k Σ γ γᵀ u, energy ½ k Σ |γᵀu|². None for any homogeneous F, turned with the body, and so scaled that bending is
//! right at every Poisson's ratio: tip deflection over Timoshenko's for 1 | 2 | 4 elements through the thickness of a
//! cantilever ten times as long as thick (square section, cubes).

use crate::elements::{YOUNG, corners, displacements, distorted};
use crate::random::Random;
use glam::DVec3;
use sinew::elements::{Element, Hex8, Hex8MeanDilatation, MOST_NODES, Parallelepiped};
use sinew::math::Mat3;
use sinew::mesh::ElementKind;

type Nodal = [[f64; 3]; MOST_NODES];

/// Hourglass forces alone: without stress there is nothing else.
fn control(points: &[DVec3], u: &Nodal) -> (Nodal, f64) {
    let shape = Hex8::rest_shape(points, YOUNG);
    let u = Hex8::prepare(u);
    let gradient = Hex8::at_point(&u, 0, |k| shape[k]).gradient;
    let mut forces = [[0.0; 3]; MOST_NODES];
    let sums = [gradient, Mat3([[0.0; 3]; 3])];
    Hex8::store_forces(&u, &sums, |k| shape[k], |corner, i, force| forces[corner][i] = force);
    (forces, Hex8::hourglass_energy(&u, &gradient, |k| shape[k]))
}

fn largest(forces: &Nodal) -> f64 {
    forces.iter().flatten().fold(0.0, |largest, x| largest.max(x.abs()))
}

#[test]
fn homogeneous_deformation_of_a_distorted_hexahedron_needs_no_control() {
    let mut random = Random(21);
    for _ in 0..100 {
        let (points, f) = (distorted(ElementKind::Hex8, &mut random), random.deformation());
        let (forces, energy) = control(&points, &displacements(&points, |x| f * x - x));
        // E V Σ(b·b)/72 = 1e2 N/m times rounding of sums of 8 displacements of size 2
        assert!(largest(&forces) < 1e-11 && energy < 1e-25, "{forces:?}, {energy:e} J");
    }
}

#[test]
fn control_turns_with_the_body_and_stores_its_energy() {
    let mut random = Random(22);
    for _ in 0..100 {
        let (points, q) = (distorted(ElementKind::Hex8, &mut random), random.rotation());
        let mut u = [[0.0; 3]; MOST_NODES];
        u.iter_mut().for_each(|u| *u = (random.vector() * 0.3).to_array());
        let mut turned = u;
        for (turned, (&x, u)) in turned.iter_mut().zip(points.iter().zip(&u)) {
            *turned = (q * (x + DVec3::from_array(*u)) - x).to_array();
        }
        let ((plain, energy), (moved, turned_energy)) = (control(&points, &u), control(&points, &turned));
        for (plain, moved) in plain.iter().zip(&moved) {
            assert!((q * DVec3::from_array(*plain) - DVec3::from_array(*moved)).length() < 1e-11);
        }
        let work: f64 = plain.iter().flatten().zip(u.iter().flatten()).map(|(f, u)| 0.5 * f * u).sum();
        assert!(energy > 0.0 && (work / energy - 1.0).abs() < 1e-12, "{work} J of {energy} J");
        assert!((turned_energy / energy - 1.0).abs() < 1e-12);
    }
}

/// V b_a = ∂V/∂X_a, and V is linear in each corner: a difference over a whole edge has no error but rounding, some
/// 1e-15 of sums of 8 products below 4.
#[test]
fn mean_gradients_are_those_of_the_volume() {
    let mut random = Random(23);
    for _ in 0..100 {
        let points = distorted(ElementKind::Hex8, &mut random);
        let shape = Hex8::rest_shape(&points, YOUNG);
        for (a, axis) in (0..8).flat_map(|a| (0..3).map(move |axis| (a, axis))) {
            let mut u = [[0.0; 3]; MOST_NODES];
            u[a][0] = 1.0;
            let b = Hex8::at_point(&Hex8::prepare(&u), 0, |k| shape[k]).gradient.0[0];
            let mut moved = points.clone();
            moved[a][axis] += 1.0;
            let volumes = [&points, &moved].map(|points| Hex8::rest_shape(points, YOUNG)[Hex8::VOLUME_ROW]);
            assert!((b[axis] - (volumes[1] / volumes[0] - 1.0)).abs() < 1e-13);
        }
    }
}

/// What is left out is zero, so that not a bit changes.
#[test]
fn parallelepipeds_need_fewer_rows_and_have_the_same_forces() {
    let mut random = Random(24);
    for _ in 0..100 {
        let (a, shift) = (random.deformation(), random.vector() * 10.0);
        let points: Vec<DVec3> = corners(ElementKind::Hex8).iter().map(|&x| a * x + shift).collect();
        let shape = Hex8::rest_shape(&points, YOUNG);
        assert!(Parallelepiped::describes(&points));
        assert!(!Parallelepiped::describes(&distorted(ElementKind::Hex8, &mut random)));
        let few = Parallelepiped::rest_shape(&points, YOUNG);
        let mut u = [[0.0; 3]; MOST_NODES];
        u.iter_mut().for_each(|u| *u = (random.vector() * 0.3).to_array());
        assert_eq!([Parallelepiped::ROWS, Hex8::ROWS], [11, 32]);
        let read = |k: usize| if k < Parallelepiped::ROWS { few[k] } else { f64::NAN };
        assert_eq!(forces_of::<Hex8>(&u, |k| shape[k]), forces_of::<Parallelepiped>(&u, read));
    }
}

/// The first node balances the others to the bit: rounding that pushes whole elements holds stiff motion awake.
#[test]
fn forces_on_a_hexahedron_add_up_to_nothing() {
    let mut random = Random(25);
    for _ in 0..100 {
        let points = distorted(ElementKind::Hex8, &mut random);
        let mut u = [[0.0; 3]; MOST_NODES];
        u.iter_mut().for_each(|u| *u = (random.vector() * 0.3).to_array());
        let shape = Hex8::rest_shape(&points, YOUNG);
        let cube = Parallelepiped::rest_shape(&corners(ElementKind::Hex8), YOUNG);
        let mean = Hex8MeanDilatation::rest_shape(&points, YOUNG);
        for forces in [
            forces_of::<Hex8>(&u, |k| shape[k]),
            forces_of::<Parallelepiped>(&u, |k| cube[k]),
            forces_of::<Hex8MeanDilatation>(&u, |k| mean[k]),
        ] {
            assert!(largest(&forces) > 0.0);
            (0..3).for_each(|i| assert_eq!(-forces[0][i], forces[1..].iter().map(|f| f[i]).sum::<f64>()));
        }
    }
}

/// Forces of a law that is not symmetric in anything: P = ∇u.
fn forces_of<E: Element>(u: &Nodal, shape: impl Fn(usize) -> f64 + Copy) -> Nodal {
    let u = E::prepare(u);
    let at = E::at_point(&u, 0, shape);
    let mut sums = E::no_forces(0.0);
    E::add_stress(&mut sums, 0, &at, &at.gradient);
    let mut forces = [[0.0; 3]; MOST_NODES];
    E::store_forces(&u, &sums, shape, |corner, i, force| forces[corner][i] = force);
    forces
}

/// A cantilever of linear elasticity, `through` cubes thick and ten times as long.
struct Cantilever {
    through: usize,
    shape: [f64; sinew::elements::MOST_ROWS],
    shear: f64,
    lambda: f64,
}

impl Cantilever {
    fn node(&self, i: usize, j: usize, k: usize) -> usize {
        (i * (self.through + 1) + j) * (self.through + 1) + k
    }

    fn count(&self) -> usize {
        (10 * self.through + 1) * (self.through + 1) * (self.through + 1)
    }

    /// K u, with the clamped end's rows left out.
    fn forces(&self, u: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let n = self.through;
        let mut forces = vec![[0.0; 3]; u.len()];
        for (i, j, k) in (0..10 * n).flat_map(|i| (0..n).flat_map(move |j| (0..n).map(move |k| (i, j, k)))) {
            let nodes = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
                .map(|(x, y, z)| self.node(i + x, j + y, k + z));
            let mut own = [[0.0; 3]; MOST_NODES];
            own.iter_mut().zip(nodes).for_each(|(own, node)| *own = u[node]);
            let local = Hex8::prepare(&own);
            let gradient = Hex8::at_point(&local, 0, |k| self.shape[k]).gradient;
            let h = gradient.0;
            let pressure = self.lambda * (h[0][0] + h[1][1] + h[2][2]);
            let entry = |a: usize, b: usize| self.shear * (h[a][b] + h[b][a]) + if a == b { pressure } else { 0.0 };
            let stress = Mat3([0, 1, 2].map(|a| [0, 1, 2].map(|b| entry(a, b))));
            let sums = [gradient, stress];
            let store = |corner: usize, i: usize, force| forces[nodes[corner]][i] += force;
            Hex8::store_forces(&local, &sums, |k| self.shape[k], store);
        }
        (0..(n + 1) * (n + 1)).for_each(|clamped| forces[clamped] = [0.0; 3]);
        forces
    }

    /// Mean deflection of the tip under a force of 1 N spread over it, by conjugate gradients.
    fn deflection(&self) -> f64 {
        let count = self.count();
        let mut load = vec![[0.0; 3]; count];
        // each tip node bears its share of the area
        for j in 0..=self.through {
            for k in 0..=self.through {
                let weight = |n: usize| if n == 0 || n == self.through { 0.5 } else { 1.0 } / self.through as f64;
                load[self.node(10 * self.through, j, k)][2] = weight(j) * weight(k);
            }
        }
        let dot = |a: &[[f64; 3]], b: &[[f64; 3]]| {
            a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| a * b).sum::<f64>()
        };
        let (mut u, mut residual) = (vec![[0.0; 3]; count], load.clone());
        let mut direction = residual.clone();
        let mut square = dot(&residual, &residual);
        let start = square;
        for _ in 0..5000 {
            let image = self.forces(&direction);
            let step = square / dot(&direction, &image);
            for n in 0..count {
                for i in 0..3 {
                    u[n][i] += step * direction[n][i];
                    residual[n][i] -= step * image[n][i];
                }
            }
            let next = dot(&residual, &residual);
            if next < 1e-16 * start {
                break;
            }
            for n in 0..count {
                for i in 0..3 {
                    direction[n][i] = residual[n][i] + next / square * direction[n][i];
                }
            }
            square = next;
        }
        dot(&u, &load)
    }
}

/// w = F L³/(3 E I) + F L/(k G A), k = 5/6; the figures are those of a static solution in another program, to .01.
#[test]
fn bending_is_right_at_every_poissons_ratio() {
    let expected = [(0.30, [0.996, 0.973, 0.986]), (0.45, [0.996, 0.936, 0.967]), (0.49, [0.996, 0.921, 0.960])];
    let (length, thick) = (0.1_f64, 0.01_f64);
    for (poisson, ratios) in expected {
        let shear = YOUNG / (2.0 * (1.0 + poisson));
        let lambda = 2.0 * shear * poisson / (1.0 - 2.0 * poisson);
        let timoshenko =
            length.powi(3) / (3.0 * YOUNG * thick.powi(4) / 12.0) + length / (5.0 / 6.0 * shear * thick * thick);
        for (through, ratio) in [1, 2, 4].into_iter().zip(ratios) {
            let cube: Vec<DVec3> = corners(ElementKind::Hex8).iter().map(|&x| x * (thick / through as f64)).collect();
            let beam = Cantilever { through, shape: Hex8::rest_shape(&cube, YOUNG), shear, lambda };
            let found = beam.deflection() / timoshenko;
            println!("ν = {poisson}, {through} through: {found:.4}, expected {ratio}");
            assert!((found - ratio).abs() < 0.01, "ν = {poisson}, {through} through: {found} instead of {ratio}");
        }
    }
}
