//! Tetrahedra and hexahedra in one body.

use super::super::Trial;
use crate::error::Error;
use glam::{DMat3, DVec3};
use std::fmt::Write;

const CELLS: usize = 3;

/// H31.
pub fn mixed_patch(trial: &mut Trial<'_>) -> Result<(), Error> {
    let own = trial.configuration.elements_name();
    let (tets, hexes) = if trial.configuration.is_tets() { (own, "Hex8") } else { ("Tet4", own) };
    let set = format!("bodies.body.mesh=File(path: \"mixed.vtk\", tets: {tets}, hexes: {hexes})");
    let mut simulation = trial.start_beside("mixed.vtk", &mesh(), &[set])?;
    simulation.finish()?;
    let gradient =
        DMat3::from_cols(DVec3::new(0.1, -0.02, 0.0), DVec3::new(0.05, -0.1, 0.03), DVec3::new(0.0, 0.04, 0.2));
    let (rest, u) = (simulation.rest_positions("body")?, simulation.displacements("body")?);
    let off = rest.iter().zip(&u).fold(0.0_f64, |worst, (x, u)| worst.max((*u - gradient * *x).length()));
    let largest = u.iter().fold(0.0_f64, |largest, u| largest.max(u.length()));
    trial.most("nodes off the common gradient", off / largest, trial.bound(1e-6, 1e-4));
    Ok(())
}

/// Cells of a cube, every other one cut into six tetrahedra, its inner nodes moved: a VTK file.
fn mesh() -> String {
    let along = CELLS + 1;
    let node = |x: usize, y: usize, z: usize| x + along * (y + along * z);
    let mut points = String::new();
    for z in 0..along {
        for y in 0..along {
            for x in 0..along {
                let inside = [x, y, z].iter().all(|&i| i > 0 && i < CELLS);
                let moved = |i: usize| {
                    if inside { 0.2 * ((7 * x + 5 * y + 3 * z + 11 * i) % 5) as f64 / 5.0 - 0.1 } else { 0.0 }
                };
                let at = [x, y, z].map(|i| i as f64);
                let _ = writeln!(
                    points,
                    "{} {} {}",
                    0.01 * (at[0] + moved(0)),
                    0.01 * (at[1] + moved(1)),
                    0.01 * (at[2] + moved(2))
                );
            }
        }
    }
    let (mut cells, mut kinds, mut count, mut numbers) = (String::new(), String::new(), 0, 0);
    let mut add = |nodes: &[usize]| {
        let words: Vec<String> = nodes.iter().map(usize::to_string).collect();
        let _ = writeln!(cells, "{} {}", nodes.len(), words.join(" "));
        let _ = writeln!(kinds, "{}", if nodes.len() == 4 { 10 } else { 12 });
        (count, numbers) = (count + 1, numbers + 1 + nodes.len());
    };
    for cell in 0..CELLS.pow(3) {
        let (x, y, z) = (cell % CELLS, cell / CELLS % CELLS, cell / CELLS / CELLS);
        let corner = |a: usize, b: usize, c: usize| node(x + a, y + b, z + c);
        if (x + y + z) % 2 == 0 {
            let lower = [corner(0, 0, 0), corner(1, 0, 0), corner(1, 1, 0), corner(0, 1, 0)];
            let upper = [corner(0, 0, 1), corner(1, 0, 1), corner(1, 1, 1), corner(0, 1, 1)];
            add(&[lower, upper].concat());
        } else {
            // a tetrahedron for each way from one corner to the opposite one along three edges
            for (order, even) in [
                ([0, 1, 2], true),
                ([1, 2, 0], true),
                ([2, 0, 1], true),
                ([0, 2, 1], false),
                ([2, 1, 0], false),
                ([1, 0, 2], false),
            ] {
                let mut at = [0, 0, 0];
                let mut way = vec![corner(0, 0, 0)];
                for axis in order {
                    at[axis] = 1;
                    way.push(corner(at[0], at[1], at[2]));
                }
                if !even {
                    way.swap(1, 2);
                }
                add(&way);
            }
        }
    }
    let nodes = along.pow(3);
    format!(
        "# vtk DataFile Version 3.0\nmixed cells\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {nodes} double\n{points}CELLS {count} {numbers}\n{cells}CELL_TYPES {count}\n{kinds}"
    )
}
