//! Bodies that are where others are, or rigid tools. Nothing keeps bodies apart that no contact is between: what they
//! do to each other then is nothing, and that must be known.

mod tools;

use crate::backend::device::bring_to_host;
use crate::components::*;
use crate::error::Error;
use crate::math::coordinates;
use crate::mesh::{Locator, Mesh};
use bevy_ecs::prelude::*;
use glam::DVec3;

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
            let found = overlap(&near_a, &near_b, a, b).map(|found| (found, a, b));
            let found = found.or_else(|| overlap(&near_b, &near_a, b, a).map(|found| (found, b, a)));
            if let Some((found, one, other)) = found {
                let message = message(&found, one.label, other.label, Kept::of(world, [one.body, other.body]));
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
    Contact,
    Glue,
    Nothing,
}

impl Kept {
    fn of(world: &World, pair: [Entity; 2]) -> Self {
        let meets = world.get::<Meets>(pair[0]).is_some_and(|meets| meets.0.iter().any(|met| met.body == pair[1]));
        let tied = |glue: &Glue| {
            glue.ties.iter().any(|tie| pair.iter().all(|body| tie.bodies.map(|of| glue.bodies[of]).contains(body)))
        };
        if meets {
            Self::Contact
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
            Kept::Contact =>
                "contact has let them: finer faces, `points: Faces`, `sweeps` or slower motion keep them apart better"
                    .into(),
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

/// Whether a point below the surface of one body lies in an element of the other. Where the elements near the box leave
/// off counts as surface, too: what is in there is in the body all the same.
fn overlap(one: &NearBox, other: &NearBox, of: &Placed<'_>, with: &Placed<'_>) -> Option<Overlap> {
    if one.elements.is_empty() || other.elements.is_empty() {
        return None;
    }
    let locator = Locator::new(&other.mesh);
    let points = &one.mesh.points;
    for face in one.mesh.surface() {
        let corners = one.mesh.element(face.element as usize);
        let middle = corners.iter().map(|&node| points[node as usize]).sum::<DVec3>() / corners.len() as f64;
        let nodes = face.nodes.map(|node| points[node as usize]);
        let count = face.corners().len();
        let center = nodes[..count].iter().sum::<DVec3>() / count as f64;
        for (place, x) in nodes[..count].iter().chain([&center]).enumerate() {
            let below = x.lerp(middle, DEPTH);
            let inside = below.cmpge(one.low).all() && below.cmple(one.high).all();
            if let Some(element) = inside.then(|| locator.holds(below)).flatten() {
                let node = one.nodes[face.nodes[place % count] as usize];
                let node = of.authoring.node_ids.of(node as usize);
                let element = with.authoring.element_ids.of(other.elements[element]);
                return Some(Overlap { node, element, at: *x, edge: nodes[0].distance(nodes[1]) });
            }
        }
    }
    None
}
