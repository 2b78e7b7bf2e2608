//! How made-up scenes are solved where steps are implicit: schemes, steps, preconditioners, budgets, and Newton's
//! iterations for rest. Of a row of their own, so that the scenes are those that explicit steps have.

use crate::dice::{Temper, number, one_of, size};
use fastrand::Rng;

/// How a scene is solved.
pub struct Solvers {
    rng: Rng,
    /// How many stable steps an implicit one is.
    pub longer: f64,
}

impl Solvers {
    pub fn of(seed: u64) -> Self {
        let mut rng = Rng::with_seed(seed ^ 0x501_7e45);
        let longer = size(&mut rng, 0.5, 300.0);
        Self { rng, longer }
    }

    /// The scene solved so, its implicit steps of a length (s).
    pub fn put_into(mut self, text: &str, step: f64, temper: Temper) -> String {
        if text.contains("analysis: Static(") {
            return text.replacen("analysis: Static(", "analysis: Static(method: Newton, ", 1);
        }
        let text = match self.rng.bool() {
            true => text.replacen("start: Equilibrium(", "start: Equilibrium(method: Newton, ", 1),
            false => text.to_string(),
        };
        // what is there of it is about the stable step
        let (head, tail) = text.split_once("integration: (").unwrap_or((&text, "), "));
        let rest = end_of(tail);
        format!("{head}solver: {}, {}", self.solver(step, temper), rest.trim_start_matches(", "))
    }

    fn solver(&mut self, step: f64, temper: Temper) -> String {
        let r = &mut self.rng;
        let mut all = vec![format!("step: {step:?}")];
        match r.u8(..3) {
            0 => all.push("scheme: GeneralizedAlpha()".into()),
            1 => all.push(format!("scheme: GeneralizedAlpha(high_frequencies: {:?})", number(r, 0.0, 1.0))),
            _ => {}
        }
        if r.bool() {
            all.push(format!("newton: {}", one_of(r, &["1", "2", "5", "30"])));
        }
        if r.bool() {
            // from what rounding hardly lets through to what hardly asks for anything
            let least = if temper == Temper::Mild { 1e-9 } else { 1e-16 };
            all.push(format!("tolerance: {:?}", size(r, least, 0.9)));
        }
        if r.u8(..3) > 0 {
            let word = one_of(r, &["TwoLevel", "BlockJacobi", "Mass", "Identity"]);
            all.push(format!("preconditioner: {word}"));
        }
        if r.u8(..3) == 0 {
            all.push(format!("budget: {}", r.u64(3..60)));
        }
        if r.u8(..4) == 0 {
            all.push(format!(
                "adaptive: (tolerance: {:?}, smallest: {:?})",
                size(r, 1e-5, 0.9),
                step * size(r, 1e-3, 0.9)
            ));
        }
        format!("Implicit({})", all.join(", "))
    }
}

/// What follows the parenthesis that closes one opened before.
fn end_of(text: &str) -> &str {
    let mut open = 1;
    for (place, letter) in text.char_indices() {
        match letter {
            '(' => open += 1,
            ')' => open -= 1,
            _ => {}
        }
        if open == 0 {
            return &text[place + 1..];
        }
    }
    ""
}
