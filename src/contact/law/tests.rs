//! The law on random sets of contacts, some of them redundant.

use super::*;
use fastrand::Rng;

fn one() -> Cpu {
    Cpu::new(1, 0, Default::default())
}

fn vector(random: &mut Rng) -> DVec3 {
    DVec3::from_array([0; 3].map(|_| 2.0 * random.f64() - 1.0))
}

/// Nodes of masses that differ a thousand times, some held along an axis, in random contacts; the masses.
fn random_set(random: &mut Rng, friction: f64, least: f64) -> (ContactSet, Vec<f64>) {
    let count = random.usize(6..30);
    let masses: Vec<f64> = (0..count).map(|_| 10.0_f64.powf(3.0 * random.f64())).collect();
    let mut set = ContactSet {
        steps: (0..count).map(|_| vector(random)).collect(),
        responses: masses.iter().map(|mass| DVec3::splat(1.0 / mass)).collect(),
        ..ContactSet::default()
    };
    for _ in 0..random.usize(1..40) {
        let normal = vector(random).normalize();
        let mut contact = Contact::new((normal, 0.4 * random.f64() - least), (friction, DVec3::ZERO));
        let mut nodes: Vec<u32> = (0..count as u32).collect();
        random.shuffle(&mut nodes);
        let weights = [random.f64(), random.f64(), random.f64()];
        let sum: f64 = weights.iter().sum();
        match random.bool() {
            true => contact.add(nodes[0], 1.0),
            false => (0..3).for_each(|i| contact.add(nodes[i], weights[i] / sum)),
        }
        let weights = [random.f64(), random.f64(), random.f64()];
        let sum: f64 = weights.iter().sum();
        (0..3).for_each(|i| contact.add(nodes[3 + i], -weights[i] / sum));
        set.contacts.push(contact);
        // twice the same
        if random.u8(0..4) == 0 {
            set.contacts.push(contact);
        }
    }
    (set, masses)
}

fn kinetic(masses: &[f64], steps: &[DVec3]) -> f64 {
    masses.iter().zip(steps).map(|(mass, step)| 0.5 * mass * step.length_squared()).sum()
}

#[test]
fn momentum_stays_and_energy_is_below_its_bound() {
    let mut random = Rng::with_seed(18);
    for round in 0..3000 {
        let friction = if round % 2 == 0 { 0.0 } else { random.f64() };
        // a third of the sets begin inside one another
        let least = if round % 3 == 0 { 0.1 } else { 0.0 };
        let (mut set, masses) = random_set(&mut random, friction, least);
        let sweeps = 1 + round % 5 / 2;
        let before = set.clone();
        set.solve(sweeps, &one());
        let momentum = |steps: &[DVec3]| masses.iter().zip(steps).map(|(mass, step)| *step * *mass).sum::<DVec3>();
        let scale: f64 = masses.iter().zip(&before.steps).map(|(mass, step)| mass * step.length()).sum();
        let change = (momentum(&set.steps) - momentum(&before.steps)).length();
        assert!(change <= 1e-12 * scale, "momentum changed by {change} of {scale}");
        let [earlier, later] = [&before, &set].map(|set| kinetic(&masses, &set.steps));
        assert!(least > 0.0 || later <= earlier * (1.0 + 1e-12), "{later} of {earlier} J");
        // the bound of one sweep: each contact takes at least what a point of its own would lose, and gives at most
        // what that would get
        if sweeps == 1 {
            let most: f64 = before
                .contacts
                .iter()
                .zip(&set.contacts)
                .filter(|(_, after)| after.pressing > 0.0)
                .map(|(contact, after)| {
                    let relative = contact.normal.dot(contact.relative(&before.steps));
                    (contact.gap * contact.gap - relative * relative) / (2.0 * after.yields)
                })
                .sum();
            assert!(later <= earlier + most + 1e-12 * earlier, "{later} of {earlier} and {most} J");
            assert_eq!(set.beyond_bound(&before), 0.0);
        }
        // what is lost is what the forces took
        let took: f64 = set
            .contacts
            .iter()
            .map(|contact| contact.force().dot(0.5 * (contact.relative(&before.steps) + contact.relative(&set.steps))))
            .sum();
        assert!((later - earlier - took).abs() <= 1e-11 * earlier, "{} and {took}", later - earlier);
        for contact in &set.contacts {
            assert!(contact.pressing >= 0.0 && contact.rubbing.length() <= friction * contact.pressing * (1.0 + 1e-12));
        }
    }
}

