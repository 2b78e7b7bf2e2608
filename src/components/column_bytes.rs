//! What columns are made of, as bytes.

use super::Reals;
use super::column::either;

/// Numbers that columns are made of.
pub trait Word: bytemuck::Pod {
    /// What they are in shaders; of those that only the host has, what they would be.
    const WORD: &'static str;
    /// So many times it.
    fn times(self, factor: f64) -> Self;
}

impl Word for f32 {
    const WORD: &'static str = "f32";
    fn times(self, factor: f64) -> Self {
        (factor * f64::from(self)) as f32
    }
}

impl Word for f64 {
    const WORD: &'static str = "f32";
    fn times(self, factor: f64) -> Self {
        factor * self
    }
}

impl Word for u32 {
    const WORD: &'static str = "u32";
    fn times(self, factor: f64) -> Self {
        debug_assert!(false, "counts are no changes in a step");
        (factor * f64::from(self)) as u32
    }
}

/// What columns are made of.
pub trait AsBytes {
    /// What the numbers are in shaders.
    const WORD: &'static str;
    /// The bytes.
    fn as_bytes(&self) -> &[u8];
    /// The bytes, to write.
    fn as_bytes_mut(&mut self) -> &mut [u8];
    /// Multiplies the numbers at some places of so many.
    fn scale(&mut self, is_one: &dyn Fn(usize, usize) -> bool, factor: f64);
}

fn scale_words<T: Word>(words: &mut [T], is_one: &dyn Fn(usize, usize) -> bool, factor: f64) {
    let length = words.len();
    let scaled = words.iter_mut().enumerate().filter(|(place, _)| is_one(*place, length));
    scaled.for_each(|(_, word)| *word = word.times(factor));
}

impl AsBytes for Reals {
    const WORD: &'static str = "f32";
    fn as_bytes(&self) -> &[u8] {
        self.bytes()
    }
    fn as_bytes_mut(&mut self) -> &mut [u8] {
        self.bytes_mut()
    }
    fn scale(&mut self, is_one: &dyn Fn(usize, usize) -> bool, factor: f64) {
        either!(self, v => scale_words(v, is_one, factor));
    }
}

impl<T: Word> AsBytes for Vec<T> {
    const WORD: &'static str = T::WORD;
    fn as_bytes(&self) -> &[u8] {
        bytemuck::cast_slice(self)
    }
    fn as_bytes_mut(&mut self) -> &mut [u8] {
        bytemuck::cast_slice_mut(self)
    }
    fn scale(&mut self, is_one: &dyn Fn(usize, usize) -> bool, factor: f64) {
        scale_words(self, is_one, factor);
    }
}
