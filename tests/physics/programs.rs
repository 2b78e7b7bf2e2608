//! What is translated from WGSL computes what the same formula written in Rust does, in every kind of number.

use crate::random::Random;
use sinew::materials::program::{Program, ProgramSource};
use std::collections::BTreeMap;

const TEXT: &str = "
struct Parameters { gain: f32, offset: f32 }
@group(0) @binding(0) var<uniform> elastic: Parameters;
struct Pair { a: f32, b: vec2<f32> }
const third = 1.0 / 3.0;
const weights = array<f32, 3>(0.1, 0.2, third);

fn arithmetic(x: f32, y: f32) -> f32 { return elastic.gain * (x * y - x / 3) + (-y + elastic.offset) * third; }

fn functions(x: f32, y: f32) -> f32 {
    let roots = sqrt(abs(x)) + inverseSqrt(1.0 + y * y) + pow(1.0 + abs(x), 1.3) + pow(2.0 + x, 3.0) + pow(3.0 + y, -2.0);
    let curves = exp(x) + sin(7.0 * x) + cos(7.0 * y) + exp2(y) + log(2.0 + x) + log2(3.0 + y) + pow(2.0 + y, third) + pow(2.0 + x, -2.0 / 3.0) + pow(2.0 + x, 1.5);
    return roots + curves + min(x, y) + 2.0 * max(x, 0.1) + clamp(y, -0.2, 0.3) + saturate(x) + sign(y) + step(0.1, x)
        + fma(x, y, 1.0) + mix(x, y, 0.3);
}

fn vectors(x: f32, y: f32) -> f32 {
    let a = vec3<f32>(x, y, 1.0);
    var b = a.zyx * 2.0 - vec3(0.5);
    b.y += x;
    b[2] = y * x;
    let m = mat3x3<f32>(a, b, cross(a, b));
    let n = transpose(m) * m;
    return dot(m * a, b) + determinant(n) + length(a) + distance(a, b) + (a * m).y + normalize(b).x + m[1][2] + weights[1];
}

fn branches(x: f32, y: f32) -> f32 {
    var sum = 0.0;
    if (x > 0.2 && y < 0.5) { sum = x; } else if (x <= -0.3) { sum = y; } else { return -1.0; }
    if (!(y >= 0.0)) { sum += 10.0; }
    if (x * x > 0.64) { return sum; }
    return sum + select(1.0, 2.0, x < y) + f32(any(vec2(x, y) > vec2(0.7)));
}

fn loops(x: f32, y: f32) -> f32 {
    var sum = 0.0;
    for (var i = 0; i < 6; i++) {
        if (i == 2) { continue; }
        if (x > 0.5 && i == 3) { continue; }
        sum += pow(x, f32(i)) * weights[i % 3];
        if (sum > y) { break; }
    }
    var left = 4u;
    loop {
        sum = sum * 0.5;
        left -= 1u;
        continuing { break if left == 0u; }
    }
    switch left { case 1u: { sum = 100.0; } case 0u: { sum += 1.0; } default: { sum = -1.0; } }
    return sum;
}

fn root(x: f32, y: f32) -> f32 {
    // Newton's steps, until they are small enough
    var z = 1.0;
    for (var i = 0; i < 40; i++) {
        let change = 0.5 * ((1.0 + x * x) / z - z);
        z += change;
        if (abs(change) < 1e-12) { break; }
    }
    return z + y;
}

fn parted(x: f32, y: f32) -> Pair {
    var pair = Pair(x, vec2(y, 1.0));
    pair.b.y = pair.a + y;
    return pair;
}
fn structs(x: f32, y: f32) -> f32 { let p = parted(y, x); return p.a + 2.0 * p.b.x + 3.0 * p.b.y; }
";

