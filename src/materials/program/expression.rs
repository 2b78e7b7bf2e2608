//! From the expressions of a WGSL function to values.

use super::graph::{Binary, Unary};
use super::translate::{Frame, Result, Translator, VARYING};
use super::value::{Place, Test, Value, Variable};
use super::{NOT_ALLOWED, Untranslatable};
use naga::{BinaryOperator, Expression, Handle, Literal, ScalarKind, Span, Type, TypeInner, UnaryOperator};

impl<'m> Translator<'m> {
    pub(super) fn expression(&mut self, frame: &mut Frame<'m>, handle: Handle<Expression>) -> Result<Value> {
        let at = frame.expressions.get_span(handle);
        let not_allowed = || Err(Untranslatable::new(at, NOT_ALLOWED));
        Ok(match &frame.expressions[handle] {
            Expression::Literal(literal) => return self.literal(*literal, at),
            Expression::Constant(constant) => return self.global(self.module.constants[*constant].init),
            Expression::ZeroValue(ty) => return self.zero(*ty, at),
            Expression::Compose { ty, components } => {
                let mut parts = Vec::new();
                for component in components {
                    match (self.value(frame, *component)?, &self.module.types[*ty].inner) {
                        // vectors may be made of vectors
                        (Value::Parts(inner), TypeInner::Vector { .. }) => parts.extend(inner),
                        (value, _) => parts.push(value),
                    }
                }
                Value::Parts(parts)
            }
            Expression::Access { base, index } => {
                let index = match self.value(frame, *index)? {
                    Value::Signed(index) => usize::try_from(index).ok(),
                    Value::Unsigned(index) => usize::try_from(index).ok(),
                    _ => None,
                };
                let Some(index) = index else {
                    return Err(Untranslatable::new(at, "an index must be known here, not differ from element to element"));
                };
                let base = self.value(frame, *base)?;
                self.part(base, index, at)?
            }
            Expression::AccessIndex { base, index } => {
                let base = self.value(frame, *base)?;
                self.part(base, *index as usize, at)?
            }
            Expression::Splat { size, value } => Value::Parts(vec![self.value(frame, *value)?; *size as usize]),
            Expression::Swizzle { size, vector, pattern } => {
                let vector = self.value(frame, *vector)?;
                let parts: Result<Vec<Value>> =
                    pattern[..*size as usize].iter().map(|c| self.part(vector.clone(), *c as usize, at)).collect();
                Value::Parts(parts?)
            }
            Expression::FunctionArgument(number) => frame.arguments[*number as usize].clone(),
            Expression::GlobalVariable(variable) => {
                Value::Place(Place { variable: Variable::Global(variable.index()), path: Vec::new() })
            }
            Expression::LocalVariable(variable) => {
                Value::Place(Place { variable: Variable::Local(variable.index()), path: Vec::new() })
            }
            Expression::Load { pointer } => match self.value(frame, *pointer)? {
                Value::Place(place) => self.load(frame, &place, at)?,
                _ => return not_allowed(),
            },
            Expression::Unary { op, expr } => {
                let value = self.value(frame, *expr)?;
                self.unary(*op, value, at)?
            }
            Expression::Binary { op, left, right } => {
                let (left, right) = (self.value(frame, *left)?, self.value(frame, *right)?);
                self.binary(*op, left, right, at)?
            }
            Expression::Select { condition, accept, reject } => {
                let condition = self.value(frame, *condition)?;
                let (accept, reject) = (self.value(frame, *accept)?, self.value(frame, *reject)?);
                self.select(condition, accept, reject, at)?
            }
            Expression::Relational { fun, argument } => {
                let argument = self.value(frame, *argument)?;
                self.relational(*fun, argument, at)?
            }
            Expression::Math { fun, arg, arg1, arg2, .. } => {
                let mut arguments = vec![self.value(frame, *arg)?];
                for argument in [arg1, arg2].into_iter().flatten() {
                    arguments.push(self.value(frame, *argument)?);
                }
                self.math(*fun, arguments, at)?
            }
            Expression::As { expr, kind, convert: Some(_) } => {
                let value = self.value(frame, *expr)?;
                self.convert(value, *kind, at)?
            }
            _ => return not_allowed(),
        })
    }

