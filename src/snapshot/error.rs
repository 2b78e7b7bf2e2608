//! Why a snapshot is refused.

use std::path::PathBuf;

/// A snapshot that cannot be taken, read, or gone on from.
#[derive(Debug, thiserror::Error)]
pub enum SnapshotError {
    /// The system does not let it be read.
    #[error("cannot read the snapshot {}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
    /// The bytes do not begin as a snapshot does.
    #[error("this is no snapshot of sinew: {0}")]
    NoSnapshot(String),
    /// Bytes are missing, or some follow.
    #[error("the snapshot is cut short or has been added to: it says that it has {said} bytes, and there are {found}")]
    Length {
        /// Bytes that it should have.
        said: u64,
        /// Bytes that there are.
        found: u64,
    },
    /// The bytes are not those that were written.
    #[error("the snapshot is damaged: its checksum does not fit its content")]
    Damaged,
    /// The content makes no sense.
    #[error("the snapshot makes no sense: {0}")]
    Senseless(String),
    /// It is of something else than what it is to be put into.
    #[error("the snapshot is of another simulation: {0}")]
    Foreign(String),
    /// A simulation of which there are no snapshots.
    #[error("a static analysis has no snapshots: its pseudo-steps are no motion that could be gone on with")]
    Static,
    /// A custom system's state cannot be kept or taken back.
    #[error("the state of the system `{system}` cannot be {done}: {reason}")]
    System {
        /// The system.
        system: String,
        /// `kept` or `taken back`.
        done: &'static str,
        /// Why.
        reason: String,
    },
}
