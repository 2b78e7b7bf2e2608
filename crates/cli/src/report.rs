//! What a run amounted to, for people.

mod systems;

use super::run::PICTURES;
use super::stability;
use super::terminal::Paint;
use super::wording::{bytes, count, counted, digits, other_end, quantity, speed};
use sinew::components::GuardMemory;
use sinew::observation::Heading;
use sinew::{Equilibrium, ImplicitSteps, SceneFile, Summary, SurfaceContactUse};
use std::fmt::Write;
use std::path::Path;
use systems::systems;

/// A page on a run.
pub fn text(summary: &Summary, scene: &SceneFile, folder: &Path, paint: Paint) -> String {
    let mut page = Page { text: String::new(), paint };
    if !summary.title.is_empty() {
        page.text = format!("{}\n", paint.bold(&summary.title));
    }
    page.row("backend", format!("{}, {}: {}", summary.backend, summary.precision, summary.backend_because));
    let (nodes, elements) = (counted(summary.nodes as u64, "node"), counted(summary.elements as u64, "element"));
    page.row("meshes", format!("{nodes}, {elements}"));
    match &summary.equilibrium {
        None => page.rows("time step", stability::of_run(summary)),
        Some(found) => equilibrium(found, "rest", &mut page),
    }
    if let Some(preload) = &summary.preload {
        let (steps, time) = (counted(preload.steps, "pseudo-step"), quantity(preload.seconds, "s"));
        page.row("preload", format!("at rest before the first step, after {steps} in {time}"));
        equilibrium(&preload.equilibrium, "", &mut page);
    }
    speeds(summary, scene.scene.duration, &mut page);
    if let Some(took) = &summary.implicit {
        implicit(took, summary.equilibrium.is_some(), &mut page);
    }
    systems(summary, &mut page);
    energies(summary, &mut page);
    guards(summary, &mut page);
    mass(summary, &mut page);
    probes(summary, scene, &mut page);
    tools(summary, scene, &mut page);
    contacts(summary, &mut page);
    attachments(summary, &mut page);
    ports(summary, &mut page);
    outputs(folder, &mut page);
    page.text
}

struct Page {
    text: String,
    paint: Paint,
}

impl Page {
    /// A line with its heading; further lines have none.
    fn row(&mut self, heading: &str, line: impl AsRef<str>) {
        let heading = self.paint.bold(&format!("{heading:<10}"));
        // writing to a String cannot fail
        let _ = writeln!(self.text, "{heading}  {}", line.as_ref());
    }

    fn rows(&mut self, heading: &str, lines: impl IntoIterator<Item = String>) {
        for (place, line) in lines.into_iter().enumerate() {
            self.row(if place == 0 { heading } else { "" }, line);
        }
    }
}

fn equilibrium(found: &Equilibrium, heading: &str, page: &mut Page) {
    let scale = quantity(found.scale, "N");
    let rounding = match found.rounding > 0.1 * found.tolerance {
        true => format!("; rounding alone makes up to {}", digits(found.rounding)),
        false => String::new(),
    };
    page.row(
        if found.reached { heading } else { "no rest" },
        format!(
            "residual {} of loads and reactions ({scale}), sought {:.0e}{rounding}",
            digits(found.residual),
            found.tolerance
        ),
    );
    if let Some(last) = found.path.last() {
        let unstable = found.path.iter().filter(|point| point.unstable).count();
        let points = counted(found.path.len() as u64, "point");
        page.row(
            "",
            format!("a path of {points} to a load factor of {:.4}, {unstable} of them unstable", last.load_factor),
        );
    }
    let (body, node, force) = &found.worst;
    page.row("", format!("largest at node {node} of {body}: {}", quantity(*force, "N")));
    let taken_back = match found.setbacks {
        0 => String::new(),
        n => format!("; steps taken back {n} times"),
    };
    let newton = match found.newton_iterations {
        0 => String::new(),
        n => format!("; by {} at last", counted(n, "Newton iteration")),
    };
    page.row("", format!("about {} of displacements to go{taken_back}{newton}", digits(found.remaining_motion)));
}

