//! The retracted lobe.

use super::{near, run};

#[test]
#[ignore = "long"]
fn forceps_and_bed_bear_the_weight_and_no_element_is_crushed() {
    let simulation = &mut run("retracted_lobe", &["bodies.lobe.mesh.across=10"]);
    let mut probe = |name: &str| simulation.probe(name).unwrap();
    let (forceps, bed) = (probe("forceps"), probe("bed"));
    // half an ellipsoid of hexahedra is a little smaller than the ellipsoid
    let mass: f64 = simulation.summary("finished").unwrap().mass;
    let (weight, borne) = (9.81 * mass, forceps[2] + bed[2]);
    assert!(near(borne, weight, 0.01), "{borne} N of {weight} N");
    // what pulls back is held by the bed
    assert!((forceps[0] + bed[0]).abs() < 0.01 * weight && forceps[2] > 0.1 * weight, "{forceps:?} {bed:?}");
    let ratios = simulation.fields("lobe").unwrap().volume_ratio;
    assert!(ratios.iter().all(|ratio| *ratio > 0.1), "{:?}", ratios.iter().copied().fold(f64::INFINITY, f64::min));
}

/// An element between nodes of the forceps is crushed; it moves nobody, and another that is crushed beside it is one of
/// a thousand.
#[test]
#[ignore = "long"]
fn what_is_crushed_between_the_forceps_does_not_shorten_the_step() {
    let simulation = run("retracted_lobe", &["bodies.lobe.mesh.across=10"]);
    let history = simulation.step_history().unwrap();
    println!("{history:?}");
    assert!(history.smallest > 0.5 * history.largest, "{history:?}");
}
