use super::*;

const SPRINGS: SolvedSprings = SolvedSprings { step: 1e-3, shared: false, forces: SpringForces::Tried };
const MASS: f64 = 2e-3;
const TIME: f64 = 1e-2;

/// The force of a point that was at 0 before the step and is there (m) after it, on a plane along z at a height.
fn force(spring: &ContactSpring, height: f64, friction: f64, at: DVec3) -> (DVec3, [DMat3; 2]) {
    let press = spring.press(&SPRINGS, MASS, at.z - height, [at.z, TIME]);
    press.with(DVec3::Z, &press.rub(DVec3::Z, at.with_z(0.0), friction))
}

#[test]
fn slopes_are_those_of_the_force() {
    let spring = ContactSpring { share: 0.7, damping: 0.2 };
    // above the surface before, and below; held, and sliding
    for (height, along) in [(-1e-5, 1e-6), (1e-3, 1e-6), (-1e-5, 1e-3), (1e-3, 1e-3)] {
        let at = DVec3::new(along, -0.5 * along, -1e-4);
        let (_, [of_place, of_step]) = force(&spring, height, 0.3, at);
        let (slope, step) = (of_place + of_step, 1e-10);
        for axis in [DVec3::X, DVec3::Y] {
            let [ahead, behind] = [step, -step].map(|step| force(&spring, height, 0.3, at + axis * step).0);
            let difference = (behind - ahead) / (2.0 * step);
            assert!((slope * axis - difference).length() < 1e-4 * slope.z_axis.length(), "{height} {along} {axis}");
        }
        let [ahead, behind] = [step, -step].map(|step| force(&spring, height, 0.3, at + DVec3::Z * step).0);
        // of sliding the part along the surface is left out
        let difference = (behind.z - ahead.z) / (2.0 * step);
        assert!((slope.z_axis.z / difference - 1.0).abs() < 1e-4, "{height} {along}");
    }
}

/// Where it touches, a spring begins from nothing however fast it comes, and none pulls.
#[test]
fn forces_begin_where_points_touch_and_do_not_pull() {
    let spring = ContactSpring { share: 0.7, damping: 0.5 };
    for from in [0.0, 1e-3, 0.1] {
        let touching = spring.press(&SPRINGS, MASS, 0.0, [-from, TIME]);
        assert!(touching.pressing == 0.0 && touching.slopes[0] > 0.0, "{from}: {touching:?}");
        let deep = spring.press(&SPRINGS, MASS, -1e-12, [-from - 1e-12, TIME]);
        assert!(deep.pressing > 0.0 && deep.pressing < 1e-5, "{from}: {deep:?}");
    }
    let leaving = spring.press(&SPRINGS, MASS, -1e-6, [1e-2, TIME]);
    assert!(leaving.pressing == 0.0 && leaving.slopes == [0.0; 2], "{leaving:?}");
    assert!(spring.press(&SPRINGS, MASS, f64::NAN, [0.0, TIME]).pressing.is_nan());
    assert!(spring.press(&SPRINGS, MASS, -1e-6, [f64::NAN, TIME]).pressing.is_nan());
}
