// The eight-node hexahedron with eight points and mean dilatation; twin of src/elements/hex8_mean_dilatation.rs.
// Coefficients of the modes ξ, η, ζ, ηζ, ζξ, ξη, ξηζ: c[m] is a vector.
struct Element {
    u: array<vec3<f32>, 7>, // of the displacement (m)
    x: array<vec3<f32>, 7>, // of the rest position (m)
    volume: f32, // m³
}

// Forces (N) on the coefficients.
struct Forces {
    f: array<vec3<f32>, 7>,
}

const GAUSS: f32 = 0.57735026919;
const THERE: u32 = 22u;

fn element_of(row: u32) -> Element {
    let u0 = corner_displacement(row, 0u);
    let u1 = corner_displacement(row, 1u);
    let u2 = corner_displacement(row, 2u);
    let u3 = corner_displacement(row, 3u);
    let u4 = corner_displacement(row, 4u);
    let u5 = corner_displacement(row, 5u);
    let u6 = corner_displacement(row, 6u);
    let u7 = corner_displacement(row, 7u);
    // differences along edges, so that a common displacement drops out before it can round
    let x0 = u1 - u0;
    let x1 = u2 - u3;
    let x2 = u5 - u4;
    let x3 = u6 - u7;
    let below = (u3 - u0) + (u2 - u1);
    let above = (u7 - u4) + (u6 - u5);
    let upright = (u4 - u0) + (u5 - u1) + (u6 - u2) + (u7 - u3);
    let low = x1 - x0;
    let high = x3 - x2;
    let u = array<vec3<f32>, 7>(
        0.125 * ((x0 + x1) + (x2 + x3)),
        0.125 * (below + above),
        0.125 * upright,
        0.125 * (above - below),
        0.125 * ((x2 + x3) - (x0 + x1)),
        0.125 * (low + high),
        0.125 * (high - low),
    );
    let x = array<vec3<f32>, 7>(
        shape_vector(row, 0u),
        shape_vector(row, 3u),
        shape_vector(row, 6u),
        shape_vector(row, 9u),
        shape_vector(row, 12u),
        shape_vector(row, 15u),
        shape_vector(row, 18u),
    );
    return Element(u, x, rest_shape[place(row, ROWS, VOLUME_ROW)]);
}

// Natural coordinates of a point: signs in the order of the nodes.
fn natural_point(point: u32) -> vec3<f32> {
    let upper = vec3<bool>(((point + 1u) & 2u) != 0u, (point & 2u) != 0u, (point & 4u) != 0u);
    return select(vec3<f32>(-GAUSS), vec3<f32>(GAUSS), upper);
}

// Columns: derivatives by ξ, η, ζ.
fn natural_gradient(c: array<vec3<f32>, 7>, p: vec3<f32>) -> mat3x3<f32> {
    return mat3x3<f32>(
        c[0] + p.z * c[4] + p.y * (c[5] + p.z * c[6]),
        c[1] + p.z * c[3] + p.x * (c[5] + p.z * c[6]),
        c[2] + p.y * c[3] + p.x * (c[4] + p.y * c[6]),
    );
}

fn at_point(e: Element, point: u32) -> PointState {
    let p = natural_point(point);
    let by = natural_gradient(e.x, p);
    // row k: det · ∂ξ_k/∂X
    let adjugate = mat3x3<f32>(cross(by[1], by[2]), cross(by[2], by[0]), cross(by[0], by[1]));
    let volume = dot(by[0], adjugate[0]);
    let u = natural_gradient(e.u, p);
    let per_volume = 1.0 / volume;
    var gradient = mat3x3<f32>();
    gradient = plus_outer(gradient, u[0] * per_volume, adjugate[0]);
    gradient = plus_outer(gradient, u[1] * per_volume, adjugate[1]);
    gradient = plus_outer(gradient, u[2] * per_volume, adjugate[2]);
    return PointState(gradient, adjugate, volume);
}

fn add_stress(forces: Forces, point: u32, at: PointState, stress: mat3x3<f32>) -> Forces {
    let p = natural_point(point);
    let by_x = times_vector(stress, at.adjugate[0]);
    let by_y = times_vector(stress, at.adjugate[1]);
    let by_z = times_vector(stress, at.adjugate[2]);
    var f = forces.f;
    f[0] += by_x;
    f[1] += by_y;
    f[2] += by_z;
    f[3] += p.z * by_y + p.y * by_z;
    f[4] += p.x * by_z + p.z * by_x;
    f[5] += p.y * by_x + p.x * by_y;
    f[6] += p.y * p.z * by_x + p.z * p.x * by_y + p.x * p.y * by_z;
    return Forces(f);
}

// Nodal forces (N).
fn corner_forces(row: u32, e: Element, forces: Forces) -> array<vec3<f32>, NODES> {
    let there = 0.125 * rest_shape[place(row, ROWS, THERE)];
    let f = forces.f;
    let f1 = there * (f[0] - f[1] - f[2] + f[3] - f[4] - f[5] + f[6]);
    let f2 = there * (f[0] + f[1] - f[2] - f[3] - f[4] + f[5] - f[6]);
    let f3 = there * (-f[0] + f[1] - f[2] - f[3] + f[4] - f[5] + f[6]);
    let f4 = there * (-f[0] - f[1] + f[2] - f[3] - f[4] + f[5] + f[6]);
    let f5 = there * (f[0] - f[1] + f[2] - f[3] + f[4] - f[5] - f[6]);
    let f6 = there * (f[0] + f[1] + f[2] + f[3] + f[4] + f[5] + f[6]);
    let f7 = there * (-f[0] + f[1] + f[2] + f[3] - f[4] - f[5] - f[6]);
    return array<vec3<f32>, NODES>(-f1 - f2 - f3 - f4 - f5 - f6 - f7, f1, f2, f3, f4, f5, f6, f7);
}

fn hourglass_energy(row: u32, e: Element) -> f32 {
    return 0.0;
}
