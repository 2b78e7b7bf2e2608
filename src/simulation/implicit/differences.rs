//! Products with the tangent stiffness as differences of forces.

use super::place::Place;
use super::trial::Trial;
use super::vectors::{clear, combine};
use crate::components::Reals;
use crate::error::Error;

/// c (F(w + ε p) − F(w))/ε, and the part of the springs that touch at w.
pub(super) fn difference(
    trial: &mut Trial<'_>,
    place: &Place<'_>,
    net: &Reals,
    p: &Reals,
    image: &mut Reals,
) -> Result<(), Error> {
    let reach = trial.reach(p);
    if reach == 0.0 {
        clear(image);
        return Ok(());
    }
    trial.forces_without_springs(&place.beyond(reach, p), image)?;
    let stiffness = place.formula.stiffness();
    combine(image, net, |there, here| stiffness / reach * (there - here));
    trial.springs.add_product(stiffness, place.formula.step(), p, image);
    Ok(())
}