    fn literal(&mut self, literal: Literal, at: Span) -> Result<Value> {
        Ok(match literal {
            Literal::F64(value) => Value::Float(self.graph.constant(value)),
            Literal::F32(value) => Value::Float(self.graph.constant(f64::from(value))),
            Literal::I32(value) => Value::Signed(value),
            Literal::U32(value) => Value::Unsigned(value),
            Literal::Bool(value) => Value::Bool(Test::Known(value)),
            _ => return Err(Untranslatable::new(at, NOT_ALLOWED)),
        })
    }

    /// The zero of a type: what a variable starts with.
    pub(super) fn zero(&mut self, ty: Handle<Type>, at: Span) -> Result<Value> {
        let scalar = |this: &mut Self, kind: ScalarKind| match kind {
            ScalarKind::Float => Ok(Value::Float(this.graph.constant(0.0))),
            ScalarKind::Sint => Ok(Value::Signed(0)),
            ScalarKind::Uint => Ok(Value::Unsigned(0)),
            ScalarKind::Bool => Ok(Value::Bool(Test::Known(false))),
            _ => Err(Untranslatable::new(at, NOT_ALLOWED)),
        };
        Ok(match &self.module.types[ty].inner {
            TypeInner::Scalar(s) => scalar(self, s.kind)?,
            TypeInner::Vector { size, scalar: s } => Value::Parts(vec![scalar(self, s.kind)?; *size as usize]),
            TypeInner::Matrix { columns, rows, scalar: s } => {
                Value::Parts(vec![Value::Parts(vec![scalar(self, s.kind)?; *rows as usize]); *columns as usize])
            }
            TypeInner::Array { base, size: naga::ArraySize::Constant(count), .. } => {
                Value::Parts(vec![self.zero(*base, at)?; count.get() as usize])
            }
            TypeInner::Struct { members, .. } => {
                let parts: Result<Vec<Value>> = members.iter().map(|member| self.zero(member.ty, at)).collect();
                Value::Parts(parts?)
            }
            _ => return Err(Untranslatable::new(at, NOT_ALLOWED)),
        })
    }

    fn part(&self, base: Value, index: usize, at: Span) -> Result<Value> {
        let part = match base {
            Value::Place(place) => return Ok(Value::Place(place.part(index))),
            Value::Parts(mut parts) if index < parts.len() => Some(parts.swap_remove(index)),
            _ => None,
        };
        part.ok_or_else(|| Untranslatable::new(at, format!("there is no part {index} here: indices count from 0")))
    }

    fn load(&self, frame: &Frame<'m>, place: &Place, at: Span) -> Result<Value> {
        let variable = match place.variable {
            Variable::Local(number) => frame.state.locals.get(number),
            Variable::Global(number) => self.globals.get(number).and_then(Option::as_ref),
        };
        let value = variable.and_then(|value| value.at(&place.path)).cloned();
        value.ok_or_else(|| Untranslatable::new(at, "this index leads beyond the end, or this variable is not the law's"))
    }

    fn unary(&mut self, op: UnaryOperator, value: Value, at: Span) -> Result<Value> {
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

    fn binary(&mut self, op: BinaryOperator, left: Value, right: Value, at: Span) -> Result<Value> {
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
            (Value::Signed(a), Value::Signed(b)) => whole(op, a, b, Value::Signed, i32::wrapping_add, i32::wrapping_sub, i32::wrapping_mul, i32::checked_div, i32::checked_rem, at)?,
            (Value::Unsigned(a), Value::Unsigned(b)) => whole(op, a, b, Value::Unsigned, u32::wrapping_add, u32::wrapping_sub, u32::wrapping_mul, u32::checked_div, u32::checked_rem, at)?,
            _ => return Err(Untranslatable::new(at, VARYING)),
        })
    }

    fn float_binary(&mut self, op: BinaryOperator, a: super::graph::Id, b: super::graph::Id, at: Span) -> Result<Value> {
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

    fn select(&mut self, condition: Value, accept: Value, reject: Value, at: Span) -> Result<Value> {
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

    fn convert(&mut self, value: Value, kind: ScalarKind, at: Span) -> Result<Value> {
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
            (Value::Float(_), _) => {
                return Err(Untranslatable::new(at, "a number that differs from element to element cannot become a whole one"));
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
