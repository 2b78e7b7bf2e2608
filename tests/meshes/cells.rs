//! Cells of a mesh keep their order, are refined, written, read and refused, whatever their kind.

use super::topology::solids;
use glam::DVec3;
use sinew::mesh::topology::{CellKind, Listing, Topology};
use sinew::mesh::{Cells, Locator, Mesh};
use sinew::output::{Frame, write_gmsh, write_vtu};

/// Adds a cell of a kind that is known here only when the test runs.
fn push(cells: &mut Cells, kind: CellKind, nodes: &[u32]) {
    let done = match *nodes {
        [a, b, c, d] => cells.push(kind, [a, b, c, d]),
        [a, b, c, d, e, f] => cells.push(kind, [a, b, c, d, e, f]),
        [a, b, c, d, e, f, g, h] => cells.push(kind, [a, b, c, d, e, f, g, h]),
        [a, b, c, d, e, f, g, h, i, j] => cells.push(kind, [a, b, c, d, e, f, g, h, i, j]),
        _ => panic!("{kind:?} has {} nodes", nodes.len()),
    };
    done.unwrap();
}

/// A mesh of one cell of each kind, apart from each other.
fn one_of_each() -> Mesh {
    let mut mesh = Mesh::default();
    for (place, (kind, _, _, p)) in solids().into_iter().rev().enumerate() {
        let first = mesh.points.len() as u32;
        push(&mut mesh.cells, kind, &(first..first + p.len() as u32).collect::<Vec<_>>());
        mesh.points.extend(p.into_iter().map(|point| point + DVec3::X * 4.0 * place as f64));
    }
    mesh
}

#[test]
fn cells_of_every_kind_are_written_and_read() {
    let folder = tempfile::tempdir().unwrap();
    let mesh = one_of_each();
    let vtu = folder.path().join("all.vtu");
    let frame = Frame {
        time: 0.0,
        points: &mesh.points,
        cells: &mesh.cells,
        point_arrays: Vec::new(),
        cell_arrays: Vec::new(),
    };
    write_vtu(&vtu, &frame).unwrap();
    let msh = folder.path().join("all.msh");
    write_gmsh(&msh, &mesh).unwrap();
    for file in [vtu, msh] {
        let read = Mesh::read(&file, false).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!((&read.cells, &read.points, &read.notes), (&mesh.cells, &mesh.points, &Vec::new()), "{file:?}");
    }
}

#[test]
fn surfaces_places_and_parts_of_all_kinds_together() {
    let mut mesh = one_of_each();
    let kinds: Vec<CellKind> = mesh.cells.iter().map(|of| of.0).collect();
    assert!(kinds.is_sorted() && kinds.len() == CellKind::solids().count(), "{kinds:?}");
    let faces: usize = kinds.iter().map(|kind| kind.topology().faces.len()).sum();
    assert_eq!(mesh.surface().len(), faces);
    let volume = mesh.volume();
    let by_rows: f64 = (0..mesh.element_count())
        .map(|row| {
            let p: Vec<DVec3> = mesh.element(row).iter().map(|&node| mesh.points[node as usize]).collect();
            (mesh.cells.kind(row).topology().solid.unwrap().volume)(&p)
        })
        .sum();
    assert!((by_rows / volume - 1.0).abs() < 1e-14);
    assert!(mesh.soundness().is_sound(), "{:?}", mesh.soundness());
    for row in 0..mesh.element_count() {
        let nodes = mesh.element(row);
        let middle = nodes.iter().map(|&node| mesh.points[node as usize]).sum::<DVec3>() / nodes.len() as f64;
        assert_eq!(Locator::new(&mesh).locate(middle).map(|at| at.element), Some(row));
    }
    // inside out, all of them: found, and turned
    let whole = mesh.clone();
    for row in 0..mesh.element_count() {
        let turned = mesh.cells.kind(row).topology().solid.unwrap().turned;
        let nodes = turned.iter().map(|&place| mesh.element(row)[place]).collect::<Vec<_>>();
        mesh.cells.nodes_mut(row).copy_from_slice(&nodes);
    }
    assert_eq!(mesh.soundness().errors[0].ids.len(), mesh.element_count());
    let folder = tempfile::tempdir().unwrap();
    write_gmsh(&folder.path().join("turned.msh"), &mesh).unwrap();
    let read = Mesh::read(folder.path().join("turned.msh"), true).unwrap();
    assert_eq!(read.cells, whole.cells, "{:?}", read.notes);
}

