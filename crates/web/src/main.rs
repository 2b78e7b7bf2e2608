//! `sinew-web` makes the page: compiles it to WebAssembly, makes what JavaScript calls, and says how large it is.

use clap::Parser;
use flate2::Compression;
use flate2::write::GzEncoder;
use std::error::Error;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use wasm_bindgen_cli_support::Bindgen;

/// Makes the page with the viewer: files to be put where a web server finds them.
#[derive(Parser)]
#[command(name = "sinew-web", version)]
struct Arguments {
    /// Where to put it
    #[arg(long, value_name = "DIR", default_value = "out/web")]
    out: PathBuf,
    /// The profile of Cargo that it is compiled by
    #[arg(long, default_value = "page")]
    profile: String,
    /// Fail if it is larger than so many bytes when a server sends it (packed by gzip)
    #[arg(long, value_name = "BYTES")]
    at_most: Option<usize>,
}

const TARGET: &str = "wasm32-unknown-unknown";
const PAGE: [(&str, &str); 2] =
    [("index.html", include_str!("../page/index.html")), ("wait.js", include_str!("../page/wait.js"))];

fn main() -> ExitCode {
    match make(&Arguments::parse()) {
        Ok(text) => {
            println!("{text}");
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("sinew-web: {error}");
            ExitCode::FAILURE
        }
    }
}

fn make(arguments: &Arguments) -> Result<String, Box<dyn Error>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), PathBuf::from);
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.args(["build", "--package", "sinew-web", "--lib", "--target", TARGET, "--profile", &arguments.profile]);
    // in the repository, whose .cargo/config.toml says for which processors
    cargo.current_dir(&root);
    if !cargo.status()?.success() {
        return Err(format!("it does not compile; is the target there? rustup target add {TARGET}").into());
    }
    // cargo's one exception among the folders of profiles
    let folder = if arguments.profile == "dev" { "debug" } else { &arguments.profile };
    let module = target.join(TARGET).join(folder).join("sinew_web.wasm");
    std::fs::create_dir_all(&arguments.out)?;
    Bindgen::new()
        .input_path(&module)
        .web(true)?
        .typescript(false)
        .remove_name_section(true)
        .generate(&arguments.out)?;
    for (name, text) in PAGE {
        std::fs::write(arguments.out.join(name), text)?;
    }
    let module = std::fs::read(arguments.out.join("sinew_web_bg.wasm"))?;
    let packed = packed(&module)?;
    let told = format!("{}: {} bytes of WebAssembly, {packed} packed by gzip", arguments.out.display(), module.len());
    match arguments.at_most.filter(|most| packed > *most) {
        Some(most) => Err(format!("{told}: more than {most}").into()),
        None => Ok(told),
    }
}

/// How many bytes a server sends of what it packs by gzip.
fn packed(bytes: &[u8]) -> std::io::Result<usize> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(bytes)?;
    Ok(encoder.finish()?.len())
}
