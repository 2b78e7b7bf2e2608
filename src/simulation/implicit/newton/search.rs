//! The line search: how far Newton's iterations go along a direction.

use super::super::conjugate_gradients::Vectors;
use super::super::trial::Tried;
use super::super::vectors::{combine, copy};
use super::{DESCENT, Lost, Newton, Way, Workspace};
use crate::components::Clock;
use crate::error::Error;

/// How often a way is halved.
const MOST_HALVINGS: u32 = 12;
/// How often it is looked along a way where the work is known to change its sign: two looks halve what is left, and
/// springs a million times as stiff as the rest are found within 2⁻²⁰ of it.
const MOST_LOOKS: u32 = 42;
/// What the norm of the residual must fall to where something touches, whatever its work along the way. Ten iterations
/// that do no more come to the usual tolerance of 1e-3, half of those that a step has. Between .1 and .9 it changes
/// next to nothing: no pass of a ball that presses a lens with springs 10 and 100 times as stiff as an element, by
/// either scheme, and 3 of 1053 of one that presses a block.
const FALLS: f64 = 0.5;
/// What the work of the residual must fall to where it has been seen to change its sign along a way.
const FOUND: f64 = 0.5;

/// Where along a way the work of the residual is nothing: it has one sign at its nearer end and the other at its
/// farther one, or is no number there. Where springs begin to touch, or let go, it bends, and halving from the far end
/// comes down to where they do not touch yet; the next iteration would go the same way. Turns of regula falsi
/// (Illinois: of an end that stays the work is halved; Dowell & Jarratt 1971) and of bisection, so that it ends
/// whatever the bend.
#[derive(Clone, Copy, Debug)]
struct Bracket {
    /// How far, and the work there (J).
    near: [f64; 2],
    far: Option<[f64; 2]>,
    /// How far it leads at most.
    ends: f64,
    bisects: bool,
}

impl Bracket {
    /// Of a way that leads so far at most, with such a work at its beginning (J).
    fn from(work: f64, ends: f64) -> Self {
        Self { near: [0.0, work], far: None, ends, bisects: true }
    }

    /// Whether the work is known to change its sign, and not only to end somewhere.
    fn crosses(&self) -> bool {
        self.far.is_some_and(|[_, work]| work.is_finite())
    }

    /// Where to look next, after a look there.
    fn next(&mut self, share: f64, work: f64) -> f64 {
        if work * self.near[1] > 0.0 {
            // it stays: what is at the other end counts for less
            self.far = self.far.map(|[share, work]| [share, 0.5 * work]);
            // more of the same sign is no nearer to the end
            match self.far {
                Some(_) => self.near = [share, work],
                None => return 0.5 * share,
            }
        } else {
            if self.far.is_some() {
                self.near[1] *= 0.5;
            }
            self.far = Some([share, work]);
        }
        let ([near, less], [far, more]) = (self.near, self.far.unwrap_or([share, work]));
        self.bisects = !self.bisects;
        let crossing = near + (far - near) * less / (less - more);
        if self.bisects || !(crossing > near && crossing < far) { 0.5 * (near + far) } else { crossing }
    }
}

