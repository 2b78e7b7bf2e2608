//! What is claimed where surfaces touch. A ball pressed into a layer (`scenes/indentation.ron`, f64) is felt by as many
//! nodes as happen to be in reach, other ones on each mesh: its force has no order to rely on.

use sinew_studies::accuracy::reference::{Error, Reference};
use sinew_studies::accuracy::solver::{Channel, Solution};

/// How deep the ball is pressed (m), its force (N) on 6, 12, 24 and 48 cells across (9, 18, 36 and 72 in the last), and
/// on a mesh that is graded towards it, with eight faces on the radius of contact: known to about half a percent.
const FORCES: [(f64, [f64; 4], f64); 6] = [
    (1e-4, [1.41347e-4, 6.55568e-5, 9.14562e-5, 1.01839e-4], 1.04707e-4),
    (1.5e-4, [2.12131e-4, 9.83421e-5, 1.88810e-4, 1.93703e-4], 1.99623e-4),
    (2e-4, [2.82981e-4, 2.09023e-4, 2.86240e-4, 3.11359e-4], 3.17615e-4),
    (3e-4, [4.24859e-4, 4.91409e-4, 5.93797e-4, 6.09275e-4], 6.17254e-4),
    (4e-4, [5.66939e-4, 8.69752e-4, 9.60555e-4, 9.86370e-4], 9.98585e-4),
    (5e-4, [1.10002e-3, 1.38422e-3, 1.43882e-3, 1.45222e-3], 1.46185e-3),
];

fn felt(force: f64) -> Solution {
    let (name, group) = ("force.Fz".to_string(), "force".to_string());
    let channel = Channel { name, group, unit: "N".into(), times: vec![1.0], values: vec![force] };
    Solution { channels: vec![channel], ..Solution::default() }
}

/// The claim for the finest of three meshes, the reference's value, and how far it may be off (N).
fn claimed(forces: &[f64], touches: bool) -> (Error, f64, f64) {
    let solutions: Vec<Solution> = forces.iter().map(|force| felt(*force)).collect();
    let (list, sizes): (Vec<&Solution>, _) = (solutions.iter().collect(), [1.0, 0.5, 0.25]);
    let reference = Reference::of_meshes(&sizes, &list, String::new()).unwrap();
    let reference = if touches { reference.of_contact(&sizes, &list) } else { reference };
    let entry = &reference.entries["force.Fz"];
    (reference.errors(list[2])["force.Fz"], entry.values[0], entry.uncertainty)
}

#[test]
fn claims_are_as_wide_as_the_error_where_surfaces_touch() {
    let mut missed = 0;
    for (depth, forces, truth) in FORCES {
        for three in forces.windows(3) {
            let (error, value, uncertainty) = claimed(three, true);
            let off = (three[2] - truth).abs() / truth;
            assert!(error.at_most() >= off, "{depth} m, {three:?}: {error:?}, in truth {off}");
            assert!((value - truth).abs() <= uncertainty, "{depth} m, {three:?}: {value} ± {uncertainty}, not {truth}");
            // as of smooth problems
            let (_, value, uncertainty) = claimed(three, false);
            missed += usize::from((value - truth).abs() > uncertainty);
        }
    }
    assert!(missed >= 3, "the power of the cell size would have done: {missed} missed");
}

/// Where nothing touches the reference stays what it was.
#[test]
fn contact_makes_claims_wider_and_never_narrower() {
    for (_, forces, _) in FORCES {
        for three in forces.windows(3) {
            assert!(claimed(three, true).2 >= claimed(three, false).2, "{three:?}");
        }
    }
}
