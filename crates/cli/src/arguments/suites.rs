//! The words of what sinew runs of itself: hard cases and benchmarks.

use super::BackendName;
use clap::Args;
use clap::builder::PossibleValuesParser;
use sinew::mesh::ElementKind;
use std::path::PathBuf;
use std::sync::LazyLock;

/// All element types by the words of benchmarks: those of scenes in small letters, such as `tet4-nodal-pressure`.
pub static ELEMENTS: LazyLock<Vec<(String, ElementKind)>> = LazyLock::new(|| {
    let word = |kind: ElementKind| {
        let mut word = String::new();
        for letter in kind.name().chars() {
            if letter.is_uppercase() && !word.is_empty() {
                word.push('-');
            }
            word.push(letter.to_ascii_lowercase());
        }
        word
    };
    ElementKind::ALL.map(|kind| (word(kind), kind)).into()
});

#[derive(Args)]
pub struct HardArguments {
    /// The cases, such as H05 or buckling [default: all]
    #[arg(value_name = "CASE")]
    pub cases: Vec<String>,
    /// In full size, with finer meshes, longer runs and timed gates; else in a size for everyday
    #[arg(long)]
    pub full: bool,
    /// Where: auto is the CPU in f64 and f32, and a GPU if there is any, a software one too
    #[arg(long, value_enum, default_value_t = BackendName::Auto)]
    pub backend: BackendName,
    /// A folder for hard.md, hard.csv and hard.json
    #[arg(short, long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

#[derive(Args)]
pub struct BenchArguments {
    /// Cells along each edge of the cubes
    #[arg(
        long,
        value_name = "N,..",
        value_delimiter = ',',
        default_values_t = [10, 20, 30],
        value_parser = clap::value_parser!(u32).range(1..=200)
    )]
    pub cells: Vec<u32>,
    /// Element types
    #[arg(
        long,
        value_name = "NAME,..",
        value_delimiter = ',',
        default_values_t = ["tet4".to_string(), "hex8".to_string()],
        value_parser = PossibleValuesParser::new(ELEMENTS.iter().map(|(word, _)| word.as_str()))
    )]
    pub elements: Vec<String>,
    /// Effects beside neo-Hookean elasticity
    #[arg(
        long,
        value_name = "NAME,..",
        value_delimiter = ',',
        default_values_t = ["none".to_string(), "fibres-viscosity".to_string()],
        value_parser = ["none", "fibres", "viscosity", "fibres-viscosity"]
    )]
    pub effects: Vec<String>,
    /// Where
    #[arg(
        long,
        value_name = "NAME,..",
        value_delimiter = ',',
        default_values_t = ["cpu".to_string()],
        value_parser = ["cpu", "gpu"]
    )]
    pub backends: Vec<String>,
    /// Number types; GPUs have f32 only
    #[arg(
        long,
        value_name = "NAME,..",
        value_delimiter = ',',
        default_values_t = ["f32".to_string()],
        value_parser = ["f32", "f64"]
    )]
    pub precisions: Vec<String>,
    /// CPU threads [default: 1 and one a core]
    #[arg(long, value_name = "N,..", value_delimiter = ',', value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Vec<u16>,
    /// Vector registers of the CPU: the widest it has, AVX2 also where there is AVX-512, or what any machine has
    #[arg(
        long,
        value_name = "NAME,..",
        value_delimiter = ',',
        default_values_t = ["widest".to_string()],
        value_parser = ["widest", "avx2", "portable"]
    )]
    pub instructions: Vec<String>,
    /// How element forces are summed
    #[arg(
        long,
        value_name = "NAME,..",
        value_delimiter = ',',
        default_values_t = ["patches".to_string(), "two-pass".to_string()],
        value_parser = ["patches", "two-pass"]
    )]
    pub schemes: Vec<String>,
    /// Whether systems share kernels and loops where they can, or are kept apart
    #[arg(
        long,
        value_name = "WORD,..",
        value_delimiter = ',',
        default_values_t = ["on".to_string()],
        value_parser = ["on", "off"]
    )]
    pub fuse: Vec<String>,
    /// What pulls at the cubes: nothing, the engine's gravity, or the same as a system of one's own, in Rust or in WGSL
    #[arg(
        long,
        value_name = "NAME,..",
        value_delimiter = ',',
        default_values_t = ["gravity".to_string()],
        value_parser = ["none", "gravity", "rust", "wgsl"]
    )]
    pub loads: Vec<String>,
    /// Seconds for each case
    #[arg(long, value_name = "S", default_value_t = 0.5)]
    pub seconds: f64,
    /// A folder for bench.csv, bench.json, bench.md and the plots
    #[arg(short, long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// An earlier bench.json: cases that take over a tenth longer now are told, and the status is 1
    #[arg(long, value_name = "FILE")]
    pub compare: Option<PathBuf>,
}
