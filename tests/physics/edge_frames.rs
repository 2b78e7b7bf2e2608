//! The co-rotational law in frames of edges (`rotation: Frame`): objective, without force where a body at rest is
//! turned, refused where there is no such frame, and its moduli changed while a scene runs.

use crate::columns::internal_forces;
use crate::implicit::options;
use glam::{DMat3, DVec3};
use sinew::components::Precision;
use sinew::{SceneFile, Simulation};

const LAW: &str = "corotational: Young(young: 3e3, poisson: 0.3, rotation: Frame)";

/// A ball, whose hexahedra are no parallelepipeds, or where elements are Tet4 as well, under F = I + gradient.
fn start(elements: &str, law: &str, f: DMat3, precision: Precision) -> Simulation {
    let h = (f - DMat3::IDENTITY).transpose();
    let rows = [h.x_axis, h.y_axis, h.z_axis].map(|row| format!("({}, {}, {})", row.x, row.y, row.z)).join(", ");
    let text = format!(
        "(duration: 1, solver: Implicit(step: 1e-9, newton: 1),
        bodies: {{\"b\": (mesh: Ellipsoid(radii: (0.05, 0.04, 0.06), across: 4, elements: {elements}), material: \"m\",
            start: Affine(gradient: ({rows})))}},
        materials: {{\"m\": (density: 1000, {law})}})"
    );
    let scene = SceneFile::from_text("ball.ron", &text, std::path::Path::new("."), &[]);
    let scene = scene.unwrap_or_else(|wrong| panic!("{}", wrong.render(false)));
    Simulation::new(&scene, &options(precision, 1)).unwrap_or_else(|error| panic!("{error}"))
}

fn forces(elements: &str, law: &str, f: DMat3, precision: Precision) -> Vec<DVec3> {
    let mut simulation = start(elements, law, f, precision);
    simulation.advance(1).unwrap();
    internal_forces(&mut simulation, "b")
}

fn largest(forces: &[DVec3]) -> f64 {
    forces.iter().map(|force| force.length()).fold(0.0, f64::max)
}

/// A turn by 57°, about no axis of the mesh.
fn turn() -> DMat3 {
    DMat3::from_axis_angle(DVec3::new(0.3, -0.5, 0.8).normalize(), 1.0)
}

/// Against the ghost forces of the linear law, which strains of 1 − cos φ = .46 make. Stresses of rotations are known
/// to some ten roundings of 1, and forces are sums of 24 elements.
#[test]
fn a_body_at_rest_that_is_turned_has_no_forces() {
    for (precision, rounding) in [(Precision::F64, 1.1e-16), (Precision::F32, 6e-8)] {
        for elements in ["Tet4", "Hex8"] {
            let found = largest(&forces(elements, LAW, turn(), precision));
            let ghost = largest(&forces(elements, "linear: Young(young: 3e3, poisson: 0.3)", turn(), precision));
            println!("{elements}: {found:.1e} N of {ghost:.1e} N");
            assert!(ghost > 1e-2, "{ghost}");
            assert!(found < 240.0 * rounding / 0.46 * ghost, "{elements}: {found:e} N");
        }
    }
}

#[test]
fn forces_turn_with_the_body() {
    let f = DMat3::from_cols(DVec3::new(1.2, 0.1, 0.0), DVec3::new(0.3, 0.9, 0.1), DVec3::new(0.0, 0.1, 1.15));
    for elements in ["Tet4", "Hex8"] {
        let (before, after) = [f, turn() * f].map(|f| forces(elements, LAW, f, Precision::F64)).into();
        let scale = largest(&before);
        assert!(scale > 1e-2, "{scale}");
        let off = before.iter().zip(&after).map(|(a, b)| (turn() * *a - *b).length()).fold(0.0, f64::max);
        println!("{elements}: {off:.1e} of {scale:.1e} N");
        assert!(off < 1e-13 * scale, "{elements}: {off:e} of {scale:e} N");
    }
}

/// To first order in the strain it is every other law, whatever the frame: a strain of 1e-4 tells them apart by 1e-4.
#[test]
fn small_strains_obey_hooke_in_a_turned_body() {
    let strain = DMat3::from_cols(DVec3::new(1.0, 0.4, 0.0), DVec3::new(0.4, -0.5, 0.2), DVec3::new(0.0, 0.2, 0.7));
    let f = turn() * (DMat3::IDENTITY + strain * 1e-4);
    for elements in ["Tet4", "Hex8"] {
        let polar = forces(elements, &LAW.replace("Frame", "Polar"), f, Precision::F64);
        let frame = forces(elements, LAW, f, Precision::F64);
        let off = polar.iter().zip(&frame).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max) / largest(&polar);
        println!("{elements}: {off:.1e}");
        assert!((1e-6..1e-3).contains(&off), "{elements}: {off:e}");
    }
}

