//! How stiff springs of contact may be.

use super::stable_step::Stability;
use crate::scene::Diagnostics;
use crate::scene::schema::{Contact, ContactLaw, Scene};
use crate::scene::syntax::Path;

/// What springs act on a body.
#[derive(Default)]
struct OnBody<'a> {
    /// Shares of tools' springs, in sum; the largest of surfaces, which share the masses of their nodes.
    of_tools: f64,
    of_surfaces: f64,
    damping: f64,
    /// The contacts they are of.
    contacts: Vec<usize>,
    name: &'a str,
}

/// The largest share of springs that does not throw out in one step what has come in in one.
const FIRM: f64 = 1.0;

/// Refuses springs that the step is too large for. With k = f/(κ D) the frequency of all is bounded by ω² ≤ ω_e² + Σ
/// f/Δt² (Weyl), so that at the share s of the stable step f ≤ 4 (1 − s²); damping that follows a step late leaves
/// (√(1 + ζ²) − ζ)² of that.
///
/// That holds for what touches all the time. A node that comes in with a step d and ends δ ≤ d inside goes on by
/// d − f δ − 2ζ√f d: not back out at once, whatever δ, where f + 2ζ√f ≤ 1, which is f ≤ (√(1 + ζ²) − ζ)². Else it may
/// leave faster than it came, and what rattles makes energy.
pub(super) fn check(scene: &Scene, stability: &Stability, diagnostics: &mut Diagnostics) {
    let share = match (scene.integration.step, stability.limit) {
        (Some(step), Some(limit)) => step / limit,
        (Some(_), None) => 0.0,
        (None, _) => scene.integration.safety,
    };
    for name in scene.bodies.keys() {
        let mut found = OnBody { name, ..OnBody::default() };
        for (number, contact) in scene.contacts.iter().enumerate() {
            let ContactLaw::Penalty { share, damping } = contact.law() else { continue };
            match contact {
                Contact::Tool { body, .. } if body.as_ref().is_none_or(|body| body == name) => found.of_tools += share,
                Contact::Between { bodies: (a, b), .. } if a == name || b == name => {
                    found.of_surfaces = found.of_surfaces.max(share);
                }
                Contact::Itself { body, .. } if body.as_ref().is_none_or(|body| body == name) => {
                    found.of_surfaces = found.of_surfaces.max(share);
                }
                _ => continue,
            }
            found.damping = found.damping.max(damping);
            found.contacts.push(number);
        }
        found.check(share, diagnostics);
    }
}

impl OnBody<'_> {
    fn check(&self, share: f64, diagnostics: &mut Diagnostics) {
        let Some(&first) = self.contacts.first() else { return };
        let late = (1.0 + self.damping * self.damping).sqrt() - self.damping;
        let most = (4.0 * (1.0 - share * share)).clamp(0.0, FIRM) * late * late;
        let found = self.of_tools + self.of_surfaces;
        // what is no number is not within
        if found <= most {
            return;
        }
        let path = Path::default().name("contacts").index(first).name("law");
        let message = format!(
            "springs with a share of {found:.4} in all act on `{}`: at {share:.3} of the stable step {most:.4} are stable",
            self.name
        );
        diagnostics
            .error_at(path, message)
            .note("give a smaller `share`, less `damping`, or a smaller `integration.safety` (or `step`)")
            .note("shares of tools add up, and the largest one of surfaces");
    }
}