/// What has slipped elastically comes back at most; a law that pushes three times as hard gives more than it can.
#[test]
fn energy_beyond_the_bound_is_found() {
    let mut random = Rng::with_seed(34);
    let mut found = 0;
    for round in 0..1000 {
        let (mut set, _) = random_set(&mut random, 0.5, 0.05);
        // several that share nodes correct each other by less
        set.contacts.truncate(if round % 2 == 0 { 1 } else { 40 });
        for contact in &mut set.contacts {
            contact.slip = 0.3 * vector(&mut random);
        }
        let before = set.clone();
        set.solve(1, &one());
        assert_eq!(set.beyond_bound(&before), 0.0);
        for contact in &mut set.contacts {
            (contact.pressing, contact.rubbing) = (3.0 * contact.pressing, 3.0 * contact.rubbing);
        }
        for (step, predicted) in set.steps.iter_mut().zip(&before.steps) {
            *step = *predicted + 3.0 * (*step - *predicted);
        }
        found += usize::from(set.beyond_bound(&before) > 0.0);
        set.steps[0].x = f64::NAN;
        let has_first = set.contacts.iter().any(|of| of.pressing > 0.0 && of.parts().any(|(node, _)| node == 0));
        assert_eq!(set.beyond_bound(&before).is_nan(), has_first);
    }
    assert!(found > 50, "{found} of 500 that press alone, as far as they do");
}

/// The largest eigenvalue of D⁻¹ A is at most 1: by the power method.
#[test]
fn shares_of_mass_majorise_the_coupling_of_contacts() {
    let mut random = Rng::with_seed(81);
    let mut largest = 0.0_f64;
    for _ in 0..300 {
        let (mut set, _) = random_set(&mut random, 0.0, 0.0);
        let (shares, responses) = (set.shares(), set.responses.clone());
        set.contacts.iter_mut().for_each(|contact| contact.find_yields(&shares, &responses));
        let count = set.contacts.len();
        let mut forces: Vec<f64> = (0..count).map(|_| random.f64()).collect();
        let mut growth = 0.0;
        for _ in 0..200 {
            let mut steps = vec![DVec3::ZERO; set.steps.len()];
            for (contact, force) in set.contacts.iter().zip(&forces) {
                for (node, weight) in contact.parts() {
                    steps[node] += set.responses[node] * (contact.normal * (*force * weight));
                }
            }
            let next: Vec<f64> = set
                .contacts
                .iter()
                .map(|contact| contact.normal.dot(contact.relative(&steps)) / contact.yields)
                .collect();
            let norm = |all: &[f64]| {
                all.iter().zip(&set.contacts).map(|(x, contact)| x * x * contact.yields).sum::<f64>().sqrt()
            };
            growth = norm(&next) / norm(&forces);
            let size = norm(&next);
            forces = next.into_iter().map(|force| force / size).collect();
        }
        assert!(growth.is_finite() && growth <= 1.0 + 1e-12, "{growth}");
        largest = largest.max(growth);
    }
    assert!(largest > 0.9, "the bound is no better than {largest}");
}

/// Sets large enough to be shared out come to the same bits.
#[test]
fn threads_find_the_same_forces() {
    let mut random = Rng::with_seed(5);
    let count = 900;
    let mut set = ContactSet {
        steps: (0..count).map(|_| vector(&mut random)).collect(),
        responses: (0..count).map(|_| DVec3::splat(0.1 + random.f64())).collect(),
        ..ContactSet::default()
    };
    for _ in 0..3 * WORTH_SHARING {
        let normal = vector(&mut random).normalize();
        let mut contact = Contact::new((normal, 0.2 * random.f64() - 0.1), (0.3, DVec3::ZERO));
        let first = random.u32(0..count as u32 - 4);
        contact.add(first, 1.0);
        (1..4).for_each(|next| contact.add(first + next, -1.0 / 3.0));
        set.contacts.push(contact);
    }
    let mut shared = set.clone();
    set.solve(2, &one());
    shared.solve(2, &Cpu::new(3, 0, Default::default()));
    assert_eq!(set.steps, shared.steps);
    assert!(set.contacts.iter().zip(&shared.contacts).all(|(a, b)| a.force() == b.force() && a.slip == b.slip));
    assert!(!shared.starts.is_empty() && set.starts.is_empty());
}

#[test]
fn one_contact_ends_on_the_surface_and_friction_holds_it() {
    let mut set = ContactSet {
        steps: vec![DVec3::new(0.3, 0.0, -1.0), DVec3::ZERO],
        responses: vec![DVec3::splat(0.5), DVec3::ZERO],
        ..ContactSet::default()
    };
    let mut contact = Contact::new((DVec3::Z, 0.25), (0.5, DVec3::ZERO));
    contact.add(0, 1.0);
    contact.add(1, -1.0);
    set.contacts.push(contact);
    set.solve(1, &one());
    assert_eq!(set.steps[0], DVec3::new(0.0, 0.0, -0.25));
    assert_eq!((set.contacts[0].pressing, set.contacts[0].slides), (1.5, false));
    // with too little friction it slides on, held by μ N
    set.steps[0] = DVec3::new(0.3, 0.0, -1.0);
    let contact = &mut set.contacts[0];
    (contact.friction, contact.pressing, contact.rubbing, contact.slip) = (0.2, 0.0, DVec3::ZERO, DVec3::ZERO);
    set.solve(1, &one());
    assert!((set.steps[0].x - 0.15).abs() < 1e-15 && set.contacts[0].slides, "{:?}", set.steps);
}
