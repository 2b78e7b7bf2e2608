//! How far a study is: the plan before it starts, then what runs.

use super::super::terminal;
use super::super::wording::quantity;
use indicatif::ProgressBar;
use sinew::accuracy::study::Outcome;
use sinew::accuracy::{Fate, Plan, Watch};
use std::time::Duration;

/// Tells on stderr.
#[derive(Default)]
pub struct Teller {
    bar: Option<ProgressBar>,
    begun: String,
}

impl Watch for Teller {
    fn planned(&mut self, plan: &Plan) {
        let budget = quantity(plan.budget, "s");
        let mut text = format!("plan: {} of at most {budget}\n", quantity(plan.predicted, "s"));
        for planned in plan.reference.iter().chain(&plan.rows) {
            let (mark, what) = match &planned.fate {
                Fate::Run(cost) => (" ", quantity(cost.seconds, "s")),
                Fate::LeftOut(cost) => ("-", format!("left out: predicted {}", quantity(cost.seconds, "s"))),
                Fate::Refused(why) => ("!", format!("refused: {why}")),
            };
            text += &format!("  {mark} {:44} {what}\n", planned.label);
        }
        if let Some(why) = &plan.no_reference {
            text += &format!("  no reference: {why}\n");
        }
        terminal::aside(&text);
    }

    fn begins(&mut self, label: &str, seconds: f64, number: usize, all: usize) {
        self.begun = format!("{number} of {all}: {label}, about {}", quantity(seconds, "s"));
        if terminal::is_watched() {
            let bar = ProgressBar::new_spinner().with_message(self.begun.clone());
            bar.enable_steady_tick(Duration::from_millis(120));
            self.bar = Some(bar);
        }
    }

    fn ended(&mut self, _: &str, outcome: &Outcome) {
        if let Some(bar) = self.bar.take() {
            bar.finish_and_clear();
        }
        let how = match outcome {
            Outcome::Done(measured) => format!("{} of steps", quantity(measured.seconds, "s")),
            Outcome::LeftOut(why) => why.clone(),
            Outcome::Refused(why) => format!("refused: {why}"),
            Outcome::Broke(why) => format!("broke down: {why}"),
        };
        terminal::aside(&format!("{}: {how}\n", self.begun));
    }
}
