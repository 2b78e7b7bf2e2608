//! Numbers on the command line, with what is said of others.

use glam::Vec3;
use sinew::scene::limits::PICTURE;
use sinew_pictures::render::RenderError;

pub fn direction(text: &str) -> Result<Vec3, String> {
    let numbers: Vec<f32> = text.split(',').filter_map(|number| number.trim().parse().ok()).collect();
    match numbers[..] {
        [x, y, z] if text.split(',').count() == 3 => Ok(Vec3::new(x, y, z)),
        _ => Err("three numbers with commas between are wanted, such as 1,-2,0.8".into()),
    }
}

pub fn size(text: &str) -> Result<(u32, u32), String> {
    let halves = text.split_once(['x', 'X', '×']);
    let numbers = halves.and_then(|(wide, high)| Some((wide.trim().parse().ok()?, high.trim().parse().ok()?)));
    let size = numbers.ok_or("width and height with an x between are wanted, such as 960x720")?;
    match PICTURE[0].contains(&size.0) && PICTURE[1].contains(&size.1) {
        true => Ok(size),
        false => Err(RenderError::Size { size }.to_string()),
    }
}

pub fn above_zero(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number: &f64| number.is_finite() && *number > 0.0);
    number.ok_or_else(|| "a number above 0 is wanted, such as 60".into())
}

/// Seconds from `60`, `60s`, `1.5 min`, `500ms`, `2h`.
pub fn wall_time(text: &str) -> Result<f64, String> {
    const UNITS: [(&str, f64); 5] = [("ms", 1e-3), ("min", 60.0), ("s", 1.0), ("m", 60.0), ("h", 3600.0)];
    let text = text.trim();
    let found = UNITS.iter().find_map(|(unit, size)| Some((text.strip_suffix(unit)?, *size)));
    let (number, size) = found.unwrap_or((text, 1.0));
    let seconds = above_zero(number.trim_end()).map(|number| number * size).ok();
    let seconds = seconds.filter(|seconds| seconds.is_finite() && *seconds > 0.0);
    seconds.ok_or_else(|| {
        "a time above 0 is wanted, such as 60s, 10min or 2h; a number above 0 is wanted of seconds".into()
    })
}

/// A share from `1%` or `0.01`. A plain number from 1 on is asked back about: who types 5 means 5 %, not 500 %.
pub fn share(text: &str) -> Result<f64, String> {
    let (number, factor) = text.strip_suffix('%').map_or((text, 1.0), |number| (number, 0.01));
    let number = above_zero(number.trim()).map_err(|_| "an error above 0 is wanted, such as 1% or 0.01".to_string())?;
    if factor == 1.0 && number >= 1.0 {
        let (percent, plain) = (100.0 * number, number / 100.0);
        return Err(format!(
            "{number} would be {percent} %: for {number} % write {number}% or {plain}, else {percent}%"
        ));
    }
    Ok(number * factor)
}

pub fn time(text: &str) -> Result<f64, String> {
    let time = text.parse().ok().filter(|time: &f64| time.is_finite());
    time.ok_or_else(|| "a time in seconds is wanted, such as 0.25".into())
}
