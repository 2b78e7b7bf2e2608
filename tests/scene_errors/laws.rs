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
    return 0.5 * elastic.mu * i1_change(k);
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
fn what_is_not_written_as_a_law_is_told_at_its_line() {
    compare(&[
        (
            "return elastic.bulk * change;",
            "return elastic.bulk * chnge;",
            "own.wgsl:14:27: error: no definition in scope for identifier: `chnge` | unknown identifier",
        ),
        (
            "return elastic.bulk * change;",
            "return elastic.bulk * change",
            r#"own.wgsl:15:1: error: expected `;`, found "}" | expected `;`"#,
        ),
        (
            "return elastic.bulk * change;",
            "return elastic.bulk * k;",
            "own.wgsl:14:27: error: no definition in scope for identifier: `k` | unknown identifier",
        ),
        (
            "return elastic.bulk * change;",
            "return 1.0; }\nfn minor(x: f32) -> f32 { return x;",
            "own.wgsl:15:4: error: `minor` is a name of sinew's own (shaders/tensor.wgsl) | choose another name",
        ),
        // kernels have a function of this name, which a law does not meet
        ("return elastic.bulk * change;", "return elastic.bulk * change; }\nfn place() -> f32 { return 0.0;", ""),
        (
            "fn elastic_pressure(change: f32)",
            "fn elastic_presure(change: f32)",
            "own.wgsl:13:4: error: the law has no function `elastic_pressure` | is `elastic_presure` meant to be it? | it must be: fn elastic_pressure(volume_change: f32) -> f32",
        ),
        (
            "fn elastic_pressure(change: f32) -> f32",
            "fn elastic_pressure(k: Kinematics) -> f32",
            "own.wgsl:14:27: error: no definition in scope for identifier: `change` | unknown identifier",
        ),
        (
            "fn elastic_pressure(change: f32) -> f32 {\n    return elastic.bulk * change;",
            "fn elastic_pressure(change: f32) -> vec3<f32> {\n    return vec3(elastic.bulk * change);",
            "own.wgsl:13:4: error: `elastic_pressure` takes and gives something else: (f32) -> vec3<f32> | it must be: fn elastic_pressure(volume_change: f32) -> f32",
        ),
        (
            "elastic: Law;",
            "elastic: Law;\nvar<private> last: f32;",
            "own.wgsl:6:14: error: `last` is a variable outside of all functions: a law has none | a stress depends on the deformation and the parameters alone",
        ),
        (
            "elastic: Law;",
            "elastic: Law;\n@group(0) @binding(1) var<storage, read_write> table: array<f32>;",
            "own.wgsl:6:48: error: `table` is a storage buffer: a law has none | a stress depends on the deformation and the parameters alone",
        ),
        (
            "elastic: Law;",
            "elastic: Law;\n@group(0) @binding(1) var<uniform> more: Law;",
            "own.wgsl:6:36: error: the parameters of a law must be called `elastic`, found `more` | @group(0) @binding(0) var<uniform> elastic: YourStruct;",
        ),
        (
            "elastic: Law;",
            "elastic: Law;\noverride gain: f32 = 1.0;",
            "own.wgsl:6:10: error: `gain` is an `override`: nothing would set it | parameters are members of the struct of `var<uniform> elastic`",
        ),
        (
            "elastic: Law;",
            "elastic: Law;\n@compute @workgroup_size(64) fn main() {}",
            "own.wgsl:6:33: error: `main` is an entry point: a law has none | the element kernel calls the law's functions; leave out @compute and @workgroup_size",
        ),
        (
            "bulk: f32,",
            "bulk: f32,\n    axis: vec3<f32>,",
            "own.wgsl:4:5: error: the parameter `axis` must be of type f32, found vec3<f32> | a vector or a table: one member for each number",
        ),
        (
            "bulk: f32,",
            "bulk: f32,\n    gamma: f32,",
            "cube.ron:1:91: error: the law needs the parameter `gamma` | the parameters of own.wgsl: mu, bulk, gamma",
        ),
        (
            "    mu: f32,",
            "    my: f32,\n    mu: f32,",
            "cube.ron:1:91: error: the law needs the parameter `my` | the parameters of own.wgsl: my, mu, bulk",
        ),
        (
            "return elastic.bulk * change;",
            "return elastic.bulk * tan(change);",
            "own.wgsl:14:27: error: this function is not there for a text of one's own | allowed: abs, all, any, clamp, cos, cross, determinant, distance, dot, exp, exp2, fma, inverseSqrt, length, log, log2, max, min, mix, normalize, outer, pow, saturate, select, sign, sin, sqrt, step, tanh, transpose",
        ),
        (
            "return elastic.bulk * change;",
            "var p = change; for (var i = 0; i < i32(p); i++) { p += 1.0; } return p;",
            "own.wgsl:14:41: error: a number that differs from element to element or node to node cannot become a whole one",
        ),
        (
            "return elastic.bulk * change;",
            "var p = change; while (p > 0.0) { p -= 1.0; } return p;",
            "own.wgsl:14:21: error: this loop is still going after 1000 rounds | count its rounds by a whole number up to a constant: for (var i = 0; i < 8; i++) { ... }",
        ),
        (
            "return elastic.bulk * change;",
            "let t = array<f32, 2>(1.0, 2.0); let i = u32(change); return t[i];",
            "own.wgsl:14:46: error: a number that differs from element to element or node to node cannot become a whole one",
        ),
        (
            "return elastic.bulk * change;",
            "var p = change; grow(&p); return p; }\nfn grow(p: ptr<function, f32>) { *p = 2.0 * *p;",
            "own.wgsl:14:21: error: a pointer cannot be handed to a function | let the function return its result, as a struct when there are several",
        ),
        (
            "return elastic.bulk * change;",
            "return elastic.bulk * bitcast<f32>(bitcast<u32>(change));",
            "own.wgsl:14:27: error: the bits of a number cannot be read: a law is computed in several precisions
own.wgsl:14:40: error: the bits of a number cannot be read: a law is computed in several precisions",
        ),
    ]);
}

