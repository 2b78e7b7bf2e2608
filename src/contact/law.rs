//! The law of contact between bodies: the impulses that keep predicted steps from ending inside one another.

use glam::DVec3;

/// Nodes of a contact: at most three of the point's and three of the face's.
const MOST: usize = 6;

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
            yields: 0.0,
            yields_along: 0.0,
        }
    }

    /// Adds a node with its signed weight: positive of the point's, negative of the face's; six at most.
    pub fn add(&mut self, node: u32, weight: f64) {
        if weight != 0.0 && self.count < MOST {
            (self.nodes[self.count], self.weights[self.count]) = (node, weight);
            self.count += 1;
        }
    }

    /// Its nodes with their weights.
    pub fn parts(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.nodes.iter().zip(self.weights).take(self.count).map(|(&node, weight)| (node as usize, weight))
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
    fn along(&self, vector: DVec3) -> DVec3 {
        vector - self.normal * vector.dot(self.normal)
    }
}

/// Contacts that act in the same step, and the nodes they act on.
#[derive(Clone, Debug, Default)]
pub struct ContactSet {
    /// The contacts.
    pub contacts: Vec<Contact>,
    /// The nodes' next steps (m): as they would be, and after [`solve`](Self::solve) as they will be.
    pub steps: Vec<DVec3>,
    /// How far a node goes for a force along each axis (m/N); 0 where it is held.
    pub responses: Vec<DVec3>,
    /// Into how many shares each node's mass is split.
    shares: Vec<f64>,
    /// What a sweep changes of each contact's force (N).
    changes: Vec<DVec3>,
}

impl ContactSet {
    /// Forgets contacts and nodes.
    pub fn clear(&mut self) {
        self.contacts.clear();
        self.steps.clear();
        self.responses.clear();
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
    pub fn solve(&mut self, sweeps: usize) {
        self.split();
        for _ in 0..sweeps.max(1) {
            self.changes.clear();
            for contact in &mut self.contacts {
                let gap = contact.gap + contact.normal.dot(contact.relative(&self.steps));
                let pressing = match contact.yields > 0.0 {
                    true => (contact.pressing - gap / contact.yields).max(0.0),
                    false => 0.0,
                };
                self.changes.push(contact.normal * (pressing - contact.pressing));
                contact.pressing = pressing;
            }
            self.apply();
            self.changes.clear();
            for contact in &mut self.contacts {
                let mut change = DVec3::ZERO;
                if contact.friction > 0.0 && contact.yields_along > 0.0 {
                    let slip = contact.along(contact.slip + contact.relative(&self.steps));
                    let wanted = contact.along(contact.rubbing) - slip / contact.yields_along;
                    let (bound, size) = (contact.friction * contact.pressing, wanted.length());
                    contact.slides = size > bound;
                    let rubbing = if contact.slides { wanted * (bound / size) } else { wanted };
                    change = rubbing - contact.rubbing;
                    contact.rubbing = rubbing;
                }
                self.changes.push(change);
            }
            self.apply();
        }
        for contact in &mut self.contacts {
            let slip = contact.along(contact.slip + contact.relative(&self.steps));
            let (bound, size) = (contact.friction * contact.pressing * contact.yields_along, slip.length());
            contact.slip = if size > bound { slip * (bound / size) } else { slip };
        }
    }

    /// Splits the mass of each node among its contacts.
    fn split(&mut self) {
        self.shares.clear();
        self.shares.resize(self.steps.len(), 0.0);
        for contact in &self.contacts {
            for (node, weight) in contact.parts() {
                self.shares[node] += weight.abs();
            }
        }
        for contact in &mut self.contacts {
            let (mut along_normal, mut largest) = (0.0, 0.0);
            for (node, weight) in contact.parts() {
                let (share, response) = (weight.abs() * self.shares[node], self.responses[node]);
                along_normal += share * contact.normal.dot(response * contact.normal);
                largest += share * response.max_element();
            }
            (contact.yields, contact.yields_along) = (along_normal, largest);
        }
    }

    fn apply(&mut self) {
        for (contact, change) in self.contacts.iter().zip(&self.changes) {
            if *change != DVec3::ZERO {
                for (node, weight) in contact.parts() {
                    self.steps[node] += self.responses[node] * (*change * weight);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests;
