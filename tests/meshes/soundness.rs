//! What is said about meshes that are wrong in one way each.

use crate::readers::read_turning;
use glam::DVec3;
use sinew::mesh::generators::box_mesh;
use sinew::mesh::soundness::{Defect, Finding};
use sinew::mesh::{CellKind, ElementKind, Ids, Mesh};

fn cube(kind: ElementKind) -> Mesh {
    box_mesh(DVec3::ONE, (2, 2, 2), kind).unwrap()
}

/// The only error.
fn error(mesh: &Mesh) -> Finding {
    let soundness = mesh.soundness();
    assert_eq!(soundness.errors.len(), 1, "{soundness:#?}");
    soundness.errors[0].clone()
}

#[track_caller]
fn says(mesh: &Mesh, defect: Defect, ids: &[u64], text: &str) {
    let finding = error(mesh);
    assert_eq!((finding.defect, &finding.ids[..]), (defect, ids), "{finding}");
    assert!(finding.to_string().contains(text), "found    {finding}\nexpected {text}");
}

#[test]
fn inverted_elements_are_listed_with_their_volumes() {
    let mut mesh = cube(ElementKind::Tet4);
    mesh.element_ids = Ids::Named((100..148).collect());
    mesh.cells.nodes_mut(3).swap(0, 1);
    mesh.cells.nodes_mut(20).swap(2, 3);
    let text = "2 inverted elements: 103 (volume -2.08e-2 m³), 120 (volume -2.08e-2 m³); list their nodes in the other order, \
                or set flip_inverted: true";
    says(&mesh, Defect::Inverted, &[103, 120], text);
    for row in 0..mesh.cells.len() {
        mesh.cells.nodes_mut(row).swap(0, 1);
    }
    assert!(
        error(&mesh).to_string().contains("46 inverted elements") && error(&mesh).to_string().contains(" and 36 more")
    );
}

#[test]
fn a_hexahedron_folded_at_one_corner_is_inverted() {
    let mut mesh = box_mesh(DVec3::ONE, (1, 1, 1), ElementKind::Hex8).unwrap();
    mesh.points[7] = DVec3::new(0.3, 0.3, 0.3);
    says(&mesh, Defect::Inverted, &[0], "1 inverted element: 0 (folded at a corner)");
}

#[test]
fn flat_elements_are_refused() {
    let mut mesh = cube(ElementKind::Tet4);
    let [a, b, c, _] = mesh.cells.of_kind(CellKind::Tet4).unwrap()[0];
    mesh.points.push((mesh.points[a as usize] + mesh.points[b as usize]) / 2.0);
    mesh.cells.push(CellKind::Tet4, [a, b, c, mesh.points.len() as u32 - 1]).unwrap();
    says(&mesh, Defect::Flat, &[48], "1 element without volume: 48 (volume 0.00e0 m³, longest edge 7.07e-1 m)");
}

#[test]
fn slivers_are_warned_of_worst_first() {
    let mut mesh = box_mesh(DVec3::new(1.0, 1.0, 1e-6), (1, 1, 1), ElementKind::Tet4).unwrap();
    assert!(mesh.soundness().is_sound());
    let warning = mesh.soundness().warnings[0].clone();
    assert_eq!(warning.defect, Defect::Sliver);
    assert!(warning.to_string().starts_with("6 very thin elements: "), "{warning}");
    mesh.place(1e-3, DVec3::ZERO, DVec3::ZERO).unwrap();
    assert!(mesh.soundness().is_sound(), "flatness does not depend on the unit");
}