#[test]
fn what_is_written_as_a_law_and_is_none_is_told_with_the_place_and_the_numbers() {
    compare(&[
        (
            "return elastic.bulk * change;",
            "return elastic.bulk * (change + 0.01);",
            "own.wgsl:13:4: error: `elastic_pressure` is not 0 at rest: 1.0000e2 Pa | an undeformed body has no stress",
        ),
        (
            "return elastic.bulk * change;",
            "return elastic.bulk * change * change / change;",
            "own.wgsl:13:4: error: `elastic_pressure` is NaN at rest | a law must be finite at rest and around it: 0/0 and ln 0 there need a series or another form",
        ),
        (
            "return elastic.bulk * change;",
            "return -elastic.bulk * change;",
            "own.wgsl:13:4: error: the bulk modulus at small strains is -10000.0000 Pa: it must be above 0 | κ is what the pressure grows by with `volume_change` at rest",
        ),
        (
            "2.0 * elastic.mu",
            "elastic.mu",
            "own.wgsl:7:4: error: `elastic_isochoric` is not the derivative of `elastic_isochoric_energy`: -0.281119 Pa, the derivative -0.562238 Pa | at ∇u = [0.000, -0.001, 0.001; 0.001, 0.000, 0.001; -0.000, -0.001, 0.001] | it is 0.5000 times the derivative everywhere: a factor too much or too little?",
        ),
        (
            "return 0.5 * elastic.bulk * change * change;",
            "return 0.5 * elastic.bulk * change * change * (1.0 + change);",
            "own.wgsl:13:4: error: `elastic_pressure` is not the derivative of `elastic_volumetric_energy`: -3000.000000 Pa, the derivative -1650.000000 Pa | at volume_change = -0.3",
        ),
        (
            "e.diagonal - sym_trace(e) / 3.0",
            "vec3(2.0, 1.0, 1.0) * (e.diagonal - sym_trace(e) / 3.0)",
            "own.wgsl:7:4: error: the law is not isotropic: its shear moduli in xy, yz, xz are 1000.0000, 1000.0000, 1000.0000 Pa | use the strains in `k` as a whole, by sym_trace and sym_times_coaxial; directions come with a material's `fibres`",
        ),
        (
            "sym_trace(e) / 3.0, e.others",
            "sym_trace(e) / 3.0, vec3(1.0, 2.0, 1.0) * e.others",
            "own.wgsl:7:4: error: the law is not isotropic: its shear moduli in xy, yz, xz are 1000.0000, 2000.0000, 1000.0000 Pa | use the strains in `k` as a whole, by sym_trace and sym_times_coaxial; directions come with a material's `fibres`",
        ),
    ]);
}

