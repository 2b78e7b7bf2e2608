//! A graph as a straight line of instructions over numbered slots, which a machine without branches can walk for a
//! whole register of elements at a time.

use super::Untranslatable;
use super::graph::{Binary, Graph, Id, Node, Unary};
use super::polynomial::Polynomial;
use crate::math::{Real, Task};

/// Slots that a program may use: constants, inputs and what lives at the same time.
pub const SLOTS: usize = 256;

/// What an instruction does. Products that go into sums are one instruction with them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Code {
    Unary(Unary),
    Binary(Binary),
    /// a b + c
    MultiplyAdd,
    /// a b − c
    MultiplySubtract,
    /// c − a b
    NegativeMultiplyAdd,
    /// b where a > 0, else c
    Select,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Instruction {
    code: Code,
    to: u8,
    a: u8,
    b: u8,
    c: u8,
}

/// A function of numbers without control flow: runs over any [`Real`].
#[derive(Clone, Debug)]
pub struct Program {
    inputs: usize,
    constants: Vec<f64>,
    instructions: Vec<Instruction>,
    outputs: Vec<u8>,
    slots: usize,
    /// The outputs, where all of them are polynomials: these are what is computed then.
    polynomials: Option<Vec<Polynomial>>,
}

impl Program {
    /// Lays a graph out for the outputs that are wanted; what they do not need is left out.
    pub(super) fn new(graph: &Graph, inputs: usize, outputs: &[Id]) -> Result<Self, Untranslatable> {
        let fused = fused(graph, outputs);
        let mut last = vec![None; graph.nodes().len()];
        for output in outputs {
            last[output.index()] = Some(usize::MAX);
        }
        for index in (0..graph.nodes().len()).rev() {
            if last[index].is_some() {
                for operand in operands(&fused, index) {
                    last[operand.index()] = last[operand.index()].max(Some(index));
                }
            }
        }
        let mut places = vec![None; graph.nodes().len()];
        let mut constants = Vec::new();
        for (index, node) in graph.nodes().iter().enumerate().filter(|(index, _)| last[*index].is_some()) {
            match node {
                Node::Input(number) => places[index] = Some(usize::from(*number)),
                Node::Constant(bits) => {
                    places[index] = Some(inputs + constants.len());
                    constants.push(f64::from_bits(*bits));
                }
                _ => {}
            }
        }
        let mut free = FreeSlots { used: inputs + constants.len(), free: Vec::new() };
        let mut instructions = Vec::new();
        for (index, step) in fused.iter().enumerate() {
            let (Some((code, arguments)), Some(_)) = (step, last[index]) else { continue };
            let at = |k: usize| arguments.get(k).and_then(|id| places[id.index()]).unwrap_or(0) as u8;
            let (a, b, c) = (at(0), at(1), at(2));
            for (k, operand) in arguments.iter().enumerate() {
                let is_last_use = last[operand.index()] == Some(index) && !arguments[..k].contains(operand);
                let lasting = matches!(graph.node(*operand), Node::Constant(_));
                if let Some(place) = places[operand.index()].filter(|_| is_last_use && !lasting) {
                    free.free.push(place);
                }
            }
            let to = free.take();
            places[index] = Some(to);
            instructions.push(Instruction { code: *code, to: to as u8, a, b, c });
        }
        if free.used > SLOTS {
            let message = format!("this needs {} numbers at the same time; {SLOTS} are there", free.used);
            return Err(Untranslatable::new(naga::Span::UNDEFINED, message)
                .note("use results soon after they are computed, and fewer different constants"));
        }
        let outputs = outputs.iter().map(|id| places[id.index()].unwrap_or(0) as u8).collect();
        Ok(Self { inputs, constants, instructions, outputs, slots: free.used, polynomials: None })
    }

    /// The same for inputs from `least` on, by Horner's rule where that keeps all digits; roundings differ.
    pub(super) fn of_energy(graph: &Graph, inputs: usize, outputs: &[Id], least: f64) -> Result<Self, Untranslatable> {
        Ok(Self { polynomials: graph.polynomials(outputs, least), ..Self::new(graph, inputs, outputs)? })
    }

    /// The result for some inputs: the numbers of all arguments in order, and as many as the function returns.
    #[inline(always)]
    pub fn run<R: Real, const INPUTS: usize, const OUTPUTS: usize>(&self, inputs: [R; INPUTS]) -> [R; OUTPUTS] {
        debug_assert!(INPUTS == self.inputs && OUTPUTS == self.outputs.len(), "not this program's numbers");
        let like = inputs[0];
        let mut outputs = [like; OUTPUTS];
        match &self.polynomials {
            Some(polynomials) => {
                for (output, polynomial) in outputs.iter_mut().zip(polynomials) {
                    *output = polynomial.at(&inputs, like);
                }
            }
            None => self.walk(&inputs, &mut outputs),
        }
        outputs
    }

    /// Goes through all instructions.
    #[inline(always)]
    fn walk<R: Real>(&self, inputs: &[R], outputs: &mut [R]) {
        let Some(&like) = inputs.first() else { return };
        let program = self;
        // all slots are written once before the first instruction: no more than needed
        match self.slots {
            0..=16 => like.outlined(Walk::<R, 16> { program, inputs, outputs, like }),
            17..=64 => like.outlined(Walk::<R, 64> { program, inputs, outputs, like }),
            _ => like.outlined(Walk::<R, SLOTS> { program, inputs, outputs, like }),
        }
    }

