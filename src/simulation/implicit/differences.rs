//! Products with the tangent stiffness as differences of forces.

use super::axes::Motion;
use super::formula::Formula;
use super::trial::Trial;
use crate::error::Error;

/// Of the velocity at the end the step (m) that it is, where loads look at that; at rest, where springs do, the way
/// from where the search began.
pub(super) fn steps_to<'s>(
    formula: &Formula,
    h: f64,
    motion: &Motion,
    w: &[f64],
    steps: &'s mut Vec<f64>,
    trial: &Trial<'_>,
) -> Option<&'s [f64]> {
    if !trial.looks_at_steps() {
        return None;
    }
    steps.resize(w.len(), 0.0);
    for (axis, step) in steps.iter_mut().enumerate() {
        *step = match formula.is_of_rest() {
            true => w[axis] - motion.u[axis],
            false => h * motion.arrival(formula, axis, h, w[axis]).0,
        };
    }
    Some(steps)
}

/// c (F(w + ε p) − F(w))/ε, and the part of the springs that touch at w.
pub(super) fn difference(
    trial: &mut Trial<'_>,
    (formula, h, motion): (&Formula, f64, &Motion),
    (w, net): (&[f64], &[f64]),
    elsewhere: &mut [f64],
    steps: &mut Vec<f64>,
    p: &[f64],
    image: &mut [f64],
) -> Result<(), Error> {
    let reach = trial.reach(p);
    if reach == 0.0 {
        image.fill(0.0);
        return Ok(());
    }
    elsewhere.iter_mut().zip(w).zip(p).for_each(|((elsewhere, w), p)| *elsewhere = w + reach * p);
    let at = steps_to(formula, h, motion, elsewhere, steps, trial);
    trial.forces_without_springs(elsewhere, at, image)?;
    let factor = formula.stiffness() / reach;
    image.iter_mut().zip(net).for_each(|(image, net)| *image = factor * (*image - net));
    trial.springs.add_product(formula.stiffness(), formula.step(), p, image);
    Ok(())
}
