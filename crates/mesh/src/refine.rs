//! Uniform subdivision: every element becomes some of the same kind, as its [`Split`] says.

use super::surface::nodes_of_face;
use super::topology::{MOST_NODES, MOST_PARENTS, MOST_SPLIT_POINTS, Split};
use super::{CellKind, Cells, Ids, Mesh, MeshError, SurfaceFace};
use glam::DVec3;
use std::collections::{BTreeSet, HashMap};

/// The parents of a new point, ascending.
type Key = [u32; MOST_PARENTS];

/// What stands in the key of a new point where it has fewer parents than one may have.
const NOBODY: u32 = u32::MAX;

impl Mesh {
    /// Cuts every element into eight, so many times over. Edges are halved where they are: a curved outline stays the
    /// polygon it is.
    ///
    /// Points keep their rows and numbers, new ones follow. The parts of an element bear its number, its vectors and
    /// its sets. A new point belongs to a set of points, or to a list of them, when the face, element or edge it lies
    /// on does (with faces of the surface tried first).
    ///
    /// # Errors
    /// Elements of a kind that cannot be cut; more elements or points than 32 bits count.
    #[doc(hidden)]
    pub fn refine(&mut self, times: u32) -> Result<(), MeshError> {
        let most = u64::from(u32::MAX) / 8;
        let refuse = |value, allowed| Err(MeshError::Parameter { name: "body", parameter: "refine", value, allowed });
        let rows = (self.points.len() as u32, self.element_count() as u32);
        let faces = self.face_sets.values().flatten().flatten();
        let lost_points = self.cells.all_nodes().chain(faces.copied()).any(|row| row >= rows.0);
        if lost_points || self.element_sets.values().flatten().any(|&row| row >= rows.1) {
            // of the mesh as it is, the check of its soundness says what is wrong
            return Ok(());
        }
        for _ in 0..times {
            let mut parts = 0;
            for (kind, count) in self.cells.kinds() {
                let topology = kind.topology();
                let Some(split) = topology.split else {
                    return refuse(format!("{times}"), format!("it must be 0: {} are not cut", topology.plural));
                };
                parts += (split.count() * count) as u64;
            }
            if parts > most {
                let value = format!("{times}, {parts} elements at last");
                return refuse(value, format!("at most {most} elements fit the 32-bit numbers of points and elements"));
            }
            self.halve();
        }
        Ok(())
    }

    fn halve(&mut self) {
        let (surface, there) = (self.surface(), self.middles());
        let whole = std::mem::take(&mut self.cells);
        let before = self.points.len();
        // those that are there are no new points
        let known = there.iter().map(|(ends, &middle)| (key(ends), middle)).collect();
        let mut middles = Middles { points: std::mem::take(&mut self.points), known };
        // where the parts of each element begin, and the last of them end
        let mut parts = vec![0];
        for (kind, nodes) in &whole {
            if let Some(split) = kind.topology().split {
                middles.cut((kind, split), nodes, |part| self.cells.push_nodes(kind, part));
            }
            parts.push(self.cells.len() as u32);
        }
        let parts_of = |parent: u32| parts[parent as usize]..parts[parent as usize + 1];
        if !self.node_sets.is_empty() || !self.point_lists.is_empty() {
            let near = Near::of(&middles, before, &surface, &whole);
            for (name, set) in &mut self.node_sets {
                let own: Option<Vec<Vec<u32>>> = self
                    .face_sets
                    .get(name)
                    .map(|faces| faces.iter().map(|face| nodes_of_face(face, &there)).collect());
                middles.join(&near, set, own.filter(|faces| same_points(faces, set)).as_ref());
            }
            self.point_lists.values_mut().for_each(|list| middles.join(&near, list, None));
        }
        for set in self.face_sets.values_mut() {
            *set = set.iter().flat_map(|face| middles.four(face)).collect();
        }
        for set in self.element_sets.values_mut() {
            *set = set.iter().flat_map(|&parent| parts_of(parent)).collect();
        }
        for vectors in self.element_vectors.values_mut() {
            let own = (0..).zip(vectors.iter()).flat_map(|(parent, vector)| parts_of(parent).map(|_| *vector));
            *vectors = own.collect();
        }
        let ids = (0..whole.len()).flat_map(|parent| {
            let id = self.element_ids.of(parent);
            parts_of(parent as u32).map(move |_| id)
        });
        self.element_ids = Ids::Named(ids.collect());
        if let Ids::Named(ids) = &mut self.point_ids {
            ids.extend(free_numbers(ids, middles.points.len() - before));
        }
        self.points = middles.points;
    }
}

