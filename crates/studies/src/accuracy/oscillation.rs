//! Amplitude and period of what swings.

/// Amplitude and period of an oscillation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Oscillation {
    /// Half of the mean distance between highest and lowest points.
    pub amplitude: f64,
    /// Mean time between two passages of the mean upwards (s).
    pub period: f64,
}

/// How far a signal must leave its mean before the next passage counts, as a share of its range.
const HYSTERESIS: f64 = 0.1;

/// The oscillation in a signal about its mean; `None` where it does not pass its mean upwards at least three times (two
/// whole periods). Passages are found by a straight line between samples, extremes by a parabola through three.
pub fn oscillation(times: &[f64], values: &[f64]) -> Option<Oscillation> {
    let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let leave = HYSTERESIS * (high - low);
    if leave.is_nan() || leave <= 1e-9 * high.abs().max(low.abs()) {
        return None;
    }
    let mut upwards = Vec::new();
    let mut turns: [Vec<f64>; 2] = [Vec::new(), Vec::new()];
    let (mut side, mut extreme) = (0usize, None::<usize>);
    for i in 0..values.len() {
        let offset = values[i] - mean;
        let now = if offset > leave {
            2
        } else if offset < -leave {
            1
        } else {
            0
        };
        if now != 0 && now != side {
            if let Some(at) = extreme.filter(|_| side != 0) {
                turns[side - 1].push(peak(values, at));
            }
            if (side, now) == (1, 2) {
                upwards.extend(passage(times, values, mean, i));
            }
            (side, extreme) = (now, Some(i));
        }
        if let Some(at) = extreme {
            let beyond = if side == 2 { values[i] > values[at] } else { values[i] < values[at] };
            extreme = Some(if beyond { i } else { at });
        }
    }
    // the first turn may be the start itself and the last the end
    let middle = |turns: &[f64]| (!turns.is_empty()).then(|| turns.iter().sum::<f64>() / turns.len() as f64);
    let (lowest, highest) = (middle(&turns[0])?, middle(&turns[1])?);
    let (first, last) = (upwards.first()?, upwards.last()?);
    let periods = upwards.len() - 1;
    (periods >= 2).then(|| Oscillation { amplitude: 0.5 * (highest - lowest), period: (last - first) / periods as f64 })
}

/// When the signal last passed its mean before the sample `i`.
fn passage(times: &[f64], values: &[f64], mean: f64, i: usize) -> Option<f64> {
    let before = (0..i).rev().find(|&j| values[j] <= mean)?;
    let (a, b) = (values[before] - mean, values[before + 1] - mean);
    Some(times[before] + (times[before + 1] - times[before]) * a / (a - b))
}

/// The extreme value near a sample.
fn peak(values: &[f64], at: usize) -> f64 {
    if at == 0 || at + 1 >= values.len() {
        return values[at];
    }
    let (a, b, c) = (values[at - 1], values[at], values[at + 1]);
    let bend = a - 2.0 * b + c;
    if bend == 0.0 { b } else { b - (a - c).powi(2) / (8.0 * bend) }
}
