//! The solver that this crate is: a scene file, run in many ways.

mod calibration;
mod curvature;
mod effects;
mod ladder;
mod march;
mod meshes;
mod rest;
mod sample;
mod steps;
mod variant;

use super::configuration::{Configuration, Digits, Factor, Processor};
use super::method::Method;
use super::solver::{Choices, Cost, Refusal, Solution, Solver};
use calibration::Calibration;
use march::{Sampling, refusal};
use rest::Rest;
use sinew::assembly::mesh_of;
use sinew::backend::gpu::Choice;
use sinew::components::Precision;
use sinew::mesh::ElementKind;
use sinew::scene::SceneFile;
use sinew::scene::schema::{Load, MeshSource, Share, ViscousIntegrator};
use sinew::{BackendChoice, Options, Simulation};
use std::time::Instant;
use variant::{names_elements, variant, written};

/// How a study runs a scene.
#[derive(Clone, Debug)]
pub struct Engine<'a> {
    file: &'a SceneFile,
    options: Options,
    /// Whether there is a GPU to compare with.
    gpu: bool,
    effects: bool,
    finest: f64,
    interrupted: fn() -> bool,
    sampling: Option<Sampling>,
    known: Vec<(Configuration, Calibration)>,
    /// Meshes that the scene can have, once they are known.
    meshes: Option<Vec<Factor>>,
    /// When everything is cut off.
    end: Option<Instant>,
    /// Kinds of elements that all bodies can have, once they are known.
    kinds: Option<Vec<ElementKind>>,
    /// Which search for equilibrium is gone by, once it is known.
    rest: Option<Rest>,
}

impl<'a> Engine<'a> {
    /// For a scene that is sound. `options` say how the scene as it is written runs; `gpu`, whether to compare with a
    /// GPU; `effects`, whether to switch effects off; `interrupted`, whether somebody wants the study to end.
    pub fn new(file: &'a SceneFile, options: Options, gpu: bool, effects: bool, interrupted: fn() -> bool) -> Self {
        Self {
            file,
            options,
            gpu,
            effects,
            finest: f64::INFINITY,
            interrupted,
            sampling: None,
            known: Vec::new(),
            meshes: None,
            end: None,
            kinds: None,
            rest: None,
        }
    }

    /// With no mesh finer than so many times the scene's.
    pub fn up_to(self, finest: f64) -> Self {
        Self { finest, ..self }
    }

    /// Samples of numbers over time that all configurations share: as many intervals, from the start to the end; 0 of a
    /// search for equilibrium.
    ///
    /// # Errors
    /// That the scene as it is written cannot be run.
    pub fn sample_count(&mut self) -> Result<u64, Refusal> {
        let kinds = self.elements()?;
        let written = self.base(&kinds);
        self.kinds = Some(kinds.clone());
        if self.rest.is_none() {
            self.rest = Some(self.choose_rest(&written)?);
        }
        let base = self.base(&kinds);
        self.calibrate(&base)?;
        Ok(self.sampling.as_ref().filter(|_| !self.file.scene.is_static()).map_or(0, |sampling| sampling.count))
    }

    /// The scene as it is written, at rest by the search that takes fewer passes; `elements` are the kinds that its
    /// bodies can have.
    fn base(&self, elements: &[ElementKind]) -> Configuration {
        let place = if self.options.backend == BackendChoice::Gpu { Processor::Gpu } else { Processor::Cpu };
        let scene = &self.file.scene;
        let mut kinds: Vec<ElementKind> = Vec::new();
        for body in scene.bodies.values() {
            let mut own = body.mesh.element_kinds();
            kinds.extend(own.find(|kind| elements.contains(kind)).or(body.mesh.element_kinds().last()));
        }
        kinds.dedup();
        let element = if let [kind] = kinds[..] { Some(kind).filter(|kind| elements.contains(kind)) } else { None };
        let mut base = written(scene, element, self.options.precision == Precision::F64, place);
        if let Some(by) = self.rest.as_ref().and_then(|rest| rest.by) {
            base.method = Method::Rest(by);
        }
        base
    }

    fn options(&self, configuration: &Configuration) -> Options {
        Options {
            backend: match configuration.place {
                Processor::Cpu => BackendChoice::Cpu,
                Processor::Gpu => BackendChoice::Gpu,
            },
            precision: if configuration.digits == Digits::Double { Precision::F64 } else { Precision::F32 },
            forgets_start: true,
            ..self.options.clone()
        }
    }

    /// Kinds of elements that all bodies can have.
    fn elements(&self) -> Result<Vec<ElementKind>, Refusal> {
        let scene = &self.file.scene;
        let mut kinds = ElementKind::ALL.to_vec();
        for body in scene.bodies.values() {
            let shape = match &body.mesh {
                MeshSource::File { .. } => {
                    let mesh = mesh_of(body, self.file).map_err(|error| Refusal::Refused(error.to_string()))?;
                    match mesh.cells.kinds().collect::<Vec<_>>()[..] {
                        [(cell, _)] => Some(cell),
                        _ => return Ok(Vec::new()),
                    }
                }
                mesh => {
                    let cell = mesh.element_kinds().next().map(|kind| kind.cell());
                    cell.filter(|_| names_elements(scene))
                }
            };
            kinds.retain(|kind| shape.is_none_or(|cell| kind.cell() == cell));
        }
        Ok(kinds)
    }

