//! From the expressions of a WGSL function to values.

use super::translate::{Frame, Result, Translator};
use super::value::{Pointer, Test, Value, Variable};
use super::{NOT_ALLOWED, Untranslatable};
use naga::{Expression, Handle, Literal, ScalarKind, Span, Type, TypeInner};

/// The largest value that a text may have, in double precision: 1000 numbers and more.
const MOST_BYTES: u32 = 8192;

impl<'m> Translator<'m> {
    pub(super) fn expression(&mut self, frame: &mut Frame<'m>, handle: Handle<Expression>) -> Result<Value> {
        let at = frame.expressions.get_span(handle);
        let not_allowed = || Err(Untranslatable::new(at, NOT_ALLOWED));
        Ok(match &frame.expressions[handle] {
            Expression::Literal(literal) => return self.literal(*literal, at),
            Expression::Constant(constant) => return self.global(self.module.constants[*constant].init),
            Expression::ZeroValue(ty) => return self.zero(*ty, at),
            Expression::Compose { ty, components } => {
                self.bearable(*ty, at)?;
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
                    return Err(Untranslatable::new(
                        at,
                        "an index must be known here, not differ from element to element or node to node",
                    ));
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
                Value::Pointer(Pointer { variable: Variable::Global(variable.index()), path: Vec::new() })
            }
            Expression::LocalVariable(variable) => {
                Value::Pointer(Pointer { variable: Variable::Local(variable.index()), path: Vec::new() })
            }
            Expression::Load { pointer } => match self.value(frame, *pointer)? {
                Value::Pointer(place) => self.load(frame, &place, at)?,
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

    /// Whether a value of a type is small enough to be handled number by number.
    fn bearable(&self, ty: Handle<Type>, at: Span) -> Result<()> {
        let size = self.module.types[ty].inner.try_size(self.module.to_ctx());
        if size.is_none_or(|bytes| bytes > MOST_BYTES) {
            let message = format!("a value of more than {MOST_BYTES} bytes is too large");
            return Err(Untranslatable::new(at, message).note("its numbers are handled one by one: use smaller arrays"));
        }
        Ok(())
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
        self.bearable(ty, at)?;
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
            Value::Pointer(place) => return Ok(Value::Pointer(place.part(index))),
            Value::Parts(mut parts) if index < parts.len() => Some(parts.swap_remove(index)),
            _ => None,
        };
        part.ok_or_else(|| Untranslatable::new(at, format!("there is no part {index} here: indices count from 0")))
    }

    fn load(&self, frame: &Frame<'m>, place: &Pointer, at: Span) -> Result<Value> {
        let variable = match place.variable {
            Variable::Local(number) => frame.state.locals.get(number),
            Variable::Global(number) => self.globals.get(number).and_then(Option::as_ref),
        };
        let value = variable.and_then(|value| value.at(&place.path)).cloned();
        value.ok_or_else(|| {
            Untranslatable::new(at, "this index leads beyond the end, or this variable holds no parameters")
        })
    }
}
