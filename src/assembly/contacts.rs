//! Contacts with tools: selections become rows, and what stands in each other's way at the start is told.

use super::body_columns::stiffnesses;
use super::tool_overlaps::{self, Standing};
use super::{Assembly, BodyParts};
use crate::backend::cpu::Cpu;
use crate::components::*;
use crate::elements::Stiffness;
use crate::math::{radians, turned};
use crate::scene::SceneFile;
use crate::scene::diagnostic::Diagnostics;
use crate::scene::schema::{Contact, ContactLaw, Curve, Scene, Select, Tool, ToolMesh, ToolPlace};
use crate::tools::{DistanceGrid, Geometry, Solid};
use bevy_ecs::prelude::*;
use glam::DVec3;
use std::collections::BTreeMap;
use std::sync::Arc;

/// How far a tool may go in a step, in edges: beyond, it may be through a surface before anybody sees it.
pub(super) const FARTHEST: f64 = 0.5;

/// How far a node may go in a step against a tool with only its end looked at, as a share of half of what the tool
/// measures across: who goes more than all of that could be beyond its middle, and would be let out on the other side.
const SAFELY: f64 = 0.5;

/// How far from a body a tool may stay in a whole run, in what the body measures across, before that is told of.
const FAR: f64 = 100.0;

/// How many instants of a run are looked at for where a tool is, and when jaws close.
const INSTANTS: u32 = 1000;

/// Half of what a tool measures across, in edges, below which it may slip between nodes.
const THINNEST: f64 = 2.0;

/// Spawns what tools may touch on each body.
pub(super) fn spawn(assembly: &Assembly<'_>, world: &mut World, diagnostics: &mut Diagnostics) {
    let scene = &assembly.scene.scene;
    if scene.contacts.is_empty() {
        return;
    }
    let geometries = geometries(assembly.scene, world, diagnostics);
    for (name, body) in &assembly.bodies {
        let mut marks: BTreeMap<u32, u32> = BTreeMap::new();
        let (mut tools, mut numbers) = (Vec::new(), Vec::new());
        let reference = reference(&body.placed.mesh.points);
        let edge = edge(body);
        for (number, contact) in scene.contacts.iter().enumerate() {
            let Contact::Tool { tool, body: of, on, thin, .. } = contact else { continue };
            if of.as_ref().is_some_and(|of| of != name) {
                continue;
            }
            // what is wrong with it has been said
            let (Some(found), Some(geometry)) = (scene.tools.get(tool), geometries.get(tool)) else { continue };
            // those are the affair of `free_tool`
            if found.free.is_some() {
                continue;
            }
            let path = format!("contacts[{number}].on");
            let Some(rows) = rows(assembly, name, body, on, &path, diagnostics) else { continue };
            if !thin {
                may_slip(tool, name, (geometry, edge), diagnostics);
            }
            let bit = 1 << tools.len();
            rows.into_iter().for_each(|row| *marks.entry(row).or_default() |= bit);
            for (other, _) in tools.iter().enumerate().filter(|(_, other): &(_, &ToolContact)| other.tool == *tool) {
                let both = marks.values().filter(|mask| *mask & bit != 0 && **mask >> other & 1 == 1).count();
                meets_twice(both, (tool, name), [numbers[other], number], diagnostics);
            }
            numbers.push(number);
            let signal = Signal::Pose { motion: motion(found), reference };
            let signal = world.resource_mut::<Signals>().add(signal);
            let (friction, spring) = (contact.friction(), spring_of(contact, scene));
            let (tool, geometry) = (tool.clone(), geometry.clone());
            let swept = if spring.is_none() { sweeps_beyond(&geometry, edge) } else { 0.0 };
            tools.push(ToolContact { tool, geometry, signal, friction, spring, swept });
        }
        if tools.is_empty() {
            continue;
        }
        let settling = settling(body, edge, world);
        let led = |contact: &ToolContact| scene.tools.get(&contact.tool).is_some_and(|tool| tool.port.is_some());
        let felt = tools.iter().any(led);
        let (rows, masks): (Vec<u32>, _) = marks.into_iter().unzip();
        let rest = world.get::<RestPosition>(body.entity).map_or(&[][..], |rest| &rest.0);
        let boxes = ToolContacts::boxes_of(&rows, rest, reference);
        let contacts = ToolContacts { tools, reference, rows, masks, boxes, edge, settling, felt };
        let touch = Reals::zeros(assembly.precision, contacts.numbers() * contacts.rows.len());
        world.entity_mut(body.entity).insert((contacts, ToolTouch(touch)));
    }
}

