//! The words of the command line.

use clap::{Args, Parser, Subcommand, ValueEnum};
use sinew::backend::gpu::Choice;
use sinew::components::Precision;
use sinew::{BackendChoice, Options};
use std::path::{Path, PathBuf};

const STATUSES: &str = "\
Exit status:
  0    done
  1    the simulation broke down; what was written until then is kept
  2    the scene or the options are wrong; nothing was run
  3    outputs could not be written
  4    there is no GPU, or it failed
  130  interrupted; what was written until then is kept";

/// Soft tissue, fast: total Lagrangian explicit finite elements on the CPU and the GPU.
#[derive(Parser)]
#[command(name = "sinew", version, after_help = STATUSES, max_term_width = 100)]
pub struct Arguments {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Subcommand)]
pub enum Command {
    /// Run a scene and write what it asks for into a folder
    #[command(after_help = STATUSES)]
    Run(RunArguments),
}

/// Which scene.
#[derive(Args)]
pub struct SceneArguments {
    /// The scene file (.ron)
    pub scene: PathBuf,
    /// Put a value into the scene in place of what stands there, or as something new:
    /// --set materials.tissue.density=1060 --set 'bodies.cube.mesh.cells=(20, 20, 20)'
    #[arg(long, value_name = "PATH=VALUE")]
    pub set: Vec<String>,
}

/// How to run it.
#[derive(Args)]
pub struct HowArguments {
    /// Where to run; auto takes a hardware GPU if there is one, else the CPU
    #[arg(long, value_enum, default_value_t = BackendName::Auto)]
    pub backend: BackendName,
    /// Which GPU: best, hardware, software, or a part of its name
    #[arg(long, value_name = "NAME", default_value = "best")]
    pub gpu: String,
    /// The number type; f64 is the reference and runs on the CPU only
    #[arg(long, value_enum, default_value_t = PrecisionName::F32)]
    pub precision: PrecisionName,
    /// CPU threads; 0 is one a core. Results are the same for any number
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u16).range(0..=1024))]
    pub threads: u16,
}

#[derive(Args)]
pub struct RunArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    #[command(flatten)]
    pub how: HowArguments,
    /// The folder to write into; what an earlier run has left there is replaced [default: out/NAME-OF-THE-SCENE]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
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

impl HowArguments {
    /// What the library calls it.
    pub fn options(&self) -> Options {
        Options {
            backend: match self.backend {
                BackendName::Auto => BackendChoice::Auto,
                BackendName::Cpu => BackendChoice::Cpu,
                BackendName::Gpu => BackendChoice::Gpu,
            },
            precision: match self.precision {
                PrecisionName::F32 => Precision::F32,
                PrecisionName::F64 => Precision::F64,
            },
            threads: self.threads.into(),
            gpu: Choice::parse(&self.gpu),
        }
    }
}

/// Where the outputs of a scene go when nobody says where.
pub fn default_folder(scene: &Path) -> PathBuf {
    Path::new("out").join(scene.file_stem().unwrap_or(scene.as_os_str()))
}
