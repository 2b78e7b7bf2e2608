//! The law on random sets of contacts, some of them redundant.

use super::*;
use fastrand::Rng;

fn one() -> Cpu {
    Cpu::new(1, 0, Default::default())
}

fn wide(random: &mut Rng) -> DVec4 {
    vector(random).extend(0.0)
}

fn vector(random: &mut Rng) -> DVec3 {
    DVec3::from_array([0; 3].map(|_| 2.0 * random.f64() - 1.0))
}

/// Nodes of masses that differ a thousand times, some held along an axis, in random contacts; the masses.
fn random_set(random: &mut Rng, friction: f64, least: f64) -> (ContactSet, Vec<f64>) {
    let count = random.usize(6..30);
    let masses: Vec<f64> = (0..count).map(|_| 10.0_f64.powf(3.0 * random.f64())).collect();
    let steps: Vec<DVec4> = (0..count).map(|_| wide(random)).collect();
    let mut set = ContactSet {
        earlier: steps.clone(),
        steps,
        responses: masses.iter().map(|mass| DVec3::splat(1.0 / mass).extend(0.0)).collect(),
        ..ContactSet::default()
    };
    for _ in 0..random.usize(1..40) {
        let normal = vector(random).normalize();
        let mut parts = Parts::default();
        let mut nodes: Vec<u32> = (0..count as u32).collect();
        random.shuffle(&mut nodes);
        let weights = [random.f64(), random.f64(), random.f64()];
        let sum: f64 = weights.iter().sum();
        match random.bool() {
            true => parts.add(nodes[0], 1.0),
            false => (0..3).for_each(|i| parts.add(nodes[i], weights[i] / sum)),
        }
        let weights = [random.f64(), random.f64(), random.f64()];
        let sum: f64 = weights.iter().sum();
        (0..3).for_each(|i| parts.add(nodes[3 + i], -weights[i] / sum));
        let step = parts.step(&set.steps);
        let contact = Contact::new(parts, (normal, 0.4 * random.f64() - least, step), (friction, DVec3::ZERO));
        set.add(contact);
        // twice the same
        if random.u8(0..4) == 0 {
            set.add(contact);
        }
    }
    (set, masses)
}

fn kinetic(masses: &[f64], steps: &[DVec4]) -> f64 {
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
        // more of them had shares in the last step
        if round % 4 == 0 {
            set.shares_before = (0..masses.len() as u32).map(|node| (node, 5.0 * random.f64())).collect();
        }
        let before = set.clone();
        set.solve(sweeps, &one());
        let momentum = |steps: &[DVec4]| masses.iter().zip(steps).map(|(mass, step)| *step * *mass).sum::<DVec4>();
        let scale: f64 = masses.iter().zip(&before.steps).map(|(mass, step)| mass * step.length()).sum();
        let change = (momentum(&set.steps) - momentum(&before.steps)).length();
        assert!(change <= 1e-12 * scale, "momentum changed by {change} of {scale}");
        let went = set.steps.iter().zip(&before.steps).zip(&masses).map(|((after, before), m)| (after - before) * *m);
        let most = set.forces.iter().map(|force| force.length()).fold(0.0, f64::max);
        let off = went.zip(&set.forces).map(|(went, force)| went.distance(*force)).fold(0.0, f64::max);
        assert!(off <= 1e-12 * (scale + most), "forces are off by {off} of {most}");
        let [earlier, later] = [&before, &set].map(|set| kinetic(&masses, &set.steps));
        assert!(least > 0.0 || later <= earlier * (1.0 + 1e-12), "{later} of {earlier} J");
        // the bound of one sweep: each contact takes at least what a point of its own would lose, and gives at most
        // what that would get
        if sweeps == 1 {
            let most: f64 = before
                .contacts()
                .zip(set.contacts())
                .filter(|(_, after)| after.pressing > 0.0)
                .map(|(contact, after)| {
                    let relative = contact.normal.dot(contact.step);
                    (contact.gap * contact.gap - relative * relative) / (2.0 * after.yields)
                })
                .sum();
            assert!(later <= earlier + most + 1e-12 * earlier, "{later} of {earlier} and {most} J");
            assert_eq!(set.beyond_bound(&before.beginnings().collect::<Vec<_>>()), 0.0);
        }
        // what is lost is what the forces took
        let took: f64 = set.works().map(|(_, work)| work).sum();
        assert!((later - earlier - took).abs() <= 1e-11 * earlier, "{} and {took}", later - earlier);
        for contact in set.contacts() {
            assert!(contact.pressing >= 0.0 && contact.rubbing.length() <= friction * contact.pressing * (1.0 + 1e-12));
        }
    }
}

