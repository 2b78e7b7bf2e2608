//! `sinew explain`: what a scene causes.

use super::Outcome;
use super::arguments::{BackendName, ExplainArguments};
use super::failure::Failure;
use super::progress;
use super::terminal::{self, Paint};
use sinew::explain::Explanation;
use sinew::systems::Registry;
use sinew::{BackendChoice, Error, Options, SceneFile, Simulation};

/// Prints a page or JSON.
pub fn command(arguments: &ExplainArguments) -> Outcome {
    let scene = arguments.scene.load()?;
    let work = || explanation(&scene, &arguments.how.options(), arguments.how.backend);
    let explanation = progress::during("reading meshes, building the simulation", work)?;
    if arguments.json {
        let text = serde_json::to_string_pretty(&explanation).map_err(|error| Failure::Silent(error.into()))?;
        return terminal::hand_out(&format!("{text}\n"));
    }
    if let Some(label) = &arguments.kernel {
        return terminal::hand_out(&listings(&explanation, label)?);
    }
    terminal::hand_out(&with_headings(&explanation.to_string(), Paint::of_stdout()))
}

/// The text of kernels whose label contains a word.
fn listings(Explanation { kernels, on_gpu, .. }: &Explanation, label: &str) -> Result<String, Failure> {
    if !on_gpu {
        let reason =
            "--kernel: the scene would run on the CPU, where there is no WGSL; --backend gpu tells what a GPU runs";
        return Err(Failure::Options(reason.into()));
    }
    let wanted = label.to_lowercase();
    let found = kernels.iter().filter(|kernel| kernel.label.to_lowercase().contains(&wanted));
    let found: Vec<&str> = found.map(|kernel| kernel.listing.as_str()).collect();
    if found.is_empty() {
        let labels: Vec<&str> = kernels.iter().map(|kernel| kernel.label.as_str()).collect();
        let labels = if labels.is_empty() { "there are none".into() } else { labels.join(", ") };
        return Err(Failure::Options(format!("--kernel {label}: no kernel's label contains that (kernels: {labels})")));
    }
    Ok(found.join("\n\n"))
}

/// On the backend that a run would take; a GPU that is asked for need not be there.
fn explanation(scene: &SceneFile, options: &Options, backend: BackendName) -> Result<Explanation, Error> {
    let registry = Registry::default();
    match Simulation::with_systems(scene, options, &registry) {
        Err(Error::NoGpu(reason)) if backend == BackendName::Gpu => {
            let on_cpu = Options { backend: BackendChoice::Cpu, ..options.clone() };
            let mut simulation = Simulation::with_systems(scene, &on_cpu, &registry)?;
            let mut explanation = simulation.explain_on_gpu(&registry)?;
            explanation.backend_because = format!("asked for, though a run would fail here: {reason}");
            Ok(explanation)
        }
        made => {
            let mut simulation = made?;
            terminal::aside(&simulation.warnings().render(Paint::of_stderr().is_on()));
            simulation.explain(&registry)
        }
    }
}

/// Lines that are not set in are headings.
fn with_headings(page: &str, paint: Paint) -> String {
    let line = |line: &str| match line.starts_with(' ') || line.is_empty() {
        true => format!("{line}\n"),
        false => format!("{}\n", paint.bold(line)),
    };
    page.lines().map(line).collect()
}
