//! The words of the command line.

mod before_a_run;
mod numbers;
mod suites;
mod sweeps;

pub use before_a_run::{MeshArguments, ModesArguments, UnloadArguments, ViewArguments};
pub use suites::{BenchArguments, ELEMENTS, HardArguments};
pub use sweeps::SweepArguments;

use clap::{Args, Parser, Subcommand, ValueEnum};
use glam::Vec3;
use numbers::{above_zero, direction, share, size, time, wall_time};
use sinew::backend::gpu::Choice;
use sinew::components::{Precision, Scheme};
use sinew::scene::{Allowed, Diagnostics};
use sinew::{BackendChoice, Options, SceneFile};
use std::path::{Path, PathBuf};

const STATUSES: &str = "\
Exit status:
  0    done
  1    the simulation broke down, or found no equilibrium, or unload no shape; what was written
       until then is kept. hard: a case did not end as it should. bench: slower than --compare
  2    the scene or the options are wrong; nothing was run
  3    outputs could not be written, or another run writes into the folder
  4    there is no GPU, or it failed
  5    accuracy: the scene as it is written does not meet its --target
  6    accuracy: the reference is too coarse to tell, or the scene as it is written did not run
  130  interrupted; what was written until then is kept";

/// Soft tissue, fast: total Lagrangian explicit finite elements on the CPU and the GPU.
#[derive(Parser)]
#[command(name = "sinew", version, after_help = STATUSES, max_term_width = 100)]
pub struct Arguments {
    #[command(subcommand)]
    pub command: Command,
    /// Say nothing but warnings and errors: no report, no progress
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    pub quiet: bool,
    /// Say what is done meanwhile, too
    #[arg(short, long, global = true)]
    pub verbose: bool,
}

#[derive(Subcommand)]
pub enum Command {
    /// Run a scene and write what it asks for into a folder
    #[command(after_help = STATUSES)]
    Run(RunArguments),
    /// Look for mistakes in a scene, all in one go, without running it
    #[command(after_help = STATUSES)]
    Check(CheckArguments),
    /// Show what a scene causes and why: systems, effects, kernels, buffers; and what would turn on what is off
    #[command(after_help = STATUSES)]
    Explain(ExplainArguments),
    /// Draw a scene or the output of a run
    #[command(after_help = STATUSES)]
    Render(RenderArguments),
    /// Look at a scene while it runs, and pull at it, or at the output of a run, in a window of sinew-view
    View(ViewArguments),
    /// Show what a mesh is and where it lies: extents, sets, quality, likely units; of a mesh file or of a scene's
    /// bodies
    #[command(after_help = STATUSES)]
    Mesh(MeshArguments),
    /// Find the lowest natural frequencies of a scene and their shapes, with a proposal for damping and ramps
    #[command(after_help = STATUSES)]
    Modes(ModesArguments),
    /// Find the unloaded shape of a scene whose meshes show its bodies loaded, as scans do
    #[command(after_help = STATUSES)]
    Unload(UnloadArguments),
    /// Show what accuracy costs in time: solve a scene in many ways, time each, measure each against a reference
    #[command(after_help = STATUSES)]
    Accuracy(AccuracyArguments),
    /// Run many variants of a scene, or a part of them: a grid, a table, a Latin hypercube
    #[command(after_help = STATUSES)]
    Sweep(SweepArguments),
    /// Run the hard cases: what must stay stable, or fail honestly
    #[command(after_help = STATUSES)]
    Hard(HardArguments),
    /// Measure what a step costs: sizes, elements, effects, backends, threads, schemes
    #[command(after_help = STATUSES)]
    Bench(BenchArguments),
    /// Print what a shell needs to complete sinew's words, to be put where the shell looks
    Completions {
        /// The shell
        shell: clap_complete::Shell,
    },
    /// Write manual pages: sinew.1, sinew-run.1 and so on
    Man {
        /// The folder to write them into, made if it is not there
        #[arg(value_name = "DIR")]
        folder: PathBuf,
    },
}

impl Command {
    /// Whether it looks for a GPU.
    pub fn may_open_a_gpu(&self) -> bool {
        match self {
            Command::Run(arguments) => arguments.how.backend != BackendName::Cpu,
            Command::Explain(arguments) => arguments.how.backend != BackendName::Cpu,
            Command::Render(_) => true,
            Command::Accuracy(arguments) => arguments.backend != BackendName::Cpu,
            Command::Sweep(arguments) => arguments.backend != BackendName::Cpu,
            Command::Hard(arguments) => arguments.backend != BackendName::Cpu,
            Command::Bench(arguments) => arguments.backends.contains(&"gpu".to_string()),
            Command::Check(_) | Command::Mesh(_) | Command::Modes(_) | Command::Unload(_) => false,
            Command::Completions { .. } | Command::Man { .. } | Command::View(_) => false,
        }
    }
}

