//! The whole scene, its time step, its guards.

use super::{
    Accuracy, Analysis, Attachment, Body, Constraint, Contact, ContactLaw, Curve, EquilibriumSearch, InitialState,
    Load, Material, Output, OwnSystem, Part, Picture, Probe, Removal, SearchMethod, Solver, Suction, Tool, When,
};
use crate::scene::syntax::Path;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A whole scene.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// What the scene shows, in a few words.
    #[serde(default)]
    pub title: String,
    /// Simulated time (s); the time whose loads and motions a static analysis takes. A file without it may be
    /// a part of a scene: see `parts`.
    pub duration: f64,
    /// Motion over time, or rest under what acts at the end.
    #[serde(default)]
    pub analysis: Analysis,
    /// How the motion is found from step to step.
    #[serde(default)]
    pub solver: Solver,
    /// How bodies stand when the motion begins.
    #[serde(default)]
    pub start: InitialState,
    /// What stands in files of its own, by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub parts: BTreeMap<String, Part>,
    /// The bodies, by name.
    #[serde(default)]
    pub bodies: BTreeMap<String, Body>,
    /// The materials, by name.
    #[serde(default)]
    pub materials: BTreeMap<String, Material>,
    /// What holds or moves nodes.
    #[serde(default)]
    pub constraints: Vec<Constraint>,
    /// What pushes and pulls.
    #[serde(default)]
    pub loads: Vec<Load>,
    /// Rigid tools, by name.
    #[serde(default)]
    pub tools: BTreeMap<String, Tool>,
    /// What touches what.
    #[serde(default)]
    pub contacts: Vec<Contact>,
    /// Tools that suck.
    #[serde(default)]
    pub suction: Vec<Suction>,
    /// What holds what.
    #[serde(default)]
    pub attachments: Vec<Attachment>,
    /// Loads of your own in WGSL, by the name of their function.
    #[serde(default)]
    pub systems: BTreeMap<String, OwnSystem>,
    /// Which elements go, and when.
    #[serde(default)]
    pub removal: Vec<Removal>,
    /// What to observe, by name.
    #[serde(default)]
    pub probes: BTreeMap<String, Probe>,
    /// The time step and how it is taken.
    #[serde(default)]
    pub integration: Integration,
    /// Systems in the order they run in each step; left out, it is derived from what the scene contains.
    #[serde(default)]
    pub schedule: Option<Vec<String>>,
    /// Whether the motion goes as fast as life: a second of it takes a second, or longer where steps do.
    #[serde(default)]
    pub real_time: bool,
    /// Whether neighbouring systems that work node by node share a pass.
    #[serde(default = "yes")]
    pub fuse: bool,
    /// Parameters of custom systems, by the system's name.
    #[serde(default)]
    pub parameters: BTreeMap<String, ron::Value>,
    /// What is written, and how often.
    #[serde(default)]
    pub output: Output,
    /// What is looked at during a run, and what ends it.
    #[serde(default)]
    pub guards: Guards,
    /// How `sinew render` draws the scene.
    #[serde(default)]
    pub picture: Picture,
    /// What `sinew accuracy` measures the scene against.
    #[serde(default)]
    pub accuracy: Accuracy,
}

fn yes() -> bool {
    true
}

/// The time step and how it is taken.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub struct Integration {
    /// The step (s); left out: the stable step times `safety`.
    pub step: Option<f64>,
    /// Share of the stable step that is taken.
    pub safety: f64,
    /// What the stable step is found from.
    pub bound: StepBound,
    /// What is done when deformation makes the stable step smaller than the step. `Adapt` when left out; `Watch` where
    /// a scene insists on a step beyond the stable one.
    pub when_unstable: Option<WhenUnstable>,
    /// Take a `step` beyond the stable one all the same. The guards watch it, and cannot be switched off.
    pub beyond_stable_step: bool,
    /// Sum displacements with compensation: three numbers a node more, and f32 keeps the digits that plain sums lose.
    pub compensated: bool,
}

impl Default for Integration {
    fn default() -> Self {
        Self {
            step: None,
            safety: 0.9,
            bound: StepBound::default(),
            when_unstable: None,
            beyond_stable_step: false,
            compensated: true,
        }
    }
}

