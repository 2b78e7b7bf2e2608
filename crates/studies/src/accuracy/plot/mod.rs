//! The work-precision plot: error against wall time per simulated second, both logarithmic.

mod legend;

use super::advice::{percent, plain, seconds};
use super::plan::Varied;
use super::reference::CLEARLY;
use super::study::{Row, Study};
use legend::{colour, legend};
use sinew_pictures::plot::axis::Axis;
use sinew_pictures::plot::{Anchor, Area, Drawing, LETTERS, place, width};

/// Width and height (pixels).
pub const SIZE: (f64, f64) = (1120.0, 700.0);
/// Where the axes are: left, top, right, bottom (pixels).
const FRAME: Area = [92.0, 84.0, 880.0, 620.0];
const INK: &str = "#2c323a";
const FAINT: &str = "#8a929c";
const FRONT: &str = "#e8b53c";
const OTHER: &str = "#6b7480";
const LAW: &str = "#8a63a8";

/// A row with a place in the plot.
struct Point<'a> {
    row: &'a Row,
    time: f64,
    error: f64,
    clear: bool,
}

/// Draws a study; `title` stands above.
pub fn drawing(study: &Study, title: &str) -> Drawing {
    let points = points(study);
    let timed = study.rows.iter().filter_map(Row::measured).all(|measured| measured.simulated.is_some());
    let times = points.iter().map(|point| point.time);
    // real time is shown where it is not far away
    let (least, most) = times.clone().fold((f64::INFINITY, 0.0f64), |(a, b), time| (a.min(time), b.max(time)));
    let real = (timed && least < 10.0 && most > 0.1).then_some(1.0);
    let x = Axis::new(times.chain(real), FRAME[0], FRAME[2]);
    let y = Axis::new(points.iter().map(|point| point.error).chain([study.target]), FRAME[3], FRAME[1]);
    let mut page = Drawing::new(SIZE);
    grid(&mut page, &x, &y);
    zone(&mut page, study, &y);
    lines(&mut page, study, &points, &x, &y, real);
    let words = target_words(study, &points, &x, &y).map(|(_, area)| area);
    marks(&mut page, &points, &x, &y, words);
    let unit = if timed { "wall time per simulated second" } else { "wall time" };
    page.text((0.5 * (FRAME[0] + FRAME[2]), FRAME[3] + 46.0), unit, 15.0, INK, Anchor::Middle);
    page.turned((16.0, 0.5 * (FRAME[1] + FRAME[3])), &format!("relative error of {}", study.judged_by), 15.0, INK);
    page.text((FRAME[0], 36.0), &format!("What accuracy costs: {title}"), 21.0, INK, Anchor::Start);
    let advice = study.findings.advice.first().map_or("", String::as_str);
    page.text((FRAME[0], 62.0), &shortened(advice, 118), 14.0, FAINT, Anchor::Start);
    legend(&mut page, &points, real.is_some());
    page
}

fn points(study: &Study) -> Vec<Point<'_>> {
    let rows = study.rows.iter().filter(|row| row.varied != Varied::Effect);
    rows.filter_map(|row| {
        let (measured, error) = (row.measured()?, row.errors.get(&study.judged_by)?);
        let (time, size) = (measured.seconds_per_second, error.vouched());
        let drawn = time > 0.0 && size > 0.0 && time.is_finite() && size.is_finite();
        drawn.then_some(Point { row, time, error: size, clear: error.is_clear() })
    })
    .collect()
}

fn grid(page: &mut Drawing, x: &Axis, y: &Axis) {
    for (value, named) in x.ticks() {
        let at = x.at(value);
        page.line((at, FRAME[1]), (at, FRAME[3]), if named { "#dfe3e8" } else { "#f1f3f5" }, 1.0, &[]);
        if named {
            page.text((at, FRAME[3] + 21.0), &plain(&seconds(value)), 13.0, INK, Anchor::Middle);
        }
    }
    for (value, named) in y.ticks() {
        let at = y.at(value);
        page.line((FRAME[0], at), (FRAME[2], at), if named { "#dfe3e8" } else { "#f1f3f5" }, 1.0, &[]);
        if named {
            page.text((FRAME[0] - 9.0, at + 4.5), &tick(value), 13.0, INK, Anchor::End);
        }
    }
    page.frame(FRAME, "#aab2bc");
}

fn tick(value: f64) -> String {
    let share = 100.0 * value;
    if share >= 9.99e-5 { format!("{} %", (share * 1e6).round() / 1e6) } else { percent(value) }
}

/// Below this the reference cannot tell.
fn zone(page: &mut Drawing, study: &Study, y: &Axis) {
    let Some(bound) = study.reference_uncertainty.map(|uncertainty| CLEARLY * uncertainty) else { return };
    if bound > y.least() {
        let top = y.at(bound).max(FRAME[1]);
        page.area([FRAME[0], top, FRAME[2], FRAME[3]], "#eef1f4");
        if FRAME[3] - top > 18.0 {
            page.text((FRAME[2] - 8.0, FRAME[3] - 8.0), "the reference cannot tell", 12.5, FAINT, Anchor::End);
        }
    }
}

