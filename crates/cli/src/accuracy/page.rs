//! What came out of a study, for people.

use super::super::terminal::Paint;
use super::super::wording::{digits, quantity};
use sinew_studies::accuracy::advice::percent;
use sinew_studies::accuracy::{Study, TargetVerdict, tables};
use std::path::Path;

/// Longer reasons are cut here: the table stays a table, and the files have them whole.
const LONGEST: usize = 60;

/// A page on a study.
pub fn text(study: &Study, title: &str, folder: &Path, paint: Paint) -> String {
    let mut text = format!("{}\n", paint.bold(&format!("What accuracy costs: {title}")));
    text += &table(study, paint);
    text.push('\n');
    for (number, estimate) in study.estimates.iter().enumerate() {
        let heading = if number == 0 { "answer" } else { "" };
        let value =
            estimate.value.as_ref().map_or(String::new(), |(value, unit)| format!(" {}", quantity(*value, unit)));
        let line = format!("{}{value} as written: {}", estimate.quantity, estimate.sentence());
        text += &format!("{heading:10} {}\n", if number == 0 { paint.bold(&line) } else { line });
    }
    for sentence in &study.unseen {
        text += &format!("{:10} {sentence}\n", if study.estimates.is_empty() { "answer" } else { "" });
    }
    if let Some(more) = &study.more {
        text += &format!("{:10} {more}\n", "more");
    }
    text += &format!("reference  {}\n", study.reference);
    if let Some(uncertainty) = study.reference_uncertainty.filter(|uncertainty| *uncertainty > 0.0) {
        text += &format!("           off by {} at most, by its own account\n", percent(uncertainty));
    }
    let parts: Vec<String> = tables::split(study).iter().map(|(name, size)| format!("{name} {size}")).collect();
    text += &format!("error      as written: {}\n", parts.join(", "));
    let orders = &study.findings.orders;
    if !orders.is_empty() {
        let few = |rows: usize| if rows < 3 { " (of two meshes only)" } else { "" };
        let orders: Vec<String> =
            orders.iter().map(|order| format!("{} {:.2}{}", order.of, order.order, few(order.rows))).collect();
        text += &format!("order      {}\n", orders.join(", "));
    }
    for (number, effect) in study.findings.effects.iter().enumerate() {
        let heading = if number == 0 { "effects" } else { "" };
        let costs = percent(effect.costs);
        text += &format!(
            "{heading:10} {}: {costs} of the time; without it {} off\n",
            effect.effect,
            percent(effect.changes)
        );
    }
    for (number, sentence) in study.findings.advice.iter().enumerate() {
        let heading = if number == 0 { "advice" } else { "" };
        text += &format!("{heading:10} {sentence}\n");
    }
    let target = percent(study.target);
    text += &format!(
        "{:10} {}\n",
        "target",
        match study.findings.verdict {
            TargetVerdict::Met => format!("the scene as written meets {target}"),
            TargetVerdict::NotMet => format!("the scene as written does not meet {target}"),
            TargetVerdict::CannotTell => format!("whether the scene as written meets {target} cannot be told"),
        }
    );
    for note in &study.notes {
        text += &format!("{:10} {note}\n", "note");
    }
    let (took, budget) = (quantity(study.took, "s"), quantity(study.budget, "s"));
    let ended = if study.interrupted { ", interrupted: what was done is kept" } else { "" };
    text += &format!("{:10} {took} of {budget}, {} predicted{ended}\n", "took", quantity(study.predicted, "s"));
    text += &format!("{:10} {}: accuracy.md, .csv, .json, .svg, .png\n", "outputs", folder.display());
    text
}

fn table(study: &Study, paint: Paint) -> String {
    let headings = tables::headings(study);
    let rows = tables::cells(study);
    let numbers = |place: usize| rows.iter().map(move |row| row.numbers[place].chars().count());
    let width = |place: usize| numbers(place).max().unwrap_or(0).max(headings[place + 1].chars().count());
    let label = rows.iter().map(|row| row.label.chars().count()).max().unwrap_or(0).max(headings[0].len());
    let mut text = format!("  {:label$}", headings[0]);
    for place in 0..4 {
        text += &format!("  {:>1$}", headings[place + 1], width(place));
    }
    text = format!("{}\n", paint.bold(&format!("{text}  {}", headings[5])));
    for row in &rows {
        text += &format!("{} {:label$}", if row.on_front { "●" } else { " " }, row.label);
        for place in 0..4 {
            text += &format!("  {:>1$}", row.numbers[place], width(place));
        }
        let error: String = match row.error.chars().count() {
            long if long > LONGEST => row.error.chars().take(LONGEST - 1).chain(['…']).collect(),
            _ => row.error.clone(),
        };
        text += &format!("  {error}\n");
    }
    let least = study.rows.iter().filter(|row| row.on_front).count();
    text + &format!("● {} worth their price: nothing is both cheaper and more accurate\n", digits(least as f64))
}
