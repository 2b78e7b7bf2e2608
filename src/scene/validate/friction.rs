//! Friction of what touches.

use super::{Validator, show};
use crate::scene::schema::{Contact, Scene};
use crate::scene::syntax::Path;

/// Coefficients of friction above this are hardly meant: tissue has some hundredths to one, rubber up to four.
const MUCH_FRICTION: f64 = 5.0;

pub(super) fn validate(scene_: &Scene, validator: &mut Validator, path: &Path, contact: &Contact) {
    let [sticking, sliding] = contact.friction();
    validator.not_negative(&path.name("friction"), sliding, "");
    if sticking < sliding {
        validator.not_negative(&path.name("static_friction"), sticking, "");
        let message = format!("`static_friction` is {}, and `friction` is {}", show(sticking), show(sliding));
        validator
            .out
            .error_at(path.name("static_friction"), message)
            .note("what sticks is held at least as well as what slides");
    }
    if sticking.max(sliding) <= 0.0 {
        return;
    }
    if sliding.is_finite() && sliding > MUCH_FRICTION {
        validator
            .out
            .warn_at(path.name("friction"), format!("friction of {}: what touches hardly ever slides", show(sliding)))
            .note(format!("it is a coefficient, and no percentage: {} % is {}", show(sliding), show(sliding / 100.0)));
    }
    if scene_.is_static() {
        let told = validator
            .out
            .warn_at(path.name("friction"), "rest with friction depends on the way there, and this is one of many")
            .note("a transient analysis goes the way that the scene tells");
        if !scene_.is_static_by_newton() {
            told.note("few `load_steps` leave behind what friction carries: take some 400 for each edge of its way");
        }
    }
    let crosses = matches!(contact, Contact::Between { edges: true, .. } | Contact::Itself { edges: true, .. });
    if scene_.is_implicit() && crosses {
        let message = "in implicit steps what should stick slides where edges cross, the faster the shorter the step";
        validator
            .out
            .warn_at(path.name("edges"), message)
            .note("leave `edges` out, or take explicit steps, in which such edges creep a little");
    }
}
