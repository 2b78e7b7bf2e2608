//! Ties and glue: points and nodes become weights on faces.

use super::anchors::{OnSurface, anchor, nearest};
use super::contacts::{bounds, edge, reference};
use super::loads::corners_of;
use super::{Assembly, BodyParts};
use crate::components::*;
use crate::scene::diagnostic::Diagnostics;
use crate::scene::schema::{Attachment, Point, Select};
use bevy_ecs::prelude::*;
use glam::{DMat3, DVec3};
use std::collections::BTreeMap;

/// What is made of the attachments so far.
struct Gluing<'a> {
    assembly: &'a Assembly<'a>,
    glue: Glue,
    /// How many ties there are of each body's points.
    counts: BTreeMap<usize, usize>,
}

/// Spawns all ties, single ones and those of surfaces that are glued.
pub(super) fn spawn(assembly: &Assembly<'_>, world: &mut World, diagnostics: &mut Diagnostics) {
    let bodies = assembly.bodies.values().map(|body| body.entity).collect();
    let corners: Vec<DVec3> =
        assembly.bodies.values().flat_map(|body| <[DVec3; 2]>::from(bounds(&body.placed.mesh.points))).collect();
    let glue = Glue { bodies, sweeps: 1, reference: reference(&corners), ..Glue::default() };
    let mut gluing = Gluing { assembly, glue, counts: BTreeMap::new() };
    for (number, attachment) in assembly.scene.scene.attachments.iter().enumerate() {
        match attachment {
            Attachment::Tie { from, to, strength, .. } => {
                let strength = strength.map_or(Strength::Any, Strength::Force);
                gluing.tie(number, [from, to], strength, diagnostics);
            }
            Attachment::Glue { sweeps, .. } => {
                gluing.glue.sweeps = gluing.glue.sweeps.max(*sweeps as usize);
                gluing.surface(number, attachment, diagnostics);
            }
            Attachment::Grasp { .. } | Attachment::Suture { .. } => {}
        }
    }
    if gluing.glue.ties.is_empty() {
        return;
    }
    between_led_nodes(&gluing.glue, world, diagnostics);
    for (body, count) in gluing.counts {
        let state = TieState(Reals::zeros(assembly.precision, TIE_NUMBERS * count));
        world.entity_mut(gluing.glue.bodies[body]).insert(state);
    }
    world.insert_resource(gluing.glue);
}

/// Tells of ties between nodes that are fixed or prescribed on both sides: no force could move them.
fn between_led_nodes(glue: &Glue, world: &World, diagnostics: &mut Diagnostics) {
    let is_led = |body: usize, row: u32| {
        world.get::<ConstrainedAxes>(glue.bodies[body]).is_some_and(|axes| axes.hold(row as usize))
    };
    let mut counts: BTreeMap<usize, [usize; 2]> = BTreeMap::new();
    for tie in &glue.ties {
        let of_point = tie.nodes.iter().all(|&(row, _)| is_led(tie.bodies[0], row));
        let of_face = tie.bearers().all(|(row, _)| is_led(tie.bodies[1], row));
        let [led, all] = counts.entry(tie.number).or_default();
        (*led, *all) = (*led + usize::from(of_point && of_face), *all + 1);
    }
    for (number, [led, all]) in counts.into_iter().filter(|(_, [led, _])| *led > 0) {
        let message = format!("{led} of its {all} points are between nodes that are fixed or prescribed on both sides");
        diagnostics
            .warn_at(format!("attachments[{number}]").as_str(), message)
            .note("no force moves those: there it bears nothing, and never breaks");
    }
}