/// What was split into more shares in the last step keeps a part of them, so that what is inside comes out by and by;
/// more shares than before count at once, and what touches nothing has none.
#[test]
fn shares_come_at_once_and_go_by_and_by() {
    let out = |before: f64| {
        let mut set = ContactSet {
            steps: vec![DVec4::ZERO; 2],
            earlier: vec![DVec4::ZERO; 2],
            responses: vec![DVec4::new(1.0, 1.0, 1.0, 0.0), DVec4::ZERO],
            shares_before: vec![(0, before), (1, before)],
            ..ContactSet::default()
        };
        let mut parts = Parts::default();
        parts.add(0, 1.0);
        set.add(Contact::new(parts, (DVec3::Z, -1.0, DVec3::ZERO), (0.0, DVec3::ZERO)));
        set.solve(1, &one());
        assert!(set.steps[1] == DVec4::ZERO && set.share(1) == 0.0);
        [set.steps[0].z, set.share(0)]
    };
    for before in [0.0, 0.5, 1.0] {
        assert_eq!(out(before), [1.0, 1.0]);
    }
    let [step, share] = out(4.0);
    assert!((share - 3.0).abs() < 1e-15 && (step - 1.0 / 3.0).abs() < 1e-15, "{share} {step}");
}

/// What has slipped elastically comes back at most; a law that pushes three times as hard gives more than it can.
#[test]
fn energy_beyond_the_bound_is_found() {
    let mut random = Rng::with_seed(34);
    let mut found = 0;
    for round in 0..1000 {
        let (all, _) = random_set(&mut random, 0.5, 0.05);
        let ContactSet { steps, earlier, responses, .. } = all.clone();
        let mut set = ContactSet { steps, earlier, responses, ..ContactSet::default() };
        // several that share nodes correct each other by less
        for mut contact in all.batches.into_iter().flatten().take(if round % 2 == 0 { 1 } else { 40 }) {
            contact.slip = 0.3 * vector(&mut random);
            set.add(contact);
        }
        let before = set.clone();
        set.solve(1, &one());
        assert_eq!(set.beyond_bound(&before.beginnings().collect::<Vec<_>>()), 0.0);
        for (step, predicted) in set.steps.iter_mut().zip(&before.steps) {
            *step = *predicted + 3.0 * (*step - *predicted);
        }
        let find_steps = |set: &mut ContactSet| {
            let ContactSet { batches, steps, .. } = set;
            batches.iter_mut().flatten().for_each(|contact| contact.step = contact.parts.step(steps));
        };
        for contact in set.batches.iter_mut().flatten() {
            (contact.pressing, contact.rubbing) = (3.0 * contact.pressing, 3.0 * contact.rubbing);
        }
        find_steps(&mut set);
        found += usize::from(set.beyond_bound(&before.beginnings().collect::<Vec<_>>()) > 0.0);
        set.steps[0].x = f64::NAN;
        find_steps(&mut set);
        let has_first = set.contacts().any(|of| of.pressing > 0.0 && of.parts.iter().any(|(node, _)| node == 0));
        assert_eq!(set.beyond_bound(&before.beginnings().collect::<Vec<_>>()).is_nan(), has_first);
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
        // some are held along an axis
        for response in &mut set.responses {
            if random.u8(0..3) == 0 {
                response[random.usize(0..3)] = 0.0;
            }
        }
        set.share_masses(&one());
        let (shares, responses) = (set.shares.clone(), set.responses.clone());
        set.batches.iter_mut().flatten().for_each(|contact| contact.find_yields(&shares, &responses));
        let count = set.count();
        let mut forces: Vec<f64> = (0..count).map(|_| random.f64()).collect();
        let mut growth = 0.0;
        for _ in 0..200 {
            let mut steps = vec![DVec4::ZERO; set.steps.len()];
            for (contact, force) in set.contacts().zip(&forces) {
                contact.parts.push(contact.normal * *force, &set.responses, &mut steps);
            }
            let next: Vec<f64> =
                set.contacts().map(|contact| contact.normal.dot(contact.parts.step(&steps)) / contact.yields).collect();
            let norm = |all: &[f64]| {
                all.iter().zip(set.contacts()).map(|(x, contact)| x * x * contact.yields).sum::<f64>().sqrt()
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
    const BATCHES: usize = 9;
    let mut random = Rng::with_seed(5);
    let count = 900;
    let mut set = ContactSet {
        steps: (0..count).map(|_| wide(&mut random)).collect(),
        earlier: vec![DVec4::ZERO; count],
        responses: (0..count).map(|_| DVec3::splat(0.1 + random.f64()).extend(0.0)).collect(),
        // one of them stays empty
        batches: vec![Vec::new(); BATCHES + 1],
        ..ContactSet::default()
    };
    for _ in 0..3 * WORTH_SHARING {
        let normal = vector(&mut random).normalize();
        let mut parts = Parts::default();
        let first = random.u32(0..count as u32 - 4);
        parts.add(first, 1.0);
        (1..4).for_each(|next| parts.add(first + next, -1.0 / 3.0));
        let step = parts.step(&set.steps);
        let contact = Contact::new(parts, (normal, 0.2 * random.f64() - 0.1, step), (0.3, DVec3::ZERO));
        set.batches[random.usize(0..BATCHES)].push(contact);
    }
    let mut shared = set.clone();
    set.solve(2, &one());
    shared.solve(2, &Cpu::new(3, 0, Default::default()));
    assert_eq!((&set.steps, &set.forces), (&shared.steps, &shared.forces));
    assert!(set.contacts().zip(shared.contacts()).all(|(a, b)| a.force() == b.force() && a.slip == b.slip));
    assert!(!shared.of_nodes.is_empty() && set.of_nodes.is_empty());
}

#[test]
fn without_contacts_there_are_no_forces_and_steps_stay() {
    let steps = vec![DVec4::X, DVec4::Y];
    let forces = vec![DVec4::ONE; 3];
    let mut set = ContactSet { steps: steps.clone(), forces, ..ContactSet::default() };
    set.solve(2, &one());
    assert_eq!((set.steps, set.forces), (steps, vec![DVec4::ZERO; 2]));
}

#[test]
fn one_contact_ends_on_the_surface_and_friction_holds_it() {
    let mut set = ContactSet {
        steps: vec![DVec4::new(0.3, 0.0, -1.0, 0.0), DVec4::ZERO],
        earlier: vec![DVec4::ZERO; 2],
        responses: vec![DVec4::new(0.5, 0.5, 0.5, 0.0), DVec4::ZERO],
        ..ContactSet::default()
    };
    let mut parts = Parts::default();
    parts.add(0, 1.0);
    parts.add(1, -1.0);
    set.add(Contact::new(parts, (DVec3::Z, 0.25, set.steps[0].truncate()), (0.5, DVec3::ZERO)));
    set.solve(1, &one());
    assert_eq!(set.steps[0], DVec4::new(0.0, 0.0, -0.25, 0.0));
    assert_eq!((set.batches[0][0].pressing, set.batches[0][0].slides), (1.5, false));
    // with too little friction it slides on, held by μ N
    set.steps[0] = DVec4::new(0.3, 0.0, -1.0, 0.0);
    set.batches[0][0] = Contact::new(parts, (DVec3::Z, 0.25, set.steps[0].truncate()), (0.2, DVec3::ZERO));
    set.solve(1, &one());
    assert!((set.steps[0].x - 0.15).abs() < 1e-15 && set.batches[0][0].slides, "{:?}", set.steps);
}