/// Tells where guided tools are with which nothing is done.
pub(super) fn spawn_idle(assembly: &Assembly<'_>, world: &mut World) {
    let scene = &assembly.scene.scene;
    let is_idle = |(name, tool): &(&String, &Tool)| tool.free.is_none() && !scene.uses(name);
    let mut signals = world.resource_mut::<Signals>();
    let mut pose = |tool: &Tool| signals.add(Signal::Pose { motion: motion(tool), reference: DVec3::ZERO });
    let idle: BTreeMap<String, usize> =
        scene.tools.iter().filter(is_idle).map(|(name, tool)| (name.clone(), pose(tool))).collect();
    if !idle.is_empty() {
        world.insert_resource(IdleTools(idle));
    }
}

/// How far a node may go in a step against a tool (m) with only its end looked at: who goes half as far as the tool is
/// thick from its middle is still nearest to the side that it came through. Of a tool that is a mesh no farther than
/// half of its grid's spacing: it may have edges and tapers that are thinner than a spacing. 0: it may be any way.
pub(super) fn sweeps_beyond(geometry: &Geometry, edge: f64) -> f64 {
    geometry.smallest_radius().map_or(0.0, |radius| (SAFELY * radius).min(geometry.blur()).max(1e-6 * edge))
}

/// Tells that nodes of a body meet a tool by two contacts, of these numbers: which of them would count?
pub(super) fn meets_twice(
    nodes: usize,
    (tool, body): (&str, &str),
    [first, second]: [usize; 2],
    diagnostics: &mut Diagnostics,
) {
    if nodes > 0 {
        let many = if nodes == 1 { "a node".to_string() } else { format!("{nodes} nodes") };
        let message = format!("{many} of `{body}` would meet the tool `{tool}` twice: by contacts[{first}] and here");
        diagnostics
            .error_at(format!("contacts[{second}]").as_str(), message)
            .note("leave one of both out, or let `on` part the surface between them");
    }
}

/// The spring of a contact, if its law is one. At rest nothing damps.
pub(super) fn spring_of(contact: &Contact, scene: &Scene) -> Option<ContactSpring> {
    match contact.law() {
        ContactLaw::Kinematic => None,
        ContactLaw::Penalty { share, .. } if scene.is_static() => Some(ContactSpring { share, damping: 0.0 }),
        ContactLaw::Penalty { share, damping } => Some(ContactSpring { share, damping }),
    }
}

/// Warns of a tool that is hardly thicker than the faces that it meets, whose edges are so long (m).
pub(super) fn may_slip(tool: &str, body: &str, (geometry, edge): (&Geometry, f64), diagnostics: &mut Diagnostics) {
    // edges that are just as long as they may be are so to rounding
    let is_thin = |radius: &f64| *radius < THINNEST * edge * (1.0 - 1e-6);
    let Some(size) = geometry.smallest_radius().filter(is_thin) else { return };
    let message =
        format!("the tool `{tool}` may slip between nodes: it is hardly thicker than the faces that it meets");
    diagnostics
        .warn_at(format!("tools.\"{tool}\"").as_str(), message)
        .note(format!("half of its thickness is {size:.3e} m, and faces of `{body}` have edges of {edge:.3e} m"))
        .note(format!(
            "give `{body}` edges of {:.1e} m or less where it is touched (more cells, `refine`), or take a thicker tool; \
             `thin: true` in the contact says that this is meant",
            size / THINNEST
        ));
}

/// What the tools are made of, by name.
pub(super) fn geometries(
    scene: &SceneFile,
    world: &World,
    diagnostics: &mut Diagnostics,
) -> BTreeMap<String, Geometry> {
    let mut all = BTreeMap::new();
    for (name, tool) in &scene.scene.tools {
        if let Some(shape) = &tool.shape {
            let solid = Solid::new(shape.clone(), tool.rounding);
            all.extend(solid.ok().map(|solid| (name.clone(), Geometry::Analytic(solid))));
        } else if let Some(mesh) = &tool.mesh {
            let path = format!("tools.\"{name}\".mesh");
            match grid(scene, mesh, world) {
                Ok(grid) => {
                    for note in grid.notes() {
                        diagnostics.warn_at(path.as_str(), format!("{}: {note}", mesh.path));
                    }
                    all.insert(name.clone(), Geometry::Grid(Arc::new(grid)));
                }
                Err(message) => {
                    diagnostics.error_at(path.as_str(), message);
                }
            }
        }
    }
    all
}

