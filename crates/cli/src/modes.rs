//! `sinew modes`: the lowest natural frequencies of a scene and their shapes, and what damping and ramps follow from
//! them.

use super::arguments::{ModesArguments, default_folder};
use super::failure::Failure;
use super::run::PICTURES;
use super::wording::{digits, quantity};
use super::{Outcome, progress, terminal};
use sinew::components::Authoring;
use sinew::glam::DVec3;
use sinew::mesh::Cells;
use sinew::output::{Array, Folder, Frame, Series, Values, summary};
use sinew::scene::schema::{Attachment, Contact, Picture, Scene};
use sinew::{BackendChoice, Mode, Options, Simulation};
use sinew_pictures::render::{RenderOptions, draw};
use std::fs;
use std::path::Path;

/// What the folder keeps of the modes beside their shapes: what `--json` prints.
const MODES: &str = "modes.json";
/// What colours a mode, which has no size of its own.
const COLOURED_BY: &str = "relative_amplitude";
/// How large the largest displacement of a drawn mode is, as a share of the scene's size.
const DRAWN: f64 = 0.1;
/// Pictures of each mode, over one period.
const PICTURES_A_MODE: usize = 16;
/// Damping of the lowest mode that brings to rest quickly and hardly changes what is faster, as a share of the critical
/// one.
const SHARE: f64 = 0.2;
/// β in stable steps that makes the stable step half as long: the highest frequency then has so much of the critical
/// damping.
const HALVES: f64 = 0.75;
/// Periods of the lowest mode over which a ramp hardly rings: with the 3-4-5 polynomial its overshoot is below 1 %.
const PERIODS: f64 = 5.0;

/// Finds the modes, tells of them and draws them.
pub fn command(arguments: &ModesArguments) -> Outcome {
    let scene = arguments.scene.load()?;
    let options = Options {
        backend: BackendChoice::Cpu,
        precision: sinew::components::Precision::F64,
        threads: arguments.threads.into(),
        ..Options::default()
    };
    let mut simulation = progress::during("building the simulation", || Simulation::new(&scene, &options))?;
    if let Some(left_out) = left_out(simulation.scene()) {
        terminal::aside(&left_out);
    }
    let modes = progress::during("looking for the lowest frequencies", || simulation.modes(arguments.count.into()))?;
    if arguments.json {
        let text = serde_json::to_string_pretty(&modes).map_err(|error| Failure::Silent(error.into()))?;
        return terminal::say(&format!("{text}\n"));
    }
    let limit = simulation.stable_limit()?;
    terminal::say(&table(&modes, limit))?;
    if arguments.no_picture || modes.is_empty() {
        return Ok(());
    }
    let mut name = default_folder(&arguments.scene.scene).into_os_string();
    name.push("-modes");
    let path = arguments.out.clone().unwrap_or_else(|| name.into());
    let animation = draw_modes(&mut simulation, &modes, &path)?;
    let folder = path.display();
    terminal::say(&format!("see them    {}; in ParaView {folder}/fields.pvd, a mode a frame\n", animation.display()))
}

/// Names of a kind that are told; of more their number.
const TOLD: usize = 4;

/// That there is more to hold bodies than modes know of, if there is.
fn left_out(scene: &Scene) -> Option<String> {
    let mut kinds: [(&str, Vec<String>); 5] =
        ["glue", "ties", "sutures", "grasps", "contact"].map(|kind| (kind, Vec::new()));
    for (number, attachment) in scene.attachments.iter().enumerate() {
        let kind = match attachment {
            Attachment::Glue { .. } => 0,
            Attachment::Tie { .. } => 1,
            Attachment::Suture { .. } => 2,
            Attachment::Grasp { .. } => 3,
        };
        let name = attachment.name(number).or_else(|| attachment.tool().cloned());
        kinds[kind].1.push(format!("`{}`", name.unwrap_or_default()));
    }
    kinds[4].1 = scene.contacts.iter().map(of_whom).collect();
    let told = |(kind, names): &(&str, Vec<String>)| {
        let more = if names.len() > TOLD { format!(" and {} more", names.len() - TOLD) } else { String::new() };
        let told = names.iter().take(TOLD).map(String::as_str).collect::<Vec<_>>().join(", ");
        format!("{kind} ({told}{more})")
    };
    let told: Vec<String> = kinds.iter().filter(|(_, names)| !names.is_empty()).map(told).collect();
    if told.is_empty() {
        return None;
    }
    Some(format!(
        "warning: modes are those of bodies without what else holds them in this scene: {}. Frequencies, and damping and \
         ramps by them, are too low for what is held so, or not those of the assembly; `Fixed` where they hold shows what \
         they do\n",
        told.join(", ")
    ))
}

/// Who touches in a contact.
fn of_whom(contact: &Contact) -> String {
    match contact {
        Contact::Tool { tool, .. } => format!("with `{tool}`"),
        Contact::Between { bodies: (a, b), .. } => format!("between `{a}` and `{b}`"),
        Contact::Itself { body: Some(body), .. } => format!("of `{body}` with itself"),
        Contact::Itself { body: None, .. } => "of the body with itself".into(),
    }
}

