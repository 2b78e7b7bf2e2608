//! A snapshot that takes little memory: columns of zeros, as they are before the first step, take next to nothing.

use super::{Head, Snapshot, SnapshotError};

/// Bytes that are packed at once.
const PIECE: usize = 1 << 24;

/// A snapshot whose columns are packed (LZ4).
#[derive(Clone, Debug)]
pub struct PackedSnapshot {
    head: Head,
    pieces: Vec<Vec<u8>>,
    length: usize,
}

impl Snapshot {
    /// The same, packed.
    pub fn packed(&self) -> PackedSnapshot {
        let pieces = self.data.chunks(PIECE).map(lz4_flex::compress).collect();
        PackedSnapshot { head: self.head.clone(), pieces, length: self.data.len() }
    }

    /// Bytes that its columns take in memory, and about those of the rest.
    pub fn size(&self) -> usize {
        self.data.len() + self.head.resume_state.len() + self.head.columns.len() * size_of::<super::ColumnEntry>()
    }
}

impl PackedSnapshot {
    /// The snapshot as it was.
    ///
    /// # Errors
    /// That memory was damaged.
    pub fn unpacked(&self) -> Result<Snapshot, SnapshotError> {
        let mut data = Vec::with_capacity(self.length);
        for piece in &self.pieces {
            let left = (self.length - data.len()).min(PIECE);
            data.extend(lz4_flex::decompress(piece, left).map_err(|_| SnapshotError::Damaged)?);
        }
        Ok(Snapshot { head: self.head.clone(), data })
    }
}
