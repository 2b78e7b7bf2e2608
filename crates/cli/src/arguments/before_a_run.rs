//! The words of what is done before a run: meshes, natural modes, unloaded shapes.

use super::SceneArguments;
use clap::Args;
use std::path::PathBuf;

/// What `sinew mesh` is told.
#[derive(Args)]
pub struct MeshArguments {
    /// A mesh file (Gmsh, VTK, VTU), or a scene file (.ron), whose bodies are shown as it places them
    #[arg(value_name = "FILE|SCENE")]
    pub what: PathBuf,
    /// Put a value into the scene first; may be given several times
    #[arg(long, value_name = "PATH=VALUE")]
    pub set: Vec<String>,
    /// Let the scene name files outside its own folder
    #[arg(long)]
    pub allow_outside: bool,
    /// Turn inverted elements of a mesh file the right way round
    #[arg(long)]
    pub flip_inverted: bool,
    /// Print JSON instead of a page; no picture
    #[arg(long)]
    pub json: bool,
    /// Draw no picture
    #[arg(long)]
    pub no_picture: bool,
    /// The folder for the picture and fields.pvd, in place of earlier ones [default: out/NAME-mesh]
    #[arg(short, long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// What `sinew modes` is told.
#[derive(Args)]
pub struct ModesArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// How many modes
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u16).range(1..=100))]
    pub count: u16,
    /// CPU threads; 0 is one a core, or a single one for small bodies
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u16).range(0..=1024))]
    pub threads: u16,
    /// Print JSON instead of a table; no picture
    #[arg(long)]
    pub json: bool,
    /// Draw no picture
    #[arg(long)]
    pub no_picture: bool,
    /// The folder for the animation and fields.pvd, in place of earlier ones [default: out/NAME-OF-THE-SCENE-modes]
    #[arg(short, long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// What `sinew unload` is told.
#[derive(Args)]
pub struct UnloadArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// How far loaded nodes may be from the mesh, as a share of the diagonal of the box around all bodies
    #[arg(long, value_name = "SHARE", default_value_t = 1e-4, value_parser = share)]
    pub tolerance: f64,
    /// Static analyses at most
    #[arg(long, value_name = "N", default_value_t = 40, value_parser = clap::value_parser!(u16).range(1..=10000))]
    pub most: u16,
    /// CPU threads; 0 is one a core, or a single one for small bodies
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u16).range(0..=1024))]
    pub threads: u16,
    /// The folder for the unloaded meshes and the scene, in place of earlier ones [default:
    /// out/NAME-OF-THE-SCENE-unloaded]
    #[arg(short, long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

fn share(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(share) if share > 0.0 && share < 1.0 => Ok(share),
        _ => Err("a number above 0 and below 1 is wanted, such as 1e-4".into()),
    }
}

/// What `sinew view` is told.
#[derive(Args)]
pub struct ViewArguments {
    /// The scene or the folder of a run, and what else sinew-view takes (sinew-view --help)
    #[arg(trailing_var_arg = true, allow_hyphen_values = true, value_name = "SCENE")]
    pub words: Vec<std::ffi::OsString>,
}
