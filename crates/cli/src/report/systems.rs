//! What systems took.

use super::Page;
use crate::wording::{bytes, counted, quantity};
use sinew::Summary;

/// What is no system, but a part of the run.
const FOLLOWED: &str = "between steps: the stable step";

pub(super) fn systems(summary: &Summary, page: &mut Page) {
    let followed = summary.step_history.as_ref().filter(|history| history.checks > 0).map(|history| {
        let estimates = counted(history.eigenvalue_estimates, "time");
        let because =
            format!("{} of elements; the highest frequency was found {estimates}", counted(history.checks, "check"));
        (FOLLOWED, Some(history.seconds), because)
    });
    let systems = summary.systems.iter().map(|system| (&*system.name, system.seconds, system.because.clone()));
    let all: Vec<_> = systems.chain(followed).collect();
    let width = all.iter().map(|(name, ..)| name.len()).max().unwrap_or(0);
    let lines = all.iter().map(|(name, seconds, because)| {
        let time = match seconds {
            Some(seconds) => {
                let share = 100.0 * seconds / summary.solving_seconds.max(f64::MIN_POSITIVE);
                format!("{:>8}  {share:3.0} %", quantity(*seconds, "s"))
            }
            None => "on the device  ".into(),
        };
        format!("{name:width$}  {time}  {because}")
    });
    page.rows("systems", lines);
    if let Some(traffic) = &summary.traffic {
        let (down, up) = (bytes(traffic.down), bytes(traffic.up));
        let line = format!("{down} to the host, {up} to the device, {} waited", quantity(traffic.seconds, "s"));
        page.row("traffic", line);
    }
}
