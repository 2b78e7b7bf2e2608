//! Products of matrices and WGSL's own functions, in terms of the few that a graph has.

use super::graph::{Binary, Id, Unary};
use super::translate::{Result, Translator};
use super::value::{Test, Value};
use super::{FUNCTIONS, Untranslatable};
use naga::{MathFunction as F, RelationalFunction, Span};

/// Whole powers up to this one are products; further ones go by logarithms.
const LARGEST_PRODUCT: f64 = 32.0;

impl Translator<'_> {
    /// The product, where one of the factors is a matrix and the other more than a number.
    pub(super) fn matrix_product(&mut self, left: &Value, right: &Value) -> Option<Value> {
        match (columns(left), columns(right)) {
            (Some(m), None) => {
                let vector = vector(right)?;
                self.times_vector(&m, &vector).map(Value::vector)
            }
            (None, Some(m)) => {
                let vector = vector(left)?;
                Some(Value::vector(m.iter().map(|column| self.dot(&vector, column)).collect::<Vec<_>>()))
            }
            (Some(m), Some(n)) => {
                let product: Option<Vec<Value>> =
                    n.iter().map(|column| self.times_vector(&m, column).map(Value::vector)).collect();
                product.map(Value::Parts)
            }
            (None, None) => None,
        }
    }

    fn times_vector(&mut self, columns: &[Vec<Id>], vector: &[Id]) -> Option<Vec<Id>> {
        let rows = columns.first()?.len();
        let row = |i: usize| columns.iter().map(|column| column[i]).collect::<Vec<_>>();
        Some((0..rows).map(|i| self.dot(&row(i), vector)).collect())
    }

    pub(super) fn relational(&mut self, function: RelationalFunction, argument: Value, at: Span) -> Result<Value> {
        let parts = match argument {
            Value::Parts(parts) => parts,
            single => vec![single],
        };
        let mut tests = Vec::new();
        for part in parts {
            match (function, part) {
                (RelationalFunction::All | RelationalFunction::Any, Value::Bool(test)) => tests.push(test),
                _ => return Err(not_there(at)),
            }
        }
        let all = function == RelationalFunction::All;
        let test = tests.into_iter().fold(Test::Known(all), |a, b| match all {
            true => self.graph.and(a, b),
            false => self.graph.or(a, b),
        });
        Ok(Value::Bool(test))
    }

    pub(super) fn math(&mut self, function: F, arguments: Vec<Value>, at: Span) -> Result<Value> {
        match (function, arguments.as_slice()) {
            (F::Dot, [a, b]) => {
                let (a, b) = (floats(a, at)?, floats(b, at)?);
                Ok(Value::Float(self.dot(&a, &b)))
            }
            (F::Cross, [a, b]) => {
                let (a, b) = (floats(a, at)?, floats(b, at)?);
                Ok(Value::vector([(1, 2), (2, 0), (0, 1)].map(|(i, j)| self.minor(a[i], a[j], b[i], b[j]))))
            }
            (F::Length | F::Distance, [a, rest @ ..]) => {
                let mut vector = floats(a, at)?;
                if let [b] = rest {
                    let b = floats(b, at)?;
                    vector = vector.iter().zip(b).map(|(&a, b)| self.graph.binary(Binary::Subtract, a, b)).collect();
                }
                Ok(Value::Float(self.length(&vector)))
            }
            (F::Normalize, [a]) => {
                let vector = floats(a, at)?;
                let length = self.length(&vector);
                Ok(Value::vector(
                    vector.into_iter().map(|x| self.graph.binary(Binary::Divide, x, length)).collect::<Vec<_>>(),
                ))
            }
            (F::Outer, [a, b]) => {
                let (a, b) = (floats(a, at)?, floats(b, at)?);
                let column = |this: &mut Self, y: Id| {
                    Value::vector(a.iter().map(|&x| this.graph.binary(Binary::Multiply, x, y)).collect::<Vec<_>>())
                };
                Ok(Value::Parts(b.into_iter().map(|y| column(self, y)).collect()))
            }
            (F::Transpose, [m]) => {
                let columns = columns(m).ok_or_else(|| not_there(at))?;
                let rows = columns.first().map_or(0, Vec::len);
                Ok(Value::Parts((0..rows).map(|i| Value::vector(columns.iter().map(|column| column[i]))).collect()))
            }
            (F::Determinant, [m]) => match columns(m).ok_or_else(|| not_there(at))?.as_slice() {
                [a, b] => Ok(Value::Float(self.minor(a[0], a[1], b[0], b[1]))),
                [a, b, c] if a.len() == 3 => {
                    let cross = [(1, 2), (2, 0), (0, 1)].map(|(i, j)| self.minor(b[i], b[j], c[i], c[j]));
                    Ok(Value::Float(self.dot(a, &cross)))
                }
                _ => Err(not_there(at)),
            },
            (_, [Value::Parts(first), ..]) => {
                let part = |argument: &Value, i: usize| match argument {
                    Value::Parts(parts) => parts.get(i).cloned(),
                    // `mix` takes a single share for a whole vector
                    single => Some(single.clone()),
                };
                let mut results = Vec::new();
                for i in 0..first.len() {
                    let arguments: Option<Vec<Value>> = arguments.iter().map(|argument| part(argument, i)).collect();
                    results.push(self.math(function, arguments.ok_or_else(|| not_there(at))?, at)?);
                }
                Ok(Value::Parts(results))
            }
            _ => {
                let numbers: Result<Vec<Id>> = arguments.iter().map(|argument| number(argument, at)).collect();
                self.pointwise(function, &numbers?).map(Value::Float).ok_or_else(|| not_there(at))
            }
        }
    }

    /// A function of numbers, or `None` where there is none.
    fn pointwise(&mut self, function: F, x: &[Id]) -> Option<Id> {
        use Binary::{Add, Divide, Less, Max, Min, Multiply, Subtract};
        let g = &mut self.graph;
        let one = g.constant(1.0);
        let zero = g.constant(0.0);
        Some(match (function, x) {
            (F::Abs, &[x]) => g.unary(Unary::Abs, x),
            (F::Sqrt, &[x]) => g.unary(Unary::Sqrt, x),
            (F::Exp, &[x]) => g.unary(Unary::Exp, x),
            (F::Sin, &[x]) => g.unary(Unary::Sine, x),
            (F::Cos, &[x]) => g.unary(Unary::Cosine, x),
            // e/(e + 2) with e = e^(2x) − 1; at 20 it is 1 to all digits
            (F::Tanh, &[x]) => {
                let (two, largest) = (g.constant(2.0), g.constant(20.0));
                let x = g.binary(Min, x, largest);
                let twice = g.binary(Multiply, two, x);
                let grown = g.unary(Unary::ExpLessOne, twice);
                let sum = g.binary(Add, grown, two);
                g.binary(Divide, grown, sum)
            }
            (F::Log, &[x]) => g.unary(Unary::Log, x),
            (F::InverseSqrt, &[x]) => {
                let root = g.unary(Unary::Sqrt, x);
                g.binary(Divide, one, root)
            }
            (F::Exp2, &[x]) => {
                let factor = g.constant(std::f64::consts::LN_2);
                let x = g.binary(Multiply, x, factor);
                g.unary(Unary::Exp, x)
            }
            (F::Log2, &[x]) => {
                let (log, factor) = (g.unary(Unary::Log, x), g.constant(std::f64::consts::LOG2_E));
                g.binary(Multiply, log, factor)
            }
            (F::Pow, &[x, y]) => self.power(x, y),
            (F::Min, &[a, b]) => g.binary(Min, a, b),
            (F::Max, &[a, b]) => g.binary(Max, a, b),
            (F::Clamp, &[x, low, high]) => {
                let x = g.binary(Max, x, low);
                g.binary(Min, x, high)
            }
            (F::Saturate, &[x]) => {
                let x = g.binary(Max, x, zero);
                g.binary(Min, x, one)
            }
            (F::Sign, &[x]) => {
                let (above, below) = (g.binary(Less, zero, x), g.binary(Less, x, zero));
                g.binary(Subtract, above, below)
            }
            (F::Step, &[edge, x]) => {
                let below = g.binary(Less, x, edge);
                g.binary(Subtract, one, below)
            }
            (F::Fma, &[a, b, c]) => {
                let product = g.binary(Multiply, a, b);
                g.binary(Add, product, c)
            }
            (F::Mix, &[a, b, share]) => {
                let rest = g.binary(Subtract, one, share);
                let (a, b) = (g.binary(Multiply, a, rest), g.binary(Multiply, b, share));
                g.binary(Add, a, b)
            }
            _ => return None,
        })
    }

    /// x^y: products for whole y, roots for halves and thirds, else by logarithms.
    fn power(&mut self, x: Id, y: Id) -> Id {
        let g = &mut self.graph;
        let (one, exponent) = (g.constant(1.0), g.constant_of(y).unwrap_or(f64::NAN));
        let near = |value: f64| (exponent - value).abs() <= 2.0 * f64::EPSILON;
        if exponent.abs() <= LARGEST_PRODUCT && (2.0 * exponent).fract() == 0.0 {
            let mut product = self.whole_power(x, exponent.abs() as u32);
            let g = &mut self.graph;
            if exponent.fract() != 0.0 {
                let root = g.unary(Unary::Sqrt, x);
                product = g.binary(Binary::Multiply, product, root);
            }
            // the derivative at 0 is 0, not what 0 · (0.5/0) would be
            if exponent.fract() != 0.0 && exponent > 1.0 {
                return self.above_zero(x, product, true);
            }
            return if exponent < 0.0 { g.binary(Binary::Divide, one, product) } else { product };
        }
        let third = g.unary(Unary::InverseCbrt, x);
        let two_thirds = g.binary(Binary::Multiply, third, third);
        let power = if near(-1.0 / 3.0) {
            third
        } else if near(-2.0 / 3.0) {
            two_thirds
        } else if near(1.0 / 3.0) {
            g.binary(Binary::Multiply, x, two_thirds)
        } else if near(2.0 / 3.0) {
            g.binary(Binary::Multiply, x, third)
        } else {
            let log = g.unary(Unary::Log, x);
            let product = g.binary(Binary::Multiply, log, y);
            g.unary(Unary::Exp, product)
        };
        self.above_zero(x, power, exponent > 0.0)
    }

    /// As on the GPU: negative numbers have no such power, 0 has the positive ones.
    fn above_zero(&mut self, x: Id, power: Id, positive: bool) -> Id {
        let g = &mut self.graph;
        let (none, zero, below) = (g.constant(f64::NAN), g.constant(0.0), g.unary(Unary::Negate, x));
        let at_zero = if positive { g.select(below, none, zero) } else { none };
        g.select(x, power, at_zero)
    }

    fn whole_power(&mut self, x: Id, exponent: u32) -> Id {
        let (mut power, mut square, mut rest) = (self.graph.constant(1.0), x, exponent);
        while rest > 0 {
            if rest % 2 == 1 {
                power = self.graph.binary(Binary::Multiply, power, square);
            }
            rest /= 2;
            if rest > 0 {
                square = self.graph.binary(Binary::Multiply, square, square);
            }
        }
        power
    }

    fn dot(&mut self, a: &[Id], b: &[Id]) -> Id {
        let mut sum = self.graph.constant(0.0);
        for (&a, &b) in a.iter().zip(b) {
            let product = self.graph.binary(Binary::Multiply, a, b);
            sum = self.graph.binary(Binary::Add, sum, product);
        }
        sum
    }

    /// a d − b c.
    fn minor(&mut self, a: Id, b: Id, c: Id, d: Id) -> Id {
        let (first, second) = (self.graph.binary(Binary::Multiply, a, d), self.graph.binary(Binary::Multiply, b, c));
        self.graph.binary(Binary::Subtract, first, second)
    }

    fn length(&mut self, vector: &[Id]) -> Id {
        if let [x] = vector {
            return self.graph.unary(Unary::Abs, *x);
        }
        let square = self.dot(vector, vector);
        self.graph.unary(Unary::Sqrt, square)
    }
}

fn not_there(at: Span) -> Untranslatable {
    Untranslatable::new(at, "this function is not there for a text of one's own").note(FUNCTIONS)
}

fn number(value: &Value, at: Span) -> Result<Id> {
    match value {
        Value::Float(id) => Ok(*id),
        _ => Err(not_there(at)),
    }
}

fn floats(value: &Value, at: Span) -> Result<Vec<Id>> {
    value.floats().ok_or_else(|| not_there(at))
}

fn vector(value: &Value) -> Option<Vec<Id>> {
    match value {
        Value::Parts(_) => value.floats(),
        _ => None,
    }
}

/// The columns, where the value is a matrix.
fn columns(value: &Value) -> Option<Vec<Vec<Id>>> {
    match value {
        Value::Parts(parts) => parts.iter().map(vector).collect(),
        _ => None,
    }
}
