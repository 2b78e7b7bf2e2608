//! Arithmetic, comparisons, choices and conversions of values, number by number.

use super::graph::{Binary, Id, Unary};
use super::translate::{Result, Translator, VARYING};
use super::value::{Test, Value};
use super::{NOT_ALLOWED, Untranslatable};
use naga::{BinaryOperator, ScalarKind, Span, UnaryOperator};

impl Translator<'_> {
    pub(super) fn unary(&mut self, op: UnaryOperator, value: Value, at: Span) -> Result<Value> {
        Ok(match (op, value) {
            (_, Value::Parts(parts)) => {
                let parts: Result<Vec<Value>> = parts.into_iter().map(|part| self.unary(op, part, at)).collect();
                Value::Parts(parts?)
            }
            (UnaryOperator::Negate, Value::Float(x)) => Value::Float(self.graph.unary(Unary::Negate, x)),
            (UnaryOperator::Negate, Value::Signed(x)) => Value::Signed(x.wrapping_neg()),
            (UnaryOperator::LogicalNot, Value::Bool(test)) => Value::Bool(self.graph.not(test)),
            (UnaryOperator::BitwiseNot, Value::Signed(x)) => Value::Signed(!x),
            (UnaryOperator::BitwiseNot, Value::Unsigned(x)) => Value::Unsigned(!x),
            _ => return Err(Untranslatable::new(at, VARYING)),
        })
    }

    pub(super) fn binary(&mut self, op: BinaryOperator, left: Value, right: Value, at: Span) -> Result<Value> {
        if let (BinaryOperator::Multiply, Some(product)) = (op, self.matrix_product(&left, &right)) {
            return Ok(product);
        }
        Ok(match (left, right) {
            (Value::Parts(left), Value::Parts(right)) => {
                let pairs = left.into_iter().zip(right);
                let parts: Result<Vec<Value>> = pairs.map(|(a, b)| self.binary(op, a, b, at)).collect();
                Value::Parts(parts?)
            }
            (Value::Parts(left), right) => {
                let parts: Result<Vec<Value>> =
                    left.into_iter().map(|a| self.binary(op, a, right.clone(), at)).collect();
                Value::Parts(parts?)
            }
            (left, Value::Parts(right)) => {
                let parts: Result<Vec<Value>> =
                    right.into_iter().map(|b| self.binary(op, left.clone(), b, at)).collect();
                Value::Parts(parts?)
            }
            (Value::Float(a), Value::Float(b)) => self.float_binary(op, a, b, at)?,
            (Value::Bool(a), Value::Bool(b)) => Value::Bool(match op {
                BinaryOperator::And | BinaryOperator::LogicalAnd => self.graph.and(a, b),
                BinaryOperator::InclusiveOr | BinaryOperator::LogicalOr => self.graph.or(a, b),
                BinaryOperator::Equal | BinaryOperator::NotEqual => {
                    let (not_a, not_b) = (self.graph.not(a), self.graph.not(b));
                    let (both, neither) = (self.graph.and(a, b), self.graph.and(not_a, not_b));
                    let equal = self.graph.or(both, neither);
                    if op == BinaryOperator::Equal { equal } else { self.graph.not(equal) }
                }
                _ => return Err(Untranslatable::new(at, NOT_ALLOWED)),
            }),
            (Value::Signed(a), Value::Signed(b)) => whole(
                op,
                a,
                b,
                Value::Signed,
                i32::wrapping_add,
                i32::wrapping_sub,
                i32::wrapping_mul,
                i32::checked_div,
                i32::checked_rem,
                at,
            )?,
            (Value::Unsigned(a), Value::Unsigned(b)) => whole(
                op,
                a,
                b,
                Value::Unsigned,
                u32::wrapping_add,
                u32::wrapping_sub,
                u32::wrapping_mul,
                u32::checked_div,
                u32::checked_rem,
                at,
            )?,
            _ => return Err(Untranslatable::new(at, VARYING)),
        })
    }

    fn float_binary(&mut self, op: BinaryOperator, a: Id, b: Id, at: Span) -> Result<Value> {
        let g = &mut self.graph;
        let function = match op {
            BinaryOperator::Add => Binary::Add,
            BinaryOperator::Subtract => Binary::Subtract,
            BinaryOperator::Multiply => Binary::Multiply,
            BinaryOperator::Divide => Binary::Divide,
            BinaryOperator::Less => return Ok(Value::Bool(g.less(a, b))),
            BinaryOperator::Greater => return Ok(Value::Bool(g.less(b, a))),
            BinaryOperator::LessEqual | BinaryOperator::GreaterEqual => {
                let (low, high) = if op == BinaryOperator::LessEqual { (a, b) } else { (b, a) };
                let less = g.less(high, low);
                return Ok(Value::Bool(g.not(less)));
            }
            BinaryOperator::Equal | BinaryOperator::NotEqual => {
                let (below, above) = (g.less(a, b), g.less(b, a));
                let differs = g.or(below, above);
                return Ok(Value::Bool(if op == BinaryOperator::NotEqual { differs } else { g.not(differs) }));
            }
            _ => return Err(Untranslatable::new(at, NOT_ALLOWED).note("`%` is for whole numbers only")),
        };
        Ok(Value::Float(g.binary(function, a, b)))
    }

    pub(super) fn select(&mut self, condition: Value, accept: Value, reject: Value, at: Span) -> Result<Value> {
        match (condition, accept, reject) {
            (Value::Bool(test), accept, reject) => Ok(self.graph.choose(test, accept, reject)),
            (Value::Parts(tests), Value::Parts(accept), Value::Parts(reject)) => {
                let parts = tests.into_iter().zip(accept).zip(reject);
                let parts: Result<Vec<Value>> = parts.map(|((t, a), r)| self.select(t, a, r, at)).collect();
                Ok(Value::Parts(parts?))
            }
            _ => Err(Untranslatable::new(at, NOT_ALLOWED)),
        }
    }

    pub(super) fn convert(&mut self, value: Value, kind: ScalarKind, at: Span) -> Result<Value> {
        Ok(match (value, kind) {
            (Value::Parts(parts), _) => {
                let parts: Result<Vec<Value>> = parts.into_iter().map(|part| self.convert(part, kind, at)).collect();
                Value::Parts(parts?)
            }
            (value @ Value::Float(_), ScalarKind::Float)
            | (value @ Value::Signed(_), ScalarKind::Sint)
            | (value @ Value::Unsigned(_), ScalarKind::Uint)
            | (value @ Value::Bool(_), ScalarKind::Bool) => value,
            (Value::Signed(value), ScalarKind::Float) => Value::Float(self.graph.constant(f64::from(value))),
            (Value::Unsigned(value), ScalarKind::Float) => Value::Float(self.graph.constant(f64::from(value))),
            (Value::Signed(value), ScalarKind::Uint) => Value::Unsigned(value as u32),
            (Value::Unsigned(value), ScalarKind::Sint) => Value::Signed(value as i32),
            (Value::Bool(test), ScalarKind::Float) => {
                let (one, zero) = (self.graph.constant(1.0), self.graph.constant(0.0));
                self.graph.choose(test, Value::Float(one), Value::Float(zero))
            }
            // one that parameters choose, as the GPU rounds it
            (Value::Float(id), ScalarKind::Sint) if let Some(x) = self.graph.constant_of(id) => {
                Value::Signed(x as f32 as i32)
            }
            (Value::Float(id), ScalarKind::Uint) if let Some(x) = self.graph.constant_of(id) => {
                Value::Unsigned(x as f32 as u32)
            }
            (Value::Float(_), _) => {
                return Err(Untranslatable::new(
                    at,
                    "a number that differs from element to element or node to node cannot become a whole one",
                ));
            }
            _ => return Err(Untranslatable::new(at, NOT_ALLOWED)),
        })
    }
}