/// Which scene.
#[derive(Args)]
pub struct SceneArguments {
    /// The scene file (.ron); - reads it from the standard input
    pub scene: PathBuf,
    /// Put a value into the scene, such as materials.tissue.density=1060; may be given several times
    #[arg(long, value_name = "PATH=VALUE")]
    pub set: Vec<String>,
    /// Let the scene name files outside its own folder
    #[arg(long)]
    pub allow_outside: bool,
}

impl SceneArguments {
    /// Reads the scene.
    pub fn load(&self) -> Result<SceneFile, Diagnostics> {
        let allowed = allowed(self.allow_outside);
        match self.scene == Path::new("-") {
            // files that it names are looked for where the command is called
            true => SceneFile::read_allowing("standard input", std::io::stdin(), Path::new(""), &self.set, allowed),
            false => SceneFile::load_allowing(&self.scene, &self.set, allowed),
        }
    }
}

/// What a scene may ask for.
pub fn allowed(outside: bool) -> Allowed {
    Allowed { outside, ..Allowed::default() }
}

/// What `sinew check` is told.
#[derive(Args)]
pub struct CheckArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// What is known of a sound scene as JSON: sizes, steps, and the stable step with the elements that set it
    #[arg(long)]
    pub json: bool,
    /// The number type that a run would have [default: f32, and f64 of a path by arc length, which is followed in no
    /// other]
    #[arg(long, value_enum)]
    pub precision: Option<PrecisionName>,
}

impl CheckArguments {
    /// The number type that a scene is checked in.
    pub fn precision_of(&self, scene: &SceneFile) -> Precision {
        match self.precision {
            Some(name) => name.into(),
            None if scene.scene.follows_path() => Precision::F64,
            None => Precision::F32,
        }
    }
}

/// Which device, and which numbers.
#[derive(Args, Clone)]
pub struct DeviceArguments {
    /// Which GPU: best, hardware, software, or a part of its name
    #[arg(long, value_name = "NAME", default_value = "best")]
    pub gpu: String,
    /// The number type; f64 is the reference and runs on the CPU only
    #[arg(long, value_enum, default_value_t = PrecisionName::F32)]
    pub precision: PrecisionName,
}

/// How to run it.
#[derive(Args)]
pub struct HowArguments {
    /// Where to run; auto takes a hardware GPU if there is one, else the CPU
    #[arg(long, value_enum, default_value_t = BackendName::Auto)]
    pub backend: BackendName,
    #[command(flatten)]
    pub device: DeviceArguments,
    /// CPU threads; 0 is one a core, or a single one for small bodies. Results are the same for any number
    #[arg(
        long,
        value_name = "N",
        default_value_t = 0,
        allow_negative_numbers = true,
        value_parser = clap::value_parser!(u16).range(0..=1024)
    )]
    pub threads: u16,
    /// How element forces are summed: patch by patch in cache or a GPU's workgroup memory, or in two passes over
    /// memory [default: patches, and two passes of small bodies on a GPU]
    #[arg(long, value_enum)]
    pub scheme: Option<SchemeName>,
}

#[derive(Args)]
pub struct RunArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    #[command(flatten)]
    pub how: HowArguments,
    /// The folder to write into, in place of an earlier run's output [default: out/NAME-OF-THE-SCENE]
    #[arg(short, long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Go on from a snapshot of the same scene, see output.snapshots_every; writes into out/NAME-OF-THE-SCENE-resumed
    #[arg(long, value_name = "FILE")]
    pub resume: Option<PathBuf>,
    /// Print the summary as JSON, and nothing else on the standard output
    #[arg(long)]
    pub json: bool,
}

#[derive(Args)]
pub struct AccuracyArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Wall time the study may take, such as 60s, 10min or 2h; a plain number is seconds. What does not fit is left out
    /// by name
    #[arg(long, value_name = "TIME", default_value = "50s", value_parser = wall_time)]
    pub budget: f64,
    /// The finest mesh to try, in the scene's cells along an edge: 2 has half the cell size
    #[arg(long, value_name = "TIMES", value_parser = above_zero)]
    pub finest: Option<f64>,
    /// The error that is good enough, such as 1% or 0.01; decides the exit status
    #[arg(long, value_name = "ERROR", value_parser = share)]
    pub target: Option<f64>,
    /// The quantity to judge by: displacement, tip.uz, tip.uz.over_time, energy.strain ... [default: the scene's]
    #[arg(long, value_name = "QUANTITY")]
    pub by: Option<String>,
    /// Tables of an earlier run to measure against: probe_NAME.csv, nodes.csv or its folder; may be given several times
    #[arg(long, value_name = "PATH")]
    pub reference: Vec<PathBuf>,
    /// Switch off each effect of the scene in turn and show what it costs and what it changes
    #[arg(long)]
    pub effects: bool,
    /// Where the scene as written runs: auto is the CPU, compared with a hardware GPU if there is one
    #[arg(long, value_enum, default_value_t = BackendName::Auto)]
    pub backend: BackendName,
    /// Which GPU: best, hardware, software, or a part of its name
    #[arg(long, value_name = "NAME", default_value = "best")]
    pub gpu: String,
    /// The number type of the scene as written
    #[arg(long, value_enum, default_value_t = PrecisionName::F32)]
    pub precision: PrecisionName,
    /// CPU threads; one, so that times can be compared with each other
    #[arg(
        long,
        value_name = "N",
        default_value_t = 1,
        allow_negative_numbers = true,
        value_parser = clap::value_parser!(u16).range(0..=1024)
    )]
    pub threads: u16,
    /// The folder to write into, in place of an earlier study [default: out/NAME-OF-THE-SCENE-accuracy]
    #[arg(short, long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

