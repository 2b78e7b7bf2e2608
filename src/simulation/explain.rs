//! What a scene causes, and why: systems, effects, kernels, columns and buffers, and what would turn on those that are
//! not there.

mod buffers;
mod contact;
mod effects;
mod kernels;
mod page;

use super::Simulation;
use super::known::Known;
use super::plan::{Pass, Plan, Planned};
use crate::backend::dispatch::Dispatched;
use crate::components::Precision;
use crate::error::Error;
use crate::systems::{OnHost, Registry, Repeat, RowSet, System};
use buffers::{Sizes, host_columns};
use kernels::OnGpu;
use serde::Serialize;

/// What a scene causes on a backend. As text it is a page for people.
#[derive(Clone, Debug, Serialize)]
pub struct Explanation {
    /// The scene's title.
    pub title: String,
    /// Where it runs.
    pub backend: String,
    /// Why there.
    pub backend_because: String,
    /// Whether that is a GPU.
    pub on_gpu: bool,
    /// `f32` or `f64`.
    pub precision: &'static str,
    /// The parts that the scene is made of.
    pub scene_parts: Vec<ScenePart>,
    /// Nodes of all bodies.
    pub nodes: usize,
    /// Elements of all bodies.
    pub elements: usize,
    /// The first step (s), what it is taken from and why; `None` in a static analysis.
    pub time_step: Option<String>,
    /// The systems in the order of a step.
    pub systems: Vec<SystemInUse>,
    /// Systems that the scene does not call for.
    pub systems_off: Vec<SystemOff>,
    /// What blocks and bodies have or lack.
    pub parts: Vec<Part>,
    /// What runs on the GPU in a step, in order; empty on the CPU.
    pub kernels: Vec<KernelInUse>,
    /// Which bodies take all steps of a submission in one dispatch, and why others do not; empty on the CPU.
    pub dispatched: Vec<Dispatched>,
    /// What solves for the ends of steps or for equilibrium; `None` where steps are explicit.
    pub solver: Option<SolverInUse>,
    /// What touches what, and what keeping it apart needs.
    pub contacts: Vec<ContactInUse>,
    /// Columns of numbers on the host.
    pub columns: Vec<Buffer>,
    /// Buffers on the device; empty on the CPU.
    pub buffers: Vec<Buffer>,
    /// Bytes of all columns on the host.
    pub host_bytes: u64,
    /// Bytes of all buffers on the device.
    pub device_bytes: u64,
    /// Bytes an element, of the device's buffers in a GPU run, else of the host's columns.
    pub bytes_an_element: f64,
}

/// A part of the scene.
#[derive(Clone, Debug, Serialize)]
pub struct ScenePart {
    /// Its name.
    pub name: String,
    /// The file that it comes from; empty where the scene holds it itself.
    pub file: String,
    /// The bodies and tools that it brings.
    pub brings: Vec<String>,
}

/// A system of the step.
#[derive(Clone, Debug, Serialize)]
pub struct SystemInUse {
    /// Its name.
    pub name: String,
    /// Its place in the step.
    pub phase: String,
    /// What it does.
    pub does: String,
    /// Why it is there.
    pub because: String,
    /// `host` or `device`.
    pub on: &'static str,
    /// How many kernels it has on the device; one whose work is done beforehand needs none.
    pub kernels: usize,
    /// For which nodes it is, where it works node by node.
    pub rows: Option<RowSet>,
    /// How it sums the forces of elements, where it finds them.
    pub sums: Option<String>,
    /// What of it a step repeats.
    pub repeat: Option<Repeat>,
    /// Systems that share its pass.
    pub shares_with: Vec<String>,
    /// Steps between two runs.
    pub every: u64,
    /// What travels for it in each of its runs; for host systems between a GPU's.
    pub travels: Option<Travels>,
}

/// Columns that go to the host before a system and back after it.
#[derive(Clone, Debug, Serialize)]
pub struct Travels {
    /// Columns brought to the host.
    pub brought: Vec<&'static str>,
    /// Bytes of those.
    pub brought_bytes: u64,
    /// Columns sent back.
    pub sent: Vec<&'static str>,
    /// Bytes of those.
    pub sent_bytes: u64,
}

/// A system that the scene does not call for.
#[derive(Clone, Debug, Serialize)]
pub struct SystemOff {
    /// Its name.
    pub name: String,
    /// What it would do.
    pub does: String,
    /// What in a scene turns it on.
    pub turned_on_by: String,
}

