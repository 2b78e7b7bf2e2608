//! The law of contact between bodies: the impulses that keep predicted steps from ending inside one another.

mod of_nodes;
mod tasks;

use super::parts::Parts;
use crate::backend::cpu::Cpu;
use glam::{DVec3, DVec4};
use of_nodes::OfNodes;
use tasks::{Begin, Correct, Correction, Forces, Note, Push};

/// So many contacts are worth the threads; fewer are added up one after the other.
const WORTH_SHARING: usize = 1024;

/// What a node keeps, from step to step, of the shares that its mass was split into and is not any more. What bears a
/// load is the deeper inside the more shares there are: where these became fewer at once, all of that would come out in
/// a step, and of a cube in a tray, whose walls touch and let go in turn, with more energy than has gone in.
const KEEPS: f64 = 2.0 / 3.0;

/// What is no gain of energy, as a share of what contacts give and take.
const ROUNDING: f64 = 1e-9;

/// A point and what it faces.
#[derive(Clone, Copy, Debug)]
pub struct Contact {
    /// Its nodes.
    pub parts: Parts,
    /// The unit normal, from the face to the point.
    pub normal: DVec3,
    /// The gap (m) before the step, where it is negative no more than may be pushed out in a step.
    pub gap: f64,
    /// The point's step against the face (m): as it would be, and after [`ContactSet::solve`] as it will be where the
    /// contact presses.
    pub step: DVec3,
    /// The largest tangential part of a normal force.
    pub friction: f64,
    /// How far the point has slipped elastically along the face (m).
    pub slip: DVec3,
    /// The normal force on the point (N).
    pub pressing: f64,
    /// The tangential force on it (N).
    pub rubbing: DVec3,
    /// How far it slides in the step (m), found where it presses.
    pub slid: f64,
    /// Whether friction does not hold it.
    pub slides: bool,
    /// Whether a spring presses: by the gap alone, whatever the step that is predicted.
    pub springs: bool,
    /// What whoever made it knows of it: the number of the point, whether that meets a face, and not an edge another,
    /// and how far it was outside (m).
    pub point: u32,
    pub of_point: bool,
    pub outside: f64,
    /// How far it yields to a force (m/N), with the shares of its nodes.
    yields: f64,
    /// The same along the surface, and not less.
    yields_along: f64,
}

impl Contact {
    /// Of nodes, along a normal with a gap (m), with the step that is predicted (m), a coefficient of friction and the
    /// slip (m) so far.
    pub fn new(parts: Parts, (normal, gap, step): (DVec3, f64, DVec3), (friction, slip): (f64, DVec3)) -> Self {
        Self {
            parts,
            normal,
            gap,
            step,
            friction,
            slip,
            pressing: 0.0,
            rubbing: DVec3::ZERO,
            slid: 0.0,
            // what nothing holds
            slides: true,
            springs: false,
            point: 0,
            of_point: false,
            outside: gap,
            yields: 0.0,
            yields_along: 0.0,
        }
    }

    /// The force on the point (N).
    #[inline(always)]
    pub fn force(&self) -> DVec3 {
        self.normal * self.pressing + self.rubbing
    }

    /// The part of a vector along the surface.
    #[inline(always)]
    pub fn along(&self, vector: DVec3) -> DVec3 {
        vector - self.normal * vector.dot(self.normal)
    }

    /// Finds the normal force of the step that was predicted, with the shares of nodes; gives it as a vector (N).
    #[inline(always)]
    fn begin(&mut self, shares: &[f64], responses: &[DVec4]) -> DVec3 {
        self.find_yields(shares, responses);
        self.press(self.step)
    }

    /// Corrects the normal force by a step of the point against the face (m), and gives by how much (N).
    #[inline(always)]
    fn press(&mut self, step: DVec3) -> DVec3 {
        let (gap, before) = match self.springs {
            true => (self.gap, 0.0),
            false => (self.gap + self.normal.dot(step), self.pressing),
        };
        let pressing = if self.yields > 0.0 { (before - gap / self.yields).max(0.0) } else { 0.0 };
        let change = self.normal * (pressing - self.pressing);
        self.pressing = pressing;
        change
    }

