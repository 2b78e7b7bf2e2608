//! What a mesh is, in short: where it lies, what it consists of, its named sets, how good its elements are, and what
//! its unit of length could be.

use super::{CellKind, Mesh, quality::Quality};
use glam::DVec3;
use serde::{Serialize, Serializer};
use std::collections::BTreeSet;

/// Lengths of bodies of tissue (m): from an embryo's organ to a whole leg.
const TISSUE: std::ops::RangeInclusive<f64> = 2e-3..=1.5;
/// Units of length that meshes come in, and what they are in metres.
const UNITS: [(&str, f64); 4] = [("m", 1.0), ("mm", 1e-3), ("cm", 1e-2), ("µm", 1e-6)];

/// A mesh in short. Lengths are in the mesh's own unit, metres for the engine.
#[derive(Clone, Debug, Serialize)]
#[doc(hidden)]
pub struct MeshReport {
    /// Nodes.
    pub nodes: usize,
    /// Elements of each kind, by what many of them are called.
    #[serde(flatten, serialize_with = "as_map")]
    pub elements: Vec<(&'static str, usize)>,
    /// The lowest coordinates (m).
    pub min: DVec3,
    /// The largest coordinates (m).
    pub max: DVec3,
    /// Volume (m³).
    pub volume: f64,
    /// Nodes of the surface.
    pub surface_nodes: usize,
    /// Faces of the surface.
    pub surface_faces: usize,
    /// Named sets, by name.
    pub sets: Vec<SetReport>,
    /// Fields of elements.
    pub fields: Vec<String>,
    /// The quality of elements.
    pub quality: Quality,
    /// The ten worst elements by the author's numbers, with their quality and their centroid (m).
    pub worst: Vec<(u64, f64, DVec3)>,
    /// Units that the lengths could be in, with the factor to metres, the likeliest first.
    pub units: Vec<(String, f64)>,
}

/// A named set in short.
#[derive(Clone, Debug, Serialize)]
#[doc(hidden)]
pub struct SetReport {
    /// Its name.
    pub name: String,
    /// `nodes`, `faces` or `elements`.
    pub of: &'static str,
    /// How many.
    pub count: usize,
    /// The lowest coordinates of its nodes (m).
    pub min: DVec3,
    /// The largest coordinates of its nodes (m).
    pub max: DVec3,
}

impl Mesh {
    /// The mesh in short.
    #[doc(hidden)]
    pub fn summary(&self) -> MeshReport {
        let (min, max) = extent(self.points.iter().copied());
        let surface = self.surface();
        let surface_nodes: BTreeSet<u32> = surface.iter().flat_map(|face| face.all_nodes()).collect();
        let quality = self.quality();
        let centroid = |row: usize| {
            let nodes = self.element(row);
            nodes.iter().map(|&node| self.points[node as usize]).sum::<DVec3>() / nodes.len() as f64
        };
        let worst = quality.worst.iter().map(|&(row, quality)| (self.element_ids.of(row), quality, centroid(row)));
        MeshReport {
            nodes: self.points.len(),
            elements: CellKind::solids().map(|(kind, _)| (kind.topology().plural, self.cells.count(kind))).collect(),
            min,
            max,
            volume: self.volume(),
            surface_nodes: surface_nodes.len(),
            surface_faces: surface.len(),
            sets: self.set_reports(),
            fields: self.element_vectors.keys().cloned().collect(),
            worst: worst.collect(),
            quality,
            units: units((max - min).max_element()),
        }
    }

    fn set_reports(&self) -> Vec<SetReport> {
        let report = |name: &String, of: &'static str, count: usize, nodes: &mut dyn Iterator<Item = u32>| {
            let (min, max) = extent(nodes.map(|node| self.points[node as usize]));
            SetReport { name: name.clone(), of, count, min, max }
        };
        let of_nodes =
            self.node_sets.iter().map(|(name, rows)| report(name, "nodes", rows.len(), &mut rows.iter().copied()));
        let of_faces = self
            .face_sets
            .iter()
            .map(|(name, faces)| report(name, "faces", faces.len(), &mut faces.iter().flatten().copied()));
        let of_elements = self.element_sets.iter().map(|(name, rows)| {
            report(name, "elements", rows.len(), &mut rows.iter().flat_map(|&row| self.element(row as usize)).copied())
        });
        let mut all: Vec<SetReport> = of_nodes.chain(of_faces).chain(of_elements).collect();
        all.sort_by(|a, b| a.name.cmp(&b.name).then(a.of.cmp(b.of)));
        all
    }
}

fn as_map<S: Serializer>(elements: &[(&'static str, usize)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(elements.iter().copied())
}

/// The box around some points; infinite where there are none.
#[doc(hidden)]
pub fn extent(points: impl Iterator<Item = DVec3>) -> (DVec3, DVec3) {
    points.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(min, max), point| (min.min(point), max.max(point)))
}

/// Units in which so long a body is tissue: the likeliest is that in which it is nearest to a tenth of a metre.
fn units(length: f64) -> Vec<(String, f64)> {
    let mut all: Vec<(&str, f64)> =
        UNITS.into_iter().filter(|(_, factor)| TISSUE.contains(&(length * factor))).collect();
    let distance = |factor: f64| (length * factor / 0.1).ln().abs();
    all.sort_by(|a, b| distance(a.1).total_cmp(&distance(b.1)));
    // what needs no factor is believed before all others
    all.sort_by_key(|(_, factor)| *factor != 1.0);
    all.into_iter().map(|(name, factor)| (name.to_string(), factor)).collect()
}

#[cfg(test)]
mod tests;