/// The distances of a tool that is a file of triangles.
fn grid(scene: &SceneFile, mesh: &ToolMesh, world: &World) -> Result<DistanceGrid, String> {
    let mut surface = scene.surface(&mesh.path)?;
    surface.points.iter_mut().for_each(|point| *point *= mesh.scale);
    let spacing = mesh.spacing.unwrap_or_else(|| DistanceGrid::usual_spacing(&surface));
    let make = || DistanceGrid::new(&surface, spacing);
    let made = world.get_resource::<Cpu>().map_or_else(make, |cpu| cpu.confine(make));
    made.map_err(|error| format!("{}: {error}", mesh.path))
}

/// The nodes that a tool may touch: of bodies that lose elements those inside, too, which may come to the surface.
pub(super) fn rows(
    assembly: &Assembly<'_>,
    name: &str,
    body: &BodyParts,
    on: &Select,
    path: &str,
    diagnostics: &mut Diagnostics,
) -> Option<Vec<u32>> {
    let whole = matches!(on, Select::Surface { normal: None, .. });
    if whole && assembly.scene.scene.may_lose_elements(name) {
        return Some((0..body.node_rows.len() as u32).collect());
    }
    let picked = assembly.pick(body, on, path, diagnostics)?;
    match picked.nodes(&body.placed) {
        Ok(marks) => Some(body.rows_of(&marks)),
        Err(problem) => {
            diagnostics.error_at(path, problem.message).notes(problem.notes);
            None
        }
    }
}

/// The middle of the box around points (m).
pub(super) fn reference(points: &[DVec3]) -> DVec3 {
    let (low, high) = bounds(points);
    0.5 * (low + high)
}

pub(super) fn bounds(points: &[DVec3]) -> (DVec3, DVec3) {
    let low = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    (low, points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max))
}

/// The mean length of a surface's edges (m).
pub(super) fn edge(body: &BodyParts) -> f64 {
    let points = &body.placed.mesh.points;
    let (mut sum, mut count) = (0.0, 0.0);
    for facet in body.placed.surface().iter().flat_map(|face| face.facets()) {
        let corners = crate::mesh::CellKind::of_face(&facet).node_count();
        for i in 0..corners {
            let [from, to] = [i, (i + 1) % corners].map(|i| points[facet[i] as usize]);
            sum += from.distance(to);
            count += 1.0;
        }
    }
    if count > 0.0 { sum / count } else { 0.0 }
}

/// How fast nodes inside a tool come out (m/s): half an edge in the time that a wave takes through the body, or through
/// one of its copies.
pub(super) fn settling(body: &BodyParts, edge: f64, world: &World) -> f64 {
    let points = &body.placed.mesh.points;
    let (low, high) = bounds(&points[..points.len() / body.copies.max(1)]);
    let square = |of: Stiffness| (of.lambda + 2.0 * of.shear + of.eta) / of.density;
    let materials = body.blocks.iter().flat_map(|&block| stiffnesses(world, block));
    let speed = materials.map(square).fold(0.0, f64::max).sqrt();
    0.5 * edge * speed / (high - low).length()
}

/// How a tool of the scene moves.
pub fn motion(tool: &Tool) -> ToolMotion {
    let place = |place: &ToolPlace| (place.t, place.at, turned(place.rotation));
    ToolMotion {
        path: tool.places().iter().map(place).collect(),
        moves: tool.moves.iter().map(|part| (part.displacement, radians(part.rotation))).collect(),
        curves: tool.moves.iter().map(|part| part.curve.clone()).collect(),
        pivot: tool.pivot,
        hand: tool.port.as_ref().map(|port| Hand {
            port: port.name.clone(),
            speed: port.speed,
            spin: port.spin.to_radians(),
        }),
    }
}

