//! Meshes of cells, as text: hexahedra, or six tetrahedra each.

use sinew::mesh::CellKind;
use std::fmt::Write;

/// A VTK file of so many cells along each axis, of corners at given places (m).
pub fn vtk(count: [usize; 3], place: impl Fn([usize; 3]) -> [f64; 3], is_hex: impl Fn([usize; 3]) -> bool) -> String {
    let along = count.map(|count| count + 1);
    let node = |[x, y, z]: [usize; 3]| x + along[0] * (y + along[1] * z);
    let mut points = String::new();
    for number in 0..along.iter().product() {
        let at = place([number % along[0], number / along[0] % along[1], number / along[0] / along[1]]);
        let _ = writeln!(points, "{} {} {}", at[0], at[1], at[2]);
    }
    let (mut cells, mut kinds, mut elements, mut numbers) = (String::new(), String::new(), 0, 0);
    let mut add = |nodes: &[usize]| {
        let words: Vec<String> = nodes.iter().map(usize::to_string).collect();
        let _ = writeln!(cells, "{} {}", nodes.len(), words.join(" "));
        let kind = if nodes.len() == 4 { CellKind::Tet4 } else { CellKind::Hex8 };
        let _ = writeln!(kinds, "{}", kind.topology().vtk[0].number);
        (elements, numbers) = (elements + 1, numbers + 1 + nodes.len());
    };
    for cell in 0..count.iter().product() {
        let [x, y, z] = [cell % count[0], cell / count[0] % count[1], cell / count[0] / count[1]];
        let corner = |[a, b, c]: [usize; 3]| node([x + a, y + b, z + c]);
        if is_hex([x, y, z]) {
            let round = [[0, 0], [1, 0], [1, 1], [0, 1]];
            let nodes: Vec<usize> = [0, 1].iter().flat_map(|&c| round.map(|[a, b]| corner([a, b, c]))).collect();
            add(&nodes);
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
                let mut way = vec![corner(at)];
                for axis in order {
                    at[axis] = 1;
                    way.push(corner(at));
                }
                if !even {
                    way.swap(1, 2);
                }
                add(&way);
            }
        }
    }
    let nodes: usize = along.iter().product();
    format!(
        "# vtk DataFile Version 3.0\ncells\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {nodes} double\n{points}CELLS {elements} \
         {numbers}\n{cells}CELL_TYPES {elements}\n{kinds}"
    )
}