/// Explicit steps, whose forces are the same kernel's; the stiffer body is as one that was made so.
#[test]
fn moduli_change_while_frames_stay() {
    let scene = |young: &str| {
        let text = format!(
            "(duration: 1, integration: (step: 1e-4),
            bodies: {{\"b\": (mesh: Ellipsoid(radii: (0.05, 0.04, 0.06), across: 4, elements: Tet4), material: \"m\",
                start: Affine(gradient: ((0.1, 0, 0), (0, -0.1, 0.1), (0, 0, 0))))}},
            materials: {{\"m\": (density: 1000, corotational: Young(young: {young}, poisson: 0.3, rotation: Frame))}})"
        );
        let scene = SceneFile::from_text("ball.ron", &text, std::path::Path::new("."), &[]).unwrap();
        Simulation::new(&scene, &options(Precision::F32, 1)).unwrap()
    };
    let (mut changed, mut made, mut soft) = (scene("3e3"), scene("6e3"), scene("3e3"));
    changed.change(&["materials.m.corotational=Young(young: 6e3, poisson: 0.3, rotation: Frame)".into()]).unwrap();
    let after = |simulation: &mut Simulation| {
        simulation.advance(20).unwrap();
        simulation.displacements("b").unwrap()
    };
    let [changed, made, soft] = [&mut changed, &mut made, &mut soft].map(after);
    assert_eq!(changed, made);
    assert_ne!(changed, soft);
    let mut other = scene("3e3");
    let told = other.change(&["materials.m.corotational=Young(young: 6e3, poisson: 0.3)".into()]).unwrap_err();
    assert!(told.to_string().contains("cannot change while the scene runs"), "{told}");
}

#[test]
fn what_has_no_frame_is_refused_by_name() {
    let told = |elements: &str, material: &str, more: &str| {
        let text = format!(
            "(duration: 1, bodies: {{\"b\": (mesh: Box(size: (1, 1, 1), cells: (1, 1, 1), elements: {elements}),
                material: \"m\", copies: 2, {more})}}, materials: {{\"m\": (density: 1000, {LAW}{material})}})"
        );
        let wrong = match SceneFile::from_text("box.ron", &text, std::path::Path::new("."), &[]) {
            Err(wrong) => wrong.render(false),
            Ok(scene) => {
                Simulation::new(&scene, &options(Precision::F64, 1)).err().map_or(String::new(), |e| e.to_string())
            }
        };
        println!("{wrong}");
        wrong
    };
    for elements in ["Tet4", "Hex8"] {
        assert_eq!(told(elements, ", prony: (terms: [(alpha: 0.2, tau: 1)])", ""), "");
    }
    for elements in ["Tet4NodalPressure", "Hex8MeanDilatation", "Tet10", "Wedge6"] {
        let told = told(elements, "", "");
        assert!(told.contains("`rotation: Frame` is of Tet4 and Hex8") && told.contains(elements), "{told}");
    }
    let told_of_fibres = told("Tet4", ", fibres: (eta: 1, direction: Along(1, 0, 0))", "");
    assert!(told_of_fibres.contains("not `corotational` with `rotation: Frame`"), "{told_of_fibres}");
    let told_of_copies = told("Tet4", "", "per_copy: {\"m.corotational.young\": Linear(1e3, 2e3)}");
    assert!(told_of_copies.contains("cannot differ from copy to copy"), "{told_of_copies}");
}
