//! What is done contact by contact, as tasks that have the machine's registers.

use super::Contact;
use glam::{DVec3, DVec4};
use pulp::{Simd, WithSimd};

/// What is corrected of forces.
#[derive(Clone, Copy)]
pub(super) enum Correction<'a> {
    /// [`Contact::begin`].
    First { shares: &'a [f64], responses: &'a [DVec4] },
    /// [`Contact::press`].
    Pressing,
    /// [`Contact::rub`].
    Rubbing,
}

/// The task of finding normal forces, contact by contact, and what they do to nodes.
pub(super) struct Begin<'a> {
    pub contacts: &'a mut [Contact],
    pub shares: &'a [f64],
    pub responses: &'a [DVec4],
    pub steps: &'a mut [DVec4],
}

impl WithSimd for Begin<'_> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        // as long as each other: a node is looked for once
        let Self { contacts, shares, responses, steps } = self;
        let (shares, steps) = (&shares[..responses.len()], &mut steps[..responses.len()]);
        for contact in contacts {
            let force = contact.begin(shares, responses);
            contact.parts.push(force, responses, steps);
        }
    }
}

/// The task of correcting forces by the steps of nodes as they are.
pub(super) struct Correct<'a> {
    pub correction: Correction<'a>,
    pub contacts: &'a mut [Contact],
    pub changes: &'a mut [DVec3],
    pub steps: &'a [DVec4],
}

impl WithSimd for Correct<'_> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        for (contact, change) in self.contacts.iter_mut().zip(self.changes) {
            *change = match self.correction {
                Correction::First { shares, responses } => contact.begin(shares, responses),
                Correction::Pressing => contact.press(contact.parts.step(self.steps)),
                Correction::Rubbing => contact.rub(self.steps),
            };
        }
    }
}

/// The task of finding what changes of forces do to nodes, in the order of contacts.
pub(super) struct Push<'a> {
    pub contacts: &'a [Contact],
    pub changes: &'a [DVec3],
    pub responses: &'a [DVec4],
    pub steps: &'a mut [DVec4],
}

impl WithSimd for Push<'_> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { contacts, changes, responses, steps } = self;
        let steps = &mut steps[..responses.len()];
        for (contact, change) in contacts.iter().zip(changes) {
            contact.parts.push(*change, responses, steps);
        }
    }
}

/// The task of noting where points go, and of adding up forces on nodes where there are any to add to.
pub(super) struct Note<'a> {
    pub contacts: &'a mut [Contact],
    pub steps: &'a [DVec4],
    pub forces: &'a mut [DVec4],
}

impl WithSimd for Note<'_> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { contacts, steps, forces } = self;
        for contact in contacts {
            contact.note(steps);
            if !forces.is_empty() {
                contact.parts.share(contact.force(), forces);
            }
        }
    }
}

/// The task of adding up forces on nodes.
pub(super) struct Forces<'a> {
    pub contacts: &'a [Contact],
    pub forces: &'a mut [DVec4],
}

impl WithSimd for Forces<'_> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        for contact in self.contacts {
            contact.parts.share(contact.force(), self.forces);
        }
    }
}
