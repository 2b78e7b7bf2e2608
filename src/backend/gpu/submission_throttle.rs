//! How many steps go into one submission: as many as are done in a tenth of a second, so that no driver's watchdog
//! bites and the desktop stays alive, and no more than 256.

use std::collections::{HashMap, VecDeque};
use std::sync::Arc;

use web_time::Instant;
use wgpu::SubmissionIndex;

use crate::backend::kernel::KernelId;

/// Seconds a submission should take at most.
const TARGET: f64 = 0.1;
/// The same where a window is drawn by the device, too: half of a frame.
const SHARED_TARGET: f64 = 0.008;
/// Steps a submission has at most.
pub(super) const MOST_STEPS: u32 = 256;
/// Submissions in flight: the GPU works on one while the next is encoded.
const IN_FLIGHT: usize = 2;

/// Measured speed of lists of kernels, and the submissions not yet waited for.
#[derive(Default)]
pub(super) struct SubmissionThrottle {
    /// A window is drawn by the same device.
    shared: bool,
    seconds_per_step: HashMap<Arc<[KernelId]>, f64>,
    flights: VecDeque<Flight>,
    last_end: Option<Instant>,
    /// made so far
    pub(super) submissions: u64,
    /// dispatches in them
    pub(super) dispatches: u64,
}

struct Flight {
    index: SubmissionIndex,
    kernels: Arc<[KernelId]>,
    steps: u32,
    submitted: Instant,
}

impl SubmissionThrottle {
    /// For a device that is ours alone, or shared with a window.
    pub(super) fn new(shared: bool) -> Self {
        Self { shared, ..Self::default() }
    }

    /// Steps for the next submission: one until there is a measurement.
    pub(super) fn batch(&self, kernels: &[KernelId]) -> u32 {
        let target = if self.shared { SHARED_TARGET } else { TARGET };
        let fits = |seconds: &f64| (target / seconds.max(1e-9)) as u32;
        self.seconds_per_step.get(kernels).map_or(1, fits).clamp(1, MOST_STEPS)
    }

    /// Notes a submission.
    pub(super) fn submitted(&mut self, index: SubmissionIndex, kernels: Arc<[KernelId]>, steps: u32) {
        self.submissions += 1;
        self.flights.push_back(Flight { index, kernels, steps, submitted: Instant::now() });
    }

    /// The submission to wait for before the next: when too many are in flight, or nothing is known of its speed.
    pub(super) fn due(&self) -> Option<SubmissionIndex> {
        let oldest = self.flights.front()?;
        let unknown = !self.seconds_per_step.contains_key(&oldest.kernels);
        (unknown || self.flights.len() >= IN_FLIGHT).then(|| oldest.index.clone())
    }

    /// The oldest submission not yet waited for.
    pub(super) fn oldest(&self) -> Option<SubmissionIndex> {
        self.flights.front().map(|flight| flight.index.clone())
    }

    /// The oldest submission has ended: measures it.
    pub(super) fn retire(&mut self) {
        let Some(flight) = self.flights.pop_front() else { return };
        let now = Instant::now();
        let begun = self.last_end.map_or(flight.submitted, |end| end.max(flight.submitted));
        self.last_end = Some(now);
        let measured = (now - begun).as_secs_f64() / f64::from(flight.steps);
        // a host that came back late measures too much: believe at most a doubling
        let seconds = self.seconds_per_step.entry(flight.kernels).or_insert(measured);
        *seconds = measured.min(*seconds * 2.0);
    }
}

#[cfg(test)]
mod tests;
