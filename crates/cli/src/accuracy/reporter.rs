//! How far a study is: the plan before it starts, then what runs.

use super::super::terminal;
use super::super::wording::quantity;
use indicatif::ProgressBar;
use sinew_studies::accuracy::study::Outcome;
use sinew_studies::accuracy::{Fate, Plan, StudyObserver};
use std::time::Duration;

/// Tells on stderr.
#[derive(Default)]
pub struct Reporter {
    bar: Option<ProgressBar>,
    begun: String,
}

impl Reporter {
    fn spin(&mut self, what: String) {
        if terminal::is_interactive() {
            let bar = ProgressBar::new_spinner().with_message(what);
            bar.enable_steady_tick(Duration::from_millis(120));
            self.bar = Some(bar);
        }
    }

    fn still(&mut self) {
        if let Some(bar) = self.bar.take() {
            bar.finish_and_clear();
        }
    }
}

impl StudyObserver for Reporter {
    fn predicts(&mut self) {
        self.spin("predicting what each way to solve the scene takes".into());
    }

    fn planned(&mut self, plan: &Plan) {
        self.still();
        let budget = quantity(plan.budget, "s");
        let mut text = format!("plan: {} of at most {budget}\n", quantity(plan.predicted, "s"));
        for (place, planned) in plan.rows.iter().enumerate() {
            let (mark, what) = match &planned.fate {
                Fate::Run(cost) if plan.reference.contains(&place) => {
                    (" ", format!("{}, for the reference", quantity(cost.seconds, "s")))
                }
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
        self.spin(self.begun.clone());
    }

    fn ended(&mut self, _: &str, outcome: &Outcome) {
        self.still();
        let how = match outcome {
            Outcome::Done(measured) => format!("{} of steps", quantity(measured.seconds, "s")),
            Outcome::LeftOut(why) => why.clone(),
            Outcome::Refused(why) => format!("refused: {why}"),
            Outcome::Broke(why) => format!("broke down: {why}"),
        };
        terminal::aside(&format!("{}: {how}\n", self.begun));
    }
}
