//! The triple buffer of src/port under loom: every order of what both threads do, and everything that the memory model
//! lets a load see.

mod sync {
    pub use loom::sync::Arc;
    pub use loom::sync::atomic::{AtomicU8, AtomicU64, Ordering};
}
#[path = "../../../src/port/buffer.rs"]
mod buffer;

/// A message with its number and a sum of the rest.
fn message(number: u64) -> [u64; 2] {
    [number, !number]
}

#[test]
fn what_is_read_is_whole_and_never_older_than_before() {
    loom::model(|| {
        let (mut writer, mut reader) = buffer::triple_buffer();
        let thread = loom::thread::spawn(move || (1..=3).for_each(|number| writer.write(&message(number))));
        let mut last = 0;
        for _ in 0..2 {
            if let Some([number, check]) = reader.read() {
                assert_eq!(check, !number, "a torn message");
                assert!(number > last, "{number} after {last}");
                last = number;
            }
        }
        thread.join().unwrap();
        // the last one is never lost
        let left = reader.read();
        assert_eq!(left.map_or(last, |[number, _]| number), 3);
        assert!(left.is_none() || last < 3);
        assert_eq!(reader.read(), None);
    });
}