impl Gluing<'_> {
    /// A body by its name, or the only one: its place, its name and what is known of it.
    fn body(&self, name: Option<&String>) -> Option<(usize, &String, &BodyParts)> {
        let mut all = self.assembly.bodies.iter().enumerate();
        let found = all.find(|(_, (of, _))| name.is_none_or(|name| name == *of));
        found.map(|(place, (name, body))| (place, name, body))
    }

    fn push(&mut self, point: usize, tie: TiedPoint) {
        let count = self.counts.entry(point).or_default();
        self.glue.ties.push(TiedPoint { place: *count, ..tie });
        *count += 1;
    }

    /// Ties a point to the nearest face of another.
    fn tie(&mut self, number: usize, [from, to]: [&Point; 2], strength: Strength, diagnostics: &mut Diagnostics) {
        let (Some((of, name, body)), Some((onto, other, face))) =
            (self.body(from.body.as_ref()), self.body(to.body.as_ref()))
        else {
            return;
        };
        let path = |field: &str| format!("attachments[{number}].{field}.at");
        let first = anchor(name, body, from.at, &path("from"), diagnostics);
        let second = anchor(other, face, to.at, &path("to"), diagnostics);
        let (Some((point, at)), Some((_, place))) = (first, second) else { return };
        let Some(found) = nearest(face, place, &|_| true) else { return };
        let (apart, most) = (at.distance(found.at), edge(body).max(edge(face)));
        if apart > most {
            diagnostics.error_at(path("to").as_str(), format!("what is to be tied is {apart:.3e} m apart")).note(
                format!("a tie holds what touches, or nearly: up to an edge of a face, {most:.3e} m; a `Suture` pulls"),
            );
            return;
        }
        if of == onto && at.distance(place) <= 1e-9 * most {
            diagnostics.error_at(path("to").as_str(), "both points of the tie are one place");
            return;
        }
        let tie = tied([of, onto], point.nodes, face, &found, at, (strength, number, None));
        self.push(of, tie);
    }

    /// Ties the nodes of one surface that are near another one.
    fn surface(&mut self, number: usize, attachment: &Attachment, diagnostics: &mut Diagnostics) {
        let Attachment::Glue { bodies: (a, b), on, onto, reach, normal, shear, .. } = attachment else { return };
        let path = |field: &str| format!("attachments[{number}].{field}");
        let (Some((of, name, body)), Some((other, _, face))) = (self.body(Some(a)), self.body(Some(b))) else { return };
        for (name, body) in [(name, body), (b, face)] {
            if body.copies > 1 {
                let message = format!("`{name}` has {} copies: which of them?", body.copies);
                diagnostics
                    .error_at(path("bodies").as_str(), message)
                    .note("only a body without `copies` can be sutured, tied or glued");
                return;
            }
        }
        let (Some(points), Some(faces)) = (
            picked_faces(self.assembly, body, on, &path("on"), diagnostics),
            picked_faces(self.assembly, face, onto, &path("onto"), diagnostics),
        ) else {
            return;
        };
        let reach = reach.unwrap_or(0.1 * edge(body).min(edge(face)));
        let mut marked = vec![false; face.placed.surface().len()];
        faces.iter().for_each(|&place| marked[place] = true);
        let surface = body.placed.surface();
        let (corners, _) = corners_of(body, points.iter().map(|&place| &surface[place]));
        let mut node_of = vec![0; body.node_rows.len()];
        body.node_rows.iter().enumerate().for_each(|(node, &row)| node_of[row as usize] = node);
        let (mut ties, mut closest) = (Vec::new(), f64::INFINITY);
        for (i, &row) in corners.rows.iter().enumerate() {
            let around = &corners.corners[corners.starts[i] as usize..corners.starts[i + 1] as usize];
            let node = node_of[row as usize];
            let at = body.placed.mesh.points[node];
            let Some(found) = nearest(face, at, &|place| marked[place]) else { continue };
            closest = closest.min(found.distance);
            let place_of = |row: u32| body.placed.mesh.points[node_of[row as usize]];
            let [whole, area] = areas(&corners, around, place_of, normal_at(face, &found));
            // corners of faces with middles have none of their area
            if found.distance > reach || whole <= 0.0 {
                continue;
            }
            let strength = match (normal, shear) {
                (None, None) => Strength::Any,
                _ => {
                    let bound = |most: &Option<f64>| most.unwrap_or(f64::INFINITY);
                    Strength::Stress { area, normal: bound(normal), shear: bound(shear) }
                }
            };
            let id = body.placed.mesh.point_ids.of(node);
            ties.push(tied([of, other], vec![(row, 1.0)], face, &found, at, (strength, number, Some(id))));
        }
        if ties.is_empty() {
            diagnostics
                .error_at(path("bodies").as_str(), format!("nothing of `{a}` is near `{b}`: nothing is glued"))
                .note(format!("the nearest node is {closest:.3e} m off, and `reach` is {reach:.3e} m"));
        }
        ties.into_iter().for_each(|tie| self.push(of, tie));
    }
}

/// The cosine between the normals of faces from which on they are turned towards each other: 120°.
const TURNED: f64 = -0.5;

