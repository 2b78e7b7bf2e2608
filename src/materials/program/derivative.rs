//! Derivatives of a graph: forward, since what is differentiated has no more than three inputs that matter.

use super::graph::{Binary, Graph, Id, Node, Unary};

impl Graph {
    /// The derivative of a value by an input. Where a choice switches it is that of the branch chosen; |x| has 0 at 0.
    pub(super) fn derivative(&mut self, of: Id, by: u16) -> Id {
        // none: 0 wherever
        let mut derivatives: Vec<Option<Id>> = vec![None; of.index() + 1];
        for index in 0..derivatives.len() {
            let node = self.nodes()[index];
            let d = |id: Id| derivatives[id.index()];
            derivatives[index] = match node {
                Node::Input(number) => (number == by).then(|| self.constant(1.0)),
                Node::Constant(_) => None,
                Node::Unary(function, x) => d(x).map(|dx| {
                    let slope = self.slope(function, x, Id::of(index));
                    self.tidy(Binary::Multiply, slope, dx)
                }),
                Node::Binary(function, a, b) => self.of_two(function, (a, d(a)), (b, d(b)), Id::of(index)),
                Node::Select(test, a, b) => self.chosen(test, (a, d(a)), (b, d(b))),
            };
        }
        derivatives[of.index()].unwrap_or_else(|| self.constant(0.0))
    }

    /// f'(x), with y = f(x).
    fn slope(&mut self, function: Unary, x: Id, y: Id) -> Id {
        use Binary::{Add, Divide, Less, Multiply, Subtract};
        let (zero, one) = (self.constant(0.0), self.constant(1.0));
        match function {
            Unary::Negate => self.constant(-1.0),
            Unary::Abs => {
                let (above, below) = (self.binary(Less, zero, x), self.binary(Less, x, zero));
                self.binary(Subtract, above, below)
            }
            Unary::Sqrt => {
                let half = self.constant(0.5);
                self.binary(Divide, half, y)
            }
            Unary::Exp => y,
            Unary::ExpLessOne => self.unary(Unary::Exp, x),
            Unary::Log => self.inverse_within(x),
            Unary::LogOfOnePlus => {
                let sum = self.tidy(Add, x, one);
                self.inverse_within(sum)
            }
            // −⅓ x^(−4/3)
            Unary::InverseCbrt => {
                let third = self.constant(-1.0 / 3.0);
                let square = self.binary(Multiply, y, y);
                let power = self.binary(Multiply, square, square);
                self.tidy(Multiply, third, power)
            }
            Unary::Sine => self.unary(Unary::Cosine, x),
            Unary::Cosine => {
                let sine = self.unary(Unary::Sine, x);
                self.unary(Unary::Negate, sine)
            }
        }
    }

    /// 1/x for x > 0, as the slope of what has no number elsewhere.
    fn inverse_within(&mut self, x: Id) -> Id {
        let (one, none) = (self.constant(1.0), self.constant(f64::NAN));
        let inverse = self.binary(Binary::Divide, one, x);
        self.select(x, inverse, none)
    }

    fn of_two(
        &mut self,
        function: Binary,
        (a, da): (Id, Option<Id>),
        (b, db): (Id, Option<Id>),
        quotient: Id,
    ) -> Option<Id> {
        use Binary::{Add, Divide, Less, Max, Min, Multiply, Subtract};
        match function {
            Add => self.total(da, db),
            Subtract => {
                let db = db.map(|db| self.tidy_negative(db));
                self.total(da, db)
            }
            Multiply => {
                let left = da.map(|da| self.tidy(Multiply, da, b));
                let right = db.map(|db| self.tidy(Multiply, a, db));
                self.total(left, right)
            }
            Divide => {
                // (da − (a/b) db)/b
                let taken = db.map(|db| {
                    let product = self.tidy(Multiply, quotient, db);
                    self.tidy_negative(product)
                });
                self.total(da, taken).map(|rest| self.tidy(Divide, rest, b))
            }
            Min | Max => {
                let less = if function == Min { self.binary(Less, a, b) } else { self.binary(Less, b, a) };
                self.chosen(less, (a, da), (b, db))
            }
            Less => None,
        }
    }

    fn tidy_negative(&mut self, x: Id) -> Id {
        let minus = self.constant(-1.0);
        self.tidy(Binary::Multiply, minus, x)
    }

    fn total(&mut self, a: Option<Id>, b: Option<Id>) -> Option<Id> {
        match (a, b) {
            (Some(a), Some(b)) => Some(self.tidy(Binary::Add, a, b)),
            (a, b) => a.or(b),
        }
    }

    /// What is no number stays none, so that what lies outside of a formula's domain is found out.
    fn chosen(&mut self, test: Id, (a, da): (Id, Option<Id>), (b, db): (Id, Option<Id>)) -> Option<Id> {
        if da.is_none() && db.is_none() {
            return None;
        }
        let none = |graph: &Graph, id: Id| graph.constant_of(id).is_some_and(f64::is_nan);
        let da = da.or_else(|| none(self, a).then_some(a));
        let db = db.or_else(|| none(self, b).then_some(b));
        let zero = self.constant(0.0);
        Some(self.select(test, da.unwrap_or(zero), db.unwrap_or(zero)))
    }
}
