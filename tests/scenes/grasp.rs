//! The scene in which forceps lift the edge of a liver.

use super::{near, reference, scene};
use sinew::Simulation;

#[test]
#[ignore = "long"]
fn the_forceps_bear_what_the_table_no_longer_does_and_let_go() {
    let mut simulation = Simulation::new(&scene("grasped_liver", &[]), &reference()).unwrap();
    simulation.advance_to(0.19).unwrap();
    let open = simulation.tool("forceps.tip").unwrap();
    assert_eq!((open.nodes, open.force.length()), (0, 0.0), "{open:?}");
    let weight: f64 = simulation.masses("liver").unwrap().iter().sum::<f64>() * 9.81;
    simulation.advance_to(0.99).unwrap();
    let [held, table] = ["forceps.tip", "table"].map(|tool| simulation.tool(tool).unwrap());
    assert!(held.nodes > 8, "{held:?}");
    assert!(-held.force.z > 0.1 * weight && -held.force.z < 0.6 * weight, "{held:?} of {weight} N");
    // it still swings a little
    assert!(near(-held.force.z - table.force.z, weight, 0.1), "{held:?}, {table:?} of {weight} N");
    let u = simulation.displacements("liver").unwrap();
    let highest = u.iter().map(|u| u.z).fold(f64::NEG_INFINITY, f64::max);
    assert!(highest > 0.05, "its edge is lifted: {highest} m");
    simulation.finish().unwrap();
    let free = simulation.tool("forceps.tip").unwrap();
    assert_eq!((free.nodes, free.force.length()), (0, 0.0), "{free:?}");
    let fallen = simulation.displacements("liver").unwrap().iter().map(|u| u.z).fold(f64::NEG_INFINITY, f64::max);
    assert!(fallen < 0.5 * highest, "it has fallen: {fallen} m");
}
