//! The law of what is tied: the forces that let points end where they are tied to, in all directions and both ways.

use glam::DVec3;

/// A point that is tied to another.
#[derive(Clone, Debug)]
pub struct Tie {
    /// Places in [`TieSet::steps`] with signed weights: positive of the point's nodes, negative of the other's.
    pub parts: Vec<(u32, f64)>,
    /// How many of these, the first, are the point's: of the other's, too, some weights may be positive.
    points: usize,
    /// Whether it bears anything.
    pub holds: bool,
    /// How far from where it belongs it is before the step (m).
    pub off: DVec3,
    /// The force on the point (N).
    pub force: DVec3,
    /// How far it yields to a force (m/N) at most, with the shares of its nodes.
    yields: f64,
    /// What its force has changed by in a sweep (N).
    change: DVec3,
}

impl Tie {
    /// Of nodes with signed weights, of which the first so many are the point's, so far off (m).
    pub fn new(parts: Vec<(u32, f64)>, points: usize, off: DVec3) -> Self {
        Self { parts, points, holds: true, off, force: DVec3::ZERO, yields: 0.0, change: DVec3::ZERO }
    }

    /// The point's step against the other's (m).
    pub fn relative(&self, steps: &[DVec3]) -> DVec3 {
        self.parts.iter().map(|&(node, weight)| steps[node as usize] * weight).sum()
    }
}

/// Ties that act in the same step, and the nodes they act on.
#[derive(Clone, Debug, Default)]
pub struct TieSet {
    /// The ties; those that hold no more change nothing.
    pub ties: Vec<Tie>,
    /// The nodes' next steps (m): as they would be, and after [`solve`](Self::solve) as they will be.
    pub steps: Vec<DVec3>,
    /// How far a node goes for a force along each axis (m/N); 0 where it is held.
    pub responses: Vec<DVec3>,
    /// Into how many shares each node's mass is split.
    shares: Vec<f64>,
}

impl TieSet {
    /// Of ties between nodes with these next steps (m) and responses (m/N).
    pub fn new(ties: Vec<Tie>, steps: Vec<DVec3>, responses: Vec<DVec3>) -> Self {
        Self { ties, steps, responses, shares: Vec::new() }
    }

    /// Finds the forces: f = −(o + r*)/D a sweep, all ties at once, with the mass of each node split among its ties by
    /// their weights, as of contacts ([`ContactSet::solve`](super::ContactSet::solve)): no correction overshoots,
    /// momentum is kept to rounding, and the kinetic energy does not grow where nothing was off. What one sweep leaves
    /// is carried on to the next step.
    pub fn solve(&mut self, sweeps: usize) {
        self.split();
        let Self { ties, steps, responses, shares } = self;
        for tie in ties.iter_mut().filter(|tie| tie.holds) {
            let of = |&(node, weight): &(u32, f64)| {
                weight.abs() * shares[node as usize] * responses[node as usize].max_element()
            };
            tie.yields = tie.parts.iter().map(of).sum();
        }
        for _ in 0..sweeps.max(1) {
            for tie in ties.iter_mut().filter(|tie| tie.holds) {
                let left = tie.off + tie.relative(steps);
                tie.change = if tie.yields > 0.0 { left * (-1.0 / tie.yields) } else { DVec3::ZERO };
                tie.force += tie.change;
            }
            for tie in ties.iter().filter(|tie| tie.holds) {
                for &(node, weight) in &tie.parts {
                    steps[node as usize] += responses[node as usize] * (tie.change * weight);
                }
            }
        }
    }

    /// Splits the mass of each node among the ties that hold it.
    fn split(&mut self) {
        let Self { ties, steps, shares, .. } = self;
        shares.clear();
        shares.resize(steps.len(), 0.0);
        for &(node, weight) in ties.iter().filter(|tie| tie.holds).flat_map(|tie| &tie.parts) {
            shares[node as usize] += weight.abs();
        }
    }

    /// Finds the forces of springs in their place, as implicit steps solve for them: −k o, k so much (1/s²) times the
    /// mass of the point, of the nodes' masses (kg).
    pub fn press(&mut self, masses: &[f64], per_mass: f64) {
        self.split();
        for tie in self.ties.iter_mut().filter(|tie| tie.holds) {
            let of_point = tie.parts.iter().take(tie.points);
            let mass: f64 = of_point.map(|&(node, weight)| weight * masses[node as usize]).sum();
            tie.force = tie.off * (-per_mass * mass);
        }
    }

    /// Whether a tie that holds acts on a node, as of the last [`solve`](Self::solve) or
    /// [`press`](Self::press).
    pub fn is_tied(&self, node: usize) -> bool {
        self.shares.get(node).is_some_and(|shares| *shares > 0.0)
    }
}