    /// Corrects the tangential force, and gives by how much (N).
    #[inline(always)]
    fn rub(&mut self, steps: &[DVec4]) -> DVec3 {
        let presses = self.pressing > 0.0 || self.rubbing != DVec3::ZERO;
        if self.friction <= 0.0 || self.yields_along <= 0.0 || !presses {
            return DVec3::ZERO;
        }
        let slip = self.along(self.slip + self.parts.step(steps));
        let wanted = self.along(self.rubbing) - slip / self.yields_along;
        let (bound, size) = (self.friction * self.pressing, wanted.length());
        self.slides = size > bound;
        let rubbing = if self.slides { wanted * (bound / size) } else { wanted };
        let change = rubbing - self.rubbing;
        self.rubbing = rubbing;
        change
    }

    /// Notes where the point goes and how far it has slipped elastically, now that forces are known.
    #[inline(always)]
    fn note(&mut self, steps: &[DVec4]) {
        if self.pressing <= 0.0 {
            self.slip = DVec3::ZERO;
            return;
        }
        self.step = self.parts.step(steps);
        self.slid = if self.slides { self.along(self.step).length() } else { 0.0 };
        if self.friction <= 0.0 {
            self.slip = DVec3::ZERO;
            return;
        }
        let slip = self.along(self.slip + self.step);
        let (bound, size) = (self.friction * self.pressing * self.yields_along, slip.length());
        self.slip = if size > bound { slip * (bound / size) } else { slip };
    }

    /// Finds how far it yields to forces, from the shares of nodes.
    #[inline(always)]
    fn find_yields(&mut self, shares: &[f64], responses: &[DVec4]) {
        let (mut along_normal, mut largest) = (0.0, 0.0);
        let ((nodes, weights), normal) = (self.parts.slices(), self.normal.extend(0.0));
        for (&node, weight) in nodes.iter().zip(weights) {
            let (share, response) = (weight.abs() * shares[node as usize], responses[node as usize]);
            along_normal += share * normal.dot(response * normal);
            largest += share * response.max_element();
        }
        (self.yields, self.yields_along) = (along_normal, largest);
    }
}

/// What a contact begins a step with: the step that is predicted of the point against the face, and its slip (m).
#[derive(Clone, Copy, Debug)]
pub struct Beginning {
    step: DVec3,
    slip: DVec3,
}

/// Contacts that act in the same step, and the nodes they act on.
#[derive(Clone, Debug, Default)]
pub struct ContactSet {
    /// The contacts, in order: a batch for each task that works on them, some of them empty.
    pub batches: Vec<Vec<Contact>>,
    /// The nodes' next steps (m): as they would be, and after [`solve`](Self::solve) as they will be. Of each vector of
    /// a node the fourth number is 0: so it fills a register.
    pub steps: Vec<DVec4>,
    /// What they were in the step before (m).
    pub earlier: Vec<DVec4>,
    /// How far a node goes for a force along each axis (m/N); 0 where it is held.
    pub responses: Vec<DVec4>,
    /// The forces on nodes (N) that [`solve`](Self::solve) or [`find_forces`](Self::find_forces) has found.
    pub forces: Vec<DVec4>,
    /// Into how many shares each node's mass is split.
    shares: Vec<f64>,
    /// Into how many that of nodes that bore a force in the last step was split then, by their places.
    pub shares_before: Vec<(u32, f64)>,
    /// What a sweep changes of each contact's force (N).
    changes: Vec<DVec3>,
    /// Contacts of each node; of none where they are too few for threads.
    of_nodes: OfNodes,
}

impl ContactSet {
    /// Forgets all contacts, and has so many batches at least from now on.
    pub fn begin(&mut self, batches: usize) {
        self.batches.resize_with(batches.max(self.batches.len()), Vec::new);
        self.batches.iter_mut().for_each(Vec::clear);
    }

    /// Adds a contact to the last batch.
    pub fn add(&mut self, contact: Contact) {
        if self.batches.is_empty() {
            self.batches.push(Vec::new());
        }
        if let Some(last) = self.batches.last_mut() {
            last.push(contact);
        }
    }

    /// All contacts, in order.
    pub fn contacts(&self) -> impl Iterator<Item = &Contact> {
        self.batches.iter().flatten()
    }

