//! Random numbers of made-up scenes: a row for what they hold, and of violent ones another for how far beyond all measure that is.

use fastrand::Rng;
use std::ops::{Deref, DerefMut};

/// The random numbers of a scene.
pub struct Dice {
    rng: Rng,
    /// Of violent scenes: a row of its own, so that all else is as in the mild scene of the same seed.
    wild: Option<Rng>,
}

impl Deref for Dice {
    type Target = Rng;
    fn deref(&self) -> &Rng {
        &self.rng
    }
}

impl DerefMut for Dice {
    fn deref_mut(&mut self) -> &mut Rng {
        &mut self.rng
    }
}

impl Dice {
    /// Every other scene is violent.
    pub fn of(seed: u64) -> Self {
        let wild = !seed.is_multiple_of(2);
        Self { rng: Rng::with_seed(seed), wild: wild.then(|| Rng::with_seed(seed ^ 0xbad_5eed)) }
    }

    /// The row of violence, where there is any.
    pub fn wild(&mut self) -> Option<&mut Rng> {
        self.wild.as_mut()
    }

    /// What to multiply with: 1 in mild scenes and now and then in others; else up to `most`, each power of ten alike.
    pub fn beyond(&mut self, most: f64) -> f64 {
        let Some(wild) = &mut self.wild else { return 1.0 };
        match wild.u8(..5) {
            0 | 1 => 1.0,
            _ => size(wild, 1.0, most),
        }
    }

    /// The same, and seldom so much that single precision ends: what is left of 1e30, which a scene may hold at most.
    pub fn far_beyond(&mut self, most: f64) -> f64 {
        match self.wild.as_mut().map(|wild| wild.u8(..16)) {
            Some(0) => self.beyond(1e26),
            _ => self.beyond(most),
        }
    }

    /// Whether something happens that only violent scenes have, in one of so many.
    pub fn wildly(&mut self, one_in: u8) -> bool {
        self.wild.as_mut().is_some_and(|wild| wild.u8(..one_in) == 0)
    }

    /// A number from 0 to 1 for what only violent scenes have.
    pub fn wild_share(&mut self) -> f64 {
        self.wild.as_mut().map_or(0.5, |wild| wild.f64())
    }
}

pub fn number(r: &mut Rng, least: f64, most: f64) -> f64 {
    least + (most - least) * r.f64()
}

/// Anything between two numbers, each power of ten alike.
pub fn size(r: &mut Rng, least: f64, most: f64) -> f64 {
    (number(r, least.ln(), most.ln())).exp()
}

pub fn vector(r: &mut Rng, most: f64) -> String {
    let mut one = || if r.u8(..4) == 0 { 0.0 } else { number(r, -most, most) };
    format!("({:?}, {:?}, {:?})", one(), one(), one())
}

pub fn one_of<'a>(r: &mut Rng, all: &[&'a str]) -> &'a str {
    all[r.usize(..all.len())]
}
