//! What a run amounted to.

use super::{Job, Simulation};
use crate::backend::device::{Device, Traffic};
use crate::components::*;
use crate::error::Error;
use crate::evaluation::BlockView;
use crate::observation::Observer;
use crate::scene::schema::Inversion;
use bevy_ecs::prelude::*;
use serde::Serialize;
use std::collections::BTreeMap;

/// What a run amounted to; `summary.json` is this.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// The version of sinew.
    pub version: &'static str,
    /// The scene's title.
    pub title: String,
    /// Where it ran.
    pub backend: String,
    /// Why there.
    pub backend_because: String,
    /// `f32` or `f64`.
    pub precision: &'static str,
    /// Nodes of all bodies.
    pub nodes: usize,
    /// Elements of all bodies at the start.
    pub elements: usize,
    /// The step up to which the run is stable at the start (s), by what `integration.bound` says.
    pub stable_step: f64,
    /// The stiffest element: body and author's number.
    pub stable_step_element: (String, u64),
    /// What is known of the stable step at the start: the bound, the elements that set it, the true limit.
    pub stability: super::Stability,
    /// Δt at the end (s).
    pub time_step: f64,
    /// The first step over the true limit at the start; `None` in a static analysis.
    pub share_of_limit: Option<f64>,
    /// How the step went during the run; `None` in a static analysis.
    pub step_history: Option<super::StepHistory>,
    /// Steps taken.
    pub steps: u64,
    /// Steps that the scene lasts.
    pub planned_steps: u64,
    /// The time of the snapshot that the run has gone on from (s).
    pub resumed_at: Option<f64>,
    /// Simulated time (s).
    pub simulated: f64,
    /// Time from the scene to the first step (s).
    pub setup_seconds: f64,
    /// Time from the first step to the last, solving and writing (s).
    pub run_seconds: f64,
    /// Of it what steps took, guards and stability checks included (s).
    pub solving_seconds: f64,
    /// Of it what observing and writing took: tables, fields, snapshots, `nodes.csv` (s).
    pub writing_seconds: f64,
    /// Solving time over simulated time; below 1 is faster than real time (in an [`Advanced`](super::Advanced) it is
    /// the other way round).
    pub real_time_factor: f64,
    /// How long frames of 10 ms of life took.
    pub frames: Option<super::Frames>,
    /// Solving time a step (s).
    pub seconds_a_step: f64,
    /// Solving time an element and step (ns).
    pub nanoseconds_an_element_and_step: f64,
    /// The systems in their order.
    pub systems: Vec<SystemTime>,
    /// What travelled between host and device.
    pub traffic: Option<Traffic>,
    /// What implicit steps took; `None` where steps are explicit.
    pub implicit: Option<super::ImplicitSteps>,
    /// The equilibrium of a static analysis.
    pub equilibrium: Option<super::Equilibrium>,
    /// What bringing the bodies to rest before the first step took; `None` where that was not asked for, and in a run
    /// that has gone on from a snapshot.
    pub preload: Option<super::Preload>,
    /// Energies at the end (J).
    pub energies: Energies,
    /// Mass at the start (kg).
    pub mass: f64,
    /// Mass taken out with removed elements (kg).
    pub removed_mass: f64,
    /// Momentum that went with them (kg m/s).
    pub removed_momentum: glam::DVec3,
    /// Elements removed.
    pub removed_elements: usize,
    /// Of each block whose elements were turned inside out and recover: who, and whether some still are.
    pub inversions: Vec<Inversions>,
    /// What each probe saw last: time (s) and values.
    pub probes: BTreeMap<String, (f64, Vec<f64>)>,
    /// What each tool feels at the end.
    pub tools: BTreeMap<String, crate::observation::ToolReading>,
    /// What each body feels of others and itself at the end, where they may touch.
    pub contacts: BTreeMap<String, crate::observation::ContactReading>,
    /// What keeping surfaces apart took; `None` where none may meet.
    pub surface_contact: Option<super::SurfaceContactUse>,
    /// What sutures, ties and glue bear at the end, by their names.
    pub attachments: BTreeMap<String, crate::observation::AttachmentReading>,
    /// What came through the ports of tools.
    pub ports: BTreeMap<String, super::PortUse>,
    /// How the run kept up with life, where the scene has `real_time`.
    pub real_time: Option<super::RealTime>,
    /// What the guards have seen and warned of.
    pub guards: GuardMemory,
    /// How it broke down, if it did.
    pub failure: Option<crate::Instability>,
    /// How it ended: `finished`, `interrupted`, or what went wrong.
    pub ended: String,
    /// Who has which number in the files, and what their columns are.
    pub names: super::names::Names,
    /// The unit of each number of this summary that is no count, by its place: `energies.kinetic` is in J.
    pub units: BTreeMap<&'static str, &'static str>,
    /// The scene with all its values, those that were left out too.
    pub parameters: serde_json::Value,
}