#[test]
fn wrong_rows_points_and_sets_are_each_named() {
    let mut mesh = cube(ElementKind::Hex8);
    mesh.cells.nodes_mut(2)[5] = 99;
    says(
        &mesh,
        Defect::OutOfRange,
        &[2],
        "1 element names a point that is not there: 2 (row 99); points have the rows 0 to 26",
    );
    let mut mesh = cube(ElementKind::Hex8);
    let twice = mesh.element(2)[4];
    mesh.cells.nodes_mut(2)[5] = twice;
    says(&mesh, Defect::RepeatedNode, &[2], "1 element names a point twice: 2 (point 12)");
    let mut mesh = cube(ElementKind::Tet4);
    let again = mesh.cells.of_kind::<4>(CellKind::Tet4).unwrap()[4];
    mesh.cells.push(CellKind::Tet4, again).unwrap();
    says(&mesh, Defect::RepeatedElement, &[48], "1 pair of elements with the same points: 4 and 48; keep one of each");
    let mut mesh = cube(ElementKind::Tet4);
    mesh.points[13].y = f64::NAN;
    says(&mesh, Defect::NotFinite, &[13], "1 point without finite coordinates: 13 [0.5, NaN, 0.5]");
    let mut mesh = cube(ElementKind::Tet4);
    mesh.node_sets.insert("top".into(), vec![27]);
    says(&mesh, Defect::Misfit, &[], "the node set `top` names point row 27: rows are below 27");
    says(&Mesh::default(), Defect::Empty, &[], "there are no elements");
}

#[test]
fn all_findings_are_reported_at_once() {
    let mut mesh = cube(ElementKind::Tet4);
    mesh.cells.nodes_mut(0)[0] = 1000;
    mesh.cells.nodes_mut(1).swap(0, 1);
    let twice = mesh.element(2)[0];
    mesh.cells.nodes_mut(2)[1] = twice;
    mesh.points.extend([mesh.points[0], DVec3::INFINITY]);
    let soundness = mesh.soundness();
    let defects: Vec<Defect> = soundness.errors.iter().map(|finding| finding.defect).collect();
    assert_eq!(defects, [Defect::NotFinite, Defect::OutOfRange, Defect::RepeatedNode, Defect::Inverted]);
    let warnings: Vec<String> = soundness.warnings.iter().map(ToString::to_string).collect();
    assert!(warnings[0].starts_with("2 points of no element: 27, 28; without mass"), "{warnings:?}");
    assert!(warnings[1].starts_with("1 pair of points in the same place: 0 and 27"), "{warnings:?}");
    let text = mesh.require_sound("a.msh").unwrap_err().to_string();
    assert_eq!(text.lines().count(), 5, "{text}");
}

const TWO: &str = "$NOD\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 0 0 -1\n$ENDNOD\n$ELM\n2\n";

#[test]
fn a_file_inside_out_is_turned_with_a_note() {
    let text = format!("{TWO}1 4 0 0 4 1 3 2 4\n2 4 0 0 4 1 2 3 5\n$ENDELM\n");
    let mesh = read_turning("a.msh", text.as_bytes(), false).unwrap();
    assert!((mesh.volume() - 1.0 / 3.0).abs() < 1e-15);
    assert_eq!(mesh.notes, ["the file lists the nodes of all 2 tetrahedra in the other order; they were turned"]);
}

#[test]
fn single_inverted_elements_are_turned_on_request_only() {
    let text = format!("{TWO}1 4 0 0 4 1 2 3 4\n2 4 0 0 4 1 2 3 5\n$ENDELM\n");
    let error = read_turning("a.msh", text.as_bytes(), false).unwrap_err().to_string();
    assert!(error.contains("1 inverted element: 2 (volume -1.67e-1 m³)"), "{error}");
    let mesh = read_turning("a.msh", text.as_bytes(), true).unwrap();
    assert!((mesh.volume() - 1.0 / 3.0).abs() < 1e-15);
    assert_eq!(mesh.notes, ["1 of 2 tetrahedra were inverted and have been turned (flip_inverted)"]);
}

#[test]
fn repeated_element_numbers_are_replaced_with_a_note() {
    let text = format!("{TWO}44 4 0 0 4 1 2 3 4\n44 4 0 0 4 1 3 2 5\n$ENDELM\n");
    let mesh = read_turning("a.msh", text.as_bytes(), false).unwrap();
    assert_eq!(mesh.element_ids, Ids::Named(vec![1, 2]));
    assert!(mesh.notes[0].starts_with("element numbers repeat (44: 2 times)"), "{:?}", mesh.notes);
}
