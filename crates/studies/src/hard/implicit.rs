//! What a hard case means under implicit steps.

/// How a case runs by implicit steps, or why it does not.
#[derive(Clone, Copy, Debug)]
pub enum Implicitly {
    /// With this put into its scene, and without the scene's `integration`, which is that of explicit steps.
    By(&'static str),
    /// The same, with springs of this share in place of the kinematic law of all its contacts.
    BySprings(&'static str, f64),
    /// It has no meaning there, and why.
    NotMeant(&'static str),
}

/// Implicit Euler by frames of 10 ms, as a scene has it that says no more.
pub const FRAMES: Implicitly = Implicitly::By("solver=Implicit(tolerance: 1e-6)");

/// What moves quickly: implicit Euler by steps of 1 ms.
pub const SHORT: Implicitly = Implicitly::By("solver=Implicit(step: 0.001, tolerance: 1e-8)");

/// The trapezoidal rule, which keeps energy, by steps of .1 ms.
pub const KEEPING: Implicitly =
    Implicitly::By("solver=Implicit(scheme: GeneralizedAlpha(high_frequencies: 1), step: 1e-4, tolerance: 1e-8)");

/// The same by steps of 1 ms, for what turns.
pub const TURNING: Implicitly =
    Implicitly::By("solver=Implicit(scheme: GeneralizedAlpha(high_frequencies: 1), step: 0.001, tolerance: 1e-8)");

/// Implicit Euler by steps of .1 ms, as long as those of the case's explicit scene.
pub const FINE: Implicitly = Implicitly::By("solver=Implicit(step: 1e-4, tolerance: 1e-8)");

/// Implicit Euler by steps of 10 µs, for what is over in 3 ms.
pub const IMPACT: Implicitly = Implicitly::By("solver=Implicit(step: 1e-5, tolerance: 1e-6)");

/// Rest by Newton's iterations.
pub const NEWTON: Implicitly = Implicitly::By("analysis=Static(method: Newton)");

/// Contact by frames of 10 ms, of springs ten times as stiff as explicit steps could have them.
pub const TOUCHING: Implicitly = Implicitly::BySprings("solver=Implicit(tolerance: 1e-6)", 10.0);

/// The same by steps of 1 ms.
pub const SLIDING: Implicitly = Implicitly::BySprings("solver=Implicit(step: 0.001, tolerance: 1e-6)", 10.0);

/// What meets and parts, by the trapezoidal rule in steps of .1 ms, of springs as stiff as elements.
pub const MEETING: Implicitly = Implicitly::BySprings(
    "solver=Implicit(scheme: GeneralizedAlpha(high_frequencies: 1), step: 1e-4, tolerance: 1e-8)",
    1.0,
);

/// Rest in contact by Newton's iterations.
pub const PRESSED: Implicitly = Implicitly::BySprings("analysis=Static(method: Newton)", 10.0);

/// What is about the kinematic law.
pub const KINEMATIC: Implicitly =
    Implicitly::NotMeant("it is about what the kinematic law takes in a step, which implicit steps do not have");

/// What is about the stiffest spring.
pub const STIFFEST: Implicitly =
    Implicitly::NotMeant("it is about the stiffest spring of a stable step, and implicit steps have no such bound");

/// What is faster than contact is looked for.
pub const TOO_FAST: Implicitly =
    Implicitly::NotMeant("it is about how far a needle goes in a stable step; implicit ones refuse half an edge");

/// What sucks.
pub const SUCTION: Implicitly = Implicitly::NotMeant("suction takes no part in implicit steps");

/// What a system of the case's own writes on the host.
pub const ON_HOST: Implicitly =
    Implicitly::NotMeant("its system writes on the host, and implicit steps would call it many times a step");

/// What is about the longest stable step.
pub const STABLE_STEP: Implicitly =
    Implicitly::NotMeant("it is about the longest stable step, and implicit steps have none");
