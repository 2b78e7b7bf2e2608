//! Random numbers of made-up scenes: a row for what they hold, and of violent ones another for how far beyond all
//! measure that is.

use fastrand::Rng;
use std::ops::{Deref, DerefMut};

/// How violent a scene is.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Temper {
    /// Not at all.
    Mild,
    /// All through, and in every way.
    Wild,
    /// Only in the last step, which no later one can judge: there by as much as numbers can express.
    Late,
    /// So much that tissue stiffens and is made heavier for it, again and again.
    Heavy,
}

impl Temper {
    /// Every other scene is violent.
    pub fn of(seed: u64) -> Self {
        match seed % 8 {
            1 | 5 => Self::Wild,
            3 => Self::Late,
            7 => Self::Heavy,
            _ => Self::Mild,
        }
    }
}

/// The random numbers of a scene.
pub struct Dice {
    rng: Rng,
    /// Of violent scenes: a row of its own, so that all else is as in the mild scene of the same seed.
    wild: Option<Rng>,
    pub temper: Temper,
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
    pub fn of(seed: u64) -> Self {
        let temper = Temper::of(seed);
        let wild = (temper != Temper::Mild).then(|| Rng::with_seed(seed ^ 0xbad_5eed));
        Self { rng: Rng::with_seed(seed), wild, temper }
    }

    /// The row of violence, where there is any.
    pub fn wild(&mut self) -> Option<&mut Rng> {
        self.wild.as_mut()
    }

    /// What to multiply with what goes on all the time: 1 in mild scenes and now and then in others; else up to `most`,
    /// each power of ten alike.
    pub fn beyond(&mut self, most: f64) -> f64 {
        match self.temper {
            Temper::Mild | Temper::Late => 1.0,
            Temper::Wild => self.seldom_one(most),
            Temper::Heavy => self.seldom_one(most.cbrt()),
        }
    }

    /// The same of what has a course in time: seldom so much that single precision ends, which is what is left of the
    /// 1e30 that a scene may hold.
    pub fn far_beyond(&mut self, most: f64) -> f64 {
        let temper = self.temper;
        match temper {
            Temper::Wild if self.wildly(16) => self.seldom_one(1e26),
            Temper::Late if self.wildly(3) => self.wild.as_mut().map_or(1.0, |wild| size(wild, 1e8, 1e26)),
            Temper::Late => self.seldom_one(most),
            _ => self.beyond(most),
        }
    }

    fn seldom_one(&mut self, most: f64) -> f64 {
        let Some(wild) = &mut self.wild else { return 1.0 };
        if wild.u8(..5) < 2 { 1.0 } else { size(wild, 1.0, most) }
    }

    /// When a course in time begins at once and so late that only the last check can see it, as a share of the whole;
    /// if it does.
    pub fn late(&mut self) -> Option<f64> {
        let temper = self.temper;
        let tens = match temper {
            Temper::Late => -2.5,
            Temper::Wild if self.wildly(6) => -1.0,
            _ => return None,
        };
        Some(1.0 - 10_f64.powf(tens - 2.0 * self.wild.as_mut()?.f64()))
    }

    /// Whether something happens that only violent scenes have, in one of so many.
    pub fn wildly(&mut self, one_in: u8) -> bool {
        self.wild.as_mut().is_some_and(|wild| wild.u8(..one_in) == 0)
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
