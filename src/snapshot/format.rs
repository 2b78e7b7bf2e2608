//! A snapshot as bytes:
//!
//! | bytes | what |
//! |---|---|
//! | 8 | [`MAGIC`] |
//! | 4 | [`VERSION`] of the format |
//! | 4 | bytes of the head |
//! | 8 | bytes of the whole |
//! | ... | the head: RON, which unlike JSON has a word for numbers that are infinite; see [`Head`] |
//! | ... | the columns, one after the other as the head lists them |
//! | 8 | XXH64 of all that stands before |
//!
//! Numbers are little-endian; columns have the byte order that the head names. Nothing is allocated by what the head
//! claims: lengths are compared with what is there.

use super::{Head, SnapshotError};
use std::fs::File;
use std::io::Read;
use std::path::Path;
use twox_hash::XxHash64;

/// How a snapshot begins: a byte that no text has, the name, and what careless copying as text would change.
const MAGIC: [u8; 8] = *b"\x89sinew\r\n";
/// Version of the format.
pub const VERSION: u32 = 8;
/// Bytes before the head.
const FRONT: usize = 24;
/// Bytes of the checksum.
const CHECK: usize = 8;

/// The order of bytes of this machine.
pub const BYTE_ORDER: &str = if cfg!(target_endian = "little") { "little" } else { "big" };

/// Puts head and columns together.
pub fn write(head: &Head, data: &[u8]) -> Result<Vec<u8>, SnapshotError> {
    let head = ron::to_string(head).map_err(|error| SnapshotError::Senseless(error.to_string()))?.into_bytes();
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

/// What a snapshot begins with, checked: bytes of the head, and of the whole.
fn front(front: &[u8; FRONT]) -> Result<(usize, u64), SnapshotError> {
    if front[..8] != MAGIC {
        return Err(SnapshotError::NoSnapshot("it does not begin as one".into()));
    }
    let word = |at: usize| u32::from_le_bytes([front[at], front[at + 1], front[at + 2], front[at + 3]]);
    let version = word(8);
    if version != VERSION {
        let text = format!("its format has version {version}; this program reads version {VERSION}");
        return Err(SnapshotError::NoSnapshot(text));
    }
    Ok((word(12) as usize, u64::from(word(16)) | u64::from(word(20)) << 32))
}

/// Reads the bytes of a file, if it begins as a snapshot and is as long as it says: nothing else of it is touched
/// before.
///
/// # Errors
/// What cannot be read; what is no file, as a device or a pipe; bytes that do not begin as a snapshot, or of another
/// length.
pub fn read_file(path: &Path) -> Result<Vec<u8>, SnapshotError> {
    let refused = |source| SnapshotError::Read { path: path.to_path_buf(), source };
    // opening a pipe would wait for a writer
    let found = std::fs::metadata(path).map_err(refused)?;
    if !found.is_file() {
        return Err(SnapshotError::NoSnapshot(format!("{} is no file", path.display())));
    }
    let mut file = File::open(path).map_err(refused)?;
    let mut bytes = Vec::new();
    (&mut file).take(FRONT as u64).read_to_end(&mut bytes).map_err(refused)?;
    let (beginning, _) = bytes.split_first_chunk().ok_or_else(too_short)?;
    let (_, said) = front(beginning)?;
    if said != found.len() {
        return Err(SnapshotError::Length { said, found: found.len() });
    }
    // a file that grows meanwhile is not followed
    file.take(said - FRONT as u64).read_to_end(&mut bytes).map_err(refused)?;
    Ok(bytes)
}

fn too_short() -> SnapshotError {
    SnapshotError::NoSnapshot("it is too short".into())
}

/// Takes head and columns apart.
///
/// # Errors
/// What is wrong, in the order in which it can be told apart: no snapshot, another version, length, checksum, sense.
pub fn read(bytes: &[u8]) -> Result<(Head, Vec<u8>), SnapshotError> {
    let (beginning, rest) = bytes.split_first_chunk::<FRONT>().ok_or_else(too_short)?;
    let ((head_length, said), found) = (front(beginning)?, bytes.len() as u64);
    if said != found || rest.len() < CHECK {
        return Err(SnapshotError::Length { said, found });
    }
    let (content, check) = bytes.split_at(bytes.len() - CHECK);
    if check != XxHash64::oneshot(0, content).to_le_bytes() {
        return Err(SnapshotError::Damaged);
    }
    let content = &content[FRONT..];
    let senseless = |reason: String| SnapshotError::Senseless(reason);
    let (head, data) =
        content.split_at_checked(head_length).ok_or_else(|| senseless("its head is longer than the whole".into()))?;
    let head: Head = ron::de::from_bytes(head).map_err(|error| senseless(format!("its head: {error}")))?;
    let sum = head.columns.iter().try_fold(0_u64, |sum, column| sum.checked_add(column.bytes));
    if sum != Some(data.len() as u64) {
        return Err(senseless(format!("its columns are not the {} bytes that follow", data.len())));
    }
    if head.byte_order != BYTE_ORDER {
        return Err(SnapshotError::Foreign(format!("its bytes are in {}-endian order", head.byte_order)));
    }
    Ok((head, data.to_vec()))
}
