//! What colours and marks mean.

use super::{FAINT, FRAME, FRONT, INK, LAW, OTHER, Point, is_mesh};
use sinew_pictures::plot::{Anchor, Drawing};

/// Colours that people with every kind of sight can tell apart (M. Okabe, K. Ito 2008), by element.
const COLOURS: [(&str, &str); 6] = [
    ("Tet4", "#d55e00"),
    ("Tet4NodalPressure", "#cc79a7"),
    ("Hex8", "#0072b2"),
    ("Hex8MeanDilatation", "#009e73"),
    ("Wedge6", "#e69f00"),
    ("Tet10", "#56b4e9"),
];

/// The colour of an element's ladder.
pub fn colour(element: &str) -> &'static str {
    COLOURS.iter().find(|(name, _)| *name == element).map_or("#56627a", |(_, colour)| colour)
}

/// The elements that have a ladder.
pub fn elements(points: &[Point<'_>]) -> Vec<String> {
    let of_meshes = points.iter().filter(|point| is_mesh(point.row));
    let mut names: Vec<String> = of_meshes.map(|point| point.row.configuration.element_name()).collect();
    let place = |name: &String| COLOURS.iter().position(|(known, _)| known == name).unwrap_or(COLOURS.len());
    names.sort_by_key(place);
    names.dedup();
    names
}

/// Draws it beside the axes.
pub fn legend(page: &mut Drawing, points: &[Point<'_>], real: bool) {
    let (x, mut y) = (FRAME[2] + 34.0, FRAME[1] + 14.0);
    let mut entry = |page: &mut Drawing, draw: &dyn Fn(&mut Drawing, (f64, f64)), text: &str| {
        draw(page, (x, y - 4.5));
        page.text((x + 22.0, y), text, 13.5, INK, Anchor::Start);
        y += 25.0;
    };
    for element in elements(points) {
        let draw = |page: &mut Drawing, at: (f64, f64)| {
            page.line((at.0 - 14.0, at.1), (at.0 + 14.0, at.1), colour(&element), 1.6, &[]);
            page.circle(at, 5.5, colour(&element), true);
        };
        entry(page, &draw, &element);
    }
    let other = |point: &Point<'_>| !is_mesh(point.row) && point.row.varied.is_ranked();
    if points.iter().any(other) {
        entry(page, &|page, at| page.diamond(at, 5.0, OTHER, true), "one thing changed");
    }
    if points.iter().any(|point| !point.row.varied.is_ranked()) {
        entry(page, &|page, at| page.diamond(at, 5.0, LAW, true), "another law: not ranked");
    }
    entry(page, &|page, at| page.ring(at, 9.0, INK), "the scene as written");
    let draw =
        |page: &mut Drawing, at: (f64, f64)| page.path(&[(at.0 - 14.0, at.1), (at.0 + 14.0, at.1)], FRONT, 5.0, 0.55);
    entry(page, &draw, "Pareto front");
    if points.iter().any(|point| !point.clear) {
        entry(page, &|page, at| page.circle(at, 5.5, FAINT, false), "a bound: the reference");
        page.text((x + 22.0, y - 8.0), "cannot tell", 13.5, INK, Anchor::Start);
        y += 17.0;
    }
    if real {
        let dashes =
            |page: &mut Drawing| page.line((x - 14.0, y - 4.5), (x + 14.0, y - 4.5), "#b0453a", 1.6, &[7.0, 4.0]);
        dashes(page);
        page.text((x + 22.0, y), "faster than real time: left of it", 13.5, INK, Anchor::Start);
    }
}
