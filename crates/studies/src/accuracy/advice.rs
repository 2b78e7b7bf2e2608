//! What to do about it, in sentences.

use super::findings::Split;
use super::plan::Varied;
use super::reference::{Error, ReferenceSource};
use super::study::Row;

/// A part of the error counts beside another when it is more than this share of it.
const COUNTS: f64 = 0.33;

/// Sentences, the most important first.
pub fn advice(rows: &[Row], split: &Split, source: ReferenceSource, judged_by: &str, target: f64) -> Vec<String> {
    let mut sentences = Vec::new();
    if source == ReferenceSource::None {
        sentences
            .push("Without a reference nothing can be said about errors; the times are measured all the same.".into());
        return sentences;
    }
    let with_errors: Vec<(&Row, Error, f64)> = rows
        .iter()
        .filter(|row| row.varied.is_ranked())
        .filter_map(|row| Some((row, *row.errors.get(judged_by)?, row.measured()?.seconds_per_second)))
        .collect();
    if with_errors.is_empty() {
        sentences.push(format!("No configuration has an error in {judged_by}: nothing ran to its end."));
        return sentences;
    }
    sentences.push(cheapest(&with_errors, target));
    sentences.extend(spending(split));
    sentences.extend(better(&with_errors));
    sentences.extend(implicit_steps(&with_errors, target));
    let clear = with_errors.iter().filter(|(_, error, _)| error.is_clear()).count();
    if clear * 2 < with_errors.len() {
        sentences.push(format!(
            "The reference is too coarse: {clear} of {} configurations err clearly more than it may itself. Their \
             order says nothing; give the study a larger --budget.",
            with_errors.len()
        ));
    }
    sentences
}

/// Of rows those that are surely under a target, the cheapest.
fn cheapest_under<'a>(rows: &[(&'a Row, Error, f64)], target: f64) -> Option<(&'a Row, Error, f64)> {
    let under = rows.iter().filter(|(_, error, _)| error.error + error.uncertainty <= target);
    under.min_by(|a, b| a.2.total_cmp(&b.2)).copied()
}

/// Whether implicit steps are worth their price on the mesh of the scene, where some ran.
fn implicit_steps(rows: &[(&Row, Error, f64)], target: f64) -> Option<String> {
    let (implicit, others): (Vec<_>, Vec<_>) =
        rows.iter().copied().partition(|(row, ..)| row.configuration.method.is_implicit());
    let nearest = implicit.iter().min_by(|a, b| a.1.vouched().total_cmp(&b.1.vouched()))?;
    let mesh = |row: &Row| (row.configuration.element, row.configuration.mesh);
    let others: Vec<_> = others.into_iter().filter(|(row, ..)| mesh(row) == mesh(nearest.0)).collect();
    let other = cheapest_under(&others, target)?;
    let said = match cheapest_under(&implicit, target) {
        Some((row, _, time)) if time < other.2 => {
            format!(
                "Implicit steps pay: {} takes {} of the time of {}.",
                row.label,
                percent(time / other.2),
                other.0.label
            )
        }
        Some((row, _, time)) => format!(
            "Implicit steps do not pay: {}, the cheapest of them under {}, takes {} of the time of {}.",
            row.label,
            percent(target),
            percent(time / other.2),
            other.0.label
        ),
        None => {
            let (row, error, time) = nearest;
            format!(
                "Implicit steps do not pay: the nearest, {}, errs {} at {}.",
                row.label,
                told(error),
                price(row, *time)
            )
        }
    };
    Some(said)
}

fn cheapest(rows: &[(&Row, Error, f64)], target: f64) -> String {
    let found = cheapest_under(rows, target);
    let target = percent(target);
    match found {
        Some((row, error, time)) => {
            format!("Cheapest under {target}: {}, {} at {}.", row.label, told(&error), price(row, time))
        }
        None => {
            let nearest = rows.iter().min_by(|a, b| a.1.vouched().total_cmp(&b.1.vouched()));
            nearest.map_or(String::new(), |(row, error, time)| {
                let (error, price) = (told(error), price(row, *time));
                format!("Nothing that ran is surely under {target}; the nearest is {}, {error} at {price}.", row.label)
            })
        }
    }
}

/// Wall time, and that it is for a simulated second where something is simulated in time.
fn price(row: &Row, time: f64) -> String {
    let timed = row.measured().is_some_and(|measured| measured.simulated.is_some());
    format!("{}{}", seconds(time), if timed { " a second" } else { "" })
}