fn lines(page: &mut Drawing, study: &Study, points: &[Point<'_>], x: &Axis, y: &Axis, real: Option<f64>) {
    if let Some(real) = real {
        page.line((x.at(real), FRAME[1]), (x.at(real), FRAME[3]), "#b0453a", 1.6, &[7.0, 4.0]);
        page.text((x.at(real) + 5.0, FRAME[1] + 15.0), "real time", 12.5, "#b0453a", Anchor::Start);
    }
    if let Some((text, area)) = target_words(study, points, x, y) {
        let at = y.at(study.target);
        page.line((FRAME[0], at), (FRAME[2], at), "#5b8c5a", 1.4, &[2.0, 4.0]);
        page.text((area[0], at - 5.0), &text, 12.5, "#5b8c5a", Anchor::Start);
    }
    let mut best: Vec<(f64, f64)> =
        points.iter().filter(|point| point.row.on_front).map(|point| (x.at(point.time), y.at(point.error))).collect();
    best.sort_by(|a, b| a.0.total_cmp(&b.0));
    // a staircase: what lies between two configurations nobody has measured
    let mut stairs: Vec<(f64, f64)> = Vec::new();
    for (place, &(across, down)) in best.iter().enumerate() {
        stairs.push((across, place.checked_sub(1).map_or(FRAME[1], |before| best[before].1)));
        stairs.push((across, down));
    }
    stairs.extend(best.last().map(|last| (FRAME[2], last.1)));
    page.path(&stairs, FRONT, 5.0, 0.55);
    for element in legend::elements(points) {
        let mut ladder: Vec<&Point<'_>> = points.iter().filter(|point| on_ladder(point, &element)).collect();
        ladder.sort_by_key(|point| point.row.configuration.mesh);
        let path: Vec<(f64, f64)> = ladder.iter().map(|point| (x.at(point.time), y.at(point.error))).collect();
        page.path(&path, colour(&element), 1.6, 0.9);
    }
}

/// The words on the target and where they stand: at the left end of its line, or at the right one where a point is in
/// the way. `None` where the target is outside the plot.
fn target_words(study: &Study, points: &[Point<'_>], x: &Axis, y: &Axis) -> Option<(String, Area)> {
    let text = format!("target {}", percent(study.target));
    let (wide, base) = (width(&text), y.at(study.target) - 5.0);
    let area = |left: f64| [left, base - LETTERS, left + wide, base + 3.0];
    let free = |area: &Area| {
        points.iter().map(|point| (x.at(point.time), y.at(point.error))).all(|(across, down)| {
            across < area[0] - 12.0 || across > area[2] + 12.0 || down < area[1] - 12.0 || down > area[3] + 12.0
        })
    };
    let places = [area(FRAME[0] + 6.0), area(FRAME[2] - 6.0 - wide)];
    let chosen = places.into_iter().find(free).unwrap_or(places[0]);
    y.contains(study.target).then_some((text, chosen))
}

fn on_ladder(point: &Point<'_>, element: &str) -> bool {
    is_mesh(point.row) && point.row.configuration.element_name() == element
}

fn is_mesh(row: &Row) -> bool {
    matches!(row.varied, Varied::Mesh | Varied::Nothing)
}

/// Points and their names; `words`: where something is written already.
fn marks(page: &mut Drawing, points: &[Point<'_>], x: &Axis, y: &Axis, words: Option<Area>) {
    let at = |point: &Point<'_>| (x.at(point.time), y.at(point.error));
    for point in points.iter().filter(|point| !is_mesh(point.row)) {
        let colour = if point.row.varied.is_ranked() { OTHER } else { LAW };
        page.diamond(at(point), 5.0, colour, point.clear);
    }
    for point in points.iter().filter(|point| is_mesh(point.row)) {
        let written = point.row.varied == Varied::Nothing;
        page.circle(
            at(point),
            if written { 8.0 } else { 5.5 },
            colour(&point.row.configuration.element_name()),
            point.clear,
        );
        if written {
            page.ring(at(point), 11.5, INK);
        }
    }
    // the scene itself first, then meshes, then the rest
    let mut order: Vec<&Point<'_>> = points.iter().collect();
    order.sort_by_key(|point| (point.row.varied != Varied::Nothing, !is_mesh(point.row)));
    let names: Vec<String> = order.iter().map(|point| name(point.row)).collect();
    let wanted: Vec<((f64, f64), &str)> = order.iter().zip(&names).map(|(p, name)| (at(p), name.as_str())).collect();
    let taken = points.iter().map(|point| {
        let (x, y) = at(point);
        [x - 7.0, y - 7.0, x + 7.0, y + 7.0]
    });
    let spots =
        place(&wanted, taken.chain(words).collect(), [FRAME[0] + 2.0, FRAME[1] + 20.0, FRAME[2] - 2.0, FRAME[3] - 2.0]);
    for ((point, name), spot) in order.iter().zip(&names).zip(spots) {
        let Some(spot) = spot else { continue };
        let ink = match point.row.varied {
            _ if is_mesh(point.row) => colour(&point.row.configuration.element_name()),
            varied if varied.is_ranked() => "#4a525c",
            _ => LAW,
        };
        if spot.far {
            let middle = spot.x + 0.5 * width(name);
            let end = (at(point).0.clamp(spot.x, middle + 0.5 * width(name)), spot.y - 4.0);
            page.line(at(point), end, "#b4bbc4", 0.8, &[]);
        }
        page.label((spot.x, spot.y), name, LETTERS, ink);
    }
}

/// What a point is called: on a ladder its mesh alone, the colour says the element.
fn name(row: &Row) -> String {
    match row.varied {
        Varied::Nothing => "as written".into(),
        Varied::Mesh => row.configuration.mesh.to_string(),
        _ => row.label.clone(),
    }
}

fn shortened(text: &str, most: usize) -> String {
    if text.chars().count() <= most { text.into() } else { text.chars().take(most - 1).chain(['…']).collect() }
}
