//! `sinew unload`: the unloaded shape of a scene whose meshes show its bodies loaded, as scans do.

use super::arguments::{UnloadArguments, default_folder};
use super::failure::Failure;
use super::wording::{counted, quantity};
use super::{Outcome, progress, terminal};
use sinew::assembly::mesh_of;
use sinew::components::Precision;
use sinew::output::{Folder, OutputError, replace, write_gmsh};
use sinew::scene::schema::{EquilibriumSearch, InitialState};
use sinew::scene::syntax::Segment;
use sinew::scene::{Diagnostics, NamedFile};
use sinew::{BackendChoice, Options, SceneFile, Simulation, Unloaded, Unloading, UnloadingStep, unload};
use std::collections::BTreeMap;
use std::io::Write;
use std::path::Path;

/// The scene that begins at the unloaded shape, in the output folder.
const SCENE: &str = "scene.ron";

/// Seeks the unloaded shape, tells how near each iteration comes, and writes meshes and a scene.
pub fn command(arguments: &UnloadArguments) -> Outcome {
    let scene = arguments.scene.load()?;
    // what cannot be written is not sought
    let plan = Plan::of(&scene)?;
    let options = Options {
        backend: BackendChoice::Cpu,
        precision: Precision::F64,
        threads: arguments.threads.into(),
        ..Options::default()
    };
    look_at_all(&scene, &options)?;
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
    let files = plan.write(&scene, &found, &path)?;
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

/// Refuses what would be wrong with the scene that is written, also in what the search for rest leaves out: removal,
/// suction, probes.
fn look_at_all(scene: &SceneFile, options: &Options) -> Result<(), Failure> {
    let mut whole = scene.clone();
    whole.scene.bodies.values_mut().for_each(|body| body.rest_shape = None);
    if whole.scene.start == InitialState::Undeformed && !whole.scene.is_static() {
        whole.scene.start = InitialState::Equilibrium(EquilibriumSearch::default());
    }
    Ok(Simulation::new(&whole, options).map(drop)?)
}

fn line(step: &UnloadingStep) -> String {
    let (largest, mean) = (quantity(step.largest, "m"), quantity(step.mean_square, "m"));
    format!("{:>9}  {largest:<16}  {mean:<12}  {}\n", step.number, step.steps)
}

/// What is written: meshes, copies of files, and the scene that names them.
#[derive(Default)]
struct Plan {
    /// The file of the unloaded mesh of each body.
    meshes: BTreeMap<String, String>,
    /// Files that the scene names, and what they name: the name of each in the folder.
    copies: BTreeMap<String, String>,
    /// Values that make of the scene the one that begins at the unloaded shape.
    sets: Vec<String>,
}

impl Plan {
    /// Refuses scenes that cannot begin at an unloaded shape.
    fn of(scene: &SceneFile) -> Result<Self, Failure> {
        let mut plan = Self::default();
        for file in scene.named_files() {
            // another takes its place
            if file.field.0.last() != Some(&Segment::Name("rest_shape".into())) {
                let copy = plan.copy(&file)?;
                plan.sets.push(format!("{}=\"{copy}\"", file.field));
            }
        }
        let bodies = &scene.scene.bodies;
        for name in bodies.keys() {
            let file = if bodies.len() == 1 { "unloaded.msh".into() } else { format!("unloaded_{name}.msh") };
            plan.sets.push(format!("bodies.\"{name}\".rest_shape=\"{file}\""));
            plan.meshes.insert(name.clone(), file);
        }
        if scene.scene.start == InitialState::Undeformed && !scene.scene.is_static() {
            plan.sets.push("start=Equilibrium()".into());
        }
        match plan.scene(scene, &scene.folder) {
            Ok(_) => Ok(plan),
            Err(found) => {
                let told: Vec<&str> = found.list().into_iter().map(|mistake| mistake.message.as_str()).collect();
                let (path, told) = (scene.path.display(), told.join("; "));
                Err(Failure::Options(format!("{path} cannot begin at an unloaded shape, so none is sought: {told}")))
            }
        }
    }

    /// Notes that a file is copied, and what it names: its name in the folder.
    fn copy(&mut self, file: &NamedFile) -> Result<String, Failure> {
        if let Some(name) = self.copies.get(&file.name) {
            return Ok(name.clone());
        }
        let plain = Path::new(&file.name).file_name().unwrap_or_default().to_string_lossy().into_owned();
        let mut name = plain.clone();
        let mut number = 1;
        while self.is_taken(&name) {
            number += 1;
            name = format!("{number}_{plain}");
        }
        self.copies.insert(file.name.clone(), name.clone());
        for (from, name) in file.names().skip(1).zip(&file.beside) {
            // it keeps the name by which it is known
            if self.copies.get(&from) == Some(name) {
                continue;
            }
            if self.is_taken(name) || name.contains('/') {
                let file = &file.name;
                let why = "there it would be in another folder, or another file has that name";
                return Err(Failure::Options(format!("{file} and {name}, which it names, cannot be copied: {why}")));
            }
            self.copies.insert(from, name.clone());
        }
        Ok(name)
    }

    fn is_taken(&self, name: &str) -> bool {
        self.copies.values().any(|other| other == name) || name.starts_with("unloaded") || name == SCENE
    }

    /// The scene that begins at the unloaded shape, of files in a folder.
    fn scene(&self, scene: &SceneFile, folder: &Path) -> Result<SceneFile, Diagnostics> {
        SceneFile::from_text_allowing(SCENE, scene.text(), folder, &self.sets, scene.allowed)
    }

    /// Writes all of it; the names of the files.
    fn write(self, scene: &SceneFile, found: &Unloaded, path: &Path) -> Result<Vec<String>, Failure> {
        let mut folder = Folder::create_for(path, &scene.path.display().to_string())?;
        for (name, file) in &self.meshes {
            let (body, rest) = (&scene.scene.bodies[name], &found.rest[name]);
            let mut mesh = mesh_of(body, scene).map_err(|error| Failure::Options(error.to_string()))?;
            mesh.points.clone_from(rest);
            write_gmsh(&folder.claim(file)?, &mesh)?;
        }
        for (from, name) in &self.copies {
            let from = scene.file(from).map_err(|outside| Failure::Options(outside.to_string()))?;
            let to = folder.claim(name)?;
            std::fs::copy(&from, &to).map_err(OutputError::system("write", &to))?;
        }
        let text = self.scene(scene, path)?;
        let file = folder.claim(SCENE)?;
        replace(&file, |file| {
            file.write_all(text.text().as_bytes()).map_err(OutputError::system("write", &path.join(SCENE)))
        })?;
        let names = self.meshes.into_values().chain(self.copies.into_values());
        Ok(names.chain([SCENE.into()]).collect())
    }
}