/// What the stable step is found from.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize, PartialEq, Eq)]
pub enum StepBound {
    /// The larger of the step that is certain by elements and nodes and that by the highest frequency, which is found
    /// as well as is worth it, where the step adapts; else that of the stiffest element.
    #[default]
    Auto,
    /// The stiffest element alone: certain, and many times smaller than need be where elements differ.
    Elements,
    /// The highest frequency of all bodies as they are held, by Lanczos' recursion.
    Iterated,
}

/// What is done when deformation makes the stable step smaller than the step.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum WhenUnstable {
    /// The step becomes smaller, and larger again when it may.
    #[default]
    Adapt,
    /// The step stays; the run tells, and the guards stop it where it breaks down.
    Watch,
    /// Elements that need a smaller step are made heavier, at the start and during the run.
    ScaleMass {
        /// Share of the mass that may be added: more is an error at the start and ends a run. Without `step` the step
        /// is as large as this allows.
        #[serde(default = "most_added_mass")]
        most: f64,
    },
    /// Elements that need a smaller step are removed.
    Remove,
}

fn most_added_mass() -> f64 {
    0.05
}

/// What is looked at during a run, and what ends it.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub struct Guards {
    /// Steps between two checks of energies and elements; numbers that are not finite and elements turned inside out
    /// are looked for in every step.
    pub every: u64,
    /// Limits of the balance of energy.
    pub energy: EnergyGuard,
    /// Energy in hourglass control of a part that is warned of, as a share of the part's largest elastic energy so far.
    pub hourglass: f64,
    /// Guards that do not check.
    pub off: Vec<Guard>,
    /// States that are kept in memory, and written when the run breaks down.
    pub window: u64,
}

/// Limits of the balance of energy, as shares of the largest energy so far.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub struct EnergyGuard {
    /// What is warned of, made or lost.
    pub warn: f64,
    /// What ends the run, made out of nothing.
    pub stop: f64,
}

/// A guard that may be switched off.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq, Eq)]
pub enum Guard {
    /// The balance of energy.
    Energy,
    /// Energy in hourglass control.
    Hourglass,
}

impl Default for Guards {
    fn default() -> Self {
        Self { every: 256, energy: EnergyGuard::default(), hourglass: 0.1, off: Vec::new(), window: 3 }
    }
}

impl Default for EnergyGuard {
    fn default() -> Self {
        Self { warn: 0.01, stop: 0.05 }
    }
}

impl Scene {
    /// Whether anything of the scene is done with a tool.
    pub(crate) fn uses(&self, tool: &str) -> bool {
        let touches = |contact: &Contact| matches!(contact, Contact::Tool { tool: of, .. } if of == tool);
        self.contacts.iter().any(touches)
            || self.removal.iter().any(|removal| removal.when.tool().is_some_and(|of| of == tool))
            || self.suction.iter().any(|suction| suction.tool == tool)
            || self.attachments.iter().any(|attachment| attachment.tool().is_some_and(|of| of == tool))
    }

    /// Time between outputs of fields (s).
    pub fn fields_every(&self) -> f64 {
        let whole = if self.is_static() { self.duration } else { self.duration / 20.0 };
        self.output.fields_every.unwrap_or(whole)
    }

    /// What is done when deformation makes the stable step smaller than the step.
    pub fn when_unstable(&self) -> WhenUnstable {
        let insists = self.integration.beyond_stable_step;
        self.integration.when_unstable.unwrap_or(if insists { WhenUnstable::Watch } else { WhenUnstable::Adapt })
    }

    /// The body that is meant where this one is named, or none: then the only one.
    pub(crate) fn body_meant<'a>(&'a self, named: &'a Option<String>) -> Option<&'a String> {
        named.as_ref().or(self.bodies.keys().next())
    }

