//! How far nodes are outside of what they face where contact does not look in a step, since nothing there can touch in
//! it: by the surfaces as they are.

use super::{FacetNow, surface_now};
use crate::backend::cpu::Cpu;
use crate::components::*;
use crate::contact::{
    DEEPEST, Faced, Finder, Kept, Listed, Lists, Placed, Point, Shortlist, Stays, Surfaces, Tree, face_points,
    triangles_of,
};
use crate::error::Error;
use bevy_ecs::prelude::*;
use glam::DVec3;

/// Triangles of bodies, with nodes numbered through all of them: those of a body in the author's order.
#[derive(Default)]
struct Bodies {
    places: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    owners: Vec<u32>,
    depths: Vec<f64>,
}

impl Bodies {
    /// Adds a facet of a body, whose nodes begin at a number and which is so deep behind it at most (m). The nodes of
    /// the facet, and the number of its first triangle.
    fn add(&mut self, (owner, first, deepest): (u32, u32, f64), facet: &FacetNow) -> ([u32; 4], u32) {
        let number = self.triangles.len() as u32;
        for corners in triangles_of(facet.facet) {
            self.triangles.push(corners.map(|node| first + node));
            self.owners.push(owner);
            self.depths.push(facet.depth.min(deepest));
        }
        (facet.facet.map(|node| first + node), number)
    }
}

/// Finds the gaps (m) of the nodes of a body's surface that have none, where they face bodies that it meets within a
/// distance (m). What it does with itself is left to contact: there most of what is near a node at rest is no gap.
pub(super) fn find(
    (body, surface): (Entity, &[FacetNow]),
    distance: f64,
    gaps: &mut [f64],
    world: &mut World,
) -> Result<(), Error> {
    let (Some(Meets(met)), Some(rest)) = (world.get::<Meets>(body), world.get::<RestPosition>(body)) else {
        return Ok(());
    };
    let met: Vec<Met> = met.iter().copied().filter(|met| met.body != body).collect();
    // places that are counted from near the body keep their digits
    let reference = rest.0.first().copied().unwrap_or_default();
    let mut wanted = vec![false; gaps.len()];
    let nodes = surface.iter().flat_map(|facet| &facet.nodes);
    nodes.filter(|&&node| gaps[node].is_infinite()).for_each(|&node| wanted[node] = true);
    let mut facets: Vec<&FacetNow> =
        surface.iter().filter(|facet| facet.nodes.iter().any(|&node| wanted[node])).collect();
    if met.is_empty() || facets.is_empty() {
        return Ok(());
    }
    let farthest = distance + met.iter().map(|met| met.thickness).fold(0.0, f64::max);
    let mut all = Bodies { places: places_now(world, body, reference), ..Bodies::default() };
    // what is beyond boxes around others is nothing to anybody
    let asked = facets.iter().fold(NOWHERE, |asked, facet| join(asked, facet.lies_within(&all.places)));
    let asked = wider(asked, farthest);
    let (mut near, mut of_others) = (NOWHERE, Vec::new());
    for of in &met {
        let (mut facets, places) = (surface_now(of.body, world)?, places_now(world, of.body, reference));
        facets.retain(|facet| overlap(asked, facet.lies_within(&places)));
        near = facets.iter().fold(near, |near, facet| join(near, facet.lies_within(&places)));
        of_others.push((facets, places));
    }
    let near = wider(near, farthest);
    facets.retain(|facet| overlap(near, facet.lies_within(&all.places)));
    if facets.is_empty() {
        return Ok(());
    }
    let points = points(&facets, &wanted, &met, &mut all);
    let mut starts = vec![all.triangles.len() as u32];
    for (number, (of, (facets, places))) in (1..).zip(met.iter().zip(of_others)) {
        let first = all.places.len() as u32;
        all.places.extend(places);
        for facet in &facets {
            all.add((number, first, DEEPEST * of.edge_of_body), facet);
        }
        starts.push(all.triangles.len() as u32);
    }
    let Bodies { places, triangles, owners, depths } = all;
    let surfaces = Surfaces::new(places.len(), triangles, owners, depths);
    // nobody asks what is near the body itself
    let of_others = starts.windows(2).map(|range| {
        let corners = |triangle: u32| surfaces.corners(&places, triangle);
        Tree::new(range[0]..range[1], corners)
    });
    let trees: Vec<Tree> = std::iter::once(Tree::default()).chain(of_others).collect();
    let of = |number: u32| number.checked_sub(1).and_then(|number| met.get(number as usize));
    let meets = |_: u32, other: u32, of_face: bool| of(other).is_some_and(|met| met.faces == of_face);
    let beyond = vec![0.0; trees.len()];
    let finder = Finder { surfaces: &surfaces, points: &points, meets: &meets, apart: &[], beyond: &beyond };
    let lists = Lists::find(&finder, &trees, &places, farthest, world.resource::<Cpu>());
    let of_triangle = |triangle: u32| of(surfaces.bodies[triangle as usize]);
    let thickness = |triangle: u32| of_triangle(triangle).map_or(0.0, |met| met.thickness);
    let reach = |triangle: u32| distance + thickness(triangle);
    let edge = |triangle: u32| of_triangle(triangle).map_or(distance, |met| met.edge);
    let now = Placed { places: &places, normals: &[] };
    let mut kept = Kept::default();
    for (place, &number) in lists.points.iter().enumerate() {
        let point = &points[number as usize];
        let (triangles, distances) = (lists.triangles(place), lists.distances(place));
        let listed = Listed { triangles, distances, nearer: 0.0, farthest };
        let (mut faced, mut short) = (Faced::NOTHING, Shortlist::UNKNOWN);
        let of_point = (&mut short, Stays::default());
        surfaces.faced((now, point), listed, (&reach, &edge), of_point, (&mut faced, &mut kept));
        let Some(facing) = faced.first else { continue };
        let gap = facing.gap - thickness(facing.triangle);
        for (node, _) in point.parts().filter(|&(node, weight)| weight > 0.0 && wanted[node as usize]) {
            gaps[node as usize] = gaps[node as usize].min(gap);
        }
    }
    Ok(())
}

