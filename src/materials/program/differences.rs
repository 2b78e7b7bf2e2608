//! Differences from rest in a form that keeps their digits: energies at strains of 1e-4 are 1e-8 of the numbers that
//! they are written with, and f32 has no more than seven digits.
//!
//! What is there of each value f is its number at rest, a linear function L of the inputs, f − f(rest) and
//! f − f(rest) − L, the last two by exact rules from those of what f is made of: of a product ab the first is
//! (a − a₀) b + a₀ (b − b₀). No term is left out anywhere.

use super::graph::{Binary, Graph, Id, Node, Unary};

/// Inputs that differences are taken in; all are 0 at rest.
const INPUTS: usize = 2;

/// A value as its number at rest and what is added to that.
#[derive(Clone, Copy, Debug)]
pub(super) struct Difference {
    /// f(rest).
    pub(super) at_rest: f64,
    /// The factors of the inputs in L: the derivatives at rest. At a kink those of the branch that is taken there.
    pub(super) slopes: [f64; INPUTS],
    /// f − f(rest).
    pub(super) first: Id,
    /// f − f(rest) − L.
    pub(super) second: Id,
}

impl Graph {
    /// A value's difference from rest; none where it is not finite there.
    pub(super) fn difference(&mut self, of: Id) -> Option<Difference> {
        let wanted = self.wanted(&[of]);
        let mut found: Vec<Option<Difference>> = vec![None; of.index() + 1];
        for index in (0..=of.index()).filter(|index| wanted[*index]) {
            let id = Id::of(index);
            let at = |id: Id| found[id.index()];
            found[index] = match self.node(id) {
                Node::Input(number) => self.of_input(id, usize::from(number)),
                Node::Constant(bits) => {
                    let zero = self.constant(0.0);
                    Some(Difference { at_rest: f64::from_bits(bits), slopes: [0.0; INPUTS], first: zero, second: zero })
                }
                Node::Unary(function, x) => at(x).map(|of| self.of_unary(function, id, of)),
                Node::Binary(function, a, b) => match (at(a), at(b)) {
                    (Some(left), Some(right)) => Some(self.of_binary(function, (a, left), (b, right), id)),
                    _ => None,
                },
                Node::Select(test, a, b) => self.of_select((test, at(test)), (a, at(a)), (b, at(b))),
            }
            .filter(|of| of.at_rest.is_finite() && of.slopes.iter().all(|slope| slope.is_finite()));
        }
        found[of.index()]
    }

    fn of_input(&mut self, id: Id, number: usize) -> Option<Difference> {
        let mut slopes = [0.0; INPUTS];
        *slopes.get_mut(number)? = 1.0;
        Some(Difference { at_rest: 0.0, slopes, first: id, second: self.constant(0.0) })
    }

