//! What carries a point, and how it is found.

use crate::mesh::topology::{CellKind, MOST_NODES, Shape};
use crate::mesh::{Locator, Mesh};
use crate::tools::tree::Tree;
use glam::{DMat3, DVec3};

/// What carries a point: an element, the weights of its nodes, and what lies too far outside of it for weights.
#[derive(Clone, Debug, PartialEq)]
pub struct Carrier {
    /// The element.
    pub element: usize,
    /// Weights of its nodes, 1 together; below 0 and above 1 where the point lies outside.
    pub weights: [f64; MOST_NODES],
    /// The rest of the way to a point that lies farther outside than an element's size.
    far: Option<Box<Far>>,
}

/// The part of the way to a point that the rotation of its element carries.
#[derive(Clone, Debug, PartialEq)]
struct Far {
    /// At rest (m).
    offset: DVec3,
    /// Gradients of the shape functions by rest positions (1/m), at the place of the element that the way begins at.
    gradients: [DVec3; MOST_NODES],
}

/// How far outside weights go on, in sizes of the element.
const REACH: f64 = 1.0;

impl Carrier {
    /// Where the point is (m) when the nodes of its element are there.
    pub fn place(&self, nodes: &[DVec3]) -> DVec3 {
        let near = nodes.iter().zip(&self.weights).map(|(x, weight)| *weight * *x).sum::<DVec3>();
        self.far.as_ref().map_or(near, |far| near + far.turned(nodes))
    }

    /// How far the point lies from where weights end (m): a force on it has an arm that nodes do not feel.
    pub fn arm(&self, nodes: &[DVec3]) -> DVec3 {
        self.far.as_ref().map_or(DVec3::ZERO, |far| far.turned(nodes))
    }
}

impl Far {
    fn turned(&self, nodes: &[DVec3]) -> DVec3 {
        // from a node on: far from the origin places have digits that would be lost
        let origin = nodes.first().copied().unwrap_or_default();
        let outer = |(&x, g): (&DVec3, &DVec3)| {
            let way = x - origin;
            DMat3::from_cols(way * g.x, way * g.y, way * g.z)
        };
        let gradient = nodes.iter().zip(&self.gradients).map(outer).fold(DMat3::ZERO, |sum, more| sum + more);
        rotation(gradient) * self.offset
    }
}

/// The rotation of a deformation gradient, by Higham's iteration R ← (R + R⁻ᵀ)/2; none where it is inside out or flat.
fn rotation(gradient: DMat3) -> DMat3 {
    let determinant = gradient.determinant();
    if !(determinant > 0.0 && determinant.is_finite()) {
        return DMat3::IDENTITY;
    }
    let mut turn = gradient * determinant.cbrt().recip();
    for _ in 0..60 {
        let next = (turn + turn.inverse().transpose()) * 0.5;
        let change = (next - turn).to_cols_array().into_iter().fold(0.0, |most: f64, part| most.max(part.abs()));
        turn = next;
        if change < 1e-15 {
            break;
        }
    }
    if turn.is_finite() { turn } else { DMat3::IDENTITY }
}

/// Finds carriers among the elements of a mesh that live.
pub struct Carriers<'a> {
    mesh: &'a Mesh,
    lives: &'a dyn Fn(usize) -> bool,
    locator: Locator<'a>,
    /// The exposed faces as triangles, and the element of each.
    tree: Tree,
    elements: Vec<u32>,
}

impl<'a> Carriers<'a> {
    /// Among the elements of a mesh that live.
    pub fn new(mesh: &'a Mesh, lives: &'a dyn Fn(usize) -> bool) -> Self {
        let faces = mesh.exposed(lives);
        let triangles: Vec<([u32; 3], u32)> =
            faces.iter().flat_map(|face| face.triangles().map(|triangle| (triangle, face.element))).collect();
        let corners = |number: u32| triangles[number as usize].0.map(|point| mesh.points[point as usize]);
        let tree = Tree::new(corners, (0..triangles.len() as u32).collect());
        let elements = triangles.iter().map(|(_, element)| *element).collect();
        Self { mesh, lives, locator: Locator::new(mesh), tree, elements }
    }

    /// What carries a point (m): the element that holds it, the first of several, else the one with the nearest place,
    /// by the distance to its faces, of which quadrilaterals count as two triangles. None where no element lives.
    pub fn carrier(&self, x: DVec3) -> Option<Carrier> {
        if let Some(element) = self.locator.holds_among(x, self.lives) {
            return Some(self.carried(element, x, x));
        }
        let nearest = self.tree.nearest(x, None, f64::INFINITY)?;
        let element = *self.elements.get(self.tree.number(nearest))?;
        Some(self.carried(element as usize, nearest.at, x))
    }

    /// How an element carries a point, from a place in it or on its surface on.
    fn carried(&self, element: usize, from: DVec3, x: DVec3) -> Carrier {
        let places = self.mesh.places(element);
        let kind = self.mesh.cells.kind(element);
        let topology = kind.topology();
        let count = topology.nodes.len();
        let mut natural = DVec3::ZERO;
        let located = topology.solid.map(|solid| (solid.locate)(&places, from));
        match located.filter(|located| located.outside.is_finite()) {
            // the shape functions reproduce their own coordinates
            Some(found) => {
                let nodes = topology.nodes.iter().zip(&found.weights);
                natural = nodes.map(|(node, weight)| *weight * DVec3::from_array(*node)).sum();
            }
            None => natural += topology.nodes.iter().map(|node| DVec3::from_array(*node)).sum::<DVec3>() / count as f64,
        }
        let shape = topology.solid.map_or_else(Shape::default, |solid| (solid.shape)(natural.to_array()));
        let origin = places.first().copied().unwrap_or_default();
        let at: DVec3 = places.iter().zip(&shape.values).map(|(&place, &value)| value * (place - origin)).sum();
        let inverse = shape.jacobian(&places).inverse();
        let mut carrier = Carrier { element, weights: shape.values, far: None };
        if !inverse.is_finite() {
            return carrier;
        }
        let way = (x - origin) - at;
        let sizes = (inverse * way / extent(kind)).abs().max_element();
        let share = if sizes > REACH { REACH / sizes } else { 1.0 };
        let mut gradients = [DVec3::ZERO; MOST_NODES];
        for (gradient, natural) in gradients.iter_mut().zip(shape.gradients).take(count) {
            *gradient = inverse.transpose() * natural;
        }
        for (weight, gradient) in carrier.weights.iter_mut().zip(&gradients) {
            *weight += gradient.dot(way * share);
        }
        if share < 1.0 {
            carrier.far = Some(Box::new(Far { offset: way * (1.0 - share), gradients }));
        }
        carrier
    }
}

/// How far a reference cell reaches along each of its coordinates.
fn extent(kind: CellKind) -> DVec3 {
    let nodes = kind.topology().nodes.iter().map(|node| DVec3::from_array(*node));
    let [low, high] = nodes.fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[a, b], node| [a.min(node), b.max(node)]);
    high - low
}