/// A line for each mode, and what follows from the lowest; `limit` is the stable step (s).
fn table(modes: &[Mode], limit: Option<f64>) -> String {
    let mut text = String::from("mode  frequency     period        moves of all mass along x, y, z\n");
    for (number, mode) in modes.iter().enumerate() {
        let masses = mode.effective_mass.map(|share| format!("{:3.0} %", 100.0 * share)).join("  ");
        let (frequency, period) = match mode.frequency {
            0.0 => ("rigid".to_string(), String::new()),
            frequency => (quantity(frequency, "Hz"), quantity(1.0 / frequency, "s")),
        };
        text += &format!("{:>4}  {frequency:<12}  {period:<12}  {masses}\n", number + 1);
    }
    let Some(lowest) = modes.iter().map(|mode| mode.frequency).find(|frequency| *frequency > 0.0) else {
        text += match modes.len() {
            0 => "nothing can move\n",
            _ => "all of these are rigid motion: no constraint holds a body; ask for more with --count\n",
        };
        return text;
    };
    let critical = 2.0 * std::f64::consts::TAU * lowest;
    text += &format!(
        "damping     damping: {} (1/s) is critical for the lowest, {} lets it ring out in some periods\n",
        digits(critical),
        digits(SHARE * critical)
    );
    if let Some(limit) = limit {
        // ξ = βω/2, and Δt = √(β² + Δt₀²) − β
        let (quiet, beta) = (HALVES * limit, 2.0 * SHARE / (std::f64::consts::TAU * lowest));
        text += &format!(
            "            stiffness_damping: {} (s) quietens what is fastest, for steps half as long; {} damps the lowest as much as \
             {} (1/s) does,\n            and all that is faster more, for steps {} times shorter\n",
            digits(quiet),
            digits(beta),
            digits(SHARE * critical),
            digits((beta.hypot(limit) + beta) / limit)
        );
    }
    text += &format!(
        "ramps       curve: Smooth(end: {}) or longer loads it as if at rest ({PERIODS} periods of the lowest)\n",
        digits(PERIODS / lowest)
    );
    text
}

/// Writes a frame for each mode, and draws them one after the other; the animation's file.
fn draw_modes(simulation: &mut Simulation, modes: &[Mode], path: &Path) -> Result<std::path::PathBuf, Failure> {
    let mut folder = Folder::create(path)?;
    let out = folder.claim(PICTURES[1])?;
    folder.claim(PICTURES[0])?;
    summary::write(&folder.claim(MODES)?, &modes)?;
    let bodies: Vec<String> = simulation.scene().bodies.keys().cloned().collect();
    let (mut points, mut cells) = (Vec::new(), Cells::default());
    for body in &bodies {
        let first = points.len() as u32;
        let entity = simulation.body(body)?;
        points.extend(simulation.rest_positions(body)?);
        let Some(authoring) = simulation.world().get::<Authoring>(entity) else { continue };
        cells.extend_moved(&authoring.cells, first);
    }
    let (low, high) = sinew::mesh::extent(points.iter().copied());
    let size = DRAWN * (high - low).length();
    let mut series = Series::create(&folder)?;
    for (number, mode) in modes.iter().enumerate() {
        let shape = bodies.iter().flat_map(|body| mode.shapes.get(body).into_iter().flatten());
        let displacement: Vec<f32> = shape.flat_map(|u: &DVec3| (*u * size).as_vec3().to_array()).collect();
        let lengths = displacement.chunks_exact(3).map(|u| u[0].hypot(u[1]).hypot(u[2]));
        let largest = lengths.clone().fold(f32::MIN_POSITIVE, f32::max);
        let amplitude: Vec<f32> = lengths.map(|length| length / largest).collect();
        let array = |name, components, values| Array { name, components, values: Values::F32(values) };
        series.write(&Frame {
            time: (number + 1) as f64,
            points: &points,
            cells: &cells,
            point_arrays: vec![array("displacement", 3, &displacement), array(COLOURED_BY, 1, &amplitude)],
            cell_arrays: Vec::new(),
        })?;
    }
    let frequencies: Vec<f64> = modes.iter().map(|mode| mode.frequency).collect();
    let options = RenderOptions { animate: true, ..RenderOptions::new(simulation.scene().picture.clone(), out) };
    Ok(draw(path, &drawing(&frequencies, options))?.out)
}

/// How modes of some frequencies (Hz) are drawn, when they would be drawn so if they were a run.
fn drawing(frequencies: &[f64], options: RenderOptions) -> RenderOptions {
    let caption = |(number, frequency): (usize, &f64)| match *frequency {
        0.0 => format!("mode {}, rigid", number + 1),
        frequency => format!("mode {}, {} Hz", number + 1, digits(frequency)),
    };
    let field = options.field.unwrap_or_else(|| COLOURED_BY.into());
    let range = if field == COLOURED_BY { Some((0.0, 1.0)) } else { options.picture.range };
    // a shape that swings is whole
    let picture = Picture { range, ghost: true, cut: None, opacity: Vec::new(), ..options.picture };
    let captions = frequencies.iter().enumerate().map(caption).collect();
    RenderOptions { picture, field: Some(field), captions, swing: PICTURES_A_MODE, ..options }
}

/// How a folder is drawn: what it keeps of modes, if those are what it holds, says it.
pub fn as_modes(folder: &Path, options: RenderOptions) -> Result<RenderOptions, Failure> {
    let path = folder.join(MODES);
    if !path.exists() {
        return Ok(options);
    }
    let wrong = |reason: String| Failure::Options(format!("{}: {reason}", path.display()));
    let text = fs::read_to_string(&path).map_err(|error| wrong(error.to_string()))?;
    let modes: Vec<serde_json::Value> = serde_json::from_str(&text).map_err(|error| wrong(error.to_string()))?;
    let frequencies: Option<Vec<f64>> = modes.iter().map(|mode| mode["frequency"].as_f64()).collect();
    Ok(drawing(&frequencies.ok_or_else(|| wrong("a mode has no frequency".into()))?, options))
}
