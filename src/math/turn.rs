//! Rotations as scenes and tables write them: axis times angle in degrees.

use glam::{DQuat, DVec3};
use std::f64::consts::PI;

/// Degrees as radians.
pub fn radians(degrees: DVec3) -> DVec3 {
    degrees * PI / 180.0
}

/// A rotation by an axis times an angle (degrees).
pub fn turned(degrees: DVec3) -> DQuat {
    DQuat::from_scaled_axis(radians(degrees))
}

/// A rotation as axis times angle (degrees), of half a turn at most.
pub fn degrees(turn: DQuat) -> DVec3 {
    let turn = shorter(turn);
    let axis = DVec3::new(turn.x, turn.y, turn.z);
    let sine = axis.length();
    // the angle by both parts: the arc cosine of one near 1 has half the digits
    if sine == 0.0 { DVec3::ZERO } else { axis / sine * (2.0 * sine.atan2(turn.w)).to_degrees() }
}

/// The same rotation, by half a turn at most.
pub fn shorter(turn: DQuat) -> DQuat {
    if turn.w < 0.0 { -turn } else { turn }
}