    /// Whether a body may lose elements.
    pub fn may_lose_elements(&self, body: &str) -> bool {
        let material = |name: &String| self.materials.get(name).map(|material| material.inversion());
        let of_body = self.bodies.get(body).into_iter();
        let mut materials = of_body
            .flat_map(|body| std::iter::once(&body.material).chain(body.regions.iter().map(|region| &region.material)));
        self.removal.iter().any(|removal| removal.body.as_deref().is_none_or(|name| name == body))
            || self.when_unstable() == WhenUnstable::Remove
            || materials.any(|name| material(name) == Some(super::Inversion::Remove))
    }

    /// Whether elements are made heavier.
    pub fn scales_mass(&self) -> bool {
        matches!(self.when_unstable(), WhenUnstable::ScaleMass { .. }) && !self.is_static()
    }

    /// All courses in time, with the ways to them.
    pub fn curves(&self) -> Vec<(Path, &Curve)> {
        let to = |list: &str| Path::default().name(list);
        let constraints = self.constraints.iter().enumerate();
        let constraints = constraints.filter_map(|(i, moved)| Some((to("constraints").index(i), moved.curve()?)));
        let loads = self.loads.iter().enumerate().map(|(i, load)| (to("loads").index(i), load.curve()));
        let systems = self.systems.iter().map(|(name, system)| (to("systems").name(name), &system.curve));
        let moves = self.tools.iter().flat_map(|(name, tool)| {
            let path = move |number| to("tools").name(name).name("moves").index(number);
            tool.moves.iter().enumerate().map(move |(number, part)| (path(number), &part.curve))
        });
        let removals = self.removal.iter().enumerate().filter_map(|(i, removal)| match &removal.when {
            When::InTool { curve, .. } => Some((to("removal").index(i).name("when"), curve)),
            _ => None,
        });
        let suction = self.suction.iter().enumerate().map(|(i, suction)| (to("suction").index(i), &suction.curve));
        let all = constraints.chain(loads).chain(systems).chain(moves).chain(removals).chain(suction);
        let all = all.map(|(path, curve)| (path.name("curve"), curve));
        let attachments = self.attachments.iter().enumerate();
        let attachments = attachments.filter_map(|(number, attachment)| {
            let (word, curve) = attachment.curve()?;
            Some((to("attachments").index(number).name(word), curve))
        });
        all.chain(attachments).collect()
    }

    /// Whether tools, other bodies or what is attached put forces on nodes.
    pub fn has_tools_that_push(&self) -> bool {
        !self.contacts.is_empty() || !self.suction.is_empty() || !self.attachments.is_empty()
    }

    /// Whether steps of the motion are implicit.
    pub fn is_implicit(&self) -> bool {
        matches!(self.solver, Solver::Implicit { .. }) && !self.is_static()
    }

    /// How equilibrium is sought instead of motion, or before it.
    pub fn search(&self) -> Option<EquilibriumSearch> {
        match (self.analysis, self.start) {
            (Analysis::Static(search), _) | (Analysis::Transient, InitialState::Equilibrium(search)) => Some(search),
            (Analysis::Transient, InitialState::Undeformed) => None,
        }
    }

    /// Whether the motion is none, and Newton's iterations seek equilibrium.
    pub fn is_static_by_newton(&self) -> bool {
        matches!(self.analysis, Analysis::Static(search) if search.method == SearchMethod::Newton)
    }

    /// Whether rest is sought along a path of equilibria.
    pub fn follows_path(&self) -> bool {
        matches!(self.analysis, Analysis::Static(EquilibriumSearch { arc: Some(_), .. }))
    }

    /// Whether contact at rest is that of springs: where Newton's iterations seek it, or one contact is a spring.
    pub fn rests_on_springs(&self) -> bool {
        let is_spring = |contact: &Contact| contact.law() != ContactLaw::Kinematic;
        self.is_static()
            && (self.contacts.iter().any(is_spring) || self.is_static_by_newton() && !self.attachments.is_empty())
    }

    /// Whether bodies may touch something, or be held by a tool, in a motion.
    pub fn touches(&self) -> bool {
        !self.is_static() && (!self.contacts.is_empty() || !self.tools.is_empty())
    }

    /// Whether equilibrium is sought instead of motion.
    pub fn is_static(&self) -> bool {
        matches!(self.analysis, Analysis::Static(_))
    }
}
