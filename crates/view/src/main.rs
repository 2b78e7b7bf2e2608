//! `sinew-view`: the viewer as a program of its own, which `sinew view` starts.

use clap::{Parser, ValueEnum};
use eframe::egui;
use sinew::components::Precision;
use sinew::scene::schema::OutputField;
use sinew::{BackendChoice, Options};
use sinew_view::{App, FIELDS, Settings, Shot, Start};
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

/// Shows a scene while it runs: look at it from all sides, pull at it, change it.
#[derive(Parser)]
#[command(name = "sinew-view", version)]
struct Arguments {
    /// The scene; one can be dropped on the window, too.
    scene: Option<PathBuf>,
    /// Put a value into the scene: --set bodies.cube.mesh.cells=(4, 4, 4)
    #[arg(long = "set", value_name = "PATH=VALUE")]
    sets: Vec<String>,
    /// Where to run.
    #[arg(long, value_enum, default_value = "auto")]
    backend: Backend,
    /// Compute in double precision.
    #[arg(long)]
    f64: bool,
    /// CPU threads; 0: one a core.
    #[arg(long, default_value_t = 0)]
    threads: usize,
    /// Run at once.
    #[arg(long)]
    run: bool,
    /// Colour by a field: von_mises, displacement and so on, as sinew render has them
    #[arg(long)]
    field: Option<String>,
    /// Write a picture of the window into a file, and close it
    #[arg(long, value_name = "FILE")]
    shot: Option<PathBuf>,
    /// When to do so, after the start (s)
    #[arg(long, value_name = "SECONDS", default_value_t = 3.0, requires = "shot")]
    after: f64,
    /// Begin in dark colours.
    #[arg(long)]
    dark: bool,
}

#[derive(Clone, Copy, ValueEnum)]
enum Backend {
    Auto,
    Cpu,
    Gpu,
}

fn field(name: &str) -> Option<OutputField> {
    FIELDS.into_iter().find(|field| field.array() == name)
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let field = match arguments.field.as_deref().map(|name| (name, field(name))) {
        None => None,
        Some((_, Some(field))) => Some(field),
        Some((name, None)) => {
            let names: Vec<&str> = FIELDS.iter().map(|field| field.array()).collect();
            eprintln!("sinew-view: there is no field {name}; there are {}", names.join(", "));
            return ExitCode::from(2);
        }
    };
    let backend = match arguments.backend {
        Backend::Auto => BackendChoice::Auto,
        Backend::Cpu => BackendChoice::Cpu,
        Backend::Gpu => BackendChoice::Gpu,
    };
    let precision = if arguments.f64 { Precision::F64 } else { Precision::F32 };
    let start = Start {
        options: Options { backend, precision, threads: arguments.threads, ..Options::default() },
        scene: arguments.scene,
        sets: arguments.sets,
        run: arguments.run,
        settings: Settings { dark: arguments.dark, field, ..Settings::default() },
        shot: arguments
            .shot
            .map(|path| Shot::new(path, Duration::try_from_secs_f64(arguments.after).unwrap_or_default())),
    };
    let viewport = egui::ViewportBuilder::default().with_inner_size([1280.0, 800.0]).with_title("sinew");
    let options = eframe::NativeOptions { viewport, ..eframe::NativeOptions::default() };
    let app: eframe::AppCreator<'_> =
        Box::new(|context| Ok(Box::new(App::new(&context.egui_ctx, start, context.wgpu_render_state.clone()))));
    match eframe::run_native("sinew", options, app) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("sinew-view: no window can be opened: {error}");
            eprintln!(
                "it needs a screen and a Vulkan, Metal or DX12 driver (Mesa's lavapipe will do); sinew render needs neither"
            );
            ExitCode::FAILURE
        }
    }
}
