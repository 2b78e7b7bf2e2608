//! Numbers as people read them.

use std::time::Duration;

/// A quantity with a prefix and three digits: `218 µs`, `1.92 ms`; `277 mm³`, whose prefix counts three times.
pub fn quantity(value: f64, unit: &str) -> String {
    const PREFIXES: [(f64, &str); 7] =
        [(1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n")];
    if value == 0.0 || !value.is_finite() {
        return format!("{value} {unit}");
    }
    let power = power(unit);
    let size = value.abs();
    // 0.4 mm³ is read more easily than 400 000 000 µm³
    let least = if power == 1 { 0.9995 } else { 0.9995e-3 };
    let mut fitting = PREFIXES.iter().map(|(factor, prefix)| (factor.powi(power), prefix));
    match fitting.find(|(factor, _)| size >= least * factor) {
        Some((factor, prefix)) if size < 1e12 => format!("{} {prefix}{unit}", digits(value / factor)),
        _ => format!("{value:.2e} {unit}"),
    }
}

/// The power of what a prefix goes before: 3 of `m³` and `m³/s`, 1 of `m/s²`.
fn power(unit: &str) -> i32 {
    let first = unit.trim_start_matches(char::is_alphabetic);
    [('²', 2), ('³', 3)].into_iter().find(|(sign, _)| first.starts_with(*sign)).map_or(1, |(_, power)| power)
}

/// Three digits: `218`, `1.92`, `0.51`; no zeros at the end.
pub fn digits(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let before = value.abs().log10().floor() as i32 + 1;
    if !(-3..=15).contains(&before) {
        return format!("{value:.2e}");
    }
    let text = format!("{value:.*}", (3 - before).max(0) as usize);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_string() } else { text }
}

/// A number of things, in groups of three digits: `12 345`.
pub fn count(number: u64) -> String {
    let plain = number.to_string();
    let mut text = String::new();
    for (place, digit) in plain.chars().enumerate() {
        if place > 0 && (plain.len() - place).is_multiple_of(3) && plain.len() > 4 {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}

/// So many of a thing: `1 node`, `12 345 nodes`.
pub fn counted(number: u64, word: &str) -> String {
    format!("{} {word}{}", count(number), if number == 1 { "" } else { "s" })
}

/// Bytes: `1.23 MB`.
pub fn bytes(number: u64) -> String {
    if number < 1000 { counted(number, "byte") } else { quantity(number as f64, "B") }
}

/// That a run ends at another time than it should (s), by more than a hundredth of it: steps are not cut.
pub fn other_end(end: f64, duration: f64) -> Option<String> {
    let (ends, wanted) = (quantity(end, "s"), quantity(duration, "s"));
    let is_other = (end - duration).abs() > 0.01 * duration;
    is_other.then(|| format!("at {ends}, not at the {wanted} of `duration`: whole steps make no such time"))
}

/// How long something takes, roughly: `12 s`, `3 min 20 s`, `2 h 5 min`.
pub fn duration(time: Duration) -> String {
    let seconds = time.as_secs();
    match seconds {
        0 => "less than 1 s".into(),
        1..60 => format!("{seconds} s"),
        60..3600 => format!("{} min {} s", seconds / 60, seconds % 60),
        _ => format!("{} h {} min", seconds / 3600, seconds / 60 % 60),
    }
}

/// Run time against simulated time.
pub fn speed(factor: f64) -> String {
    match factor {
        f if !f.is_finite() || f <= 0.0 => "speed unknown".into(),
        f if f < 0.995 => format!("{} times faster than real time", digits(1.0 / f)),
        f if f < 1.005 => "as fast as real time".into(),
        f => format!("{} times slower than real time", digits(f)),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
    use super::*;

    #[test]
    fn numbers_read_well() {
        assert_eq!(quantity(2.181e-4, "s"), "218 µs");
        assert_eq!(quantity(-0.00192, "m"), "-1.92 mm");
        assert_eq!(quantity(9.999e-4, "s"), "1 ms");
        assert_eq!((quantity(2.77e-7, "m³"), quantity(4e-10, "m³/s")), ("277 mm³".into(), "0.4 mm³/s".into()));
        assert_eq!((quantity(1.03e-4, "m²"), quantity(2e-3, "m²")), ("103 mm²".into(), "0.002 m²".into()));
        assert_eq!((quantity(9.81e-3, "m/s²"), quantity(1e-14, "m³")), ("9.81 mm/s²".into(), "10000 µm³".into()));
        assert_eq!(quantity(0.0, "J"), "0 J");
        assert_eq!(quantity(3e-14, "J"), "3.00e-14 J");
        assert_eq!(quantity(f64::NAN, "J"), "NaN J");
        assert_eq!((digits(0.5), digits(1234.5), digits(-98.76)), ("0.5".into(), "1234".into(), "-98.8".into()));
        assert_eq!((count(1331), count(29791), count(1_000_000)), ("1331".into(), "29 791".into(), "1 000 000".into()));
        assert_eq!(bytes(12), "12 bytes");
        assert_eq!(duration(Duration::from_secs(200)), "3 min 20 s");
    }

    #[test]
    fn speed_is_told_against_life() {
        assert_eq!(speed(0.25), "4 times faster than real time");
        assert_eq!(speed(1.0), "as fast as real time");
        assert_eq!(speed(12.5), "12.5 times slower than real time");
    }
}