fn reference(name: &str, x: f64, y: f64) -> f64 {
    let weights = [0.1, 0.2, 1.0 / 3.0];
    match name {
        "arithmetic" => 2.5 * (x * y - x / 3.0) + (-y + 0.75) / 3.0,
        "functions" => {
            let roots = x.abs().sqrt()
                + (1.0 + y * y).sqrt().recip()
                + (1.0 + x.abs()).powf(1.3)
                + (2.0 + x).powi(3)
                + (3.0 + y).powi(-2);
            let curves = x.exp()
                + (7.0 * x).sin()
                + (7.0 * y).cos()
                + y.exp2()
                + (2.0 + x).ln()
                + (3.0 + y).log2()
                + (2.0 + y).cbrt()
                + (2.0 + x).powf(-2.0 / 3.0)
                + (2.0 + x).powf(1.5);
            let steps = f64::from(y > 0.0) - f64::from(y < 0.0) + f64::from(x >= 0.1);
            roots
                + curves
                + x.min(y)
                + 2.0 * x.max(0.1)
                + y.clamp(-0.2, 0.3)
                + x.clamp(0.0, 1.0)
                + steps
                + x * y
                + 1.0
                + 0.7 * x
                + 0.3 * y
        }
        "vectors" => {
            let a = glam::DVec3::new(x, y, 1.0);
            let b = glam::DVec3::new(2.0 - 0.5, 2.0 * y - 0.5 + x, y * x);
            let m = glam::DMat3::from_cols(a, b, a.cross(b));
            let n = m.transpose() * m;
            (m * a).dot(b) + n.determinant() + a.length() + a.distance(b) + a.dot(b) + b.normalize().x + b.z + 0.2
        }
        "branches" => {
            let mut sum = if x > 0.2 && y < 0.5 {
                x
            } else if x <= -0.3 {
                y
            } else {
                return -1.0;
            };
            sum += if y < 0.0 { 10.0 } else { 0.0 };
            if x * x > 0.64 {
                return sum;
            }
            sum + if x < y { 2.0 } else { 1.0 } + f64::from(x > 0.7 || y > 0.7)
        }
        "loops" => {
            let mut sum = 0.0;
            for i in 0..6 {
                if i == 2 || (x > 0.5 && i == 3) {
                    continue;
                }
                sum += x.powi(i) * weights[i as usize % 3];
                if sum > y {
                    break;
                }
            }
            sum / 16.0 + 1.0
        }
        "root" => (1.0 + x * x).sqrt() + y,
        _ => y + 2.0 * x + 3.0 * (y + x),
    }
}

fn program(name: &str) -> Program {
    let uniforms = BTreeMap::from([("elastic".to_string(), vec![2.5, 0.75])]);
    let source = ProgramSource::read(TEXT).unwrap_or_else(|wrong| panic!("{wrong:?}"));
    source
        .translate(name, &uniforms)
        .unwrap_or_else(|wrong| panic!("{name}: {wrong:?} {:?}", wrong.at.clone().map(|at| &TEXT[at])))
}

#[test]
fn translated_functions_give_what_rust_gives() {
    for name in ["arithmetic", "functions", "vectors", "branches", "loops", "root", "structs"] {
        let program = program(name);
        let mut random = Random(11);
        let (mut worst64, mut worst32): (f64, f64) = (0.0, 0.0);
        for _ in 0..2000 {
            let (x, y) = (random.number(), random.number());
            let expected = reference(name, x, y);
            let [in_f64] = program.run([x, y]);
            worst64 = worst64.max((in_f64 - expected).abs() / (1.0 + expected.abs()));
            // f32 may see an edge on the other side: such places are left out
            let (x, y) = (x as f32, y as f32);
            let near_edge = (reference(name, f64::from(x) + 1e-5, f64::from(y) - 1e-5)
                - reference(name, f64::from(x) - 1e-5, f64::from(y) + 1e-5))
            .abs()
                > 0.01;
            let [in_f32]: [f32; 1] = program.run([x, y]);
            if !near_edge {
                let expected = reference(name, f64::from(x), f64::from(y));
                worst32 = worst32.max((f64::from(in_f32) - expected).abs() / (1.0 + expected.abs()));
            }
        }
        println!("{name}: f64 {worst64:.1e}, f32 {worst32:.1e}, {:?}", program.size());
        assert!(worst64 < 1e-13, "{name} in f64: {worst64:e}");
        assert!(worst32 < 1e-5, "{name} in f32: {worst32:e}");
    }
}

