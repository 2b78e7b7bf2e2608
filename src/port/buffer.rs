//! A triple buffer of atomic words: one thread writes, another reads what was written last, and neither waits.
//!
//! The writer fills a slot of its own and changes it for the spare one, the reader changes its own for the spare one
//! where that is fresh. Both changes are one atomic byte each, which releases what the slot holds and acquires what the
//! other side left in the slot that it gets. Words are atomic for the sake of safe code: nobody else has the slot.
//! `tests/interleavings` goes through all orders in which two threads may do this, and all that memory may show them.

use super::sync::{Arc, AtomicU8, AtomicU64, Ordering};

/// Which slot, in the byte.
const SLOT: u8 = 3;
/// Whether the spare slot was written after the reader left it there.
const FRESH: u8 = 4;

/// A slot; not on the cache lines of another.
#[derive(Debug)]
#[repr(align(128))]
struct Slot<const N: usize>([AtomicU64; N]);

#[derive(Debug)]
struct Shared<const N: usize> {
    slots: [Slot<N>; 3],
    spare: AtomicU8,
}

/// The side that writes.
#[derive(Debug)]
pub struct Writer<const N: usize> {
    shared: Arc<Shared<N>>,
    own: u8,
}

/// The side that reads.
#[derive(Debug)]
pub struct Reader<const N: usize> {
    shared: Arc<Shared<N>>,
    own: u8,
}

/// Both sides of a new buffer for messages of N words.
pub fn triple_buffer<const N: usize>() -> (Writer<N>, Reader<N>) {
    let slot = || Slot(std::array::from_fn(|_| AtomicU64::new(0)));
    let shared = Arc::new(Shared { slots: [slot(), slot(), slot()], spare: AtomicU8::new(1) });
    (Writer { shared: shared.clone(), own: 0 }, Reader { shared, own: 2 })
}

impl<const N: usize> Writer<N> {
    /// Leaves a message; one that was not read yet is gone.
    pub fn write(&mut self, words: &[u64; N]) {
        let slot = &self.shared.slots[usize::from(self.own)];
        slot.0.iter().zip(words).for_each(|(place, word)| place.store(*word, Ordering::Relaxed));
        self.own = self.shared.spare.swap(self.own | FRESH, Ordering::AcqRel) & SLOT;
    }
}

impl<const N: usize> Reader<N> {
    /// The last message, if it has not been read yet.
    pub fn read(&mut self) -> Option<[u64; N]> {
        if self.shared.spare.load(Ordering::Relaxed) & FRESH == 0 {
            return None;
        }
        self.own = self.shared.spare.swap(self.own, Ordering::AcqRel) & SLOT;
        let slot = &self.shared.slots[usize::from(self.own)];
        Some(std::array::from_fn(|place| slot.0[place].load(Ordering::Relaxed)))
    }
}
