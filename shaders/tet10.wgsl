// The ten-node tetrahedron with four points and mean dilatation; twin of src/elements/tet10.rs.
// Differences e to the first corner, and deviations d of the middles of the edges 01 12 20 03 13 23 from halfway.
struct Element {
    u: array<vec3<f32>, 9>, // of the displacement (m)
    x: array<vec3<f32>, 9>, // of the rest position (m)
    volume: f32, // m³
}

// Forces (N) on the coefficients.
struct Forces {
    f: array<vec3<f32>, 9>,
}

const FAR: f32 = 0.58541019662;
const NEAR: f32 = 0.13819660113;
const WEIGHT: f32 = 0.04166666667;
const THERE: u32 = 28u;
const STIFFNESS: u32 = 29u;

// How far a middle is from halfway between two corners.
fn deviation(middle: vec3<f32>, a: vec3<f32>, b: vec3<f32>) -> vec3<f32> {
    // differences along edges, so that a common displacement drops out before it can round
    return 0.5 * ((middle - a) + (middle - b));
}

fn element_of(row: u32) -> Element {
    let u0 = corner_displacement(row, 0u);
    let u1 = corner_displacement(row, 1u);
    let u2 = corner_displacement(row, 2u);
    let u3 = corner_displacement(row, 3u);
    let u = array<vec3<f32>, 9>(
        u1 - u0,
        u2 - u0,
        u3 - u0,
        deviation(corner_displacement(row, 4u), u0, u1),
        deviation(corner_displacement(row, 5u), u1, u2),
        deviation(corner_displacement(row, 6u), u2, u0),
        deviation(corner_displacement(row, 7u), u0, u3),
        deviation(corner_displacement(row, 8u), u1, u3),
        deviation(corner_displacement(row, 9u), u2, u3),
    );
    let x = array<vec3<f32>, 9>(
        shape_vector(row, 0u),
        shape_vector(row, 3u),
        shape_vector(row, 6u),
        shape_vector(row, 9u),
        shape_vector(row, 12u),
        shape_vector(row, 15u),
        shape_vector(row, 18u),
        shape_vector(row, 21u),
        shape_vector(row, 24u),
    );
    return Element(u, x, rest_shape[place(row, ROWS, VOLUME_ROW)]);
}

// Four times the barycentric coordinates of a point; after the integration points comes the middle.
fn four_shares(point: u32) -> vec4<f32> {
    let near = vec4<f32>(4.0 * select(NEAR, 0.25, point >= POINTS));
    return select(near, vec4<f32>(4.0 * FAR), vec4<u32>(0u, 1u, 2u, 3u) == vec4<u32>(point));
}

// Columns: derivatives by the coordinates of the corners 1, 2 and 3.
fn natural_gradient(c: array<vec3<f32>, 9>, l: vec4<f32>) -> mat3x3<f32> {
    return mat3x3<f32>(
        c[0] + (l.x - l.y) * c[3] + l.z * (c[4] - c[5]) + l.w * (c[7] - c[6]),
        c[1] + l.y * (c[4] - c[3]) + (l.x - l.z) * c[5] + l.w * (c[8] - c[6]),
        c[2] + l.y * (c[7] - c[3]) + l.z * (c[8] - c[5]) + (l.x - l.w) * c[6],
    );
}

fn at_point(e: Element, point: u32) -> PointState {
    let l = four_shares(point);
    let by = natural_gradient(e.x, l);
    // row k: det · ∂L_k/∂X
    let adjugate = mat3x3<f32>(cross(by[1], by[2]), cross(by[2], by[0]), cross(by[0], by[1]));
    let determinant = dot(by[0], adjugate[0]);
    let u = natural_gradient(e.u, l);
    let inverse = 1.0 / determinant;
    var gradient = mat3x3<f32>();
    gradient = plus_outer(gradient, u[0] * inverse, adjugate[0]);
    gradient = plus_outer(gradient, u[1] * inverse, adjugate[1]);
    gradient = plus_outer(gradient, u[2] * inverse, adjugate[2]);
    return PointState(gradient, adjugate, WEIGHT * determinant);
}

fn add_stress(forces: Forces, point: u32, at: PointState, stress: mat3x3<f32>) -> Forces {
    let l = four_shares(point);
    let by_1 = times_vector(stress, at.adjugate[0]);
    let by_2 = times_vector(stress, at.adjugate[1]);
    let by_3 = times_vector(stress, at.adjugate[2]);
    var f = forces.f;
    f[0] += by_1;
    f[1] += by_2;
    f[2] += by_3;
    f[3] += (l.x - l.y) * by_1 - l.y * (by_2 + by_3);
    f[4] += l.z * by_1 + l.y * by_2;
    f[5] += (l.x - l.z) * by_2 - l.z * (by_1 + by_3);
    f[6] += (l.x - l.w) * by_3 - l.w * (by_1 + by_2);
    f[7] += l.w * by_1 + l.y * by_3;
    f[8] += l.w * by_2 + l.z * by_3;
    return Forces(f);
}

// What J of each point is beside their mean.
fn volume_deviations(e: Element) -> vec4<f32> {
    var volumes = vec4<f32>();
    var changes = vec4<f32>();
    for (var point = 0u; point < POINTS; point++) {
        let at = at_point(e, point);
        volumes[point] = at.volume;
        changes[point] = volume_change_of(at.gradient);
    }
    return changes - dot(volumes, changes) / dot(volumes, vec4<f32>(1.0));
}

// Nodal forces (N).
fn corner_forces(row: u32, e: Element, of_stress: Forces) -> array<vec3<f32>, NODES> {
    let deviations = rest_shape[place(row, ROWS, STIFFNESS)] * volume_deviations(e);
    var forces = of_stress;
    for (var point = 0u; point < POINTS; point++) {
        let at = at_point(e, point);
        forces = add_stress(forces, point, at, deviations[point] * cofactor_with_identity(at.gradient));
    }
    let share = WEIGHT * rest_shape[place(row, ROWS, THERE)];
    let f4 = share * forces.f[3];
    let f5 = share * forces.f[4];
    let f6 = share * forces.f[5];
    let f7 = share * forces.f[6];
    let f8 = share * forces.f[7];
    let f9 = share * forces.f[8];
    let f1 = share * forces.f[0] - 0.5 * (f4 + f5 + f8);
    let f2 = share * forces.f[1] - 0.5 * (f5 + f6 + f9);
    let f3 = share * forces.f[2] - 0.5 * (f7 + f8 + f9);
    let f0 = -(((f1 + f2) + f3) + ((f4 + f5) + (f6 + f7)) + (f8 + f9));
    return array<vec3<f32>, NODES>(f0, f1, f2, f3, f4, f5, f6, f7, f8, f9);
}

// J
fn hourglass_energy(row: u32, e: Element) -> f32 {
    let deviations = volume_deviations(e);
    var sum = 0.0;
    for (var point = 0u; point < POINTS; point++) {
        sum += at_point(e, point).volume * deviations[point] * deviations[point];
    }
    return 0.5 * rest_shape[place(row, ROWS, STIFFNESS)] * rest_shape[place(row, ROWS, THERE)] * sum;
}
