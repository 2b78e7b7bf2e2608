//! From the statements of a WGSL function to a graph. What a branch or a loop does is done for every element and chosen
//! from afterwards, so that no control flow is left.

use super::flow::State;
use super::graph::{Graph, Unary};
use super::value::{Pointer, Test, Value, Variable};
use super::{KNOWN_BY_NAME, NOT_ALLOWED, Untranslatable};
use naga::{Arena, Block, Expression, Function, Handle, Module, Span, Statement, SwitchValue};

pub(super) type Result<T> = std::result::Result<T, Untranslatable>;

/// Statements, and numbers that expressions and branches handle, unrolled and with all calls, after which a function is
/// given up: some tenths of a second.
const MOST_WORK: usize = 2_000_000;
/// Values of a function, unrolled and with all calls, after which it is given up: each is an instruction of every
/// element and step.
pub(super) const MOST_VALUES: usize = 50_000;
/// Calls and blocks within each other.
const MOST_DEPTH: usize = 200;

/// Translates functions of one module into one graph.
pub(super) struct Translator<'m> {
    pub(super) module: &'m Module,
    pub(super) graph: Graph,
    /// Values of the module's variables; none for those that may not be used.
    pub(super) globals: Vec<Option<Value>>,
    /// Values of the module's own expressions, once they are known.
    constants: Vec<Option<Value>>,
    work: usize,
    depth: usize,
}

/// What a function is in the middle of.
pub(super) struct Frame<'m> {
    pub(super) expressions: &'m Arena<Expression>,
    pub(super) arguments: Vec<Value>,
    values: Vec<Option<Value>>,
    pub(super) state: State,
}

impl<'m> Translator<'m> {
    pub(super) fn new(module: &'m Module, globals: Vec<Option<Value>>) -> Self {
        let constants = vec![None; module.global_expressions.len()];
        Self { module, graph: Graph::default(), globals, constants, work: 0, depth: 0 }
    }

    /// What a function returns for these arguments.
    pub(super) fn call(&mut self, function: &'m Function, arguments: Vec<Value>, at: Span) -> Result<Value> {
        if let Some(known) = self.known_by_name(function, &arguments) {
            return Ok(known);
        }
        if arguments.iter().any(|argument| matches!(argument, Value::Pointer(_))) {
            return Err(Untranslatable::new(at, "a pointer cannot be handed to a function")
                .note("let the function return its result, as a struct when there are several"));
        }
        self.spend(function.expressions.len() / 8, at)?;
        let mut frame = self.frame(&function.expressions, arguments);
        for (_, variable) in function.local_variables.iter() {
            let value = match variable.init {
                Some(init) => self.value(&mut frame, init)?,
                None => self.zero(variable.ty, at)?,
            };
            self.spend(value.numbers(), at)?;
            frame.state.locals.push(value);
        }
        frame.state.loose = vec![false; frame.state.locals.len()];
        self.block(&mut frame, &function.body)?;
        frame.state.result.ok_or_else(|| Untranslatable::new(at, "this function returns nothing"))
    }

    /// The result of a function of ours that looks at the bits of a number: that has no twin in double precision.
    fn known_by_name(&mut self, function: &Function, arguments: &[Value]) -> Option<Value> {
        let &[Value::Float(x)] = arguments else { return None };
        let name = function.name.as_deref().filter(|name| KNOWN_BY_NAME.contains(name))?;
        let function = match name {
            "inverse_cbrt" => Unary::InverseCbrt,
            "exponential" => Unary::Exp,
            "exponential_less_one" => Unary::ExpLessOne,
            "logarithm_of_one_plus" => Unary::LogOfOnePlus,
            _ => return None,
        };
        Some(Value::Float(self.graph.unary(function, x)))
    }

    /// The value of an expression of the module itself.
    pub(super) fn global(&mut self, handle: Handle<Expression>) -> Result<Value> {
        if let Some(known) = &self.constants[handle.index()] {
            return Ok(known.clone());
        }
        let expressions = &self.module.global_expressions;
        let mut frame = Frame { expressions, arguments: Vec::new(), values: Vec::new(), state: State::default() };
        let value = self.value(&mut frame, handle)?;
        self.constants[handle.index()] = Some(value.clone());
        Ok(value)
    }

