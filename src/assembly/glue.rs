//! Ties and glue: points and nodes become weights on faces.

mod joints;
mod rest_shapes;

use super::anchors::{OnSurface, TOUCHES, anchor, begin_elsewhere, nearest};
use super::contacts::{bounds, edge, reference};
use super::loads::corners_of;
use super::sutures::at_start;
use super::{Assembly, BodyParts};
use crate::components::*;
use crate::scene::diagnostic::Diagnostics;
use crate::scene::schema::{Attachment, Point, Select};
use bevy_ecs::prelude::*;
use glam::{DMat3, DVec3};
use joints::Joints;
use std::borrow::Cow;
use std::collections::BTreeMap;

/// What counts where bodies begin elsewhere than where their meshes have them.
const AT_START: &str = "it counts where bodies are at the start, which their `start` or `rest_shape` tells";

/// What is made of the attachments so far.
struct Gluing<'a> {
    assembly: &'a Assembly<'a>,
    world: &'a World,
    /// Whether bodies begin elsewhere than where their meshes have them.
    elsewhere: bool,
    /// Where the nodes of each body are at the start (m).
    points: &'a [Cow<'a, [DVec3]>],
    glue: Glue,
    /// How many ties there are of each body's points.
    counts: BTreeMap<usize, usize>,
}

/// A body at the start.
#[derive(Clone, Copy)]
struct Placed<'a> {
    /// Its place in [`Glue::bodies`].
    place: usize,
    name: &'a String,
    body: &'a BodyParts,
    /// Where its nodes are (m), in the author's order.
    points: &'a [DVec3],
}

/// Spawns all ties, single ones and those of surfaces that are glued, as meshes have bodies. What begins elsewhere is
/// not there yet: it waits for [`spawn_elsewhere`].
pub(super) fn spawn(assembly: &Assembly<'_>, world: &mut World, diagnostics: &mut Diagnostics) {
    if !begin_elsewhere(assembly) {
        spawn_ties(assembly, false, world, diagnostics);
    }
}

/// The same where bodies begin elsewhere, as they are by now.
pub(super) fn spawn_elsewhere(assembly: &Assembly<'_>, world: &mut World, diagnostics: &mut Diagnostics) {
    if begin_elsewhere(assembly) {
        spawn_ties(assembly, true, world, diagnostics);
    }
}

/// Where the nodes of a body are (m): in its mesh, or as they are by now.
pub(super) fn points_of<'a>(body: &'a BodyParts, by_now: bool, world: &World) -> Cow<'a, [DVec3]> {
    let rest = &body.placed.mesh.points;
    match world.get::<Displacement>(body.entity).filter(|_| by_now) {
        Some(u) => rest.iter().zip(&body.node_rows).map(|(at, &row)| *at + u.vector(row as usize)).collect(),
        None => Cow::Borrowed(body.placed.points()),
    }
}

