//! Worlds with every effect a kernel can be put together from, for tests with and without a GPU.
#![allow(dead_code, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use bevy_ecs::prelude::*;
use sinew::backend::Buffers;
use sinew::backend::dispatch::{self, Dispatched, ElementsThenNodes};
use sinew::backend::kernel::{BufferId, Composed, Composer, Kernel, KernelError, MostBuffers};
use sinew::backend::node_stage::{NodeStage, node_kernels};
use sinew::components::*;
use sinew::systems::{OnDevice, Registry};
use sinew::{BackendChoice, Options, SceneFile, Simulation};
use std::sync::Arc;

mod laws;
mod noise;
#[allow(unused_imports)]
pub use laws::{ALONG, AROUND, FAMILIES, FRAMED, GROWING, LAWS, VARIED};
#[allow(unused_imports)]
pub use noise::{Noise, randomize, scale_strains, small_strains};

/// What a scene calls for.
#[derive(Clone, Debug, Default)]
pub struct Effects {
    /// A direction, as RON writes it.
    pub fibres: Option<&'static str>,
    pub tension_only: bool,
    pub prony: usize,
    pub backward_euler: bool,
    pub damping: bool,
    pub loads: bool,
    /// Bodies that a program may grab.
    pub grabs: bool,
    pub moved: bool,
    /// Two copies of each body, with loads that differ.
    pub copies: bool,
    /// Parameters of the law, and of fibres where there are, that differ from copy to copy: see [`VARIED`].
    pub varied: Option<&'static str>,
    pub compensated: bool,
    pub energies: bool,
    pub removal: bool,
    /// A tool that sucks at each body, and another.
    pub sucks: bool,
    /// A static analysis; nothing is removed in one.
    pub at_rest: bool,
    /// A removal criterion for all elements, as RON writes it.
    pub criterion: Option<&'static str>,
    /// Hexahedra that are all parallelepipeds.
    pub cells: bool,
    /// Elements that take their pressure from means.
    pub averaged: bool,
    /// Other elements in place of hexahedra.
    pub others: Option<&'static str>,
    /// The elastic law, as RON writes it; else the neo-Hookean one.
    pub law: Option<&'static str>,
    /// Families of fibres that stiffen, as RON writes them.
    pub families: Option<&'static str>,
    /// Viscosity of the pressure.
    pub volumetric: bool,
    pub reproject: bool,
    /// What becomes of inverted elements, as RON writes it.
    pub inversion: Option<&'static str>,
    /// How element forces are summed.
    pub scheme: Scheme,
}

impl Effects {
    /// Everything at once.
    pub fn all() -> Self {
        Self {
            fibres: Some(AROUND),
            tension_only: true,
            prony: 2,
            damping: true,
            loads: true,
            grabs: true,
            moved: true,
            compensated: true,
            energies: true,
            removal: true,
            families: Some(FAMILIES),
            volumetric: true,
            reproject: true,
            ..Self::default()
        }
    }

    /// Every combination of material effects, and of what a body can have.
    pub fn combinations() -> Vec<Self> {
        let mut all = vec![Self { cells: true, ..Self::default() }, Self { cells: true, ..Self::all() }];
        for fibres in [None, Some(ALONG), Some(AROUND)] {
            for prony in [0, 1, 2] {
                all.push(Self { fibres, prony, ..Self::default() });
                all.push(Self { fibres, prony, removal: true, loads: true, ..Self::default() });
            }
        }
        for bits in 0..32 {
            let bit = |i: u32| bits >> i & 1 == 1;
            let (damping, loads) = (bit(0), bit(1));
            let (compensated, energies, removal) = (bit(2), bit(3), bit(4));
            all.push(Self { damping, loads, compensated, energies, removal, moved: true, ..Self::default() });
        }
        for law in LAWS {
            let families = (!law.starts_with("linear")).then_some(FAMILIES);
            for averaged in [false, true] {
                let plain = Self { law: Some(law), averaged, ..Self::default() };
                all.push(Self { prony: 1, families, removal: true, ..plain.clone() });
                all.push(Self { volumetric: true, reproject: true, ..plain });
            }
        }
        all.push(Self { law: Some(FRAMED), prony: 1, volumetric: true, removal: true, ..Self::default() });
        let at_rest = Self { at_rest: true, prony: 1, damping: true, moved: true, ..Self::default() };
        for (loads, compensated) in [(false, false), (false, true), (true, false), (true, true)] {
            all.push(Self { loads, compensated, ..at_rest.clone() });
        }
        for averaged in [false, true] {
            all.push(Self { inversion: Some("Remove"), averaged, removal: true, ..Self::default() });
        }
        all.push(Self { inversion: Some("Remove"), prony: 1, fibres: Some(AROUND), averaged: true, ..Self::default() });
        for averaged in [false, true] {
            let plain = Self { scheme: Scheme::TwoPass, averaged, ..Self::default() };
            all.push(Self { fibres: Some(AROUND), prony: 1, removal: true, ..plain.clone() });
            all.push(plain);
        }
        all.push(Self::all());
        all.push(Self { copies: true, loads: true, ..Self::default() });
        for (law, varied) in VARIED {
            let own = Self { copies: true, law: Some(law), varied: Some(varied), ..Self::default() };
            all.push(Self { averaged: law == LAWS[2], ..own.clone() });
            let [families, fibres] = [FAMILIES, AROUND].map(|word| (law != LAWS[0]).then_some(word));
            all.push(Self { families, fibres, removal: true, prony: 1, scheme: Scheme::TwoPass, ..own });
        }
        all.push(Self { averaged: true, ..Self::default() });
        all.push(Self { grabs: true, ..Self::default() });
        all.push(Self { averaged: true, ..Self::all() });
        for others in ["Wedge6", "Tet10"].map(Some) {
            for scheme in [Scheme::Patches, Scheme::TwoPass] {
                all.push(Self { others, scheme, ..Self::default() });
            }
            all.push(Self { others, ..Self::all() });
        }
        all
    }

