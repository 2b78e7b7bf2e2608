//! Bodies that are where others are, or rigid tools. Nothing keeps bodies apart that no contact is between: what they
//! do to each other then is nothing, and that must be known.

mod tools;

use crate::backend::device::bring_to_host;
use crate::components::*;
use crate::contact::triangles_of;
use crate::error::Error;
use crate::math::coordinates;
use crate::mesh::{Locator, Mesh, OnTriangle};
use bevy_ecs::prelude::*;
use glam::DVec3;
use std::collections::HashMap;

/// What the warnings are called.
const OVERLAP: &str = "overlap";
/// Pairs of bodies that are told; who has more knows what is wrong.
const MOST_PAIRS: usize = 100;
/// How deep in its own element, as a share of the way from its surface to its middle, a point must be that lies in
/// another body: what only touches does not overlap, nor do curved surfaces whose facets differ.
const DEPTH: f64 = 0.05;

/// Where two bodies overlap.
struct Overlap {
    /// A node of the surface (author's number), or one of the face whose middle it is.
    node: u64,
    /// The element of the other body (author's number).
    element: u64,
    at: DVec3,
    /// How long an edge of the face is (m).
    edge: f64,
}

/// A body as it is now.
struct Placed<'a> {
    body: Entity,
    label: &'a str,
    authoring: &'a Authoring,
    /// In the author's order (m).
    points: Vec<DVec3>,
    low: DVec3,
    high: DVec3,
}

/// Looks for pairs of bodies that overlap, and for tools in bodies, and warns once of each. Boxes around bodies are
/// compared first: those of one body, or apart from each other, take no time.
///
/// # Errors
/// What the GPU says.
pub(super) fn check(world: &mut World) -> Result<(), Error> {
    let bodies: Vec<Entity> = world.query_filtered::<Entity, With<Authoring>>().iter(world).collect();
    let told = |memory: &GuardMemory| memory.warnings.iter().filter(|notice| notice.criterion == OVERLAP).count();
    let pairs = tools::pairs(world);
    if bodies.len() < 2 && pairs.is_empty()
        || world.get_resource::<GuardMemory>().is_some_and(|memory| told(memory) >= MOST_PAIRS)
    {
        return Ok(());
    }
    bring_to_host(world, |_, name| [Displacement::NAME, Alive::NAME, ToolHold::NAME].contains(&name))?;
    let (time, step) = (world.resource::<Clock>().time(), world.resource::<Clock>().step);
    let mut memory = world.get_resource::<GuardMemory>().cloned().unwrap_or_default();
    let mut placed: Vec<Placed<'_>> = bodies.iter().filter_map(|&body| place(world, body)).collect();
    placed.sort_by_key(|body| body.label);
    for (number, a) in placed.iter().enumerate() {
        for b in &placed[number + 1..] {
            let (low, high) = (a.low.max(b.low), a.high.min(b.high));
            // false also where a position is no number
            if !low.cmplt(high).all() || told(&memory) >= MOST_PAIRS {
                continue;
            }
            let part = format!("{} and {}", a.label, b.label);
            if memory.warnings.iter().any(|notice| notice.criterion == OVERLAP && notice.part == part) {
                continue;
            }
            let (near_a, near_b) = (near(world, a, low, high), near(world, b, low, high));
            let kept = Kept::of(world, [a.body, b.body]);
            let meet = matches!(kept, Kept::Contact { .. });
            let found = overlap((&near_a, &near_b), (a, b), meet).map(|found| (found, a, b));
            let found = found.or_else(|| overlap((&near_b, &near_a), (b, a), meet).map(|found| (found, b, a)));
            if let Some((found, one, other)) = found {
                let message = message(&found, one.label, other.label, kept);
                let criterion = OVERLAP.to_string();
                memory.warnings.push(Notice { criterion, part, time, step, value: 1.0, limit: 0.0, message });
            }
        }
    }
    tools::check(world, &pairs, &mut memory, (time, step));
    world.insert_resource(memory);
    Ok(())
}

