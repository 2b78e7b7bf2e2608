//! The plot: well-formed, with all that belongs into it, and labels that do not lie on each other.

use crate::made_up::{MadeUp, Nobody};
use sinew_pictures::plot::{Anchor, Drawing, place, png, svg};
use sinew_studies::accuracy::plot::drawing;
use sinew_studies::accuracy::{Settings, Study, study};

fn made() -> Study {
    let started = std::time::Instant::now();
    let settings = Settings { started, budget: 1e9, target: 0.01, judged_by: None, reference: None };
    study(&mut MadeUp { seconds: 1e-4, ..MadeUp::default() }, &settings, &mut Nobody).unwrap()
}

#[test]
fn the_plot_is_a_drawing_with_axes_units_front_real_time_and_legend() {
    let drawing = svg(&drawing(&made(), "a bar & <its> weight"));
    let document = roxmltree::Document::parse(&drawing).unwrap();
    let texts: Vec<&str> = document.descendants().filter(|n| n.has_tag_name("text")).filter_map(|n| n.text()).collect();
    for words in [
        "What accuracy costs: a bar & <its> weight",
        "wall time per simulated second",
        "relative error of displacement",
        "real time",
        "Pareto front",
        "Tet4",
        "Hex8",
        "as written",
        "×2",
        "Δt/4",
        "target 1.0 %",
    ] {
        assert!(texts.iter().any(|text| text.contains(words)), "{words:?} is not in {texts:?}");
    }
    for attribute in ["x", "y", "cx", "cy", "x1", "y1", "x2", "y2"] {
        for value in document.descendants().filter_map(|node| node.attribute(attribute)) {
            let value: f64 = value.parse().unwrap();
            assert!((-1.0..1200.0).contains(&value), "{attribute} = {value}");
        }
    }
    assert!(!drawing.contains("NaN"));
}

#[test]
fn the_picture_has_letters_without_any_fonts_of_the_system() {
    let drawing = |text: &str| {
        let mut page = Drawing::new((80.0, 40.0));
        page.text((5.0, 30.0), text, 24.0, "#000000", Anchor::Start);
        png(&page, 1.0).unwrap()
    };
    let blank = drawing("");
    assert_eq!(blank[1..4], *b"PNG");
    // what no font has is a box
    let missing = drawing("\u{e000}");
    assert_ne!(missing, blank);
    for letter in ["×", "Δ", "½", "µ", "…", "W"] {
        let picture = drawing(letter);
        assert!(picture != blank && picture != missing, "letter {letter} is missing");
    }
    assert!(png(&Drawing::clear((0.0, 40.0)), 1.0).is_err());
}

#[test]
fn labels_of_a_crowd_do_not_lie_on_each_other_or_on_points() {
    let crowd: Vec<(f64, f64)> =
        (0..14).map(|i| (300.0 + 4.0 * f64::from(i % 4), 300.0 + 5.0 * f64::from(i / 4))).collect();
    let labels: Vec<((f64, f64), &str)> = crowd.iter().map(|&at| (at, "some label")).collect();
    let points = crowd.iter().map(|(x, y)| [x - 6.0, y - 6.0, x + 6.0, y + 6.0]).collect();
    let spots = place(&labels, points, [0.0, 0.0, 800.0, 600.0]);
    let areas: Vec<[f64; 4]> =
        spots.iter().flatten().map(|spot| [spot.x, spot.y - 10.0, spot.x + 68.0, spot.y + 2.0]).collect();
    assert!(areas.len() >= 12, "{} of 14 have a place", areas.len());
    for (i, a) in areas.iter().enumerate() {
        for b in &areas[..i] {
            assert!(a[0] >= b[2] || b[0] >= a[2] || a[1] >= b[3] || b[1] >= a[3], "{a:?} lies on {b:?}");
        }
    }
}