fn speeds(summary: &Summary, duration: f64, page: &mut Page) {
    let steps = match summary.steps == summary.planned_steps {
        true => counted(summary.steps, "step"),
        false => format!("{} of {}", counted(summary.steps, "step"), summary.planned_steps),
    };
    let (simulated, solving) = (quantity(summary.simulated, "s"), quantity(summary.solving_seconds, "s"));
    match &summary.equilibrium {
        None => {
            let speed = speed(summary.real_time_factor);
            page.row("solving", format!("{steps}, {simulated} simulated in {solving}: {speed}"));
        }
        Some(found) => {
            // each iteration that led to rest counts as a step, after one that finds where things are
            let (stepped, iterations) =
                (summary.steps.saturating_sub(found.newton_iterations), found.newton_iterations);
            let row = match iterations > 0 && stepped <= 1 {
                true => format!("{} in {solving}", counted(iterations, "Newton iteration")),
                false => {
                    let steps = counted(stepped, "pseudo-step");
                    format!("{steps} in {solving}; loads grew over the first {}", found.load_steps)
                }
            };
            page.row("solving", row);
        }
    }
    if summary.steps > 0 {
        let each = quantity(summary.seconds_a_step, "s");
        let element = quantity(summary.nanoseconds_an_element_and_step * 1e-9, "s");
        page.row("", format!("{each} a step, {element} an element and step"));
    }
    if let Some(frames) = &summary.frames {
        let (of_most, longest) = (quantity(frames.percentile_99, "s"), quantity(frames.longest, "s"));
        page.row("", format!("frames of 10 ms of life: {of_most} at most for 99 of 100, {longest} for the longest"));
    }
    let (before, writing) = (quantity(summary.setup_seconds, "s"), quantity(summary.writing_seconds, "s"));
    page.row("beside it", format!("{before} of reading and building, {writing} of observing and writing"));
    match summary.ended.as_str() {
        "finished" if summary.equilibrium.is_some() => {}
        "finished" => page.rows("ended", other_end(summary.simulated, duration)),
        "interrupted" => page.row("ended", "interrupted; what was written until then is whole"),
        // the reason itself is told on stderr and stands in summary.json
        _ => page.row("ended", "too early; the fields hold the last good state"),
    }
}

/// What implicit steps took, or Newton's iterations to rest.
fn implicit(took: &ImplicitSteps, to_rest: bool, page: &mut Page) {
    let heading = if to_rest { "newton" } else { "implicit" };
    let one = if to_rest { "attempt" } else { "step" };
    let (of, passes) = (counted(took.steps, one), count(took.passes));
    let (newton, linear) = (counted(took.newton_iterations, "Newton iteration"), count(took.linear_iterations));
    page.row(heading, format!("{of}: {passes} passes over all forces, {newton}, {linear} of conjugate gradients"));
    if !to_rest && took.smallest_step < took.largest_step {
        let (from, to) = (quantity(took.smallest_step, "s"), quantity(took.largest_step, "s"));
        let back = counted(took.steps_rejected, "step");
        page.row("", format!("steps of {from} to {to}; {back} taken back for a shorter one"));
    }
    let (left, above) = (digits(took.largest_residual_left), counted(took.unsolved, one));
    page.row("", format!("largest share of a residual left: {left}; {above} above the tolerance"));
    let (most, held) = (count(took.most_passes), bytes(took.preconditioner_bytes));
    page.row("", format!("at most {most} passes for one; {held} of preconditioner"));
}

fn energies(summary: &Summary, page: &mut Page) {
    let energies = &summary.energies;
    if !(energies.kinetic.is_finite() && energies.strain.is_finite()) {
        return page.row("energies", "not finite");
    }
    let held = [("kinetic", energies.kinetic), ("strain", energies.strain), ("hourglass", energies.hourglass)];
    let line = |list: &[(&str, f64)]| {
        list.iter().map(|(name, value)| format!("{name} {}", quantity(*value, "J"))).collect::<Vec<_>>().join(", ")
    };
    page.row("energies", line(&held));
    let works = [
        ("of loads", energies.load_work),
        ("of constraints", energies.constraint_work),
        ("against internal forces", energies.internal_work),
        ("lost to damping", energies.damping_loss),
        ("lost to contact", energies.contact_loss.filter(|loss| *loss >= 0.0)),
        ("gained by contact", energies.contact_loss.filter(|loss| *loss < 0.0).map(f64::abs)),
    ];
    let works: Vec<(&str, f64)> = works.iter().filter_map(|(name, value)| Some((*name, (*value)?))).collect();
    if !works.is_empty() {
        page.row("work", line(&works));
    }
}

fn guards(summary: &Summary, page: &mut Page) {
    let seen = &summary.guards;
    if seen.checks > 0 {
        page.row("guards", balance(seen));
    }
    page.rows("warnings", warnings(seen));
}

fn warnings(seen: &GuardMemory) -> impl Iterator<Item = String> {
    seen.warnings.iter().map(|w| format!("from t = {} s: {}", digits(w.time), w.message))
}

