//! Which element a point lies in, and where in it: what fields are interpolated with.

use super::Mesh;
use super::topology::{Located, MOST_NODES};
use glam::DVec3;

/// How far outside of an element a point may lie and still count as inside, in element sizes: rounding.
const ROUNDING: f64 = 1e-9;

/// A point in an element.
#[derive(Clone, Copy, Debug, PartialEq)]
#[doc(hidden)]
pub struct Location {
    /// The element.
    pub element: usize,
    /// Values of the nodes' shape functions; 1 together. What the element has no node for is 0.
    pub weights: [f64; MOST_NODES],
    /// How far outside of the element the point lies, in element sizes; 0 inside.
    pub outside: f64,
}

/// Finds points in a mesh, by boxes of space with the elements that touch them.
#[doc(hidden)]
pub struct Locator<'a> {
    mesh: &'a Mesh,
    low: DVec3,
    /// Boxes along each axis.
    boxes: [usize; 3],
    /// Edges of a box (m).
    size: DVec3,
    /// `elements[starts[i]..starts[i + 1]]` touch box `i`.
    starts: Vec<u32>,
    elements: Vec<u32>,
}

impl<'a> Locator<'a> {
    /// For a mesh whose elements refer to its points.
    pub fn new(mesh: &'a Mesh) -> Self {
        let low = mesh.points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let high = mesh.points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
        let extent = (high - low).max(DVec3::splat(1e-300));
        // about one element a box
        let edge = (extent.element_product() / mesh.element_count().max(1) as f64).cbrt().max(1e-300);
        let boxes = extent.to_array().map(|length| ((length / edge).ceil() as usize).clamp(1, 512));
        let size = DVec3::from_array([0, 1, 2].map(|axis| extent[axis] / boxes[axis] as f64));
        let mut locator = Self { mesh, low, boxes, size, starts: Vec::new(), elements: Vec::new() };
        let mut touching = Vec::new();
        for element in 0..mesh.element_count() {
            let corners = mesh.element(element).iter().map(|&node| mesh.points[node as usize]);
            let (a, b) = corners.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), corner| {
                (low.min(corner), high.max(corner))
            });
            let margin = 1e-6 * (b - a);
            let (a, b) = (locator.cell(a - margin), locator.cell(b + margin));
            for z in a[2]..=b[2] {
                for y in a[1]..=b[1] {
                    touching.extend((a[0]..=b[0]).map(|x| (locator.number([x, y, z]), element as u32)));
                }
            }
        }
        touching.sort_unstable();
        locator.starts = vec![0; boxes.iter().product::<usize>() + 1];
        touching.iter().for_each(|(number, _)| locator.starts[*number as usize + 1] += 1);
        for number in 1..locator.starts.len() {
            locator.starts[number] += locator.starts[number - 1];
        }
        locator.elements = touching.into_iter().map(|(_, element)| element).collect();
        locator
    }

    fn cell(&self, x: DVec3) -> [usize; 3] {
        // a cast takes what is below 0 to 0
        [0, 1, 2].map(|axis| (((x[axis] - self.low[axis]) / self.size[axis]) as usize).min(self.boxes[axis] - 1))
    }

    fn number(&self, [x, y, z]: [usize; 3]) -> u32 {
        (x + self.boxes[0] * (y + self.boxes[1] * z)) as u32
    }

    /// Where a point lies (m). A point outside of the mesh is taken to the nearest place of the element that it is
    /// least outside of, among those near it; `None` when there is none within two boxes (about two elements).
    pub fn locate(&self, x: DVec3) -> Option<Location> {
        let at = self.cell(x);
        let mut best: Option<Location> = None;
        for reach in 0..=2 {
            let span = |axis: usize| at[axis].saturating_sub(reach)..=(at[axis] + reach).min(self.boxes[axis] - 1);
            for z in span(2) {
                for y in span(1) {
                    for x_box in span(0) {
                        let number = self.number([x_box, y, z]) as usize;
                        for &element in &self.elements[self.starts[number] as usize..self.starts[number + 1] as usize] {
                            let found = self.in_element(element as usize, x);
                            if best.as_ref().is_none_or(|best| found.outside < best.outside) {
                                best = Some(found);
                            }
                            if found.outside <= ROUNDING {
                                return Some(Location { outside: 0.0, ..found });
                            }
                        }
                    }
                }
            }
            if best.is_some_and(|best| best.outside < 0.1) {
                break;
            }
        }
        best.filter(|best| best.outside < 2.0)
    }

    /// An element that a point (m) lies in, if one does.
    pub fn holds(&self, x: DVec3) -> Option<usize> {
        self.holds_among(x, |_| true)
    }

    /// The same of some of the elements; the first of several.
    pub fn holds_among(&self, x: DVec3, counts: impl Fn(usize) -> bool) -> Option<usize> {
        if self.elements.is_empty() || !x.is_finite() {
            return None;
        }
        // elements stand in every box that they touch; a point beside the mesh is taken to the last box, and is in none
        let number = self.number(self.cell(x)) as usize;
        let near = &self.elements[self.starts[number] as usize..self.starts[number + 1] as usize];
        let mut near = near.iter().map(|&element| element as usize).filter(|&element| counts(element));
        near.find(|&element| self.in_element(element, x).outside <= ROUNDING)
    }

    fn in_element(&self, element: usize, x: DVec3) -> Location {
        let nowhere = Located { weights: [0.0; MOST_NODES], outside: f64::INFINITY };
        let solid = self.mesh.cells.kind(element).topology().solid;
        let Located { weights, outside } = solid.map_or(nowhere, |solid| (solid.locate)(&self.mesh.places(element), x));
        Location { element, weights, outside }
    }
}