/// The reference cell of a kind as a mesh.
fn reference_mesh(kind: CellKind) -> Mesh {
    let points: Vec<DVec3> = kind.topology().nodes.iter().map(|&at| DVec3::from_array(at)).collect();
    let mut mesh = Mesh { points, ..Mesh::default() };
    push(&mut mesh.cells, kind, &(0..mesh.points.len() as u32).collect::<Vec<_>>());
    mesh
}

#[test]
fn cells_of_every_kind_are_refined_or_refused() {
    for (kind, topology, _, p) in solids() {
        // with straight edges, which keep their volume
        let mut mesh = Mesh { points: straightened(topology, p), ..reference_mesh(kind) };
        mesh.element_sets.insert("all".into(), vec![0]);
        mesh.element_vectors.insert("along".into(), vec![DVec3::X]);
        mesh.element_ids = sinew::mesh::Ids::Named(vec![17]);
        let (volume, refined) = (mesh.volume(), mesh.refine(1));
        let Some(split) = topology.split else {
            assert!(refined.unwrap_err().to_string().contains(topology.plural), "{kind:?}");
            continue;
        };
        refined.unwrap();
        let parts = split.count();
        let faces: usize = topology.faces.iter().map(|face| face.kind.topology().split.unwrap().count()).sum();
        assert_eq!((mesh.element_count(), mesh.surface().len()), (parts, faces), "{kind:?}");
        assert!((mesh.volume() / volume - 1.0).abs() < 1e-13 && mesh.soundness().is_sound(), "{kind:?}");
        assert_eq!(mesh.element_sets["all"], (0..parts as u32).collect::<Vec<_>>());
        assert_eq!(mesh.element_vectors["along"], vec![DVec3::X; parts]);
        assert_eq!(mesh.element_ids, sinew::mesh::Ids::Named(vec![17; parts]));
    }
    for kind in [CellKind::Tet4, CellKind::Hex8, CellKind::Wedge6, CellKind::Tet10] {
        assert_eq!(kind.topology().split.map(|split| split.count()), Some(8), "{kind:?}");
    }
}

#[test]
fn a_tetrahedron_of_second_order_is_cut_at_its_middles() {
    let mut mesh = reference_mesh(CellKind::Tet10);
    mesh.points[4] = DVec3::new(0.5, -0.05, 0.0);
    mesh.face_sets.insert("bottom".into(), vec![[0, 2, 1, 1]]);
    mesh.node_sets.insert("bottom".into(), vec![0, 1, 2, 4, 5, 6]);
    mesh.node_sets.insert("edge".into(), vec![0, 1, 4]);
    mesh.refine(1).unwrap();
    // ten nodes, two on each half of the six edges, three between the middles of each of four faces, and one inside
    assert_eq!((mesh.element_count(), mesh.points.len()), (8, 10 + 12 + 12 + 1));
    assert!(mesh.soundness().is_sound(), "{:?}", mesh.soundness());
    let faces = &mesh.face_sets["bottom"];
    let corners: std::collections::BTreeSet<u32> = faces.iter().flatten().copied().collect();
    assert_eq!((faces.len(), corners), (4, (0..7).filter(|&node| node != 3).collect()));
    let height = |node: &u32| mesh.points[*node as usize].z;
    assert_eq!(mesh.node_sets["bottom"].len(), 15);
    assert!(mesh.node_sets["bottom"].iter().all(|node| height(node) == 0.0));
    // what is new on the edge is halfway between nodes of it
    let mut edge: Vec<f64> = mesh.node_sets["edge"].iter().map(|&node| mesh.points[node as usize].x).collect();
    edge.sort_by(f64::total_cmp);
    assert_eq!(edge, [0.0, 0.25, 0.5, 0.75, 1.0]);
}

/// With the middles of edges halfway between their ends.
fn straightened(topology: &Topology, mut p: Vec<DVec3>) -> Vec<DVec3> {
    for (node, [a, b]) in (topology.corners..topology.nodes.len()).zip(topology.edges) {
        p[node] = 0.5 * (p[*a] + p[*b]);
    }
    p
}

