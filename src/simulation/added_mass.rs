//! How much mass may be added: told of above a share of all mass, an error above what the scene allows.

use super::Simulation;
use super::follow::Follower;
use super::mass_scaling::{self, Additions};
use crate::assembly::StableStep;
use crate::components::*;
use crate::error::{Criterion, Error, Instability};
use crate::scene::{Diagnostics, SceneFile};
use bevy_ecs::prelude::*;

/// More added mass than this share is always told of.
const WORTH_TELLING: f64 = 0.05;
/// Rounding of what just fits is no reason to complain.
const ROUNDING: f64 = 1e-6;

/// Whether so large a share of all mass is more than `most`; also what is no number.
fn too_much(share: f64, most: f64) -> bool {
    share.is_nan() || share > most * (1.0 + ROUNDING)
}

/// Makes elements heavier for the step that the scene wants, or for the largest that so much added mass allows. What
/// all elements are stable up to then (s); `None` where that is too much.
pub(super) fn at_the_start(
    scene: &SceneFile,
    bound: &StableStep,
    most: f64,
    world: &mut World,
    diagnostics: &mut Diagnostics,
) -> Option<f64> {
    let integration = &scene.scene.integration;
    let wanted = match integration.step {
        Some(step) => (step / integration.safety).max(bound.time_step),
        None => mass_scaling::step_for(world, most, bound.time_step, bound.usual),
    };
    let precision = match world.query::<&Mass>().iter(world).next() {
        Some(Mass(Reals::F32(_))) => Precision::F32,
        _ => Precision::F64,
    };
    let additions = Additions::at_rest(world, wanted);
    let (added, all) = (additions.mass(), mass_scaling::mass_of_all(world));
    let share = added / all;
    let told = format!(
        "{added:.3e} kg added for a stable step of {wanted:.3e} s: {:.1} % of all mass, most of it to element {} of {}",
        100.0 * share,
        additions.most_needy(world).1,
        additions.most_needy(world).0,
    );
    if too_much(share, most) {
        diagnostics
            .error_at("integration.when_unstable", format!("{told}; `most` allows {} %", 100.0 * most))
            .note("a smaller `step` needs less, and without `step` it is as large as `most` allows; or allow more");
        return None;
    }
    if share > WORTH_TELLING {
        diagnostics.warn_at("integration.when_unstable", told).note(
            "motion is slowed where mass is added; a smaller `step` needs less, and a smaller `most` allows less",
        );
    }
    mass_scaling::insert_columns(precision, world);
    additions.make(world);
    mass_scaling::scale_masses(world);
    Some(wanted)
}

impl Simulation {
    /// Whether mass may be added in the run, beside what was: an error where that is more than the scene allows, a
    /// warning where it is much. Nothing has been added yet.
    pub(super) fn may_add(&mut self, additions: &Additions, follower: &Follower, most: f64) -> Result<(), Error> {
        let added = follower.history.added_mass + additions.mass();
        let share = added / self.facts.initial_mass;
        if !too_much(share, most) {
            return Ok(());
        }
        let (body, element) = additions.most_needy(&self.world);
        let time_step = self.world.resource::<Clock>().time_step;
        Err(Error::Unstable(Box::new(Instability {
            time: self.time(),
            step: self.step_count(),
            body,
            what: format!(
                "a step of {time_step:.3e} s would need {:.1} % of all mass added, most of it to element {element}, and \
                 `when_unstable: ScaleMass` allows {} %",
                100.0 * share,
                100.0 * most
            ),
            cause: "tissue that is squeezed flat or stiffens (take a smaller step, allow more mass by `most`, or let the step \
                    follow: when_unstable: Adapt)"
                .into(),
            good_until: self.time(),
            criterion: Criterion {
                value: Some(share).filter(|share| share.is_finite()),
                limit: Some(most),
                element: Some(element),
                ..Criterion::of("added_mass")
            },
            last_good: None,
        })))
    }

    /// Warns, once, of more added mass than is worth telling.
    pub(super) fn warn_of_added_mass(&mut self, share: f64) {
        let (time, step) = (self.time(), self.step_count());
        let criterion = "added_mass".to_string();
        let mut memory = self.world.get_resource_or_init::<GuardMemory>();
        if share <= WORTH_TELLING || memory.warnings.iter().any(|notice| notice.criterion == criterion) {
            return;
        }
        let message = format!(
            "{:.1} % of all mass was added so that the step can stay ({:.0} % are a warning): motion is slowed there; take a smaller \
             step, or let it follow (when_unstable: Adapt)",
            100.0 * share,
            100.0 * WORTH_TELLING
        );
        let (value, limit) = (share, WORTH_TELLING);
        memory.warnings.push(Notice { criterion, part: "all bodies".into(), time, step, value, limit, message });
    }
}
