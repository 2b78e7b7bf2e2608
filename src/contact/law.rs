//! The law of contact between bodies: the impulses that keep predicted steps from ending inside one another.

use crate::backend::cpu::Cpu;
use glam::DVec3;

/// Contacts and nodes that a task works on.
const CONTACTS_A_TASK: usize = 256;

/// So many contacts are worth the threads; fewer are added up one after the other.
const WORTH_SHARING: usize = 1024;

/// What is no gain of energy, as a share of what contacts give and take.
const ROUNDING: f64 = 1e-9;

/// Nodes of a contact: at most four of the point's and four of the face's.
const MOST: usize = 8;

/// A point and what it faces.
#[derive(Clone, Copy, Debug)]
pub struct Contact {
    /// Places in [`ContactSet::steps`], the first [`count`](Self::count) of them.
    pub nodes: [u32; MOST],
    /// Their signed weights: positive of the point's nodes, negative of the face's.
    pub weights: [f64; MOST],
    /// How many.
    pub count: usize,
    /// The unit normal, from the face to the point.
    pub normal: DVec3,
    /// The gap (m) before the step, where it is negative no more than may be pushed out in a step.
    pub gap: f64,
    /// The largest tangential part of a normal force.
    pub friction: f64,
    /// How far the point has slipped elastically along the face (m).
    pub slip: DVec3,
    /// The normal force on the point (N).
    pub pressing: f64,
    /// The tangential force on it (N).
    pub rubbing: DVec3,
    /// Whether friction does not hold it.
    pub slides: bool,
    /// Whether a spring presses: by the gap alone, whatever the step that is predicted.
    pub springs: bool,
    /// How far it yields to a force (m/N), with the shares of its nodes.
    yields: f64,
    /// The same along the surface, and not less.
    yields_along: f64,
}

impl Contact {
    /// Of no nodes yet, along a normal with a gap (m), with a coefficient of friction and the slip (m) so far.
    pub fn new((normal, gap): (DVec3, f64), (friction, slip): (f64, DVec3)) -> Self {
        Self {
            nodes: [0; MOST],
            weights: [0.0; MOST],
            count: 0,
            normal,
            gap,
            friction,
            slip,
            pressing: 0.0,
            rubbing: DVec3::ZERO,
            slides: false,
            springs: false,
            yields: 0.0,
            yields_along: 0.0,
        }
    }

    /// Adds a node with its signed weight: positive of the point's, negative of the face's; eight at most.
    pub fn add(&mut self, node: u32, weight: f64) {
        if weight != 0.0 && self.count < MOST {
            (self.nodes[self.count], self.weights[self.count]) = (node, weight);
            self.count += 1;
        }
    }

    /// Its nodes with their weights.
    pub fn parts(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        let count = self.count.min(MOST);
        self.nodes[..count].iter().zip(&self.weights[..count]).map(|(&node, &weight)| (node as usize, weight))
    }

    /// The force on the point (N).
    pub fn force(&self) -> DVec3 {
        self.normal * self.pressing + self.rubbing
    }

    /// The point's step against the face (m).
    pub fn relative(&self, steps: &[DVec3]) -> DVec3 {
        self.parts().map(|(node, weight)| steps[node] * weight).sum()
    }

    /// The part of a vector along the surface.
    pub fn along(&self, vector: DVec3) -> DVec3 {
        vector - self.normal * vector.dot(self.normal)
    }

    /// Corrects the normal force, and gives by how much (N).
    fn press(&mut self, steps: &[DVec3]) -> DVec3 {
        let (gap, before) = match self.springs {
            true => (self.gap, 0.0),
            false => (self.gap + self.normal.dot(self.relative(steps)), self.pressing),
        };
        let pressing = if self.yields > 0.0 { (before - gap / self.yields).max(0.0) } else { 0.0 };
        let change = self.normal * (pressing - self.pressing);
        self.pressing = pressing;
        change
    }

