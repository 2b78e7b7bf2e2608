//! The law of what is tied: the forces that let points end where they are tied to, in all directions and both ways.

use glam::DVec3;

/// A point that is tied to another.
#[derive(Clone, Debug, Default)]
pub struct Tie {
    /// Places in [`TieSet::steps`] with signed weights: positive of the point's nodes, negative of the other's.
    pub parts: Vec<(u32, f64)>,
    /// How far from where it belongs it is before the step (m).
    pub off: DVec3,
    /// The force on the point (N).
    pub force: DVec3,
    /// How far it yields to a force (m/N) at most, with the shares of its nodes.
    yields: f64,
}

impl Tie {
    /// Of nodes with signed weights, so far off (m).
    pub fn new(parts: Vec<(u32, f64)>, off: DVec3) -> Self {
        Self { parts, off, ..Self::default() }
    }

    /// The point's step against the other's (m).
    pub fn relative(&self, steps: &[DVec3]) -> DVec3 {
        self.parts.iter().map(|&(node, weight)| steps[node as usize] * weight).sum()
    }
}

/// Ties that act in the same step, and the nodes they act on.
#[derive(Clone, Debug, Default)]
pub struct TieSet {
    /// The ties.
    pub ties: Vec<Tie>,
    /// The nodes' next steps (m): as they would be, and after [`solve`](Self::solve) as they will be.
    pub steps: Vec<DVec3>,
    /// How far a node goes for a force along each axis (m/N); 0 where it is held.
    pub responses: Vec<DVec3>,
}

impl TieSet {
    /// Finds the forces: f = −(o + r*)/D a sweep, all ties at once, with the mass of each node split among its ties by
    /// their weights, as of contacts ([`ContactSet::solve`](super::ContactSet::solve)): no correction overshoots,
    /// momentum is kept to rounding, and the kinetic energy does not grow where nothing was off. What one sweep leaves
    /// is carried on to the next step.
    pub fn solve(&mut self, sweeps: usize) {
        let mut shares = vec![0.0; self.steps.len()];
        for &(node, weight) in self.ties.iter().flat_map(|tie| &tie.parts) {
            shares[node as usize] += weight.abs();
        }
        for tie in &mut self.ties {
            let of = |&(node, weight): &(u32, f64)| {
                weight.abs() * shares[node as usize] * self.responses[node as usize].max_element()
            };
            tie.yields = tie.parts.iter().map(of).sum();
        }
        let mut changes = vec![DVec3::ZERO; self.ties.len()];
        for _ in 0..sweeps.max(1) {
            for (tie, change) in self.ties.iter_mut().zip(&mut changes) {
                let left = tie.off + tie.relative(&self.steps);
                *change = if tie.yields > 0.0 { left * (-1.0 / tie.yields) } else { DVec3::ZERO };
                tie.force += *change;
            }
            for (tie, change) in self.ties.iter().zip(&changes) {
                for &(node, weight) in &tie.parts {
                    self.steps[node as usize] += self.responses[node as usize] * (*change * weight);
                }
            }
        }
    }
}
