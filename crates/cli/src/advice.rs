//! Whether implicit steps would pay, from numbers of the scene: how fast loads act, how fast bodies swing, and what a
//! few steps take.

use super::wording::{count, digits, quantity};
use glam::DVec3;
use serde::Serialize;
use sinew::components::{Authoring, Fixed, OfBody, RestPosition};
use sinew::scene::schema::{Attachment, Curve, ImplicitScheme, Scene};
use sinew::{BackendChoice, Error, Options, SceneFile, Simulation};
use sinew_studies::accuracy::Method;
use std::collections::BTreeSet;
use std::f64::consts::TAU;

/// What implicit Euler would take.
#[derive(Clone, Debug, Serialize)]
pub struct Advice {
    /// Its step (s).
    pub step: f64,
    /// Passes over all forces from start to end, by those of the first steps.
    pub passes: u64,
    /// Those of explicit steps.
    pub explicit_passes: u64,
    /// How fast bodies swing in the shape that they are loaded into (Hz): Rayleigh's quotient.
    pub frequency: f64,
    /// The error of the step over time of a single mass that swings so, loaded as the scene is: root mean square, as a
    /// share of the largest value.
    pub error: f64,
}

impl Advice {
    /// In words.
    pub fn text(&self) -> String {
        format!(
            "loads are slow (what they act on swings at about {} Hz): implicit steps of {} take some {} passes over all \
             forces in place of {}, for an error of about {} %\n  try --set 'solver=Implicit(step: {})'; sinew \
             accuracy tells what it costs\n",
            digits(self.frequency),
            quantity(self.step, "s"),
            count(self.passes),
            count(self.explicit_passes),
            digits(100.0 * self.error),
            self.step
        )
    }
}

/// The largest error of a step that is worth a word.
const ERROR: f64 = 0.01;
/// The least share of passes that has to be saved for it.
const SAVED: f64 = 0.5;
/// How many steps are tried.
const TRIED: u64 = 10;
/// Elements from which on trying takes too long for a look.
const MOST_ELEMENTS: usize = 50_000;

/// What implicit steps would take in place of the explicit ones of a simulation, if they pay by much. None for bodies
/// that nothing at rest holds, or that can turn about what does: they go far and are strained little.
///
/// # Errors
/// None for what implicit steps cannot do: there is no advice then.
pub fn implicit(file: &SceneFile, explicit: &mut Simulation) -> Result<Option<Advice>, Error> {
    let scene = explicit.scene().clone();
    let summary = explicit.summary("not run")?;
    let curves: Vec<&Curve> = scene.curves().into_iter().map(|(_, curve)| curve).collect();
    let told_by_programs = curves.iter().any(|curve| matches!(curve, Curve::Input { .. }));
    let of_this_scene = Method::of(&scene) == Method::Explicit && !told_by_programs && !curves.is_empty();
    if !of_this_scene || summary.elements > MOST_ELEMENTS || !are_held(&scene, held_alone(&scene, explicit)?) {
        return Ok(None);
    }
    let explicit_passes = summary.planned_steps;
    let mut steps: Vec<f64> = Method::of_motion(scene.duration, summary.time_step, TRIED)
        .into_iter()
        .filter_map(|method| match method {
            Method::Implicit { scheme: ImplicitScheme::Euler, step, linearized: false } => Some(step),
            _ => None,
        })
        .collect();
    steps.sort_by(|a, b| b.total_cmp(a));
    // what turns about what holds it would be said to swing too slowly to swing at all
    let swings = |trial: &Trial| trial.frequency * scene.duration >= 1.0;
    let Some(first) = steps.first().and_then(|&step| tried(file, step)).filter(swings) else { return Ok(None) };
    let error = |step: f64| {
        let worst = curves.iter().map(|curve| error_of_a_mass(curve, first.frequency, step, scene.duration));
        worst.fold(0.0, f64::max)
    };
    let Some((step, error)) = steps.into_iter().map(|step| (step, error(step))).find(|(_, error)| *error <= ERROR)
    else {
        return Ok(None);
    };
    let Some(trial) = (if step == first.step { Some(first) } else { tried(file, step) }) else { return Ok(None) };
    let passes = (trial.passes_a_step * scene.duration / step).ceil() as u64;
    let pays = (passes as f64) < (1.0 - SAVED) * explicit_passes as f64;
    Ok(pays.then_some(Advice { step, passes, explicit_passes, frequency: first.frequency, error }))
}

