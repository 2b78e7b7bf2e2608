//! How a scene is stepped in time, or led to rest.

use super::advice::{plain, seconds};
use serde::Serialize;
use sinew::scene::schema::{Analysis, ErrorControl, ImplicitScheme, Load, Scene, SearchMethod, Solver};
use std::fmt;

/// How the motion is found from step to step, or equilibrium.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub enum Method {
    /// Central differences.
    Explicit,
    /// Central differences of masses so many times as large, the step longer by the root of it.
    HeavierMasses(u32),
    /// Steps that solve for their end.
    Implicit {
        /// The formula of a step.
        scheme: ImplicitScheme,
        /// The step (s).
        step: f64,
        /// Whether a step is one Newton iteration.
        linearized: bool,
    },
    /// The same by an estimate of their error.
    Adaptive {
        /// The formula of a step.
        scheme: ImplicitScheme,
        /// The longest step (s).
        step: f64,
        /// The error that steps within the longest one add up to.
        tolerance: f64,
    },
    /// A search for equilibrium.
    Rest(SearchMethod),
}

/// Steps about as long as a frame (s).
const FRAMES: [f64; 4] = [0.02, 0.01, 0.005, 0.002];
/// Where the motion is too short for them: parts of the longest step.
const PARTS: [f64; 4] = [1.0, 2.0, 4.0, 10.0];
/// Errors by which steps are chosen.
const TOLERANCES: [f64; 2] = [1e-2, 1e-3];
/// An implicit step is worth so many explicit ones at least: it takes more passes over all forces than that.
const LEAST: f64 = 4.0;
/// What bodies weigh in units of their mass.
const HEAVIER: [u32; 2] = [4, 16];

impl Method {
    /// That of a scene as it is written.
    pub fn of(scene: &Scene) -> Self {
        match (scene.search().filter(|_| scene.is_static()), &scene.solver) {
            (Some(search), _) => Method::Rest(search.method),
            (None, Solver::Explicit) => Method::Explicit,
            (None, &Solver::Implicit { scheme, step, adaptive: None, newton, .. }) => {
                Method::Implicit { scheme, step, linearized: newton == 1 }
            }
            (None, &Solver::Implicit { scheme, step, adaptive: Some(ErrorControl { tolerance, .. }), .. }) => {
                Method::Adaptive { scheme, step, tolerance }
            }
        }
    }

    /// Whether steps solve for their end.
    pub fn is_implicit(self) -> bool {
        matches!(self, Method::Implicit { .. } | Method::Adaptive { .. })
    }

    /// The formula of implicit steps, and whether they are linearised.
    pub fn formula(self) -> Option<(ImplicitScheme, bool)> {
        match self {
            Method::Implicit { scheme, linearized, .. } => Some((scheme, linearized)),
            Method::Adaptive { scheme, .. } => Some((scheme, false)),
            _ => None,
        }
    }

    /// The longest of its steps (s), where these are implicit.
    pub fn longest_step(self) -> Option<f64> {
        match self {
            Method::Implicit { step, .. } | Method::Adaptive { step, .. } => Some(step),
            _ => None,
        }
    }

    /// The order of its error in the step.
    pub fn order(self) -> i32 {
        let first = self.formula().is_some_and(|(scheme, _)| scheme == ImplicitScheme::Euler);
        if first { 1 } else { 2 }
    }

    /// All methods for a motion of a `duration` (s), of which `stable` is the explicit step (s). A whole number of
    /// implicit steps lies between two of `fields` fields.
    pub fn of_motion(duration: f64, stable: f64, fields: u64) -> Vec<Self> {
        let longest = duration / fields as f64;
        let fits = |step: &f64| *step <= longest * (1.0 + 1e-9) && *step >= LEAST * stable;
        let mut steps: Vec<f64> = FRAMES.into_iter().filter(fits).collect();
        if steps.is_empty() {
            steps = PARTS.map(|parts| longest / parts).into_iter().filter(fits).collect();
        }
        let mut steps: Vec<f64> = steps.into_iter().map(|step| longest / (longest / step - 1e-9).ceil()).collect();
        steps.dedup();
        let generalized = ImplicitScheme::GeneralizedAlpha { high_frequencies: 0.8 };
        let schemes = [(ImplicitScheme::Euler, false), (ImplicitScheme::Euler, true), (generalized, false)];
        let implicit = schemes.into_iter().flat_map(|(scheme, linearized)| {
            steps.iter().map(move |&step| Method::Implicit { scheme, step, linearized })
        });
        let first = steps.first().copied();
        let adaptive = [ImplicitScheme::Euler, generalized].into_iter().flat_map(|scheme| {
            let of = move |tolerance| first.map(|step| Method::Adaptive { scheme, step, tolerance });
            TOLERANCES.into_iter().filter_map(of)
        });
        let heavier = HEAVIER.into_iter().map(Method::HeavierMasses);
        [Method::Explicit].into_iter().chain(heavier).chain(implicit).chain(adaptive).collect()
    }

