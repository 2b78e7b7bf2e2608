//! What keeping surfaces apart took in a run.

use super::Simulation;
use crate::systems::SurfaceContacts;
use serde::Serialize;

/// What keeping surfaces apart took since the run began or went on. What kernels of a GPU do is not counted.
#[derive(Clone, Copy, Debug, Serialize, PartialEq)]
pub struct SurfaceContactUse {
    /// Points that may meet faces.
    pub points: usize,
    /// Triangles of the faces.
    pub faces: usize,
    /// Time on the host (s).
    pub seconds: Option<f64>,
    /// That over the time of solving.
    pub share: Option<f64>,
    /// Points that were near something and looked at, a step.
    pub points_near: Option<f64>,
    /// Time over points that were looked at (ns).
    pub nanoseconds_a_near_point: Option<f64>,
    /// Contacts a step.
    pub contacts: Option<f64>,
    /// Steps in which nothing was near.
    pub asleep: Option<u64>,
    /// How often lists of what may be near what were made.
    pub builds: u64,
    /// That over the time simulated (1/s).
    pub builds_a_second: f64,
    /// How long making them took (s).
    pub build_seconds: f64,
    /// Steps on a GPU that found their lists too old, and went through all faces.
    pub unlisted: u64,
    /// The deepest that a point was inside after a step (m).
    pub deepest: Option<f64>,
    /// Bytes on the host beside the columns of bodies: surfaces, trees, lists, what a step finds.
    pub bytes: usize,
}

impl Simulation {
    /// What keeping surfaces apart took, of a run that solved for so long (s).
    pub(super) fn surface_contact_use(&self, solving: f64) -> Option<SurfaceContactUse> {
        let contacts = self.world.get_resource::<SurfaceContacts>()?;
        let (figures, [points, faces]) = (contacts.figures(), contacts.size());
        let entry = self.entries.iter().find(|entry| entry.name == "surface_contact");
        let on_host = |entry: &&super::ScheduledPass| matches!(entry.job, super::Job::Host { .. });
        let seconds = entry.filter(on_host).map(|entry| entry.time.as_secs_f64());
        let steps = (figures.steps > 0).then_some(figures.steps as f64);
        let examined = figures.examined as f64;
        Some(SurfaceContactUse {
            points,
            faces,
            seconds,
            share: seconds.filter(|_| solving > 0.0).map(|seconds| seconds / solving),
            points_near: steps.map(|steps| examined / steps),
            nanoseconds_a_near_point: seconds.filter(|_| figures.examined > 0).map(|of| of * 1e9 / examined),
            contacts: steps.map(|steps| figures.contacts as f64 / steps),
            asleep: steps.map(|_| figures.asleep),
            builds: figures.builds,
            builds_a_second: figures.builds as f64 / (self.time() - self.began.1).max(f64::MIN_POSITIVE),
            build_seconds: figures.building.as_secs_f64(),
            unlisted: figures.unlisted,
            deepest: steps.map(|_| figures.deepest),
            bytes: contacts.memory().total(),
        })
    }
}