/// A file as Gmsh writes it with elements of second order: faces and lines with names are sets, with their middles.
#[test]
fn a_gmsh_file_of_second_order_has_its_sets_and_is_written_so() {
    let text = r#"$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
3
1 1 "edge"
2 2 "bottom"
3 3 "all"
$EndPhysicalNames
$Nodes
10
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
5 0.5 0 0
6 0.5 0.5 0
7 0 0.5 0
8 0 0 0.5
9 0 0.5 0.5
10 0.5 0 0.5
$EndNodes
$Elements
3
1 8 2 1 1 1 2 5
2 9 2 2 2 1 3 2 7 6 5
3 11 2 3 3 1 2 3 4 5 6 7 8 9 10
$EndElements
"#;
    let read = |text: &[u8]| Mesh::from_bytes("second.msh", text, false).unwrap_or_else(|error| panic!("{error}"));
    let mesh = read(text.as_bytes());
    // the last two middles are the other way round
    assert_eq!(mesh.cells.of_kind(CellKind::Tet10).unwrap(), [[0, 1, 2, 3, 4, 5, 6, 7, 9, 8]]);
    assert_eq!(mesh.face_sets["bottom"], [[0, 2, 1, 1]]);
    assert_eq!((&mesh.node_sets["edge"][..], &mesh.node_sets["bottom"][..]), (&[0, 1, 4][..], &[0, 1, 2, 4, 5, 6][..]));
    assert_eq!(mesh.element_sets["all"], [0]);
    assert!(mesh.notes.is_empty() && mesh.soundness().is_sound(), "{:?}", mesh.notes);
    assert!((mesh.volume() - 1.0 / 6.0).abs() < 1e-15);
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("again.msh");
    write_gmsh(&file, &mesh).unwrap();
    let written = std::fs::read(&file).unwrap();
    assert!(
        String::from_utf8_lossy(&written).contains(" 9 2 2 2 1 3 2 7 6 5\n"),
        "{}",
        String::from_utf8_lossy(&written)
    );
    let again = read(&written);
    assert_eq!((&again.cells, &again.points, &again.face_sets), (&mesh.cells, &mesh.points, &mesh.face_sets));
    assert_eq!(again.node_sets["bottom"], mesh.node_sets["bottom"]);
}

/// A curved edge may fold a cell whose corners are sound.
#[test]
fn a_cell_that_its_edges_fold_is_refused() {
    let mut mesh = reference_mesh(CellKind::Tet10);
    mesh.points[4] = DVec3::new(0.5, -0.05, 0.0);
    assert!(mesh.soundness().is_sound(), "{:?}", mesh.soundness());
    mesh.points[4] = DVec3::new(0.5, 0.6, 0.0);
    let errors = mesh.soundness().errors;
    assert!(errors.len() == 1 && errors[0].to_string().contains("folded where its edges curve"), "{errors:?}");
}

/// Two cells of second order share a face; one of first order at the same corners does not.
#[test]
fn faces_of_second_order_are_inside_or_surface() {
    let mut mesh = reference_mesh(CellKind::Tet10);
    mesh.points.extend([DVec3::new(0.0, 0.0, -1.0), DVec3::new(0.0, 0.0, -0.5), DVec3::new(0.5, 0.0, -0.5)]);
    mesh.points.push(DVec3::new(0.0, 0.5, -0.5));
    let mut other = mesh.clone();
    push(&mut mesh.cells, CellKind::Tet10, &[0, 2, 1, 10, 6, 5, 4, 11, 13, 12]);
    assert_eq!(mesh.surface().len(), 6);
    assert!(mesh.soundness().is_sound(), "{:?}", mesh.soundness());
    let face = mesh.surface()[0];
    assert_eq!((face.corners().len(), face.all_nodes().count(), face.triangles().count()), (3, 6, 4));
    push(&mut other.cells, CellKind::Tet4, &[0, 2, 1, 10]);
    assert_eq!(other.surface().len(), 8);
}

