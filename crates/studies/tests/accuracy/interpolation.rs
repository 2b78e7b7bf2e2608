//! Finding points in meshes, and fields on different meshes against each other.

use sinew::glam::DVec3;
use sinew::mesh::generators::{box_mesh, cylinder_mesh, ellipsoid_mesh};
use sinew::mesh::{ElementKind, Locator, Mesh};
use sinew_studies::accuracy::field::{FieldReference, same_mesh};
use sinew_studies::accuracy::points::PointReference;
use sinew_studies::accuracy::solver::{BodyField, Field};
use std::collections::BTreeMap;
use std::sync::Arc;

const KINDS: [ElementKind; 2] = [ElementKind::Tet4, ElementKind::Hex8];

/// Scattered points in the unit cube.
fn scattered(count: u32) -> impl Iterator<Item = DVec3> {
    (1..=count).map(|i| DVec3::new(0.754877666, 0.569840291, 0.362105289) * f64::from(i)).map(|x| x - x.floor())
}

#[test]
fn every_point_of_a_body_is_found_where_it_is() {
    for kind in KINDS {
        for mesh in [box_mesh(DVec3::ONE, (3, 4, 5), kind).unwrap(), cylinder_mesh(1.0, 2.0, 6, 4, kind).unwrap()] {
            let locator = Locator::new(&mesh);
            for share in scattered(300) {
                let element = (share.x * mesh.element_count() as f64) as usize;
                // inside of an element: any mean of its corners
                let corners = mesh.element(element);
                let weights: Vec<f64> =
                    (0..corners.len()).map(|i| 0.1 + ((i as f64 + 1.0) * share.y * 7.3).fract()).collect();
                let sum: f64 = weights.iter().sum();
                let x: DVec3 = corners.iter().zip(&weights).map(|(&c, w)| mesh.points[c as usize] * (w / sum)).sum();
                let found = locator.locate(x).unwrap();
                let there: DVec3 = mesh
                    .element(found.element)
                    .iter()
                    .zip(found.weights)
                    .map(|(&c, w)| mesh.points[c as usize] * w)
                    .sum();
                assert!(there.distance(x) < 1e-9, "{x} is found at {there}, {found:?}");
                assert!((found.weights.iter().sum::<f64>() - 1.0).abs() < 1e-12);
            }
        }
    }
}

#[test]
fn a_point_outside_is_taken_to_the_surface_and_told_so_or_not_found() {
    for kind in KINDS {
        let mesh = box_mesh(DVec3::ONE, (4, 4, 4), kind).unwrap();
        let locator = Locator::new(&mesh);
        let near = locator.locate(DVec3::new(1.02, 0.4, 0.6)).unwrap();
        assert!(near.outside > 0.01 && near.outside < 0.3, "{near:?}");
        assert!(locator.locate(DVec3::new(9.0, 0.5, 0.5)).is_none());
    }
}

fn field(mesh: Mesh, u: impl Fn(DVec3) -> DVec3) -> Field {
    let displacements = vec![mesh.points.iter().map(|x| u(*x)).collect()];
    let masses = vec![1.0; mesh.points.len()];
    let body = BodyField { mesh: Arc::new(mesh), masses, displacements };
    Field { times: vec![1.0], bodies: BTreeMap::from([("a".to_string(), body)]) }
}

#[test]
fn a_linear_field_is_the_same_on_every_mesh() {
    let linear = |x: DVec3| DVec3::new(0.1 * x.y, 0.2 * x.x + 0.3 * x.z, -0.4 * x.z);
    for kind in KINDS {
        let fine = FieldReference::given(field(box_mesh(DVec3::ONE, (7, 7, 7), KINDS[0]).unwrap(), linear), 0.0);
        let coarse = field(box_mesh(DVec3::ONE, (3, 4, 2), kind).unwrap(), linear);
        let error = fine.error_of(&coarse).unwrap();
        assert!(error.all().iter().all(|error| *error < 1e-12), "{error:?}");
    }
}

#[test]
fn a_field_that_is_wrong_by_one_percent_errs_by_one_percent() {
    let bent = |x: DVec3| DVec3::new(0.0, 0.0, x.x * x.x);
    let mesh = || box_mesh(DVec3::ONE, (8, 8, 8), ElementKind::Hex8).unwrap();
    let reference = FieldReference::given(field(mesh(), bent), 0.0);
    let coarse = box_mesh(DVec3::ONE, (4, 4, 4), ElementKind::Tet4).unwrap();
    let error = reference.error_of(&field(coarse, |x| 1.01 * bent(x))).unwrap();
    assert!(error.all().iter().all(|error| (error - 0.01).abs() < 1e-12), "{error:?}");
    let apart = same_mesh(&field(mesh(), |x| 1.01 * bent(x)), &field(mesh(), bent)).unwrap();
    assert!((apart.at_end - 0.01).abs() < 1e-12);
}

#[test]
fn three_nested_fields_are_extrapolated_to_their_limit() {
    // every node errs by 3 % h²
    let on = |cells: u32| {
        let mesh = box_mesh(DVec3::ONE, (cells, cells, cells), ElementKind::Hex8).unwrap();
        field(mesh, move |x| DVec3::new(0.0, 0.0, x.x * (1.0 + 0.03 * (2.0 / f64::from(cells)).powi(2))))
    };
    let reference = FieldReference::of_three([1.0, 0.5, 0.25], [on(2), on(4), on(8)], true).unwrap();
    assert!((reference.order.unwrap() - 2.0).abs() < 1e-6, "{reference:?}");
    for (cells, error) in [(2, 0.03), (1, 0.12)] {
        assert!((reference.error_of(&on(cells)).unwrap().at_end - error).abs() < 1e-9);
    }
    assert!(reference.uncertainty[0] < 1e-3);
}

#[test]
fn fields_of_nothing_and_of_other_bodies_have_no_error() {
    let still = |_: DVec3| DVec3::ZERO;
    let mesh = || box_mesh(DVec3::ONE, (2, 2, 2), ElementKind::Hex8).unwrap();
    assert!(FieldReference::given(field(mesh(), still), 0.0).error_of(&field(mesh(), still)).is_none());
    let mut other = field(mesh(), |x| x);
    let body = other.bodies.remove("a").unwrap();
    other.bodies.insert("b".into(), body);
    assert!(FieldReference::given(field(mesh(), |x| x), 0.0).error_of(&other).is_none());
}

#[test]
fn single_points_are_compared_where_nodes_lie_on_them() {
    let mesh = ellipsoid_mesh(DVec3::new(1.0, 1.0, 2.0), 4, ElementKind::Hex8).unwrap();
    let points: Vec<(DVec3, DVec3)> = mesh.points.iter().step_by(3).map(|x| (*x * (1.0 + 1e-9), *x)).collect();
    let reference = PointReference { bodies: BTreeMap::from([(String::new(), points)]) };
    let [all, largest] = reference.error_of(&field(mesh.clone(), |x| 1.02 * x)).unwrap();
    assert!((all - 0.02).abs() < 1e-6 && (largest - 0.02).abs() < 1e-6, "{all} {largest}");
    let elsewhere = PointReference { bodies: BTreeMap::from([(String::new(), vec![(DVec3::splat(9.0), DVec3::ONE)])]) };
    assert!(elsewhere.error_of(&field(mesh, |x| x)).is_none());
}
