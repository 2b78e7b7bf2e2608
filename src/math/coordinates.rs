//! Places in words.

use glam::DVec3;

/// Digits after the point of lengths (m) beside something of a size (m): four, as many more as it takes to tell a
/// hundredth of that, and twelve at most.
pub fn digits_beside(size: f64) -> usize {
    (2.0 - size.max(f64::MIN_POSITIVE).log10().floor()).clamp(4.0, 12.0) as usize
}

/// The coordinates of a place (m) in something of a size (m).
pub fn coordinates(at: DVec3, size: f64) -> String {
    let digits = digits_beside(size);
    at.to_array().map(|x| format!("{x:.digits$}")).join(", ")
}

#[cfg(test)]
mod tests;
