//! Uniform subdivision: every element becomes eight of the same kind.

use super::{Ids, Mesh, MeshError, SurfaceFace};
use glam::DVec3;
use std::collections::{BTreeSet, HashMap};

/// Edges of a tetrahedron by its corners; [`INNER`] counts them in this order.
const EDGES: [[usize; 2]; 6] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];

/// The octahedron in the middle of a tetrahedron, cut along one of its diagonals: two edges of [`EDGES`] whose middles
/// the diagonal joins, and the other four around it, right-handed.
const INNER: [([usize; 2], [usize; 4]); 3] = [([0, 5], [1, 2, 4, 3]), ([1, 4], [2, 0, 3, 5]), ([2, 3], [0, 1, 5, 4])];

/// Corners of a hexahedron (VTK order) by bits: 1 upper in the first direction, 2 in the second, 4 in the third.
const CORNERS: [usize; 8] = [0, 1, 3, 2, 4, 5, 7, 6];

/// What stands in the key of a new point where it has fewer parents than eight.
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
    /// More elements or points than 32 bits count.
    pub fn refine(&mut self, times: u32) -> Result<(), MeshError> {
        let most = u64::from(u32::MAX) / 8;
        let rows = (self.points.len() as u32, self.element_count() as u32);
        let faces = self.face_sets.values().flatten().flatten();
        let mut points = self.tets.iter().flatten().chain(self.hexes.iter().flatten()).chain(faces);
        if points.any(|&row| row >= rows.0) || self.element_sets.values().flatten().any(|&row| row >= rows.1) {
            // of the mesh as it is, the check of its soundness says what is wrong
            return Ok(());
        }
        for _ in 0..times {
            if self.element_count() as u64 * 8 > most {
                let value = format!("{times}, {} elements at last", self.element_count() as f64 * 8.0);
                let allowed = format!("at most {most} elements fit the 32-bit numbers of points and elements");
                return Err(MeshError::Parameter { name: "body", parameter: "refine", value, allowed });
            }
            self.halve();
        }
        Ok(())
    }

    fn halve(&mut self) {
        let surface = self.surface();
        let (tets, hexes) = (std::mem::take(&mut self.tets), std::mem::take(&mut self.hexes));
        let before = self.points.len();
        let mut middles = Middles { points: std::mem::take(&mut self.points), known: HashMap::new() };
        for tet in &tets {
            self.tets.extend(eight_tets(tet, &mut middles));
        }
        for hex in &hexes {
            self.hexes.extend(eight_hexes(hex, &mut middles));
        }
        if !self.node_sets.is_empty() || !self.point_lists.is_empty() {
            let near = Near::of(&middles, &surface, &tets, &hexes);
            for (name, set) in &mut self.node_sets {
                let own = self.face_sets.get(name).filter(|faces| same_points(faces, set));
                middles.join(&near, set, own);
            }
            self.point_lists.values_mut().for_each(|list| middles.join(&near, list, None));
        }
        for set in self.face_sets.values_mut() {
            *set = set.iter().flat_map(|face| middles.four(face)).collect();
        }
        for set in self.element_sets.values_mut() {
            *set = set.iter().flat_map(|&parent| 8 * parent..8 * parent + 8).collect();
        }
        for vectors in self.element_vectors.values_mut() {
            *vectors = vectors.iter().flat_map(|vector| [*vector; 8]).collect();
        }
        let ids = (0..tets.len() + hexes.len()).flat_map(|parent| [self.element_ids.of(parent); 8]).collect();
        self.element_ids = Ids::Named(ids);
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

fn same_points(faces: &[[u32; 4]], points: &[u32]) -> bool {
    let of_faces: BTreeSet<u32> = faces.iter().flatten().copied().collect();
    of_faces.into_iter().eq(points.iter().copied())
}

/// The points, and which of the new ones lies between which of the old.
struct Middles {
    points: Vec<DVec3>,
    known: HashMap<[u32; 8], u32>,
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

    /// The four parts of a face; none of one that no element has.
    fn four(&self, &[a, b, c, d]: &[u32; 4]) -> Vec<[u32; 4]> {
        let parts = || {
            let (ab, bc) = (self.find(&[a, b])?, self.find(&[b, c])?);
            if c == d {
                let ca = self.find(&[c, a])?;
                return Some(vec![[a, ab, ca, ca], [ab, b, bc, bc], [ca, bc, c, c], [ab, bc, ca, ca]]);
            }
            let (cd, da, m) = (self.find(&[c, d])?, self.find(&[d, a])?, self.find(&[a, b, c, d])?);
            Some(vec![[a, ab, m, da], [ab, b, bc, m], [m, bc, c, cd], [da, m, cd, d]])
        };
        parts().unwrap_or_default()
    }

    /// Adds to a set of points the new ones that belong to it: those on the faces of its own, else on faces of the
    /// surface, else also in elements, that have all their corners in it; and those between points of the set of which
    /// one is on none of these.
    fn join(&self, near: &Near<'_>, set: &mut Vec<u32>, own: Option<&Vec<[u32; 4]>>) {
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
    points: HashMap<u32, Vec<(&'a [u32; 8], u32)>>,
}

impl<'a> Near<'a> {
    fn of(middles: &'a Middles, surface: &[SurfaceFace], tets: &[[u32; 4]], hexes: &[[u32; 8]]) -> Self {
        let by_lowest = |parts: &mut dyn Iterator<Item = Vec<u32>>| {
            let mut found = ByLowest::new();
            for part in parts {
                if let Some(&lowest) = part.iter().min() {
                    found.entry(lowest).or_default().push(part);
                }
            }
            found
        };
        let mut points: HashMap<u32, Vec<(&[u32; 8], u32)>> = HashMap::new();
        for (key, &row) in &middles.known {
            points.entry(key[0]).or_default().push((key, row));
        }
        let elements = tets.iter().map(|tet| tet.to_vec());
        Self {
            faces: by_lowest(&mut surface.iter().map(|face| face.nodes.to_vec())),
            elements: by_lowest(&mut elements.chain(hexes.iter().map(|hex| hex.to_vec()))),
            points,
        }
    }
}

/// The name of a new point: its parents in order.
fn key(parents: &[u32]) -> [u32; 8] {
    let mut key = [NOBODY; 8];
    key[..parents.len()].copy_from_slice(parents);
    key.sort_unstable();
    key
}

/// Eight tetrahedra in the place of one, right-handed if it is: one in each corner, and four around the shortest
/// diagonal of the octahedron between them.
fn eight_tets(tet: &[u32; 4], middles: &mut Middles) -> [[u32; 4]; 8] {
    let m = EDGES.map(|[a, b]| middles.of(&[tet[a], tet[b]]));
    let length = |&([a, b], _): &([usize; 2], [usize; 4])| {
        middles.points[m[a] as usize].distance_squared(middles.points[m[b] as usize])
    };
    let mut shortest = INNER[0];
    for inner in &INNER[1..] {
        if length(inner) < length(&shortest) {
            shortest = *inner;
        }
    }
    let ([a, b], ring) = shortest;
    let inside = [0, 1, 2, 3].map(|i| [m[a], m[b], m[ring[i]], m[ring[(i + 1) % 4]]]);
    let corners = [
        [tet[0], m[0], m[1], m[2]],
        [m[0], tet[1], m[3], m[4]],
        [m[1], m[3], tet[2], m[5]],
        [m[2], m[4], m[5], tet[3]],
    ];
    [corners[0], corners[1], corners[2], corners[3], inside[0], inside[1], inside[2], inside[3]]
}

/// Eight hexahedra in the place of one, each at the corner of its place.
fn eight_hexes(hex: &[u32; 8], middles: &mut Middles) -> [[u32; 8]; 8] {
    // points of the 3×3×3 grid: each the middle of the corners that agree with it
    let mut grid = [0; 27];
    for (place, point) in grid.iter_mut().enumerate() {
        let at = [place % 3, place / 3 % 3, place / 9];
        let agrees = |corner: usize| (0..3).all(|axis| at[axis] == 1 || (at[axis] == 2) == (corner >> axis & 1 == 1));
        let parents: Vec<u32> = (0..8).filter(|&corner| agrees(corner)).map(|c| hex[CORNERS[c]]).collect();
        *point = if parents.len() == 1 { parents[0] } else { middles.of(&parents) };
    }
    CORNERS.map(|corner| {
        let at =
            |bits: usize| (0..3).map(move |axis| ((corner >> axis & 1) + (bits >> axis & 1)) * 3usize.pow(axis as u32));
        CORNERS.map(|bits| grid[at(bits).sum::<usize>()])
    })
}