#[test]
fn a_tetrahedron_and_a_hexahedron_are_cut_as_ever() {
    // rows of new points and of parts are what scenes, snapshots and probes count on
    let mut tet = reference_mesh(CellKind::Tet4);
    tet.refine(1).unwrap();
    let middle = |a: usize, b: usize| (tet.points[a] + tet.points[b]) / 2.0;
    let edges = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];
    assert_eq!(tet.points[4..], edges.map(|(a, b)| middle(a, b)));
    let parts = [
        [0, 4, 5, 6],
        [4, 1, 7, 8],
        [5, 7, 2, 9],
        [6, 8, 9, 3],
        [4, 9, 5, 6],
        [4, 9, 6, 8],
        [4, 9, 8, 7],
        [4, 9, 7, 5],
    ];
    assert_eq!(tet.cells.of_kind(CellKind::Tet4).unwrap(), parts);
    let mut hex = reference_mesh(CellKind::Hex8);
    hex.refine(1).unwrap();
    let parts = [
        [0, 8, 10, 9, 13, 14, 17, 16],
        [8, 1, 11, 10, 14, 15, 18, 17],
        [10, 11, 2, 12, 17, 18, 21, 20],
        [9, 10, 12, 3, 16, 17, 20, 19],
        [13, 14, 17, 16, 4, 22, 24, 23],
        [14, 15, 18, 17, 22, 5, 25, 24],
        [17, 18, 21, 20, 24, 25, 6, 26],
        [16, 17, 20, 19, 23, 24, 26, 7],
    ];
    assert_eq!(hex.cells.of_kind(CellKind::Hex8).unwrap(), parts);
    assert_eq!(hex.points[17], DVec3::ZERO);
    assert_eq!((hex.points[10], hex.points[18]), (DVec3::NEG_Z, DVec3::X));
}

#[test]
fn flat_cells_and_wrong_numbers_of_nodes_are_refused() {
    let mut cells = Cells::default();
    let error = cells.push(CellKind::Triangle, [0, 1, 2]).unwrap_err().to_string();
    assert!(error.contains("a kind of triangles") && error.contains("tetrahedra, hexahedra, wedges"), "{error}");
    let error = cells.push(CellKind::Hex8, [0, 1, 2, 3]).unwrap_err().to_string();
    assert!(error.contains("given by 4 nodes; hexahedra have 8"), "{error}");
    assert!(Cells::of(CellKind::Quad, &[[0, 1, 2, 3]]).is_err() && cells.is_empty());
    cells.push(CellKind::Tet4, [0, 1, 2, 3]).unwrap();
    assert_eq!(cells.of_kind::<8>(CellKind::Tet4), None);
    assert_eq!(cells.of_kind::<8>(CellKind::Hex8), Some(&[][..]));
    let mesh = Mesh { points: vec![DVec3::ZERO; 4], cells, ..Mesh::default() };
    assert_eq!((mesh.corners::<4>(0), mesh.corners::<3>(0)), (Some([DVec3::ZERO; 4]), None));
}

