//! Tools that are closed surfaces of triangles.

use crate::configurations::cpu_and_long_gpu;

/// At its point the distance to a grid grows by less than one metre a metre: one correction would let the node in.
#[test]
fn the_point_of_a_mesh_does_not_go_into_a_node() {
    let folder = tempfile::tempdir().unwrap();
    let octahedron = "v 6 0 0\nv -6 0 0\nv 0 6 0\nv 0 -6 0\nv 0 0 6\nv 0 0 -6\nf 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\n\
                      f 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n";
    std::fs::write(folder.path().join("octahedron.obj"), octahedron).unwrap();
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start_in(
            "(duration: 0.1, bodies: {\"b\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (10, 10, 10),
                elements: Hex8MeanDilatation), material: \"m\")},
            materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45), damping: 60)},
            constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))],
            tools: {\"pick\": (mesh: (path: \"octahedron.obj\", scale: 0.001), at: (0.01, 0.01, 0.027),
                moves: [(displacement: (0, 0, -3e-3), curve: Smooth(end: 0.1))])},
            contacts: [Tool(tool: \"pick\")])",
            folder.path(),
        );
        while simulation.time() < 0.099 {
            simulation.advance(20).unwrap();
            let reading = simulation.tool("pick").unwrap();
            assert!(reading.penetration < 2e-6, "{}: {reading:?}", run.name);
        }
        assert!(simulation.tool("pick").unwrap().force.z > 1e-3);
    }
}
