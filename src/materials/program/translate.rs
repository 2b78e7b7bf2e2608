//! From the statements of a WGSL function to a graph. What a branch or a loop does is done for every element and chosen
//! from afterwards, so that no control flow is left.

use super::graph::{Graph, Unary};
use super::value::{Place, Test, Value, Variable};
use super::{KNOWN_BY_NAME, NOT_ALLOWED, Untranslatable};
use naga::{Arena, Block, Expression, Function, Handle, Module, Span, Statement, SwitchValue};

pub(super) type Result<T> = std::result::Result<T, Untranslatable>;

/// Rounds after which a loop that is still going is given up.
const MOST_ROUNDS: usize = 1000;
/// Statements and expressions, unrolled and with all calls, after which a function is given up.
const MOST_WORK: usize = 200_000;

/// Translates functions of one module into one graph.
pub(super) struct Translator<'m> {
    pub(super) module: &'m Module,
    pub(super) graph: Graph,
    /// Values of the module's variables; none for those that may not be used.
    pub(super) globals: Vec<Option<Value>>,
    work: usize,
}

/// What a function is in the middle of.
pub(super) struct Frame<'m> {
    pub(super) expressions: &'m Arena<Expression>,
    pub(super) arguments: Vec<Value>,
    values: Vec<Option<Value>>,
    pub(super) state: State,
}

/// What the branches of an `if` may leave differently.
#[derive(Clone, Debug)]
pub(super) struct State {
    pub(super) locals: Vec<Value>,
    /// Variables whose whole numbers hold only for the elements that still run.
    loose: Vec<bool>,
    /// Elements that have neither returned, nor left or cut short the loop.
    running: Test,
    broken: Test,
    continued: Test,
    /// Whether some have returned already.
    returned: bool,
    result: Option<Value>,
}

impl<'m> Translator<'m> {
    pub(super) fn new(module: &'m Module, globals: Vec<Option<Value>>) -> Self {
        Self { module, graph: Graph::default(), globals, work: 0 }
    }

