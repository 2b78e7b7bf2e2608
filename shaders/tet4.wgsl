// The four-node tetrahedron; twin of src/elements/tet4.rs, also with averaged nodal pressure.
struct Element {
    // displacements of nodes 1 to 3 less that of node 0 (m)
    u1: vec3<f32>,
    u2: vec3<f32>,
    u3: vec3<f32>,
    // gradients of nodes 1 to 3 (1/m)
    g1: vec3<f32>,
    g2: vec3<f32>,
    g3: vec3<f32>,
    volume: f32, // m³
}

fn element_of(row: u32) -> Element {
    let u0 = corner_displacement(row, 0u);
    return Element(
        corner_displacement(row, 1u) - u0,
        corner_displacement(row, 2u) - u0,
        corner_displacement(row, 3u) - u0,
        shape_vector(row, 0u),
        shape_vector(row, 3u),
        shape_vector(row, 6u),
        rest_shape[place(row, ROWS, VOLUME_ROW)],
    );
}

// First Piola-Kirchhoff stress (Pa)
struct Forces {
    stress: mat3x3<f32>,
}

fn at_point(e: Element, point: u32) -> PointState {
    var h = mat3x3<f32>(e.u1.x * e.g1, e.u1.y * e.g1, e.u1.z * e.g1);
    h = plus_outer(plus_outer(h, e.u2, e.g2), e.u3, e.g3);
    return PointState(h, h, e.volume);
}

fn add_stress(forces: Forces, point: u32, at: PointState, stress: mat3x3<f32>) -> Forces {
    return Forces(stress);
}

// Nodal forces (N).
fn corner_forces(row: u32, e: Element, forces: Forces) -> array<vec3<f32>, NODES> {
    let stress = e.volume * forces.stress;
    let f1 = times_vector(stress, e.g1);
    let f2 = times_vector(stress, e.g2);
    let f3 = times_vector(stress, e.g3);
    return array<vec3<f32>, NODES>(-f1 - f2 - f3, f1, f2, f3);
}

fn hourglass_energy(row: u32, e: Element) -> f32 {
    return 0.0;
}