    /// What time is left (s).
    fn time_left(&self) -> f64 {
        self.end.map_or(f64::INFINITY, |end| end.saturating_duration_since(Instant::now()).as_secs_f64())
    }

    fn check_time(&self) -> Result<(), Refusal> {
        match ((self.interrupted)(), self.time_left() <= 0.0) {
            (true, _) => Err(Refusal::Interrupted),
            (false, true) => Err(Refusal::TooLong),
            (false, false) => Ok(()),
        }
    }

    fn notes(&self) -> Vec<String> {
        let scene = &self.file.scene;
        let mut notes: Vec<String> = self.rest.iter().filter_map(|rest| rest.note.clone()).collect();
        let each = |load: &Load| matches!(load, Load::NodalForce { share: Share::Each, .. });
        if let Some(number) = scene.loads.iter().position(each) {
            notes.push(format!(
                "loads[{number}] gives each node its force: where finer meshes have more nodes there it grows; share: Total \
                 would not"
            ));
        }
        notes
    }
}

impl Engine<'_> {
    /// The step that the scene wants (s). One that it names itself is kept where it is stable, and for the scene as it
    /// is written, which may be meant to go beyond.
    fn step(&self, configuration: &Configuration, options: &Options) -> Result<f64, Refusal> {
        match configuration.method {
            Method::Implicit { step, .. } | Method::Adaptive { step, .. } => return Ok(step),
            Method::HeavierMasses(times) => {
                let usual = Configuration { method: Method::Explicit, ..configuration.clone() };
                return Ok(f64::from(times).sqrt() * self.step(&usual, options)?);
            }
            Method::Explicit | Method::Rest(_) => {}
        }
        let integration = &self.file.scene.integration;
        let own = self.base(self.kinds.as_deref().unwrap_or_default());
        let as_written = (configuration.element, configuration.mesh) == (own.element, own.mesh);
        if let Some(step) = integration.step.filter(|_| as_written) {
            return Ok(step);
        }
        let scene = variant(self.file, configuration, None);
        let cpu = Options { backend: BackendChoice::Cpu, ..options.clone() };
        let mut simulation = Simulation::new(&scene, &cpu).map_err(refusal)?;
        let found = integration.safety * simulation.summary("not run").map_err(refusal)?.stable_step;
        Ok(integration.step.map_or(found, |step| step.min(found)))
    }
}

impl Solver for Engine<'_> {
    fn choices(&mut self) -> Result<Choices, Refusal> {
        self.sample_count()?;
        let elements = self.kinds.clone().unwrap_or_default();
        let base = self.base(&elements);
        let scene = &self.file.scene;
        let hexes = base.element.is_none_or(|kind| kind == ElementKind::Hex8);
        let viscous = scene.materials.values().any(|material| material.prony.is_some());
        let places = if self.gpu { vec![Processor::Cpu, Processor::Gpu] } else { Vec::new() };
        let both = [ViscousIntegrator::Exact, ViscousIntegrator::BackwardEuler];
        Ok(Choices {
            elements,
            meshes: self.sound_meshes()?,
            single_layers: self.single_layers(),
            touches: !scene.contacts.is_empty(),
            step_is_fixed: scene.integration.step.is_some() || base.method.is_implicit(),
            steps: if scene.is_static() { Vec::new() } else { vec![2, 4] },
            digits: vec![Digits::Plain, Digits::Compensated, Digits::Double],
            hourglass: if hexes { vec![0.5, 2.0] } else { Vec::new() },
            viscous: if viscous { both.to_vec() } else { Vec::new() },
            laws: ladder::laws(scene),
            places,
            methods: self.methods(&base)?,
            quantities: self.sampling.as_ref().map(Sampling::names).unwrap_or_default(),
            effects: if self.effects { effects::effects(scene) } else { Vec::new() },
            unseen: self.unseen()?,
            notes: self.notes(),
            base,
        })
    }

    fn predict(&mut self, configuration: &Configuration) -> Result<Cost, Refusal> {
        if configuration.place == Processor::Gpu && configuration.digits == Digits::Double {
            return Err(Refusal::Refused("the GPU computes in f32 only".into()));
        }
        self.cost(configuration)
    }

    fn solve(&mut self, configuration: &Configuration) -> Result<Solution, Refusal> {
        let started = Instant::now();
        let options = self.options(configuration);
        let sampling = match &self.sampling {
            Some(sampling) => sampling.clone(),
            None => return Err(Refusal::Refused("nothing has been predicted yet".into())),
        };
        let step = if self.file.scene.is_static() {
            None
        } else {
            let (duration, largest) = (self.file.scene.duration, self.step(configuration, &options)?);
            let most = largest / f64::from(configuration.step);
            let is_implicit = configuration.method.is_implicit();
            Some(if is_implicit { Sampling::whole(duration, most) } else { sampling.fitting(duration, most) })
        };
        let scene = variant(self.file, configuration, step);
        let solution = march::solve(&scene, &options, &sampling, &|| self.check_time())?;
        self.learn(configuration, &solution, started.elapsed().as_secs_f64());
        Ok(solution)
    }

    fn until(&mut self, end: Instant) {
        self.end = Some(end);
    }
}

/// Whether a GPU answers to a name; with `Choice::Best`, whether there is a hardware GPU.
pub fn has_gpu(choice: &Choice) -> bool {
    let wanted = if *choice == Choice::Best { Choice::Hardware } else { choice.clone() };
    sinew::backend::gpu::Gpu::open(&wanted).is_ok()
}
