//! Implicit steps: their numbers, and what of a scene they cannot do.

use super::{Validator, scene, show, with_unit};
use crate::scene::schema::{
    Contact, ContactLaw, ErrorControl, ImplicitScheme, Scene, SearchMethod, Solver, WhenUnstable,
};
use crate::scene::syntax::Path;

/// Passes that an iteration and the residual before it take at least.
const LEAST_BUDGET: u64 = 3;

pub(super) fn validate(scene_: &Scene, validator: &mut Validator) {
    if scene_.search().is_some_and(|search| search.method == SearchMethod::Newton) {
        let word = if scene_.is_static() { "analysis" } else { "start" };
        let instead = format!("`method: Relaxation` in `{word}`");
        let message = "Newton's iterations cannot take part in the kinematic law of contact, which puts nodes where they \
                       may be from step to step";
        refuse_kinematic(scene_, message, &format!("use {instead}"), validator);
        refused(scene_, "Newton's iterations", &instead, validator);
    }
    let is_spring = |contact: &Contact| contact.law() != ContactLaw::Kinematic;
    if scene_.search().is_some_and(|search| search.method == SearchMethod::Relaxation)
        && scene_.contacts.iter().any(is_spring)
    {
        let message = "at rest all contacts are springs, or none is";
        refuse_kinematic(scene_, message, "leave `law` out at the others", validator);
    }
    let Solver::Implicit { scheme, step, adaptive, newton, tolerance, budget, .. } = scene_.solver else { return };
    let path = scene("solver");
    validator.above_zero(&path.name("step"), step, "s");
    if let Some(control) = adaptive {
        error_control(control, step, &path.name("adaptive"), validator);
    }
    if newton == 0 {
        validator.must(&path.name("newton"), "at least 1", newton).note("1 is the linearised step");
    }
    if tolerance <= 0.0 || tolerance >= 1.0 {
        validator
            .must(&path.name("tolerance"), "above 0 and below 1", show(tolerance))
            .note("it is a share of the forces in a step; 1e-3 when left out");
    }
    if let Some(budget) = budget.filter(|budget| *budget < LEAST_BUDGET) {
        validator.must(&path.name("budget"), &format!("at least {LEAST_BUDGET}"), budget).note(
            "one pass for the residual, one for a product, one where it leads; left out, a step takes what it needs",
        );
    }
    if let ImplicitScheme::GeneralizedAlpha { high_frequencies } = scheme
        && !(0.0..=1.0).contains(&high_frequencies)
    {
        validator
            .must(&path.name("scheme").name("high_frequencies"), "from 0 to 1", show(high_frequencies))
            .note("it is what a step leaves of frequencies far above 1/step; 0.8 when left out");
    }
    if scene_.is_static() {
        validator.out.warn_at(&path, "a static analysis ignores `solver`: its own `method` leads to rest");
        return;
    }
    if scene_.integration.step.is_some() {
        validator
            .out
            .error_at(scene("integration").name("step"), "this is the step of explicit steps")
            .note("that of implicit ones stands in `solver`");
    }
    if scene_.integration.when_unstable.is_some_and(|policy| policy != WhenUnstable::Watch) {
        validator
            .out
            .error_at(scene("integration").name("when_unstable"), "implicit steps are stable at any length")
            .note("leave it out: neither masses nor steps nor elements have to change");
    }
    let message = "the kinematic law corrects explicit steps, and there are none";
    refuse_kinematic(scene_, message, "use `solver: Explicit`", validator);
    refused(scene_, "implicit steps", "`solver: Explicit`", validator);
}

/// Steps that are chosen by their error.
fn error_control(control: ErrorControl, step: f64, path: &Path, validator: &mut Validator) {
    let ErrorControl { tolerance, displacement, smallest } = control;
    if tolerance <= 0.0 || tolerance >= 1.0 {
        validator
            .must(&path.name("tolerance"), "above 0 and below 1", show(tolerance))
            .note("it is the error that the steps within one `step` add up to, as a share; 1e-3 when left out");
    }
    if let Some(displacement) = displacement {
        validator.above_zero(&path.name("displacement"), displacement, "m");
    }
    if let Some(smallest) = smallest {
        validator.above_zero(&path.name("smallest"), smallest, "s");
        if smallest > step && step > 0.0 {
            validator
                .must(&path.name("smallest"), &format!("at most {}", with_unit(step, "s")), with_unit(smallest, "s"))
                .note("`step` is the longest step");
        }
    }
}

/// Refuses the kinematic law.
fn refuse_kinematic(scene_: &Scene, message: &str, instead: &str, validator: &mut Validator) {
    let kinematic = |(_, contact): &(usize, &Contact)| contact.law() == ContactLaw::Kinematic;
    // what a free tool touches is told of with the tool, which knows no other law
    let of_free = |contact: &Contact| match contact {
        Contact::Tool { tool, .. } => scene_.tools.get(tool).is_some_and(|tool| tool.free.is_some()),
        Contact::Between { .. } | Contact::Itself { .. } => false,
    };
    for (number, _) in scene_.contacts.iter().enumerate().filter(kinematic).filter(|(_, contact)| !of_free(contact)) {
        let note = format!("write `law: Penalty(share: 1)`, a spring that is solved for, or {instead}");
        validator.out.error_at(scene("contacts").index(number), message).note(note);
    }
}

/// What has a step of its own that knows central differences only.
fn refused(scene_: &Scene, who: &str, instead: &str, validator: &mut Validator) {
    if !scene_.suction.is_empty() {
        validator
            .out
            .error_at(
                scene("suction").index(0),
                format!("{who} cannot take part in suction, which keeps what was sucked from step to step"),
            )
            .note(format!("leave `suction` out, or use {instead}"));
    }
    for (name, _) in scene_.tools.iter().filter(|(_, tool)| tool.free.is_some()) {
        validator
            .out
            .error_at(scene("tools").name(name).name("free"), format!("{who} do not move free tools"))
            .note(format!("use {instead}"));
    }
}
