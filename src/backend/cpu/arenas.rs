//! Memory for what lives no longer than a pass: asked of the system once, used again in every step.

use bumpalo::Bump;
use std::sync::{Mutex, PoisonError};

/// Bytes of a new arena.
const FIRST: usize = 64 << 10;

/// Arenas that nobody uses at the moment. A pass within a pass takes another one.
#[derive(Default)]
pub(super) struct Arenas(Mutex<Vec<Bump>>);

impl Arenas {
    /// Lends one to a task; what the task puts there is forgotten, not dropped.
    pub(super) fn with<R>(&self, task: impl FnOnce(&Bump) -> R) -> R {
        let free = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let taken = free().pop();
        let mut arena = taken.unwrap_or_else(|| Bump::with_capacity(FIRST));
        let result = task(&arena);
        arena.reset();
        free().push(arena);
        result
    }
}
