//! What of a solution is compared: final values, courses over time, amplitudes and periods.

use super::oscillation::oscillation;
use super::solver::{Channel, Solution};
use std::collections::BTreeMap;

/// Below this share of its largest value over time a final value is measured against that largest value instead of
/// itself.
const FADED: f64 = 0.01;

/// A quantity of a solution.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// Its values: one, or one a time.
    pub values: Vec<f64>,
    /// Its unit.
    pub unit: String,
    /// What errors are divided by (in `unit`).
    pub scale: f64,
}

/// All quantities of a solution but the displacement field, by name:
///
/// | name | what |
/// |---|---|
/// | `tip.uz` | its value at the end |
/// | `tip.uz.over_time` | its course |
/// | `tip.uz.amplitude`, `tip.uz.period` | where it swings |
///
/// A component is measured against the length of the vector it belongs to: an error of 1e-9 m of a sideways motion that
/// should be none is no error of 100 %.
pub fn readings(solution: &Solution) -> BTreeMap<String, Reading> {
    let mut readings = BTreeMap::new();
    for channel in &solution.channels {
        let group: Vec<&Channel> = solution.channels.iter().filter(|other| other.group == channel.group).collect();
        let length = |at: usize| group.iter().map(|c| c.values.get(at).map_or(0.0, |v| v * v)).sum::<f64>().sqrt();
        let largest = (0..channel.values.len()).map(length).fold(0.0, f64::max);
        let Some(&end) = channel.values.last() else { continue };
        let last = length(channel.values.len() - 1);
        let scale = if last > FADED * largest { last } else { largest };
        let mut add = |kind: &str, values: Vec<f64>, unit: &str, scale: f64| {
            readings.insert(format!("{}{kind}", channel.name), Reading { values, unit: unit.into(), scale });
        };
        add("", vec![end], &channel.unit, scale);
        if channel.values.len() < 2 {
            continue;
        }
        add(".over_time", channel.values.clone(), &channel.unit, largest);
        if let Some(swing) = oscillation(&channel.times, &channel.values)
            && swing.amplitude > 0.01 * largest
        {
            add(".amplitude", vec![swing.amplitude], &channel.unit, swing.amplitude);
            add(".period", vec![swing.period], "s", swing.period);
        }
    }
    readings
}

/// Root of the mean square: the norm in which values are compared.
pub fn mean_square(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len().max(1) as f64).sqrt()
}

/// Distance of two lists of values in that norm; infinite where they have no common length.
pub fn distance(a: &[f64], b: &[f64]) -> f64 {
    if a.len() != b.len() {
        return f64::INFINITY;
    }
    mean_square(&a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<_>>())
}