    /// Of y = f(x).
    fn of_unary(&mut self, function: Unary, y: Id, x: Difference) -> Difference {
        let at_rest = function.of(x.at_rest);
        let times = |factor: f64| x.slopes.map(|slope| factor * slope);
        match function {
            Unary::Negate => self.multiple(-1.0, x),
            Unary::Abs => self.of_size(x),
            // (a − a₀)/(√a + √a₀)
            Unary::Sqrt if at_rest > 0.0 => {
                let slopes = times(0.5 / at_rest);
                let sum = self.plus_number(y, at_rest);
                let first = self.tidy(Binary::Divide, x.first, sum);
                let bent = self.linear(slopes);
                let bent = self.tidy(Binary::Multiply, bent, first);
                let rest = self.tidy(Binary::Subtract, x.second, bent);
                Difference { at_rest, slopes, first, second: self.tidy(Binary::Divide, rest, sum) }
            }
            // its slope is infinite at 0
            Unary::Sqrt => Difference { at_rest, slopes: [0.0; INPUTS], first: y, second: y },
            Unary::Exp | Unary::ExpLessOne => {
                let factor = x.at_rest.exp();
                let grown = self.unary(Unary::ExpLessOne, x.first);
                let bent = self.exponential_remainder(x.first);
                let bent = self.tidy(Binary::Add, bent, x.second);
                let (first, second) = (self.number_times(factor, grown), self.number_times(factor, bent));
                Difference { at_rest, slopes: times(factor), first, second }
            }
            Unary::Log | Unary::LogOfOnePlus => {
                let factor = 1.0 / if function == Unary::Log { x.at_rest } else { 1.0 + x.at_rest };
                let share = self.number_times(factor, x.first);
                let bent = self.logarithm_remainder(share);
                let rest = self.number_times(factor, x.second);
                let second = self.tidy(Binary::Add, bent, rest);
                Difference { at_rest, slopes: times(factor), first: self.unary(Unary::LogOfOnePlus, share), second }
            }
            Unary::InverseCbrt => self.of_inverse_cbrt(y, at_rest, x),
            // sin(a₀ + d) = sin a₀ cos d + cos a₀ sin d with cos d = 1 − 2 sin²(d/2)
            Unary::Sine | Unary::Cosine => {
                let (own, other) = match function {
                    Unary::Sine => (at_rest, x.at_rest.cos()),
                    _ => (at_rest, -x.at_rest.sin()),
                };
                let half = self.number_times(0.5, x.first);
                let half = self.unary(Unary::Sine, half);
                let bent = self.tidy(Binary::Multiply, half, half);
                let bent = self.number_times(-2.0 * own, bent);
                let sine = self.unary(Unary::Sine, x.first);
                let turned = self.number_times(other, sine);
                let first = self.tidy(Binary::Add, bent, turned);
                let rest = self.tidy(Binary::Subtract, sine, x.first);
                let rest = self.tidy(Binary::Add, rest, x.second);
                let rest = self.number_times(other, rest);
                Difference { at_rest, slopes: times(other), first, second: self.tidy(Binary::Add, bent, rest) }
            }
        }
    }

    /// |x| = max(s x, −s x) with the sign s at rest; at 0 its slope is taken for 0.
    fn of_size(&mut self, x: Difference) -> Difference {
        let at_rest = x.at_rest.abs();
        if at_rest == 0.0 {
            let first = self.unary(Unary::Abs, x.first);
            return Difference { at_rest, slopes: [0.0; INPUTS], first, second: first };
        }
        let along = self.multiple(x.at_rest.signum(), x);
        let against = self.number_times(-1.0, along.first);
        let against = self.plus_number(against, -2.0 * at_rest);
        let slope = self.linear(along.slopes);
        let bent = self.tidy(Binary::Subtract, against, slope);
        let first = self.binary(Binary::Max, along.first, against);
        Difference { at_rest, first, second: self.binary(Binary::Max, along.second, bent), ..along }
    }

    /// Of y = x^(−1/3), from y³ x = y₀³ x₀ = 1: with d = y − y₀, d = −y₀³ (x − x₀)/(x (y² + y y₀ + y₀²)), and
    /// d − L = −y₀/3 (y₀³ (x − x₀ − Lₓ) + 3y₀² d (x − x₀) + d² (3y₀ + d) x).
    fn of_inverse_cbrt(&mut self, y: Id, at_rest: f64, of: Difference) -> Difference {
        use Binary::{Add, Divide, Multiply};
        let cube = at_rest.powi(3);
        let x = self.plus_number(of.first, of.at_rest);
        let sum = self.plus_number(y, at_rest);
        let squares = self.tidy(Multiply, y, sum);
        let squares = self.plus_number(squares, at_rest * at_rest);
        let divisor = self.tidy(Multiply, x, squares);
        let above = self.number_times(-cube, of.first);
        let first = self.tidy(Divide, above, divisor);
        let product = self.tidy(Multiply, first, of.first);
        let product = self.number_times(3.0 * at_rest * at_rest, product);
        let square = self.tidy(Multiply, first, first);
        let longer = self.plus_number(first, 3.0 * at_rest);
        let bent = self.tidy(Multiply, square, longer);
        let bent = self.tidy(Multiply, bent, x);
        let bent = self.tidy(Add, product, bent);
        let rest = self.number_times(cube, of.second);
        let rest = self.tidy(Add, rest, bent);
        let slopes = of.slopes.map(|slope| -at_rest.powi(4) / 3.0 * slope);
        Difference { at_rest, slopes, first, second: self.number_times(-at_rest / 3.0, rest) }
    }

