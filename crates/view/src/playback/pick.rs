//! Whose a point is that was picked of a finished run.

use sinew::Pick;
use sinew::driver::{Body, Picked};

/// What there is at a point; nothing of a body or an element that the run has not.
pub fn about(bodies: &[Body], pick: Pick) -> Option<Picked> {
    let body = bodies.iter().find(|body| body.name == pick.body)?;
    let element = (0..body.cells.len()).find(|place| body.elements.of(*place) == pick.element)?;
    let heaviest = (0..3).max_by(|&a, &b| pick.weights[a].total_cmp(&pick.weights[b])).unwrap_or(0);
    let node = pick.nodes[heaviest];
    let node_number = body.rest.get(node as usize).map(|_| body.nodes.of(node as usize))?;
    let material = body.element_materials.get(element).and_then(|place| body.materials.get(*place as usize));
    let material = material.cloned().unwrap_or_default();
    Some(Picked { node, node_number, element, material, step: None, pick })
}
