//! Branches and loops without control flow: every element does everything, and what it should not have done is not
//! chosen.

use super::Untranslatable;
use super::translate::{Frame, Result, Translator};
use super::value::{Test, Value};
use naga::{Block, Expression, Handle, Span};

/// Rounds after which a loop that is still going is given up.
const MOST_ROUNDS: usize = 1000;

/// What the branches of an `if` may leave differently.
#[derive(Clone, Debug)]
pub(super) struct State {
    pub(super) locals: Vec<Value>,
    /// Variables whose whole numbers hold only for the elements that still run.
    pub(super) loose: Vec<bool>,
    /// Elements that have neither returned, nor left or cut short the loop.
    pub(super) running: Test,
    pub(super) broken: Test,
    pub(super) continued: Test,
    /// Whether some have returned already.
    pub(super) returned: bool,
    pub(super) result: Option<Value>,
}

impl Default for State {
    /// All run.
    fn default() -> Self {
        let no = Test::Known(false);
        Self {
            locals: Vec::new(),
            loose: Vec::new(),
            running: Test::Known(true),
            broken: no,
            continued: no,
            returned: false,
            result: None,
        }
    }
}

impl State {
    /// Numbers of all variables.
    fn numbers(&self) -> usize {
        self.locals.iter().map(Value::numbers).sum()
    }
}

impl<'m> Translator<'m> {
    /// Both branches, and what they leave chosen from.
    pub(super) fn branch(
        &mut self,
        frame: &mut Frame<'m>,
        condition: Test,
        accept: &'m Block,
        reject: &'m Block,
        at: Span,
    ) -> Result<()> {
        if let Test::Known(known) = condition {
            return self.block(frame, if known { accept } else { reject });
        }
        // kept, chosen from and chosen
        self.spend(3 * frame.state.numbers(), at)?;
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

    pub(super) fn rounds(
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
            self.spend(frame.state.locals.len() / 8, at)?;
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
                self.spend(3 * frame.state.numbers(), at)?;
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
    pub(super) fn stop(&mut self, state: &mut State, noted: impl Fn(&mut State) -> &mut Test) {
        let running = std::mem::replace(&mut state.running, Test::Known(false));
        let before = *noted(state);
        *noted(state) = self.graph.or(before, running);
    }

    /// Those that were noted run again; whole numbers that went on without them are theirs no longer.
    pub(super) fn revive(&mut self, frame: &mut Frame<'m>, noted: impl Fn(&mut State) -> &mut Test) {
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
}
