//! What is measured: cubes under a load, held at the bottom.

use super::load::{Load, TEXT};
use serde::{Deserialize, Serialize};
use sinew::Error;
use sinew::backend::cpu::Instructions;
use sinew::components::{Precision, Scheme};
use sinew::mesh::ElementKind;
use sinew::scene::SceneFile;
use sinew::{BackendChoice, Options, Simulation};
use std::collections::BTreeMap;

/// Effects beside neo-Hookean elasticity.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum Effects {
    /// None.
    None,
    /// Transverse isotropy.
    Fibres,
    /// One Prony term.
    Viscosity,
    /// Both: the paper's material.
    FibresViscosity,
}

/// One case.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
pub struct Case {
    /// The element type.
    pub element: ElementKind,
    /// Effects.
    pub effects: Effects,
    /// `cpu` or `gpu`.
    pub backend: String,
    /// `f32` or `f64`.
    pub precision: String,
    /// CPU threads.
    pub threads: usize,
    /// Vector registers of the CPU: `widest`, `avx2` or `portable`.
    #[serde(default = "widest")]
    pub instructions: String,
    /// `patches` or `two-pass`.
    pub scheme: String,
    /// Cells along each edge.
    pub cells: u32,
    /// Whether neighbouring systems share a kernel or loop where they can.
    #[serde(default = "yes")]
    pub fuse: bool,
    /// What pulls at it.
    #[serde(default)]
    pub load: Load,
}

/// Records of before had no word for it.
fn widest() -> String {
    "widest".into()
}

fn yes() -> bool {
    true
}

/// All cases of a benchmark: every combination.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Cells along each edge.
    pub cells: Vec<u32>,
    /// Element types.
    pub elements: Vec<ElementKind>,
    /// Effects.
    pub effects: Vec<Effects>,
    /// `cpu`, `gpu`.
    pub backends: Vec<String>,
    /// `f32`, `f64`.
    pub precisions: Vec<String>,
    /// CPU threads.
    pub threads: Vec<usize>,
    /// `widest`, `avx2`, `portable`.
    pub instructions: Vec<String>,
    /// `patches`, `two-pass`.
    pub schemes: Vec<String>,
    /// Whether systems share kernels, both for what that gains.
    pub fuse: Vec<bool>,
    /// Loads.
    pub loads: Vec<Load>,
}

impl Plan {
    /// Groups of cases of the same cube, to be timed by turns.
    pub fn groups(&self) -> Vec<Vec<Case>> {
        let mut groups = Vec::new();
        for &cells in &self.cells {
            for &element in &self.elements {
                let mut group = Vec::new();
                for &effects in &self.effects {
                    for backend in &self.backends {
                        let gpu = backend == "gpu";
                        for precision in self.precisions.iter().filter(|precision| !gpu || *precision == "f32") {
                            for (threads, instructions) in if gpu { vec![(1, widest())] } else { self.on_cpu() } {
                                for scheme in &self.schemes {
                                    let fuse = self.fuse.iter();
                                    let both = fuse.flat_map(|&fuse| self.loads.iter().map(move |&load| (fuse, load)));
                                    group.extend(both.map(|(fuse, load)| Case {
                                        element,
                                        effects,
                                        backend: backend.clone(),
                                        precision: precision.clone(),
                                        threads,
                                        instructions: instructions.clone(),
                                        scheme: scheme.clone(),
                                        cells,
                                        fuse,
                                        load,
                                    }));
                                }
                            }
                        }
                    }
                }
                groups.push(group);
            }
        }
        groups.retain(|group: &Vec<Case>| !group.is_empty());
        groups
    }

    /// Threads and registers.
    fn on_cpu(&self) -> Vec<(usize, String)> {
        let with = |&threads| self.instructions.iter().map(move |instructions| (threads, instructions.clone()));
        self.threads.iter().flat_map(with).collect()
    }
}

/// How many elements fill a cell of a cube.
pub fn elements_a_cell(element: ElementKind) -> u64 {
    element.a_cell().unwrap_or(1).into()
}

impl Effects {
    /// As in files.
    pub fn name(self) -> &'static str {
        match self {
            Effects::None => "none",
            Effects::Fibres => "fibres",
            Effects::Viscosity => "viscosity",
            Effects::FibresViscosity => "fibres-viscosity",
        }
    }
}

impl Case {
    /// Whether it runs on a GPU.
    pub fn is_gpu(&self) -> bool {
        self.backend == "gpu"
    }

    /// Where it runs, in a few words.
    pub fn on(&self) -> String {
        match self.instructions.as_str() {
            _ if self.is_gpu() => "GPU".into(),
            "widest" => format!("{} × {}", self.threads, self.precision),
            instructions => format!("{} × {}, {instructions}", self.threads, self.precision),
        }
    }

    /// The same with every system apart.
    pub fn split(&self) -> Self {
        Self { fuse: false, ..self.clone() }
    }

    /// The same under the engine's gravity.
    pub fn under_gravity(&self) -> Self {
        Self { load: Load::Gravity, ..self.clone() }
    }

    /// The same in the plain scheme of two passes.
    pub fn two_pass(&self) -> Self {
        Self { scheme: "two-pass".into(), ..self.clone() }
    }

    /// Its scene.
    ///
    /// # Errors
    /// None is known: it is the program's own text.
    pub fn scene(&self) -> Result<SceneFile, Error> {
        let fibres = "fibres: (eta: 2000, direction: Along(1, 0, 0)),";
        let viscosity = "prony: (terms: [(alpha: 0.5, tau: 0.58)]),";
        let effects = match self.effects {
            Effects::None => String::new(),
            Effects::Fibres => fibres.into(),
            Effects::Viscosity => viscosity.into(),
            Effects::FibresViscosity => format!("{fibres} {viscosity}"),
        };
        let (cells, element) = (self.cells, self.element);
        let fuse = if self.fuse { "" } else { "fuse: false," };
        let text = format!(
            "(duration: 1e6, {fuse}
              bodies: {{\"cube\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: ({cells}, {cells}, {cells}), elements: {element:?}),
                                   material: \"tissue\")}},
              materials: {{\"tissue\": (density: 1000, neo_hookean: Young(young: 3000, poisson: 0.45), {effects})}},
              constraints: [Fixed(on: Set(\"z0\"))],
              {})",
            self.load.in_scene()
        );
        let files = BTreeMap::from([(TEXT.0.to_string(), TEXT.1.as_bytes().to_vec())]);
        SceneFile::from_memory("cube", &text, files, &[]).map_err(Error::from)
    }

    /// Its simulation.
    ///
    /// # Errors
    /// As [`Simulation::new`].
    pub fn simulation(&self) -> Result<Simulation, Error> {
        Simulation::with_systems(&self.scene()?, &self.options(), &self.load.registry())
    }

    /// How it runs.
    pub fn options(&self) -> Options {
        Options {
            backend: if self.is_gpu() { BackendChoice::Gpu } else { BackendChoice::Cpu },
            precision: if self.precision == "f64" { Precision::F64 } else { Precision::F32 },
            threads: self.threads,
            instructions: match self.instructions.as_str() {
                "avx2" => Instructions::Avx2,
                "portable" => Instructions::Portable,
                _ => Instructions::Widest,
            },
            scheme: Some(if self.scheme == "patches" { Scheme::Patches } else { Scheme::TwoPass }),
            forgets_start: true,
            ..Options::default()
        }
    }
}