fn spawn_ties(assembly: &Assembly<'_>, elsewhere: bool, world: &mut World, diagnostics: &mut Diagnostics) {
    let points: Vec<Cow<'_, [DVec3]>> =
        assembly.bodies.values().map(|body| points_of(body, elsewhere, world)).collect();
    let bodies = assembly.bodies.values().map(|body| body.entity).collect();
    let corners: Vec<DVec3> =
        assembly.bodies.values().flat_map(|body| <[DVec3; 2]>::from(bounds(&body.placed.mesh.points))).collect();
    let glue = Glue { bodies, sweeps: 1, reference: reference(&corners), ..Glue::default() };
    let mut gluing = Gluing { assembly, world, elsewhere, points: &points, glue, counts: BTreeMap::new() };
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
    let Gluing { glue, counts, .. } = gluing;
    if glue.ties.is_empty() {
        return;
    }
    between_led_nodes(&glue, world, diagnostics);
    if !elsewhere {
        rest_shapes::check(assembly, &glue, world, diagnostics);
    }
    for (body, count) in counts {
        let state = TieState(Reals::zeros(assembly.precision, TIE_NUMBERS * count));
        world.entity_mut(glue.bodies[body]).insert(state);
    }
    world.insert_resource(glue);
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

impl<'a> Gluing<'a> {
    /// A body by its name, or the only one.
    fn body(&self, name: Option<&String>) -> Option<Placed<'a>> {
        let mut all = self.assembly.bodies.iter().zip(self.points).enumerate();
        let (place, ((name, body), points)) = all.find(|(_, ((of, _), _))| name.is_none_or(|name| name == *of))?;
        Some(Placed { place, name, body, points })
    }

    /// Where something is at the start that is at a place in the mesh (m).
    fn begins(&self, anchor: &Anchor, at: DVec3) -> DVec3 {
        if self.elsewhere { at_start(anchor, DVec3::ZERO, self.world) } else { at }
    }

    fn push(&mut self, point: usize, tie: TiedPoint) {
        let count = self.counts.entry(point).or_default();
        self.glue.ties.push(TiedPoint { place: *count, ..tie });
        *count += 1;
    }

    /// Ties a point to the nearest face of another.
    fn tie(&mut self, number: usize, [from, to]: [&Point; 2], strength: Strength, diagnostics: &mut Diagnostics) {
        let (Some(of), Some(onto)) = (self.body(from.body.as_ref()), self.body(to.body.as_ref())) else { return };
        let path = |field: &str| format!("attachments[{number}].{field}.at");
        let first = anchor(of.name, of.body, from.at, &path("from"), diagnostics);
        let second = anchor(onto.name, onto.body, to.at, &path("to"), diagnostics);
        let (Some((point, at)), Some((goal, place))) = (first, second) else { return };
        let (at, place) = (self.begins(&point, at), self.begins(&goal, place));
        let Some(found) = onto.nearest(place, |_| true) else { return };
        let (apart, most) = (at.distance(found.at), edge(of.body).max(edge(onto.body)));
        if apart > most {
            let message = format!("what is to be tied is {apart:.3e} m apart");
            diagnostics
                .error_at(path("to").as_str(), message)
                .note(format!(
                    "a tie holds what touches, or nearly: up to an edge of a face, {most:.3e} m; a `Suture` pulls"
                ))
                .notes(self.elsewhere.then(|| AT_START.to_string()));
            return;
        }
        let tie = tied([of, onto], point.nodes, &found, at, (strength, number, None));
        if of.place == onto.place && (at.distance(place) <= 1e-9 * most || bears_nothing(&tie)) {
            diagnostics.error_at(path("to").as_str(), "both points of the tie are one place");
            return;
        }
        self.push(of.place, tie);
    }

    /// Ties the nodes of one surface that are near another one.
    fn surface(&mut self, number: usize, attachment: &Attachment, diagnostics: &mut Diagnostics) {
        let Attachment::Glue { bodies: (a, b), on, onto, reach, normal, shear, .. } = attachment else { return };
        let path = |field: &str| format!("attachments[{number}].{field}");
        let (Some(one), Some(other)) = (self.body(Some(a)), self.body(Some(b))) else { return };
        for Placed { name, body, .. } in [one, other] {
            if body.copies > 1 {
                let message = format!("`{name}` has {} copies: which of them?", body.copies);
                diagnostics
                    .error_at(path("bodies").as_str(), message)
                    .note("only a body without `copies` can be sutured, tied or glued");
                return;
            }
        }
        let (Some(points), Some(faces)) = (
            picked_faces(self.assembly, one.body, on, &path("on"), diagnostics),
            picked_faces(self.assembly, other.body, onto, &path("onto"), diagnostics),
        ) else {
            return;
        };
        let reach = reach.unwrap_or(0.1 * edge(one.body).min(edge(other.body)));
        let mut marked = vec![false; other.body.placed.surface().len()];
        faces.iter().for_each(|&place| marked[place] = true);
        let joints = (one.place == other.place).then(|| Joints::of(other));
        let body = one.body;
        let surface = body.placed.surface();
        let (corners, _) = corners_of(body, points.iter().map(|&place| &surface[place]));
        let mut node_of = vec![0; body.node_rows.len()];
        body.node_rows.iter().enumerate().for_each(|(node, &row)| node_of[row as usize] = node);
        let (mut ties, mut closest) = (Vec::new(), f64::INFINITY);
        for (i, &row) in corners.rows.iter().enumerate() {
            let around = &corners.corners[corners.starts[i] as usize..corners.starts[i + 1] as usize];
            let node = node_of[row as usize];
            let at = one.points[node];
            let own = joints.as_ref().map(|joints| joints.around(node as u32, reach)).unwrap_or_default();
            let Some(found) = other.nearest(at, |place| marked[place] && !own.contains(&place)) else { continue };
            closest = closest.min(found.distance);
            let place_of = |row: u32| one.points[node_of[row as usize]];
            let Some(area) = area_of(&corners, around, place_of, other.normal(&found)) else { continue };
            if found.distance > reach {
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
            ties.push(tied([one, other], vec![(row, 1.0)], &found, at, (strength, number, Some(id))));
        }
        if ties.is_empty() {
            let message = format!("nothing of `{a}` is near `{b}`: nothing is glued");
            let told = diagnostics.error_at(path("bodies").as_str(), message);
            if closest.is_finite() {
                told.note(format!("the nearest node is {closest:.3e} m off, and `reach` is {reach:.3e} m"));
            }
            if self.elsewhere {
                told.note(AT_START);
            }
            if joints.is_some() {
                told.note(format!(
                    "faces of `{a}` do not count that are joined to a node along the surface within {reach:.3e} m of it"
                ));
            }
        }
        ties.into_iter().for_each(|tie| self.push(one.place, tie));
    }
}

/// The cosine between the normals of faces from which on they are turned towards each other: 120°.
const TURNED: f64 = -0.5;

impl Placed<'_> {
    /// The place of its surface nearest to a point (m), among faces that count.
    fn nearest(&self, at: DVec3, counts: impl Fn(usize) -> bool) -> Option<OnSurface> {
        nearest((self.body, self.points), at, &counts)
    }

    /// The normal of its face at a place of it.
    fn normal(&self, at: &OnSurface) -> DVec3 {
        let [a, b, c] = at.corners.map(|node| self.points[node as usize]);
        (b - a).cross(c - a).normalize_or_zero()
    }
}

