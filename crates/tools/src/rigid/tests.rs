use super::*;

fn top() -> (Inertia, RigidMotion) {
    let inertia = Inertia::new(2.0, DVec3::ZERO, DMat3::from_diagonal(DVec3::new(1.0, 2.0, 3.5)));
    let turn = DQuat::from_scaled_axis(DVec3::new(0.3, -0.8, 0.5));
    // near the middle axis, about which nothing keeps on turning
    let momentum = turn * (inertia.moments * DVec3::new(0.05, 1.0, 0.02));
    (inertia, RigidMotion { place: DVec3::ZERO, turn, velocity: DVec3::X, momentum })
}

fn run(steps: usize, time: f64) -> (RigidMotion, f64) {
    let (inertia, mut motion) = top();
    let (energy, mut worst) = (motion.kinetic(&inertia), 0.0_f64);
    for _ in 0..steps {
        motion = motion.after(time / steps as f64, &inertia);
        worst = worst.max((motion.kinetic(&inertia) / energy - 1.0).abs());
    }
    (motion, worst)
}

#[test]
fn a_top_that_nothing_turns_keeps_its_energy_and_tumbles_by_the_second_order() {
    // angular momentum is not touched; the energy says that it is that of the body as it is turned
    let (_, off) = run(20_000, 40.0);
    assert!(off < 1e-11, "energy is off by {off:.1e}");
    let reference = run(64_000, 20.0).0.turn;
    let errors = [500, 1000, 2000].map(|steps| run(steps, 20.0).0.turn.angle_between(reference));
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 2.0).abs() < 0.15, "of order {order}: {errors:?}");
    }
    // half round about the middle axis, it has tumbled
    let (_, start) = top();
    assert!(errors[2] < 1e-2 && reference.angle_between(start.turn) > 0.1, "{errors:?}");
}

#[test]
fn a_step_back_undoes_a_step() {
    let (inertia, start) = top();
    let back = start.after(0.1, &inertia).after(-0.1, &inertia);
    assert!(back.turn.angle_between(start.turn) < 1e-7 && back.place.length() < 1e-16, "{back:?}");
    assert!((back.turn.xyz() - start.turn.xyz()).length() < 1e-15, "{back:?}");
}

#[test]
fn a_body_that_turns_about_a_main_axis_turns_by_its_spin() {
    let inertia = Inertia::new(1.0, DVec3::ZERO, DMat3::from_diagonal(DVec3::new(1.0, 2.0, 4.0)));
    let start =
        RigidMotion { place: DVec3::ZERO, turn: DQuat::IDENTITY, velocity: DVec3::ZERO, momentum: 4.0 * DVec3::Z };
    let mut motion = start;
    (0..1000).for_each(|_| motion = motion.after(1e-3, &inertia));
    // an angle of 2 atan(ω Δt/2) a step: short of ω Δt by its cube's twelfth
    let angle = 2000.0 * (0.5e-3_f64).atan();
    assert!(motion.turn.angle_between(DQuat::from_rotation_z(angle)) < 1e-7, "{motion:?}");
    assert!((motion.turn.z - (0.5 * angle).sin()).abs() < 1e-12, "{motion:?}");
}
