//! The words of `sinew sweep`.

use super::{BackendName, DeviceArguments, HowArguments};
use clap::Args;
use sinew::Options;
use sinew_studies::sweep::Part;
use std::path::PathBuf;

/// What `sinew sweep` is told.
#[derive(Args)]
pub struct SweepArguments {
    /// The file of the sweep (.ron): which scene, which values at which places, which probes
    pub sweep: PathBuf,
    /// A part of it: 3/16 is every sixteenth variant from the third on
    #[arg(long, value_name = "K/N", value_parser = part, default_value = "1/1")]
    pub part: Part,
    /// Variants that run at once, each on one thread; 0 is one a core. Results are the same for any number
    #[arg(
        long,
        value_name = "N",
        default_value_t = 0,
        allow_negative_numbers = true,
        value_parser = clap::value_parser!(u16).range(0..=1024)
    )]
    pub threads: u16,
    /// Where to run; auto is the CPU, for whoever has many variants has work for all cores
    #[arg(long, value_enum, default_value_t = BackendName::Cpu)]
    pub backend: BackendName,
    #[command(flatten)]
    pub device: DeviceArguments,
    /// Let the scene name files outside its own folder
    #[arg(long)]
    pub allow_outside: bool,
    /// The folder of the results; what is done there is not done again [default: out/NAME-OF-THE-SWEEP]
    #[arg(short, long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

impl SweepArguments {
    /// How each variant runs.
    pub fn options(&self) -> Options {
        let backend = if self.backend == BackendName::Gpu { BackendName::Gpu } else { BackendName::Cpu };
        HowArguments { backend, device: self.device.clone(), threads: 1, scheme: None }.options()
    }

    /// How many run at once.
    pub fn at_once(&self) -> usize {
        match self.threads {
            0 => std::thread::available_parallelism().map_or(1, |cores| cores.get()),
            threads => threads.into(),
        }
    }
}

fn part(text: &str) -> Result<Part, String> {
    let numbers = text.split_once('/').and_then(|(which, of)| Some((which.parse().ok()?, of.parse().ok()?)));
    match numbers {
        Some((which, of)) if (1..=of).contains(&which) => Ok(Part { which, of }),
        _ => Err("a part and how many there are is wanted, such as 3/16".into()),
    }
}
