//! Renumbering: neighbours in space become neighbours in memory. Elements and nodes in a file's order cost 1.7 times
//! the step at 135 thousand tetrahedra and 4.3 times at a million.

use crate::components::inside_of;
use crate::mesh::Mesh;
use glam::DVec3;

/// Elements of a block, author's rows, so that each `patch` of them, one after the other, has few nodes: cut in halves
/// across the longest side, at whole patches, until a patch is left (recursive coordinate bisection, Berger and Bokhari
/// 1987). Within a patch they follow a space-filling curve through their centroids (Morton's).
///
/// Copies of a mesh, which may stand in the same place, follow one another.
pub fn element_order(mesh: &Mesh, elements: Vec<u32>, copies: usize, patch: usize) -> Vec<u32> {
    let points_a_copy = mesh.points.len().div_ceil(copies.max(1)).max(1);
    let first = &mesh.points[..points_a_copy.min(mesh.points.len())];
    let low = first.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = first.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    let scale = 2_097_151.0 / (high - low).max_element().max(f64::MIN_POSITIVE);
    let placed = |element: u32| {
        let nodes = mesh.element(element as usize);
        let copy = nodes[0] as usize / points_a_copy;
        let centroid = nodes.iter().map(|&n| mesh.points[n as usize]).sum::<DVec3>() / nodes.len() as f64;
        let cell = (centroid - mesh.points[copy * points_a_copy] + mesh.points[0] - low) * scale;
        Placed { copy: copy as u32, cell: [cell.x as u32, cell.y as u32, cell.z as u32], element }
    };
    let mut placed: Vec<Placed> = elements.into_iter().map(placed).collect();
    cut(&mut placed, patch);
    placed.into_iter().map(|placed| placed.element).collect()
}

/// An element: the copy it belongs to and where its centroid is in that, in 2²¹ parts of the longest side.
#[derive(Clone, Copy)]
struct Placed {
    copy: u32,
    cell: [u32; 3],
    element: u32,
}

impl Placed {
    fn on_curve(&self) -> (u32, u64, u32) {
        let [x, y, z] = self.cell.map(|cell| spread(u64::from(cell)));
        (self.copy, x | y << 1 | z << 2, self.element)
    }
}

fn cut(placed: &mut [Placed], patch: usize) {
    if placed.len() <= patch {
        return placed.sort_by_cached_key(Placed::on_curve);
    }
    let middle = placed.len().div_ceil(patch) / 2 * patch;
    let side = |axis: usize| {
        let cells = placed.iter().map(|placed| placed.cell[axis]);
        cells.clone().max().unwrap_or(0) - cells.min().unwrap_or(0)
    };
    if placed.iter().any(|other| other.copy != placed[0].copy) {
        placed.select_nth_unstable_by_key(middle, Placed::on_curve);
    } else {
        let sides = [side(0), side(1), side(2)];
        let longest = (1..3).fold(0, |longest, axis| if sides[axis] > sides[longest] { axis } else { longest });
        // what lies in one plane is cut along the next axes
        let along = |placed: &Placed| ([0, 1, 2].map(|i| placed.cell[(longest + i) % 3]), placed.element);
        placed.select_nth_unstable_by_key(middle, along);
    }
    let (one, other) = placed.split_at_mut(middle);
    cut(one, patch);
    cut(other, patch);
}

/// Puts two zero bits between any two of the lowest 21 bits.
fn spread(x: u64) -> u64 {
    let x = x & 0x1f_ffff;
    let x = (x | x << 32) & 0x001f_0000_0000_ffff;
    let x = (x | x << 16) & 0x001f_0000_ff00_00ff;
    let x = (x | x << 8) & 0x100f_00f0_0f00_f00f;
    let x = (x | x << 4) & 0x10c3_0c30_c30c_30c3;
    (x | x << 2) & 0x1249_2492_4924_9249
}

/// For each of the author's nodes its new row. `patches` are elements, each a list of nodes. First come, patch by
/// patch, the nodes that no other patch has, as far as it [has](inside_of) such for itself: before those that are kept
/// `apart` (ascending) all others. Then come those that patches share, then what is left of those apart: who goes over
/// them finds them side by side; and last nodes without elements. Each in the order in which elements first touch them.
pub fn node_rows<'a>(
    node_count: usize,
    patches: impl Iterator<Item = impl Iterator<Item = &'a [u32]>>,
    apart: &[u32],
) -> Vec<u32> {
    let mut last = vec![u32::MAX; node_count];
    let mut patches_of = vec![0_u32; node_count];
    let mut is_apart = vec![false; node_count];
    apart.iter().for_each(|&node| is_apart[node as usize] = true);
    let mut touched: Vec<Vec<u32>> = Vec::new();
    for (patch, elements) in (0..).zip(patches) {
        let mut nodes = Vec::new();
        for &node in elements.flatten() {
            if std::mem::replace(&mut last[node as usize], patch) != patch {
                patches_of[node as usize] += 1;
                nodes.push(node);
            }
        }
        touched.push(nodes);
    }
    let mut rows = vec![u32::MAX; node_count];
    let mut next = 0;
    let mut give = |row: &mut u32| {
        if *row == u32::MAX {
            *row = next;
            next += 1;
        }
    };
    for nodes in &touched {
        let [free, of_surface] = [false, true].map(|apart| {
            let (patches_of, is_apart) = (&patches_of, &is_apart);
            let is_inside = move |&node: &usize| patches_of[node] == 1 && is_apart[node] == apart;
            nodes.iter().map(|&node| node as usize).filter(is_inside)
        });
        let own = inside_of([free.clone().count(), of_surface.clone().count()]).iter().sum();
        free.chain(of_surface).take(own).for_each(|node| give(&mut rows[node]));
    }
    for last in [false, true] {
        let nodes = touched.iter().flatten().filter(|&&node| is_apart[node as usize] == last);
        nodes.for_each(|&node| give(&mut rows[node as usize]));
    }
    rows.iter_mut().for_each(give);
    rows
}

#[cfg(test)]
mod tests;
