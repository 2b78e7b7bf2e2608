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
mod tests {
    use super::*;

    #[test]
    fn a_state_is_of_the_past_only_with_the_same_changes_before_it() {
        let mut lineage = Lineage::default();
        let start = lineage.before(3).unwrap_or(1);
        lineage.note(3, "a");
        lineage.note(3, "b");
        lineage.note(7, "c");
        let [three, four, eight] = [3, 4, 8].map(|step| lineage.before(step).unwrap_or(1));
        assert!(start == 0 && three == start && four != start && eight != four);
        // the present and the past are its own, the future is not
        assert!(lineage.go_on_from(5, four, 9));
        assert_eq!(lineage.before(9), Some(four));
        assert!(!lineage.go_on_from(6, four, 5));
        assert_eq!((lineage.before(5), lineage.before(6)), (None, Some(four)));
        // nor is what went elsewhere
        let mut other = Lineage::default();
        other.note(3, "other");
        assert!(!other.go_on_from(4, four, 9));
        assert!(other.go_on_from(4, four, 4));
    }

    #[test]
    fn what_is_long_past_is_forgotten() {
        let mut lineage = Lineage::default();
        (0..=MOST as u64).for_each(|step| lineage.note(step, "moved"));
        let left = MOST as u64 / 2;
        assert!(lineage.changes.len() == MOST / 2 + 1 && lineage.before(left - 1).is_none());
        assert!(lineage.before(left).is_some() && lineage.before(left) != lineage.before(left + 1));
    }
}
