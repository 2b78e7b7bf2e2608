//! What is wrong with tools that suck.

use super::names::touched;
use super::tool::named;
use super::{Validator, scene};
use crate::scene::limits::TOOLS_OF_A_BODY;
use crate::scene::schema::{InitialState, Scene, Shape, Suction};
use crate::scene::syntax::Path;
use std::collections::BTreeMap;

pub(super) fn suction(scene_: &Scene, validator: &mut Validator) {
    let mut of_body: BTreeMap<Option<&String>, usize> = BTreeMap::new();
    for (number, suction) in scene_.suction.iter().enumerate() {
        let path = scene("suction").index(number);
        named(scene_, validator, &path, &suction.tool);
        touched(scene_, validator, &path, suction.body.as_ref(), |body| {
            format!("(tool: \"{}\", body: \"{body}\", ...)", suction.tool)
        });
        validator.above_zero(&path.name("pressure"), suction.pressure, "Pa");
        validator.above_zero(&path.name("reach"), suction.reach, "m");
        validator.not_negative(&path.name("delay"), suction.delay, "s");
        of_copies(scene_, validator, &path, &suction.body, "what the tool sucks at");
        let body = scene_.body_meant(&suction.body);
        let is_this = |other: &Suction| {
            (&other.tool, bore_meant(scene_, other), scene_.body_meant(&other.body))
                == (&suction.tool, bore_meant(scene_, suction), body)
        };
        if let Some(earlier) = scene_.suction[..number].iter().position(is_this) {
            let message = format!("`{}` sucks at this body by suction[{earlier}] already", suction.tool);
            validator.out.error_at(&path, message).note("leave one of both out");
        }
        let tool = scene_.tools.get(&suction.tool);
        if let Some(bore) = suction.bore {
            validator.above_zero(&path.name("bore"), bore, "m");
        } else if tool.is_some_and(|tool| !matches!(tool.shape, Some(Shape::Tube { .. }))) {
            validator
                .out
                .error_at(&path, format!("the tool `{}` is no tube: where is its mouth?", suction.tool))
                .note("give `bore`, the radius of a disc about the tool's origin, across its axis z");
        }
        if scene_.is_static() {
            validator
                .out
                .error_at(&path, "a static analysis cannot suck: what is sucked depends on the way there")
                .note("leave `suction` out, or use `analysis: Transient`");
        }
        let begins = matches!(scene_.start, InitialState::Equilibrium(_)) && !scene_.is_static();
        if begins && suction.curve.value(0.0) != 0.0 {
            validator
                .out
                .error_at(&path, "it sucks at t = 0, and `start: Equilibrium()` knows nothing of suction")
                .note("let it begin by and by: `curve: Smooth(end: 0.1)`; or leave `start` out");
        }
        let count = of_body.entry(body).or_default();
        *count += 1;
        if *count == TOOLS_OF_A_BODY + 1 {
            validator.out.error_at(&path, format!("at most {TOOLS_OF_A_BODY} tools may suck at a body"));
        }
    }
}

/// The radius of a mouth (m): a tube's own where none is given.
fn bore_meant(scene_: &Scene, suction: &Suction) -> Option<f64> {
    let own = scene_.tools.get(&suction.tool).and_then(|tool| match &tool.shape {
        Some(Shape::Tube { inner, .. }) => Some(*inner),
        _ => None,
    });
    suction.bore.or(own)
}

/// Refuses what the copies of a body would share, who have nothing in common: a mouth, a tool that gives way.
pub(super) fn of_copies(scene_: &Scene, validator: &mut Validator, path: &Path, body: &Option<String>, what: &str) {
    let found = scene_
        .body_meant(body)
        .and_then(|name| Some((name, scene_.bodies.get(name)?)))
        .filter(|(_, body)| body.copies > 1);
    if let Some((name, body)) = found {
        let message = format!("{what} is shared by the {} copies of `{name}`: they would not do alike", body.copies);
        validator.out.error_at(path, message).note("leave `copies` out, or give each its own body and tool");
    }
}