/// So many numbers that none of `ids` is: those after the largest, or where these come to an end the smallest.
fn free_numbers(ids: &[u64], count: usize) -> Vec<u64> {
    let next = ids.iter().max().map_or(Some(0), |id| id.checked_add(1));
    match next.filter(|next| next.checked_add(count as u64).is_some()) {
        Some(next) => (next..).take(count).collect(),
        None => {
            let taken: BTreeSet<u64> = ids.iter().copied().collect();
            (0..).filter(|number| !taken.contains(number)).take(count).collect()
        }
    }
}

fn same_points(faces: &[Vec<u32>], points: &[u32]) -> bool {
    let of_faces: BTreeSet<u32> = faces.iter().flatten().copied().collect();
    of_faces.into_iter().eq(points.iter().copied())
}

/// The points, and which of the new ones lies between which of the old.
struct Middles {
    points: Vec<DVec3>,
    known: HashMap<Key, u32>,
}

impl Middles {
    /// The point in the middle of two, four or eight others.
    fn of(&mut self, parents: &[u32]) -> u32 {
        let key = key(parents);
        if let Some(&row) = self.known.get(&key) {
            return row;
        }
        let row = self.points.len() as u32;
        let sum: DVec3 = parents.iter().map(|&parent| self.points[parent as usize]).sum();
        self.points.push(sum / parents.len() as f64);
        self.known.insert(key, row);
        row
    }

    fn find(&self, parents: &[u32]) -> Option<u32> {
        self.known.get(&key(parents)).copied()
    }

    /// The parts of a cell, right-handed if it is, by the rows of their nodes. Of a cell of second order the middles of
    /// the parts' edges are halfway between nodes.
    fn cut(&mut self, (kind, split): (CellKind, &Split), nodes: &[u32], mut see: impl FnMut(&[u32])) {
        let mut rows = [0; MOST_SPLIT_POINTS];
        for (place, corners) in split.points.iter().enumerate() {
            let mut parents = [0; MOST_PARENTS];
            for (parent, &corner) in corners.iter().enumerate() {
                parents[parent] = nodes[corner];
            }
            rows[place] = if let [corner] = corners { nodes[*corner] } else { self.of(&parents[..corners.len()]) };
        }
        let (topology, mut parts) = (kind.topology(), Vec::with_capacity(split.count()));
        split.parts(
            |place| self.points[rows[place] as usize],
            |part| {
                let mut nodes = [0; MOST_NODES];
                for (node, &place) in part.iter().enumerate() {
                    nodes[node] = rows[place];
                }
                parts.push(nodes);
            },
        );
        for mut nodes in parts {
            for (node, &[a, b]) in (topology.corners..kind.node_count()).zip(topology.edges) {
                nodes[node] = self.of(&[nodes[a], nodes[b]]);
            }
            see(&nodes[..kind.node_count()]);
        }
    }

    /// The four parts of a face; none of one that no element has.
    fn four(&self, face: &[u32; 4]) -> Vec<[u32; 4]> {
        let parts = || {
            let split = CellKind::of_face(face).topology().split?;
            let row = |corners: &&[usize]| match corners {
                [corner] => Some(face[*corner]),
                corners => self.find(&corners.iter().map(|&corner| face[corner]).collect::<Vec<_>>()),
            };
            let rows = split.points.iter().map(row).collect::<Option<Vec<u32>>>()?;
            let four = |part: &&[usize]| [0, 1, 2, part.len() - 1].map(|place| rows[part[place]]);
            Some(split.parts.iter().map(four).collect())
        };
        parts().unwrap_or_default()
    }

