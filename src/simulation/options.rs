//! How to run a scene: what is not the scene's business.

use crate::backend::cpu::Instructions;
use crate::backend::gpu::{Choice, Gpu, Host, NoGpu, SmallerLimits};
use crate::components::{Precision, Scheme};
use crate::error::Error;

/// Where to run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BackendChoice {
    /// A hardware GPU if there is one and the precision is f32, else the CPU.
    #[default]
    Auto,
    /// The CPU.
    Cpu,
    /// The GPU, a software device if there is no other.
    Gpu,
}

/// How to run a scene.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Where to run.
    pub backend: BackendChoice,
    /// The number type.
    pub precision: Precision,
    /// CPU threads; 0: one a core, and one only for bodies too small to share.
    pub threads: usize,
    /// Which vector registers the CPU's kernels use: fewer for trying out what becomes of a scene on a smaller machine.
    pub instructions: Instructions,
    /// Which GPU, when there are several.
    pub gpu: Choice,
    /// A device that the program has opened already, to run on in place of one of our own, if it is what is wanted.
    pub host: Option<Host>,
    /// How element forces are summed; `None`: patch by patch, but in two passes where a GPU has too few patches to work
    /// on at once.
    pub scheme: Option<Scheme>,
    /// Less than that GPU allows, for trying out what becomes of a scene on a smaller one.
    pub gpu_limits: SmallerLimits,
    /// Whether a program may [grab](crate::Simulation::grab) bodies while it runs: they have forces on nodes then.
    pub grabs: bool,
    /// Whether the state before the first step is not kept: then nobody can [reset](crate::Simulation::reset).
    pub forgets_start: bool,
}

/// What was chosen, and why.
pub(super) struct Chosen {
    pub gpu: Option<Gpu>,
    pub why: String,
}

/// Chooses the backend; of some things there is one only, and others instead.
pub(super) fn choose(options: &Options, of_the_cpu: Option<[String; 2]>) -> Result<Chosen, Error> {
    let cpu = |why: String| Ok(Chosen { gpu: None, why });
    match (options.backend, of_the_cpu) {
        (BackendChoice::Gpu, Some([what, instead])) => {
            return Err(Error::Options(format!("{what}: use --backend cpu, or {instead}")));
        }
        (BackendChoice::Auto, Some([what, _])) => return cpu(what),
        _ => {}
    }
    let open = |choice: &Choice| {
        let mut gpu = match &options.host {
            Some(host) => Gpu::adopt(host.clone(), choice)?,
            None => Gpu::open(choice)?,
        };
        gpu.keep_to(options.gpu_limits);
        Ok(gpu)
    };
    match (options.backend, options.precision) {
        (BackendChoice::Cpu, _) => cpu("asked for".into()),
        (BackendChoice::Gpu, Precision::F64) => {
            Err(Error::Options("the GPU computes in f32 only: use --precision f32, or --backend cpu for f64".into()))
        }
        (BackendChoice::Gpu, Precision::F32) => {
            let gpu = open(&options.gpu)?;
            let why = format!("asked for; {}", gpu.report());
            Ok(Chosen { gpu: Some(gpu), why })
        }
        (BackendChoice::Auto, Precision::F64) => cpu("f64 runs on the CPU only".into()),
        (BackendChoice::Auto, Precision::F32) => {
            let wanted = if options.gpu == Choice::Best { Choice::Hardware } else { options.gpu.clone() };
            match open(&wanted) {
                Ok(gpu) => {
                    let why = format!("a hardware GPU is there: {}", gpu.report());
                    Ok(Chosen { gpu: Some(gpu), why })
                }
                Err(NoGpu::NoDriver) => cpu("no driver shows a GPU".into()),
                Err(NoGpu::NoMatch { found, .. }) => {
                    cpu(format!("there is no hardware GPU, only {}", found.join(", ")))
                }
                Err(refused) => cpu(refused.to_string()),
            }
        }
    }
}
