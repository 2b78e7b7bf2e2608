//! The model of cost: arithmetic counted by numbers that count, bytes from the columns.

use super::{Case, Effects};
use sinew::backend::patch_lists::patch_batches;
use sinew::components::patch_groups;
use sinew::elements::{Element, MOST_NODES, PressureFrom};
use sinew::elements::{ElementTask, node_count, point_count, run_with_element};
use sinew::materials::{Elastic, Fibres, NeoHookean, PronyTerm};
use sinew::math::{LANES, Real, Sym3, Task, refine_inverse_cbrt};
use sinew::mesh::ElementKind;
use sinew::mesh::generators::box_mesh;
use std::cell::Cell;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// What an element and step takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cost {
    /// Floating-point operations of the element kernel; a multiply-add is two.
    pub flops: f64,
    /// Bytes, with each column moved once and nodes counted where they are shared out.
    pub bytes: f64,
}

/// The model for a case with so many elements and nodes.
pub fn cost(case: &Case, elements: u64, nodes: u64) -> Cost {
    let (kind, number) = (case.element, if case.precision == "f64" { 8.0 } else { 4.0 });
    let a_node = nodes as f64 / elements as f64;
    let viscous = matches!(case.effects, Effects::Viscosity | Effects::FibresViscosity);
    let points = point_count(kind) as f64;
    let history = if viscous { 2.0 * 6.0 * points * number } else { 0.0 };
    // steps, displacements and their lost digits read and written, mass read and constraints; apart, forces and loads
    // are written and read, loads also cleared
    let compensated = if case.precision == "f64" { 0.0 } else { 12.0 };
    let forces_of_node = if case.fuse { 0.0 } else { 6.0 + 9.0 };
    let of_node = (12.0 + compensated + forces_of_node + 2.0) * number + 4.0;
    let corners = node_count(kind) as f64;
    let forces = if case.scheme == "patches" {
        // nodes of a patch: those of a cube of so many elements
        let cells = (patch_groups(kind) * LANES) as f64 / super::elements_a_cell(kind) as f64;
        let of_patches = (1.0 + 1.0 / cells.cbrt()).powi(3) * a_node;
        // those inside move with it: their displacements are there, their forces are neither written nor looked up and
        // read
        let inside = if case.fuse { (1.0 - 1.0 / cells.cbrt()).powi(3) * a_node } else { 0.0 };
        // on a GPU a byte a corner of each batch says how often corners take turns
        let batches = if case.is_gpu() { patch_batches(kind) as f64 } else { 0.0 };
        let turns = batches * corners / (patch_groups(kind) * LANES) as f64;
        let bring = of_patches * 4.0 + (of_patches - inside) * 3.0 * number;
        2.0 * corners + turns + bring + (of_patches - inside) * (4.0 + 2.0 * 3.0 * number)
    } else {
        4.0 * corners + corners * (4.0 + 2.0 * 3.0 * number) + a_node * 3.0 * number
    };
    // cubes of cubes: what only other shapes need is left out
    let (rows, flops) = run_with_element(kind, RowsAndFlops(kind, case.effects));
    let shape = rows as f64 * number;
    Cost { flops, bytes: shape + history + forces + a_node * of_node }
}

/// Numbers of the rest shape and operations of an element kind with these effects.
struct RowsAndFlops(ElementKind, Effects);

impl ElementTask for RowsAndFlops {
    type Output = (usize, f64);

    fn run<E: Element>(self) -> (usize, f64) {
        (<E::Specialisation as Element>::ROWS, flops::<E::Specialisation>(self.0, self.1))
    }
}

thread_local! {
    static COUNT: Cell<u64> = const { Cell::new(0) };
}

/// A number that counts what is done with it.
#[derive(Clone, Copy, Debug)]
struct Counted(f64);

fn counted(operations: u64, value: f64) -> Counted {
    COUNT.set(COUNT.get() + operations);
    Counted(value)
}

macro_rules! operators {
    ($($name:ident $function:ident $sign:tt),*) => {
        $(impl $name for Counted {
            type Output = Self;
            fn $function(self, other: Self) -> Self {
                counted(1, self.0 $sign other.0)
            }
        })*
    };
}
operators!(Add add +, Sub sub -, Mul mul *, Div div /);

impl Neg for Counted {
    type Output = Self;
    fn neg(self) -> Self {
        Counted(-self.0)
    }
}
impl AddAssign for Counted {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}
impl SubAssign for Counted {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl Real for Counted {
    const EPSILON: f64 = f64::EPSILON;

