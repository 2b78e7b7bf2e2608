//! `sinew check`: whether a scene is sound.

use super::Outcome;
use super::advice::{self, Advice};
use super::arguments::CheckArguments;
use super::failure::{Failure, count_of};
use super::progress;
use super::stability;
use super::terminal::{self, Paint};
use super::wording::{count, counted, other_end, quantity};
use sinew::components::Block;
use sinew::components::Cadence;
use sinew::scene::schema::{Scene, SearchMethod, Solver};
use sinew::systems::Registry;
use sinew::{BackendChoice, Error, Options, Simulation, Summary};
use std::path::Path;

/// Shows all that is wrong, and a line of verdict.
pub fn command(arguments: &CheckArguments) -> Outcome {
    let scene = arguments.scene.load()?;
    let reading = "reading meshes, looking for mistakes";
    let diagnostics = progress::during(reading, || Simulation::check(&scene, &Registry::default()));
    if diagnostics.has_errors() {
        return Err(diagnostics.into());
    }
    terminal::aside(&diagnostics.render(Paint::of_stderr().is_on()));
    let precision = arguments.precision_of(&scene);
    let options = Options { backend: BackendChoice::Cpu, precision, threads: 1, ..Options::default() };
    let mut simulation = progress::during("building the simulation", || Simulation::new(&scene, &options))?;
    progress::settle(&mut simulation)?;
    let advice = progress::during("looking for cheaper steps", || advice::implicit(&scene, &mut simulation))?;
    if arguments.json {
        let text = serde_json::to_string_pretty(&facts(&mut simulation, advice.as_ref())?)
            .map_err(|error| Failure::Silent(error.into()))?;
        return terminal::hand_out(&format!("{text}\n"));
    }
    let warnings = if diagnostics.is_empty() { String::new() } else { format!(", with {}", count_of(&diagnostics)) };
    terminal::say(&format!("sound{warnings}: {}", verdict(&mut simulation, advice.as_ref())?))
}

/// What a sound scene amounts to, for programs.
fn facts(simulation: &mut Simulation, advice: Option<&Advice>) -> Result<serde_json::Value, Error> {
    let summary = simulation.summary("not run")?;
    Ok(serde_json::json!({
        "nodes": summary.nodes,
        "elements": summary.elements,
        "steps": summary.planned_steps,
        "time_step": summary.time_step,
        "share_of_limit": summary.share_of_limit,
        "stability": summary.stability,
        "added_mass": summary.step_history.map(|history| history.added_mass),
        "implicit_steps": advice,
    }))
}

/// What a sound scene amounts to, for people.
fn verdict(simulation: &mut Simulation, advice: Option<&Advice>) -> Result<String, Error> {
    let summary = simulation.summary("not run")?;
    let world = simulation.world_mut();
    let blocks = world.query::<&Block>().iter(world).count() as u64;
    let mut lines = format!(
        "{}, {} in {}; ",
        counted(summary.nodes as u64, "node"),
        counted(summary.elements as u64, "element"),
        counted(blocks, "block"),
    );
    lines += &match &summary.equilibrium {
        None => format!(
            "{} of {} for {}\n{}{}",
            counted(summary.planned_steps, "step"),
            quantity(summary.time_step, "s"),
            quantity(simulation.scene().duration, "s"),
            ends_elsewhere(&summary, simulation.scene()).unwrap_or_default(),
            stability::at_start(&summary),
        ),
        Some(sought) => format!(
            "rest under what acts at {}: {}at most {}, in the first {} of them loads grow\n",
            quantity(simulation.scene().duration, "s"),
            by_newton(simulation.scene()),
            counted(summary.planned_steps, "pseudo-step"),
            sought.load_steps,
        ),
    };
    lines += &advice.map(Advice::text).unwrap_or_default();
    // a static analysis observes while loads grow, and at the end
    let observed = summary.equilibrium.as_ref().map_or(summary.planned_steps, |sought| sought.load_steps);
    lines += &format!("a run writes: {}\n", outputs(simulation, observed).join(", "));
    Ok(lines)
}

/// What leads to rest before pseudo-steps do, if anything does.
fn by_newton(scene: &Scene) -> &'static str {
    match scene.search() {
        Some(search) if search.method == SearchMethod::Newton => "by Newton's iterations, and where they find none by ",
        _ => "",
    }
}

/// That a run will not end at `duration`; chosen steps do.
fn ends_elsewhere(summary: &Summary, scene: &Scene) -> Option<String> {
    if let Solver::Implicit { adaptive: Some(_), .. } = scene.solver {
        return None;
    }
    let end = other_end(summary.planned_steps as f64 * summary.time_step, scene.duration)?;
    Some(format!("a run ends {end}\n"))
}

/// What `sinew run --verbose` says before the first step.
pub fn details(simulation: &mut Simulation, folder: &Path) -> Result<String, Error> {
    let summary = simulation.summary("not run")?;
    let systems: Vec<&str> = summary.systems.iter().map(|system| system.name.as_str()).collect();
    let stability = match summary.equilibrium {
        None => stability::at_start(&summary),
        Some(_) => String::new(),
    };
    Ok(format!(
        "{}: {}\nread and built in {}\nsystems: {}\n{stability}writes into {}: {}\n",
        summary.backend,
        summary.backend_because,
        quantity(summary.setup_seconds, "s"),
        systems.join(", "),
        sinew::shell_word(folder),
        outputs(simulation, summary.planned_steps).join(", ")
    ))
}

/// The files of a run, and how long those that grow become.
fn outputs(simulation: &Simulation, steps: u64) -> Vec<String> {
    // the start, each time that it is due, and the end
    let whole_steps = |every: f64| Cadence::new(every, simulation.time_step()).count(steps);
    let rows = |every: f64| Cadence::new(every, simulation.time_step()).rows(steps);
    let scene = simulation.scene();
    let mut files = vec![format!("fields.pvd ({})", counted(whole_steps(scene.fields_every()), "frame"))];
    files.extend(scene.output.energies_every.map(|every| format!("energy.csv ({} rows)", count(rows(every)))));
    // none of the start, one of the end
    let snapshots = scene.output.snapshots_every.filter(|_| !scene.is_static());
    files.extend(snapshots.map(|every| counted(whole_steps(every) - 1, "snapshot")));
    let skins = scene.bodies.iter().filter(|(_, body)| body.skin.is_some());
    files.extend(skins.map(|(name, _)| format!("skin_{name}.pvd")));
    for (name, probe) in &scene.probes {
        let every = probe.every.unwrap_or_else(|| scene.fields_every());
        files.push(format!("probe_{name}.csv ({} rows)", count(rows(every))));
    }
    match scene.bodies.len() {
        1 => files.push("nodes.csv".into()),
        _ => files.extend(scene.bodies.keys().map(|name| format!("nodes_{name}.csv"))),
    }
    files.extend(scene.is_static().then(|| "convergence.csv".to_string()));
    files.extend(scene.follows_path().then(|| "path.csv".to_string()));
    files.extend(["summary.json".into(), "scene.ron".into()]);
    files
}