    fn of_binary(
        &mut self,
        function: Binary,
        (a, x): (Id, Difference),
        (b, y): (Id, Difference),
        id: Id,
    ) -> Difference {
        use Binary::{Add, Divide, Less, Max, Min, Multiply, Subtract};
        let at_rest = function.of(x.at_rest, y.at_rest);
        let both = |f: &dyn Fn(f64, f64) -> f64| std::array::from_fn(|i| f(x.slopes[i], y.slopes[i]));
        match function {
            Add | Subtract => Difference {
                at_rest,
                slopes: both(&|a, b| function.of(a, b)),
                first: self.tidy(function, x.first, y.first),
                second: self.tidy(function, x.second, y.second),
            },
            // a² − a₀² = (a − a₀)(a + a₀)
            Multiply if a == b => {
                let sum = self.plus_number(a, x.at_rest);
                let (first, square) = (self.tidy(Multiply, x.first, sum), self.tidy(Multiply, x.first, x.first));
                let rest = self.number_times(2.0 * x.at_rest, x.second);
                let slopes = both(&|a, _| 2.0 * x.at_rest * a);
                Difference { at_rest, slopes, first, second: self.tidy(Add, square, rest) }
            }
            Multiply => {
                let (left, right) = (self.tidy(Multiply, x.first, b), self.number_times(x.at_rest, y.first));
                let first = self.tidy(Add, left, right);
                let (left, right) = (self.number_times(y.at_rest, x.second), self.number_times(x.at_rest, y.second));
                let product = self.tidy(Multiply, x.first, y.first);
                let rest = self.tidy(Add, left, right);
                let slopes = both(&|a, b| a * y.at_rest + x.at_rest * b);
                Difference { at_rest, slopes, first, second: self.tidy(Add, product, rest) }
            }
            // (a − a₀ − q₀ (b − b₀))/b
            Divide => {
                let slopes = both(&|a, b| (a - at_rest * b) / y.at_rest);
                let taken = self.number_times(at_rest, y.first);
                let first = self.tidy(Subtract, x.first, taken);
                let taken = self.number_times(at_rest, y.second);
                let rest = self.tidy(Subtract, x.second, taken);
                let bent = self.linear(slopes);
                let bent = self.tidy(Multiply, bent, y.first);
                let second = self.tidy(Subtract, rest, bent);
                let (first, second) = (self.tidy(Divide, first, b), self.tidy(Divide, second, b));
                Difference { at_rest, slopes, first, second }
            }
            Min | Max => {
                let chosen = match function == Min && x.at_rest < y.at_rest || function == Max && x.at_rest > y.at_rest
                {
                    true => x,
                    false => y,
                };
                let (x, y) = (self.beside(x, chosen), self.beside(y, chosen));
                let (first, second) = (self.binary(function, x.0, y.0), self.binary(function, x.1, y.1));
                Difference { first, second, ..chosen }
            }
            Less => {
                let first = self.plus_number(id, -at_rest);
                Difference { at_rest, slopes: [0.0; INPUTS], first, second: first }
            }
        }
    }

    fn of_select(
        &mut self,
        (test, at_rest): (Id, Option<Difference>),
        (a, x): (Id, Option<Difference>),
        (b, y): (Id, Option<Difference>),
    ) -> Option<Difference> {
        let chosen = if at_rest?.at_rest > 0.0 { x } else { y }?;
        let [x, y] = [(a, x), (b, y)].map(|(id, of)| match of {
            Some(of) => self.beside(of, chosen),
            // what is not finite at rest is not chosen there
            None => {
                let first = self.plus_number(id, -chosen.at_rest);
                let slope = self.linear(chosen.slopes);
                (first, self.tidy(Binary::Subtract, first, slope))
            }
        });
        Some(Difference { first: self.select(test, x.0, y.0), second: self.select(test, x.1, y.1), ..chosen })
    }

