//! The stretched bar: an instant and a relaxed reaction, against the law at one point.

use super::{near, run, scene};
use sinew::Simulation;

const ALONG: [&str; 6] = [
    "materials.tissue.fibres.direction=Along(1, 0, 0)",
    // ends that may grow thin: the stress is the same everywhere
    "constraints[0].axes=[X]",
    "constraints[1].axes=[X]",
    "bodies.bar.mesh.cells=(20, 2, 2)",
    // what the motion sets ringing
    "materials.tissue.damping=40",
    "probes.middle.every=0.1",
];

/// Energy per rest volume (Pa) of a bar stretched by `l` along its fibres and by `t` across: μ/2 (Ī₁ − 3) + η/2 (Ī₄ −
/// 1)²
/// + κ/2 (J − 1)², the isochoric part times `share`.
fn energy(l: f64, t: f64, share: f64) -> f64 {
    let (mu, kappa, eta) = (3000.0 / 2.9, 10000.0, 2000.0);
    let j = l * t * t;
    let scale = j.powf(-2.0 / 3.0);
    let isochoric = mu / 2.0 * (scale * (l * l + 2.0 * t * t) - 3.0) + eta / 2.0 * (scale * l * l - 1.0).powi(2);
    share * isochoric + kappa / 2.0 * (j - 1.0).powi(2)
}

/// The force (N) on a bar of 1 cm² whose sides are free: its width minimises the energy.
fn force(l: f64, share: f64) -> f64 {
    let slope = |t: f64| energy(l, t + 1e-6, share) - energy(l, t - 1e-6, share);
    let (mut low, mut high) = (0.5, 1.1);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if slope(middle) > 0.0 { high = middle } else { low = middle }
    }
    let t = 0.5 * (low + high);
    1e-4 * (energy(l + 1e-6, t, share) - energy(l - 1e-6, t, share)) / 2e-6
}

fn pull(sets: &[&str]) -> f64 {
    let sets: Vec<&str> = ALONG.iter().chain(sets).copied().collect();
    run("stretched_bar", &sets).probe("pull").unwrap()[0]
}

#[test]
fn the_instant_reaction_is_that_of_the_elastic_law() {
    let found = pull(&["materials.tissue.prony.terms[0].tau=1e6", "duration=1.5"]);
    assert!(near(found, force(1.3, 1.0), 2e-3), "{found} N, not {} N", force(1.3, 1.0));
}

/// Only the isochoric part relaxes: not by 1 − α altogether, since volume gives way a little.
#[test]
fn the_relaxed_reaction_is_that_of_the_law_with_its_isochoric_part_times_one_less_alpha() {
    let found = pull(&["duration=6"]);
    assert!(near(found, force(1.3, 0.5), 2e-3), "{found} N, not {} N", force(1.3, 0.5));
    let ratio = force(1.3, 0.5) / force(1.3, 1.0);
    assert!((0.5..0.6).contains(&ratio), "{ratio}");
}

#[test]
fn the_shipped_bar_pulls_less_and_less_while_it_is_held() {
    let mut simulation = Simulation::new(&scene("stretched_bar", &[]), &super::reference()).unwrap();
    let mut pulls = Vec::new();
    for time in [0.6, 1.0, 1.5, 2.5, 4.0] {
        simulation.advance_to(time).unwrap();
        pulls.push(simulation.probe("pull").unwrap()[0]);
    }
    assert!(pulls.windows(2).all(|pair| pair[1] < pair[0]), "{pulls:?} N");
    let ratio = pulls[4] / pulls[0];
    assert!((0.5..0.8).contains(&ratio), "{ratio}");
}
