//! What an expression stands for while a function is translated: numbers of the graph, whole numbers and truths that
//! are known, and arrangements of these.

use super::graph::{Binary, Graph, Id};

/// Whether something holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Test {
    /// For all elements alike.
    Known(bool),
    /// Where this value of the graph is above 0; it is 1 or 0.
    Where(Id),
}

/// A value of WGSL.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Value {
    Float(Id),
    Signed(i32),
    Unsigned(u32),
    Bool(Test),
    /// Vectors, matrices (their columns), structs and arrays.
    Parts(Vec<Value>),
    /// A variable or a part of it.
    Pointer(Pointer),
    /// A whole number that differs from element to element: it must not be looked at.
    Varying,
}

/// A variable, and the way to a part of it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Pointer {
    pub(super) variable: Variable,
    pub(super) path: Vec<usize>,
}

/// A variable by its number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Variable {
    Local(usize),
    Global(usize),
}

impl Pointer {
    pub(super) fn part(&self, index: usize) -> Self {
        let mut part = self.clone();
        part.path.push(index);
        part
    }
}

impl Value {
    /// The part that a path leads to.
    pub(super) fn at(&self, path: &[usize]) -> Option<&Value> {
        path.iter().try_fold(self, |value, &index| match value {
            Value::Parts(parts) => parts.get(index),
            _ => None,
        })
    }

    /// The part that a path leads to, to change.
    pub(super) fn at_mut(&mut self, path: &[usize]) -> Option<&mut Value> {
        path.iter().try_fold(self, |value, &index| match value {
            Value::Parts(parts) => parts.get_mut(index),
            _ => None,
        })
    }

    /// All numbers in it, in order; `None` where something else is in it.
    pub(super) fn floats(&self) -> Option<Vec<Id>> {
        match self {
            Value::Float(id) => Some(vec![*id]),
            Value::Parts(parts) => {
                parts.iter().map(Value::floats).collect::<Option<Vec<_>>>().map(|parts| parts.concat())
            }
            _ => None,
        }
    }

    /// How much there is of it: its numbers and what they are arranged in, or the way to them.
    pub(super) fn numbers(&self) -> usize {
        match self {
            Value::Parts(parts) => 1 + parts.iter().map(Value::numbers).sum::<usize>(),
            Value::Pointer(place) => 1 + place.path.len(),
            _ => 1,
        }
    }

    /// A vector of numbers.
    pub(super) fn vector(ids: impl IntoIterator<Item = Id>) -> Self {
        Value::Parts(ids.into_iter().map(Value::Float).collect())
    }

    /// Whole numbers that came to vary, taken from another value instead.
    pub(super) fn with_whole_numbers_of(self, other: Option<&Value>) -> Value {
        match (self, other) {
            (Value::Varying, Some(other)) => other.clone(),
            (Value::Parts(parts), Some(Value::Parts(others))) => Value::Parts(
                parts.into_iter().zip(others).map(|(part, other)| part.with_whole_numbers_of(Some(other))).collect(),
            ),
            (value, _) => value,
        }
    }

    /// Makes every whole number a varying one.
    pub(super) fn forget_whole_numbers(&mut self) {
        match self {
            Value::Signed(_) | Value::Unsigned(_) => *self = Value::Varying,
            Value::Parts(parts) => parts.iter_mut().for_each(Value::forget_whole_numbers),
            _ => {}
        }
    }
}

impl Graph {
    pub(super) fn not(&mut self, test: Test) -> Test {
        match test {
            Test::Known(known) => Test::Known(!known),
            Test::Where(id) => {
                let one = self.constant(1.0);
                Test::Where(self.binary(Binary::Subtract, one, id))
            }
        }
    }

    pub(super) fn and(&mut self, a: Test, b: Test) -> Test {
        match (a, b) {
            (Test::Known(false), _) | (_, Test::Known(false)) => Test::Known(false),
            (Test::Known(true), other) | (other, Test::Known(true)) => other,
            (Test::Where(a), Test::Where(b)) => Test::Where(self.binary(Binary::Min, a, b)),
        }
    }

    pub(super) fn or(&mut self, a: Test, b: Test) -> Test {
        match (a, b) {
            (Test::Known(true), _) | (_, Test::Known(true)) => Test::Known(true),
            (Test::Known(false), other) | (other, Test::Known(false)) => other,
            (Test::Where(a), Test::Where(b)) => Test::Where(self.binary(Binary::Max, a, b)),
        }
    }

    pub(super) fn less(&mut self, a: Id, b: Id) -> Test {
        let less = self.binary(Binary::Less, a, b);
        match self.constant_of(less) {
            Some(known) => Test::Known(known > 0.0),
            None => Test::Where(less),
        }
    }

    /// One of two values, part by part.
    pub(super) fn choose(&mut self, test: Test, accept: Value, reject: Value) -> Value {
        let id = match test {
            Test::Known(true) => return accept,
            Test::Known(false) => return reject,
            Test::Where(id) => id,
        };
        match (accept, reject) {
            (Value::Float(a), Value::Float(b)) => Value::Float(self.select(id, a, b)),
            (Value::Bool(a), Value::Bool(b)) => {
                let otherwise = self.not(test);
                let (a, b) = (self.and(test, a), self.and(otherwise, b));
                Value::Bool(self.or(a, b))
            }
            (Value::Parts(a), Value::Parts(b)) => {
                Value::Parts(a.into_iter().zip(b).map(|(a, b)| self.choose(test, a, b)).collect())
            }
            (a, b) if a == b => a,
            _ => Value::Varying,
        }
    }
}
