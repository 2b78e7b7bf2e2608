//! The scene of a cataract, coarse and short.

use super::{reference, scene};
use sinew::Simulation;
use std::collections::BTreeMap;

/// What is gone is the rate's integral to an element, and mass goes with it; the surface stays closed; the tip feels no
/// more than what it sucks and the tissue that it presses; elements stay sound.
#[test]
fn a_tip_takes_the_nucleus_at_its_rate() {
    let sets = [
        "bodies.lens.mesh.across=16",
        "bodies.lens.mesh.through=8",
        "duration=0.6",
        "removal[0].when=InTool(tool: \"tip\", bore: 3.5e-4, reach: 8e-4, rate: 2e-8, curve: Step(start: 0.2))",
    ];
    let mut simulation = Simulation::new(&scene("cataract", &sets), &reference()).unwrap();
    let density = [1050.0, 1090.0];
    let (mut before, mut most) = (0.0, 0.0_f64);
    while simulation.time() < 0.6 {
        simulation.advance_to((simulation.time() + 0.05).min(0.6)).unwrap();
        let gone = simulation.probe("hole").unwrap()[0];
        let taken = 2e-8 * (simulation.time() - 0.2).max(0.0);
        assert!(gone >= before && gone <= taken * (1.0 + 1e-9), "{gone:e} of {taken:e}");
        before = gone;
        let mut edges: BTreeMap<[u32; 2], usize> = BTreeMap::new();
        for [a, b, c] in simulation.surface_triangles("lens").unwrap() {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                *edges.entry([from.min(to), from.max(to)]).or_default() += 1;
            }
        }
        assert!(edges.values().all(|count| count % 2 == 0), "at {}", simulation.time());
        let tip = simulation.tool("tip").unwrap();
        most = most.max(tip.force.length());
        // Δp π r²
        let bound = 2e3 * std::f64::consts::PI * 3.5e-4 * 3.5e-4;
        assert!(tip.suction.length() <= 1.01 * bound, "{tip:?}");
        assert!(tip.penetration < 1e-5, "{tip:?}");
    }
    let summary = simulation.summary("").unwrap();
    println!("{} elements, {before:e} m³, up to {most:e} N", summary.removed_elements);
    assert!(summary.removed_elements > 10, "{}", summary.removed_elements);
    assert!(most > 1e-4 && most < 0.05, "{most} N");
    let [least, largest] = density.map(|density| density * before);
    assert!(summary.removed_mass >= least * (1.0 - 1e-9) && summary.removed_mass <= largest * (1.0 + 1e-9));
}