#[test]
fn parameters_and_files_that_do_not_fit_are_told_in_the_scene() {
    let cases = [
        (
            r#"law: (file: "own.wgsl")"#,
            "cube.ron:1:60: error: the law needs the parameter `mu` | the parameters of own.wgsl: mu, bulk
cube.ron:1:60: error: the law needs the parameter `bulk` | the parameters of own.wgsl: mu, bulk",
        ),
        (
            r#"law: (file: "own.wgsl", parameters: {"mu": 1, "bulk": 2, "bulkk": 3})"#,
            "cube.ron:1:121: error: the law has no parameter `bulkk` | did you mean `bulk`? | the parameters of own.wgsl: mu, bulk",
        ),
        (
            r#"law: (file: "own.wgsl", parameters: {"mu": 0, "bulk": 2})"#,
            "own.wgsl:7:4: error: the shear modulus at small strains is 0.0000 Pa: it must be above 0 | 2 μ is what the stress grows by with the shear strain at rest",
        ),
        (
            r#"law: (file: "other.wgsl")"#,
            "cube.ron:1:67: error: there is no file `other.wgsl` | paths are relative to the scene file",
        ),
        (
            r#"law: (file: "")"#,
            "cube.ron:1:67: error: the law has neither `energy` nor `file` nor `rust` | for instance energy: \"mu/2*I1bar_minus_3 + kappa/2*J_minus_1^2\", parameters: {\"mu\": 1000, \"kappa\": 1e4} | or file: \"law.wgsl\", a law in WGSL",
        ),
        (
            r#"law: (file: "own.wgsl", parameters: {"mu": 1, "bulk": 2}), neo_hookean: Moduli(shear: 1, bulk: 2)"#,
            "cube.ron:1:60: error: the material `tissue` has two elastic laws, neo_hookean and law | a material has exactly one: leave the others out",
        ),
    ];
    for (material, expected) in cases {
        assert_eq!(brief(GOOD, material), expected, "with {material}");
    }
}

/// A deviator as a small difference of large numbers.
#[test]
fn digits_that_f32_would_lose_are_warned_of() {
    compare(&[(
        "let deviator = Sym3(e.diagonal - sym_trace(e) / 3.0, e.others);",
        "let c = 100.0 + e.diagonal; let deviator = Sym3(c - (c.x + c.y + c.z) / 3.0, e.others);",
        "own.wgsl:7:4: warning: in f32 the stress errs by 16.5 % at strains of 1e-4: digits are lost | differences of large numbers, such as Ī₁ − 3, lose them: compute from `k.green_strain` and `k.volume_change`, which are exact for small strains",
    )]);
}

#[test]
fn a_factor_that_is_missing_is_found_and_named() {
    let text = complaints(&GOOD.replacen("2.0 * elastic.mu", "elastic.mu", 1), MATERIAL).render(false);
    assert_eq!(
        text,
        "error: `elastic_isochoric` is not the derivative of `elastic_isochoric_energy`: -0.281119 Pa, the derivative -0.562238 Pa
  ┌─ own.wgsl:7:4
  │
7 │ fn elastic_isochoric(k: Kinematics) -> Sym3 {
  │    ^^^^^^^^^^^^^^^^^
  │
  = at ∇u = [0.000, -0.001, 0.001; 0.001, 0.000, 0.001; -0.000, -0.001, 0.001]
  = it is 0.5000 times the derivative everywhere: a factor too much or too little?

"
    );
}
