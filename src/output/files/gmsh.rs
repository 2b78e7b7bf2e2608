//! A mesh as a Gmsh file (format 2.2, text): the format that holds all that a mesh of sinew has, named sets of points,
//! faces and elements, numbers, and vectors of elements, and that other programs read.

use crate::mesh::{CellKind, Mesh, nodes_of_face};
use crate::output::{OutputError, replace};
use std::collections::BTreeSet;
use std::fs::File;
use std::io::{BufWriter, Result, Write};
use std::path::Path;

/// Writes a mesh; the file appears when it is complete. Numbers are written with as many digits as give each back
/// exactly.
///
/// # Errors
/// What the system says.
pub fn write(path: &Path, mesh: &Mesh) -> std::result::Result<(), OutputError> {
    replace(path, |file| write_to(file, mesh).map_err(OutputError::system("write", path)))
}

/// A named set: its dimension, its number, and its cells as kind and rows of points; those of elements as their rows.
struct Group<'a> {
    name: &'a str,
    dimension: u8,
    cells: Vec<(CellKind, Vec<u32>)>,
    elements: &'a [u32],
}

fn groups(mesh: &Mesh) -> Vec<Group<'_>> {
    let mut all = Vec::new();
    for (name, elements) in &mesh.element_sets {
        all.push(Group { name, dimension: 3, cells: Vec::new(), elements });
    }
    let middles = mesh.middles();
    for (name, faces) in &mesh.face_sets {
        let cell = |face: &[u32; 4]| {
            let kind = CellKind::of_face(face);
            let mut nodes = nodes_of_face(face, &middles);
            if kind == CellKind::Triangle && nodes.len() == CellKind::Triangle6.node_count() {
                return (CellKind::Triangle6, nodes);
            }
            nodes.truncate(kind.node_count());
            (kind, nodes)
        };
        all.push(Group { name, dimension: 2, cells: faces.iter().map(cell).collect(), elements: &[] });
    }
    for (name, nodes) in &mesh.node_sets {
        // faces and elements of the name bring their points
        let faces = mesh.face_sets.get(name).into_iter().flatten().flat_map(|face| nodes_of_face(face, &middles));
        let elements = mesh.element_sets.get(name).into_iter().flatten();
        let brought: BTreeSet<u32> = faces.chain(elements.flat_map(|&e| mesh.element(e as usize)).copied()).collect();
        let left: Vec<(CellKind, Vec<u32>)> =
            nodes.iter().filter(|node| !brought.contains(node)).map(|&node| (CellKind::Point, vec![node])).collect();
        if !left.is_empty() {
            all.push(Group { name, dimension: 0, cells: left, elements: &[] });
        }
    }
    all
}

fn write_to(file: &mut BufWriter<File>, mesh: &Mesh) -> Result<()> {
    let groups = groups(mesh);
    writeln!(file, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n{}", groups.len())?;
    for (place, group) in groups.iter().enumerate() {
        writeln!(file, "{} {} \"{}\"", group.dimension, place + 1, group.name)?;
    }
    writeln!(file, "$EndPhysicalNames\n$Nodes\n{}", mesh.points.len())?;
    for (row, point) in mesh.points.iter().enumerate() {
        writeln!(file, "{} {:?} {:?} {:?}", mesh.point_ids.of(row), point.x, point.y, point.z)?;
    }
    writeln!(file, "$EndNodes\n$Elements\n{}", cell_count(mesh, &groups))?;
    for row in 0..mesh.element_count() {
        write_element(file, mesh, row, 0)?;
    }
    let last = (0..mesh.element_count()).map(|row| mesh.element_ids.of(row)).max().unwrap_or(0);
    let mut number = last;
    for (place, group) in groups.iter().enumerate() {
        for &row in group.elements {
            // once more, for the group
            write_element(file, mesh, row as usize, place + 1)?;
        }
        for (kind, rows) in &group.cells {
            number += 1;
            write_cell(file, mesh, (number, *kind, place + 1), rows)?;
        }
    }
    writeln!(file, "$EndElements")?;
    for (name, vectors) in &mesh.element_vectors {
        writeln!(file, "$ElementData\n1\n\"{name}\"\n1\n0\n3\n0\n3\n{}", vectors.len())?;
        for (row, v) in vectors.iter().enumerate() {
            writeln!(file, "{} {:?} {:?} {:?}", mesh.element_ids.of(row), v.x, v.y, v.z)?;
        }
        writeln!(file, "$EndElementData")?;
    }
    Ok(())
}

fn cell_count(mesh: &Mesh, groups: &[Group<'_>]) -> usize {
    mesh.element_count() + groups.iter().map(|group| group.cells.len() + group.elements.len()).sum::<usize>()
}

fn write_element(file: &mut BufWriter<File>, mesh: &Mesh, row: usize, group: usize) -> Result<()> {
    write_cell(file, mesh, (mesh.element_ids.of(row), mesh.cells.kind(row), group), mesh.element(row))
}

fn write_cell(
    file: &mut BufWriter<File>,
    mesh: &Mesh,
    (number, kind, group): (u64, CellKind, usize),
    rows: &[u32],
) -> Result<()> {
    let listing = &kind.topology().gmsh;
    write!(file, "{number} {} 2 {group} {group}", listing.number)?;
    for row in listing.write(rows) {
        write!(file, " {}", mesh.point_ids.of(row as usize))?;
    }
    writeln!(file)
}
