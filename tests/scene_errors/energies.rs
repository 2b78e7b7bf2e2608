//! Laws from an energy that are none: each mistake at its own place in the formula, or in the file.

use sinew::scene::Diagnostics;
use sinew::systems::Registry;
use sinew::{SceneFile, Simulation};
use std::time::{Duration, Instant};

fn complaints(law: &str, file: &str) -> Diagnostics {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("own.wgsl"), file).unwrap();
    let scene = format!(
        r#"(duration: 0.1, materials: {{"tissue": (density: 1000, law: (
{law}
))}},
bodies: {{"cube": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (1, 1, 1)), material: "tissue")}})"#
    );
    match SceneFile::from_text("cube.ron", &scene, folder.path(), &[]) {
        Err(diagnostics) => diagnostics,
        Ok(scene) => Simulation::check(&scene, &Registry::default()),
    }
}

fn brief(law: &str, file: &str) -> String {
    let diagnostics = complaints(law, file);
    let lines = diagnostics.lines();
    let told = lines.iter().zip(diagnostics.list()).map(|(line, complaint)| {
        let label = std::iter::once(complaint.label.clone()).filter(|label| !label.is_empty());
        label.chain(complaint.notes.clone()).fold(line.to_string(), |text, part| format!("{text} | {part}"))
    });
    told.collect::<Vec<_>>().join("\n")
}

const GOOD: &str = r#"energy: "mu/2*I1bar_minus_3 + kappa/2*J_minus_1^2",
parameters: {"mu": 1000, "kappa": 1e4}"#;

