//! `sinew-view`: the viewer as a program of its own, which `sinew view` starts.

use clap::{Parser, ValueEnum};
use eframe::egui;
use sinew::components::Precision;
use sinew::scene::schema::OutputField;
use sinew::{BackendChoice, Options, Snapshot};
use sinew_view::{App, FIELDS, Settings, Shot, Start, headless, measure, screen};
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

/// Shows a scene while it runs: look at it from all sides, pull at it, change it.
#[derive(Parser)]
#[command(name = "sinew-view", version)]
struct Arguments {
    /// The scene, or the folder of a finished run; one can be dropped on the window, too.
    scene: Option<PathBuf>,
    /// Put a value into the scene: --set bodies.cube.mesh.cells=(4, 4, 4)
    #[arg(long = "set", value_name = "PATH=VALUE")]
    sets: Vec<String>,
    /// Begin with a state of the scene: a snapshot of sinew run, or one that a program has written
    #[arg(long, value_name = "FILE", conflicts_with = "frame_times")]
    resume: Option<PathBuf>,
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
    /// Film it without a window, into a .gif, a .mp4 (by ffmpeg) or a folder of PNG files
    #[arg(long, value_name = "FILE", conflicts_with = "shot")]
    film: Option<PathBuf>,
    /// Simulated seconds a second of the film, and of what is measured
    #[arg(long, default_value_t = 1.0)]
    speed: f64,
    /// Say how long so many frames take without a window, with the body pulled at
    #[arg(long, value_name = "FRAMES", conflicts_with_all = ["shot", "film"])]
    frame_times: Option<usize>,
    /// Width and height of what is drawn without a window (pixels)
    #[arg(long, value_parser = size, default_value = "1280x800")]
    size: (u32, u32),
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

fn size(text: &str) -> Result<(u32, u32), String> {
    let parts = text.split_once('x').and_then(|(width, height)| Some((width.parse().ok()?, height.parse().ok()?)));
    parts.filter(|(width, height)| (16..=8192).contains(width) && (16..=8192).contains(height)).ok_or_else(|| {
        format!("{text:?} is no size: width and height from 16 to 8192 pixels, such as 1280x800, are wanted")
    })
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
    if arguments.speed.is_nan() || arguments.speed <= 0.0 {
        eprintln!("sinew-view: --speed {}: it must be above 0", arguments.speed);
        return ExitCode::from(2);
    }
    let resume = match arguments.resume.as_deref().map(Snapshot::read).transpose() {
        Ok(snapshot) => snapshot.map(Box::new),
        Err(error) => {
            eprintln!("sinew-view: {error}");
            return ExitCode::from(2);
        }
    };
    let mut start = Start {
        resume,
        options: Options { backend, precision, threads: arguments.threads, ..Options::default() },
        scene: arguments.scene,
        sets: arguments.sets,
        run: arguments.run,
        settings: Settings { dark: arguments.dark, field, ..Settings::default() },
        shot: arguments
            .shot
            .map(|path| Shot::new(path, Duration::try_from_secs_f64(arguments.after).unwrap_or_default())),
        bundle: None,
    };
    let told = match (&arguments.film, arguments.frame_times) {
        (Some(film), _) => Some(headless::film(&start, film, arguments.size, arguments.speed)),
        (None, Some(frames)) => Some(measure::frame_times(&start, frames, arguments.size, arguments.speed)),
        (None, None) => None,
    };
    if let Some(told) = told {
        return match told {
            Ok(text) => {
                println!("{text}");
                ExitCode::SUCCESS
            }
            Err(text) => {
                eprintln!("sinew-view: {text}");
                ExitCode::FAILURE
            }
        };
    }
    let viewport = egui::ViewportBuilder::default().with_inner_size([1280.0, 800.0]).with_title("sinew");
    let wgpu_options = screen::configuration();
    let options = eframe::NativeOptions { viewport, wgpu_options, ..eframe::NativeOptions::default() };
    let app: eframe::AppCreator<'_> = Box::new(|context| {
        start.options.host = screen::host(context);
        Ok(Box::new(App::on_screen(context, start)))
    });
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
