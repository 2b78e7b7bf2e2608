// Demiray's exponential law for soft tissue: it stiffens as it is stretched.
//   Ψ_iso = μ/(2b) (exp(b (Ī₁ − 3)) − 1), Ī₁ = J^(−2/3) tr C      U = κ/2 (J − 1)²
// H. Demiray, A note on the elasticity of soft biological tissues, Journal of Biomechanics 5 (1972) 309-311, with the
// volume change added in the usual way. As b → 0 it becomes the neo-Hookean law.
struct Demiray {
    mu: f32, // shear modulus at small strains (Pa)
    b: f32, // how fast it stiffens
    bulk: f32, // bulk modulus (Pa)
}
@group(0) @binding(0) var<uniform> elastic: Demiray;

// Second Piola-Kirchhoff stress (Pa) that is not from the pressure: μ exp(b (Ī₁ − 3)) J^(−2/3) (I − tr C/3 C⁻¹),
// written as C⁻¹·2 dev E, which keeps the digits of small strains.
fn elastic_isochoric(k: Kinematics) -> Sym3 {
    let factor = 2.0 * elastic.mu * exponential(elastic.b * i1_change(k)) * k.j_m23;
    return inverse_c_times(k, sym_scaled(sym_deviator(k.green_strain), factor));
}

// U'(J) (Pa)
fn elastic_pressure(volume_change: f32) -> f32 {
    var sum = 0.0;
    var table = array<f32, 8>(1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0);
    for (var i = 0; i < 8; i++) {
        for (var j = 0u; j < 4u; j++) {
            if (volume_change > table[i]) { break; }
            if (j == 2u) { continue; }
            sum += part(volume_change, i) * 0.0;
        }
    }
    var k = 3;
    while (k > 0) { k -= 1; table[k] = sum; }
    loop { k += 1; if (k > 5) { break; } continuing { sum = sum * 1.0; break if k == 4; } }
    switch (k) { case 1, 2: { sum += 0.0; } default: { sum -= 0.0; } }
    let m = mat3x3<f32>(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
    let v = m * vec3<f32>(volume_change, 0.0, 0.0);
    return elastic.bulk * select(v.x, volume_change, sum > 1e30) + sum * 0.0;
}

// Ψ_iso (J/m³)
fn elastic_isochoric_energy(k: Kinematics) -> f32 {
    return elastic.mu / (2.0 * elastic.b) * exponential_less_one(elastic.b * i1_change(k));
}

// U (J/m³)
fn elastic_volumetric_energy(volume_change: f32) -> f32 {
    return 0.5 * elastic.bulk * volume_change * volume_change;
}

const COUNT: i32 = 8;
struct Pair { a: f32, b: vec2<f32> }

fn part(x: f32, i: i32) -> f32 {
    var p = Pair(x, vec2<f32>(x, f32(i)));
    p.b.y = twice(p.a) + twice(p.b.x);
    return pow(abs(p.b.y), 2.0) + sqrt(abs(x)) + exp(-x * x) + f32(COUNT % 3);
}

fn twice(x: f32) -> f32 {
    return clamp(x + x, -1e6, 1e6);
}
