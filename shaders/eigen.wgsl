// Eigenvalues and eigenvectors of a symmetric matrix by Jacobi's rotations; twin of src/math/eigen.rs.
struct Eigen {
    values: vec3<f32>,
    // rows: the unit eigenvectors
    vectors: mat3x3<f32>,
}

// Tangent, cosine and sine of the rotation that makes the entry between two axes zero.
fn zeroing_rotation(app: f32, aqq: f32, apq: f32) -> vec3<f32> {
    let twice = apq + apq;
    let difference = aqq - app;
    // where squares underflow the angle must stay below 45 degrees
    let root = max(sqrt(difference * difference + twice * twice), abs(twice));
    let t = select(-twice, twice, difference > 0.0) / (abs(difference) + root + 1e-36);
    let c = 1.0 / sqrt(t * t + 1.0);
    return vec3<f32>(t, c, t * c);
}

fn sym_eigen(s: Sym3) -> Eigen {
    var d = s.diagonal;
    var o = s.others;
    var x = vec3<f32>(1.0, 0.0, 0.0);
    var y = vec3<f32>(0.0, 1.0, 0.0);
    var z = vec3<f32>(0.0, 0.0, 1.0);
    for (var sweep = 0u; sweep < 4u; sweep++) {
        let a = zeroing_rotation(d.x, d.y, o.x);
        d = vec3<f32>(d.x - a.x * o.x, d.y + a.x * o.x, d.z);
        o = vec3<f32>(0.0, a.z * o.z + a.y * o.y, a.y * o.z - a.z * o.y);
        let old_x = x;
        x = a.y * old_x - a.z * y;
        y = a.z * old_x + a.y * y;
        let b = zeroing_rotation(d.y, d.z, o.y);
        d = vec3<f32>(d.x, d.y - b.x * o.y, d.z + b.x * o.y);
        o = vec3<f32>(b.y * o.x - b.z * o.z, 0.0, b.z * o.x + b.y * o.z);
        let old_y = y;
        y = b.y * old_y - b.z * z;
        z = b.z * old_y + b.y * z;
        let c = zeroing_rotation(d.x, d.z, o.z);
        d = vec3<f32>(d.x - c.x * o.z, d.y, d.z + c.x * o.z);
        o = vec3<f32>(c.y * o.x - c.z * o.y, c.z * o.x + c.y * o.y, 0.0);
        let turned_x = x;
        x = c.y * turned_x - c.z * z;
        z = c.z * turned_x + c.y * z;
    }
    return Eigen(d, mat3x3<f32>(x, y, z));
}