/// The points of a body's facets that meet others, of nodes those that are wanted. The facets are added: they say which
/// way points look.
fn points(facets: &[&FacetNow], wanted: &[bool], met: &[Met], all: &mut Bodies) -> Vec<Point> {
    let meets = |faces: bool| met.iter().any(|met| met.faces == faces);
    let mut points = Vec::new();
    if meets(false) {
        let mut nodes: Vec<usize> = facets.iter().flat_map(|facet| facet.nodes.iter().copied()).collect();
        nodes.sort_unstable();
        nodes.dedup();
        let nodes = nodes.into_iter().filter(|&node| wanted[node]);
        points.extend(nodes.map(|node| Point::node(0, node as u32)));
    }
    for facet in facets {
        // how deep its own inside goes matters to nobody
        let (nodes, first) = all.add((0, 0, 0.0), facet);
        let of_face = if meets(true) { face_points(nodes) } else { &[] };
        for (corner, weights) in of_face.iter().enumerate() {
            let is_on_first = all.triangles[first as usize].contains(&nodes[corner]);
            let triangle = Some(if is_on_first { first } else { first + 1 });
            points.push(Point { body: 0, nodes, weights, triangle });
        }
    }
    points
}

/// Where the nodes of a body are (m, from a reference), in the author's order. Displacements are on the host.
fn places_now(world: &World, body: Entity, reference: DVec3) -> Vec<DVec3> {
    let entity = world.entity(body);
    let (Some(authoring), Some(rest), Some(u)) =
        (entity.get::<Authoring>(), entity.get::<RestPosition>(), entity.get::<Displacement>())
    else {
        return Vec::new();
    };
    let place = |&row: &u32| rest.0[row as usize] - reference + u.vector(row as usize);
    authoring.node_rows.iter().map(place).collect()
}

/// The least and the largest coordinates of nothing.
const NOWHERE: [DVec3; 2] = [DVec3::INFINITY, DVec3::NEG_INFINITY];

impl FacetNow {
    /// The least and the largest coordinates of its corners (m).
    fn lies_within(&self, places: &[DVec3]) -> [DVec3; 2] {
        self.nodes.iter().fold(NOWHERE, |all, &node| join(all, [places[node]; 2]))
    }
}

fn join(a: [DVec3; 2], b: [DVec3; 2]) -> [DVec3; 2] {
    [a[0].min(b[0]), a[1].max(b[1])]
}

/// The same and so much more on all sides (m).
fn wider([low, high]: [DVec3; 2], more: f64) -> [DVec3; 2] {
    [low - more, high + more]
}

fn overlap(a: [DVec3; 2], b: [DVec3; 2]) -> bool {
    a[0].cmple(b[1]).all() && b[0].cmple(a[1]).all()
}
