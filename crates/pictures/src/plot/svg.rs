//! Drawings as SVG.

use super::drawing::{Anchor, Drawing, Edge, Shape, Text};
use std::fmt::Write;

const FONTS: &str = "Ubuntu, 'Segoe UI', 'Helvetica Neue', Arial, sans-serif";

/// The whole file.
pub fn svg(drawing: &Drawing) -> String {
    let (width, height) = drawing.size;
    let mut file = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
         font-family=\"{FONTS}\">\n"
    );
    for shape in &drawing.shapes {
        let _ = writeln!(file, "{}", element(shape));
    }
    file += "</svg>\n";
    file
}

fn element(shape: &Shape) -> String {
    match shape {
        Shape::Line { from: (ax, ay), to: (bx, by), colour, width, dashes } => {
            let lengths: Vec<String> = dashes.iter().map(f32::to_string).collect();
            let dashes = match lengths.is_empty() {
                true => String::new(),
                false => format!(" stroke-dasharray=\"{}\"", lengths.join(" ")),
            };
            format!(
                "<line x1=\"{ax:.1}\" y1=\"{ay:.1}\" x2=\"{bx:.1}\" y2=\"{by:.1}\" stroke=\"{colour}\" \
                 stroke-width=\"{width}\"{dashes}/>"
            )
        }
        Shape::Polyline { points, colour, width, opacity } => format!(
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\" \
             stroke-opacity=\"{opacity}\" stroke-linejoin=\"round\"/>",
            listed(points)
        ),
        Shape::Rectangle { area: [left, top, right, bottom], colour } => format!(
            "<rect x=\"{left:.1}\" y=\"{top:.1}\" width=\"{:.1}\" height=\"{:.1}\" fill=\"{colour}\"/>",
            right - left,
            bottom - top
        ),
        Shape::Frame { area: [left, top, right, bottom], colour } => format!(
            "<rect x=\"{left}\" y=\"{top}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"{colour}\"/>",
            right - left,
            bottom - top
        ),
        Shape::Circle { centre: (x, y), radius, colour, fill } => format!(
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius}\" fill=\"{}\" stroke=\"{colour}\" stroke-width=\"1.6\"/>",
            fill.as_deref().unwrap_or("none")
        ),
        Shape::Diamond { centre: (x, y), reach, colour, fill } => {
            let (left, right, top, bottom) = (x - reach, x + reach, y - reach, y + reach);
            format!(
                "<path d=\"M{x:.1} {top:.1}L{right:.1} {y:.1}L{x:.1} {bottom:.1}L{left:.1} {y:.1}Z\" fill=\"{fill}\" \
                 stroke=\"{colour}\" stroke-width=\"1.4\"/>"
            )
        }
        Shape::Polygon { points, colour, opacity } => {
            format!("<polygon points=\"{}\" fill=\"{colour}\" fill-opacity=\"{opacity}\"/>", listed(points))
        }
        Shape::Text(text) => letters(text),
    }
}

fn letters(Text { at: (x, y), text, size, colour, anchor, edge, turned }: &Text) -> String {
    let edge = match edge {
        Edge::None => String::new(),
        Edge::Same(width) => format!(" stroke=\"{colour}\" stroke-width=\"{width:.2}\""),
        Edge::White(width) => {
            format!(" stroke=\"#ffffff\" stroke-width=\"{width}\" stroke-linejoin=\"round\" paint-order=\"stroke\"")
        }
    };
    let anchor = match anchor {
        Anchor::Start => "start",
        Anchor::Middle => "middle",
        Anchor::End => "end",
    };
    let turned = if *turned { format!(" transform=\"rotate(-90 {x:.1} {y:.1})\"") } else { String::new() };
    format!(
        "<text x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"{size}\" fill=\"{colour}\"{edge} text-anchor=\"{anchor}\"{turned}>{}\
         </text>",
        escaped(text)
    )
}

fn listed(points: &[(f64, f64)]) -> String {
    let points: Vec<String> = points.iter().map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
    points.join(" ")
}

/// Text as XML takes it, which knows no control characters.
fn escaped(text: &str) -> String {
    let text: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