/// An element block or a body.
#[derive(Clone, Debug, Serialize)]
pub struct Part {
    /// `block cube/tissue/Hex8` or `body cube`.
    pub name: String,
    /// How large it is.
    pub size: String,
    /// What it has or lacks.
    pub effects: Vec<Effect>,
    /// The variant of the CPU's kernel that a block runs.
    pub cpu_variant: Option<String>,
}

/// Something that a part has or lacks.
#[derive(Clone, Debug, Serialize)]
pub struct Effect {
    /// What.
    pub name: &'static str,
    /// Its parameters when it is on; `None`: off.
    pub on: Option<String>,
    /// What in the scene turns it on.
    pub turned_on_by: String,
}

/// A dispatch of a step.
#[derive(Clone, Debug, Serialize)]
pub struct KernelInUse {
    /// The kernel.
    pub label: String,
    /// The systems it belongs to, in their order, as one text.
    pub system: String,
    /// The same, one by one.
    #[serde(skip)]
    pub systems: Vec<String>,
    /// The WGSL function.
    pub entry: &'static str,
    /// Dispatches of a step.
    pub times: usize,
    /// Invocations.
    pub threads: u32,
    /// Invocations of a workgroup.
    pub workgroup: u32,
    /// Bytes of memory that a workgroup shares.
    pub workgroup_memory: u32,
    /// Storage buffers; every WebGPU device allows 8.
    pub storage_buffers: usize,
    /// The pieces it is put together from.
    pub fragments: Vec<Piece>,
    /// Lines of all pieces.
    pub lines: usize,
    /// Their text, and which functions of them call which.
    #[serde(skip)]
    pub listing: String,
    /// What it binds.
    pub bindings: Vec<Bound>,
}

/// A piece of WGSL.
#[derive(Clone, Debug, Serialize)]
pub struct Piece {
    /// Its file, or what it was generated for.
    pub path: String,
    /// Lines.
    pub lines: usize,
}

/// A WGSL variable with its buffer.
#[derive(Clone, Debug, Serialize)]
pub struct Bound {
    /// The variable.
    pub variable: String,
    /// `uniform`, `read` or `read_write`.
    pub access: &'static str,
    /// The buffer.
    pub buffer: String,
    /// Its bytes.
    pub bytes: u64,
}

/// A system of contact: what it looks at, and what it holds beside columns.
#[derive(Clone, Debug, Serialize)]
pub struct ContactInUse {
    /// The system.
    pub system: String,
    /// How much it looks at, and how it finds what is near.
    pub of: Vec<String>,
    /// What it holds on the host beside columns, and the bytes.
    pub held: Vec<(&'static str, u64)>,
    /// Bytes of its columns and of this over the faces of surfaces; 0 where none are looked at.
    pub bytes_a_face: f64,
}

/// A solver: what a step of it is made of, and what it holds beside columns.
#[derive(Clone, Debug, Serialize)]
pub struct SolverInUse {
    /// What it does.
    pub of: Vec<String>,
    /// What it holds on the host beside columns, and the bytes.
    pub held: Vec<(&'static str, u64)>,
}

/// A column or a device buffer.
#[derive(Clone, Debug, Serialize)]
pub struct Buffer {
    /// What it belongs to.
    pub of: String,
    /// Its name.
    pub name: String,
    /// `column`, `constants` or `uniform`.
    pub kind: &'static str,
    /// Its bytes.
    pub bytes: u64,
}

impl Simulation {
    /// What the scene causes on the backend that it runs on. `registry` is the one that the simulation was made with.
    ///
    /// # Errors
    /// Kernels that do not compile.
    pub fn explain(&mut self, registry: &Registry) -> Result<Explanation, Error> {
        self.explain_for(registry, self.facts.on_gpu)
    }

    /// What the scene would cause on a GPU. None is needed: buffers are only counted.
    ///
    /// # Errors
    /// A simulation in f64, and kernels that do not compile.
    pub fn explain_on_gpu(&mut self, registry: &Registry) -> Result<Explanation, Error> {
        match self.facts.precision {
            Precision::F32 => self.explain_for(registry, true),
            Precision::F64 => Err(Error::Options("the GPU computes in f32 only".into())),
        }
    }

