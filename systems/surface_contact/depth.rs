//! How deep points may be inside of what they face.

use crate::components::*;
use crate::math::Scalar;

/// What is the same for all points in a step.
pub(super) struct InStep {
    /// How far the fastest node went in the last step (m).
    pub largest: f64,
    /// How far points that are inside and may be come out (m).
    pub settling: f64,
}

/// How a point is to something that it faces.
#[derive(Clone, Copy, Debug)]
pub(super) struct Outside {
    /// How far it is outside now (m).
    pub now: f64,
    /// How far outwards it has gone since it was noted how far that was (m).
    pub since: f64,
    /// The same in the last step (m).
    pub went: f64,
}

/// How deep a point may be inside (m) of what it faces, one face or the two walls of a corner: as deep as it is found
/// there and no motion has brought it, by and by less. A point that was not seen before (at the start, laid bare, at a
/// corner that comes round) is not thrown out in a step. One that touches went outwards as far as it did in the last
/// step, and not as far as was foreseen: tools may have held what it touches.
///
/// Of walls that change places it is not known which was which. So what has faced two, and what has touched nothing, is
/// taken to have gone as far as any motion may have brought it; and of two, one of which it has touched, that one is
/// the one of which motion tells more.
///
/// Also how far that is less than it would be, did nothing come out (m).
pub(super) fn allowed<T: Scalar>(touch: &[T], faced: &[Outside], in_step: &InStep) -> (f64, f64) {
    let [before, last] = [touch[3].to_f64(), touch[5].to_f64()];
    let PointState { did, in_corner } = PointState::of(touch[4].to_f64());
    let lowest = faced.iter().map(|outside| outside.now).fold(f64::INFINITY, f64::min);
    let unexpected = |outside: &Outside| outside.now - (last + outside.since);
    let deeper = match (did, faced) {
        (Did::Free, _) => lowest,
        (Did::Sticks | Did::Slides, [one]) if !in_corner => unexpected(one),
        (Did::Sticks | Did::Slides, [one, other]) if !in_corner => {
            let is_one = unexpected(one).abs() <= unexpected(other).abs();
            let (old, new) = if is_one { (one, other) } else { (other, one) };
            // behind the line where both meet it is behind the other as far as in the one, or less
            unexpected(old).min((new.now - new.went) - (old.now - old.went).min(0.0))
        }
        _ => lowest - (last - 2.0 * in_step.largest),
    };
    let least = lowest.min(0.0);
    let stays = (before + deeper.min(0.0)).max(least);
    let allowed = (stays + in_step.settling).min(0.0).max(least);
    (allowed, allowed - stays)
}

/// The stiffness of the spring that has pressed a point (N/m), by the force at last and how deep it is now in all that it
/// faces, with how deep it may be (m).
pub(super) fn stiffness<T: Scalar>(touch: &[T], faced: &[Outside], allowed: f64) -> f64 {
    let deep: f64 = faced.iter().map(|outside| (allowed - outside.now).max(0.0)).sum();
    if deep > 0.0 { touch[6].to_f64() / deep } else { 0.0 }
}

#[cfg(test)]
mod tests;
