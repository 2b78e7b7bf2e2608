//! What is written down of each kind of cell fits together.

use glam::{DMat3, DVec3};
use sinew::mesh::topology::{CellKind, MassRule, Solid, Topology, foreign};
use std::collections::{BTreeMap, BTreeSet};

/// Cells that fill space, each with its nodes moved a little (m).
pub fn solids() -> Vec<(CellKind, &'static Topology, &'static Solid, Vec<DVec3>)> {
    let mut random = fastrand::Rng::with_seed(7);
    let mut moved = |at: &[f64; 3]| DVec3::from_array(at.map(|x| x + 0.2 * (random.f64() - 0.5)));
    let solid = |(kind, solid): (CellKind, &'static Solid)| {
        let topology = kind.topology();
        (kind, topology, solid, topology.nodes.iter().map(&mut moved).collect())
    };
    CellKind::solids().map(solid).collect()
}

/// The determinant of the Jacobian at a place of the reference cell.
fn determinant(solid: &Solid, at: [f64; 3], p: &[DVec3]) -> f64 {
    (solid.shape)(at).jacobian(p).determinant()
}

/// Gauss points and weights from 0 to 1, exact up to the seventh order.
fn gauss() -> [(f64, f64); 4] {
    let root = 1.2f64.sqrt();
    let (inner, outer) = ((3.0 / 7.0 - 2.0 / 7.0 * root).sqrt(), (3.0 / 7.0 + 2.0 / 7.0 * root).sqrt());
    let (heavy, light) = ((18.0 + 30f64.sqrt()) / 72.0, (18.0 - 30f64.sqrt()) / 72.0);
    [(-outer, light), (-inner, heavy), (inner, heavy), (outer, light)].map(|(x, weight)| ((1.0 + x) / 2.0, weight))
}

/// ∫ x·n dA / 3 over a face: exact with two Gauss points a direction on a bilinear one; that of a triangle of second
/// order is of the fourth order, on a square folded to a triangle of the fifth.
pub fn flux(p: &[DVec3]) -> f64 {
    if let [a, b, c] = *p {
        return a.cross(b).dot(c) / 6.0;
    }
    if let [a, b, c, ab, bc, ca] = *p {
        let at = |r: f64, s: f64| {
            let [l, m, n] = [1.0 - r - s, r, s];
            let x = l * (2.0 * l - 1.0) * a + m * (2.0 * m - 1.0) * b + n * (2.0 * n - 1.0) * c;
            let x = x + 4.0 * (l * m * ab + m * n * bc + n * l * ca);
            let by_r = (1.0 - 4.0 * l) * a + (4.0 * m - 1.0) * b + 4.0 * ((l - m) * ab + n * bc - n * ca);
            let by_s = (1.0 - 4.0 * l) * a + (4.0 * n - 1.0) * c + 4.0 * ((l - n) * ca + m * bc - m * ab);
            x.dot(by_r.cross(by_s)) / 3.0
        };
        let all = gauss().into_iter().flat_map(|u| gauss().map(|v| (u, v)));
        return all.map(|((u, of_u), (v, of_v))| of_u * of_v * (1.0 - u) * at(u, v * (1.0 - u))).sum();
    }
    let [a, b, c, d] = [0, 1, 2, 3].map(|i| p[i]);
    let gauss = [0.5 - 0.5 / 3f64.sqrt(), 0.5 + 0.5 / 3f64.sqrt()];
    let at = |u: f64, v: f64| {
        let x = (1.0 - v) * ((1.0 - u) * a + u * b) + v * ((1.0 - u) * d + u * c);
        let (along, across) = ((1.0 - v) * (b - a) + v * (c - d), (1.0 - u) * (d - a) + u * (c - b));
        x.dot(along.cross(across)) / 12.0
    };
    gauss.into_iter().map(|u| gauss.into_iter().map(|v| at(u, v)).sum::<f64>()).sum()
}

