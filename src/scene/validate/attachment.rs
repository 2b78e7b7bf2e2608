//! Attachments: whether what holds and what is held are there.

use super::names::body_named;
use super::tool::named;
use super::{Validator, scene, select};
use crate::scene::limits::TOOLS_OF_A_BODY;
use crate::scene::schema::{Attachment, Scene};
use std::collections::BTreeMap;

pub(super) fn validate(scene_: &Scene, validator: &mut Validator) {
    let mut of_body: BTreeMap<Option<&String>, usize> = BTreeMap::new();
    for (number, attachment) in scene_.attachments.iter().enumerate() {
        let path = scene("attachments").index(number);
        let Attachment::Grasp { tool, body, on, jaws, reach, strength, closed: _ } = attachment;
        named(scene_, validator, &path, tool);
        body_named(scene_, validator, &path, body.as_ref());
        if let Some(on) = on {
            select::validate(validator, &path.name("on"), on);
        }
        if let Some(problem) = jaws.as_ref().and_then(|shape| shape.problem(0.0)) {
            validator.out.error_at(path.name("jaws").name(problem.field), problem.message);
        }
        if let Some(reach) = reach {
            validator.not_negative(&path.name("reach"), *reach, "m");
        }
        if let Some(strength) = strength {
            validator.above_zero(&path.name("strength"), *strength, "N");
        }
        let count = of_body.entry(body.as_ref().or(scene_.bodies.keys().next())).or_default();
        *count += 1;
        if *count == TOOLS_OF_A_BODY + 1 {
            validator.out.error_at(&path, format!("at most {TOOLS_OF_A_BODY} grasps may hold a body"));
        }
    }
}
