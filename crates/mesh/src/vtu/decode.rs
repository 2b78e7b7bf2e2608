//! From encoded, perhaps compressed blocks to plain bytes.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use std::io::Read;

/// How a file packs binary data.
#[derive(Clone, Copy, Debug)]
pub struct Packing {
    /// Bytes of a number in headers: 4 or 8.
    pub header: usize,
    /// Whether the most significant byte comes first.
    pub big_endian: bool,
    /// Whether and how blocks are compressed.
    pub compression: Compression,
}

/// How blocks are compressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Compression {
    /// Not at all.
    None,
    /// By zlib.
    Zlib,
    /// By lz4, block format.
    Lz4,
}

/// No compression makes more of a byte than this (zlib 1032, lz4 255): larger claims are refused unallocated.
const MOST_EXPANSION: u64 = 1040;

/// What is wrong with packed data.
pub type Wrong = String;

/// Bytes of base64 text. Encoded pieces may follow each other, each with its padding.
pub fn base64(text: &[u8]) -> Result<Vec<u8>, Wrong> {
    let text: Vec<u8> = text.iter().copied().filter(|byte| !byte.is_ascii_whitespace()).collect();
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3);
    let mut rest = text.as_slice();
    while !rest.is_empty() {
        let padding = rest.iter().position(|&byte| byte == b'=');
        // a piece ends with the group of four that its padding fills up; it is never empty
        let end = padding.map_or(rest.len(), |at| (at + 1).next_multiple_of(4).min(rest.len()));
        let piece = STANDARD.decode(&rest[..end]).map_err(|error| format!("its base64 text is damaged ({error})"))?;
        bytes.extend(piece);
        rest = &rest[end..];
    }
    Ok(bytes)
}

impl Packing {
    /// The plain data that begin at the start of `bytes`, `most` bytes of them; more may follow.
    pub fn unpack(&self, bytes: &[u8], most: usize) -> Result<Vec<u8>, Wrong> {
        let too_many = || format!("it holds more than {most} bytes, the most that a file of this length may hold");
        if self.compression == Compression::None {
            let length = self.header(bytes, 0)?;
            let part = self.part(bytes, self.header as u64, length)?;
            return if part.len() > most { Err(too_many()) } else { Ok(part.to_vec()) };
        }
        let [blocks, size, last] = [self.header(bytes, 0)?, self.header(bytes, 1)?, self.header(bytes, 2)?];
        let header_end = blocks.checked_add(3).and_then(|count| count.checked_mul(self.header as u64));
        let mut at = header_end.filter(|&end| end <= bytes.len() as u64).ok_or("its header claims too many blocks")?;
        let mut plain = Vec::new();
        for block in 0..blocks {
            let packed = self.header(bytes, 3 + block)?;
            let expected = if block + 1 == blocks && last > 0 { last } else { size };
            if expected > packed.saturating_add(1).saturating_mul(MOST_EXPANSION) {
                return Err(format!("block {block} claims {expected} bytes in {packed} compressed ones"));
            }
            if expected > most.saturating_sub(plain.len()) as u64 {
                return Err(too_many());
            }
            self.unpack_block(self.part(bytes, at, packed)?, expected as usize, &mut plain)?;
            at += packed;
        }
        Ok(plain)
    }

    fn unpack_block(&self, packed: &[u8], expected: usize, plain: &mut Vec<u8>) -> Result<(), Wrong> {
        let start = plain.len();
        match self.compression {
            Compression::Lz4 => {
                plain.resize(start + expected, 0);
                let length = lz4_flex::block::decompress_into(packed, &mut plain[start..]);
                plain.truncate(start + length.map_err(|error| format!("an lz4 block is damaged ({error})"))?);
            }
            _ => {
                let mut decoder = flate2::read::ZlibDecoder::new(packed).take(expected as u64 + 1);
                decoder.read_to_end(plain).map_err(|error| format!("a zlib block is damaged ({error})"))?;
            }
        }
        let length = plain.len() - start;
        if length == expected {
            Ok(())
        } else {
            Err(format!("a block claims {expected} bytes and holds another number"))
        }
    }

    /// A number of the header.
    fn header(&self, bytes: &[u8], index: u64) -> Result<u64, Wrong> {
        let part = self.part(bytes, index.saturating_mul(self.header as u64), self.header as u64)?;
        let number = super::scalar::Scalar::UInt(self.header);
        // block counts and sizes beyond 2⁵³ fit no file: rounding them changes nothing
        Ok(number.column(part, self.big_endian).values.first().map_or(0, |&value| value as u64))
    }

    fn part<'a>(&self, bytes: &'a [u8], at: u64, length: u64) -> Result<&'a [u8], Wrong> {
        let (start, end) = (usize::try_from(at).ok(), at.checked_add(length).and_then(|end| usize::try_from(end).ok()));
        start
            .zip(end)
            .and_then(|(start, end)| bytes.get(start..end))
            .ok_or_else(|| format!("it needs {length} bytes from byte {at} on, of {} that there are", bytes.len()))
    }
}