impl Newton<'_, '_> {
    /// Goes along p as far as the residual does less work along it, and where bodies give way along it as far as it
    /// leads downhill. `size` becomes the norm of the new residual. Where no pass is left, what leaves less of it is
    /// enough, and else it stays where it was.
    pub(super) fn search(&mut self, way: Way, size: &mut f64, enough: f64) -> Result<Tried, Lost> {
        copy(&mut self.space.vectors.image, &self.space.correction);
        self.residual();
        let begins = self.sums.dot(&self.space.p, &self.space.residual);
        let touches = self.trial.world.resource::<Clock>().springs.is_some();
        let moves = self.space.to_go.moves();
        let ends = self.longest();
        let (mut share, mut bracket, mut halvings) = (ends, Bracket::from(begins, ends), 0);
        // where least is left, and how much
        let mut best = (0.0, DESCENT * *size);
        for look in 0..=MOST_LOOKS {
            if look > MOST_HALVINGS && !bracket.crosses() {
                break;
            }
            halvings = look;
            let tried = self.forces_along(share)?;
            let mut work = f64::NAN;
            self.beyond |= !tried.sound;
            if tried.sound {
                let now = self.residual();
                work = self.sums.dot(&self.space.p, &self.space.residual);
                let descends = self.descends(&way, (share, work), touches.then_some(&bracket));
                // of what is moved as told the work may be of either sign, and what slides is rubbed by what presses
                // it, of which a symmetric tangent does not know: it leads there where less is left
                let arrives = touches && now <= if moves { DESCENT } else { FALLS } * *size;
                let is_enough = now <= enough || self.left() == 0 && now < *size;
                if now < best.1 {
                    best = (share, now);
                }
                if now.is_finite() && (descends || arrives || self.settings.newton == 1 || is_enough) {
                    self.space.to_go.go(share);
                    *size = now;
                    return Ok(tried);
                }
            }
            self.report.halvings += 1;
            if self.left() == 0 {
                break;
            }
            share = if touches { bracket.next(share, work) } else { 0.5 * share };
        }
        if self.left() == 0 {
            return Ok(self.forces_along(0.0)?);
        }
        if best.0 > 0.0 && (touches || moves) && !self.settings.formula.is_of_rest() {
            // slowly is better than not at all: between sticking and sliding forces have a kink, and the work along the
            // way of what is moved evenly as told is that of next to no forces
            let tried = self.forces_along(best.0)?;
            self.space.to_go.go(best.0);
            *size = self.residual();
            return Ok(tried);
        }
        let Workspace { correction, vectors, .. } = &mut *self.space;
        copy(correction, &vectors.image);
        Err(Lost::Because(format!(
            "no descent after {halvings} halvings of a Newton step, at a residual of {size:.3e} N{}",
            self.what_is_beyond()
        )))
    }

    /// Goes a share of the way along p from where it began, which is kept, and takes the forces there.
    fn forces_along(&mut self, share: f64) -> Result<Tried, Error> {
        let Workspace { correction, p, to_go, vectors: Vectors { image: from, .. }, .. } = &mut *self.space;
        copy(correction, from);
        if share > 0.0 {
            combine(correction, p, |from, p| from + share * p);
            // where held axes go p is 0
            to_go.add(share, correction);
        }
        self.forces_at_w()
    }

    /// The share of p beyond which an axis would go farther than it may.
    fn longest(&self) -> f64 {
        let Some(farthest) = self.farthest else { return 1.0 };
        let Workspace { p, to_go, .. } = &*self.space;
        // where held axes go p is 0
        let ways = (0..p.len()).map(|axis| p.get(axis)).chain(to_go.iter().map(|(_, left)| left));
        let most = ways.map(f64::abs).fold(0.0, f64::max);
        if most > farthest { farthest / most } else { 1.0 }
    }

    /// Whether the work of the residual (J) has fallen enough where a share of the way is gone. Of a share, that share
    /// of the fall is asked for, or directions along which work falls as the tangent says were refused. Where something
    /// touches, a way counts, too, at whose end the residual still leads on: springs have let go, of which the tangent
    /// did not know.
    fn descends(&self, way: &Way, (share, work): (f64, f64), touching: Option<&Bracket>) -> bool {
        let along = way.along.abs();
        let size = if way.gives_way { work.max(0.0) } else { work.abs() };
        let most = if touching.is_some_and(Bracket::crosses) { FOUND } else { 1.0 - (1.0 - DESCENT) * share };
        let leads_on = |bracket: &Bracket| share == bracket.ends && work * bracket.near[1] > 0.0 && size < along;
        size <= most * along || touching.is_some_and(leads_on)
    }
}

#[cfg(test)]
mod tests;
