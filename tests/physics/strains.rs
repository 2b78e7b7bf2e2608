//! What the stable step is followed by: how far and how fast elements are deformed, under an affine motion that has
//! closed forms.
//!
//! Bounds: traces of cof C of a deformation with J = 0.5 to 2 are some thirty products, each rounded: 1e-13 in f64,
//! 3e-5 in f32, whose displacements are rounded too.

use crate::configurations::{ELEMENTS, configurations, near};
use glam::{DMat3, DVec3};
use sinew::backend::cpu::{Cpu, Strain, StrainColumns, strains};
use sinew::bevy_ecs::prelude::Entity;
use sinew::components::*;
use sinew::elements::{Element, Hex8, Hex8MeanDilatation, Tet4, Tet4NodalPressure, Tet10, Wedge6};
use sinew::math::{LANES, SimdScalar};
use sinew::mesh::ElementKind;
use sinew::{BackendChoice, Simulation};

/// x-stretch, shears and a turn; J = 1.3.
const GRADIENT: [[f64; 3]; 3] = [[0.4, -0.5, 0.1], [0.6, -0.2, 0.2], [0.0, -0.1, -0.1]];
const CHANGE: [[f64; 3]; 3] = [[0.01, 0.03, 0.0], [-0.03, 0.02, 0.01], [0.0, 0.0, -0.02]];

fn matrix(rows: [[f64; 3]; 3]) -> DMat3 {
    DMat3::from_cols_array_2d(&rows).transpose()
}

fn moved(simulation: &Simulation, body: Entity, gradient: DMat3) -> impl Iterator<Item = f64> {
    let rest = simulation.world().get::<RestPosition>(body).unwrap().0.clone();
    rest.into_iter().flat_map(move |x| (gradient * x).to_array())
}

/// Of all elements of the only block, with C_xx beside.
fn all(simulation: &Simulation, body: Entity) -> Vec<Strain> {
    fn of<E: Element, T: SimdScalar>(simulation: &Simulation, body: Entity) -> Vec<Strain> {
        let world = simulation.world();
        let entity = world.get::<Authoring>(body).unwrap().blocks[0];
        let block = world.get::<Block>(entity).unwrap();
        let columns = StrainColumns::<T> {
            displacement: world.get::<Displacement>(body).unwrap().slice(),
            step: world.get::<DisplacementIncrement>(body).unwrap().slice(),
            connectivity: world.get::<Connectivity>(entity).unwrap(),
            rest_shape: world.get::<RestShape>(entity).unwrap().slice(),
            ends: true,
        };
        let groups = 0..block.count.div_ceil(LANES);
        let stretch = |_: usize, c: [f64; 6]| c[0];
        let mut found = Vec::new();
        let mut visit = |some: &[Strain]| found.extend_from_slice(some);
        let (cpu, visit) = (world.resource::<Cpu>(), Some(&mut visit as &mut dyn FnMut(&[Strain])));
        let (widest, count) = match block.simple {
            true => strains::<E::Specialisation, T>(cpu, &columns, groups, Some(&stretch), visit, None),
            false => strains::<E, T>(cpu, &columns, groups, Some(&stretch), visit, None),
        };
        assert_eq!(count, found.len());
        let most = |of: fn(&Strain) -> f64| found.iter().map(of).fold(0.0, f64::max);
        let expected = [most(|s| s.size), most(|s| s.squeeze), most(|s| s.speed), most(|s| s.more)];
        assert_eq!([widest.size, widest.squeeze, widest.speed, widest.more], expected);
        found
    }
    let world = simulation.world();
    let entity = world.get::<Authoring>(body).unwrap().blocks[0];
    let precision = world.get::<Displacement>(body).unwrap().precision();
    macro_rules! run {
        ($E:ty) => {
            match precision {
                Precision::F32 => of::<$E, f32>(simulation, body),
                Precision::F64 => of::<$E, f64>(simulation, body),
            }
        };
    }
    match world.get::<Block>(entity).unwrap().kind {
        ElementKind::Tet4 => run!(Tet4),
        ElementKind::Tet4NodalPressure => run!(Tet4NodalPressure),
        ElementKind::Hex8 => run!(Hex8),
        ElementKind::Hex8MeanDilatation => run!(Hex8MeanDilatation),
        ElementKind::Wedge6 => run!(Wedge6),
        ElementKind::Tet10 => run!(Tet10),
    }
}

