//! Products with the tangent stiffness of every law and every kind of element: q·Kp = p·Kq where forces have an energy,
//! in f64 and in f32.
//!
//! A difference of forces at a strain ε, 1e-7 in f64 and 1e-3 in f32, has ε/2 of the third derivative of the energy in
//! it, which is not symmetric. Displacements of neighbours are opposite at worst, so that gradients are up to 2 ε, and
//! of these laws where strains are .3 third derivatives are some three times the second: 3 ε of the product. q·Kp has
//! as little of what is off as of anything that knows nothing of q: a third of that here.

use crate::configurations::{ELEMENTS, scene_of};
use crate::implicit::{EFFECTS, options};
use crate::law_words::{FRAMED, LAWS};
use glam::DVec3;
use sinew::Simulation;
use sinew::components::{Precision, RestPosition, TrialForces};
use std::path::Path;

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

/// Two motions of a body that is bent, stretched and squeezed, and what its stiffness makes of each.
fn products(elements: &str, material: &str, precision: Precision) -> ([Vec<f64>; 2], Vec<Vec<f64>>) {
    let scene = format!(
        "(duration: 1, solver: Implicit(),
        bodies: {{\"b\": (mesh: Box(size: (0.1, 0.04, 0.03), cells: (4, 2, 2), elements: {elements}), material: \"m\")}},
        materials: {{\"m\": (density: 1000, {material})}})"
    );
    let mut simulation = Simulation::new(&scene_of(&scene, Path::new(".")), &options(precision, 1)).unwrap();
    let body = simulation.body("b").unwrap();
    let bent = |x: &DVec3| DVec3::new(0.2 * x.x - 3.0 * x.x * x.z, 4.0 * x.x * x.x, -0.3 * x.z + 2.0 * x.x * x.y);
    let rest = &simulation.world().get::<RestPosition>(body).unwrap().0;
    let w: Vec<f64> = rest.iter().flat_map(|x| bent(x).to_array()).collect();
    let vector = |seed: f64| -> Vec<f64> { (0..w.len()).map(|axis| (seed * (axis as f64 + 1.0)).sin()).collect() };
    let motions = [vector(0.37), vector(1.91)];
    // memories are to stay as they are
    simulation.world_mut().resource_mut::<TrialForces>().trying = true;
    let images = simulation.stiffness_by_differences(&w, &motions).unwrap();
    assert_eq!(images.len(), 2, "{material}, {elements}: an element is turned inside out");
    (motions, images)
}

/// |q·Kp − p·Kq| over |q| |Kp|, which laws that soften have, too.
fn asymmetry(([p, q], images): &([Vec<f64>; 2], Vec<Vec<f64>>)) -> f64 {
    let (of_p, of_q) = (&images[0], &images[1]);
    (dot(q, of_p) - dot(p, of_q)).abs() / (norm(q) * norm(of_p))
}

fn materials() -> Vec<String> {
    let effects = "stiffness_damping: 5e-3, exponential_fibres: [(k1: 900, k2: 0.4, direction: Along(0, 1, 1))],";
    let with_effects = format!("{EFFECTS} {effects} {}", LAWS[2]);
    LAWS.into_iter().map(str::to_owned).chain([with_effects]).collect()
}

#[test]
fn products_of_every_law_and_element_are_symmetric() {
    let mut worst = [0.0_f64; 3];
    for material in materials() {
        for elements in ELEMENTS {
            let exact = products(elements, &material, Precision::F64);
            let rounded = products(elements, &material, Precision::F32);
            let off = |place: usize| -> f64 {
                let apart: Vec<f64> = rounded.1[place].iter().zip(&exact.1[place]).map(|(a, b)| a - b).collect();
                norm(&apart) / norm(&exact.1[place])
            };
            let found = [asymmetry(&exact), asymmetry(&rounded), off(0).max(off(1))];
            println!("{elements}, {material}: {found:?}");
            for (worst, found) in worst.iter_mut().zip(found) {
                *worst = worst.max(found);
            }
        }
    }
    println!("{worst:?}");
    assert!(worst[0] < 1e-6, "{worst:?}");
    assert!(worst[1] < 1e-3 && worst[2] < 3e-3, "{worst:?}");
}

/// What has no energy has no symmetric tangent, and the test above could fail.
#[test]
fn those_of_a_law_in_a_frame_of_edges_are_not() {
    for elements in ["Tet4", "Hex8"] {
        let found = asymmetry(&products(elements, FRAMED, Precision::F64));
        assert!(found > 1e-4, "{elements}: {found:e}");
    }
}