#[test]
fn files_have_the_numbers_and_the_orders_of_their_formats() {
    // places in reference cells in the order in which the formats list them: vtkCell.h's types with the parametric
    // coordinates of the classes (0 to 1), and "Node ordering" and "MSH file format" of Gmsh's manual (-1 to 1 for
    // hexahedra)
    type Places = &'static [[i8; 3]];
    /// A kind with its numbers and orders in VTK files, and those in Gmsh files.
    type Known<'a> = (CellKind, &'a [(u8, Places)], (u8, Places));
    const SQUARE: Places = &[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]];
    const TET: Places = &[[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]];
    const CUBE: Places = &[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];
    // vtkWedge: the first triangle's normal points out of it
    const PRISM: Places = &[[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1]];
    const VTK_WEDGE: Places = &[[0, 0, 0], [0, 1, 0], [1, 0, 0], [0, 0, 1], [0, 1, 1], [1, 0, 1]];
    const PIXEL: Places = &[[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]];
    const VOXEL: Places = &[[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1], [1, 1, 1]];
    // of second order in halves
    const LINE3: Places = &[[0, 0, 0], [2, 0, 0], [1, 0, 0]];
    const TRIANGLE6: Places = &[[0, 0, 0], [2, 0, 0], [0, 2, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]];
    const TET10: Places =
        &[[0, 0, 0], [2, 0, 0], [0, 2, 0], [0, 0, 2], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1]];
    const GMSH_TET10: Places =
        &[[0, 0, 0], [2, 0, 0], [0, 2, 0], [0, 0, 2], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [0, 1, 1], [1, 0, 1]];
    let known: [Known<'_>; 10] = [
        (CellKind::Point, &[(1, &[[0; 3]])], (15, &[[0; 3]])),
        (CellKind::Line, &[(3, &[[0, 0, 0], [1, 0, 0]])], (1, &[[0, 0, 0], [1, 0, 0]])),
        (CellKind::Triangle, &[(5, TET.split_at(3).0)], (2, TET.split_at(3).0)),
        (CellKind::Quad, &[(9, SQUARE), (8, PIXEL)], (3, SQUARE)),
        (CellKind::Tet4, &[(10, TET)], (4, TET)),
        (CellKind::Hex8, &[(12, CUBE), (11, VOXEL)], (5, CUBE)),
        (CellKind::Wedge6, &[(13, VTK_WEDGE)], (6, PRISM)),
        (CellKind::Line3, &[(21, LINE3)], (8, LINE3)),
        (CellKind::Triangle6, &[(22, TRIANGLE6)], (9, TRIANGLE6)),
        (CellKind::Tet10, &[(24, TET10)], (11, GMSH_TET10)),
    ];
    assert_eq!(known.map(|of| of.0), CellKind::ALL);
    for (kind, vtk, gmsh) in known {
        let topology = kind.topology();
        // along lines, quadrilaterals, hexahedra and wedges' axes they are here twice as long, about the origin
        let least = |axis: usize| topology.nodes.iter().fold(0.0, |least: f64, x| least.min(x[axis]));
        let place = |node: usize| {
            [0, 1, 2].map(|axis| match topology.nodes[node][axis] {
                x if least(axis) < 0.0 => (x + 1.0) / 2.0,
                x => x,
            })
        };
        let unit = if topology.nodes.len() > topology.corners { 2.0 } else { 1.0 };
        let check = |listing: &Listing, (number, places): (u8, Places)| {
            let used = |axis: usize| axis < usize::from(topology.dimension);
            let nodes: Vec<usize> = (0..topology.nodes.len()).collect();
            let listed: Vec<[i8; 3]> = listing
                .write(&nodes)
                .map(|node| {
                    let place = place(node);
                    [0, 1, 2].map(|axis| if used(axis) { (unit * place[axis]) as i8 } else { 0 })
                })
                .collect();
            assert_eq!((listing.number, &listed[..]), (number, places), "{kind:?}");
        };
        assert_eq!(topology.vtk.len(), vtk.len(), "{kind:?}");
        topology.vtk.iter().zip(vtk).for_each(|(listing, of)| check(listing, *of));
        check(&topology.gmsh, gmsh);
    }
}

#[test]
fn rows_count_kind_by_kind_in_the_order_of_adding() {
    let mut cells = Cells::default();
    let hex = |first: u32| [0, 1, 2, 3, 4, 5, 6, 7].map(|node| first + node);
    cells.push(CellKind::Hex8, hex(0)).unwrap();
    cells.push(CellKind::Tet4, [3, 4, 5, 6]).unwrap();
    cells.push(CellKind::Hex8, hex(8)).unwrap();
    cells.push(CellKind::Tet4, [0, 1, 2, 3]).unwrap();
    let nodes: Vec<&[u32]> = (0..cells.len()).map(|row| cells.nodes(row)).collect();
    assert_eq!(nodes, [&[3, 4, 5, 6][..], &[0, 1, 2, 3], &hex(0), &hex(8)]);
    assert_eq!((cells.first(CellKind::Hex8), cells.first(CellKind::Tet4), cells.count(CellKind::Hex8)), (2, 0, 2));
    assert!(cells.iter().map(|of| of.1).eq(nodes.iter().copied()));
    assert!(cells.all_nodes().eq(nodes.iter().flat_map(|nodes| nodes.iter().copied())));
    let some = cells.select([1, 2], |node| node + 10);
    assert_eq!(some.iter().map(|of| of.1.to_vec()).collect::<Vec<_>>(), [vec![10, 11, 12, 13], hex(10).to_vec()]);
    let mut twice = cells.clone();
    twice.extend_moved(&some, 1);
    assert_eq!((twice.nodes(2), twice.nodes(5)), (&[11, 12, 13, 14][..], &hex(11)[..]));
    assert!(twice != cells && cells == cells.clone());
    assert_eq!((cells.iter().len(), (&cells).into_iter().count()), (4, 4));
    let mut both = some.clone();
    both.extend([&some, &some]);
    assert_eq!((both.len(), both.nodes(1)), (6, some.nodes(0)));
}