/// The bodies that nodes which do not move hold.
fn held_alone<'a>(scene: &'a Scene, simulation: &mut Simulation) -> Result<BTreeSet<&'a String>, Error> {
    let mut held = BTreeSet::new();
    for (name, body) in &scene.bodies {
        if is_held(name, body.copies as usize, simulation)? {
            held.insert(name);
        }
    }
    Ok(held)
}

/// Whether each body is one of those, or is tied or glued to one.
fn are_held<'a>(scene: &'a Scene, mut held: BTreeSet<&'a String>) -> bool {
    let mut before = None;
    while before != Some(held.len()) {
        before = Some(held.len());
        for attachment in &scene.attachments {
            let (one, other) = match attachment {
                Attachment::Tie { from, to, .. } => (from.body.as_ref(), to.body.as_ref()),
                Attachment::Glue { bodies: (one, other), .. } => (Some(one), Some(other)),
                Attachment::Grasp { .. } | Attachment::Suture { .. } => continue,
            };
            if let (Some(one), Some(other)) = (one, other)
                && (held.contains(one) || held.contains(other))
            {
                held.extend([one, other]);
            }
        }
    }
    held.len() == scene.bodies.len()
}

/// The axes that a node does not move along: x, y, z as bits 0, 1, 2.
type Axes = u32;
/// The least lever that keeps a body from turning, as a share of its size.
const LEVER: f64 = 1e-4;

/// Whether nodes that do not move keep each copy of a body from going and from turning as a whole.
fn is_held(name: &str, copies: usize, simulation: &mut Simulation) -> Result<bool, Error> {
    let body = simulation.body(name)?;
    let world = simulation.world_mut();
    let (Some(authoring), Some(rest)) = (world.get::<Authoring>(body), world.get::<RestPosition>(body)) else {
        return Ok(false);
    };
    let (order, places) = (authoring.node_rows.clone(), rest.0.clone());
    let mut fixed: Vec<Axes> = vec![0; places.len()];
    for (one, _) in world.query::<(&Fixed, &OfBody)>().iter(world).filter(|(_, of)| of.0 == body) {
        one.rows.iter().for_each(|&row| fixed[row as usize] |= one.axes);
    }
    // numbers go on from copy to copy
    let of_a_copy = (order.len() / copies.max(1)).max(1);
    let nodes = |rows: &[u32]| -> Vec<(DVec3, Axes)> {
        rows.iter().map(|&row| (places[row as usize], fixed[row as usize])).collect()
    };
    Ok(!order.is_empty() && order.chunks(of_a_copy).all(|rows| leaves_no_way(&nodes(rows))))
}

