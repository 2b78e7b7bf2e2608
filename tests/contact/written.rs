//! Meshes that tests write, in the format of Gmsh 2.2.

use std::fmt::Write;
use std::path::Path;

/// A mesh as it is written: nodes with their places, and elements by Gmsh's number of their kind.
#[derive(Default)]
pub struct Written {
    nodes: String,
    elements: String,
}

impl Written {
    pub fn node(&mut self, [x, y, z]: [f64; 3]) -> usize {
        let number = self.nodes.lines().count() + 1;
        writeln!(self.nodes, "{number} {x} {y} {z}").unwrap();
        number
    }

    /// Of a face of nodes at one end, and the same at the other, or one node there.
    pub fn element(&mut self, faces: [&[usize]; 2]) {
        let (number, corners) = (self.elements.lines().count() + 1, faces.concat());
        let kind = match corners.len() {
            4 => 4,
            6 => 6,
            _ => 5,
        };
        let corners = corners.iter().map(usize::to_string).collect::<Vec<_>>().join(" ");
        writeln!(self.elements, "{number} {kind} 2 1 1 {corners}").unwrap();
    }

    pub fn write(&self, path: &Path) {
        let Self { nodes, elements } = self;
        let counts = [nodes.lines().count(), elements.lines().count()];
        let text = format!(
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n{nodes}$EndNodes\n$Elements\n{}\n{elements}\
             $EndElements\n",
            counts[0], counts[1]
        );
        std::fs::write(path, text).unwrap();
    }
}
