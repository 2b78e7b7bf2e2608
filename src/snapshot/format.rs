//! A snapshot as bytes:
//!
//! | bytes | what |
//! |---|---|
//! | 8 | [`MAGIC`] |
//! | 4 | [`VERSION`] of the format |
//! | 4 | bytes of the head |
//! | 8 | bytes of the whole |
//! | ... | the head: JSON, see [`Head`] |
//! | ... | the columns, one after the other as the head lists them |
//! | 8 | XXH64 of all that stands before |
//!
//! Numbers are little-endian; columns have the byte order that the head names. Nothing is allocated by what the head claims:
//! lengths are compared with what is there.

use super::{Head, SnapshotError};
use twox_hash::XxHash64;

/// How a snapshot begins: a byte that no text has, the name, and what careless copying as text would change.
const MAGIC: [u8; 8] = *b"\x89sinew\r\n";
/// Version of the format.
pub const VERSION: u32 = 4;
/// Bytes before the head.
const FRONT: usize = 24;
/// Bytes of the checksum.
const CHECK: usize = 8;

/// The order of bytes of this machine.
pub const BYTE_ORDER: &str = if cfg!(target_endian = "little") { "little" } else { "big" };

/// Puts head and columns together.
pub fn write(head: &Head, data: &[u8]) -> Result<Vec<u8>, SnapshotError> {
    let head = serde_json::to_vec(head).map_err(|error| SnapshotError::Senseless(error.to_string()))?;
    let head_length = u32::try_from(head.len()).map_err(|_| SnapshotError::Senseless("the head is too long".into()))?;
    let total = FRONT + head.len() + data.len() + CHECK;
    let mut bytes = Vec::with_capacity(total);
    bytes.extend(MAGIC);
    bytes.extend(VERSION.to_le_bytes());
    bytes.extend(head_length.to_le_bytes());
    bytes.extend((total as u64).to_le_bytes());
    bytes.extend(head);
    bytes.extend(data);
    bytes.extend(XxHash64::oneshot(0, &bytes).to_le_bytes());
    Ok(bytes)
}

/// Takes head and columns apart.
///
/// # Errors
/// What is wrong, in the order in which it can be told apart: no snapshot, another version, length, checksum, sense.
pub fn read(bytes: &[u8]) -> Result<(Head, Vec<u8>), SnapshotError> {
    let no_snapshot = |reason: &str| SnapshotError::NoSnapshot(reason.into());
    let (front, rest) = bytes.split_first_chunk::<FRONT>().ok_or_else(|| no_snapshot("it is too short"))?;
    if front[..8] != MAGIC {
        return Err(no_snapshot("it does not begin as one"));
    }
    let word = |at: usize| u32::from_le_bytes([front[at], front[at + 1], front[at + 2], front[at + 3]]);
    let version = word(8);
    if version != VERSION {
        let text = format!("its format has version {version}; this program reads version {VERSION}");
        return Err(SnapshotError::NoSnapshot(text));
    }
    let (said, found) = (u64::from(word(16)) | u64::from(word(20)) << 32, bytes.len() as u64);
    if said != found || rest.len() < CHECK {
        return Err(SnapshotError::Length { said, found });
    }
    let (content, check) = bytes.split_at(bytes.len() - CHECK);
    if check != XxHash64::oneshot(0, content).to_le_bytes() {
        return Err(SnapshotError::Damaged);
    }
    let content = &content[FRONT..];
    let senseless = |reason: String| SnapshotError::Senseless(reason);
    let (head, data) = content
        .split_at_checked(word(12) as usize)
        .ok_or_else(|| senseless("its head is longer than the whole".into()))?;
    let head: Head = serde_json::from_slice(head).map_err(|error| senseless(format!("its head: {error}")))?;
    let sum = head.columns.iter().try_fold(0_u64, |sum, column| sum.checked_add(column.bytes));
    if sum != Some(data.len() as u64) {
        return Err(senseless(format!("its columns are not the {} bytes that follow", data.len())));
    }
    if head.byte_order != BYTE_ORDER {
        return Err(SnapshotError::Foreign(format!("its bytes are in {}-endian order", head.byte_order)));
    }
    Ok((head, data.to_vec()))
}