/// Cases: a piece of the good law, what replaces it, and how what is said of the result begins.
fn compare(cases: &[(&str, &str, &str)]) {
    let mut wrong = String::new();
    for (old, new, expected) in cases {
        assert!(GOOD.contains(old), "the good law has no {old}");
        let said = brief(&GOOD.replacen(old, new, 1), "");
        if expected.is_empty() || !said.starts_with(expected) || said.lines().count() != 1 {
            wrong += &format!("with {new}: {said}\n");
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

#[test]
fn a_sound_formula_is_not_complained_about() {
    assert_eq!(brief(GOOD, ""), "");
}

/// Powers of which a parameter is the exponent, and half powers, are no numbers only where they must not be.
#[test]
fn powers_by_parameters_are_powers() {
    for (formula, parameters) in [
        ("mu/2*I1bar_minus_3 + mu*I1bar_minus_3^n + kappa/2*J_minus_1^2", "\"mu\": 1000, \"n\": 2, \"kappa\": 1e4"),
        ("mu/2*I1bar_minus_3 + mu*I1bar_minus_3^1.5 + kappa/2*J_minus_1^2", "\"mu\": 1000, \"kappa\": 1e4"),
        ("mu/2*I1bar_minus_3 + mu*I2bar_minus_3^2.5 + kappa/2*J_minus_1^2", "\"mu\": 1000, \"kappa\": 1e4"),
        ("mu/a*(I1bar^a - 3^a) + kappa/a*(J^a - a*log(J))", "\"mu\": 1000, \"a\": 0.8, \"kappa\": 1e4"),
    ] {
        assert_eq!(brief(&format!("energy: \"{formula}\", parameters: {{{parameters}}}"), ""), "", "{formula}");
    }
}

#[test]
fn what_is_no_formula_is_told_at_its_place() {
    const VARIABLES: &str = "variables: I1bar_minus_3, I2bar_minus_3, J_minus_1, I1bar, I2bar, J";
    let unknown = "is neither a variable nor one of `parameters`";
    compare(&[
        (
            "mu/2",
            "mju/2",
            &format!(
                "cube.ron:2:10: error: `mju` {unknown} | did you mean `mu`? | {VARIABLES} | `parameters`: kappa, mu"
            ),
        ),
        ("\"mu\": 1000, ", "", &format!("cube.ron:2:10: error: `mu` {unknown}")),
        (
            "I1bar_minus_3",
            "I1_bar_minus_3",
            &format!("cube.ron:2:15: error: `I1_bar_minus_3` {unknown} | did you mean `I1bar_minus_3`?"),
        ),
        ("\"mu\": 1000", "\"mu\": \"soft\"", "cube.ron:3:20: error: `mu` must be a number | found a text"),
        ("\"mu\": 1000", "\"mu\": NaN", "cube.ron:3:20: error: "),
        (
            "\"mu\": 1000",
            "\"m u\": 5, \"mu\": 1000",
            "cube.ron:3:21: error: `m u` cannot be the name of a parameter | allowed: a letter, then letters, digits and `_`",
        ),
        ("\"mu\": 1000", "\"J\": 5, \"mu\": 1000", "cube.ron:3:19: error: `J` already has a meaning in a formula"),
        (
            "\"mu\": 1000",
            "\"b\": 5, \"mu\": 1000",
            "cube.ron:3:19: error: the formula does not have the parameter `b` | leave it out, or use it",
        ),
        (
            "I1bar_minus_3",
            "sinh(I1bar_minus_3)",
            "cube.ron:2:15: error: `sinh` is no function of formulas | did you mean `sin`? | functions: abs, ",
        ),
        ("I1bar_minus_3 +", "I1bar_minus_3; +", "cube.ron:2:28: error: `;` has no place in a formula | variables: "),
        ("mu/2", "mu/2u", "cube.ron:2:13: error: `2u` has no place in a formula"),
        ("mu/2", "mu/0x2", "cube.ron:2:13: error: `0x2` has no place in a formula"),
        ("mu/2*", "mu/2*(", "cube.ron:2:15: error: this bracket is not closed"),
        ("J_minus_1^2", "J_minus_1^2)", "cube.ron:2:50: error: this bracket closes none"),
        ("J_minus_1^2", "J_minus_1^", "cube.ron:2:48: error: the exponent is missing"),
        ("J_minus_1^2", "(J_minus_1^)", "cube.ron:2:50: error: an exponent is missing before this bracket"),
        ("mu/2*", "mu^*", "cube.ron:2:13: error: an exponent is missing before `*`"),
        ("I1bar_minus_3 +", "^2 +", "cube.ron:2:15: error: there is nothing before `^` to raise to a power"),
        ("mu/2*", "mu/*", "cube.ron:2:12: error: `/*I1bar_minus_3 + kappa/2*J_minus_1^2` has no place in a formula"),
        ("mu/2*", "mu/2 ", "cube.ron:2:15: error: an operator is missing before this"),
        ("mu/2*", "mu/2*exp(1)(2)*", "cube.ron:2:21: error: an operator is missing before this"),
        ("J_minus_1^2", "", "cube.ron:2:38: error: expected expression, found"),
        ("J_minus_1^2", "max(J_minus_1)", "cube.ron:2:39: error: wrong number of arguments: expected 2, found 1"),
        ("mu/2*", "mu/2*1e300*", "cube.ron:2:15: error: "),
    ]);
}

#[test]
fn what_is_no_law_is_told_with_what_it_lacks() {
    compare(&[
        (
            "kappa/2*",
            "kappa*J_minus_1 + kappa/2*",
            "cube.ron:2:9: error: the energy's pressure is not 0 at rest: 1.0000e4 Pa | an undeformed body has no stress",
        ),
        (
            "\"mu\": 1000",
            "\"mu\": -1000",
            "cube.ron:2:9: error: the shear modulus at small strains is -1000.0000 Pa: it must be above 0",
        ),
        (
            "\"kappa\": 1e4",
            "\"kappa\": -1e4",
            "cube.ron:2:9: error: the bulk modulus at small strains is -10000.0000 Pa: it must be above 0",
        ),
        ("mu/2*I1bar_minus_3 + ", "0*mu + ", "cube.ron:2:9: error: the shear modulus at small strains is 0.0000 Pa"),
        (
            "mu/2*I1bar_minus_3",
            "mu*log(I1bar_minus_3)",
            "cube.ron:2:9: error: the energy's isochoric stress is NaN at rest",
        ),
        ("I1bar_minus_3", "sqrt(I1bar_minus_3)", "cube.ron:2:9: error: the energy's isochoric stress is "),
        (
            "\"kappa\": 1e4",
            "\"kappa\": 0",
            "cube.ron:2:9: error: the bulk modulus at small strains is 0.0000 Pa: it must be above 0 | κ is what the \
             pressure grows by with `J_minus_1` at rest",
        ),
        (
            "J_minus_1^2",
            "J_minus_1^2*I1bar",
            "cube.ron:2:10: error: the energy is no sum of one of `I1bar` and `I2bar` and one of `J`",
        ),
        (
            "energy: \"mu/2*I1bar_minus_3 + kappa/2*J_minus_1^2\"",
            "energy: \" \"",
            "cube.ron:2:9: error: the formula is empty",
        ),
        ("energy:", "file: \"own.wgsl\", energy:", "cube.ron:2:7: error: the law has both `energy` and `file`"),
        (
            "energy: \"mu/2*I1bar_minus_3 + kappa/2*J_minus_1^2\",",
            "",
            "cube.ron:1:60: error: the law has neither `energy` nor `file`",
        ),
    ]);
}

/// A formula that is written with backslashes is marked as a whole.
#[test]
fn a_formula_with_backslashes_is_marked_as_a_whole() {
    assert!(brief(&GOOD.replace("mu/2", "\\u{6d}ju/2"), "").starts_with("cube.ron:2:9: error: `mju` is neither"));
}

const FILE: &str = "struct Law { mu: f32, kappa: f32 }
@group(0) @binding(0) var<uniform> elastic: Law;
fn elastic_energy(s: Invariants) -> f32 {
    return elastic.mu / 2 * s.I1bar_minus_3 + elastic.kappa / 2 * s.J_minus_1 * s.J_minus_1;
}
";

#[test]
fn energies_in_files_are_told_of_at_their_lines() {
    let law = r#"file: "own.wgsl", parameters: {"mu": 1000, "kappa": 1e4}"#;
    assert_eq!(brief(law, FILE), "");
    let mut wrong = String::new();
    for (old, new, expected) in [
        ("s.I1bar_minus_3", "s.I1", "own.wgsl:4:"),
        ("(s: Invariants)", "(s: f32)", "own.wgsl:4:"),
        ("kappa / 2 *", "kappa *", ""),
        (
            "-> f32 {\n    return elastic.mu",
            "-> f32 {\n    return s.J_minus_1 * elastic.mu",
            "own.wgsl:3:1: error: the energy is no sum of one of",
        ),
        ("elastic.kappa / 2", "- elastic.kappa", "own.wgsl:3:4: error: the bulk modulus at small strains is -"),
        ("kappa: f32 }", "bulk: f32, kappa: f32 }", "cube.ron:2:31: error: the energy needs the parameter `bulk`"),
        ("fn elastic_energy", "fn elastic_pressure", "own.wgsl: error: the law has no function `elastic_isochoric`"),
        (
            "fn elastic_energy",
            "fn elastic_enery",
            "own.wgsl:3:4: error: the law has no function `elastic_energy`, and none of those of its stresses | is \
             `elastic_enery` meant to be `elastic_energy`? | its energy alone will do: fn elastic_energy(s: Invariants) \
             -> f32 | else it must have all of: fn elastic_isochoric(k: Kinematics) -> Sym3, ",
        ),
        // derivatives of what is just short enough are too long
        (
            "    return",
            "    var x = s.J;\n    for (var i = 0; i < 900; i++) { x = x * sin(x * s.J) + exp(x) * cos(x / s.J) + \
             sqrt(x) * log(x) * s.J / x; }\n    return x +",
            "own.wgsl:3:1: error: the derivatives of this have ",
        ),
    ] {
        assert!(FILE.contains(old), "{old}");
        let said = brief(law, &FILE.replacen(old, new, 1));
        if !said.starts_with(expected) || said.is_empty() != expected.is_empty() {
            wrong += &format!("with {new}: {said}\n");
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

/// Formulas that are too long or too deep are told so at once, and no stack overflows.
#[test]
fn a_formula_beyond_all_bounds_is_told_so() {
    for n in [100, 10_000] {
        let deep = [
            format!("{}J_minus_1", "-".repeat(n)),
            format!("{}J{}", "(".repeat(n), ")".repeat(n)),
            format!("J{}", "^J".repeat(n)),
            format!("J{}", " + J".repeat(n)),
            format!("{}J{}", "exp(".repeat(n), ")".repeat(n)),
            "(".repeat(n),
            "J ".repeat(3 * n),
        ];
        for energy in deep {
            let started = Instant::now();
            let said = brief(&GOOD.replace("J_minus_1^2", &energy), "");
            assert!(n == 100 || said.contains("error: a formula has at most"), "{energy:.20}: {said:.300}");
            assert!(started.elapsed() < Duration::from_secs(10), "{energy:.20} took {:?}", started.elapsed());
        }
    }
    // what the message allows is allowed
    for (term, n) in [(" + J_minus_1", 480), (" + 0*kappa", 240), (" + 0*J_minus_1^2", 110)] {
        let said = brief(&GOOD.replace("kappa/2*J_minus_1^2", &format!("kappa*J_minus_1^2{}", term.repeat(n))), "");
        assert!(!said.contains("at most"), "{n} times{term}: {said:.300}");
    }
    let said = brief(&GOOD.replace("mu/2", &format!("mu/2{}", " ".repeat(70_000))), "");
    assert!(said.contains("error: a formula has at most 65536 bytes"), "{said:.300}");
}