/// Looks for nodes inside tools at the start, and tells whether there are some; and for tools that are too fast for the
/// mesh.
pub(super) fn check(assembly: &Assembly<'_>, world: &World, diagnostics: &mut Diagnostics) -> bool {
    let mut are_inside = false;
    let clock = world.resource::<Clock>();
    for (name, body) in &assembly.bodies {
        let Some(contacts) = world.get::<ToolContacts>(body.entity) else { continue };
        for (bit, contact) in contacts.tools.iter().enumerate() {
            let Some(tool) = assembly.scene.scene.tools.get(&contact.tool) else { continue };
            let motion = motion(tool);
            let path = format!("tools.\"{}\"", contact.tool);
            // a static analysis lets every motion grow from nothing
            let grows = clock.relaxation.is_some();
            let pose = motion.pose(0.0, |number| if grows { 0.0 } else { motion.curves[number].value(0.0) });
            let touched = contacts.rows.iter().zip(&contacts.masks).filter(|(_, mask)| **mask >> bit & 1 == 1);
            let rows: Vec<u32> = touched.map(|(&row, _)| row).collect();
            let standing =
                Standing { tool: &contact.tool, geometry: &contact.geometry, pose, rows: &rows, edge: contacts.edge };
            are_inside |= tool_overlaps::check(name, body, &standing, (&assembly.scene.scene, world), diagnostics);
            if clock.relaxation.is_some() {
                continue;
            }
            jumps(&contact.tool, tool, "nodes that it meets there are pushed out by and by", diagnostics);
            let duration = assembly.scene.scene.duration;
            stays_far(contact, (name, body), (&motion, duration), diagnostics);
            let reach = contact.geometry.bounding_sphere().map_or(0.0, |(center, radius)| center.length() + radius);
            let speed = motion.fastest(reach);
            if speed * clock.time_step > FARTHEST * contacts.edge {
                let message = format!(
                    "the tool `{}` {} {speed:.3e} m/s, {:.3e} m a step, and faces of `{name}` have edges of {:.3e} m",
                    contact.tool,
                    // a bound, and a wide one
                    if tool.pivot.is_some() { "may, as far as its pivot tells, go up to" } else { "goes up to" },
                    speed * clock.time_step,
                    contacts.edge,
                );
                let way_out = if tool.port.is_some() { "lower the `speed` of its port" } else { "give it more time" };
                diagnostics.error_at(path.as_str(), message).note(format!(
                    "it could be through a surface before anybody sees it: {way_out}, or take a smaller `step`"
                ));
            }
        }
    }
    are_inside
}

/// Times of a run (s) at which it is looked where a tool is.
pub(super) fn instants(duration: f64) -> impl Iterator<Item = f64> {
    (0..=INSTANTS).map(move |instant| duration * f64::from(instant) / f64::from(INSTANTS))
}

/// Where a tool that is not led is on its way, as far as a run goes.
pub(super) fn way(motion: &ToolMotion, duration: f64) -> impl Iterator<Item = Pose> {
    let times = instants(duration).chain(motion.path.iter().map(|key| key.0).filter(move |time| *time <= duration));
    times.map(move |time| motion.meant(time))
}

/// Warns of a tool that stays so far from where a body begins as nobody means who counts in metres.
fn stays_far(
    contact: &ToolContact,
    (name, body): (&str, &BodyParts),
    (motion, duration): (&ToolMotion, f64),
    diagnostics: &mut Diagnostics,
) {
    let Some((middle, radius)) = contact.geometry.bounding_sphere().filter(|_| !motion.is_led()) else { return };
    let (low, high) = bounds(&body.placed.mesh.points);
    let across = low.distance(high);
    let places = way(motion, duration).map(|pose| pose.place(middle));
    let nearest = places.map(|place| place.distance(0.5 * (low + high))).fold(f64::INFINITY, f64::min);
    let away = nearest - radius - 0.5 * across;
    if away > FAR * across {
        let message = format!(
            "the tool `{}` comes no nearer than {away:.3e} m to where `{name}` is, which measures {across:.3e} m across",
            contact.tool
        );
        let note = "lengths are metres: `scale` of a tool's mesh, or of a part, makes them of millimetres (1e-3)";
        diagnostics.warn_at(format!("tools.\"{}\"", contact.tool).as_str(), message).note(note);
    }
}

/// Warns of moves that happen all at once, and of what becomes of nodes then.
pub(super) fn jumps(name: &str, tool: &Tool, nodes: &str, diagnostics: &mut Diagnostics) {
    for (number, part) in tool.moves.iter().enumerate() {
        let (message, note) = match &part.curve {
            Curve::Step { start, end } if *start > 0.0 || end.is_some() => {
                ("the tool jumps", "let it take time: curve: Smooth(end: ...), Ramp(end: ...) or Table([...])")
            }
            Curve::Input { rate: None, .. } => {
                ("an input without `rate` lets the tool jump", "bound its change a second: Input(name: ..., rate: ...)")
            }
            _ => continue,
        };
        let path = format!("tools.\"{name}\".moves[{number}].curve");
        diagnostics.warn_at(path.as_str(), format!("{message}: {nodes}")).note(note);
    }
}