/// Where a formula ends the result is no number, as on the GPU, and not some number: a run must find out.
#[test]
fn what_has_no_value_has_none() {
    let text = "fn a(x: f32) -> f32 { return log(x); } fn b(x: f32) -> f32 { return pow(x, 0.3); } fn c(x: f32) -> f32 { return pow(x, 1.0 / 3.0); }
fn d(x: f32) -> f32 { return sqrt(x); } fn e(x: f32) -> f32 { return select(sqrt(x), 7.0, x < 0.0); }";
    let source = ProgramSource::read(text).unwrap_or_else(|wrong| panic!("{wrong:?}"));
    let value = |name: &str, x: f64| {
        let program = source.translate(name, &BTreeMap::new()).unwrap_or_else(|wrong| panic!("{wrong:?}"));
        program.run::<f64, 1, 1>([x])[0]
    };
    for name in ["a", "b", "c", "d"] {
        assert!(value(name, -0.5).is_nan(), "{name}");
    }
    assert_eq!((value("b", 0.0), value("c", 0.0), value("e", -1.0)), (0.0, 0.0, 7.0));
}

/// Constants have all digits of f64, though WGSL has f32 only; what is not used costs nothing.
#[test]
fn programs_are_short_and_constants_exact() {
    let text = "fn f(x: f32) -> f32 { let third = 1.0 / 3.0; let unused = exp(x) * 2.0; let y = x * third; return y + (x * third); }";
    let source = ProgramSource::read(text).unwrap_or_else(|wrong| panic!("{wrong:?}"));
    let program = source.translate("f", &BTreeMap::new()).unwrap_or_else(|wrong| panic!("{wrong:?}"));
    assert_eq!(program.run::<f64, 1, 1>([3.0])[0], 2.0);
    // one product, one sum
    assert_eq!(program.size().0, 2);
}

/// WGSL's own functions of constants alone have their values, as in the text that goes to the GPU.
#[test]
fn functions_of_constants_have_their_values() {
    let cases = [
        ("abs(-2.0)", 2.0),
        ("abs(-gain)", 0.125),
        ("abs(vec2<f32>(-1, 2)).x", 1.0),
        ("max(-1.0 + 0.75, 1 / 3.0)", 1.0 / 3.0),
        ("min(gain, 3.0)", 0.125),
        ("clamp(-2.0, -0.5, 1.0)", -0.5),
        ("saturate(2.0)", 1.0),
        ("sign(-2.0)", -1.0),
        ("step(1.0, 2.0)", 1.0),
        ("sqrt(2.0)", std::f64::consts::SQRT_2),
        ("inverseSqrt(4.0)", 0.5),
        ("exp(1.0)", std::f64::consts::E),
        ("sin(0.5)", 0.479_425_538_604_203),
        ("cos(0.5)", 0.877_582_561_890_372_8),
        ("exp2(0.5)", std::f64::consts::SQRT_2),
        ("log(2.0)", std::f64::consts::LN_2),
        ("log2(8.0)", 3.0),
        ("pow(2.0, 0.5)", std::f64::consts::SQRT_2),
        ("fma(2.0, 3.0, 4.0)", 10.0),
        ("mix(1.0, 3.0, 0.25f)", 1.5),
        ("dot(vec2f(1.0, 2.0), vec2f(3.0, 4.0))", 11.0),
        ("cross(vec3f(1, 0, 0), vec3f(0, 1, 0)).z", 1.0),
        ("length(vec2f(3.0, 4.0))", 5.0),
        ("distance(2.0, 5.0)", 3.0),
        ("normalize(vec2f(3.0, 4.0)).x", 0.6),
        ("determinant(mat2x2f(1.0, 2.0, 3.0, 5.0))", -1.0),
        ("(1.0 + abs(-2.0)) * max(0.25, -1.0)", 0.75),
    ];
    for (call, expected) in cases {
        let text = format!("const gain: f32 = 0.125; fn f(x: f32) -> f32 {{ let value = {call}; return x * value; }}");
        let source = ProgramSource::read(&text).unwrap_or_else(|wrong| panic!("{call}: {wrong:?}"));
        let program = source.translate("f", &BTreeMap::new()).unwrap_or_else(|wrong| panic!("{call}: {wrong:?}"));
        let found = program.run::<f64, 1, 1>([1.0])[0];
        // logarithms and powers of them are right to a few roundings
        assert!((found - expected).abs() <= 4.0 * f64::EPSILON * (1.0 + expected.abs()), "{call} is {found}");
        let found = program.run::<f32, 1, 1>([1.0])[0];
        assert_eq!(found, expected as f32, "{call} in f32");
    }
}