    fn frame(&self, expressions: &'m Arena<Expression>, arguments: Vec<Value>) -> Frame<'m> {
        Frame { expressions, arguments, values: vec![None; expressions.len()], state: State::default() }
    }

    /// The value of an expression: as it was found when its turn came, or now for what has no turn.
    pub(super) fn value(&mut self, frame: &mut Frame<'m>, handle: Handle<Expression>) -> Result<Value> {
        let value = match frame.values.get(handle.index()) {
            Some(Some(value)) => value.clone(),
            _ => self.expression(frame, handle)?,
        };
        self.spend(value.numbers(), frame.expressions.get_span(handle))?;
        Ok(value)
    }

    /// Counts work that is proportional to so many numbers.
    pub(super) fn spend(&mut self, numbers: usize, at: Span) -> Result<()> {
        self.work += 1 + numbers;
        if self.work > MOST_WORK || self.graph.nodes().len() > MOST_VALUES {
            return Err(Untranslatable::new(at, "this is too long once its loops are unrolled")
                .note("fewer rounds, or a formula without a loop"));
        }
        Ok(())
    }

    pub(super) fn block(&mut self, frame: &mut Frame<'m>, block: &'m Block) -> Result<()> {
        self.depth += 1;
        for (statement, span) in block.span_iter() {
            if frame.state.running == Test::Known(false) {
                break;
            }
            if self.depth > MOST_DEPTH {
                let message = format!("more than {MOST_DEPTH} calls and blocks within each other");
                return Err(Untranslatable::new(*span, message).note("functions that call functions count with theirs"));
            }
            self.spend(0, *span)?;
            self.statement(frame, statement, *span)?;
        }
        self.depth -= 1;
        Ok(())
    }

    fn statement(&mut self, frame: &mut Frame<'m>, statement: &'m Statement, at: Span) -> Result<()> {
        match statement {
            Statement::Emit(range) => {
                for handle in range.clone() {
                    let value = self.expression(frame, handle)?;
                    self.spend(value.numbers(), at)?;
                    frame.values[handle.index()] = Some(value);
                }
            }
            Statement::Block(block) => self.block(frame, block)?,
            Statement::If { condition, accept, reject } => {
                let condition = self.test(frame, *condition)?;
                self.branch(frame, condition, accept, reject, at)?;
            }
            Statement::Switch { selector, cases } => {
                self.spend(cases.len(), at)?;
                let chosen = match self.value(frame, *selector)? {
                    Value::Signed(number) => SwitchValue::I32(number),
                    Value::Unsigned(number) => SwitchValue::U32(number),
                    _ => return Err(Untranslatable::new(at, "`switch` must choose by a number that is known here")),
                };
                let case = cases.iter().position(|case| case.value == chosen);
                let case = case.or_else(|| cases.iter().position(|case| case.value == SwitchValue::Default));
                let broken = std::mem::replace(&mut frame.state.broken, Test::Known(false));
                for case in cases.iter().skip(case.unwrap_or(cases.len())) {
                    self.block(frame, &case.body)?;
                    if !case.fall_through {
                        break;
                    }
                }
                self.revive(frame, |state| &mut state.broken);
                frame.state.broken = broken;
            }
            Statement::Loop { body, continuing, break_if } => self.rounds(frame, body, continuing, *break_if, at)?,
            Statement::Break => self.stop(&mut frame.state, |state| &mut state.broken),
            Statement::Continue => self.stop(&mut frame.state, |state| &mut state.continued),
            Statement::Return { value } => {
                if let Some(value) = value {
                    let value = self.value(frame, *value)?;
                    let state = &mut frame.state;
                    state.result = Some(match state.result.take() {
                        Some(before) => self.graph.choose(state.running, value, before),
                        None => value,
                    });
                }
                frame.state.running = Test::Known(false);
                frame.state.returned = true;
            }
            Statement::Store { pointer, value } => {
                let value = self.value(frame, *value)?;
                match self.value(frame, *pointer)? {
                    Value::Pointer(place) => self.store(frame, &place, value, at)?,
                    _ => return Err(Untranslatable::new(at, "this cannot be assigned to")),
                }
            }
            Statement::Call { function, arguments, result } => {
                let arguments: Result<Vec<Value>> =
                    arguments.iter().map(|argument| self.value(frame, *argument)).collect();
                let value = self.call(&self.module.functions[*function], arguments?, at)?;
                if let Some(result) = result {
                    frame.values[result.index()] = Some(value);
                }
            }
            _ => return Err(Untranslatable::new(at, NOT_ALLOWED)),
        }
        Ok(())
    }

    pub(super) fn test(&mut self, frame: &mut Frame<'m>, handle: Handle<Expression>) -> Result<Test> {
        match self.value(frame, handle)? {
            Value::Bool(test) => Ok(test),
            _ => Err(Untranslatable::new(frame.expressions.get_span(handle), VARYING)),
        }
    }

    fn store(&mut self, frame: &mut Frame<'m>, place: &Pointer, value: Value, at: Span) -> Result<()> {
        let Variable::Local(number) = place.variable else {
            return Err(Untranslatable::new(at, "only variables of the function itself can be assigned to"));
        };
        let running = frame.state.running;
        let Some(target) = frame.state.locals[number].at_mut(&place.path) else {
            return Err(Untranslatable::new(at, VARYING));
        };
        let before = std::mem::replace(target, Value::Varying);
        let chosen = self.graph.choose(running, value.clone(), before);
        *target = chosen.with_whole_numbers_of(Some(&value));
        frame.state.loose[number] |= running != Test::Known(true);
        Ok(())
    }
}

/// What is said of whole numbers and indices that are not known when a function is translated.
pub(super) const VARYING: &str = "a whole number here differs from element to element or node to node";