/// Where to spend: on the part of the error that is largest. Parts that are not known are not spoken of.
fn spending(split: &Split) -> Option<String> {
    let (space, time, round_off) = (split.space?, split.time.unwrap_or(0.0), split.round_off.unwrap_or(0.0));
    let model = split.model.unwrap_or(0.0);
    let total = split.total?;
    if split.space_is_a_bound && space > time.max(round_off) {
        return None;
    }
    if split.stays || model > space.max(time).max(round_off) {
        let model = if split.model.is_some() { model } else { total };
        return Some(format!(
            "An error of {} does not fall with the mesh: it is in the model or in the reference, and neither a finer mesh nor \
             a smaller step takes it away.",
            percent(model)
        ));
    }
    let known = [("the mesh", split.space), ("the step", split.time), ("the number type", split.round_off)];
    let parts: Vec<(&str, f64)> = known.into_iter().filter_map(|(what, part)| Some((what, part?))).collect();
    let (place, &(what, largest)) = parts.iter().enumerate().max_by(|a, b| a.1.1.total_cmp(&b.1.1))?;
    if largest <= 0.0 {
        return None;
    }
    let others: Vec<&(&str, f64)> =
        parts.iter().enumerate().filter(|(i, _)| *i != place).map(|(_, part)| part).collect();
    let also: Vec<&str> = others.iter().filter(|(_, part)| *part > COUNTS * largest).map(|(what, _)| *what).collect();
    let not: Vec<&str> = others.iter().filter(|(_, part)| *part <= COUNTS * largest).map(|(what, _)| *what).collect();
    let advice = match (also.is_empty(), not.is_empty()) {
        (true, true) => format!("Spend on {what}"),
        (true, false) => format!("Spend on {what}, not on {}", not.join(" or ")),
        (false, true) => format!("Spend on {what}, and on {} too", also.join(" and ")),
        (false, false) => format!("Spend on {what} and on {}, not on {}", also.join(" and "), not.join(" or ")),
    };
    let shares: Vec<String> = parts.iter().map(|(what, part)| format!("{what} makes {}", percent(*part))).collect();
    Some(format!("{advice}: as written, {}.", shares.join(", ")))
}

/// Whether something is both cheaper and no worse than the scene as it is written.
fn better(rows: &[(&Row, Error, f64)]) -> Option<String> {
    let (_, written, time) = rows.iter().find(|(row, ..)| row.varied == Varied::Nothing)?;
    let better = rows.iter().filter(|(row, error, t)| {
        let surely = error.is_clear() || error.at_most() <= written.error - written.uncertainty;
        row.on_front && *t < 0.7 * time && error.error <= written.error && surely
    });
    let (row, error, t) = better.min_by(|a, b| a.2.total_cmp(&b.2))?;
    let (error, written) = (told(error), told(written));
    let compared =
        if error == written { format!("the same ({error})") } else { format!("less ({error} instead of {written})") };
    let share = percent(t / time);
    Some(format!("The scene as written costs more than it must: {} errs {compared} in {share} of its time.", row.label))
}

/// An error in words; what the reference cannot tell from none is said to be below a bound.
pub fn told(error: &Error) -> String {
    if error.is_clear() { percent(error.error) } else { format!("below {}", percent(error.at_most())) }
}

/// A share in percent with two digits: `0.34 %`, `12 %`, `2.3e-5 %`.
pub fn percent(share: f64) -> String {
    let value = 100.0 * share;
    match value.abs() {
        0.0 => "0 %".into(),
        size if size >= 9.95 => format!("{value:.0} %"),
        size if size >= 0.995 => format!("{value:.1} %"),
        size if size >= 0.0995 => format!("{value:.2} %"),
        size if size >= 0.00995 => format!("{value:.3} %"),
        _ => format!("{value:.1e} %"),
    }
}

/// Seconds with a prefix and two to three digits.
pub fn seconds(value: f64) -> String {
    let (factor, unit) = match value.abs() {
        size if size >= 1.0 => (1.0, "s"),
        size if size >= 1e-3 => (1e3, "ms"),
        size if size >= 1e-6 => (1e6, "µs"),
        _ => (1e9, "ns"),
    };
    let value = value * factor;
    if value >= 99.5 { format!("{value:.0} {unit}") } else { format!("{value:.2} {unit}") }
}

/// `1.00 ms` as `1 ms`.
pub fn plain(text: &str) -> String {
    match text.split_once(' ') {
        Some((number, unit)) if number.contains('.') => {
            format!("{} {unit}", number.trim_end_matches('0').trim_end_matches('.'))
        }
        _ => text.to_string(),
    }
}