    /// How many contacts there are.
    pub fn count(&self) -> usize {
        self.batches.iter().map(Vec::len).sum()
    }

    /// Bytes that it takes.
    pub fn bytes(&self) -> usize {
        let Self { batches, steps, earlier, responses, forces, shares, shares_before, changes, of_nodes } = self;
        let contacts: usize = batches.iter().map(|contacts| size_of_val(&contacts[..])).sum();
        let of_contacts = contacts + size_of_val(&changes[..]) + of_nodes.bytes();
        let vectors = [steps, earlier, responses, forces].map(|all| size_of_val(&all[..]));
        of_contacts + vectors.iter().sum::<usize>() + size_of_val(&shares[..]) + size_of_val(&shares_before[..])
    }

    /// Finds the forces.
    ///
    /// All contacts at once, with the mass of each node split among them by their weights: then no correction
    /// overshoots, whatever their number and order (the sum over contacts of λᵀDλ is never less than λᵀAλ of the exact
    /// coupling A, by Cauchy and Schwarz), momentum is kept to rounding, and the kinetic energy does not grow. Each
    /// further sweep descends to the solution of the linear complementarity problem (Tonge et al. 2012).
    ///
    /// Friction is the return mapping of an elastic slip that each contact keeps: it sticks without creep, and slides
    /// with exactly the largest force.
    pub fn solve(&mut self, sweeps: usize, cpu: &Cpu) {
        if self.count() == 0 {
            return clear_forces(&mut self.forces, self.steps.len());
        }
        match cpu.threads() > 1 && self.count() >= WORTH_SHARING {
            true => self.of_nodes.list(&self.batches, self.steps.len()),
            false => self.of_nodes.clear(),
        }
        self.share_masses(cpu);
        let (shares, responses) = (std::mem::take(&mut self.shares), std::mem::take(&mut self.responses));
        let rub = self.contacts().any(|contact| contact.friction > 0.0);
        for sweep in 0..sweeps.max(1) {
            match sweep {
                0 => self.press_first(&shares, &responses, cpu),
                _ => self.change(Correction::Pressing, &responses, cpu),
            }
            if rub {
                self.change(Correction::Rubbing, &responses, cpu);
            }
        }
        (self.shares, self.responses) = (shares, responses);
        let Self { batches, steps, forces, changes, of_nodes, .. } = self;
        clear_forces(forces, steps.len());
        if of_nodes.is_empty() {
            let notes = |contacts: &mut Vec<Contact>| cpu.dispatch(Note { contacts, steps, forces });
            return batches.iter_mut().for_each(notes);
        }
        cpu.for_each(of_batches(batches, changes), |(contacts, changes)| {
            cpu.dispatch(Note { contacts: &mut *contacts, steps, forces: &mut [] });
            contacts.iter().zip(changes).for_each(|(contact, change)| *change = contact.force());
        });
        of_nodes.add(changes, forces, cpu, |_, force| force);
    }

    /// Finds what contacts do to nodes, in the order of contacts.
    pub fn find_forces(&mut self, cpu: &Cpu) {
        let Self { batches, steps, forces, .. } = self;
        clear_forces(forces, steps.len());
        batches.iter().for_each(|contacts| cpu.dispatch(Forces { contacts, forces }));
    }

    /// What contacts do (J, but for what the lengths of steps make of it) to each node that they push, by its place and
    /// by the mean of its next step and the one before.
    pub fn works(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        let pushed = self.forces.iter().enumerate().filter(|(_, force)| **force != DVec4::ZERO);
        pushed.map(move |(node, force)| (node, 0.5 * force.dot(self.earlier[node] + self.steps[node])))
    }

