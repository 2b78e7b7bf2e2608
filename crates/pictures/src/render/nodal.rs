//! Values of elements averaged at nodes: over the elements of one material around a node, weighted by their volume at
//! rest.

use super::RenderError;
use super::frame::{FieldAssociation, FrameFile};
use glam::Vec3;
use sinew::mesh::topology::{Face, MOST_NODES};
use sinew::mesh::{CellKind, Cells};
use std::collections::HashMap;

/// Averages of one frame.
pub struct Averages {
    /// Of each cell.
    material: Vec<u32>,
    /// Of each node: the material of the first cell there, and sums over the cells of that.
    first: Vec<(u32, Sum)>,
    /// Sums of other materials, by node and material.
    others: HashMap<(u32, u32), Sum>,
}

/// Weighted values, and weights.
#[derive(Clone, Copy, Default)]
struct Sum {
    value: f64,
    weight: f64,
}

const NONE: u32 = u32::MAX;

impl Averages {
    /// Averages the values of those cells of a frame that are there.
    pub fn new(
        frame: &FrameFile,
        rest: &[Vec3],
        cells: &Cells,
        values: &[f32],
        there: impl Fn(usize) -> bool,
    ) -> Result<Averages, RenderError> {
        let material = match frame.entry(FieldAssociation::Cells, "material").filter(|entry| entry.components == 1) {
            Some(entry) => frame.floats(entry)?.into_iter().map(|number| number as u32).collect(),
            None => vec![0; values.len()],
        };
        Ok(Self::of(material, rest, cells, values, there))
    }

    /// Averages the values of those cells that are there; `material`: that of each cell, by number.
    pub fn of(
        material: Vec<u32>,
        rest: &[Vec3],
        cells: &Cells,
        values: &[f32],
        there: impl Fn(usize) -> bool,
    ) -> Averages {
        let mut averages =
            Averages { material, first: vec![(NONE, Sum::default()); rest.len()], others: HashMap::new() };
        for (cell, value) in values.iter().enumerate().filter(|(cell, _)| there(*cell)) {
            let corners = cells.nodes(cell);
            let weight = f64::from(volume(cells.kind(cell), corners, rest).max(f32::MIN_POSITIVE));
            for node in corners {
                averages.add(*node, averages.material[cell], Sum { value: weight * f64::from(*value), weight });
            }
        }
        averages
    }

    fn add(&mut self, node: u32, material: u32, more: Sum) {
        let first = &mut self.first[node as usize];
        if first.0 == NONE {
            first.0 = material;
        }
        let sum = if first.0 == material { &mut first.1 } else { self.others.entry((node, material)).or_default() };
        sum.value += more.value;
        sum.weight += more.weight;
    }

    /// At a corner of a cell.
    pub fn at(&self, cell: usize, node: u32) -> f32 {
        let (material, first) = (self.material[cell], self.first[node as usize]);
        let sum = if first.0 == material { Some(first.1) } else { self.others.get(&(node, material)).copied() };
        sum.map_or(f32::NAN, |sum| (sum.value / sum.weight) as f32)
    }
}

/// The volume of a cell (m³), as pyramids over its faces.
fn volume(kind: CellKind, corners: &[u32], points: &[Vec3]) -> f32 {
    let point = |row: usize| points[corners[row] as usize];
    if kind == CellKind::Tet4 {
        return (point(1) - point(0)).cross(point(2) - point(0)).dot(point(3) - point(0)).abs() / 6.0;
    }
    let middle = (0..corners.len()).map(point).sum::<Vec3>() / corners.len() as f32;
    let rows: [usize; MOST_NODES] = std::array::from_fn(|row| row);
    let pyramid = |face: &Face| {
        let [a, b, c, d] = face.corners(&rows).map(|corner| point(corner) - middle);
        (c - a).cross(d - b).dot(a + b + c + d) / 24.0
    };
    kind.topology().faces.iter().map(pyramid).sum::<f32>().abs()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
    use super::*;

    #[test]
    fn volumes_are_those_of_the_shape() {
        let points = [(0, 0, 0), (2, 0, 0), (2, 3, 0), (0, 3, 0), (0, 0, 4), (2, 0, 4), (2, 3, 4), (0, 3, 4)];
        let points = points.map(|(x, y, z)| Vec3::new(x as f32, y as f32, z as f32));
        assert!((volume(CellKind::Hex8, &[0, 1, 2, 3, 4, 5, 6, 7], &points) - 24.0).abs() < 1e-4);
        assert!((volume(CellKind::Tet4, &[0, 1, 3, 4], &points) - 4.0).abs() < 1e-5);
    }

    #[test]
    fn large_cells_count_for_more_and_materials_stay_apart() {
        let mut averages =
            Averages { material: vec![0, 0, 1], first: vec![(NONE, Sum::default())], others: HashMap::new() };
        for (material, value, weight) in [(0, 1.0, 3.0), (0, 5.0, 1.0), (1, 7.0, 2.0)] {
            averages.add(0, material, Sum { value: value * weight, weight });
        }
        assert_eq!([0, 1, 2].map(|cell| averages.at(cell, 0)), [2.0, 2.0, 7.0]);
    }
}
