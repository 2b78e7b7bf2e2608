//! Graphs made anew in simpler terms: with other inputs, constants drawn together, and differences that lose digits at
//! small strains in a form that keeps them. Unlike what [`Graph`] itself simplifies, this may change roundings and
//! takes 0·x for 0: it is for energies, which are differentiated anyway.

use super::graph::{Binary, Graph, Id, Node, Unary};

impl Graph {
    /// The values `outputs`, and all that they are made of, in a new graph; `input` says what stands for each input.
    pub(super) fn tidied(&self, outputs: &[Id], mut input: impl FnMut(&mut Graph, u16) -> Id) -> (Graph, Vec<Id>) {
        let wanted = self.wanted(outputs);
        let mut graph = Graph::default();
        let outputs = self.made_in(&mut graph, outputs, &wanted, &mut input);
        (graph, outputs)
    }

    /// Which values some are made of.
    pub(super) fn wanted(&self, outputs: &[Id]) -> Vec<bool> {
        let mut wanted = vec![false; self.nodes().len()];
        outputs.iter().for_each(|output| wanted[output.index()] = true);
        for index in (0..wanted.len()).rev() {
            if wanted[index] {
                mark(self.nodes()[index], &mut wanted);
            }
        }
        wanted
    }

    fn made_in(
        &self,
        graph: &mut Graph,
        outputs: &[Id],
        wanted: &[bool],
        input: &mut impl FnMut(&mut Graph, u16) -> Id,
    ) -> Vec<Id> {
        let zero = graph.constant(0.0);
        let mut new = vec![zero; self.nodes().len()];
        for (index, node) in self.nodes().iter().enumerate().filter(|(index, _)| wanted[*index]) {
            let at = |id: Id| new[id.index()];
            new[index] = match *node {
                Node::Input(number) => input(graph, number),
                Node::Constant(bits) => graph.constant(f64::from_bits(bits)),
                Node::Unary(function, x) => graph.tidy_unary(function, at(x)),
                Node::Binary(function, a, b) => graph.tidy(function, at(a), at(b)),
                Node::Select(test, a, b) => graph.select(at(test), at(a), at(b)),
            };
        }
        outputs.iter().map(|output| new[output.index()]).collect()
    }

    /// Which of the inputs a value is made of.
    pub(super) fn inputs_of(&self, id: Id) -> Vec<u16> {
        let wanted = self.wanted(&[id]);
        let used = self.nodes().iter().zip(wanted).filter(|(_, wanted)| *wanted);
        used.filter_map(|(node, _)| if let Node::Input(number) = node { Some(*number) } else { None }).collect()
    }

    fn tidy_unary(&mut self, function: Unary, x: Id) -> Id {
        match (function, self.node(x)) {
            // −(c y)
            (Unary::Negate, Node::Binary(Binary::Multiply, a, b)) => match self.constant_of(a) {
                Some(factor) => self.times(-factor, b),
                None => self.unary(function, x),
            },
            // ln(y + 1)
            (Unary::Log, Node::Binary(Binary::Add, y, c)) if self.constant_of(c) == Some(1.0) => {
                self.unary(Unary::LogOfOnePlus, y)
            }
            _ => self.unary(function, x),
        }
    }

    /// As [`binary`](Self::binary): sums have their constant last, products their constant first.
    pub(super) fn tidy(&mut self, function: Binary, a: Id, b: Id) -> Id {
        use Binary::{Add, Divide, Multiply, Subtract};
        match (function, self.constant_of(a), self.constant_of(b)) {
            (_, Some(_), Some(_)) => self.binary(function, a, b),
            (Add, Some(left), _) => self.plus(b, left),
            (Add, _, Some(right)) => self.plus(a, right),
            (Subtract, _, Some(right)) => self.plus(a, -right),
            (Subtract, Some(left), _) => {
                let (own, rest) = self.with_summand(b);
                let negative = self.times(-1.0, rest);
                self.plus(negative, left - own)
            }
            (Multiply, Some(left), _) => self.times(left, b),
            (Multiply, _, Some(right)) => self.times(right, a),
            (Divide, _, Some(right)) if (1.0 / right).is_normal() => self.times(1.0 / right, a),
            (Divide, Some(0.0), _) => a,
            (Add, ..) if a == b => self.times(2.0, a),
            (Subtract, ..) if a == b => self.constant(0.0),
            (Add | Subtract, ..) => self.sum(function, a, b),
            (Multiply, ..) => self.product(a, b),
            _ => self.binary(function, a, b),
        }
    }

