//! Points: finite, used, and each in a place of its own.

use super::{Defect, Soundness, counted};
use crate::Mesh;
use glam::DVec3;

/// Points closer than this share of the mesh's size count as coincident.
const SAME_PLACE: f64 = 1e-10;

impl Mesh {
    pub(super) fn check_points(&self, found: &mut Soundness) {
        let not_finite: Vec<usize> = (0..self.points.len()).filter(|&row| !self.points[row].is_finite()).collect();
        if !not_finite.is_empty() {
            let names = not_finite.iter().map(|&row| format!("{} {}", self.point_name(row), self.points[row]));
            let text = counted(
                not_finite.len(),
                "point without finite coordinates",
                "points without finite coordinates",
                names,
            );
            let ids = not_finite.iter().map(|&row| self.point_name(row)).collect();
            found.error(Defect::NotFinite, ids, text);
        }
        self.check_use(found);
        self.check_places(found);
    }

    fn check_use(&self, found: &mut Soundness) {
        let mut used = vec![false; self.points.len()];
        for row in self.cells.all_nodes() {
            if let Some(used) = used.get_mut(row as usize) {
                *used = true;
            }
        }
        let ids: Vec<u64> = (0..used.len()).filter(|&row| !used[row]).map(|row| self.point_name(row)).collect();
        if !ids.is_empty() && self.element_count() > 0 {
            let list =
                counted(ids.len(), "point of no element", "points of no element", ids.iter().map(u64::to_string));
            let text = format!("{list}; without mass, such points stay where they are");
            found.warn(Defect::Unused, ids, text);
        }
    }

    /// Sorts the points along a direction in which no regular mesh has layers; coincident ones are neighbours then.
    fn check_places(&self, found: &mut Soundness) {
        let finite = |&row: &usize| self.points[row].is_finite();
        let inside = |row: usize| self.points[row];
        let low = (0..self.points.len()).filter(finite).map(inside).reduce(DVec3::min);
        let high = (0..self.points.len()).filter(finite).map(inside).reduce(DVec3::max);
        let (Some(low), Some(high)) = (low, high) else { return };
        let near = SAME_PLACE * low.distance(high);
        let along = DVec3::new(0.577_215_664_9, 0.738_114_271_3, 0.349_562_382_7);
        let mut places: Vec<(f64, u32)> =
            (0..self.points.len()).filter(finite).map(|row| ((inside(row) - low).dot(along), row as u32)).collect();
        places.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut pairs = Vec::new();
        for (i, &(place, row)) in places.iter().enumerate() {
            let candidates = places[i + 1..].iter().take_while(|(other, _)| other - place <= near);
            let twin = candidates
                .map(|&(_, other)| other)
                .find(|&other| inside(row as usize).distance(inside(other as usize)) <= near);
            pairs.extend(twin.map(|twin| (row.min(twin), row.max(twin))));
        }
        if pairs.is_empty() {
            return;
        }
        pairs.sort_unstable();
        let name = |row: u32| self.point_name(row as usize);
        let names = pairs.iter().map(|&(a, b)| format!("{} and {}", name(a), name(b)));
        let list = counted(pairs.len(), "pair of points in the same place", "pairs of points in the same place", names);
        let mut rows: Vec<u32> = pairs.iter().flat_map(|&(a, b)| [a, b]).collect();
        rows.sort_unstable();
        rows.dedup();
        let text = format!("{list}; elements are joined by common points only, so the body may fall apart there");
        found.warn(Defect::Coincident, rows.into_iter().map(name).collect(), text);
    }
}