#[test]
fn faces_look_outwards_and_close_the_cell() {
    for (kind, topology, solid, p) in solids() {
        let by_faces: f64 =
            topology.faces.iter().map(|face| flux(&face.nodes.iter().map(|&node| p[node]).collect::<Vec<_>>())).sum();
        let by_points: f64 = solid.quadrature.iter().map(|(at, weight)| weight * determinant(solid, *at, &p)).sum();
        let volume = (solid.volume)(&p);
        assert!(volume > 0.0, "{kind:?}: {volume}");
        assert!((by_faces / volume - 1.0).abs() < 1e-13, "{kind:?}: its faces enclose {by_faces}, it fills {volume}");
        assert!((by_points / volume - 1.0).abs() < 1e-13, "{kind:?}: by quadrature {by_points}, it fills {volume}");
        // each edge belongs to two faces, which run along it in opposite directions
        let mut ways = BTreeSet::new();
        for face in topology.faces {
            assert_eq!(face.nodes.len(), face.kind.node_count(), "{kind:?}");
            // its middles are those of the cell's edges
            for (node, ends) in face.nodes[face.kind.topology().corners..].iter().zip(face.kind.topology().edges) {
                let [a, b] = topology.edges[node - topology.corners];
                let [c, d] = ends.map(|end| face.nodes[end]);
                assert!([a, b] == [c, d] || [b, a] == [c, d], "{kind:?}: {node} is not between {c} and {d}");
            }
            // flat parts fill it, the same way round
            let corners: Vec<DVec3> = face.kind.topology().nodes.iter().map(|&at| DVec3::from_array(at)).collect();
            let area = |[a, b, c, d]: [usize; 4]| 0.5 * (corners[c] - corners[a]).cross(corners[d] - corners[b]).z;
            let whole = if face.kind.topology().corners == 4 { 4.0 } else { 0.5 };
            assert!(face.kind.topology().facets.iter().all(|&facet| area(facet) > 0.0), "{kind:?}");
            assert_eq!(face.kind.topology().facets.iter().map(|&facet| area(facet)).sum::<f64>(), whole, "{kind:?}");
            assert_eq!(face.nodes.iter().collect::<BTreeSet<_>>().len(), face.nodes.len(), "{kind:?}");
            for [a, b] in face.kind.topology().edges.iter().map(|edge| edge.map(|end| face.nodes[end])) {
                assert!(ways.insert([a, b]), "{kind:?}: two faces run along the edge {a} {b}");
            }
        }
        let edges: BTreeSet<[usize; 2]> = topology.edges.iter().flat_map(|&[a, b]| [[a, b], [b, a]]).collect();
        assert_eq!((ways, 2 * topology.edges.len()), (edges.clone(), edges.len()), "{kind:?}");
        // corners less edges and faces: Euler
        assert_eq!(topology.corners + topology.faces.len(), topology.edges.len() + 2, "{kind:?}");
    }
}

#[test]
fn nodes_in_the_middle_follow_the_edges() {
    for kind in CellKind::ALL {
        let topology = kind.topology();
        for (node, edge) in topology.nodes[topology.corners..].iter().zip(topology.edges) {
            let [a, b] = edge.map(|end| DVec3::from_array(topology.nodes[end]));
            assert_eq!(DVec3::from_array(*node), (a + b) / 2.0, "{kind:?}");
        }
        let middles = topology.nodes.len() - topology.corners;
        assert!(middles == 0 || middles == topology.edges.len(), "{kind:?}");
    }
}

#[test]
fn shape_functions_are_one_at_their_node_and_their_gradients_are_slopes() {
    for (kind, topology, solid, _) in solids() {
        let nodes = topology.nodes.len();
        for (own, at) in topology.nodes.iter().enumerate() {
            for (other, value) in (solid.shape)(*at).values.into_iter().enumerate() {
                assert!(
                    (value - if own == other { 1.0 } else { 0.0 }).abs() < 1e-15,
                    "{kind:?}: {own} {other} {value}"
                );
            }
        }
        let at = [0.21, 0.13, 0.32];
        let here = (solid.shape)(at);
        assert!((here.values.iter().sum::<f64>() - 1.0).abs() < 1e-14, "{kind:?}");
        assert!(here.gradients.iter().sum::<DVec3>().length() < 1e-14, "{kind:?}");
        for axis in 0..3 {
            let beside = |by: f64| {
                let mut at = at;
                at[axis] += by;
                (solid.shape)(at).values
            };
            let (over, under) = (beside(1e-5), beside(-1e-5));
            for node in 0..nodes {
                let slope = (over[node] - under[node]) / 2e-5;
                assert!((slope - here.gradients[node][axis]).abs() < 1e-9, "{kind:?}: node {node}, axis {axis}");
            }
        }
    }
}