/// What keeps two bodies apart.
enum Kept {
    Contact {
        /// Whether its points are those of faces, and not nodes.
        faces: bool,
        /// Whether its forces can be corrected again in a step.
        sweeps: bool,
    },
    Glue,
    Nothing,
}

impl Kept {
    fn of(world: &World, pair: [Entity; 2]) -> Self {
        let meets = world.get::<Meets>(pair[0]).and_then(|meets| meets.0.iter().find(|met| met.body == pair[1]));
        let tied = |glue: &Glue| {
            glue.ties.iter().any(|tie| pair.iter().all(|body| tie.bodies.map(|of| glue.bodies[of]).contains(body)))
        };
        if let Some(met) = meets {
            Self::Contact { faces: met.faces, sweeps: !met.spring }
        } else if world.get_resource::<Glue>().is_some_and(tied) {
            Self::Glue
        } else {
            Self::Nothing
        }
    }
}

fn message(found: &Overlap, one: &str, other: &str, kept: Kept) -> String {
    let Overlap { node, element, at, edge } = found;
    let at = coordinates(*at, *edge);
    format!(
        "{one} and {other} overlap at ({at}) m: the surface of {one} at its node {node} is in element {element} of {other}; {}",
        match kept {
            Kept::Contact { faces, sweeps } => format!(
                "contact has let them: finer faces, {}{}slower motion keep them apart better",
                if faces { "" } else { "`points: Faces`, " },
                if sweeps { "`sweeps` or " } else { "a larger `share` or " },
            ),
            Kept::Glue =>
                "they are glued or tied, at some of their points, and between these faces bend or are bent as they \
                 are: finer faces there overlap less"
                    .into(),
            Kept::Nothing =>
                format!("nothing keeps them apart: `contacts: [Between(bodies: (\"{one}\", \"{other}\"))]` does"),
        }
    )
}

fn place(world: &World, entity: Entity) -> Option<Placed<'_>> {
    let authoring = world.get::<Authoring>(entity)?;
    let (rest, u) = (&world.get::<RestPosition>(entity)?.0, world.get::<Displacement>(entity)?);
    let point = |&row: &u32| rest[row as usize] + u.vector(row as usize);
    let points: Vec<DVec3> = authoring.node_rows.iter().map(point).collect();
    let low = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    Some(Placed { body: entity, label: &world.get::<Label>(entity)?.0, authoring, points, low, high })
}

/// The elements of a body that are there and reach into a box, with their places in the author's order and those of
/// their nodes.
struct NearBox {
    mesh: Mesh,
    elements: Vec<usize>,
    nodes: Vec<u32>,
    low: DVec3,
    high: DVec3,
}

fn near(world: &World, body: &Placed<'_>, low: DVec3, high: DVec3) -> NearBox {
    let Placed { authoring, points, .. } = body;
    let there = |element: usize| {
        let (block, row) = authoring.element_rows[element];
        world.get::<Alive>(authoring.blocks[block as usize]).is_none_or(|alive| alive[row as usize] == 1)
    };
    let reaches = |nodes: &[u32]| {
        let corners = nodes.iter().map(|&node| points[node as usize]);
        let (a, b) = corners.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
        a.cmple(high).all() && b.cmpge(low).all()
    };
    let cells = authoring.cells.iter().enumerate();
    let elements: Vec<usize> =
        cells.filter(|(row, (_, nodes))| reaches(nodes) && there(*row)).map(|(row, _)| row).collect();
    let (mut nodes, mut rows) = (Vec::new(), vec![u32::MAX; points.len()]);
    let row = |node: u32| {
        let row = &mut rows[node as usize];
        if *row == u32::MAX {
            *row = nodes.len() as u32;
            nodes.push(node);
        }
        *row
    };
    let cells = authoring.cells.select(elements.iter().copied(), row);
    let points = nodes.iter().map(|&node| points[node as usize]).collect();
    let mesh = Mesh { points, cells, ..Mesh::default() };
    NearBox { mesh, elements, nodes, low, high }
}