/// Whether nodes with the axes that they do not move along leave a rigid body none of its six ways to move: to go along
/// three axes, and to turn about three, by its size times the angle.
fn leaves_no_way(nodes: &[(DVec3, Axes)]) -> bool {
    let (low, high) = sinew::mesh::extent(nodes.iter().map(|(place, _)| *place));
    let (middle, size) = (0.5 * (low + high), (high - low).length());
    let mut products = [[0.0_f64; 6]; 6];
    for (place, axes) in nodes {
        let arm = (*place - middle) / size;
        for (bit, axis) in [1, 2, 4].into_iter().zip(DVec3::AXES) {
            if *axes & bit == 0 {
                continue;
            }
            let turned = arm.cross(axis);
            let row = [axis.x, axis.y, axis.z, turned.x, turned.y, turned.z];
            for (products, a) in products.iter_mut().zip(row) {
                products.iter_mut().zip(row).for_each(|(product, b)| *product += a * b);
            }
        }
    }
    // what is left of each way once those before it are held
    let mut left: Vec<usize> = (0..6).collect();
    while let Some(pivot) = left.iter().copied().max_by(|&a, &b| products[a][a].total_cmp(&products[b][b])) {
        let most = products[pivot];
        if !most[pivot].is_finite() || most[pivot] <= LEVER * LEVER {
            return false;
        }
        left.retain(|&row| row != pivot);
        for &row in &left {
            let factor = products[row][pivot] / most[pivot];
            products[row].iter_mut().zip(most).for_each(|(product, pivot)| *product -= factor * pivot);
        }
    }
    true
}

/// What a few steps showed.
#[derive(Clone, Copy)]
struct Trial {
    step: f64,
    passes_a_step: f64,
    frequency: f64,
}

/// Takes a few implicit Euler steps; `None` where that cannot be, or nothing moves.
fn tried(file: &SceneFile, step: f64) -> Option<Trial> {
    let mut file = file.clone();
    Method::Implicit { scheme: ImplicitScheme::Euler, step, linearized: false }.apply(&mut file.scene, None);
    let options = Options { backend: BackendChoice::Cpu, threads: 1, ..Options::default() };
    let mut simulation = Simulation::new(&file, &options).ok()?;
    simulation.advance_towards_end(TRIED).ok()?;
    let taken = simulation.implicit_steps()?;
    let passes_a_step = taken.passes as f64 / taken.steps as f64;
    let energies = simulation.energies().ok()?;
    let names: Vec<String> = file.scene.bodies.keys().cloned().collect();
    let mut moved = 0.0;
    for name in names {
        let (masses, ways) = (simulation.masses(&name).ok()?, simulation.displacements(&name).ok()?);
        moved += masses.iter().zip(ways).map(|(mass, u)| mass * u.length_squared()).sum::<f64>();
    }
    let frequency = (2.0 * (energies.strain + energies.hourglass) / moved).sqrt() / TAU;
    (frequency.is_finite() && frequency > 0.0 && passes_a_step.is_finite()).then_some(Trial {
        step,
        passes_a_step,
        frequency,
    })
}

