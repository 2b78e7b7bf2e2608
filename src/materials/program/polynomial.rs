//! Polynomials of one input: what the derivatives of many energies are, by Horner's rule in place of a program.

use super::graph::{Binary, Graph, Id, Node, Unary};
use crate::math::Real;

/// The highest power; the series of Arruda and Boyce has four in its slope.
const HIGHEST: usize = 8;

/// How much larger than its value the sum of its terms' sizes may be: Horner's rule errs by so many times the rounding
/// of its operations (Higham 2002, §5.1).
const LOSS: f64 = 8.0;

/// Where that is looked at: twelve decades, four places in each.
const LARGEST: f64 = 100.0;
const PLACES: i32 = 48;

/// Σ cₖ xᵏ of one input.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Polynomial {
    /// The number of the input.
    input: usize,
    /// The factor of the highest power, and those of the others from there down.
    highest: f64,
    lower: Vec<f64>,
}

impl Polynomial {
    /// Its value.
    #[inline(always)]
    pub(super) fn at<R: Real>(&self, inputs: &[R], like: R) -> R {
        let x = inputs.get(self.input).copied().unwrap_or(like);
        let mut sum = like.constant(self.highest);
        for factor in &self.lower {
            sum = sum.mul_add(x, like.constant(*factor));
        }
        sum
    }

    /// The highest power.
    pub(super) fn degree(&self) -> usize {
        self.lower.len()
    }

    /// One whose value keeps its digits for arguments from `least` on; none of others.
    fn of(terms: &Terms, least: f64) -> Option<Self> {
        let places = (0..=PLACES).map(|place| LARGEST * 10.0_f64.powf(-f64::from(place) / 4.0));
        let both = places.flat_map(|x| [x, -x]).filter(|x| *x >= least);
        let keeps = |x: f64| {
            let value = terms.factors.iter().rev().fold(0.0, |sum, factor| sum * x + factor);
            let sizes = terms.factors.iter().rev().fold(0.0, |sum, factor| sum * x.abs() + factor.abs());
            sizes <= LOSS * f64::abs(value)
        };
        let (highest, lower) = terms.factors.split_last()?;
        let lower = lower.iter().rev().copied().collect();
        let found = Self { input: usize::from(terms.input.unwrap_or(0)), highest: *highest, lower };
        { both }.all(keeps).then_some(found)
    }
}

/// Factors of the powers of an input, the lowest first; of none where it is a constant.
#[derive(Clone)]
struct Terms {
    input: Option<u16>,
    factors: Vec<f64>,
}

impl Terms {
    fn constant(c: f64) -> Self {
        Self { input: None, factors: vec![c] }
    }

    /// Both of one input, and what comes of them.
    fn with(&self, other: &Self, make: impl FnOnce(&[f64], &[f64]) -> Vec<f64>) -> Option<Self> {
        if self.input.is_some() && other.input.is_some() && self.input != other.input {
            return None;
        }
        let mut factors = make(&self.factors, &other.factors);
        while factors.len() > 1 && factors.last() == Some(&0.0) {
            factors.pop();
        }
        let is_finite = factors.iter().all(|factor| factor.abs() < f64::from(f32::MAX));
        (is_finite && factors.len() <= HIGHEST + 1).then_some(Self { input: self.input.or(other.input), factors })
    }

    fn plus(&self, other: &Self, times: f64) -> Option<Self> {
        self.with(other, |a, b| {
            let at = |of: &[f64], k: usize| of.get(k).copied().unwrap_or(0.0);
            (0..a.len().max(b.len())).map(|k| at(a, k) + times * at(b, k)).collect()
        })
    }

    fn times(&self, other: &Self) -> Option<Self> {
        self.with(other, |a, b| {
            let mut product = vec![0.0; a.len() + b.len() - 1];
            for (i, x) in a.iter().enumerate() {
                for (k, y) in b.iter().enumerate() {
                    product[i + k] += x * y;
                }
            }
            product
        })
    }
}

impl Graph {
    /// Values as polynomials of an input each, good for arguments from `least` on; none where one of them is something
    /// else, or would lose digits in this form.
    pub(super) fn polynomials(&self, outputs: &[Id], least: f64) -> Option<Vec<Polynomial>> {
        let wanted = self.wanted(outputs);
        let mut found: Vec<Option<Terms>> = vec![None; self.nodes().len()];
        for (index, node) in self.nodes().iter().enumerate().filter(|(index, _)| wanted[*index]) {
            let at = |id: Id| found[id.index()].as_ref();
            found[index] = match *node {
                Node::Input(number) => Some(Terms { input: Some(number), factors: vec![0.0, 1.0] }),
                Node::Constant(bits) => Some(f64::from_bits(bits)).filter(|c| c.is_finite()).map(Terms::constant),
                Node::Unary(Unary::Negate, x) => at(x).and_then(|x| Terms::constant(0.0).plus(x, -1.0)),
                Node::Binary(function, a, b) => at(a).zip(at(b)).and_then(|(a, b)| match (function, &b.factors[..]) {
                    (Binary::Add, _) => a.plus(b, 1.0),
                    (Binary::Subtract, _) => a.plus(b, -1.0),
                    (Binary::Multiply, _) => a.times(b),
                    (Binary::Divide, [number]) => a.times(&Terms::constant(1.0 / number)),
                    _ => None,
                }),
                Node::Unary(..) | Node::Select(..) => None,
            };
        }
        outputs.iter().map(|id| found[id.index()].as_ref().and_then(|terms| Polynomial::of(terms, least))).collect()
    }
}

#[cfg(test)]
mod tests;