    /// Whether it is the same, bit by bit.
    pub(crate) fn is(&self, other: &Self) -> bool {
        let bits = |program: &Self| program.constants.iter().map(|c| c.to_bits()).collect::<Vec<_>>();
        self.inputs == other.inputs
            && self.instructions == other.instructions
            && self.outputs == other.outputs
            && bits(self) == bits(other)
    }

    /// Whether an output depends on an input.
    pub fn reads(&self, input: usize) -> bool {
        let holds = |slot: u8| usize::from(slot) == input;
        for i in &self.instructions {
            let operands = match i.code {
                Code::Unary(_) => &[i.a][..],
                Code::Binary(_) => &[i.a, i.b],
                _ => &[i.a, i.b, i.c],
            };
            if operands.iter().any(|&slot| holds(slot)) {
                return true;
            }
            if holds(i.to) {
                return false;
            }
        }
        self.outputs.iter().any(|&slot| holds(slot))
    }

    /// Instructions, constants, and slots in use at the same time; of polynomials products, factors and no slots.
    pub fn size(&self) -> (usize, usize, usize) {
        match &self.polynomials {
            Some(all) => {
                let products = all.iter().map(Polynomial::degree).sum();
                (products, products + all.len(), 0)
            }
            None => (self.instructions.len(), self.constants.len(), self.slots),
        }
    }
}

/// A run of a program. `COUNT` is a power of two that is at least the number of slots, so that no index needs to be
/// checked.
struct Walk<'a, R, const COUNT: usize> {
    program: &'a Program,
    inputs: &'a [R],
    outputs: &'a mut [R],
    /// Any number of the kind.
    like: R,
}

impl<R: Real, const COUNT: usize> Task<R> for Walk<'_, R, COUNT> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let at = |place: u8| usize::from(place) & (COUNT - 1);
        let Self { program, inputs, outputs, like } = self;
        let mut slots = [like; COUNT];
        for (slot, input) in slots.iter_mut().zip(inputs) {
            *slot = *input;
        }
        for (slot, constant) in slots.iter_mut().skip(inputs.len()).zip(&program.constants) {
            *slot = like.constant(*constant);
        }
        for i in &program.instructions {
            let (a, b, c) = (slots[at(i.a)], slots[at(i.b)], slots[at(i.c)]);
            slots[at(i.to)] = match i.code {
                Code::Unary(function) => function.of(a),
                Code::Binary(function) => function.of(a, b),
                Code::MultiplyAdd => a.mul_add(b, c),
                Code::MultiplySubtract => a.mul_add(b, -c),
                Code::NegativeMultiplyAdd => (-a).mul_add(b, c),
                Code::Select => a.if_positive(b, c),
            };
        }
        for (output, place) in outputs.iter_mut().zip(&program.outputs) {
            *output = slots[at(*place)];
        }
    }
}

struct FreeSlots {
    used: usize,
    free: Vec<usize>,
}

impl FreeSlots {
    fn take(&mut self) -> usize {
        self.free.pop().unwrap_or_else(|| {
            self.used += 1;
            self.used - 1
        })
    }
}

type TapeStep = Option<(Code, Vec<Id>)>;

/// The instruction of each value, none for inputs and constants. A product that only a sum uses goes into it.
fn fused(graph: &Graph, outputs: &[Id]) -> Vec<TapeStep> {
    let mut uses = vec![0_usize; graph.nodes().len()];
    for output in outputs {
        uses[output.index()] += 1;
    }
    for index in (0..graph.nodes().len()).rev() {
        if uses[index] > 0 {
            match graph.nodes()[index] {
                Node::Unary(_, a) => uses[a.index()] += 1,
                Node::Binary(_, a, b) => [a, b].iter().for_each(|id| uses[id.index()] += 1),
                Node::Select(a, b, c) => [a, b, c].iter().for_each(|id| uses[id.index()] += 1),
                Node::Input(_) | Node::Constant(_) => {}
            }
        }
    }
    let product = |id: Id| match graph.node(id) {
        Node::Binary(Binary::Multiply, a, b) if uses[id.index()] == 1 => Some((a, b)),
        _ => None,
    };
    let step = |node: &Node| match *node {
        Node::Input(_) | Node::Constant(_) => None,
        Node::Binary(Binary::Add, x, y) => Some(match (product(x), product(y)) {
            (_, Some((a, b))) => (Code::MultiplyAdd, vec![a, b, x]),
            (Some((a, b)), None) => (Code::MultiplyAdd, vec![a, b, y]),
            _ => (Code::Binary(Binary::Add), vec![x, y]),
        }),
        Node::Binary(Binary::Subtract, x, y) => Some(match (product(x), product(y)) {
            (Some((a, b)), _) => (Code::MultiplySubtract, vec![a, b, y]),
            (None, Some((a, b))) => (Code::NegativeMultiplyAdd, vec![a, b, x]),
            _ => (Code::Binary(Binary::Subtract), vec![x, y]),
        }),
        Node::Unary(function, a) => Some((Code::Unary(function), vec![a])),
        Node::Binary(function, a, b) => Some((Code::Binary(function), vec![a, b])),
        Node::Select(a, b, c) => Some((Code::Select, vec![a, b, c])),
    };
    graph.nodes().iter().map(step).collect()
}

fn operands(steps: &[TapeStep], index: usize) -> impl Iterator<Item = Id> + '_ {
    steps[index].iter().flat_map(|(_, arguments)| arguments.iter().copied())
}