    /// Adds to a set of points the new ones that belong to it: those on the faces of its own, else on faces of the
    /// surface, else also in elements, that have all their corners in it; and those between points of the set of which
    /// one is on none of these.
    fn join(&self, near: &Near<'_>, set: &mut Vec<u32>, own: Option<&Vec<Vec<u32>>>) {
        if set.len() < 2 {
            return;
        }
        let old: BTreeSet<u32> = set.iter().copied().collect();
        let whole = |nodes: &[u32]| nodes.iter().all(|node| old.contains(node));
        let mut parts: Vec<&[u32]> = match own {
            Some(own) => own.iter().map(|face| &face[..]).collect(),
            None => at(&near.faces, set).filter(|face| whole(face)).collect(),
        };
        let on_faces: BTreeSet<u32> = parts.iter().flat_map(|part| part.iter().copied()).collect();
        if on_faces.len() < old.len() {
            parts.extend(at(&near.elements, set).filter(|element| whole(element)));
        }
        let mut of_point: HashMap<u32, Vec<usize>> = HashMap::new();
        for (place, part) in parts.iter().enumerate() {
            part.iter().for_each(|&node| of_point.entry(node).or_default().push(place));
        }
        // a point lies on a part when all of its parents are corners of it
        let belongs = |parents: &[u32]| {
            let places = of_point.get(&parents[0]).map_or(&[][..], Vec::as_slice);
            places.iter().any(|&place| parents.iter().all(|parent| parts[place].contains(parent)))
                || parents.iter().any(|parent| !of_point.contains_key(parent))
        };
        let mut new = Vec::new();
        for (key, row) in old.iter().filter_map(|node| near.points.get(node)).flatten() {
            let parents = &key[..key.partition_point(|&parent| parent != NOBODY)];
            if whole(parents) && belongs(parents) {
                new.push(*row);
            }
        }
        set.extend(new);
        set.sort_unstable();
        set.dedup();
    }
}

type ByLowest = HashMap<u32, Vec<Vec<u32>>>;

/// The parts whose lowest corner is one of some points.
fn at<'a>(parts: &'a ByLowest, points: &'a [u32]) -> impl Iterator<Item = &'a [u32]> {
    points.iter().filter_map(|point| parts.get(point)).flatten().map(Vec::as_slice)
}

/// Faces of the surface, elements and new points, each by the lowest of its corners or parents.
struct Near<'a> {
    faces: ByLowest,
    elements: ByLowest,
    points: HashMap<u32, Vec<(&'a Key, u32)>>,
}

impl<'a> Near<'a> {
    fn of(middles: &'a Middles, before: usize, surface: &[SurfaceFace], whole: &Cells) -> Self {
        let by_lowest = |parts: &mut dyn Iterator<Item = Vec<u32>>| {
            let mut found = ByLowest::new();
            for part in parts {
                if let Some(&lowest) = part.iter().min() {
                    found.entry(lowest).or_default().push(part);
                }
            }
            found
        };
        let mut points: HashMap<u32, Vec<(&Key, u32)>> = HashMap::new();
        for (key, &row) in middles.known.iter().filter(|(_, row)| **row as usize >= before) {
            points.entry(key[0]).or_default().push((key, row));
        }
        Self {
            faces: by_lowest(
                &mut surface
                    .iter()
                    .map(|face| face.nodes.into_iter().chain(face.middles.into_iter().flatten()).collect()),
            ),
            elements: by_lowest(&mut whole.iter().map(|(_, nodes)| nodes.to_vec())),
            points,
        }
    }
}

/// The name of a new point: its parents in order.
fn key(parents: &[u32]) -> Key {
    let mut key = [NOBODY; MOST_PARENTS];
    key[..parents.len()].copy_from_slice(parents);
    key.sort_unstable();
    key
}
