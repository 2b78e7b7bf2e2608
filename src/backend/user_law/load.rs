//! Reading a load of the user's own: one WGSL function that gives the force on a node.

use super::form::Form;
use super::names::declared;
use super::reading::Reading;
use super::{About, Complaint};
use crate::components::{LoadText, NodeAtRest};
use std::collections::BTreeMap;
use std::ops::Range;

/// Reads the load `name` from the text of its file and the parameters that the scene gives.
///
/// # Errors
/// All that is wrong with the text, or with the parameters.
pub fn read_load(
    name: &str,
    path: &str,
    text: &str,
    parameters: &BTreeMap<String, f64>,
) -> Result<LoadText, Vec<Complaint>> {
    let reading = Reading::of(&Form::load(name), path, text, parameters)?;
    let program = reading.program(name)?;
    let (name, path, text) = (name.to_owned(), path.to_owned(), text.to_owned());
    Ok(LoadText { name, path, text, uniform: reading.uniform, program })
}

/// Where a load's function stands in its text.
fn function(load: &LoadText) -> Option<Range<usize>> {
    declared(&load.text).into_iter().find(|d| d.kind == "fn" && d.name == load.name).map(|d| d.at)
}

/// What is wrong with a load on some nodes at rest, each with the author's number: forces that are no numbers. Whether
/// its curve is one of the scene's own is `with_curve`.
pub fn check_load(
    load: &LoadText,
    nodes: impl IntoIterator<Item = (u64, NodeAtRest)>,
    with_curve: bool,
) -> Vec<Complaint> {
    let about = || function(load).map_or(About::File, About::Bytes);
    let mut complaints = Vec::new();
    for (number, node) in nodes {
        let force = load.force(&node.numbers());
        if force.iter().any(|part| !part.is_finite()) {
            let at = node.rest_position;
            let message = format!(
                "`{}` gives ({}, {}, {}) N on node {number} at rest, at ({}, {}, {})",
                load.name, force[0], force[1], force[2], at.x, at.y, at.z
            );
            let note = "a force must be finite at rest: 0/0 there needs a case of its own, as `normalize` of 0 does";
            complaints.push(Complaint::new(about(), message).note(note));
            break;
        }
    }
    if with_curve && !load.program.reads(LoadText::CURVE) {
        let message = format!("`{}` does not read `node.curve`: the scene's `curve` changes nothing", load.name);
        let note = "multiply by `node.curve` what is to have this course in time";
        complaints.push(Complaint { warning: true, ..Complaint::new(about(), message).note(note) });
    }
    complaints
}
