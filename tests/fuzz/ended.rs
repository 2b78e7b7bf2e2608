//! How runs ended, and whether two ended alike.

use crate::whole::MOST_STEPS;
use glam::DVec3;
use sinew::Snapshot;

/// How a run ended: its last state, or what was wrong.
pub struct Run {
    pub ended: Result<(), String>,
    /// Steps taken, the length of the last (s), and when it ended (s).
    pub steps: u64,
    pub time_step: f64,
    pub time: f64,
    pub bytes: Vec<u8>,
    pub displacements: Vec<DVec3>,
    /// The largest share of its energy that came from nothing or went there, as the run itself tells.
    pub imbalance: f64,
}

pub fn whole_of(run: &Run) -> Run {
    Run { ended: run.ended.clone(), bytes: run.bytes.clone(), displacements: run.displacements.clone(), ..*run }
}

/// The largest distance between two sets of displacements, as a share of the largest displacement.
fn apart(a: &[DVec3], b: &[DVec3]) -> f64 {
    let largest = a.iter().chain(b).fold(1e-9_f64, |most, u| most.max(u.length()));
    a.iter().zip(b).fold(0.0_f64, |most, (a, b)| most.max((*a - *b).length())) / largest
}

pub fn same(what: &str, a: &Run, b: &Run) -> Result<(), String> {
    if a.ended != b.ended {
        return Err(format!("{what}: {:?}, and without: {:?}", b.ended, a.ended));
    }
    if a.bytes != b.bytes {
        let parts = match (Snapshot::from_bytes(&a.bytes), Snapshot::from_bytes(&b.bytes)) {
            (Ok(a), Ok(b)) => a.differences(&b).join(", "),
            _ => "no snapshots".into(),
        };
        return Err(format!("{what}: other bits in {parts}"));
    }
    Ok(())
}

pub fn near(what: &str, a: &Run, b: &Run, most: f64) -> Result<(), String> {
    if a.ended.is_err() || b.ended.is_err() {
        // near a limit rounding may decide
        return Ok(());
    }
    if a.steps == MOST_STEPS && b.steps == MOST_STEPS && (a.time - b.time).abs() > a.time_step.max(b.time_step) {
        // cut off at other times, since their steps were others
        return Ok(());
    }
    // where rounding has decided when a step that follows became another, what differs is the error of the scheme
    // itself: of motion that holds so much of the energy as a run says went non_finite, amplitudes go with its root
    let alike = a.steps == b.steps && (a.time_step - b.time_step).abs() <= 1e-9 * a.time_step;
    let most = if alike { most } else { most.max(0.05).max(a.imbalance.max(b.imbalance).sqrt()) };
    let apart = apart(&a.displacements, &b.displacements);
    if apart <= most {
        return Ok(());
    }
    let steps = [a, b].map(|run| (run.steps, run.time_step, run.time));
    Err(format!("{what}: displacements differ by {apart:.2e}; steps, the last ones' lengths, ends: {steps:?}"))
}
