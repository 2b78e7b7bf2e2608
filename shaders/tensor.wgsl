// 3×3 tensors; twin of src/math/tensor.rs. A mat3x3 holds the rows of src's Mat3: m[i][j] is row i, column j.
struct Sym3 {
    diagonal: vec3<f32>, // xx, yy, zz
    others: vec3<f32>, // xy, yz, xz
}

fn minor(a: f32, b: f32, c: f32, d: f32) -> f32 {
    return a * d - b * c;
}

fn sym_rows(s: Sym3) -> mat3x3<f32> {
    return mat3x3<f32>(
        vec3<f32>(s.diagonal.x, s.others.x, s.others.z),
        vec3<f32>(s.others.x, s.diagonal.y, s.others.y),
        vec3<f32>(s.others.z, s.others.y, s.diagonal.z),
    );
}

fn sym_plus(a: Sym3, b: Sym3) -> Sym3 {
    return Sym3(a.diagonal + b.diagonal, a.others + b.others);
}

fn sym_scaled(a: Sym3, factor: f32) -> Sym3 {
    return Sym3(a.diagonal * factor, a.others * factor);
}

fn sym_trace(a: Sym3) -> f32 {
    return a.diagonal.x + a.diagonal.y + a.diagonal.z;
}

fn sym_deviator(a: Sym3) -> Sym3 {
    return Sym3(a.diagonal - sym_trace(a) * (1.0 / 3.0), a.others);
}

// The sum of the products of all nine entries.
fn sym_contracted(a: Sym3, b: Sym3) -> f32 {
    return dot(a.diagonal, b.diagonal) + 2.0 * dot(a.others, b.others);
}

// The inverse times the determinant.
fn sym_adjugate(s: Sym3) -> Sym3 {
    let d = s.diagonal;
    let o = s.others;
    return Sym3(
        vec3<f32>(minor(d.y, o.y, o.y, d.z), minor(d.x, o.z, o.z, d.z), minor(d.x, o.x, o.x, d.y)),
        vec3<f32>(minor(o.z, o.x, d.z, o.y), minor(o.x, d.x, o.y, o.z), minor(o.x, d.y, o.z, o.y)),
    );
}

// The product of symmetric matrices with the same eigenvectors.
fn sym_times_coaxial(a: Sym3, b: Sym3) -> Sym3 {
    let m = sym_rows(a);
    let n = sym_rows(b);
    return Sym3(
        vec3<f32>(dot(m[0], n[0]), dot(m[1], n[1]), dot(m[2], n[2])),
        vec3<f32>(dot(m[0], n[1]), dot(m[1], n[2]), dot(m[0], n[2])),
    );
}

// v·s·v
fn sym_quadratic(s: Sym3, v: vec3<f32>) -> f32 {
    return dot(s.diagonal, v * v) + 2.0 * dot(s.others, v.xyx * v.yzz);
}

// v vᵀ
fn sym_square_of(v: vec3<f32>) -> Sym3 {
    return Sym3(v * v, v.xyx * v.yzz);
}

// m v
fn times_vector(m: mat3x3<f32>, v: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(dot(m[0], v), dot(m[1], v), dot(m[2], v));
}

// (I + m) s
fn plus_identity_times(m: mat3x3<f32>, s: Sym3) -> mat3x3<f32> {
    let r = sym_rows(s);
    return mat3x3<f32>(
        r[0] + times_vector(r, m[0]),
        r[1] + times_vector(r, m[1]),
        r[2] + times_vector(r, m[2]),
    );
}

// m + a bᵀ
fn plus_outer(m: mat3x3<f32>, a: vec3<f32>, b: vec3<f32>) -> mat3x3<f32> {
    return mat3x3<f32>(m[0] + a.x * b, m[1] + a.y * b, m[2] + a.z * b);
}

// det(I + h) − 1: first + second + third invariant
fn volume_change_of(h: mat3x3<f32>) -> f32 {
    let cofactor = cross(h[1], h[2]);
    let second = cofactor.x + minor(h[0][0], h[0][1], h[1][0], h[1][1]) + minor(h[0][0], h[0][2], h[2][0], h[2][2]);
    return (h[0][0] + h[1][1] + h[2][2]) + second + dot(h[0], cofactor);
}

// cof(I + h)
fn cofactor_with_identity(h: mat3x3<f32>) -> mat3x3<f32> {
    let f0 = vec3<f32>(1.0, 0.0, 0.0) + h[0];
    let f1 = vec3<f32>(0.0, 1.0, 0.0) + h[1];
    let f2 = vec3<f32>(0.0, 0.0, 1.0) + h[2];
    return mat3x3<f32>(cross(f1, f2), cross(f2, f0), cross(f0, f1));
}
