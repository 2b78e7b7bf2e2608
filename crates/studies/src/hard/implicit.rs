//! What a hard case means under implicit steps.

/// How a case runs by implicit steps, or why it does not.
#[derive(Clone, Copy, Debug)]
pub enum Implicitly {
    /// With this put into its scene, and without the scene's `integration`, which is that of explicit steps.
    By(&'static str),
    /// It has no meaning there, and why.
    NotMeant(&'static str),
}

/// Implicit Euler by frames of 10 ms, as a scene has it that says no more.
pub const FRAMES: Implicitly = Implicitly::By("solver=Implicit(tolerance: 1e-6)");

/// What moves quickly: implicit Euler by steps of 1 ms.
pub const SHORT: Implicitly = Implicitly::By("solver=Implicit(step: 0.001, tolerance: 1e-8)");

/// Implicit Euler by steps of 1 ms, to the tolerance that steps have which say no more.
pub const LOOSE: Implicitly = Implicitly::By("solver=Implicit(step: 0.001)");

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

/// What a scene of contact says.
pub const CONTACT: Implicitly =
    Implicitly::NotMeant("its contact is kinematic, a correction of explicit steps that implicit ones do not have");

/// What a system of the case's own writes on the host.
pub const ON_HOST: Implicitly =
    Implicitly::NotMeant("its system writes on the host, and implicit steps would call it many times a step");

/// What is about the longest stable step.
pub const STABLE_STEP: Implicitly =
    Implicitly::NotMeant("it is about the longest stable step, and implicit steps have none");