/// The normal of a body's face at a place of it.
fn normal_at(body: &BodyParts, at: &OnSurface) -> DVec3 {
    let [a, b, c] = at.corners.map(|node| body.placed.mesh.points[node as usize]);
    (b - a).cross(c - a).normalize_or_zero()
}

/// A node's share of the area (m²) of the faces `around` it, and of those among them that are turned towards what they
/// are glued to, whose normal is `outward`: at the edge of a surface the faces around the corner bear nothing of glue.
/// Where no face is so turned both are the same.
fn areas(corners: &FaceCorners, around: &[u32], place_of: impl Fn(u32) -> DVec3, outward: DVec3) -> [f64; 2] {
    let (mut whole, mut turned) = (0.0, 0.0);
    for &corner in around {
        let (number, corner) = (corner as usize / 4, corner as usize % 4);
        let [a, b, c, d] = corners.faces[number].map(&place_of);
        // the product of the diagonals; the last corner of a triangle is its third
        let normal = (c - a).cross(d - b);
        let area = corners.areas[number][corner];
        whole += area;
        if normal.normalize_or_zero().dot(outward) < TURNED {
            turned += area;
        }
    }
    [whole, if turned > 0.0 { turned } else { whole }]
}

fn picked_faces(
    assembly: &Assembly<'_>,
    body: &BodyParts,
    select: &Select,
    path: &str,
    diagnostics: &mut Diagnostics,
) -> Option<Vec<usize>> {
    let picked = assembly.pick(body, select, path, diagnostics)?;
    match picked.faces(&body.placed) {
        Ok(places) => Some(places),
        Err(problem) => {
            diagnostics.error_at(path, problem.message).notes(problem.notes);
            None
        }
    }
}

/// A point at a place (m) of which nodes have so much, tied to a place of a face.
fn tied(
    bodies: [usize; 2],
    nodes: Vec<(u32, f64)>,
    face: &BodyParts,
    found: &OnSurface,
    at: DVec3,
    (strength, number, node): (Strength, usize, Option<u64>),
) -> TiedPoint {
    let points = &face.placed.mesh.points;
    let corners = found.corners.map(|node| points[node as usize]);
    let off_it = at.distance(found.at) > TOUCHES * corners[0].distance(corners[1]);
    let carried = off_it.then(|| carried(face, found, at)).flatten();
    let (weights, behind) =
        carried.map_or((found.weights, None), |(weights, node, weight)| (weights, Some((node, weight))));
    let of_behind = behind.map_or(DVec3::ZERO, |(node, weight)| points[node as usize] * weight);
    let place = corners.iter().zip(weights).map(|(corner, weight)| *corner * weight).sum::<DVec3>() + of_behind;
    let gap = frame_of(corners).map_or(DVec3::ZERO, |axes| DVec3::from_array(axes.map(|axis| axis.dot(at - place))));
    let (block, row) = face.element_rows[found.element as usize];
    TiedPoint {
        bodies,
        nodes,
        corners: found.corners.map(|node| face.node_rows[node as usize]),
        weights,
        behind: behind.map(|(node, weight)| (face.node_rows[node as usize], weight)),
        element: (face.blocks[block as usize], row),
        gap,
        strength,
        place: 0,
        number,
        node,
    }
}

/// What a point may be off a face, in sides of it, that touches it.
const TOUCHES: f64 = 1e-9;

/// What the corners of a face have of a place (m) off it, and which node of the element behind has the rest: of all of
/// them that which is farthest from the face. None where the element has no thickness.
fn carried(face: &BodyParts, found: &OnSurface, at: DVec3) -> Option<([f64; 3], u32, f64)> {
    let mesh = &face.placed.mesh;
    let [a, b, c] = found.corners.map(|node| mesh.points[node as usize]);
    let out = (b - a).cross(c - a).normalize_or_zero();
    let depth = |node: u32| (mesh.points[node as usize] - a).dot(out).abs();
    let nodes = mesh.element(found.element as usize).iter().copied();
    let node = nodes.max_by(|one, other| depth(*one).total_cmp(&depth(*other)))?;
    let sides = DMat3::from_cols(b - a, c - a, mesh.points[node as usize] - a);
    let shares = sides.inverse() * (at - a);
    let weights = [1.0 - shares.x - shares.y - shares.z, shares.x, shares.y];
    (depth(node) > TOUCHES * a.distance(b) && shares.is_finite()).then_some((weights, node, shares.z))
}