/// Elements of a block that were turned inside out in a run and are left to recover.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Inversions {
    /// The body.
    pub body: String,
    /// One of them, by the author's number.
    pub element: u64,
    /// How many are inside out at the end.
    pub left: usize,
}

fn inversions(world: &mut World) -> Result<Vec<Inversions>, Error> {
    crate::backend::device::bring_to_host(world, |_, name| name == FirstInverted::NAME || name == Displacement::NAME)?;
    let mut query = world.query::<(Entity, &FirstInverted, &OnInversion)>();
    let recovering = query.iter(world).filter(|(.., policy)| policy.0 == Inversion::Recover);
    let mut noted: Vec<(Entity, u32)> = recovering.map(|(entity, first, _)| (entity, first[0])).collect();
    noted.retain(|&(_, row)| row != u32::MAX);
    noted.sort_unstable();
    let found = noted.into_iter().filter_map(|(entity, row)| {
        let view = BlockView::now(world, entity)?;
        let authoring = world.get::<Authoring>(view.block.body)?;
        let place = authoring.blocks.iter().position(|&block| block == entity)?;
        Some(Inversions {
            body: world.get::<Label>(view.block.body)?.0.clone(),
            element: authoring.element_id(place, row as usize),
            left: (0..view.block.count).filter(|&row| view.element(row).is_inverted()).count(),
        })
    });
    Ok(found.collect())
}

/// A system's share of a run.
#[derive(Clone, Debug, Serialize)]
pub struct SystemTime {
    /// The system.
    pub name: String,
    /// Why it is there.
    pub because: String,
    /// `host` or `device`.
    pub on: &'static str,
    /// Time on the host without observing and writing (s); kernels run beside it and are not timed here.
    pub seconds: Option<f64>,
    /// How often it ran on the host.
    pub runs: Option<u64>,
    /// Columns brought to the host for it in a GPU run.
    pub brought: Vec<&'static str>,
    /// Columns sent back to the device after it.
    pub sent: Vec<&'static str>,
}

