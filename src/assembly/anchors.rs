//! Points of bodies that something is attached to.

use super::contacts::edge;
use super::{Assembly, BodyParts};
use crate::components::Anchor;
use crate::math::coordinates;
use crate::mesh::{Locator, Mesh, OnTriangle};
use crate::scene::diagnostic::Diagnostics;
use crate::scene::schema::InitialState;
use crate::skins::Embedding;
use glam::DVec3;

/// The place of a surface that is nearest to a point.
pub(super) struct OnSurface {
    /// Nodes of its triangle, in the author's order, and what each has of it.
    pub corners: [u32; 3],
    pub weights: [f64; 3],
    /// The author's element behind it.
    pub element: u32,
    /// Where it is (m), and how far from the point.
    pub at: DVec3,
    pub distance: f64,
}

/// What a point may be off a face, in sides of it, that touches it.
pub(super) const TOUCHES: f64 = 1e-9;

/// The place of a body's surface nearest to a point (m), with its nodes where they are told to be (m), among faces that
/// count.
pub(super) fn nearest(
    (body, points): (&BodyParts, &[DVec3]),
    at: DVec3,
    counts: &dyn Fn(usize) -> bool,
) -> Option<OnSurface> {
    let mut best: Option<OnSurface> = None;
    for (_, face) in body.placed.surface().iter().enumerate().filter(|(place, _)| counts(*place)) {
        for corners in face.triangles() {
            let places = corners.map(|node| points[node as usize]);
            let (found, same) = (OnTriangle::nearest(at, places), TOUCHES * places[0].distance(places[1]));
            let distance = at.distance(found.at);
            // of equally near ones the first, however the body is turned
            if found.at.is_finite() && best.as_ref().is_none_or(|best| distance + same < best.distance) {
                let (weights, element) = (found.weights, face.element);
                best = Some(OnSurface { corners, weights, element, at: found.at, distance });
            }
        }
    }
    best
}

/// Whether some body begins elsewhere than where its mesh has it: deformed by a `start` of its own, or in a rest shape
/// that is another one, without rest being sought first.
pub(super) fn begin_elsewhere(assembly: &Assembly<'_>) -> bool {
    let scene = &assembly.scene.scene;
    let deformed = scene.bodies.values().any(|body| body.start.is_some());
    let at_rest = || assembly.bodies.values().any(|body| body.placed.is_shown_elsewhere());
    !scene.is_static() && (deformed || scene.start == InitialState::Undeformed && at_rest())
}

/// What a point of the scene is of a body where its mesh has it: itself where the body is, else the nearest place of
/// its surface, no farther than an edge of a face. It goes with the body as material, so also to its rest shape where
/// that is another one. Gives where it is in the mesh, too (m).
pub(super) fn anchor(
    name: &str,
    body: &BodyParts,
    at: DVec3,
    path: &str,
    diagnostics: &mut Diagnostics,
) -> Option<(Anchor, DVec3)> {
    if body.copies > 1 {
        diagnostics
            .error_at(path, format!("`{name}` has {} copies: which of them?", body.copies))
            .note("only a body without `copies` can be sutured, tied or glued");
        return None;
    }
    let shown = body.placed.as_shown();
    let mesh: &Mesh = &shown;
    let mut place = at;
    if Locator::new(mesh).holds(at).is_none() {
        let found = nearest((body, &mesh.points), at, &|_| true)?;
        let edge = edge(body);
        if found.distance > edge {
            diagnostics
                .error_at(
                    path,
                    format!("nothing of `{name}` is there: the nearest place is {:.3e} m off", found.distance),
                )
                .note(format!(
                    "it is at ({}); up to an edge of a face, {edge:.3e} m, may lie between",
                    coordinates(found.at, edge)
                ));
            return None;
        }
        place = found.at;
    }
    let embedding = Embedding::new(mesh, &[place], &|_| true);
    let carrier = embedding.carriers().first()?.as_ref()?;
    let nodes = mesh.element(carrier.element).iter().zip(carrier.weights);
    let nodes = nodes.map(|(&node, weight)| (body.node_rows[node as usize], weight));
    let (block, row) = body.element_rows[carrier.element];
    let nodes: Vec<(u32, f64)> = nodes.filter(|(_, weight)| *weight != 0.0).collect();
    Some((Anchor { body: body.entity, nodes, element: (body.blocks[block as usize], row) }, place))
}
