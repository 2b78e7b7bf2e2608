//! What a program has done to a run so far, as a hash: by it a snapshot is known as one of the run's own past.

use twox_hash::XxHash64;

/// So many changes are remembered at most: a snapshot from before the oldest counts as one from elsewhere.
const MOST: usize = 1 << 20;

/// Hashes of all changes of inputs, grabs and steps, by the step that began with them.
#[derive(Debug, Default)]
pub(super) struct Lineage {
    /// The step from which on all changes are known, and the hash of those before.
    from: (u64, u64),
    /// Steps that began with changes, ascending, with the hash of all changes up to those.
    changes: Vec<(u64, u64)>,
}

impl Lineage {
    /// Takes note of a change before a step.
    pub fn note(&mut self, step: u64, what: &str) {
        let before = self.changes.last().map_or(self.from.1, |change| change.1);
        let hash = XxHash64::oneshot(before, format!("{step} {what}").as_bytes());
        match self.changes.last_mut() {
            Some(last) if last.0 == step => last.1 = hash,
            _ => self.changes.push((step, hash)),
        }
        if self.changes.len() > MOST
            && let Some((step, hash)) = self.changes.drain(..MOST / 2).next_back()
        {
            self.from = (step + 1, hash);
        }
    }

    /// The hash of all changes before a step, which does not count those that it began with; `None` where they are not
    /// known.
    pub fn before(&self, step: u64) -> Option<u64> {
        let count = self.changes.partition_point(|change| change.0 < step);
        let last = count.checked_sub(1).and_then(|last| self.changes.get(last));
        (step >= self.from.0).then(|| last.map_or(self.from.1, |change| change.1))
    }

    /// The run goes on from a step with such a hash, where it was at the step `now`; whether it has been there.
    pub fn go_on_from(&mut self, step: u64, hash: u64, now: u64) -> bool {
        let ours = step <= now && self.before(step) == Some(hash);
        match ours {
            true => self.changes.retain(|change| change.0 < step),
            false => *self = Self { from: (step, hash), changes: Vec::new() },
        }
        ours
    }
}

#[cfg(test)]
mod tests;