#[test]
fn sizes_and_speeds_of_an_affine_motion_are_the_closed_forms_for_every_element_there() {
    let (f, change) = (DMat3::IDENTITY + matrix(GRADIENT), matrix(CHANGE));
    let (c, rate) = (f.transpose() * f, f.transpose() * change);
    let e = 0.5 * (rate + rate.transpose());
    let trace = |m: DMat3| m.x_axis.x + m.y_axis.y + m.z_axis.z;
    // what the volume has grown by counts twice: cof C
    let inverse = f.determinant().powi(2).max(1.0) * c.inverse();
    let size = trace(c).max(trace(inverse)) / 3.0;
    let strained = trace(e.transpose() * e).sqrt();
    let mean = trace(inverse) / 3.0;
    // tr C⁻¹/3 + √(2/3 D : D) with its deviator D
    let deviator = inverse - mean * DMat3::IDENTITY;
    let squeeze = mean + (2.0 / 3.0 * trace(deviator.transpose() * deviator)).sqrt();
    for run in configurations().iter().filter(|run| run.options.backend == BackendChoice::Cpu) {
        // a box, whose hexahedra are parallelepipeds, and a ball, whose are none
        for (elements, mesh) in ELEMENTS.iter().flat_map(|elements| {
            [("Box(size: (1, 1.2, 0.9), cells: (3, 4, 3)"), ("Ellipsoid(radii: (1, 1.2, 0.9), across: 4")]
                .map(|mesh| (elements, mesh))
        }) {
            let mut simulation = run.start(&format!(
                "(duration: 1, bodies: {{\"b\": (mesh: {mesh}, elements: {elements}), material: \"m\")}},
                materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}}, integration: (step: 1e-5))"
            ));
            let body = simulation.body("b").unwrap();
            let u = Reals::from_f64(run.options.precision, moved(&simulation, body, matrix(GRADIENT)));
            let d = Reals::from_f64(run.options.precision, moved(&simulation, body, change));
            simulation.world_mut().get_mut::<Displacement>(body).unwrap().0 = u;
            simulation.world_mut().get_mut::<DisplacementIncrement>(body).unwrap().0 = d;
            let found = all(&simulation, body);
            let bound = run.bound(1e-13, 3e-5);
            let what = |of: &str| format!("{} {elements} {mesh}: {of}", run.name);
            let entity = simulation.world().get::<Authoring>(body).unwrap().blocks[0];
            assert_eq!(found.len(), simulation.world().get::<Block>(entity).unwrap().count);
            for strain in &found {
                near(&what("size"), strain.size, size, size, bound);
                near(&what("squeeze"), strain.squeeze, squeeze, squeeze, bound);
                near(&what("speed"), strain.speed, strained * squeeze, strained * squeeze, bound);
                near(&what("mean speed"), strain.mean_speed, strained * mean, strained * mean, bound);
                near(&what("C_xx"), strain.more, c.x_axis.x, c.x_axis.x, bound);
            }
            assert!(found.iter().enumerate().all(|(row, strain)| strain.row == row));
            // what is no number counts as infinitely far and fast
            let lost = simulation.world().get::<Connectivity>(entity).unwrap()[5] as usize;
            set(&mut simulation.world_mut().get_mut::<Displacement>(body).unwrap().0, 3 * lost);
            let found = all(&simulation, body);
            assert!(found[5].size.is_infinite() && found[5].speed.is_infinite(), "{}", what("no number"));
            assert!(found.iter().any(|strain| strain.size.is_finite()), "{}", what("others"));
        }
    }
}

fn set(column: &mut Reals, at: usize) {
    match column {
        Reals::F32(numbers) => numbers[at] = f32::NAN,
        Reals::F64(numbers) => numbers[at] = f64::NAN,
    }
}

#[test]
fn elements_that_fall_flat_are_infinitely_deformed() {
    for run in configurations().iter().filter(|run| run.options.backend == BackendChoice::Cpu) {
        for elements in ELEMENTS {
            let mut simulation = run.start(&format!(
                "(duration: 1, bodies: {{\"b\": (mesh: Box(size: (1, 1, 1), cells: (2, 2, 2), elements: {elements}), material: \"m\")}},
                materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}}, integration: (step: 1e-5))"
            ));
            let body = simulation.body("b").unwrap();
            let flat = DMat3::from_diagonal(DVec3::new(0.0, 0.0, -1.0));
            let u = Reals::from_f64(run.options.precision, moved(&simulation, body, flat));
            simulation.world_mut().get_mut::<Displacement>(body).unwrap().0 = u;
            let found = all(&simulation, body);
            assert!(found.iter().all(|strain| strain.size > 1e5), "{} {elements}: {found:?}", run.name);
        }
    }
}
