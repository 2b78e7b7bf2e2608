// The six-node wedge with six points and mean dilatation; twin of src/elements/wedge6.rs.
// Coefficients of r, s, ζ, rζ, sζ: c[m] is a vector.
struct Element {
    u: array<vec3<f32>, 5>, // of the displacement (m)
    x: array<vec3<f32>, 5>, // of the rest position (m)
    volume: f32, // m³
}

// Forces (N) on the coefficients.
struct Forces {
    f: array<vec3<f32>, 5>,
}

const GAUSS: f32 = 0.57735026919;
const WEIGHT: f32 = 0.16666666667;
const THERE: u32 = 16u;

fn element_of(row: u32) -> Element {
    let u0 = corner_displacement(row, 0u);
    let u3 = corner_displacement(row, 3u);
    // differences along edges, so that a common displacement drops out before it can round
    let r_below = corner_displacement(row, 1u) - u0;
    let s_below = corner_displacement(row, 2u) - u0;
    let r_above = corner_displacement(row, 4u) - u3;
    let s_above = corner_displacement(row, 5u) - u3;
    let u = array<vec3<f32>, 5>(
        0.5 * (r_above + r_below),
        0.5 * (s_above + s_below),
        0.5 * (u3 - u0),
        0.5 * (r_above - r_below),
        0.5 * (s_above - s_below),
    );
    let x = array<vec3<f32>, 5>(
        shape_vector(row, 0u),
        shape_vector(row, 3u),
        shape_vector(row, 6u),
        shape_vector(row, 9u),
        shape_vector(row, 12u),
    );
    return Element(u, x, rest_shape[place(row, ROWS, VOLUME_ROW)]);
}

// Natural coordinates of a point.
fn natural_point(point: u32) -> vec3<f32> {
    let corner = point % 3u;
    let near = 0.16666666667;
    let far = 0.66666666667;
    return vec3<f32>(select(near, far, corner == 1u), select(near, far, corner == 2u), select(-GAUSS, GAUSS, point >= 3u));
}

// Columns: derivatives by r, s, ζ.
fn natural_gradient(c: array<vec3<f32>, 5>, p: vec3<f32>) -> mat3x3<f32> {
    return mat3x3<f32>(c[0] + p.z * c[3], c[1] + p.z * c[4], c[2] + p.x * c[3] + p.y * c[4]);
}

fn at_point(e: Element, point: u32) -> PointState {
    let p = natural_point(point);
    let by = natural_gradient(e.x, p);
    // row k: det · ∂ξ_k/∂X
    let adjugate = mat3x3<f32>(cross(by[1], by[2]), cross(by[2], by[0]), cross(by[0], by[1]));
    let determinant = dot(by[0], adjugate[0]);
    let u = natural_gradient(e.u, p);
    let inverse = 1.0 / determinant;
    var gradient = mat3x3<f32>();
    gradient = plus_outer(gradient, u[0] * inverse, adjugate[0]);
    gradient = plus_outer(gradient, u[1] * inverse, adjugate[1]);
    gradient = plus_outer(gradient, u[2] * inverse, adjugate[2]);
    return PointState(gradient, adjugate, WEIGHT * determinant);
}

fn add_stress(forces: Forces, point: u32, at: PointState, stress: mat3x3<f32>) -> Forces {
    let p = natural_point(point);
    let by_r = times_vector(stress, at.adjugate[0]);
    let by_s = times_vector(stress, at.adjugate[1]);
    let by_z = times_vector(stress, at.adjugate[2]);
    var f = forces.f;
    f[0] += by_r;
    f[1] += by_s;
    f[2] += by_z;
    f[3] += p.z * by_r + p.x * by_z;
    f[4] += p.z * by_s + p.y * by_z;
    return Forces(f);
}

// Nodal forces (N).
fn corner_forces(row: u32, e: Element, forces: Forces) -> array<vec3<f32>, NODES> {
    let share = 0.5 * WEIGHT * rest_shape[place(row, ROWS, THERE)];
    let f = forces.f;
    let f1 = share * (f[0] - f[3]);
    let f2 = share * (f[1] - f[4]);
    let f4 = share * (f[0] + f[3]);
    let f5 = share * (f[1] + f[4]);
    let f3 = share * f[2] - f4 - f5;
    return array<vec3<f32>, NODES>(-((f1 + f2) + (f3 + (f4 + f5))), f1, f2, f3, f4, f5);
}

fn hourglass_energy(row: u32, e: Element) -> f32 {
    return 0.0;
}