/// The error over time of implicit Euler for a mass on a spring without damping, u″ + ω²u = ω²f(t), against steps so
/// short that theirs does not count: root mean square over that of the largest value.
fn error_of_a_mass(curve: &Curve, frequency: f64, step: f64, duration: f64) -> f64 {
    let square = (TAU * frequency).powi(2);
    // central differences of a fiftieth of a period, 2π²/3/50² off in phase, a whole number in a step
    let parts = (step * frequency * 50.0).ceil().max(50.0);
    let short = step / parts;
    let (mut exact, mut rate) = (0.0, 0.0);
    let (mut euler, mut euler_rate) = (0.0, 0.0);
    let (mut sum, mut largest, mut count) = (0.0_f64, 0.0_f64, 0.0);
    for number in 0..(duration / step).round() as u64 {
        let from = number as f64 * step;
        for part in 0..parts as u64 {
            let middle = from + (part as f64 + 0.5) * short;
            exact += 0.5 * short * rate;
            rate += short * square * (curve.value(middle) - exact);
            exact += 0.5 * short * rate;
        }
        let end = from + step;
        euler_rate = (euler_rate + step * square * (curve.value(end) - euler)) / (1.0 + step * step * square);
        euler += step * euler_rate;
        sum += (euler - exact).powi(2);
        largest = largest.max(exact.abs());
        count += 1.0;
    }
    let error = (sum / count).sqrt() / largest;
    if error.is_finite() { error } else { f64::INFINITY }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    /// A mass of 72 Hz under a load that grows smoothly within seven periods, and under one that is there at once.
    #[test]
    fn slow_loads_have_small_errors_and_sudden_ones_have_not() {
        let slow = Curve::Smooth { start: 0.0, end: 0.1 };
        let of = |curve: &Curve, step: f64| error_of_a_mass(curve, 72.0, step, 0.2);
        assert!(of(&slow, 0.01) < 2e-3, "{}", of(&slow, 0.01));
        assert!(of(&Curve::default(), 0.01) > 0.1, "{}", of(&Curve::default(), 0.01));
        assert_eq!(of(&Curve::Table(vec![(0.0, 0.0)]), 0.01), f64::INFINITY, "what nothing loads has no error");
    }

    /// Who is glued or tied to what is held is held; who hangs on a thread may be carried.
    #[test]
    fn bodies_are_held_by_what_does_not_move() {
        let held = |by: &str, attachments: &str| {
            let mesh = "mesh: Box(size: (1, 1, 1), cells: (1, 1, 1))";
            let body = |name: &str| format!("\"{name}\": ({mesh}, material: \"m\")");
            let text = format!(
                "(duration: 1, bodies: {{{}, {}, {}}},
                materials: {{\"m\": (density: 1, neo_hookean: Young(young: 1, poisson: 0))}},
                attachments: [{attachments}])",
                body("a"),
                body("b"),
                body("c")
            );
            let scene = SceneFile::from_memory("held.ron", &text, Default::default(), &[]).unwrap().scene;
            are_held(&scene, scene.bodies.keys().filter(|name| by.contains(name.as_str())).collect())
        };
        let glue = "Glue(bodies: (\"a\", \"b\"))";
        let ends = "from: (body: \"b\", at: (0, 0, 0)), to: (body: \"c\", at: (0, 0, 0))";
        assert!(held("c", &format!("{glue}, Tie({ends})")));
        assert!(!held("c", glue));
        assert!(!held("c", &format!("{glue}, Suture({ends}, stiffness: 1)")));
        assert!(held("abc", "") && !held("", ""));
    }

    /// Three corners of a block keep it from turning, and so do planes of symmetry; an edge, wherever it is, does not,
    /// and neither do nodes that do not move along one axis.
    #[test]
    fn what_can_turn_is_not_held() {
        let held = |axes: &dyn Fn(DVec3) -> Axes| {
            let corner = |n: usize| DVec3::new((n & 1) as f64, ((n >> 1) & 1) as f64, (n >> 2) as f64);
            let block: Vec<DVec3> = (0..8).map(|n| DVec3::new(0.3, -7.0, 0.1) + 0.02 * corner(n)).collect();
            let nodes: Vec<(DVec3, Axes)> = (0..8).zip(&block).map(|(n, place)| (*place, axes(corner(n)))).collect();
            leaves_no_way(&nodes)
        };
        let all = |is_one: bool| if is_one { 7 } else { 0 };
        assert!(held(&|x| all(x.x == 0.0)) && held(&|x| all(x.element_sum() <= 1.0 && x.z == 0.0)));
        assert!(held(&|x| u32::from(x.x == 0.0) + 2 * u32::from(x.y == 0.0) + 4 * u32::from(x.z == 0.0)));
        assert!(!held(&|x| all(x.x == 0.0 && x.z == 1.0)) && !held(&|x| all(x.element_sum() == 0.0)));
        assert!(!held(&|_| 1) && !held(&|_| 0) && !leaves_no_way(&[]));
        // held about it, but not along it
        assert!(!held(&|x| 6 * u32::from(x.x == 0.0)));
    }

    /// Of a smooth load errors of the first order halve with the step.
    #[test]
    fn errors_of_slow_loads_shrink_with_the_step() {
        let quick = Curve::Smooth { start: 0.0, end: 0.1 };
        let [long, short] = [2e-3, 1e-3].map(|step| error_of_a_mass(&quick, 10.0, step, 0.1));
        assert!(short < 0.6 * long && short > 0.4 * long, "{long} {short}");
    }
}
