//! Elements: rows in range, each point once, positive volume, not too thin.

use super::{Defect, FLAT, LISTED, Soundness, counted};
use crate::Mesh;
use crate::measure::longest_edge;
use crate::topology::MOST_NODES;

/// An element whose smallest altitude is below this share of its longest edge is warned of.
const SLIVER: f64 = 0.01;

/// What elements measure, and the text for each kind of finding.
#[derive(Default)]
struct ElementDefects {
    out_of_range: Vec<(usize, String)>,
    repeated: Vec<(usize, String)>,
    flat: Vec<(usize, String)>,
    inverted: Vec<(usize, String)>,
    slivers: Vec<(usize, f64)>,
}

impl Mesh {
    pub(super) fn check_elements(&self, found: &mut Soundness) {
        let mut all = ElementDefects::default();
        for row in 0..self.element_count() {
            if self.check_rows(row, &mut all) {
                self.check_shape(row, &mut all);
            }
        }
        let out_of_range = format!("; points have the rows 0 to {}", self.points.len().saturating_sub(1));
        let text = ("element names a point that is not there", "elements name points that are not there");
        self.report(found, Defect::OutOfRange, all.out_of_range, text, &out_of_range);
        let text = ("element names a point twice", "elements name a point twice");
        self.report(found, Defect::RepeatedNode, all.repeated, text, "; each of its points must be a different one");
        let advice = "; remove it, or move its points apart";
        self.report(found, Defect::Flat, all.flat, ("element without volume", "elements without volume"), advice);
        let advice =
            "; list their nodes in the other order, or set flip_inverted: true (a folded one needs its corners moved)";
        self.report(found, Defect::Inverted, all.inverted, ("inverted element", "inverted elements"), advice);
        self.check_repeated_elements(found);
        self.warn_of_slivers(found, all.slivers);
    }

    fn report(
        &self,
        found: &mut Soundness,
        defect: Defect,
        rows: Vec<(usize, String)>,
        (one, many): (&str, &str),
        advice: &str,
    ) {
        if rows.is_empty() {
            return;
        }
        let names = rows.iter().map(|(row, detail)| format!("{} ({detail})", self.element_name(*row)));
        let text = counted(rows.len(), one, many, names) + advice;
        found.error(defect, rows.iter().map(|&(row, _)| self.element_name(row)).collect(), text);
    }

    /// Whether an element's points are there, different and finite, so that its shape can be measured.
    fn check_rows(&self, row: usize, all: &mut ElementDefects) -> bool {
        let nodes = self.element(row);
        if let Some(node) = nodes.iter().find(|&&node| node as usize >= self.points.len()) {
            all.out_of_range.push((row, format!("row {node}")));
            return false;
        }
        let twice = (1..nodes.len()).find(|&i| nodes[..i].contains(&nodes[i]));
        if let Some(i) = twice {
            all.repeated.push((row, format!("point {}", self.point_name(nodes[i] as usize))));
            return false;
        }
        nodes.iter().all(|&node| self.points[node as usize].is_finite())
    }

    fn check_shape(&self, row: usize, all: &mut ElementDefects) {
        let kind = self.cells.kind(row);
        let Some(solid) = kind.topology().solid else { return };
        let corners = &self.places(row)[..];
        let (edge, altitude) = (longest_edge(kind, corners), (solid.smallest_altitude)(corners));
        let (mut volume, mut folded) = ((solid.volume)(corners), false);
        if !solid.is_affine() {
            let middle = solid.middle_volume(corners);
            let least = solid.corner_volumes(corners).fold(middle, f64::min);
            folded = least < -FLAT * edge.powi(3);
            // a one-point element lives by its centre alone: where that has no volume, the element has none
            volume = if middle.abs() < volume.abs() { middle } else { volume };
        }
        if volume.abs() < FLAT * edge.powi(3) || edge == 0.0 {
            all.flat.push((row, format!("volume {volume:.2e} m³, longest edge {edge:.2e} m")));
        } else if volume < 0.0 {
            all.inverted.push((row, format!("volume {volume:.2e} m³")));
        } else if folded {
            let place = if solid.samples.is_empty() { "at a corner" } else { "where its edges curve" };
            all.inverted.push((row, format!("folded {place}")));
        } else if altitude < SLIVER * edge {
            all.slivers.push((row, altitude / edge));
        }
    }

    /// Two elements with the same points: found among those with the same lowest point, four bytes an element.
    fn check_repeated_elements(&self, found: &mut Soundness) {
        let mut pairs: Vec<(u32, u32)> = Vec::new();
        for (kind, rows, _) in self.cells.blocks() {
            let sorted = |row: u32| {
                let mut nodes = [0; MOST_NODES];
                let nodes_of = self.element(row as usize);
                nodes[..nodes_of.len()].copy_from_slice(nodes_of);
                nodes[..kind.node_count()].sort_unstable();
                nodes
            };
            let lowest = |row: usize| self.element(row).iter().min().map_or(0, |&node| node as usize);
            // lowest points that are not there share a bucket
            let bucket = |row: usize| lowest(row).min(self.points.len());
            let mut starts = vec![0_u32; self.points.len() + 2];
            rows.clone().for_each(|row| starts[bucket(row) + 1] += 1);
            (1..starts.len()).for_each(|place| starts[place] += starts[place - 1]);
            let (mut next, mut dealt) = (starts.clone(), vec![0_u32; rows.len()]);
            for row in rows {
                let next = &mut next[bucket(row)];
                dealt[*next as usize] = row as u32;
                *next += 1;
            }
            for bucket in starts.windows(2) {
                let mut alike: Vec<([u32; MOST_NODES], u32)> =
                    dealt[bucket[0] as usize..bucket[1] as usize].iter().map(|&row| (sorted(row), row)).collect();
                alike.sort_unstable();
                pairs.extend(alike.windows(2).filter(|two| two[0].0 == two[1].0).map(|two| (two[0].1, two[1].1)));
            }
        }
        if pairs.is_empty() {
            return;
        }
        pairs.sort_unstable();
        let name = |row: u32| self.element_name(row as usize);
        let names = pairs.iter().map(|&(a, b)| format!("{} and {}", name(a), name(b)));
        let list = counted(
            pairs.len(),
            "pair of elements with the same points",
            "pairs of elements with the same points",
            names,
        );
        let ids = pairs.iter().map(|&(_, second)| name(second)).collect();
        found.error(Defect::RepeatedElement, ids, format!("{list}; keep one of each"));
    }

    fn warn_of_slivers(&self, found: &mut Soundness, mut slivers: Vec<(usize, f64)>) {
        if slivers.is_empty() {
            return;
        }
        slivers.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
        let ids: Vec<u64> = slivers.iter().map(|&(row, _)| self.element_name(row)).collect();
        let names = slivers.iter().map(|&(row, ratio)| format!("{} ({ratio:.1e})", self.element_name(row)));
        let (one, many) = ("very thin element", "very thin elements");
        let worst = if ids.len() > LISTED { "; the worst are listed" } else { "" };
        let text = format!(
            "{} (smallest altitude against longest edge){worst}; the thinnest sets the time step of the whole body",
            counted(ids.len(), one, many, names)
        );
        found.warn(Defect::Sliver, ids, text);
    }
}