/// What was warned of in a run whose report is not wanted.
pub fn warnings_alone(summary: &Summary) -> String {
    warnings(&summary.guards).map(|warning| format!("warning: {warning}\n")).collect()
}

fn balance(seen: &GuardMemory) -> String {
    let mut line = format!("energy balances to {:.2} %", 100.0 * seen.imbalance.abs());
    if let Some(least) = &seen.least_volume_ratio {
        let _ = write!(line, ", smallest J {} (element {} of {})", digits(least.value), least.id, least.body);
    }
    if let Some(fastest) = &seen.fastest_node {
        let speed = quantity(fastest.value, "m/s");
        let _ = write!(line, ", fastest node {} of {}: {speed}", fastest.id, fastest.body);
    }
    line
}

fn mass(summary: &Summary, page: &mut Page) {
    let mut line = quantity(summary.mass * 1e3, "g");
    if summary.removed_elements > 0 {
        let _ = write!(
            line,
            ", of it {} removed with {}, and {} of energy",
            quantity(summary.removed_mass * 1e3, "g"),
            counted(summary.removed_elements as u64, "element"),
            quantity(summary.energies.removed, "J")
        );
    }
    page.row("mass", line);
    let inversions = summary.inversions.iter().map(|found| {
        let left = match found.left {
            0 => "none is at the end".to_string(),
            left => format!("{} still at the end", counted(left as u64, "element")),
        };
        format!("elements of {} were inside out, one of them {}; {left}", found.body, found.element)
    });
    page.rows("inversion", inversions.collect::<Vec<_>>());
}

fn tools(summary: &Summary, scene: &SceneFile, page: &mut Page) {
    let lines = summary.tools.iter().map(|(name, reading)| {
        let [x, y, z] = reading.force.to_array().map(|part| quantity(part, "N"));
        let inside = match reading.penetration > 0.0 {
            true => format!(", the deepest {} inside", quantity(reading.penetration, "m")),
            false => String::new(),
        };
        // a pressure that dies away is none
        let is_sucking = reading.suction.length() > 1e-9 * reading.force.length();
        let sucks = match is_sucking {
            true => format!(", {} of it what it sucks", quantity(reading.suction.length(), "N")),
            false => String::new(),
        };
        let nodes = counted(reading.nodes as u64, "node");
        let slipped = match reading.slipped {
            0 => String::new(),
            count => format!(", {} slipped out", counted(count as u64, "node")),
        };
        // also of one that sucks no more
        let may_suck = scene.scene.suction.iter().any(|suction| suction.tool == *name);
        let but = if may_suck { ", the work of what it sucks left out" } else { "" };
        let spent = reading
            .work
            .zip(reading.loss)
            .map_or(String::new(), |(work, loss)| format!("; it did {}{but}, {}", quantity(work, "J"), taken(loss)));
        let waits = match reading.waiting > 0.0 {
            true => format!("; {} that it has taken in wait to go, as `burst` says", quantity(reading.waiting, "m³")),
            false => String::new(),
        };
        format!("{name} feels ({x}, {y}, {z}) of {nodes}{slipped}{inside}{sucks}{spent}{waits}")
    });
    page.rows("tools", lines.collect::<Vec<_>>());
}

/// What contact has taken (J), or given: what is inside at the start is pushed out.
fn taken(loss: f64) -> String {
    match loss < 0.0 {
        true => format!("gained by contact {}", quantity(-loss, "J")),
        false => format!("lost to impact and friction {}", quantity(loss, "J")),
    }
}

/// What contact has taken of the energy of a body (J), or given it.
fn exchanged(loss: f64) -> String {
    match loss < 0.0 {
        true => format!("contact gave it {}", quantity(-loss, "J")),
        false => format!("contact took {} of its energy", quantity(loss, "J")),
    }
}

fn contacts(summary: &Summary, page: &mut Page) {
    let lines = summary.contacts.iter().map(|(name, reading)| {
        let [x, y, z] = reading.force.to_array().map(|part| quantity(part, "N"));
        let inside = match reading.penetration > 0.0 {
            true => format!(", the deepest {} inside", quantity(reading.penetration, "m")),
            false => String::new(),
        };
        let points = counted(reading.points as u64, "point");
        let loss = reading.loss.map_or(String::new(), |loss| format!("; {}", exchanged(loss)));
        format!("{name} feels ({x}, {y}, {z}) and touches with {points}{inside}{loss}")
    });
    page.rows("contacts", lines.collect::<Vec<_>>());
    if let Some(found) = &summary.surface_contact {
        surface_contact(found, page);
    }
}