/// The surface of a body as contact has it, of each of its elements near a box: a face that is warped is two triangles
/// there, and the element bulges out of one side of them.
fn triangles(near: &NearBox, body: &Placed<'_>) -> HashMap<u32, Vec<[DVec3; 3]>> {
    let mut found: HashMap<u32, Vec<[DVec3; 3]>> = HashMap::new();
    for face in near.mesh.surface() {
        let facets = face.facets().map(|facet| facet.map(|node| near.nodes[node as usize]));
        let of_face = facets.flat_map(triangles_of).map(|corners| corners.map(|node| body.points[node as usize]));
        found.entry(face.element).or_default().extend(of_face);
    }
    found
}

/// Whether a place in an element is also behind the triangles of its surface, if it has some.
fn behind(x: DVec3, triangles: &[[DVec3; 3]]) -> bool {
    let away = |triangle: &[DVec3; 3]| OnTriangle::nearest(x, *triangle).at.distance_squared(x);
    let nearest = triangles.iter().min_by(|a, b| away(a).total_cmp(&away(b)));
    nearest.is_none_or(|&[a, b, c]| (b - a).cross(c - a).dot(x - a) < 0.0)
}

/// Whether a point below the surface of one body lies in an element of the other; of bodies that meet, behind its
/// surface as contact has it, too. Where the elements near the box leave off counts as surface, too: what is in there
/// is in the body all the same.
fn overlap((one, other): (&NearBox, &NearBox), (of, with): (&Placed<'_>, &Placed<'_>), meet: bool) -> Option<Overlap> {
    if one.elements.is_empty() || other.elements.is_empty() {
        return None;
    }
    let locator = Locator::new(&other.mesh);
    let points = &one.mesh.points;
    let surface = if meet { triangles(other, with) } else { HashMap::new() };
    let behind = |x: DVec3, element: usize| surface.get(&(element as u32)).is_none_or(|of| behind(x, of));
    for face in one.mesh.surface() {
        let corners = one.mesh.element(face.element as usize);
        let middle = corners.iter().map(|&node| points[node as usize]).sum::<DVec3>() / corners.len() as f64;
        let nodes = face.nodes.map(|node| points[node as usize]);
        let count = face.corners().len();
        let mut center = nodes[..count].iter().sum::<DVec3>() / count as f64;
        if meet && count == 4 {
            // of its own middle and that of the side which its two triangles share, the one that is less far out
            let mut triangles = triangles_of(face.nodes.map(|node| one.nodes[node as usize]));
            let shared = triangles.next().zip(triangles.next()).map(|(first, second)| {
                let both = (0..4).filter(|&corner| {
                    let node = one.nodes[face.nodes[corner] as usize];
                    first.contains(&node) && second.contains(&node)
                });
                both.map(|corner| 0.5 * nodes[corner]).sum::<DVec3>()
            });
            center = shared.filter(|side| side.distance(middle) < center.distance(middle)).unwrap_or(center);
        }
        for (place, x) in nodes[..count].iter().chain([&center]).enumerate() {
            let below = x.lerp(middle, DEPTH);
            let inside = below.cmpge(one.low).all() && below.cmple(one.high).all();
            let held = inside.then(|| locator.holds(below)).flatten();
            if let Some(element) = held.filter(|&held| behind(below, held)) {
                let node = one.nodes[face.nodes[place % count] as usize];
                let node = of.authoring.node_ids.of(node as usize);
                let element = with.authoring.element_ids.of(other.elements[element]);
                return Some(Overlap { node, element, at: *x, edge: nodes[0].distance(nodes[1]) });
            }
        }
    }
    None
}