#[test]
fn the_shares_of_the_mass_are_what_the_rule_gives() {
    for (kind, topology, solid, _) in solids() {
        let p: Vec<DVec3> = topology.nodes.iter().map(|&at| DVec3::from_array(at)).collect();
        let power = if solid.mass == MassRule::Hrz { 2 } else { 1 };
        let mut sums = vec![0.0; p.len()];
        // squares of second order are of the fourth, on a cube folded to a tetrahedron of the sixth
        let folded = |((u, a), (v, b), (w, c)): ((f64, f64), (f64, f64), (f64, f64))| {
            ([u, v * (1.0 - u), w * (1.0 - u) * (1.0 - v)], a * b * c * (1.0 - u).powi(2) * (1.0 - v))
        };
        let cube = gauss().into_iter().flat_map(|u| gauss().map(|v| (u, v)));
        let cube = cube.flat_map(|(u, v)| gauss().map(|w| folded((u, v, w))));
        let points = if topology.corners == 4 { cube.collect() } else { solid.quadrature.to_vec() };
        for (at, weight) in &points {
            let weight = weight * determinant(solid, *at, &p);
            let values = (solid.shape)(*at).values;
            sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += weight * value.powi(power));
        }
        let whole: f64 = sums.iter().sum();
        assert_eq!(solid.shares.len(), sums.len(), "{kind:?}");
        assert!((solid.shares.iter().sum::<f64>() - 1.0).abs() < 1e-15, "{kind:?}");
        for (share, sum) in solid.shares.iter().zip(sums) {
            assert!(
                *share > 0.0 && (share - sum / whole).abs() < 1e-14,
                "{kind:?}: {share}, by the rule {}",
                sum / whole
            );
        }
    }
}

#[test]
fn frames_and_axes_give_the_volume_of_an_affine_cell() {
    for (kind, topology, solid, p) in solids() {
        let middle =
            topology.nodes.iter().map(|&at| DVec3::from_array(at)).sum::<DVec3>() / topology.nodes.len() as f64;
        // as the volume of an affine cell: the determinant times the volume of the reference cell
        let reference: f64 = solid.quadrature.iter().map(|(_, weight)| weight).sum();
        let volume = reference * determinant(solid, middle.to_array(), &p);
        assert!((solid.middle_volume(&p) / volume - 1.0).abs() < 1e-13, "{kind:?}: {volume}");
        let affine = DMat3::from_cols(DVec3::new(1.2, 0.1, 0.0), DVec3::new(-0.2, 0.9, 0.3), DVec3::new(0.1, 0.0, 1.1));
        let moved: Vec<DVec3> = topology.nodes.iter().map(|&at| affine * DVec3::from_array(at)).collect();
        let whole = (solid.volume)(&moved);
        let all = solid.corner_volumes(&moved).chain([solid.middle_volume(&moved)]);
        all.for_each(|volume| assert!((volume / whole - 1.0).abs() < 1e-13, "{kind:?}: {volume}, not {whole}"));
        let joined = |a: usize, b: usize| topology.edges.iter().any(|edge| *edge == [a, b] || *edge == [b, a]);
        for (found, frame) in solid.corner_volumes(&p).zip(solid.frames) {
            let exact = reference * determinant(solid, topology.nodes[frame[0]], &p);
            assert!((found - exact).abs() < 1e-13 * exact.abs(), "{kind:?} at {}: {found}, not {exact}", frame[0]);
            assert!(frame[1..].iter().all(|&other| joined(frame[0], other)), "{kind:?}: {frame:?}");
        }
        assert!(solid.frames.is_empty() || solid.frames.len() == topology.corners, "{kind:?}");
    }
}