    fn constant(self, value: f64) -> Self {
        Counted(value)
    }
    fn mul_add(self, factor: Self, summand: Self) -> Self {
        counted(2, self.0 * factor.0 + summand.0)
    }
    fn max(self, other: Self) -> Self {
        counted(1, self.0.max(other.0))
    }
    fn min(self, other: Self) -> Self {
        counted(1, self.0.min(other.0))
    }
    fn inverse_cbrt(self) -> Self {
        // as in f32
        refine_inverse_cbrt(self, Counted(1.0 / self.0.cbrt()), 3)
    }
    fn sqrt(self) -> Self {
        counted(1, self.0.sqrt())
    }
    fn if_positive(self, then: Self, otherwise: Self) -> Self {
        if counted(1, self.0).0 > 0.0 { then } else { otherwise }
    }
    fn power_of_two(self) -> Self {
        counted(1, self.0.exp2())
    }
    fn mantissa_and_exponent(self) -> (Self, Self) {
        let exponent = self.0.log2().round();
        (counted(1, self.0 / exponent.exp2()), counted(1, exponent))
    }
    fn outlined<T: Task<Self>>(self, task: T) -> T::Output {
        task.run()
    }
}

/// Operations of one element, by doing them.
fn flops<E: Element>(kind: ElementKind, effects: Effects) -> f64 {
    let zero = Counted(0.0);
    // any will do: what is counted does not depend on the shape
    let Ok(cube) = box_mesh(glam::DVec3::ONE, (1, 1, 1), kind) else { return f64::NAN };
    let points: Vec<glam::DVec3> = cube.cells.nodes(0).iter().map(|&node| cube.points[node as usize]).collect();
    let shape = E::rest_shape(&points, 3000.0);
    let shape = |row: usize| Counted(shape[row]);
    let law = NeoHookean { shear: Counted(1034.0), bulk: Counted(1e4) };
    let fibres = (Fibres { eta: Counted(2000.0), tension_only: zero }, [Counted(1.0), zero, zero]);
    let term = PronyTerm { stress: Counted(1e-4), memory: Counted(-0.5), rate: Counted(1e-3), aim: Counted(-1.0) };
    let viscous = matches!(effects, Effects::Viscosity | Effects::FibresViscosity);
    let fibred = matches!(effects, Effects::Fibres | Effects::FibresViscosity);
    let along_squared = Sym3::square_of(fibres.1);
    COUNT.set(0);
    let u = E::prepare(&[[Counted(1e-3); 3]; MOST_NODES]);
    let mut shared = None;
    if E::PRESSURE != PressureFrom::Point {
        let mut sum = zero;
        for point in 0..E::POINTS {
            let state = E::at_point(&u, point, shape);
            let k = law.kinematics(&state.gradient);
            sum = state.volume.mul_add(law.volume_measure(&k), sum);
        }
        shared = Some(law.pressure(sum));
    }
    let mut forces = E::no_forces(zero);
    for point in 0..E::POINTS {
        let state = E::at_point(&u, point, shape);
        let stress = if viscous {
            let fibres = fibred.then_some((fibres.0, along_squared));
            let relax = |isochoric: Sym3<Counted>, volumetric: Sym3<Counted>| {
                let memory = isochoric;
                let relaxed = term.relaxed(&isochoric, &memory);
                let _ = term.carried_on(&isochoric, &memory);
                isochoric.plus(&relaxed).plus(&volumetric)
            };
            law.stress_relaxed(&state.gradient, shared, fibres, relax).0
        } else {
            law.direct_stress(&state.gradient, shared, fibred.then_some(fibres)).0
        };
        E::add_stress(&mut forces, point, &state, &stress);
    }
    // and their sums at the nodes
    E::store_forces(&u, &forces, shape, |_, _, force| {
        let _ = force + zero;
    });
    COUNT.get() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::Load;
    use sinew::mesh::ElementKind;

    #[test]
    fn arithmetic_is_that_of_the_elements_and_more_with_effects() {
        let case = |element, effects| Case {
            fuse: true,
            load: Load::Gravity,
            element,
            effects,
            backend: "cpu".into(),
            precision: "f32".into(),
            threads: 1,
            instructions: "widest".into(),
            scheme: "patches".into(),
            cells: 20,
        };
        let tet = cost(&case(ElementKind::Tet4, Effects::None), 48_000, 9261);
        // ∇u 9·3·2, forces 9·3·2, sums 12 and differences 9 are 129; the law comes on top
        assert!((180.0..300.0).contains(&tet.flops), "{tet:?}");
        let apart = cost(&Case { fuse: false, ..case(ElementKind::Tet4, Effects::None) }, 48_000, 9261);
        assert!((14.0..18.0).contains(&(apart.bytes - tet.bytes)), "forces and loads of a fifth of a node");
        for kind in ElementKind::ALL {
            let one = cost(&case(kind, Effects::None), 48_000, 9261);
            assert!(one.flops >= tet.flops && one.flops < 1e4 && one.bytes.is_finite(), "{kind:?}: {one:?}");
        }
        let all = cost(&case(ElementKind::Tet4, Effects::FibresViscosity), 48_000, 9261);
        assert!(all.flops > tet.flops + 50.0 && all.bytes == tet.bytes + 48.0, "{all:?}");
        let hex = cost(&case(ElementKind::Hex8, Effects::None), 8_000, 9261);
        assert!(hex.flops > tet.flops && hex.bytes > tet.bytes, "{hex:?}");
    }
}