impl AccuracyArguments {
    /// How the scene as written runs.
    pub fn options(&self) -> Options {
        let backend = if self.backend == BackendName::Gpu { BackendName::Gpu } else { BackendName::Cpu };
        let device = DeviceArguments { gpu: self.gpu.clone(), precision: self.precision };
        HowArguments { backend, device, threads: self.threads, scheme: None }.options()
    }
}

#[derive(Args)]
pub struct ExplainArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    #[command(flatten)]
    pub how: HowArguments,
    /// Print JSON instead of a page
    #[arg(long)]
    pub json: bool,
    /// Print the whole WGSL of the kernels whose label contains this, instead of a page; of a run on a GPU
    #[arg(long, value_name = "LABEL", conflicts_with = "json")]
    pub kernel: Option<String>,
}

#[derive(Args)]
pub struct RenderArguments {
    /// An output folder, or a scene file; a scene is run first where its output is missing or older than it
    #[arg(value_name = "SCENE|OUT")]
    pub what: PathBuf,
    /// Put a value into the scene, such as picture.zoom=2; of an output folder into its picture. May be given several
    /// times
    #[arg(long, value_name = "PATH=VALUE")]
    pub set: Vec<String>,
    /// Let the scene name files outside its own folder
    #[arg(long)]
    pub allow_outside: bool,
    /// What gives the colour: displacement, speed, von_mises, pressure, volume_ratio, or a component such as
    /// displacement.z or stress.xy [default: the scene's]
    #[arg(long, value_name = "NAME")]
    pub field: Option<String>,
    /// Where the eye stands, seen from what it looks at: three numbers [default: the scene's]
    #[arg(long, value_name = "X,Y,Z", value_parser = direction, allow_hyphen_values = true)]
    pub from: Option<Vec3>,
    /// Width and height in pixels [default: the scene's]
    #[arg(long, value_name = "WxH", value_parser = size)]
    pub size: Option<(u32, u32)>,
    /// The time of the picture in seconds; an animation ends there [default: the end]
    #[arg(long, value_name = "TIME", value_parser = time)]
    pub at: Option<f64>,
    /// Draw the animation only
    #[arg(long, conflicts_with = "no_animation")]
    pub animate: bool,
    /// Draw the picture only
    #[arg(long)]
    pub no_animation: bool,
    /// The file to write: .png for a picture, .gif for an animation [default: picture.png and animation.gif in the
    /// output folder]
    #[arg(long, value_name = "FILE", conflicts_with_all = ["animate", "no_animation"])]
    pub to: Option<PathBuf>,
}

#[derive(Clone, Copy, ValueEnum, PartialEq, Eq)]
pub enum BackendName {
    Auto,
    Cpu,
    Gpu,
}

#[derive(Clone, Copy, ValueEnum)]
pub enum PrecisionName {
    F32,
    F64,
}

impl From<PrecisionName> for Precision {
    fn from(name: PrecisionName) -> Self {
        match name {
            PrecisionName::F32 => Precision::F32,
            PrecisionName::F64 => Precision::F64,
        }
    }
}

#[derive(Clone, Copy, ValueEnum)]
pub enum SchemeName {
    Patches,
    TwoPass,
}

impl HowArguments {
    /// What the library calls it.
    pub fn options(&self) -> Options {
        Options {
            backend: match self.backend {
                BackendName::Auto => BackendChoice::Auto,
                BackendName::Cpu => BackendChoice::Cpu,
                BackendName::Gpu => BackendChoice::Gpu,
            },
            precision: self.device.precision.into(),
            threads: self.threads.into(),
            gpu: Choice::parse(&self.device.gpu),
            scheme: self.scheme.map(|name| match name {
                SchemeName::Patches => Scheme::Patches,
                SchemeName::TwoPass => Scheme::TwoPass,
            }),
            forgets_start: true,
            ..Options::default()
        }
    }
}

/// Where the outputs of a scene go when nobody says where.
pub fn default_folder(scene: &Path) -> PathBuf {
    let name = if scene == Path::new("-") { "stdin".as_ref() } else { scene.file_stem().unwrap_or(scene.as_os_str()) };
    Path::new("out").join(name)
}