#[test]
fn a_turned_cell_is_inside_out() {
    for (kind, _, solid, p) in solids() {
        let turned: Vec<DVec3> = solid.turned.iter().map(|&place| p[place]).collect();
        let (volume, other) = ((solid.volume)(&p), (solid.volume)(&turned));
        assert!((volume + other).abs() < 1e-13 * volume, "{kind:?}: {volume} and {other}");
        assert!(solid.is_inside_out(&turned) && !solid.is_inside_out(&p), "{kind:?}");
        let again: Vec<usize> = solid.turned.iter().map(|&place| solid.turned[place]).collect();
        assert_eq!(again, (0..p.len()).collect::<Vec<_>>(), "{kind:?}: turned twice");
    }
}

#[test]
fn files_list_every_node_once_and_numbers_name_one_kind() {
    let (mut vtk, mut gmsh) = (BTreeSet::new(), BTreeSet::new());
    for kind in CellKind::ALL {
        let topology = kind.topology();
        let nodes: Vec<usize> = (0..topology.nodes.len()).collect();
        for listing in topology.vtk.iter().chain([&topology.gmsh]) {
            assert_eq!(
                listing.order.iter().copied().collect::<BTreeSet<_>>(),
                nodes.iter().copied().collect(),
                "{kind:?}"
            );
            assert_eq!(listing.order.len(), nodes.len(), "{kind:?}");
            let listed: Vec<usize> = listing.write(&nodes).collect();
            assert!(listing.read(&listed).eq(nodes.iter().copied()), "{kind:?}");
        }
        assert!(topology.vtk.iter().all(|listing| vtk.insert(listing.number)), "{kind:?}");
        assert!(gmsh.insert(u64::from(topology.gmsh.number)), "{kind:?}");
        assert_eq!(CellKind::of_vtk(topology.vtk[0].number).ok().map(|of| of.0), Some(kind));
        assert_eq!(CellKind::of_gmsh(topology.gmsh.number.into()), Some(kind));
    }
    for cell in &foreign::CELLS {
        assert!(cell.vtk.is_none_or(|number| vtk.insert(number)), "{}", cell.plural);
        assert!(cell.gmsh.is_none_or(|number| gmsh.insert(number)), "{}", cell.plural);
    }
}

/// The parts of a split cell, by their points (m), and which points of the split these are.
fn parts_of(topology: &Topology, p: &[DVec3]) -> Vec<(Vec<usize>, Vec<DVec3>)> {
    let split = topology.split.unwrap();
    let middle = |corners: &&[usize]| corners.iter().map(|&corner| p[corner]).sum::<DVec3>() / corners.len() as f64;
    let points: Vec<DVec3> = split.points.iter().map(middle).collect();
    let mut parts = Vec::new();
    split.parts(|place| points[place], |part| parts.push((part.to_vec(), part.iter().map(|&at| points[at]).collect())));
    parts
}

#[test]
fn parts_fill_the_cell_and_their_inner_faces_cancel() {
    // those of second order are cut as those of first
    let straight = |topology: &Topology| topology.split.is_some() && topology.corners == topology.nodes.len();
    for (kind, topology, solid, p) in solids().into_iter().filter(|of| straight(of.1)) {
        let parts = parts_of(topology, &p);
        assert_eq!(parts.len(), topology.split.unwrap().count(), "{kind:?}");
        let volumes: Vec<f64> = parts.iter().map(|(_, points)| (solid.volume)(points)).collect();
        assert!(volumes.iter().all(|volume| *volume > 0.0), "{kind:?}: {volumes:?}");
        let (sum, whole) = (volumes.iter().sum::<f64>(), (solid.volume)(&p));
        assert!((sum / whole - 1.0).abs() < 1e-13, "{kind:?}: parts fill {sum}, the cell {whole}");
        // a face inside is seen once from either side: its corners the other way round; one outside is seen once
        let mut seen: BTreeMap<Vec<usize>, Vec<Vec<usize>>> = BTreeMap::new();
        for (part, _) in &parts {
            for face in topology.faces {
                let nodes: Vec<usize> = face.nodes.iter().map(|&node| part[node]).collect();
                let mut key = nodes.clone();
                key.sort_unstable();
                seen.entry(key).or_default().push(nodes);
            }
        }
        for (key, sides) in seen.values().filter(|sides| sides.len() > 1).map(|sides| (&sides[0], sides)) {
            let back: Vec<usize> = sides[1].iter().rev().copied().collect();
            let same = (0..back.len()).any(|turn| back.iter().cycle().skip(turn).take(back.len()).eq(key));
            assert!(sides.len() == 2 && same, "{kind:?}: {sides:?}");
        }
        let outside = seen.values().filter(|sides| sides.len() == 1).count();
        let of_faces = topology.faces.iter().map(|face| face.kind.topology().split.unwrap().parts.len());
        assert_eq!(outside, of_faces.sum::<usize>(), "{kind:?}");
    }
}