    /// Corrects the tangential force, and gives by how much (N).
    fn rub(&mut self, steps: &[DVec3]) -> DVec3 {
        let presses = self.pressing > 0.0 || self.rubbing != DVec3::ZERO;
        if self.friction <= 0.0 || self.yields_along <= 0.0 || !presses {
            return DVec3::ZERO;
        }
        let slip = self.along(self.slip + self.relative(steps));
        let wanted = self.along(self.rubbing) - slip / self.yields_along;
        let (bound, size) = (self.friction * self.pressing, wanted.length());
        self.slides = size > bound;
        let rubbing = if self.slides { wanted * (bound / size) } else { wanted };
        let change = rubbing - self.rubbing;
        self.rubbing = rubbing;
        change
    }

    /// Notes how far it has slipped elastically, now that forces are known.
    fn note_slip(&mut self, steps: &[DVec3]) {
        if self.pressing <= 0.0 || self.friction <= 0.0 {
            self.slip = DVec3::ZERO;
            return;
        }
        let slip = self.along(self.slip + self.relative(steps));
        let (bound, size) = (self.friction * self.pressing * self.yields_along, slip.length());
        self.slip = if size > bound { slip * (bound / size) } else { slip };
    }

    /// Finds how far it yields to forces, from the shares of nodes.
    fn find_yields(&mut self, shares: &[f64], responses: &[DVec3]) {
        let (mut along_normal, mut largest) = (0.0, 0.0);
        for (node, weight) in self.parts() {
            let (share, response) = (weight.abs() * shares[node], responses[node]);
            along_normal += share * self.normal.dot(response * self.normal);
            largest += share * response.max_element();
        }
        (self.yields, self.yields_along) = (along_normal, largest);
    }
}

/// Contacts that act in the same step, and the nodes they act on.
#[derive(Clone, Debug, Default)]
pub struct ContactSet {
    /// The contacts.
    pub contacts: Vec<Contact>,
    /// The nodes' next steps (m): as they would be, and after [`solve`](Self::solve) as they will be.
    pub steps: Vec<DVec3>,
    /// What they were in the step before (m).
    pub earlier: Vec<DVec3>,
    /// How far a node goes for a force along each axis (m/N); 0 where it is held.
    pub responses: Vec<DVec3>,
    /// Into how many shares each node's mass is split.
    shares: Vec<f64>,
    /// What a sweep changes of each contact's force (N).
    changes: Vec<DVec3>,
    /// Where each node's contacts begin in the next list; empty where contacts are too few for threads.
    starts: Vec<u32>,
    /// Contacts of each node, ascending, with its weights.
    of_nodes: Vec<(u32, f64)>,
}

impl ContactSet {
    /// Forgets contacts and nodes.
    pub fn clear(&mut self) {
        self.contacts.clear();
        self.steps.clear();
        self.earlier.clear();
        self.responses.clear();
    }

    /// Bytes that it takes.
    pub fn bytes(&self) -> usize {
        let Self { contacts, steps, earlier, responses, shares, changes, starts, of_nodes } = self;
        let of_contacts = size_of_val(&contacts[..]) + size_of_val(&changes[..]) + size_of_val(&of_nodes[..]);
        let vectors = size_of_val(&steps[..]) + size_of_val(&earlier[..]) + size_of_val(&responses[..]);
        of_contacts + vectors + size_of_val(&shares[..]) + size_of_val(&starts[..])
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
        self.list_nodes(cpu);
        self.changes.clear();
        self.changes.resize(self.contacts.len(), DVec3::ZERO);
        let (shares, responses) = (self.shares(), std::mem::take(&mut self.responses));
        let rub = self.contacts.iter().any(|contact| contact.friction > 0.0);
        for sweep in 0..sweeps.max(1) {
            let press = |contact: &mut Contact, steps: &[DVec3]| {
                if sweep == 0 {
                    contact.find_yields(&shares, &responses);
                }
                contact.press(steps)
            };
            self.change(press, &responses, cpu);
            if rub {
                self.change(Contact::rub, &responses, cpu);
            }
        }
        (self.shares, self.responses) = (shares, responses);
        let steps = &self.steps;
        cpu.for_each(self.contacts.chunks_mut(CONTACTS_A_TASK), |contacts| {
            contacts.iter_mut().for_each(|contact| contact.note_slip(steps));
        });
    }