impl Simulation {
    /// What the run amounted to so far. `ended` is how.
    ///
    /// # Errors
    /// What the GPU says.
    pub fn summary(&mut self, ended: &str) -> Result<Summary, Error> {
        let energies = self.energies()?;
        let mass = crate::observation::mass(&mut self.world)?;
        crate::backend::device::bring_to_host(&mut self.world, |_, name| name == Alive::NAME)?;
        let removed: usize = self
            .world
            .query::<(&Block, &Alive)>()
            .iter(&self.world)
            .map(|(block, alive)| alive[..block.count].iter().filter(|&&alive| alive == 0).count())
            .sum();
        let (steps, run) = (self.step_count(), self.elapsed.as_secs_f64());
        let writing = self.world.resource::<Observer>().writing.as_secs_f64();
        let solving = self.solving().as_secs_f64();
        let (first, since) = self.began;
        let a_step = solving / steps.saturating_sub(first).max(1) as f64;
        let names: Vec<String> = self.scene.tools.keys().cloned().collect();
        let mut tools = BTreeMap::new();
        for name in names {
            let reading = crate::observation::read_tool(&mut self.world, &name)?;
            tools.insert(name, reading);
        }
        let mut contacts = BTreeMap::new();
        for name in self.scene.bodies.keys().cloned().collect::<Vec<_>>() {
            let body = self.body(&name)?;
            contacts.extend(crate::observation::read_contact(&mut self.world, body)?.map(|reading| (name, reading)));
        }
        let facts = &self.facts;
        Ok(Summary {
            version: env!("CARGO_PKG_VERSION"),
            title: self.scene.title.clone(),
            backend: facts.backend.clone(),
            backend_because: facts.why.clone(),
            precision: match facts.precision {
                Precision::F32 => "f32",
                Precision::F64 => "f64",
            },
            nodes: facts.nodes,
            elements: facts.elements,
            stable_step: facts.stability.stable_step,
            stable_step_element: facts.stability.bound.critical(),
            stability: facts.stability.clone(),
            time_step: self.time_step(),
            share_of_limit: facts.stability.limit.map(|limit| facts.stability.step / limit),
            step_history: self.step_history().copied(),
            steps,
            planned_steps: facts.steps,
            resumed_at: (first > 0).then_some(since),
            simulated: self.time(),
            setup_seconds: facts.setup.as_secs_f64(),
            run_seconds: run,
            solving_seconds: solving,
            writing_seconds: writing,
            real_time_factor: solving / (self.time() - since).max(f64::MIN_POSITIVE),
            frames: self.frames(),
            seconds_a_step: a_step,
            nanoseconds_an_element_and_step: a_step * 1e9 / facts.elements.max(1) as f64,
            systems: self.entries.iter().map(|entry| system_time(entry, &self.plan, facts.on_gpu)).collect(),
            traffic: self.world.get_resource::<Device>().map(Device::traffic),
            implicit: self.implicit_steps(),
            equilibrium: self.equilibrium().cloned(),
            preload: self.preload.clone(),
            energies,
            mass: facts.initial_mass,
            removed_mass: facts.initial_mass - mass,
            removed_momentum: crate::observation::removed_momentum(&mut self.world)?,
            removed_elements: removed,
            inversions: inversions(&mut self.world)?,
            probes: self.world.resource::<Observer>().latest.clone(),
            tools,
            contacts,
            surface_contact: self.surface_contact_use(solving),
            attachments: self.attachments()?,
            ports: self.ports(),
            real_time: self.scene.real_time.then(|| self.metronome.kept()),
            guards: self.guards(),
            failure: self.failure.clone(),
            ended: ended.into(),
            names: super::names::Names::of(&self.scene),
            units: super::names::UNITS.iter().copied().collect(),
            parameters: super::names::parameters(&self.scene),
        })
    }
}

fn system_time(entry: &super::ScheduledPass, plan: &super::plan::Plan, on_gpu: bool) -> SystemTime {
    let because: Vec<&str> = entry.systems.iter().map(|&place| plan.systems[place].because.as_str()).collect();
    let (name, because) = (entry.name.clone(), because.join("; "));
    match &entry.job {
        Job::Kernels(_) => {
            let none = Vec::new;
            SystemTime { name, because, on: "device", seconds: None, runs: None, brought: none(), sent: none() }
        }
        Job::Host { writes, observes, .. } => {
            // what observes may see everything, and fetches for itself what is due
            let travels = on_gpu && !observes;
            let travelling = |columns: &Vec<&'static str>| if travels { columns.clone() } else { Vec::new() };
            let (brought, sent) = (travelling(&entry.reads), travelling(writes));
            let seconds = Some(entry.time.as_secs_f64());
            SystemTime { name, because, on: "host", seconds, runs: Some(entry.runs), brought, sent }
        }
    }
}
