//! Which way a tool pushes a node.

use glam::DVec3;

/// By how much of what it does along the way out at the end of a step a push must move a node out that goes along the
/// way out at its beginning: they differ by up to 26°, as on surfaces that are round. Of rims, and of what goes round a
/// tool within a step, they differ by more.
const SMOOTH: f64 = 0.9;

/// The direction in which a tool pushes a node, and how far that takes the node outwards for each metre of it, by the
/// ways out at the beginning and at the end of the step. `moves` says where a push leads, symmetric.
///
/// It is the way out at the beginning, where the force acts, and the push as long as lets the node end on the surface:
/// SHAKE (Ryckaert, Ciccotti & Berendsen 1977), which is symplectic with central differences (Leimkuhler & Skeel 1994).
/// The step before and this one lead away from the tangent plane there by as much, one way and the other, so that the
/// force does no work on what goes along the surface. Along the way out at the end it would do N d²/r, where a step d
/// goes along a radius r: it would drive what slides on a ball, and brake what slides in a bowl.
pub(in crate::systems) fn direction([start, end]: [DVec3; 2], moves: impl Fn(DVec3) -> DVec3) -> (DVec3, f64) {
    let [at_start, at_end] = [start, end].map(|way| end.dot(moves(way)));
    let is_smooth = at_start >= SMOOTH * at_end && SMOOTH * at_start <= at_end;
    if is_smooth { (start, at_start) } else { (end, at_end) }
}

#[cfg(test)]
mod tests {
    use super::direction;
    use glam::DVec3;

    #[test]
    fn a_push_goes_along_the_way_out_at_the_beginning_but_round_rims() {
        let at = |degrees: f64| DVec3::new(degrees.to_radians().sin(), 0.0, degrees.to_radians().cos());
        for (start, is_start) in
            [(0.0, true), (25.0, true), (-25.0, true), (27.0, false), (90.0, false), (180.0, false)]
        {
            let (way, along) = direction([at(start), DVec3::Z], |push| push);
            assert_eq!(way, if is_start { at(start) } else { DVec3::Z }, "{start} degrees");
            assert!((along - way.z).abs() < 1e-15, "{start} degrees: {along}");
        }
        // what may go along z alone, between ways out that are nearly across it
        let (way, along) = direction([at(70.0), at(89.0)], |push| push * DVec3::Z);
        assert_eq!((way, along), (at(89.0), at(89.0).z * at(89.0).z));
    }
}
