//! The law of ties on random sets.

use fastrand::Rng;
use glam::DVec3;
use sinew::contact::{Tie, TieSet};

fn vector(random: &mut Rng) -> DVec3 {
    DVec3::from_array([0; 3].map(|_| 2.0 * random.f64() - 1.0))
}

/// Ties between some nodes, of masses that differ a thousand times.
fn random_set(random: &mut Rng) -> TieSet {
    let nodes = random.u32(5..12);
    let steps: Vec<DVec3> = (0..nodes).map(|_| vector(random)).collect();
    let responses = (0..nodes).map(|_| DVec3::splat(10.0_f64.powf(3.0 * random.f64()))).collect();
    let ties = (0..6).map(|_| {
        let mut all: Vec<u32> = (0..nodes).collect();
        random.shuffle(&mut all);
        let weights = [random.f64(), random.f64(), random.f64()];
        let sum: f64 = weights.iter().sum();
        let others = all[1..4].iter().zip(weights).map(|(&node, weight)| (node, -weight / sum));
        Tie::new(std::iter::once((all[0], 1.0)).chain(others).collect(), 1, DVec3::ZERO)
    });
    let ties = ties.collect();
    TieSet::new(ties, steps, responses)
}

fn momentum(set: &TieSet) -> DVec3 {
    set.steps.iter().zip(&set.responses).map(|(step, response)| *step / *response).sum()
}

fn energy(set: &TieSet) -> f64 {
    set.steps.iter().zip(&set.responses).map(|(step, response)| step.dot(*step / *response)).sum()
}

#[test]
fn ties_keep_momentum_and_make_no_energy() {
    let mut random = Rng::with_seed(11);
    for _ in 0..1000 {
        let mut set = random_set(&mut random);
        let (before, most) = (momentum(&set), energy(&set));
        let left = |set: &TieSet| set.ties.iter().map(|tie| (tie.off + tie.relative(&set.steps)).length()).sum::<f64>();
        let apart = left(&set);
        set.solve(1);
        let scale: f64 = set.responses.iter().map(|response| 1.0 / response.x).sum();
        assert!((momentum(&set) - before).length() < 1e-13 * scale, "{set:?}");
        assert!(energy(&set) <= most * (1.0 + 1e-13), "{set:?}");
        set.solve(200);
        assert!(left(&set) < 0.5 * apart, "sweeps bring what is tied together: {} of {apart}", left(&set));
    }
}

#[test]
fn a_single_tie_is_exact_in_one_sweep() {
    let steps = vec![DVec3::new(1.0, 2.0, 3.0), DVec3::new(-1.0, 0.5, 0.0)];
    let responses = vec![DVec3::splat(0.5), DVec3::splat(0.25)];
    let off = DVec3::new(0.1, 0.0, -0.2);
    let mut set = TieSet::new(vec![Tie::new(vec![(0, 1.0), (1, -1.0)], 1, off)], steps, responses);
    set.solve(1);
    assert!((set.ties[0].relative(&set.steps) + off).length() < 1e-15, "{set:?}");
}

/// Over a gap the other end lies beyond its nodes, and one of them has a weight of the sign of the point's. The
/// stiffness that solvers know of a tie is that of the mass of its point.
#[test]
fn the_spring_of_a_tie_over_a_gap_weighs_its_point_alone() {
    let (steps, responses) = (vec![DVec3::ZERO; 4], vec![DVec3::ONE; 4]);
    let parts = vec![(0, 0.5), (1, 0.5), (2, -1.4), (3, 0.4)];
    let off = DVec3::new(0.1, 0.0, -0.2);
    let mut set = TieSet::new(vec![Tie::new(parts, 2, off)], steps, responses);
    set.press(&[2.0, 4.0, 50.0, 1000.0], 10.0);
    assert!((set.ties[0].force + 30.0 * off).length() < 1e-13, "{set:?}");
}