    /// Two distorted balls, one of tetrahedra and one of hexahedra, each with a region of a second, plain material.
    pub fn scene(&self) -> String {
        let fibres = self.fibres.map_or(String::new(), |direction| {
            format!("fibres: (eta: 2000, direction: {direction}, tension_only: {}),", self.tension_only)
        });
        let terms = ["(alpha: 0.4, tau: 0.58),", "(alpha: 0.2, tau: 0.01),"][..self.prony].concat();
        let integrator = if self.backward_euler { "BackwardEuler" } else { "Exact" };
        let volumetric = if self.volumetric { "(alpha: 0.3, tau: 0.05), (alpha: 0.1, tau: 2)" } else { "" };
        let prony = match (self.prony, self.volumetric) {
            (0, false) => String::new(),
            _ => format!(
                "prony: (terms: [{terms}], volumetric: [{volumetric}], integrator: {integrator}, reproject: {}),",
                self.reproject
            ),
        };
        let law = self.law.unwrap_or(LAWS[2]);
        let families = self.families.map_or(String::new(), |families| format!("exponential_fibres: {families},"));
        let damping = if self.damping { "damping: 20," } else { "" };
        let inversion = self.inversion.map_or(String::new(), |word| format!("inversion: {word},"));
        let (copies, per_copy) = match self.copies {
            true => (
                "copies: 2, apart: (0.001, 0, 0),",
                "per_copy: Axes(x: Linear(0.5, -2), y: Values([1, 3]), z: Uniform(from: 1, to: 2)),",
            ),
            false => ("", ""),
        };
        let mut varied: Vec<&str> = self.varied.into_iter().collect();
        if self.varied.is_some() && self.fibres.is_some() {
            varied.push("\"tissue.fibres.eta\": Values([1000, 3000])");
        }
        if self.varied.is_some() && self.families.is_some() {
            varied.push("\"tissue.exponential_fibres[0].k1\": Values([900, 500])");
            varied.push("\"tissue.exponential_fibres[1].k2\": Values([0.1, 0.4])");
        }
        varied.extend((self.varied.is_some() && self.prony > 0).then_some(laws::VARIED_TERM));
        let varied = varied.join(", ");
        let both = |text: &str| {
            ["tets", "hexes"].map(|body| text.replace("BODY", body).replace("PER_COPY", per_copy)).concat()
        };
        let loads = if self.loads {
            both(
                "Gravity(body: \"BODY\", PER_COPY acceleration: (1, -2, -9.81)),
                 NodalForce(body: \"BODY\", on: Sphere(center: (0, 0, 0.05), radius: 0.03), PER_COPY force: (0.001, 0.002, -0.003)),
                 Pressure(body: \"BODY\", on: All, pressure: 120),
                 Traction(body: \"BODY\", on: Surface(normal: (0, 0, 1), within: 70), PER_COPY traction: (5, -7, 11)),",
            )
        } else {
            String::new()
        };
        let moved = if self.moved {
            both(
                "Prescribed(body: \"BODY\", on: Sphere(center: (0, 0, -0.04), radius: 0.025), axes: [X, Z],
                    displacement: (0.001, 0.002, 0.003), gradient: ((0.1, 0.2, 0), (0, 0.1, 0.1), (0.05, 0, -0.1)),
                    rotation: (3, 4, 5), center: (0.01, 0, 0), curve: Ramp(start: 0, end: 0.1)),",
            )
        } else {
            String::new()
        };
        let removal = if self.removal {
            both(
                "(body: \"BODY\", on: Sphere(center: (0.02, 0, 0), radius: 0.02), when: At(1e-9)),
                 (body: \"BODY\", on: Sphere(center: (-0.02, 0, 0), radius: 0.02), when: StretchAbove(1.25)),
                 (body: \"BODY\", on: All, when: VolumeRatioAbove(1.25)),
                 (body: \"BODY\", on: All, when: VolumeRatioBelow(0.8)),
                 (body: \"BODY\", on: All, when: EnergyDensityAbove(450)),",
            )
        } else {
            String::new()
        };
        let criterion = self.criterion.map_or(String::new(), |when| both(&format!("(body: \"BODY\", when: {when}),")));
        let energies = if self.energies { "output: (energies_every: 0.1)," } else { "" };
        let sucks = if self.sucks {
            both(
                "(tool: \"tip_BODY\", body: \"BODY\", pressure: 90, bore: 0.025, reach: 0.03, delay: 0.1),
                 (tool: \"side_BODY\", body: \"BODY\", pressure: 80, bore: 0.04, reach: 0.02),",
            )
        } else {
            String::new()
        };
        let analysis = if self.at_rest { "Static()" } else { "Transient" };
        let body = |kind: &str| {
            let mesh = match self.cells && kind.starts_with("Hex8") {
                true => format!(
                    "Box(size: (0.1, 0.08, 0.12), cells: (6, 5, 7), elements: {kind}), translate: (-0.05, -0.04, -0.06)"
                ),
                false => format!("Ellipsoid(radii: (0.05, 0.04, 0.06), across: 6, elements: {kind})"),
            };
            format!(
                "(mesh: {mesh}, material: \"tissue\", {copies} per_copy: {{{varied}}},
                  regions: [(on: Box(min: (0, -1, -1), max: (1, 1, 1)), material: \"plain\")])"
            )
        };
        // of each body its own: a mouth of both is closed by both, which only the host knows
        let tools = both(
            "\"tip_BODY\": (shape: Sphere(radius: 0.01), at: (0.01, 0.005, 0.05), rotation: (10, 20, 0)),
             \"side_BODY\": (shape: Sphere(radius: 0.01), at: (0.04, 0, 0), rotation: (0, 80, 0)),",
        );
        let tools = if self.sucks { format!("tools: {{{tools}}},") } else { String::new() };
        format!(
            "(title: \"effects\", duration: 1, analysis: {analysis},
            bodies: {{ \"tets\": {}, \"hexes\": {} }},
            materials: {{
                \"tissue\": (density: 1000, {law}, {fibres} {families} {prony} {damping} {inversion}),
                \"plain\": (density: 1200, neo_hookean: Moduli(shear: 3000, bulk: 9000)),
            }},
            constraints: [{moved}],
            loads: [{loads}],
            removal: [{removal} {criterion}],
            {tools}
            suction: [{sucks}],
            integration: (compensated: {}),
            {energies}
            )",
            body(if self.averaged { "Tet4NodalPressure" } else { "Tet4" }),
            body(self.others.unwrap_or(if self.averaged { "Hex8MeanDilatation" } else { "Hex8" })),
            self.compensated
        )
    }

    /// A simulation of it.
    pub fn simulation(&self, backend: BackendChoice) -> Simulation {
        let text = self.scene();
        let scene = match SceneFile::from_text("effects.ron", &text, std::path::Path::new("."), &[]) {
            Ok(scene) => scene,
            Err(problem) => panic!("{}", problem.render(false)),
        };
        let options =
            Options { backend, gpu: gpu_choice(), scheme: Some(self.scheme), grabs: self.grabs, ..Options::default() };
        Simulation::new(&scene, &options).unwrap_or_else(|error| panic!("{error}\n{text}"))
    }
}

/// The device that tests run on.
pub fn gpu_choice() -> sinew::backend::gpu::Choice {
    sinew::backend::gpu::Choice::parse(&std::env::var("SINEW_GPU").unwrap_or_default())
}

/// Hands out no buffers, but remembers the bytes of uniforms.
pub struct Described {
    pub most: MostBuffers,
    pub uniforms: Vec<(String, usize)>,
    pub columns: Vec<(Entity, &'static str)>,
    pub composer: Composer,
}

impl Default for Described {
    /// As on the smallest device.
    fn default() -> Self {
        let composer = Composer::default();
        Self { most: MostBuffers::WEBGPU, uniforms: Vec::new(), columns: Vec::new(), composer }
    }
}

impl Buffers for Described {
    fn compose(&mut self, kernel: &Kernel) -> Result<Arc<Composed>, KernelError> {
        self.composer.compose(kernel)
    }
    fn most_buffers(&self) -> MostBuffers {
        self.most
    }
    fn column(&mut self, entity: Entity, name: &'static str) -> BufferId {
        if !self.columns.contains(&(entity, name)) {
            self.columns.push((entity, name));
        }
        BufferId::NONE
    }
    fn constants(&mut self, _: String, _: &[u8]) -> BufferId {
        BufferId::NONE
    }
    fn uniform(&mut self, label: String, bytes: &[u8]) -> BufferId {
        self.uniforms.push((label, bytes.len()));
        BufferId::NONE
    }
}

/// The kernels of all systems that a world calls for, with their systems' names.
pub fn all_kernels(world: &mut World) -> (Vec<(String, Kernel)>, Described) {
    let mut described = Described::default();
    let mut all = Vec::new();
    for system in Registry::default().systems() {
        if (system.because)(world).is_some() {
            let kernels = system.kernels(world, &mut described);
            all.extend(kernels.into_iter().map(|kernel| (system.name.clone(), kernel)));
        }
    }
    (all, described)
}

/// Systems that work node by node, in an order in which they can share kernels.
pub const OF_NODES: [&str; 8] =
    ["gather", "gravity", "nodal_force", "traction", "grab", "pressure", "boundary", "integrate"];

/// Kernels of systems of nodes that share them.
pub fn shared_kernels(systems: &[&str], world: &mut World, buffers: &mut dyn Buffers) -> Vec<Kernel> {
    let stages = stages_of(systems, world, buffers);
    node_kernels(stages, true, buffers)
}

/// Kernels of bodies that take many steps in a dispatch: however many elements they have, if only their patches allow
/// it.
pub fn small_bodies(of_nodes: &[&str], world: &mut World, buffers: &mut dyn Buffers) -> Vec<Kernel> {
    grouped(of_nodes, world, buffers, |told, step, world, buffers| {
        dispatch::decide_many_steps(usize::MAX, told, step, world, buffers);
    })
    .moving
}

/// Kernels of patches that move the nodes inside them, and what is left to others.
pub fn interior_nodes(of_nodes: &[&str], world: &mut World, buffers: &mut dyn Buffers) -> Grouped {
    grouped(of_nodes, world, buffers, dispatch::decide_interior_nodes)
}

/// A step of element forces and one pass of nodes, as it was decided.
pub struct Grouped {
    /// Kernels that do nothing but find forces.
    pub alone: Vec<Kernel>,
    /// Those that find forces and move nodes.
    pub moving: Vec<Kernel>,
    /// Those of the nodes that are left.
    pub others: Vec<Kernel>,
    /// What is told of each body.
    pub told: Vec<Dispatched>,
}

pub fn grouped(
    of_nodes: &[&str],
    world: &mut World,
    buffers: &mut dyn Buffers,
    decide: impl FnOnce(&mut [Dispatched], ElementsThenNodes<'_>, &World, &mut dyn Buffers),
) -> Grouped {
    let forces = Registry::default().get("element_forces").unwrap().device.clone();
    let (elements, stages) = (forces.kernels(world, buffers), stages_of(of_nodes, world, buffers));
    let step = ElementsThenNodes { elements: &elements, stages: &stages };
    let mut told = dispatch::pass_by_pass("nothing is decided", "nothing is decided", world);
    decide(&mut told, step, world, buffers);
    let (alone, moving, left) = dispatch::grouped(&told, step, world, buffers);
    Grouped { alone, moving, others: node_kernels(left, true, buffers), told }
}

fn stages_of(systems: &[&str], world: &mut World, buffers: &mut dyn Buffers) -> Vec<NodeStage> {
    let registry = Registry::default();
    let mut stages = Vec::new();
    for system in systems.iter().filter_map(|name| registry.get(name)) {
        match ((system.because)(world), &system.device) {
            (Some(_), OnDevice::Stages(describe)) => stages.extend(describe(world, buffers)),
            (_, device) => assert!(!matches!(device, OnDevice::Kernels(_)), "{}", system.name),
        }
    }
    stages
}

/// The kernels of the guards, which run beside the step.
pub fn guard_kernels(world: &mut World) -> Vec<(String, Kernel)> {
    sinew::systems::add_guard_columns(world);
    let kernels = sinew::systems::guard_kernels(world, &mut Described::default());
    kernels.into_iter().map(|kernel| ("observe".to_string(), kernel)).collect()
}
