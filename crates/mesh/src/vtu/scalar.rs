//! VTK's types of numbers, and columns of them from bytes.

use super::DataArray;

/// A type of number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scalar {
    /// Signed integers of so many bytes.
    Int(usize),
    /// Unsigned integers of so many bytes.
    UInt(usize),
    /// Floating-point numbers of 4 or 8 bytes.
    Float(usize),
}

impl Scalar {
    /// From the `type` of a VTU array, or a type's name in a legacy file.
    pub fn named(name: &str) -> Option<Scalar> {
        Some(match name.to_ascii_lowercase().as_str() {
            "int8" | "char" | "signed_char" => Scalar::Int(1),
            "uint8" | "unsigned_char" => Scalar::UInt(1),
            "int16" | "short" => Scalar::Int(2),
            "uint16" | "unsigned_short" => Scalar::UInt(2),
            "int32" | "int" | "vtkidtype" => Scalar::Int(4),
            "uint32" | "unsigned_int" => Scalar::UInt(4),
            "int64" | "long" | "vtktypeint64" => Scalar::Int(8),
            "uint64" | "unsigned_long" | "vtktypeuint64" => Scalar::UInt(8),
            "float32" | "float" => Scalar::Float(4),
            "float64" | "double" => Scalar::Float(8),
            _ => return None,
        })
    }

    /// Bytes of one number.
    pub fn size(self) -> usize {
        match self {
            Scalar::Int(size) | Scalar::UInt(size) | Scalar::Float(size) => size,
        }
    }

    /// The numbers in `bytes`; a rest too short for one is left.
    pub fn column(self, bytes: &[u8], big_endian: bool) -> DataArray {
        let value = |bytes: &[u8]| {
            let mut eight = [0; 8];
            eight[..bytes.len()].copy_from_slice(bytes);
            if big_endian {
                eight[..bytes.len()].reverse();
            }
            let word = u64::from_le_bytes(eight);
            match self {
                Scalar::UInt(_) => word as f64,
                Scalar::Int(size) => ((word << (64 - 8 * size)) as i64 >> (64 - 8 * size)) as f64,
                Scalar::Float(4) => f64::from(f32::from_bits(word as u32)),
                Scalar::Float(_) => f64::from_bits(word),
            }
        };
        let values = bytes.chunks_exact(self.size()).map(value).collect();
        DataArray { components: 1, values, integers: self.is_integer() }
    }

    /// Whether it holds integers.
    pub fn is_integer(self) -> bool {
        !matches!(self, Scalar::Float(_))
    }
}