    /// What a value is added to another's number at rest, and to its linear function as well.
    fn beside(&mut self, of: Difference, other: Difference) -> (Id, Id) {
        let apart = of.at_rest - other.at_rest;
        let slope = self.linear(std::array::from_fn(|i| of.slopes[i] - other.slopes[i]));
        let (first, second) = (self.plus_number(of.first, apart), self.plus_number(of.second, apart));
        (first, self.tidy(Binary::Add, second, slope))
    }

    fn multiple(&mut self, factor: f64, of: Difference) -> Difference {
        Difference {
            at_rest: factor * of.at_rest,
            slopes: of.slopes.map(|slope| factor * slope),
            first: self.number_times(factor, of.first),
            second: self.number_times(factor, of.second),
        }
    }

    /// Σ slopesᵢ xᵢ.
    pub(super) fn linear(&mut self, slopes: [f64; INPUTS]) -> Id {
        let mut sum = self.constant(0.0);
        for (number, slope) in slopes.into_iter().enumerate().filter(|(_, slope)| *slope != 0.0) {
            let input = self.input(number as u16);
            let term = self.number_times(slope, input);
            sum = self.tidy(Binary::Add, sum, term);
        }
        sum
    }

    fn number_times(&mut self, factor: f64, x: Id) -> Id {
        let factor = self.constant(factor);
        self.tidy(Binary::Multiply, factor, x)
    }

    pub(super) fn plus_number(&mut self, x: Id, summand: f64) -> Id {
        let summand = self.constant(summand);
        self.tidy(Binary::Add, x, summand)
    }

    /// e^x − 1 − x. Below ¼ its series, which ends where f64 does (2 x¹¹/13! < 1e-16); beyond, the difference loses no
    /// more than a factor of 8.
    fn exponential_remainder(&mut self, x: Id) -> Id {
        let mut factor = 1.0;
        let factors: Vec<f64> = (2..=12)
            .map(|k| {
                factor /= f64::from(k);
                factor
            })
            .collect();
        let series = self.polynomial(&factors, x);
        let square = self.tidy(Binary::Multiply, x, x);
        let near = self.tidy(Binary::Multiply, square, series);
        let grown = self.unary(Unary::ExpLessOne, x);
        let far = self.tidy(Binary::Subtract, grown, x);
        self.within(x, 0.25, near, far)
    }

    /// ln(1 + x) − x = 2s³ (⅓ + s²/5 + ...) − s x with s = x/(2 + x). Below ⅛ as that, with a series that ends where
    /// f64 does (s¹³/17 < 1e-16); beyond, the difference loses no more than a factor of 20.
    fn logarithm_remainder(&mut self, x: Id) -> Id {
        let factors: Vec<f64> = (0..7).map(|k| 2.0 / f64::from(2 * k + 3)).collect();
        let sum = self.plus_number(x, 2.0);
        let s = self.tidy(Binary::Divide, x, sum);
        let square = self.tidy(Binary::Multiply, s, s);
        let series = self.polynomial(&factors, square);
        let series = self.tidy(Binary::Multiply, square, series);
        let less = self.tidy(Binary::Subtract, series, x);
        let near = self.tidy(Binary::Multiply, s, less);
        let logarithm = self.unary(Unary::LogOfOnePlus, x);
        let far = self.tidy(Binary::Subtract, logarithm, x);
        self.within(x, 0.125, near, far)
    }

    /// Σ factorₖ xᵏ.
    fn polynomial(&mut self, factors: &[f64], x: Id) -> Id {
        let mut sum = self.constant(0.0);
        for factor in factors.iter().rev() {
            let product = self.tidy(Binary::Multiply, sum, x);
            sum = self.plus_number(product, *factor);
        }
        sum
    }

    /// `near` where |x| is below a limit.
    fn within(&mut self, x: Id, limit: f64, near: Id, far: Id) -> Id {
        let (size, limit) = (self.unary(Unary::Abs, x), self.constant(limit));
        let test = self.binary(Binary::Less, size, limit);
        self.select(test, near, far)
    }
}
