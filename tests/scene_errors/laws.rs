//! Laws of one's own that are none: each misuse at its own line of the law's file.

use sinew::scene::Diagnostics;
use sinew::systems::Registry;
use sinew::{SceneFile, Simulation};

/// A law that is sound.
const GOOD: &str = "struct Law {
    mu: f32,
    bulk: f32,
}
@group(0) @binding(0) var<uniform> elastic: Law;

fn elastic_isochoric(k: Kinematics) -> Sym3 {
    let e = k.green_strain;
    let deviator = Sym3(e.diagonal - sym_trace(e) / 3.0, e.others);
    return sym_scaled(sym_times_coaxial(k.adjugate_c, deviator), 2.0 * elastic.mu * k.j_m23 / (k.j * k.j));
}

fn elastic_pressure(change: f32) -> f32 {
    return elastic.bulk * change;
}

fn elastic_isochoric_energy(k: Kinematics) -> f32 {
    return 0.5 * elastic.mu * (k.j_m23 * (3.0 + 2.0 * sym_trace(k.green_strain)) - 3.0);
}

fn elastic_volumetric_energy(change: f32) -> f32 {
    return 0.5 * elastic.bulk * change * change;
}
";

fn complaints(law: &str, material: &str) -> Diagnostics {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("own.wgsl"), law).unwrap();
    let scene = format!(
        r#"(duration: 0.1, materials: {{"tissue": (density: 1000, {material})}},
bodies: {{"cube": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (1, 1, 1)), material: "tissue")}})"#
    );
    match SceneFile::from_text("cube.ron", &scene, folder.path(), &[]) {
        Err(diagnostics) => diagnostics,
        Ok(scene) => Simulation::check(&scene, &Registry::default()),
    }
}

fn brief(law: &str, material: &str) -> String {
    let diagnostics = complaints(law, material);
    let lines = diagnostics.lines();
    let told = lines.iter().zip(diagnostics.list()).map(|(line, complaint)| {
        let label = std::iter::once(complaint.label.clone()).filter(|label| !label.is_empty());
        label.chain(complaint.notes.clone()).fold(line.to_string(), |text, part| format!("{text} | {part}"))
    });
    told.collect::<Vec<_>>().join("\n")
}

const MATERIAL: &str = r#"law: (file: "own.wgsl", parameters: {"mu": 1000, "bulk": 1e4})"#;

/// Cases: a piece of the good law, what replaces it, and all that is said of the result.
fn compare(cases: &[(&str, &str, &str)]) {
    for (old, new, expected) in cases {
        assert!(GOOD.contains(old), "the good law has no {old}");
        assert_eq!(brief(&GOOD.replacen(old, new, 1), MATERIAL), *expected, "with {new}");
    }
}

#[test]
fn a_sound_law_is_not_complained_about() {
    assert_eq!(brief(GOOD, MATERIAL), "");
}

#[test]
fn print_all() {
    let cases = [
        ("return elastic.bulk * change;", "return elastic.bulk * chnge;"),
        ("return elastic.bulk * change;", "return elastic.bulk * change"),
        ("return elastic.bulk * change;", "return elastic.bulk * k;"),
        ("return elastic.bulk * change;", "return 1.0; }\nfn minor(x: f32) -> f32 { return x;"),
        ("return elastic.bulk * change;", "return elastic.bulk * change; }\nfn place() -> f32 { return 0.0;"),
        ("fn elastic_pressure(change: f32)", "fn elastic_presure(change: f32)"),
        ("fn elastic_pressure(change: f32) -> f32", "fn elastic_pressure(k: Kinematics) -> f32"),
        (
            "fn elastic_pressure(change: f32) -> f32 {\n    return elastic.bulk * change;",
            "fn elastic_pressure(change: f32) -> vec3<f32> {\n    return vec3(elastic.bulk * change);",
        ),
        ("elastic: Law;", "elastic: Law;\nvar<private> last: f32;"),
        ("elastic: Law;", "elastic: Law;\n@group(0) @binding(1) var<storage, read_write> table: array<f32>;"),
        ("elastic: Law;", "elastic: Law;\n@group(0) @binding(1) var<uniform> more: Law;"),
        ("elastic: Law;", "elastic: Law;\noverride gain: f32 = 1.0;"),
        ("elastic: Law;", "elastic: Law;\n@compute @workgroup_size(64) fn main() {}"),
        ("bulk: f32,", "bulk: f32,\n    axis: vec3<f32>,"),
        ("bulk: f32,", "bulk: f32,\n    gamma: f32,"),
        ("    mu: f32,", "    my: f32,\n    mu: f32,"),
        ("return elastic.bulk * change;", "return elastic.bulk * sin(change);"),
        ("return elastic.bulk * change;", "var p = change; for (var i = 0; i < i32(p); i++) { p += 1.0; } return p;"),
        ("return elastic.bulk * change;", "var p = change; while (p > 0.0) { p -= 1.0; } return p;"),
        ("return elastic.bulk * change;", "let t = array<f32, 2>(1.0, 2.0); let i = u32(change); return t[i];"),
        (
            "return elastic.bulk * change;",
            "var p = change; grow(&p); return p; }\nfn grow(p: ptr<function, f32>) { *p = 2.0 * *p;",
        ),
        ("return elastic.bulk * change;", "return elastic.bulk * bitcast<f32>(bitcast<u32>(change));"),
        ("return elastic.bulk * change;", "return elastic.bulk * (change + 0.01);"),
        ("return elastic.bulk * change;", "return elastic.bulk * change * change / change;"),
        ("return elastic.bulk * change;", "return -elastic.bulk * change;"),
        ("2.0 * elastic.mu", "elastic.mu"),
        (
            "return 0.5 * elastic.bulk * change * change;",
            "return 0.5 * elastic.bulk * change * change * (1.0 + change);",
        ),
        ("e.diagonal - sym_trace(e) / 3.0", "vec3(2.0, 1.0, 1.0) * (e.diagonal - sym_trace(e) / 3.0)"),
        ("sym_trace(e) / 3.0, e.others", "sym_trace(e) / 3.0, vec3(1.0, 2.0, 1.0) * e.others"),
        (
            "Sym3(e.diagonal - sym_trace(e) / 3.0, e.others);",
            "Sym3(vec3((k.j_m23 * (1.0 + 2.0 * e.diagonal) - k.j_m23 * (3.0 + 2.0 * sym_trace(e)) / 3.0) / (2.0 * k.j_m23)), e.others);",
        ),
    ];
    for (old, new) in cases {
        assert!(GOOD.contains(old), "{old}");
        println!("---- {new}\n{}", brief(&GOOD.replacen(old, new, 1), MATERIAL));
    }
    for material in [
        r#"law: (file: "own.wgsl")"#,
        r#"law: (file: "own.wgsl", parameters: {"mu": 1, "bulk": 2, "bulkk": 3})"#,
        r#"law: (file: "own.wgsl", parameters: {"mu": 0, "bulk": 2})"#,
        r#"law: (file: "other.wgsl")"#,
        r#"law: (file: "")"#,
        r#"law: (file: "own.wgsl", parameters: {"mu": 1, "bulk": 2}), neo_hookean: Moduli(shear: 1, bulk: 2)"#,
    ] {
        println!("---- {material}\n{}", brief(GOOD, material));
    }
    println!("{}", complaints(&GOOD.replacen("2.0 * elastic.mu", "elastic.mu", 1), MATERIAL).render(false));
}
