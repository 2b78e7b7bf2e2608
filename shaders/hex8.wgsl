// The eight-node hexahedron with one integration point and hourglass control; twin of src/elements/hex8.rs.
// Modes: signs of the nodes along x, y, z, and the products of those.
struct Element {
    // displacements, each times its node's sign (m)
    x: vec3<f32>,
    y: vec3<f32>,
    z: vec3<f32>,
    yz: vec3<f32>,
    zx: vec3<f32>,
    xy: vec3<f32>,
    xyz: vec3<f32>,
    // the mean gradients' parts in the modes (1/m); they have none in the last
    slope_x: vec3<f32>,
    slope_y: vec3<f32>,
    slope_z: vec3<f32>,
    slope_yz: vec3<f32>,
    slope_zx: vec3<f32>,
    slope_xy: vec3<f32>,
    volume: f32, // m³
}

// how many modes' slopes are not zero: parallelepipeds have those of x, y and z only, and no arms
const SLOPES: u32 = VOLUME_ROW / 3u;
const HOURGLASS_STIFFNESS: u32 = VOLUME_ROW + 1u;
const HOURGLASS_ARMS: u32 = VOLUME_ROW + 2u;

fn further_slope(row: u32, mode: u32) -> vec3<f32> {
    if mode < SLOPES {
        return shape_vector(row, 3u * mode);
    }
    return vec3<f32>(0.0);
}

fn element_of(row: u32) -> Element {
    let u0 = corner_displacement(row, 0u);
    let u1 = corner_displacement(row, 1u);
    let u2 = corner_displacement(row, 2u);
    let u3 = corner_displacement(row, 3u);
    let u4 = corner_displacement(row, 4u);
    let u5 = corner_displacement(row, 5u);
    let u6 = corner_displacement(row, 6u);
    let u7 = corner_displacement(row, 7u);
    // from differences along edges, so that a common displacement drops out before it can round
    let x0 = u1 - u0;
    let x1 = u2 - u3;
    let x2 = u5 - u4;
    let x3 = u6 - u7;
    let y_below = (u3 - u0) + (u2 - u1);
    let y_above = (u7 - u4) + (u6 - u5);
    return Element(
        (x0 + x1) + (x2 + x3),
        y_below + y_above,
        ((u4 - u0) + (u5 - u1)) + ((u6 - u2) + (u7 - u3)),
        y_above - y_below,
        (x2 + x3) - (x0 + x1),
        (x1 - x0) + (x3 - x2),
        (x3 - x2) - (x1 - x0),
        shape_vector(row, 0u),
        shape_vector(row, 3u),
        shape_vector(row, 6u),
        further_slope(row, 3u),
        further_slope(row, 4u),
        further_slope(row, 5u),
        rest_shape[place(row, ROWS, VOLUME_ROW)],
    );
}

struct Forces {
    gradient: mat3x3<f32>, // ∇u
    stress: mat3x3<f32>, // first Piola-Kirchhoff stress (Pa)
}

fn at_point(e: Element, point: u32) -> PointState {
    var h = mat3x3<f32>(e.x.x * e.slope_x, e.x.y * e.slope_x, e.x.z * e.slope_x);
    h = plus_outer(h, e.y, e.slope_y);
    h = plus_outer(h, e.z, e.slope_z);
    if SLOPES > 3u {
        h = plus_outer(h, e.yz, e.slope_yz);
        h = plus_outer(h, e.zx, e.slope_zx);
        h = plus_outer(h, e.xy, e.slope_xy);
    }
    return PointState(h, h, e.volume);
}

fn add_stress(forces: Forces, point: u32, at: PointState, stress: mat3x3<f32>) -> Forces {
    return Forces(at.gradient, stress);
}

// XᵀΓ_m (m)
fn hourglass_arm(row: u32, m: u32) -> vec3<f32> {
    return shape_vector(row, HOURGLASS_ARMS + 3u * m);
}

// The four hourglass displacements q_m = Γ_m·u − ∇u h_m (m), of the modes yz, zx, xy, xyz.
fn hourglass_displacements(row: u32, e: Element, h: mat3x3<f32>) -> array<vec3<f32>, 4> {
    if SLOPES == 3u {
        return array<vec3<f32>, 4>(e.yz, e.zx, e.xy, e.xyz);
    }
    return array<vec3<f32>, 4>(
        e.yz - times_vector(h, hourglass_arm(row, 0u)),
        e.zx - times_vector(h, hourglass_arm(row, 1u)),
        e.xy - times_vector(h, hourglass_arm(row, 2u)),
        e.xyz - times_vector(h, hourglass_arm(row, 3u)),
    );
}

// Nodal forces (N).
fn corner_forces(row: u32, e: Element, forces: Forces) -> array<vec3<f32>, NODES> {
    let displacements = hourglass_displacements(row, e, forces.gradient);
    let stiffness = rest_shape[place(row, ROWS, HOURGLASS_STIFFNESS)];
    let p = stiffness * displacements[0];
    let q = stiffness * displacements[1];
    let r = stiffness * displacements[2];
    let s = stiffness * displacements[3];
    var folded = e.volume * forces.stress;
    if SLOPES > 3u {
        folded = plus_outer(folded, -p, hourglass_arm(row, 0u));
        folded = plus_outer(folded, -q, hourglass_arm(row, 1u));
        folded = plus_outer(folded, -r, hourglass_arm(row, 2u));
        folded = plus_outer(folded, -s, hourglass_arm(row, 3u));
    }
    // what is odd in (x, y, z), and what is even, has its counterpart at the opposite node
    let x = times_vector(folded, e.slope_x);
    let y = times_vector(folded, e.slope_y);
    let z = times_vector(folded, e.slope_z);
    var yz = p;
    var zx = q;
    var xy = r;
    if SLOPES > 3u {
        yz += times_vector(folded, e.slope_yz);
        zx += times_vector(folded, e.slope_zx);
        xy += times_vector(folded, e.slope_xy);
    }
    let odd_1 = (x - y) - (z - s);
    let odd_3 = (y - x) - (z - s);
    let odd_4 = (z + s) - (x + y);
    let odd_6 = (x + y) + (z + s);
    let even_1 = (yz - zx) - xy;
    let even_3 = (zx - yz) - xy;
    let even_4 = xy - (yz + zx);
    let even_6 = (yz + zx) + xy;
    let f1 = even_1 + odd_1;
    let f2 = even_4 - odd_4;
    let f3 = even_3 + odd_3;
    let f4 = even_4 + odd_4;
    let f5 = even_3 - odd_3;
    let f6 = even_6 + odd_6;
    let f7 = even_1 - odd_1;
    // node 0 balances the others: see the twin
    return array<vec3<f32>, NODES>(-(f1 + f2 + f3 + f4 + f5 + f6 + f7), f1, f2, f3, f4, f5, f6, f7);
}

// J
fn hourglass_energy(row: u32, e: Element) -> f32 {
    let q = hourglass_displacements(row, e, at_point(e, 0u).gradient);
    let squares = dot(q[0], q[0]) + dot(q[1], q[1]) + dot(q[2], q[2]) + dot(q[3], q[3]);
    return 0.5 * rest_shape[place(row, ROWS, HOURGLASS_STIFFNESS)] * squares;
}
