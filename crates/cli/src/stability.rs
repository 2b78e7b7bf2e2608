//! The stable step in words: what sets it, what is taken of it, and how it went.

use super::terminal;
use super::wording::{counted, digits, quantity};
use sinew::Summary;
use std::fmt::Write;

/// What is known of it at the start, and the elements that set it, a line each.
pub fn at_start(summary: &Summary) -> String {
    let stability = &summary.stability;
    let mut text = format!("stable step: {}\n", bounds(summary));
    if let Some(taken) = taken_from(summary) {
        let _ = writeln!(text, "  {taken}");
    }
    let _ = writeln!(
        text,
        "elements that set it: the usual element is stable up to {} (half of the volume needs no smaller step)",
        quantity(stability.bound.usual, "s")
    );
    let worst = &stability.bound.worst;
    // of a regular mesh one is as good as the other
    let alike = worst.iter().all(|other| other.bound <= (1.0 + ALIKE) * worst[0].bound);
    let shown = if alike && worst.len() > 1 && !terminal::is_verbose() { 1 } else { worst.len() };
    for worst in &worst[..shown] {
        let _ = writeln!(
            text,
            "  element {} of {}: {}, costs {} times the steps; without it and those above {} times the step",
            worst.element,
            worst.body,
            quantity(worst.bound, "s"),
            digits(worst.cost),
            digits(worst.gain)
        );
    }
    if shown < worst.len() {
        let _ = writeln!(text, "  and at least {} more like it (-v lists them)", worst.len() - 1);
    }
    text
}

/// Elements whose bounds differ by less than this share are alike.
const ALIKE: f64 = 0.01;

/// The true limit counts as known from this share of what is beyond it for certain.
const WELL_KNOWN: f64 = 0.95;

/// Bounds, true limit and what is taken of it.
fn bounds(summary: &Summary) -> String {
    let (body, element) = &summary.stable_step_element;
    let stability = &summary.stability;
    let mut text = format!("{}, set by element {element} of {body}", quantity(stability.bound.time_step, "s"));
    if let (Some(limit), Some(share)) = (stability.limit, summary.share_of_limit) {
        if let Some(by_nodes) = stability.by_nodes.filter(|by_nodes| *by_nodes > 1.001 * stability.bound.time_step) {
            let _ = write!(text, "; by nodes {}", quantity(by_nodes, "s"));
        }
        // what few products leave open is said
        let beyond = stability.beyond.filter(|beyond| limit < WELL_KNOWN * beyond);
        let (sought, at_most) = match beyond {
            _ if stability.products == 0 => ("not sought, at least ".to_string(), "at most "),
            Some(beyond) => (format!("below {}, at least ", quantity(beyond, "s")), "at most "),
            None => (String::new(), ""),
        };
        let (limit, share) = (quantity(limit, "s"), digits(share));
        let _ = write!(text, "; true limit: {sought}{limit}; the step is {at_most}{share} of it");
    }
    text
}

/// What the step is taken from, and why.
fn taken_from(summary: &Summary) -> Option<String> {
    let stability = &summary.stability;
    stability.limit?;
    Some(format!("taken from {}: {}", stability.in_words(), stability.because))
}

/// The step of a run, and how it went.
pub fn of_run(summary: &Summary) -> Vec<String> {
    let first = quantity(summary.stability.step, "s");
    let sure = if summary.stability.limit.is_some() { "certainly stable" } else { "stable" };
    let mut lines = vec![format!("{first}; {sure} up to {}", bounds(summary))];
    lines.extend(taken_from(summary));
    let Some(history) = &summary.step_history else { return lines };
    if history.changes > 0 {
        lines.push(format!(
            "changed {}: smallest {}, largest {}",
            counted(history.changes, "time"),
            quantity(history.smallest, "s"),
            quantity(history.largest, "s")
        ));
    }
    if let Some(time) = history.beyond_since {
        lines.push(format!("beyond the stable step since t = {}: do not trust what follows", quantity(time, "s")));
    }
    if history.added_mass > 0.0 {
        let added = quantity(history.added_mass * 1e3, "g");
        lines.push(format!("{added} of mass added for it, {} % of all", digits(100.0 * history.added_share)));
    }
    if history.removed > 0 {
        lines.push(format!("{} removed for it", counted(history.removed, "element")));
    }
    lines
}