    fn explain_for(&mut self, registry: &Registry, on_gpu: bool) -> Result<Explanation, Error> {
        let sizes = Sizes::of(&mut self.world);
        let plan = &self.plan;
        let known = Known::of(registry, &self.scene);
        let in_use = |name: &str| plan.systems.iter().any(|planned| planned.name == name);
        let off = known.systems().filter(|system| !in_use(&system.name));
        let systems_off = off.map(|system| SystemOff {
            name: system.name.clone(),
            does: system.does.clone(),
            turned_on_by: system.called_for_by.into(),
        });
        let systems_off = systems_off.collect();
        let of_name = |planned: &Planned| known.get(&planned.name).ok_or_else(|| unknown(planned));
        let scheduled = plan.systems.iter().map(of_name).collect::<Result<Vec<&System>, Error>>()?;
        let mut systems: Vec<SystemInUse> = Vec::new();
        for pass in plan.passes(on_gpu) {
            systems
                .extend(pass.systems.iter().map(|&place| in_pass(plan, pass, place, scheduled[place], on_gpu, &sizes)));
        }
        let OnGpu { kernels, buffers, dispatched } = match on_gpu {
            true => kernels::describe(plan, &scheduled, &sizes, &mut self.world)?,
            false => Default::default(),
        };
        let of_forces = |kernel: &&KernelInUse| {
            let first = kernel.systems.first();
            let planned = plan.systems.iter().find(|planned| Some(&planned.name) == first);
            planned.is_some_and(|planned| planned.finds_forces)
        };
        let forces_on_gpu = on_gpu.then(|| kernels.iter().filter(of_forces).map(|kernel| kernel.times).sum());
        for system in &mut systems {
            let own = kernels.iter().filter(|kernel| kernel.systems.contains(&system.name));
            system.kernels = own.count();
        }
        let columns = host_columns(&sizes, &mut self.world);
        let total = |buffers: &[Buffer]| buffers.iter().map(|buffer| buffer.bytes).sum::<u64>();
        let (host_bytes, device_bytes) = (total(&columns), total(&buffers));
        let counted = if on_gpu { device_bytes } else { host_bytes };
        Ok(Explanation {
            title: self.scene.title.clone(),
            scene_parts: effects::scene_parts(&self.file),
            backend: if on_gpu && !self.facts.on_gpu { "a GPU".into() } else { self.facts.backend.clone() },
            backend_because: self.facts.why.clone(),
            on_gpu,
            precision: match self.facts.precision {
                Precision::F32 => "f32",
                Precision::F64 => "f64",
            },
            nodes: self.facts.nodes,
            elements: self.facts.elements,
            time_step: (self.facts.stability.limit.is_some() || self.scene.is_implicit()).then(|| {
                let stability = &self.facts.stability;
                format!("{:.3e} s by {}: {}", stability.step, stability.in_words(), stability.because)
            }),
            systems,
            systems_off,
            parts: effects::parts(&self.scene, self.facts.precision, on_gpu, &mut self.world),
            kernels,
            dispatched,
            solver: self.solver.in_use(&self.scene, &mut self.world, (&self.entries, forces_on_gpu)),
            contacts: contact::in_use(&mut self.world),
            columns,
            buffers,
            host_bytes,
            device_bytes,
            bytes_an_element: counted as f64 / self.facts.elements.max(1) as f64,
        })
    }
}

fn unknown(planned: &Planned) -> Error {
    Error::Options(format!("`{}` is not in the registry: it must be that of the simulation", planned.name))
}

/// A system as one of a pass.
fn in_pass(plan: &Plan, pass: &Pass, place: usize, system: &System, on_gpu: bool, sizes: &Sizes) -> SystemInUse {
    let planned = &plan.systems[place];
    let on_device = on_gpu && planned.on_device;
    let travels = (on_gpu && !on_device && !planned.observes).then(|| {
        let (mut brought, sent) = (sizes.existing(&planned.reads), sizes.existing(&planned.writes));
        brought.extend(sent.iter().filter(|name| !planned.reads.contains(name)));
        let (brought_bytes, sent_bytes) = (sizes.sum(&brought), sizes.sum(&sent));
        Travels { brought, brought_bytes, sent, sent_bytes }
    });
    let others = pass.systems.iter().filter(|&&other| other != place);
    SystemInUse {
        name: planned.name.clone(),
        phase: format!("{:?}", planned.phase),
        does: system.does.clone(),
        because: planned.because.clone(),
        rows: planned.rows,
        sums: matches!(system.host, OnHost::Elements(_)).then(|| plan.summed.to_string()),
        repeat: pass.repeat.clone(),
        shares_with: others.map(|&other| plan.systems[other].name.clone()).collect(),
        on: if on_device { "device" } else { "host" },
        kernels: 0,
        every: planned.every,
        travels,
    }
}
