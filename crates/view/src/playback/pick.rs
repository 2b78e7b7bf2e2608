//! What a ray first meets of a finished run.

use glam::{DVec3, Vec3};
use sinew::Pick;
use sinew::driver::{Body, BodyState, Picked};
use sinew_pictures::render::Faces;

/// Barycentric coordinates may be so far below 0, so that no ray slips between two triangles.
const ROUNDING: f64 = 1e-9;

/// Where a ray first meets a body; nothing where it meets none, or is none.
pub fn pick(bodies: &[Body], states: &[BodyState], origin: DVec3, direction: DVec3) -> Option<Picked> {
    let direction = direction.try_normalize()?;
    let mut nearest: Option<Picked> = None;
    for (body, now) in bodies.iter().zip(states) {
        let there = |cell: u32| now.alive.get(cell as usize).filter(|alive| **alive != 0).map(|_| 0);
        for face in Faces::new(&body.cells).surface(there, None) {
            let [a, b, c, d] = face.points;
            let halves = [[a, b, c], [a, c, d]];
            for nodes in halves.into_iter().take(if c == d { 1 } else { 2 }) {
                let place = |node: u32| Vec3::from_array(now.positions[node as usize]).as_dvec3();
                let Some((distance, weights)) = meets(nodes.map(place), origin, direction) else { continue };
                if nearest.as_ref().is_some_and(|known| known.pick.distance <= distance) {
                    continue;
                }
                let heaviest = (0..3).max_by(|&a, &b| weights[a].total_cmp(&weights[b])).unwrap_or(0);
                let (node, element) = (nodes[heaviest], face.cell as usize);
                let [p, q, r] = nodes.map(place);
                let material =
                    body.element_materials.get(element).and_then(|place| body.materials.get(*place as usize));
                let pick = Pick {
                    body: body.name.clone(),
                    element: body.elements.of(element),
                    face: face.points,
                    nodes,
                    weights,
                    point: origin + direction * distance,
                    normal: (q - p).cross(r - p).normalize_or_zero(),
                    distance,
                };
                let node_number = body.nodes.of(node as usize);
                let material = material.cloned().unwrap_or_default();
                nearest = Some(Picked { node, node_number, element, material, step: None, pick });
            }
        }
    }
    nearest
}

/// How far away a ray meets a triangle (m), and the weights of its corners there.
fn meets([a, b, c]: [DVec3; 3], origin: DVec3, direction: DVec3) -> Option<(f64, [f64; 3])> {
    let (ab, ac) = (b - a, c - a);
    let across = direction.cross(ac);
    let volume = ab.dot(across);
    if volume == 0.0 || !volume.is_finite() {
        return None;
    }
    let from = origin - a;
    let along = from.cross(ab);
    let (v, w) = (from.dot(across) / volume, direction.dot(along) / volume);
    let (u, distance) = (1.0 - v - w, ac.dot(along) / volume);
    (u.min(v).min(w) >= -ROUNDING && distance >= 0.0).then_some((distance, [u, v, w]))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_ray_meets_a_triangle_within_it_only() {
        let triangle = [DVec3::ZERO, DVec3::X, DVec3::Y];
        let down = |x: f64, y: f64| meets(triangle, DVec3::new(x, y, 2.0), DVec3::NEG_Z);
        let (distance, weights) = down(0.25, 0.5).unwrap();
        assert!((distance - 2.0).abs() < 1e-12);
        assert!(weights.iter().zip([0.25, 0.25, 0.5]).all(|(found, wanted)| (found - wanted).abs() < 1e-12));
        assert!(down(0.6, 0.6).is_none() && down(f64::NAN, 0.1).is_none());
        assert!(meets(triangle, DVec3::new(0.2, 0.2, -1.0), DVec3::NEG_Z).is_none(), "it is behind");
    }
}
