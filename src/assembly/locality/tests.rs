#![allow(clippy::expect_used)]

use super::*;
use crate::components::GROUP_ROWS;
use crate::mesh::{ElementKind, generators::box_mesh};

#[test]
fn every_node_and_element_keeps_its_place_once() {
    let mesh = box_mesh(DVec3::new(1.0, 2.0, 3.0), (3, 4, 5), ElementKind::Tet4).expect("a box");
    let order = element_order(&mesh, (0..mesh.element_count() as u32).collect(), 1, 128);
    let mut sorted = order.clone();
    sorted.sort_unstable();
    assert!(sorted.iter().enumerate().all(|(i, &e)| i as u32 == e));
    let patches = order.chunks(128).map(|patch| patch.iter().map(|&e| mesh.element(e as usize)));
    let mut rows = node_rows(mesh.points.len() + 2, patches, &[]);
    assert!(rows[mesh.points.len()..].iter().all(|&row| row as usize >= mesh.points.len()));
    rows.sort_unstable();
    assert!(rows.iter().enumerate().all(|(i, &row)| i as u32 == row));
}

#[test]
fn neighbours_lie_nearer_than_in_a_shuffled_file() {
    let mesh = box_mesh(DVec3::ONE, (12, 12, 12), ElementKind::Hex8).expect("a box");
    let shuffled: Vec<u32> = (0..1728_u32).map(|i| i * 1009 % 1728).collect();
    let order = element_order(&mesh, shuffled.clone(), 1, 1728);
    let spread = |order: &[u32]| {
        let rows = node_rows(mesh.points.len(), std::iter::once(order.iter().map(|&e| mesh.element(e as usize))), &[]);
        let width = |&e: &u32| {
            let of = mesh.element(e as usize).iter().map(|&n| rows[n as usize]);
            of.clone().max().unwrap_or(0) - of.min().unwrap_or(0)
        };
        order.iter().map(width).sum::<u32>() as f64 / 1728.0
    };
    assert!(spread(&order) < 0.3 * spread(&shuffled), "{} against {}", spread(&order), spread(&shuffled));
}

/// 20³ cells: patches of 224 hexahedra had 397 nodes along Morton's curve; a cube of as many has 357.
#[test]
fn patches_are_compact_and_their_inner_nodes_come_first() {
    let mesh = box_mesh(DVec3::ONE, (20, 20, 20), ElementKind::Hex8).expect("a box");
    let order = element_order(&mesh, (0..8000).collect(), 1, 224);
    let patches = || order.chunks(224).map(|patch| patch.iter().map(|&e| mesh.element(e as usize)));
    let rows = node_rows(mesh.points.len(), patches(), &[]);
    let mut of_patches: Vec<Vec<u32>> = patches().map(|p| p.flatten().map(|&n| rows[n as usize]).collect()).collect();
    let mut patches_of = vec![0; rows.len()];
    for nodes in &mut of_patches {
        nodes.sort_unstable();
        nodes.dedup();
        nodes.iter().for_each(|&row| patches_of[row as usize] += 1);
    }
    let mean = of_patches.iter().map(Vec::len).sum::<usize>() as f64 / of_patches.len() as f64;
    assert!(mean < 370.0, "{mean} nodes a patch");
    let mut next = 0;
    for nodes in &of_patches {
        let inside = nodes.iter().filter(|&&row| patches_of[row as usize] == 1).count();
        assert!(inside >= GROUP_ROWS, "{inside}");
        assert!(nodes[..inside].iter().zip(next..).all(|(&row, wanted)| row == wanted));
        next += inside as u32;
    }
    assert!(patches_of[next as usize..].iter().all(|&patches| patches > 1));
}

/// Of a body whose surface may meet others nodes of the surface follow the others inside their patch, and those that
/// patches share follow all others.
#[test]
fn nodes_of_surfaces_follow_those_inside_their_patch() {
    let mesh = box_mesh(DVec3::ONE, (20, 20, 20), ElementKind::Hex8).expect("a box");
    let order = element_order(&mesh, (0..8000).collect(), 1, 224);
    let patches = || order.chunks(224).map(|patch| patch.iter().map(|&e| mesh.element(e as usize)));
    let is_on_surface = |node: &usize| mesh.points[*node].to_array().iter().any(|x| *x < 1e-9 || *x > 1.0 - 1e-9);
    let apart: Vec<u32> = (0..mesh.points.len()).filter(is_on_surface).map(|node| node as u32).collect();
    let rows = node_rows(mesh.points.len(), patches(), &apart);
    let (mut patches_of, mut is_apart) = (vec![0; rows.len()], vec![false; rows.len()]);
    apart.iter().for_each(|&node| is_apart[rows[node as usize] as usize] = true);
    let mut of_patches: Vec<Vec<u32>> = patches().map(|p| p.flatten().map(|&n| rows[n as usize]).collect()).collect();
    for nodes in &mut of_patches {
        nodes.sort_unstable();
        nodes.dedup();
        nodes.iter().for_each(|&row| patches_of[row as usize] += 1);
    }
    let (mut next, mut with_both) = (0, 0);
    for nodes in &of_patches {
        let inside = |apart: bool| {
            let is_inside = |row: usize| patches_of[row] == 1 && is_apart[row] == apart;
            nodes.iter().filter(|&&row| is_inside(row as usize)).count()
        };
        let [free, of_surface] = inside_of([inside(false), inside(true)]);
        let own = next..next + (free + of_surface) as u32;
        assert!(nodes.iter().zip(own.clone()).all(|(&row, wanted)| row == wanted), "{free}, {of_surface}");
        assert!(free == 0 || own.clone().all(|row| is_apart[row as usize] == (row - next >= free as u32)));
        with_both += usize::from(free > 0 && of_surface > 0);
        next = own.end;
    }
    assert!(with_both > 20 && is_apart[next as usize..].is_sorted() && is_apart[rows.len() - 1], "{with_both}");
}

/// Copies in the same place are not mixed: each has the order of the first.
#[test]
fn copies_follow_one_another() {
    let mut copies = box_mesh(DVec3::ONE, (3, 3, 3), ElementKind::Hex8).expect("a box");
    copies.repeat(3, DVec3::ZERO);
    let order = element_order(&copies, (0..81).rev().collect(), 3, 32);
    let copy_of = |&element: &u32| element / 27;
    assert!(order.is_sorted_by_key(copy_of), "{order:?}");
}