    /// What its contacts begin the step with.
    pub fn beginnings(&self) -> impl Iterator<Item = Beginning> + '_ {
        self.contacts().map(|&Contact { step, slip, .. }| Beginning { step, slip })
    }

    /// Kinetic energy (J) that one sweep has given beyond what it can, from what contacts began with; 0 where it has
    /// not, but for rounding.
    ///
    /// That is at most Σ (g² − (n · r*)²)/(2D) + s²/(2D') over the contacts that press, r* the steps that were
    /// predicted, s what has slipped elastically: a point that is not inside takes energy, and one that is gives back
    /// what a spring would hold that is so stiff as to push it out in a step.
    pub fn beyond_bound(&self, before: &[Beginning]) -> f64 {
        let (mut beyond, mut size) = (0.0, 0.0);
        for (contact, start) in self.contacts().zip(before).filter(|(of, _)| of.pressing > 0.0) {
            let given = contact.force().dot(0.5 * (start.step + contact.step));
            let along = contact.normal.dot(start.step);
            let [inside, taken] = [contact.gap, along].map(|length| length * length / (2.0 * contact.yields));
            let rubs = contact.rubbing != DVec3::ZERO;
            let slipped = if rubs { start.slip.length_squared() / (2.0 * contact.yields_along) } else { 0.0 };
            beyond += given - inside + taken - slipped;
            // a step against the face is the difference of those of nodes, which may be far larger
            let of_nodes: f64 =
                contact.parts.iter().map(|(node, weight)| weight.abs() * self.steps[node].length()).sum();
            let by_rounding = (contact.force().length() + along.abs() / contact.yields) * of_nodes;
            size += given.abs() + inside + taken + slipped + by_rounding;
        }
        // what is no number is told of
        if beyond <= ROUNDING * size { 0.0 } else { beyond }
    }

    /// Into how many shares the mass of a node has been split.
    pub fn share(&self, node: usize) -> f64 {
        self.shares[node]
    }

    /// Splits the mass of each node among its contacts, and among those that it had, by and by less.
    fn share_masses(&mut self, cpu: &Cpu) {
        let Self { batches, steps, shares, shares_before, of_nodes, .. } = self;
        shares.clear();
        shares.resize(steps.len(), 0.0);
        match of_nodes.is_empty() {
            false => of_nodes.share(shares, cpu),
            true => {
                for (node, weight) in batches.iter().flatten().flat_map(|contact| contact.parts.iter()) {
                    shares[node] += weight.abs();
                }
            }
        }
        for &(node, before) in &*shares_before {
            let share = &mut shares[node as usize];
            // what touches nothing has none
            if *share > 0.0 && before > *share {
                *share += KEEPS * (before - *share);
            }
        }
    }

    /// Finds normal forces, and corrects the steps of nodes by that. Steps against faces are known, so that of one
    /// thread each contact is gone to once.
    fn press_first(&mut self, shares: &[f64], responses: &[DVec4], cpu: &Cpu) {
        if !self.of_nodes.is_empty() {
            return self.change(Correction::First { shares, responses }, responses, cpu);
        }
        let Self { batches, steps, .. } = self;
        batches.iter_mut().for_each(|contacts| cpu.dispatch(Begin { contacts, shares, responses, steps }));
    }

    /// Corrects forces, and the steps of nodes by that.
    fn change(&mut self, correction: Correction<'_>, responses: &[DVec4], cpu: &Cpu) {
        let count = self.count();
        let Self { batches, steps, changes, of_nodes, .. } = self;
        changes.resize(count, DVec3::ZERO);
        let now = &*steps;
        cpu.for_each(of_batches(batches, changes), |(contacts, changes)| {
            cpu.dispatch(Correct { correction, contacts, changes, steps: now });
        });
        if of_nodes.is_empty() {
            let push = |(contacts, changes): (&mut [Contact], &mut [DVec3])| {
                cpu.dispatch(Push { contacts, changes, responses, steps });
            };
            return of_batches(batches, changes).for_each(push);
        }
        of_nodes.add(changes, steps, cpu, |node, change| responses[node] * change);
    }
}

/// Batches with what each contact of theirs has of all.
fn of_batches<'a>(
    batches: &'a mut [Vec<Contact>],
    mut left: &'a mut [DVec3],
) -> impl Iterator<Item = (&'a mut [Contact], &'a mut [DVec3])> {
    batches.iter_mut().map(move |contacts| {
        let (of_batch, others) = std::mem::take(&mut left).split_at_mut(contacts.len());
        left = others;
        (&mut contacts[..], of_batch)
    })
}

/// Forces on so many nodes: none.
fn clear_forces(forces: &mut Vec<DVec4>, nodes: usize) {
    forces.clear();
    forces.resize(nodes, DVec4::ZERO);
}

#[cfg(test)]
mod tests;