/// Whether all that a tie of a body to itself does to a node it undoes again.
fn bears_nothing(tie: &TiedPoint) -> bool {
    let mut shares: BTreeMap<u32, f64> = tie.nodes.iter().copied().collect();
    tie.bearers().for_each(|(row, weight)| *shares.entry(row).or_default() -= weight);
    shares.values().all(|share| share.abs() <= TOUCHES)
}

/// What parts of faces come to at a corner, as a share of their sizes, that cancel but for rounding and for how curved
/// the faces are.
const CANCELS: f64 = 0.05;

/// A node's share of the area (m²) of the faces `around` it that are turned towards what they are glued to, whose
/// normal is `outward`: at the edge of a surface the faces around the corner bear nothing of glue. Where no face is so
/// turned it is that of all. None at corners of faces with middles: those have all of the area.
fn area_of(corners: &FaceCorners, around: &[u32], place_of: impl Fn(u32) -> DVec3, outward: DVec3) -> Option<f64> {
    let (mut all, mut turned) = ([0.0; 2], [0.0; 2]);
    for &corner in around {
        let (number, corner) = (corner as usize / 4, corner as usize % 4);
        let [a, b, c, d] = corners.faces[number].map(&place_of);
        // the product of the diagonals; the last corner of a triangle is its third
        let normal = (c - a).cross(d - b);
        let area: f64 = corners.areas[number][corner];
        let add = |[sum, size]: [f64; 2]| [sum + area, size + area.abs()];
        all = add(all);
        if normal.normalize_or_zero().dot(outward) < TURNED {
            turned = add(turned);
        }
    }
    let [sum, size] = if turned[1] > 0.0 { turned } else { all };
    (sum > CANCELS * size).then_some(sum)
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

/// A point at a place (m) of the first body, of which nodes have so much, tied to a place of a face of the second.
fn tied(
    [of, onto]: [Placed<'_>; 2],
    nodes: Vec<(u32, f64)>,
    found: &OnSurface,
    at: DVec3,
    (strength, number, node): (Strength, usize, Option<u64>),
) -> TiedPoint {
    let Placed { body: face, points, .. } = onto;
    let corners = found.corners.map(|node| points[node as usize]);
    let off_it = at.distance(found.at) > TOUCHES * corners[0].distance(corners[1]);
    let carried = off_it.then(|| carried(onto, found, at)).flatten();
    let (weights, behind) =
        carried.map_or((found.weights, None), |(weights, node, weight)| (weights, Some((node, weight))));
    let of_behind = behind.map_or(DVec3::ZERO, |(node, weight)| points[node as usize] * weight);
    let place = corners.iter().zip(weights).map(|(corner, weight)| *corner * weight).sum::<DVec3>() + of_behind;
    let gap = frame_of(corners).map_or(DVec3::ZERO, |axes| DVec3::from_array(axes.map(|axis| axis.dot(at - place))));
    let (block, row) = face.element_rows[found.element as usize];
    TiedPoint {
        bodies: [of.place, onto.place],
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

/// What the corners of a face have of a place (m) off it, and which node of the element behind has the rest: of all of
/// them that which is farthest from the face, the first of several. None where the element has no thickness.
fn carried(face: Placed<'_>, found: &OnSurface, at: DVec3) -> Option<([f64; 3], u32, f64)> {
    let Placed { body, points, .. } = face;
    let [a, b, c] = found.corners.map(|node| points[node as usize]);
    let out = (b - a).cross(c - a).normalize_or_zero();
    let depth = |node: u32| (points[node as usize] - a).dot(out).abs();
    let (nodes, same) = (body.placed.mesh.element(found.element as usize), TOUCHES * a.distance(b));
    let deepest = nodes.iter().map(|&node| depth(node)).fold(0.0, f64::max);
    // however the body is turned
    let node = nodes.iter().copied().find(|&node| depth(node) + same >= deepest)?;
    let sides = DMat3::from_cols(b - a, c - a, points[node as usize] - a);
    let shares = sides.inverse() * (at - a);
    let weights = [1.0 - shares.x - shares.y - shares.z, shares.x, shares.y];
    (deepest > same && shares.is_finite()).then_some((weights, node, shares.z))
}
