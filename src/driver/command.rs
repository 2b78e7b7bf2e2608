//! What can be asked of a simulation while it runs.

use crate::scene::schema::OutputField;
use crate::{Pick, SceneFile, Snapshot};
use glam::DVec3;

/// What can be asked of a [`Session`](super::Session).
#[derive(Clone, Debug)]
pub enum Command {
    /// Go on. At the end of the scene it pauses, unless a hand holds something; asked again it goes on beyond.
    Run,
    /// Stay.
    Pause,
    /// Stay, after so many steps.
    Step(u64),
    /// Simulated seconds a second on the wall, 1 at first; infinite: as fast as it can.
    Speed(f64),
    /// Back to the state before the first step.
    Reset,
    /// Back to the last state kept that is not later than a time (s).
    Rewind(f64),
    /// Over to a state of the same scene that was kept elsewhere: [`Simulation::restore`](crate::Simulation::restore).
    Restore(Box<Snapshot>),
    /// Change parameters by the words of `--set`: [`Simulation::change`](crate::Simulation::change).
    Set(Vec<String>),
    /// Set an input of the scene.
    Input {
        /// Its name.
        name: String,
        /// The factor that it goes to.
        value: f64,
    },
    /// Take hold of what a ray first meets, with a hand of any number; what that held is let go.
    Grab {
        /// The hand.
        hand: u32,
        /// Where the ray begins (m).
        origin: DVec3,
        /// Where it goes.
        direction: DVec3,
    },
    /// Take hold of a point that was picked elsewhere, as among what is drawn, with a hand; what that held is let go.
    GrabAt {
        /// The hand.
        hand: u32,
        /// The point: its body, nodes and weights count.
        pick: Box<Pick>,
    },
    /// Move what a hand pulls towards to a place (m).
    MoveGrab {
        /// The hand.
        hand: u32,
        /// The place (m).
        target: DVec3,
    },
    /// Let go with a hand.
    Release {
        /// The hand.
        hand: u32,
    },
    /// Say what lies where a ray first meets a body; forget what was asked before where it meets none.
    Pick {
        /// Where the ray begins (m).
        origin: DVec3,
        /// Where it goes.
        direction: DVec3,
    },
    /// Say what lies at a point that was picked elsewhere; forget what was asked before where there is none.
    PickAt(Option<Box<Pick>>),
    /// Which field states have values of; none at first.
    Field(Option<OutputField>),
    /// Which field of vectors of nodes states have for arrows; none at first.
    Arrows(Option<OutputField>),
    /// Whether who looks draws bodies on the GPU from where they are ([`Body::on_gpu`](super::Body::on_gpu)): positions
    /// and elements that are left are then brought from there for one of four states of a simulation that runs, and
    /// those between have the last ones.
    Lend(bool),
    /// Go over to another scene. If that is refused, the old one goes on.
    Load(Box<SceneFile>),
}
