//! `sinew unload`: the unloaded shape of a scene whose meshes show its bodies loaded, as scans do.

use super::arguments::{UnloadArguments, default_folder};
use super::failure::Failure;
use super::wording::{counted, quantity};
use super::{Outcome, progress, terminal};
use sinew::assembly::mesh_of;
use sinew::components::Precision;
use sinew::output::{Folder, OutputError, replace, write_gmsh};
use sinew::scene::schema::{InitialState, MeshSource};
use sinew::{BackendChoice, Options, SceneFile, Unloaded, Unloading, UnloadingStep, unload};
use std::collections::BTreeMap;
use std::io::Write;
use std::path::Path;

/// The scene that begins at the unloaded shape, in the output folder.
const SCENE: &str = "scene.ron";

/// Seeks the unloaded shape, tells how near each iteration comes, and writes meshes and a scene.
pub fn command(arguments: &UnloadArguments) -> Outcome {
    let scene = arguments.scene.load()?;
    let options = Options {
        backend: BackendChoice::Cpu,
        precision: Precision::F64,
        threads: arguments.threads.into(),
        ..Options::default()
    };
    let how = Unloading { tolerance: arguments.tolerance, most: arguments.most.into() };
    terminal::say("iteration  largest distance  mean square   pseudo-steps\n")?;
    let mut silent = Ok(());
    let found = progress::during("seeking the unloaded shape", || {
        unload(&scene, &options, &how, |step| silent = terminal::say(&line(step)))
    });
    let found = found?;
    silent?;
    let mut name = default_folder(&arguments.scene.scene).into_os_string();
    name.push("-unloaded");
    let path = arguments.out.clone().unwrap_or_else(|| name.into());
    let files = write(&scene, &found, &path)?;
    let largest = found.iterations.last().map_or(0.0, |step| step.largest);
    terminal::say(&format!(
        "unloaded    after {}: loaded, nodes are within {} of the mesh ({} are allowed)\nwritten     {}: {}\nrun it      sinew run {}\n",
        counted(found.iterations.len() as u64, "iteration"),
        quantity(largest, "m"),
        quantity(found.allowed, "m"),
        path.display(),
        files.join(", "),
        sinew::shell_word(&path.join(SCENE))
    ))
}

fn line(step: &UnloadingStep) -> String {
    let (largest, mean) = (quantity(step.largest, "m"), quantity(step.mean_square, "m"));
    format!("{:>9}  {largest:<16}  {mean:<12}  {}\n", step.number, step.steps)
}

/// Writes the unloaded meshes, a copy of each file that the scene names, and the scene that begins with them; their
/// names.
fn write(scene: &SceneFile, found: &Unloaded, path: &Path) -> Result<Vec<String>, Failure> {
    let mut folder = Folder::create_for(path, &scene.path.display().to_string())?;
    let (mut names, mut sets) = (Vec::new(), Vec::new());
    let mut copies = Copies::default();
    for (name, rest) in &found.rest {
        let body = &scene.scene.bodies[name];
        let mut mesh = mesh_of(body, scene).map_err(|error| Failure::Options(error.to_string()))?;
        mesh.points.clone_from(rest);
        let file = if found.rest.len() == 1 { "unloaded.msh".into() } else { format!("unloaded_{name}.msh") };
        write_gmsh(&folder.claim(&file)?, &mesh)?;
        sets.push(format!("bodies.\"{name}\".rest_shape=\"{file}\""));
        if let MeshSource::File { path, .. } = &body.mesh {
            let copy = copies.of(path, scene, &mut folder)?;
            sets.push(format!("bodies.\"{name}\".mesh.path=\"{copy}\""));
        }
        names.push(file);
    }
    for (name, body) in &scene.scene.bodies {
        if let Some(skin) = &body.skin {
            sets.push(format!("bodies.\"{name}\".skin.file=\"{}\"", copies.of(&skin.file, scene, &mut folder)?));
            if let Some(image) = &skin.image {
                sets.push(format!("bodies.\"{name}\".skin.image=\"{}\"", copies.of(image, scene, &mut folder)?));
            }
        }
    }
    for (name, material) in &scene.scene.materials {
        if let Some(law) = material.law.as_ref().filter(|law| !law.file.is_empty()) {
            sets.push(format!("materials.\"{name}\".law.file=\"{}\"", copies.of(&law.file, scene, &mut folder)?));
        }
    }
    for (name, system) in &scene.scene.systems {
        sets.push(format!("systems.\"{name}\".file=\"{}\"", copies.of(&system.file, scene, &mut folder)?));
    }
    if scene.scene.start == InitialState::Undeformed && !scene.scene.is_static() {
        sets.push("start=Equilibrium()".into());
    }
    let text = SceneFile::from_text_allowing(SCENE, scene.text(), path, &sets, scene.allowed)?;
    let file = folder.claim(SCENE)?;
    replace(&file, |file| {
        file.write_all(text.text().as_bytes()).map_err(OutputError::system("write", &path.join(SCENE)))
    })?;
    names.extend(copies.names.into_values());
    names.push(SCENE.into());
    Ok(names)
}

/// Files that the scene names, copied beside the new scene: the name of each there.
#[derive(Default)]
struct Copies {
    names: BTreeMap<String, String>,
}

impl Copies {
    fn of(&mut self, file: &str, scene: &SceneFile, folder: &mut Folder) -> Result<String, Failure> {
        if let Some(name) = self.names.get(file) {
            return Ok(name.clone());
        }
        let from = scene.file(file).map_err(|outside| Failure::Options(outside.to_string()))?;
        let plain = from.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let taken = |name: &String| self.names.values().any(|other| other == name) || name.starts_with("unloaded");
        let mut name = plain.clone();
        let mut number = 1;
        while taken(&name) || name == SCENE {
            number += 1;
            name = format!("{number}_{plain}");
        }
        let to = folder.claim(&name)?;
        std::fs::copy(&from, &to).map_err(OutputError::system("write", &to))?;
        self.names.insert(file.into(), name.clone());
        Ok(name)
    }
}