fn surface_contact(found: &SurfaceContactUse, page: &mut Page) {
    let held = bytes(found.bytes as u64);
    page.row("surfaces", format!("{} points that may meet {} faces, {held}", found.points, found.faces));
    let times = counted(found.builds, "time");
    let lists = format!(
        "lists made {times}, {} a simulated second, in {}",
        digits(found.builds_a_second),
        quantity(found.build_seconds, "s")
    );
    page.row("", lists);
    if let (Some(seconds), Some(share), Some(near)) = (found.seconds, found.share, found.points_near) {
        let each =
            found.nanoseconds_a_near_point.map_or(String::new(), |ns| format!(", {} each", quantity(ns * 1e-9, "s")));
        let (took, share) = (quantity(seconds, "s"), digits(100.0 * share));
        page.row("", format!("took {took}, {share} % of solving: {} points near a step{each}", digits(near)));
    }
    if let Some(deepest) = found.deepest.filter(|deepest| *deepest > 0.0) {
        page.row("", format!("the deepest that a point was inside after a step: {}", quantity(deepest, "m")));
    }
}

fn attachments(summary: &Summary, page: &mut Page) {
    let lines = summary.attachments.iter().map(|(name, reading)| {
        let [x, y, z] = reading.force.to_array().map(|part| quantity(part, "N"));
        let points = counted(reading.holds as u64, "point");
        let broke = match reading.broke_at {
            Some(time) if reading.broken.is_empty() => format!("; broke at {}", quantity(time, "s")),
            Some(time) => {
                let nodes = counted(reading.broken.len() as u64, "node");
                format!("; {nodes} came off, the first at {}", quantity(time, "s"))
            }
            None => String::new(),
        };
        let length =
            if reading.length > 0.0 { format!(", {} long", quantity(reading.length, "m")) } else { String::new() };
        let loss = quantity(reading.loss, "J");
        format!("{name} pulls with ({x}, {y}, {z}) at {points}{length}{broke}; lost {loss}")
    });
    page.rows("attachments", lines.collect::<Vec<_>>());
}

fn ports(summary: &Summary, page: &mut Page) {
    let lines = summary.ports.iter().map(|(name, port)| {
        let told = format!("{name} moved {} by {}", port.tool, counted(port.poses, "pose"));
        if port.warning.is_empty() { told } else { format!("{told}: {}", port.warning) }
    });
    page.rows("ports", lines.collect::<Vec<_>>());
    if let Some(kept) = &summary.real_time {
        let waited = quantity(kept.waited, "s");
        page.row("pace", format!("waited {waited} for life; late {} of {}", counted(kept.late, "time"), kept.ticks));
    }
}

fn probes(summary: &Summary, scene: &SceneFile, page: &mut Page) {
    let lines = summary.probes.iter().map(|(name, (time, values))| {
        let header = scene.scene.probes.get(name).map(|probe| sinew::observation::header(&probe.what));
        let columns = header.iter().flatten().skip(1);
        let values: Vec<String> = values.iter().zip(columns).map(|(value, column)| named(column, *value)).collect();
        format!("{name} at t = {} s: {}", digits(*time), values.join(", "))
    });
    page.rows("probes", lines.collect::<Vec<_>>());
}

/// A value under the name and unit of its column: ux in m and 0.0012 are "ux 1.2 mm".
fn named(column: &Heading, value: f64) -> String {
    match column.unit {
        "1" => format!("{} {}", column.name, digits(value)),
        unit => format!("{} {}", column.name, quantity(value, unit)),
    }
}

fn outputs(folder: &Path, page: &mut Page) {
    let names: Vec<String> = std::fs::read_dir(folder).map_or(Vec::new(), |entries| {
        entries.filter_map(|entry| Some(entry.ok()?.file_name().to_string_lossy().into_owned())).collect()
    });
    let frames = names.iter().filter(|name| name.starts_with("fields_") && name.ends_with(".vtu")).count();
    let mut others: Vec<&str> = names.iter().map(String::as_str).collect();
    let is_skin = |name: &str| name.starts_with("skin_") && name.ends_with(".pvd");
    others.retain(|name| name.ends_with(".csv") || name.ends_with(".json") || is_skin(name));
    others.retain(|name| *name != "sinew.json");
    others.retain(|name| !PICTURES.contains(name));
    others.sort_unstable();
    let fields = format!("fields.pvd ({})", counted(frames as u64, "frame"));
    page.row("outputs", format!("{}: {fields}, {}", folder.display(), others.join(", ")));
    page.row("see it", format!("sinew render {}", sinew::shell_word(folder)));
}
