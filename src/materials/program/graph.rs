//! A function of numbers as a graph without control flow: each value once, constants folded.

use crate::math::Real;
use std::collections::HashMap;

/// A value of a graph. What it is made of has lower numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct Id(u32);

impl Id {
    pub(super) fn index(self) -> usize {
        self.0 as usize
    }
}

/// Functions of one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Unary {
    Negate,
    Abs,
    Sqrt,
    Exp,
    /// e^x − 1.
    ExpLessOne,
    Log,
    /// ln(1 + x).
    LogOfOnePlus,
    InverseCbrt,
    Sine,
    Cosine,
}

/// Functions of two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Binary {
    Add,
    Subtract,
    Multiply,
    Divide,
    Min,
    Max,
    /// 1 where the first is less, else 0.
    Less,
}

/// How a value is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Node {
    Input(u16),
    /// The bits of an `f64`, so that equal constants are one.
    Constant(u64),
    Unary(Unary, Id),
    Binary(Binary, Id, Id),
    /// The second where the first is above 0, else the third.
    Select(Id, Id, Id),
}

/// The values made so far.
#[derive(Clone, Debug, Default)]
pub(super) struct Graph {
    nodes: Vec<Node>,
    known: HashMap<Node, Id>,
}

impl Graph {
    pub(super) fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    pub(super) fn node(&self, id: Id) -> Node {
        self.nodes[id.index()]
    }

    fn make(&mut self, node: Node) -> Id {
        *self.known.entry(node).or_insert_with(|| {
            self.nodes.push(node);
            Id(self.nodes.len() as u32 - 1)
        })
    }

    pub(super) fn input(&mut self, number: u16) -> Id {
        self.make(Node::Input(number))
    }

    pub(super) fn constant(&mut self, value: f64) -> Id {
        self.make(Node::Constant(value.to_bits()))
    }

    /// The value, where it does not depend on inputs.
    pub(super) fn constant_of(&self, id: Id) -> Option<f64> {
        match self.node(id) {
            Node::Constant(bits) => Some(f64::from_bits(bits)),
            _ => None,
        }
    }

    pub(super) fn unary(&mut self, function: Unary, x: Id) -> Id {
        match (self.constant_of(x), function, self.node(x)) {
            (Some(value), ..) => self.constant(function.of(value)),
            (_, Unary::Negate, Node::Unary(Unary::Negate, inner)) => inner,
            (_, Unary::Negate, Node::Binary(Binary::Subtract, a, b)) => self.binary(Binary::Subtract, b, a),
            _ => self.make(Node::Unary(function, x)),
        }
    }

    /// Simplifies what is the same for every number; 0·x stays, because it is not 0 when x is not finite.
    pub(super) fn binary(&mut self, function: Binary, a: Id, b: Id) -> Id {
        use Binary::{Add, Divide, Less, Max, Min, Multiply, Subtract};
        let (left, right) = (self.constant_of(a), self.constant_of(b));
        match (function, left, right) {
            (_, Some(left), Some(right)) => self.constant(function.of(left, right)),
            (Add, Some(0.0), _) | (Multiply, Some(1.0), _) => b,
            (Add | Subtract, _, Some(0.0)) | (Multiply | Divide, _, Some(1.0)) => a,
            (Subtract, Some(0.0), _) | (Multiply, Some(-1.0), _) => self.unary(Unary::Negate, b),
            (Multiply | Divide, _, Some(-1.0)) => self.unary(Unary::Negate, a),
            (Min | Max, ..) if a == b => a,
            (Less, ..) if a == b => self.constant(0.0),
            // one order for what has none
            (Add | Multiply | Min | Max, ..) if b < a => self.make(Node::Binary(function, b, a)),
            _ => self.make(Node::Binary(function, a, b)),
        }
    }

    pub(super) fn select(&mut self, test: Id, accept: Id, reject: Id) -> Id {
        match self.constant_of(test) {
            Some(test) => {
                if test > 0.0 {
                    accept
                } else {
                    reject
                }
            }
            None if accept == reject => accept,
            None => self.make(Node::Select(test, accept, reject)),
        }
    }
}

impl Unary {
    /// The function for any kind of number.
    #[inline(always)]
    pub(super) fn of<R: Real>(self, x: R) -> R {
        match self {
            Self::Negate => -x,
            Self::Abs => x.max(-x),
            Self::Sqrt => x.sqrt(),
            Self::Exp => x.exp(),
            Self::ExpLessOne => x.exp_m1(),
            // as on the GPU: what has no logarithm must be found out, not go on as some number
            Self::Log => x.if_positive(x.ln(), x.constant(f64::NAN)),
            Self::LogOfOnePlus => (x + x.constant(1.0)).if_positive(x.ln_1p(), x.constant(f64::NAN)),
            Self::InverseCbrt => x.inverse_cbrt(),
            Self::Sine => x.sin(),
            Self::Cosine => x.cos(),
        }
    }
}

impl Binary {
    /// The function for any kind of number.
    #[inline(always)]
    pub(super) fn of<R: Real>(self, a: R, b: R) -> R {
        match self {
            Self::Add => a + b,
            Self::Subtract => a - b,
            Self::Multiply => a * b,
            Self::Divide => a / b,
            Self::Min => -(-a).max(-b),
            Self::Max => a.max(b),
            Self::Less => (b - a).if_positive(a.constant(1.0), a.constant(0.0)),
        }
    }
}