#[test]
fn a_point_is_found_where_the_shape_functions_put_it() {
    for (kind, topology, solid, p) in solids() {
        let middle =
            topology.nodes.iter().map(|&at| DVec3::from_array(at)).sum::<DVec3>() / topology.nodes.len() as f64;
        for corner in topology.nodes {
            let at = middle.lerp(DVec3::from_array(*corner), 0.8).to_array();
            let values = (solid.shape)(at).values;
            let x: DVec3 = p.iter().zip(values).map(|(point, value)| *point * value).sum();
            let found = (solid.locate)(&p, x);
            let miss = found.weights.iter().zip(values).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(found.outside == 0.0 && miss < 1e-12, "{kind:?} at {at:?}: {found:?}");
        }
        let beyond = 3.0 * p[0] - 2.0 * p.iter().sum::<DVec3>() / p.len() as f64;
        let found = (solid.locate)(&p, beyond);
        assert!(found.outside > 0.1 && found.weights[0] > 0.99, "{kind:?}: {found:?}");
    }
}

/// Far from the origin places have fewer digits, and a point is found by all that they have: 10 km off, cells of 1 mm
/// have lost seven of sixteen, and Newton's steps, which ended by what is left near the origin, never did.
#[test]
fn a_point_is_found_far_from_the_origin_too() {
    for (kind, topology, solid, p) in solids() {
        let middle =
            topology.nodes.iter().map(|&at| DVec3::from_array(at)).sum::<DVec3>() / topology.nodes.len() as f64;
        for offset in [DVec3::ZERO, DVec3::new(1e4, -7e3, 5e3)] {
            // half as far from the reference cell as the others
            let moved = |(at, node): (&DVec3, &[f64; 3])| offset + 1e-3 * at.midpoint(DVec3::from_array(*node));
            let p: Vec<DVec3> = p.iter().zip(topology.nodes).map(moved).collect();
            for corner in topology.nodes {
                let at = middle.lerp(DVec3::from_array(*corner), 0.8).to_array();
                let values = (solid.shape)(at).values;
                let x = p[0] + p.iter().zip(values).map(|(point, value)| (*point - p[0]) * value).sum::<DVec3>();
                let found = (solid.locate)(&p, x);
                let miss = found.weights.iter().zip(values).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                // the point is rounded by half a unit of its last digit, and weights change by some a cell
                let most = 1e-12 + 16.0 * f64::EPSILON * offset.length() / 1e-3;
                assert!(found.outside == 0.0 && miss < most, "{kind:?} at {at:?} from {offset}: {miss:e}, {found:?}");
            }
            let volume = (solid.volume)(&p) / (1e-9 * solid.unit_volume);
            assert!(volume > 0.1 && volume < 10.0, "{kind:?} from {offset}: {volume}");
        }
    }
}

#[test]
fn the_jacobian_of_a_linear_map_is_its_matrix() {
    // the Jacobian of a cell that is mapped by a matrix is that matrix, anywhere in it
    let matrix = DMat3::from_cols(DVec3::new(1.2, 0.1, 0.0), DVec3::new(-0.2, 0.9, 0.3), DVec3::new(0.1, 0.0, 1.1));
    for (kind, topology, solid, _) in solids() {
        let p: Vec<DVec3> = topology.nodes.iter().map(|&at| matrix * DVec3::from_array(at)).collect();
        for at in [[0.1, 0.2, 0.3], [0.0, 0.0, -0.4]] {
            assert!((solid.shape)(at).jacobian(&p).abs_diff_eq(matrix, 1e-14), "{kind:?}");
        }
    }
}