    /// Gives a scene this method; `step` is the time step (s), `None` to have it found, or to leave an implicit one.
    pub fn apply(self, scene: &mut Scene, step: Option<f64>) {
        match self {
            Method::Rest(method) => {
                if let Analysis::Static(search) = &mut scene.analysis {
                    search.method = method;
                }
                scene.integration.step = step;
            }
            Method::Explicit => (scene.solver, scene.integration.step) = (Solver::Explicit, step),
            Method::HeavierMasses(times) => {
                (scene.solver, scene.integration.step) = (Solver::Explicit, step);
                make_heavier(scene, f64::from(times));
            }
            Method::Implicit { scheme, step: own, linearized } => {
                scene.integration.step = None;
                scene.integration.when_unstable = None;
                scene.solver = implicit(&scene.solver, scheme, (step.unwrap_or(own), None), linearized);
            }
            Method::Adaptive { scheme, step: own, tolerance } => {
                scene.integration.step = None;
                scene.integration.when_unstable = None;
                let step = step.unwrap_or(own);
                // steps become shorter with the longest one where the error does by their order, and the tolerance is
                // that of a time so much shorter
                let tolerance = tolerance * (step / own).powi(self.order() + 1);
                scene.solver = implicit(&scene.solver, scheme, (step, Some(tolerance)), false);
            }
        }
    }
}

/// Multiplies all masses; weights and damping forces stay what they were.
fn make_heavier(scene: &mut Scene, times: f64) {
    for material in scene.materials.values_mut() {
        material.density *= times;
        material.damping = material.damping.map(|rate| rate / times);
    }
    for load in &mut scene.loads {
        if let Load::Gravity { acceleration, .. } = load {
            *acceleration /= times;
        }
    }
}

/// Newton iterations of a step at most, a scene's own default.
const NEWTON: u32 = 20;
/// The residual at which a step is solved, a scene's own default.
const TOLERANCE: f64 = 1e-3;

/// Implicit steps, with what the scene says of them itself.
fn implicit(
    written: &Solver,
    scheme: ImplicitScheme,
    (step, tolerance): (f64, Option<f64>),
    linearized: bool,
) -> Solver {
    let asked = match written {
        Solver::Implicit { adaptive, .. } => *adaptive,
        Solver::Explicit => None,
    };
    let asked = asked.unwrap_or(ErrorControl { tolerance: 0.0, displacement: None, smallest: None });
    let adaptive = tolerance.map(|tolerance| ErrorControl { tolerance, ..asked });
    let (newton, tolerance, preconditioner, budget) = match written {
        Solver::Implicit { newton, tolerance, preconditioner, budget, .. } => {
            (*newton, *tolerance, *preconditioner, *budget)
        }
        Solver::Explicit => (NEWTON, TOLERANCE, Default::default(), None),
    };
    let newton = match (linearized, newton) {
        (true, _) => 1,
        (false, 1) => NEWTON,
        (false, most) => most,
    };
    Solver::Implicit { scheme, step, adaptive, newton, tolerance, preconditioner, budget }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Method::Explicit => f.write_str("explicit"),
            Method::HeavierMasses(times) => write!(f, "masses ×{times}"),
            Method::Rest(SearchMethod::Relaxation) => f.write_str("relaxation"),
            Method::Rest(SearchMethod::Newton) => f.write_str("Newton"),
            Method::Implicit { scheme, step, linearized } => {
                let once = if linearized { ", linearised" } else { "" };
                write!(f, "{} {}{once}", name(scheme), plain(&seconds(step)))
            }
            Method::Adaptive { scheme, step, tolerance } => {
                write!(f, "{} to {tolerance:e} in {}", name(scheme), plain(&seconds(step)))
            }
        }
    }
}

fn name(scheme: ImplicitScheme) -> &'static str {
    match scheme {
        ImplicitScheme::Euler => "implicit Euler",
        ImplicitScheme::GeneralizedAlpha { .. } => "generalised-α",
    }
}