/// Arithmetic of known whole numbers, as WGSL has it: around the end.
fn whole<N: PartialOrd + Copy>(
    op: BinaryOperator,
    a: N,
    b: N,
    make: fn(N) -> Value,
    add: fn(N, N) -> N,
    subtract: fn(N, N) -> N,
    multiply: fn(N, N) -> N,
    divide: fn(N, N) -> Option<N>,
    remainder: fn(N, N) -> Option<N>,
    at: Span,
) -> Result<Value> {
    let by_zero = || Untranslatable::new(at, "this divides a whole number by 0");
    let test = |known: bool| Ok(Value::Bool(Test::Known(known)));
    match op {
        BinaryOperator::Add => Ok(make(add(a, b))),
        BinaryOperator::Subtract => Ok(make(subtract(a, b))),
        BinaryOperator::Multiply => Ok(make(multiply(a, b))),
        BinaryOperator::Divide => divide(a, b).map(make).ok_or_else(by_zero),
        BinaryOperator::Modulo => remainder(a, b).map(make).ok_or_else(by_zero),
        BinaryOperator::Equal => test(a == b),
        BinaryOperator::NotEqual => test(a != b),
        BinaryOperator::Less => test(a < b),
        BinaryOperator::LessEqual => test(a <= b),
        BinaryOperator::Greater => test(a > b),
        BinaryOperator::GreaterEqual => test(a >= b),
        _ => Err(Untranslatable::new(at, NOT_ALLOWED)),
    }
}
