//! What a search for rest has found.

use super::super::implicit::PathPoint;
use serde::Serialize;

/// The equilibrium that a static analysis has found, or how far it came.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Equilibrium {
    /// Whether it is one within the tolerance.
    pub reached: bool,
    /// ‖R − F‖ over free axes, as a share of `scale`.
    pub residual: f64,
    /// About what rounding of displacements, and of places where something touches or is tied, makes of the residual at
    /// least, as a share of `scale`.
    pub rounding: f64,
    /// The share that is small enough, beside what rounding makes.
    pub tolerance: f64,
    /// ‖R‖ over free axes and ‖F − R‖ over held ones, together (N).
    pub scale: f64,
    /// About how far nodes still have to go, as a share of their displacements (root mean squares).
    pub remaining_motion: f64,
    /// The body with the largest force that nothing balances, the author's number of its node, and the force (N).
    pub worst: (String, u64, f64),
    /// Steps over which loads grew, as planned.
    pub load_steps: u64,
    /// How often steps were taken back.
    pub setbacks: u32,
    /// Newton's iterations that led there at last; 0 where pseudo-steps did.
    pub newton_iterations: u64,
    /// Whether bodies give way along some motion: what is found is an equilibrium, but none that lasts. Known of
    /// Newton's iterations in f64, where no body is free to move as a whole.
    pub unstable: bool,
    /// What loads move and nothing holds, in words, where that is why there is none.
    pub not_held: Vec<String>,
    /// Which body flies away and where to, in words, where that is why there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flies_away: Option<String>,
    /// The path of equilibria that led there, where one was followed.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub path: Vec<PathPoint>,
}
