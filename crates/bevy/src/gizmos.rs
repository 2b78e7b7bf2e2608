//! What holds and pushes tissue, drawn over it.

use crate::simulation::*;
use crate::{SinewSystems, SoftGrab};
use bevy_app::{App, Plugin, PostUpdate};
use bevy_color::Color;
use bevy_ecs::prelude::*;
use bevy_gizmos::gizmos::Gizmos;
use bevy_math::{Isometry3d, Vec3};
use bevy_transform::components::GlobalTransform;
use sinew::components::{ConstrainedAxes, ExternalForce};
use sinew::{Error, Simulation};

/// So many marks of a kind are drawn of a body; more would hide what they are about.
const MOST: usize = 500;
/// How long the longest arrow is, in diagonals of the body's box.
const ARROW: f32 = 0.125;
/// Half the size of a cross, in the same.
const CROSS: f32 = 0.01;

const SUPPORT: Color = Color::srgb(0.15, 0.35, 0.9);
const LOAD: Color = Color::srgb(0.9, 0.35, 0.1);
const TOOL: Color = Color::srgb(0.1, 0.6, 0.3);
const HAND: Color = Color::srgb(0.9, 0.75, 0.1);

/// Draws what scenes with [`SoftGizmos`] ask for, with Bevy's gizmos: it needs their plugin, which `DefaultPlugins`
/// have.
#[derive(Clone, Copy, Debug, Default)]
pub struct SinewGizmosPlugin;

impl Plugin for SinewGizmosPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(PostUpdate, draw.after(SinewSystems::WriteMeshes));
    }
}

/// What of a scene is drawn over its bodies: put it beside [`SoftScene`].
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
pub struct SoftGizmos {
    /// A cross at each node that is fixed or moved as told.
    pub supports: bool,
    /// An arrow for the force of loads, tools and hands on each node, as of the last step: the longest an eighth of the
    /// body's diagonal.
    pub forces: bool,
    /// A cross where each tool is, and an arrow for the force on it, as long as that of a body's nodes would be.
    pub tools: bool,
    /// A line from what is held to where it is pulled to.
    pub grabs: bool,
}

impl Default for SoftGizmos {
    /// All of it.
    fn default() -> Self {
        Self { supports: true, forces: true, tools: true, grabs: true }
    }
}

/// Something to be drawn, in the metres and axes of the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Mark {
    Cross(Vec3, f32, Color),
    Arrow(Vec3, Vec3, Color),
    Line(Vec3, Vec3, Color),
}

fn draw(
    mut gizmos: Gizmos,
    mut scenes: Query<(Entity, &SoftGizmos, &mut SoftSimulation, &GlobalTransform)>,
    hands: Query<&SoftGrab>,
) {
    for (scene, wanted, mut simulation, place) in &mut scenes {
        // what cannot be read is told by the step that could not be taken
        let mut marks = marks(&mut simulation, wanted).unwrap_or_default();
        if wanted.grabs {
            let held = hands.iter().filter(|hand| hand.scene == scene);
            marks.extend(held.filter_map(|hand| held_by(&mut simulation, hand, place)));
        }
        for mark in marks {
            let at = |point: Vec3| place.transform_point(point);
            match mark {
                Mark::Cross(center, half, color) => {
                    let half = (at(center + half * Vec3::X) - at(center)).length();
                    gizmos.cross(Isometry3d::from_translation(at(center)), half, color);
                }
                Mark::Arrow(from, to, color) => drop(gizmos.arrow(at(from), at(to), color)),
                Mark::Line(from, to, color) => gizmos.line(at(from), at(to), color),
            }
        }
    }
}

