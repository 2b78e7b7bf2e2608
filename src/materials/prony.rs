//! Viscosity: stress relaxes in exponentials.

use crate::math::{Real, Sym3};

/// One term of a Prony series: the share α of a stress relaxes with the time τ. The stress is S_iso, or the pressure,
/// whose history is one number a term.
///
/// S_iso is reduced by Υ, and six numbers q a term carry the history (Comas et al. 2008, eqs. 1 to 4; the WGSL
/// twin is `shaders/prony.wgsl`). Both integrators are the same linear recursion with other coefficients:
/// Υ = `stress`·S + `memory`·q, then q ← q + `rate`·(`aim`·S − q). The increment form keeps the digits of a small
/// step, but f32 stalls when the increment falls under one ulp of q: the long-term stress is then off by up to 1e-4.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct PronyTerm<T> {
    /// Part of the present stress in Υ.
    pub stress: T,
    /// Part of the memory in Υ.
    pub memory: T,
    /// How much of the way to its aim the memory goes in a step.
    pub rate: T,
    /// What the memory goes to, in units of the present stress.
    pub aim: T,
}

impl PronyTerm<f64> {
    /// The exact recursion for a stress that is linear within each step (second order): with h = Δt/τ and
    /// φ = (1 − e^(−h))/h: Υ = α(S − q − φS), q ← e^(−h) q − φ(1 − e^(−h)) S.
    pub fn exact(alpha: f64, tau: f64, time_step: f64) -> Self {
        let h = time_step / tau;
        let rate = -(-h).exp_m1();
        let phi = rate / h;
        // 1 − φ by its series where the difference would lose digits
        let complement = if h < 1e-3 { h / 2.0 - h * h / 6.0 + h * h * h / 24.0 } else { 1.0 - phi };
        Self { stress: alpha * complement, memory: -alpha, rate, aim: -phi }
    }

    /// The paper's eq. 4, backward Euler on τΥ̇ + Υ = αS (first order, L-stable); q is Υ itself. Its error after a step
    /// strain is at most 0.184 αΔt/τ of the stress.
    pub fn backward_euler(alpha: f64, tau: f64, time_step: f64) -> Self {
        let rate = time_step / (time_step + tau);
        Self { stress: rate * alpha, memory: tau / (time_step + tau), rate, aim: alpha }
    }

    /// Damping proportional to stiffness, written as a term: −Υ = (β/Δt)(S − q), q the stress of the step before. So S
    /// − Υ = S + β Ṡ, the rate taken over the last step.
    pub fn damping(beta: f64, time_step: f64) -> Self {
        Self { stress: -beta / time_step, memory: beta / time_step, rate: 1.0, aim: 1.0 }
    }

    /// Whether it is one of [`damping`](Self::damping): those of viscosity take from the stress.
    pub fn is_damping(&self) -> bool {
        self.stress < 0.0
    }

    /// Adds so many `times` the stress to the memory and takes nothing from the stress: q ← q + r((times/r) S − q),
    /// with r = 2⁻⁶⁰ so small that q itself stays as it is in f64.
    pub fn adding(times: f64) -> Self {
        let rate = 2.0_f64.powi(-60);
        Self { stress: 0.0, memory: 0.0, rate, aim: times / rate }
    }

    /// Carries a memory on that one term took from the stress with, so that another takes as much of the present one:
    /// s S + m q = s' S + m' q'.
    pub(crate) fn keeping(before: &Self, after: &Self) -> Self {
        let times = (before.stress - after.stress) / after.memory;
        match 1.0 - before.memory / after.memory {
            0.0 => Self::adding(times),
            rate => Self { stress: 0.0, memory: 0.0, rate, aim: times / rate },
        }
    }

    /// What has relaxed after a long time, Υ = αS, whatever the history; q stays as it is.
    pub fn long_term(alpha: f64) -> Self {
        Self { stress: alpha, memory: 0.0, rate: 0.0, aim: 0.0 }
    }
}

impl<R: Real> PronyTerm<R> {
    /// The same term over other numbers.
    #[inline(always)]
    pub fn map<Q: Real>(&self, number: impl Fn(R) -> Q) -> PronyTerm<Q> {
        PronyTerm {
            stress: number(self.stress),
            memory: number(self.memory),
            rate: number(self.rate),
            aim: number(self.aim),
        }
    }

    /// Υ (Pa) of one component of a stress, or of a pressure.
    #[inline(always)]
    pub fn relaxed_component(&self, stress: R, memory: R) -> R {
        self.stress.mul_add(stress, self.memory * memory)
    }

    /// The memory of one component after the step.
    #[inline(always)]
    pub fn component_carried_on(&self, stress: R, memory: R) -> R {
        self.rate.mul_add(self.aim.mul_add(stress, -memory), memory)
    }

    /// Υ of this term (Pa) for the present isochoric stress and memory.
    #[inline(always)]
    pub fn relaxed(&self, isochoric: &Sym3<R>, memory: &Sym3<R>) -> Sym3<R> {
        let mut relaxed = *memory;
        for i in 0..6 {
            relaxed.0[i] = self.relaxed_component(isochoric.0[i], memory.0[i]);
        }
        relaxed
    }

    /// The memory after the step.
    #[inline(always)]
    pub fn carried_on(&self, isochoric: &Sym3<R>, memory: &Sym3<R>) -> Sym3<R> {
        let mut carried_on = *memory;
        for i in 0..6 {
            carried_on.0[i] = self.component_carried_on(isochoric.0[i], memory.0[i]);
        }
        carried_on
    }
}