    /// What a function returns for these arguments.
    pub(super) fn call(&mut self, function: &'m Function, arguments: Vec<Value>, at: Span) -> Result<Value> {
        if let Some(known) = self.known_by_name(function, &arguments) {
            return Ok(known);
        }
        if arguments.iter().any(|argument| matches!(argument, Value::Place(_))) {
            return Err(Untranslatable::new(at, "a pointer cannot be handed to a function").note(
                "let the function return its result, as a struct when there are several",
            ));
        }
        let mut frame = self.frame(&function.expressions, arguments);
        for (_, variable) in function.local_variables.iter() {
            let value = match variable.init {
                Some(init) => self.value(&mut frame, init)?,
                None => self.zero(variable.ty, at)?,
            };
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
        let mut frame = self.frame(&self.module.global_expressions, Vec::new());
        self.value(&mut frame, handle)
    }

    fn frame(&self, expressions: &'m Arena<Expression>, arguments: Vec<Value>) -> Frame<'m> {
        let no = Test::Known(false);
        let state = State {
            locals: Vec::new(),
            loose: Vec::new(),
            running: Test::Known(true),
            broken: no,
            continued: no,
            returned: false,
            result: None,
        };
        Frame { expressions, arguments, values: vec![None; expressions.len()], state }
    }

    /// The value of an expression: as it was found when its turn came, or now for what has no turn.
    pub(super) fn value(&mut self, frame: &mut Frame<'m>, handle: Handle<Expression>) -> Result<Value> {
        match &frame.values[handle.index()] {
            Some(value) => Ok(value.clone()),
            None => self.expression(frame, handle),
        }
    }

    pub(super) fn spend(&mut self, at: Span) -> Result<()> {
        self.work += 1;
        match self.work > MOST_WORK {
            true => Err(Untranslatable::new(at, "this is too long once its loops are unrolled")
                .note("fewer rounds, or a formula without a loop")),
            false => Ok(()),
        }
    }

    fn block(&mut self, frame: &mut Frame<'m>, block: &'m Block) -> Result<()> {
        for (statement, span) in block.span_iter() {
            if frame.state.running == Test::Known(false) {
                return Ok(());
            }
            self.spend(*span)?;
            self.statement(frame, statement, *span)?;
        }
        Ok(())
    }

    fn statement(&mut self, frame: &mut Frame<'m>, statement: &'m Statement, at: Span) -> Result<()> {
        match statement {
            Statement::Emit(range) => {
                for handle in range.clone() {
                    self.spend(at)?;
                    let value = self.expression(frame, handle)?;
                    frame.values[handle.index()] = Some(value);
                }
            }
            Statement::Block(block) => self.block(frame, block)?,
            Statement::If { condition, accept, reject } => {
                let condition = self.test(frame, *condition)?;
                self.branch(frame, condition, accept, reject)?;
            }
            Statement::Switch { selector, cases } => {
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
                    Value::Place(place) => self.store(frame, &place, value, at)?,
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

    /// Both branches, and what they leave chosen from.
    fn branch(&mut self, frame: &mut Frame<'m>, condition: Test, accept: &'m Block, reject: &'m Block) -> Result<()> {
        if let Test::Known(known) = condition {
            return self.block(frame, if known { accept } else { reject });
        }
        let before = frame.state.clone();
        self.block(frame, accept)?;
        let accepted = std::mem::replace(&mut frame.state, before);
        self.block(frame, reject)?;
        let merged = self.merge(condition, &accepted, &frame.state);
        frame.state = merged;
        Ok(())
    }

    fn merge(&mut self, condition: Test, accepted: &State, rejected: &State) -> State {
        let mut merged = rejected.clone();
        for (number, value) in accepted.locals.iter().enumerate() {
            let other = &rejected.locals[number];
            // where one branch leads away, the whole numbers of the other are those of all that go on
            let keep = match (accepted.running, rejected.running) {
                (Test::Known(false), _) => Some(other),
                (_, Test::Known(false)) => Some(value),
                _ => None,
            };
            merged.loose[number] |= accepted.loose[number] || (keep.is_some() && value != other);
            let chosen = self.graph.choose(condition, value.clone(), other.clone());
            merged.locals[number] = chosen.with_whole_numbers_of(keep);
        }
        let mut test = |a: Test, b: Test| match self.graph.choose(condition, Value::Bool(a), Value::Bool(b)) {
            Value::Bool(test) => test,
            _ => Test::Known(false),
        };
        merged.running = test(accepted.running, rejected.running);
        merged.broken = test(accepted.broken, rejected.broken);
        merged.continued = test(accepted.continued, rejected.continued);
        merged.returned |= accepted.returned;
        merged.result = match (accepted.result.clone(), rejected.result.clone()) {
            (Some(a), Some(b)) => Some(self.graph.choose(condition, a, b)),
            (a, b) => a.or(b),
        };
        merged
    }

    fn rounds(
        &mut self,
        frame: &mut Frame<'m>,
        body: &'m Block,
        continuing: &'m Block,
        break_if: Option<Handle<Expression>>,
        at: Span,
    ) -> Result<()> {
        let no = Test::Known(false);
        let State { running, broken, continued, returned, .. } = frame.state;
        (frame.state.broken, frame.state.continued, frame.state.returned) = (no, no, false);
        let mut round = 0;
        while frame.state.running != no {
            round += 1;
            if round > MOST_ROUNDS {
                let message = format!("this loop is still going after {MOST_ROUNDS} rounds");
                return Err(Untranslatable::new(at, message)
                    .note("count its rounds by a whole number up to a constant: for (var i = 0; i < 8; i++) { ... }"));
            }
            // those that cut this round short come back after it: only what this round did without them is not theirs
            let none = vec![false; frame.state.loose.len()];
            let before = std::mem::replace(&mut frame.state.loose, none);
            self.block(frame, body)?;
            self.revive(frame, |state| &mut state.continued);
            for (loose, before) in frame.state.loose.iter_mut().zip(before) {
                *loose |= before;
            }
            self.block(frame, continuing)?;
            if let Some(condition) = break_if.filter(|_| frame.state.running != no) {
                let condition = self.test(frame, condition)?;
                let mut leaving = frame.state.clone();
                self.stop(&mut leaving, |state| &mut state.broken);
                let merged = match condition {
                    Test::Known(true) => leaving,
                    Test::Known(false) => continue,
                    _ => self.merge(condition, &leaving, &frame.state),
                };
                frame.state = merged;
            }
        }
        self.revive(frame, |state| &mut state.broken);
        let state = &mut frame.state;
        if !state.returned {
            // all that came in go on, whichever way they came out
            state.running = running;
        }
        (state.broken, state.continued) = (broken, continued);
        state.returned |= returned;
        Ok(())
    }

    /// All that run stop, and are noted.
    fn stop(&mut self, state: &mut State, noted: impl Fn(&mut State) -> &mut Test) {
        let running = std::mem::replace(&mut state.running, Test::Known(false));
        let before = *noted(state);
        *noted(state) = self.graph.or(before, running);
    }

    /// Those that were noted run again; whole numbers that went on without them are theirs no longer.
    fn revive(&mut self, frame: &mut Frame<'m>, noted: impl Fn(&mut State) -> &mut Test) {
        let state = &mut frame.state;
        let revived = std::mem::replace(noted(state), Test::Known(false));
        if revived == Test::Known(false) {
            return;
        }
        let alone = state.running == Test::Known(false) && revived == Test::Known(true);
        state.running = self.graph.or(state.running, revived);
        for (local, loose) in state.locals.iter_mut().zip(&mut state.loose) {
            if *loose && !alone {
                local.forget_whole_numbers();
            }
            *loose = false;
        }
    }

    fn store(&mut self, frame: &mut Frame<'m>, place: &Place, value: Value, at: Span) -> Result<()> {
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
pub(super) const VARYING: &str = "a whole number here differs from element to element";

impl Value {
    /// Whole numbers that came to vary, taken from another value instead.
    fn with_whole_numbers_of(self, other: Option<&Value>) -> Value {
        match (self, other) {
            (Value::Varying, Some(other)) => other.clone(),
            (Value::Parts(parts), Some(Value::Parts(others))) => {
                Value::Parts(parts.into_iter().zip(others).map(|(part, other)| part.with_whole_numbers_of(Some(other))).collect())
            }
            (value, _) => value,
        }
    }
}