    /// The constant and the rest of a sum, 0 and itself where there is none.
    fn with_summand(&self, x: Id) -> (f64, Id) {
        match self.node(x) {
            Node::Binary(Binary::Add, y, c) => self.constant_of(c).map_or((0.0, x), |constant| (constant, y)),
            _ => (0.0, x),
        }
    }

    /// The constant and the rest of a product, 1 and itself where there is none.
    fn with_factor(&self, x: Id) -> (f64, Id) {
        match self.node(x) {
            Node::Binary(Binary::Multiply, c, y) => self.constant_of(c).map_or((1.0, x), |constant| (constant, y)),
            Node::Unary(Unary::Negate, y) => (-1.0, y),
            _ => (1.0, x),
        }
    }

    /// x + c.
    fn plus(&mut self, x: Id, c: f64) -> Id {
        let (own, rest) = self.with_summand(x);
        let sum = own + c;
        if sum == 0.0 {
            return rest;
        }
        // e^y − 1, and 1 − e^y
        let (factor, exponential) = self.with_factor(rest);
        if let (Node::Unary(Unary::Exp, y), true) = (self.node(exponential), sum == -factor) {
            let less_one = self.unary(Unary::ExpLessOne, y);
            return self.times(factor, less_one);
        }
        let constant = self.constant(sum);
        self.make_in_order(Binary::Add, rest, constant)
    }

    /// c x.
    fn times(&mut self, c: f64, x: Id) -> Id {
        let (own, rest) = self.with_factor(x);
        match own * c {
            0.0 => self.constant(0.0),
            1.0 => rest,
            -1.0 => self.unary(Unary::Negate, rest),
            product => {
                let constant = self.constant(product);
                self.make_in_order(Binary::Multiply, constant, rest)
            }
        }
    }

    /// Neither is a constant.
    fn sum(&mut self, function: Binary, a: Id, b: Id) -> Id {
        let ((first, a), (second, b)) = (self.with_summand(a), self.with_summand(b));
        let sign = if function == Binary::Add { 1.0 } else { -1.0 };
        // x − (−y), and alike
        let (rest, function) = match (self.node(b), function) {
            (Node::Unary(Unary::Negate, y), Binary::Add) => (y, Binary::Subtract),
            (Node::Unary(Unary::Negate, y), _) => (y, Binary::Add),
            _ => (b, function),
        };
        let sum = match function {
            Binary::Subtract if a == rest => self.constant(0.0),
            Binary::Add if a == rest => self.times(2.0, a),
            _ => self.binary(function, a, rest),
        };
        let constant = first + sign * second;
        match self.constant_of(sum) {
            Some(known) => self.constant(known + constant),
            None => self.plus(sum, constant),
        }
    }

    /// Neither is a constant.
    fn product(&mut self, a: Id, b: Id) -> Id {
        let ((first, a), (second, b)) = (self.with_factor(a), self.with_factor(b));
        let product = self.binary(Binary::Multiply, a, b);
        self.times(first * second, product)
    }
}

fn mark(node: Node, wanted: &mut [bool]) {
    let mut mark = |id: Id| wanted[id.index()] = true;
    match node {
        Node::Input(_) | Node::Constant(_) => {}
        Node::Unary(_, x) => mark(x),
        Node::Binary(_, a, b) => [a, b].into_iter().for_each(mark),
        Node::Select(test, a, b) => [test, a, b].into_iter().for_each(mark),
    }
}