    /// Kinetic energy (J) that one sweep has given beyond what it can, from the set `before` that; 0 where it has not,
    /// but for rounding.
    ///
    /// That is at most Σ (g² − (n · r*)²)/(2D) + s²/(2D') over the contacts that press, r* the steps that were
    /// predicted, s what has slipped elastically: a point that is not inside takes energy, and one that is gives back
    /// what a spring would hold that is so stiff as to push it out in a step.
    pub fn beyond_bound(&self, before: &Self) -> f64 {
        let (mut beyond, mut size) = (0.0, 0.0);
        for (contact, start) in self.contacts.iter().zip(&before.contacts).filter(|(of, _)| of.pressing > 0.0) {
            let predicted = start.relative(&before.steps);
            let given = contact.force().dot(0.5 * (predicted + contact.relative(&self.steps)));
            let along = contact.normal.dot(predicted);
            let [inside, taken] = [start.gap, along].map(|length| length * length / (2.0 * contact.yields));
            let rubs = contact.rubbing != DVec3::ZERO;
            let slipped = if rubs { start.slip.length_squared() / (2.0 * contact.yields_along) } else { 0.0 };
            beyond += given - inside + taken - slipped;
            size += given.abs() + inside + taken + slipped;
        }
        // what is no number is told of
        if beyond <= ROUNDING * size { 0.0 } else { beyond }
    }

    /// Lists contacts by node where there are so many that threads add up what they do: in the order in which one
    /// thread would, so that the bits are the same.
    fn list_nodes(&mut self, cpu: &Cpu) {
        let Self { contacts, steps, starts, of_nodes, .. } = self;
        starts.clear();
        if cpu.threads() == 1 || contacts.len() < WORTH_SHARING {
            return;
        }
        starts.resize(steps.len() + 1, 0);
        contacts.iter().for_each(|contact| contact.parts().for_each(|(node, _)| starts[node + 1] += 1));
        (0..steps.len()).for_each(|node| starts[node + 1] += starts[node]);
        of_nodes.clear();
        of_nodes.resize(starts[steps.len()] as usize, (0, 0.0));
        // the start of each node runs to its end, which is the next one's start
        for (number, contact) in (0..).zip(&*contacts) {
            for (node, weight) in contact.parts() {
                of_nodes[starts[node] as usize] = (number, weight);
                starts[node] += 1;
            }
        }
        starts.rotate_right(1);
        starts[0] = 0;
    }

    /// Into how many shares the mass of each node is split among its contacts.
    fn shares(&mut self) -> Vec<f64> {
        let mut shares = std::mem::take(&mut self.shares);
        shares.clear();
        shares.resize(self.steps.len(), 0.0);
        for contact in &self.contacts {
            contact.parts().for_each(|(node, weight)| shares[node] += weight.abs());
        }
        shares
    }

    /// Corrects forces, and the steps of nodes by that.
    fn change(
        &mut self,
        correct: impl Fn(&mut Contact, &[DVec3]) -> DVec3 + Sync + Send,
        responses: &[DVec3],
        cpu: &Cpu,
    ) {
        let Self { contacts, steps, changes, starts, of_nodes, .. } = self;
        let now = &*steps;
        let tasks = contacts.chunks_mut(CONTACTS_A_TASK).zip(changes.chunks_mut(CONTACTS_A_TASK));
        cpu.for_each(tasks, |(contacts, changes)| {
            contacts.iter_mut().zip(changes).for_each(|(contact, change)| *change = correct(contact, now));
        });
        let changes = &*changes;
        if starts.is_empty() {
            for (contact, change) in contacts.iter().zip(changes).filter(|(_, change)| **change != DVec3::ZERO) {
                contact.parts().for_each(|(node, weight)| steps[node] += responses[node] * (*change * weight));
            }
            return;
        }
        cpu.for_each(steps.chunks_mut(CONTACTS_A_TASK).enumerate(), |(task, steps)| {
            for (node, step) in (task * CONTACTS_A_TASK..).zip(steps) {
                for &(contact, weight) in &of_nodes[starts[node] as usize..starts[node + 1] as usize] {
                    let change = changes[contact as usize];
                    if change != DVec3::ZERO {
                        *step += responses[node] * (change * weight);
                    }
                }
            }
        });
    }
}

#[cfg(test)]
mod tests;