/// All that is asked for but hands.
fn marks(simulation: &mut Simulation, wanted: &SoftGizmos) -> Result<Vec<Mark>, Error> {
    let bodies: Vec<String> = simulation.scene().bodies.keys().cloned().collect();
    let mut marks = Vec::new();
    let mut largest: f32 = 0.0;
    for body in &bodies {
        let nodes: Vec<Vec3> = simulation.positions(body)?.into_iter().map(|node| node.as_vec3()).collect();
        let size = diagonal(&nodes);
        largest = largest.max(size);
        if wanted.supports {
            let held = supports(simulation, body, &nodes)?;
            marks.extend(held.into_iter().take(MOST).map(|node| Mark::Cross(node, CROSS * size, SUPPORT)));
        }
        if wanted.forces {
            let forces = forces(simulation, body);
            let mut pushed: Vec<(Vec3, Vec3)> = nodes.iter().copied().zip(forces).collect();
            pushed.retain(|(_, force)| force.is_finite() && *force != Vec3::ZERO);
            pushed.sort_by(|a, b| b.1.length_squared().total_cmp(&a.1.length_squared()));
            let scale = pushed.first().map_or(0.0, |(_, force)| ARROW * size / force.length());
            marks.extend(pushed.iter().take(MOST).map(|(node, force)| Mark::Arrow(*node, node + scale * force, LOAD)));
        }
    }
    if wanted.tools {
        let tools: Vec<String> = simulation.scene().tools.keys().cloned().collect();
        let read = |tool: &String| simulation.tool(tool);
        let readings = tools.iter().map(read).collect::<Result<Vec<_>, Error>>()?;
        let most = readings.iter().map(|tool| tool.force.length()).fold(0.0, f64::max);
        for tool in readings {
            let place = tool.place.as_vec3();
            marks.push(Mark::Cross(place, 3.0 * CROSS * largest, TOOL));
            if most > 0.0 && tool.force.length() > 0.0 {
                let arrow = ARROW * largest * (tool.force / most).as_vec3();
                marks.push(Mark::Arrow(place, place + arrow, TOOL));
            }
        }
    }
    Ok(marks)
}

/// The diagonal of the box around some points (m).
fn diagonal(points: &[Vec3]) -> f32 {
    let ends = points
        .iter()
        .filter(|point| point.is_finite())
        .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), point| (low.min(*point), high.max(*point)));
    let size = (ends.1 - ends.0).length();
    if size.is_finite() { size } else { 0.0 }
}

/// Nodes that are fixed or moved as told along any axis.
fn supports(simulation: &mut Simulation, body: &str, nodes: &[Vec3]) -> Result<Vec<Vec3>, Error> {
    let entity = simulation.body(body)?;
    let rows: Vec<u32> = simulation.column::<sinew::components::Displacement>(body)?.node_rows().to_vec();
    let Some(axes) = simulation.world().get::<ConstrainedAxes>(entity) else { return Ok(Vec::new()) };
    let held = nodes.iter().zip(rows).filter(|(_, row)| axes.get(*row as usize).is_some_and(|axes| *axes != 0));
    Ok(held.map(|(node, _)| *node).collect())
}

/// The force of loads on each node (N); nothing where the scene has none.
fn forces(simulation: &mut Simulation, body: &str) -> Vec<Vec3> {
    let Ok(column) = simulation.column::<ExternalForce>(body) else { return Vec::new() };
    let mut numbers = vec![0.0; column.node_rows().len() * column.numbers()];
    match column.copy_in_authors_order(&mut numbers) {
        Ok(()) => numbers.as_chunks::<3>().0.iter().map(|force| Vec3::from_array(*force)).collect(),
        Err(_) => Vec::new(),
    }
}

/// From the point that a hand holds to where it pulls.
fn held_by(simulation: &mut Simulation, hand: &SoftGrab, place: &GlobalTransform) -> Option<Mark> {
    let nodes = simulation.positions(&hand.pick.body).ok()?;
    let corners = hand.pick.nodes.iter().zip(hand.pick.weights);
    let held = corners.filter_map(|(node, weight)| Some(nodes.get(*node as usize)?.as_vec3() * weight as f32)).sum();
    Some(Mark::Line(held, in_scene(place, hand.target).as_vec3(), HAND))
}
