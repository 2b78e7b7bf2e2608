//! Parameters that differ from copy to copy: what is wrong with them, and in which copy.

use crate::complaints::told_of;

/// What is said of a body with so many copies and what differs in them.
fn told(copies: u32, per_copy: &str) -> String {
    let text = format!(
        "(duration: 0.1, bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (1, 1, 1)), material: \"m\", copies: {copies},
    per_copy: {{{per_copy}}})}},
materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45),
        fibres: (eta: 0, direction: Along(0, 0, 1)), exponential_fibres: [(k1: 5, k2: 1, direction: Along(0, 0, 1)),
            (k1: 5, k2: 1, direction: Around(center: (0, 0, -1), axis: (0, 1, 0)))]),
    \"other\": (density: 1000, law: (energy: \"mu*I1bar_minus_3 + k*J_minus_1^2\", parameters: {{\"mu\": 100, \"k\": 900}}))}})"
    );
    let told = told_of(&text, std::path::Path::new("."));
    told.lines().filter(|line| !line.contains("no body uses")).collect::<Vec<_>>().join("\n")
}

#[test]
fn parameters_that_copies_can_have_are_no_mistake() {
    let well = [
        "\"m.neo_hookean.young\": Linear(500, 2000)",
        "\"m.neo_hookean.young\": LogUniform(from: 500, to: 2e4), \"m.neo_hookean.poisson\": Uniform(from: 0.3, to: 0.4, seed: 7)",
        "\"m.exponential_fibres[0].k1\": Values([0, 1, 2])",
        "\"m.exponential_fibres[0].direction\": Directions(), \"m.density\": Linear(900, 1100)",
        "\"m.exponential_fibres[0].direction[1]\": Linear(-1, 1), \"m.exponential_fibres[1].direction.axis[2]\": Linear(-1, 1)",
    ];
    for per_copy in well {
        assert_eq!(told(3, per_copy), "", "{per_copy}");
    }
}

#[test]
fn what_is_wrong_is_told_with_the_copy_and_what_is_allowed() {
    let cases = [
        (1, "\"m.neo_hookean.young\": Linear(1, 2)", "error: the body has one copy only | give the body `copies`"),
        (3, "\"young\": Linear(1, 2)", "error: `young` names no parameter of a material | such as"),
        (3, "\"n.neo_hookean.young\": Linear(1, 2)", "error: the body has no material `n` | "),
        (3, "\"other.law.parameters.mu\": Linear(1, 2)", "error: the body has no material `other` | "),
        (
            3,
            "\"m.neo_hookean.yuong\": Linear(1, 2)",
            "error: `neo_hookean.yuong` of the material `m` cannot differ from copy to copy | did you mean `neo_hookean.young`?",
        ),
        (3, "\"m.density\": Values([1, 0, 2])", "error: copy 1, with m.density = 0: `density` must be above 0"),
        (
            3,
            "\"m.exponential_fibres[0].dispersion\": Linear(0, 0.1)",
            "error: `exponential_fibres[0].dispersion` of the material `m` cannot differ from copy to copy | ",
        ),
        (
            3,
            "\"m.exponential_fibres[0].direction\": Axes(x: Linear(-1, 1), y: Linear(0, 0), z: Linear(0, 0))",
            "error: copy 1, with m.exponential_fibres[0].direction[0] = 0, m.exponential_fibres[0].direction[1] = 0, \
             m.exponential_fibres[0].direction[2] = 0: ",
        ),
        (
            3,
            "\"m.neo_hookean.young\": Directions()",
            "error: `neo_hookean.young[0]` of the material `m` cannot differ from copy to copy | ",
        ),
        (
            3,
            "\"m.exponential_fibres[0].direction\": Axes(x: Directions(), y: Linear(0, 1), z: Linear(0, 1))",
            "error: a component of a vector is one number a copy",
        ),
        (
            3,
            "\"m.exponential_fibres[0].direction\": Axes(x: Values([1]), y: Linear(0, 1), z: Linear(0, 1))",
            "error: there are 1 values for 3 copies | give one a copy",
        ),
        (3, "\"m.damping\": Linear(1, 2)", "error: `damping` of the material `m` cannot differ from copy to copy | "),
        (3, "\"m.fibres.eta\": Linear(1, 2)", "error: the material `m` has fibres of no stiffness: what has no weight"),
        (3, "\"m.fibres.direction[0]\": Linear(1, 2)", "error: the material `m` has fibres of no stiffness: "),
        (3, "\"m.neo_hookean.young\": Values([1e3, 2e3])", "error: there are 2 values for 3 copies | give one a copy"),
        (
            3,
            "\"m.neo_hookean.young\": LogUniform(from: 0, to: 1)",
            "error: `LogUniform` lies between numbers above 0, found 0 and 1",
        ),
        (3, "\"m.neo_hookean.young\": Uniform(from: 3, to: 2)", "error: `from` must not be above `to`, found 3 and 2"),
        (
            3,
            "\"m.neo_hookean.young\": Values([1e3, 1e3, -2]), \"m.exponential_fibres[0].k2\": Linear(1, 2)",
            "error: copy 2, with m.neo_hookean.young = -2, m.exponential_fibres[0].k2 = 2: `young` must be above 0, found -2 Pa",
        ),
        (
            3,
            "\"m.neo_hookean.poisson\": Linear(0.3, 0.6)",
            "error: copy 2, with m.neo_hookean.poisson = 0.6: `poisson` must be between -1 and 0.5, found 0.6",
        ),
        (
            3,
            "\"m.neo_hookean.young\": Linear(1, 2), \"m.\\\"neo_hookean\\\".young\": Linear(1, 2)",
            "error: `m.neo_hookean.young` stands here twice, written otherwise",
        ),
    ];
    for (copies, per_copy, wanted) in cases {
        let found = told(copies, per_copy);
        assert!(found.contains(wanted) && found.lines().count() == 1, "{per_copy}: {found}");
    }
}

/// What is said of a body of a material with three copies and what differs in them, beside `more` of the scene.
fn told_of_material(material: &str, per_copy: &str, more: &str) -> String {
    let text = format!(
        "(duration: 0.1, bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (1, 1, 1)), material: \"{material}\", copies: 3,
    per_copy: {{{per_copy}}})}},
materials: {{\"damped\": (density: 1000, damping: 0, stiffness_damping: 0, neo_hookean: Young(young: 3e3, poisson: 0.45),
        prony: (terms: [(alpha: 0, tau: 1), (alpha: 0.5, tau: 1)])),
    \"own\": (density: 1000, prony: (terms: [(alpha: 0.5, tau: 1)]), fibres: (eta: 5, direction: Along(0, 0, 1)),
        law: (energy: \"mu*I1bar_minus_3 + k*J_minus_1^2\", parameters: {{\"mu\": 100, \"k\": 900}}))}}, {more})"
    );
    let told = told_of(&text, std::path::Path::new("."));
    told.lines().filter(|line| line.contains("error: ")).collect::<Vec<_>>().join("\n")
}

#[test]
fn what_has_no_weight_or_is_a_law_of_ones_own_is_the_same_in_all_copies() {
    let removal = "removal: [(when: StretchAbove(2))]";
    let cases = [
        ("damped", "damping", "", "the material `damped` has damping of 0: what has no weight does not exist"),
        ("damped", "stiffness_damping", "", "the material `damped` has damping of 0"),
        ("damped", "prony.terms[0].tau", "", "the material `damped` has a term of viscosity of no share"),
        ("damped", "prony.terms[1].tau", "", ""),
        (
            "damped",
            "density",
            removal,
            "`density` cannot differ in a body that loses elements | what takes elements away",
        ),
        ("damped", "prony.terms[1].tau", removal, ""),
        ("own", "prony.terms[0].tau", "", "what its elements remember, are the same in all copies"),
        ("own", "density", "", ""),
        ("own", "fibres.direction[1]", "", ""),
    ];
    for (material, place, more, wanted) in cases {
        let found = told_of_material(material, &format!("\"{material}.{place}\": Values([1, 2, 3])"), more);
        assert!(found.contains(wanted) && found.is_empty() == wanted.is_empty(), "{material} {place}: {found}");
    }
}

#[test]
fn factors_of_loads_and_motion_are_one_a_copy() {
    let told = |copies: u32, action: &str| {
        let text = format!(
            "(duration: 0.1, bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (1, 1, 1)), material: \"m\", copies: {copies})}},
materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}},
constraints: [Fixed(on: Set(\"z0\")),
    {action}])"
        );
        told_of(&text, std::path::Path::new("."))
    };
    let pressure = |per_copy: &str| format!("], loads: [Pressure(on: Set(\"z1\"), pressure: 1, per_copy: {per_copy})");
    assert_eq!(told(2, &pressure("Values([1, 2])")), "");
    assert!(told(2, &pressure("Values([1])")).contains("error: there are 1 values for 2 copies"));
    let axes = "Axes(x: Linear(1, 2), y: Linear(0, 0), z: Linear(0, 1))";
    assert!(told(2, &pressure(axes)).contains("error: a pressure has no direction of its own: one number a copy"));
    let gravity = |of: &str| format!("], loads: [Gravity({of} acceleration: (0, 0, -9.81), per_copy: {axes})");
    assert_eq!(told(2, &gravity("body: \"b\",")), "");
    assert!(told(2, &gravity("")).contains("error: gravity on all bodies is the same in all copies | name the `body`"));
    assert!(told(1, &pressure("Linear(1, 2)")).contains("error: the body has one copy only"));
    // what has the same number along all axes is turned by that, other vectors are not
    for (action, number) in [
        ("], loads: [Gravity(body: \"b\", acceleration: V, per_copy: Directions())", "3"),
        ("], loads: [NodalForce(on: Set(\"z1\"), force: V, per_copy: Directions())", "0.003"),
        ("], loads: [Traction(on: Set(\"z1\"), traction: V, per_copy: Directions())", "0.003"),
        ("Prescribed(on: Set(\"z1\"), displacement: V, per_copy: Directions(), curve: Smooth(end: 0.1))", "0.003"),
    ] {
        let even = format!("({number}, {number}, {number})");
        assert_eq!(told(2, &action.replace('V', &even)), "", "{action}");
        let askew = format!("(0, 0, -{number})");
        let found = told(2, &action.replace('V', &askew));
        let wanted =
            format!("`Directions` multiplies {askew} component by component: that does not turn it | {even} is");
        assert!(found.contains(&format!("warning: {wanted}")) && found.lines().count() == 1, "{action}: {found}");
    }
    let turned =
        told(2, "Prescribed(on: Set(\"z1\"), rotation: (0, 0, 5), per_copy: Linear(1, 2), curve: Smooth(end: 0.1))");
    assert!(turned.contains("error: a rotation is the same in all copies"), "{turned}");
}

/// A material of a part has the part's name before its own, also where copies differ.
#[test]
fn parts_bring_bodies_whose_copies_differ() {
    let part = "(bodies: {\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (1, 1, 1)), material: \"m\", copies: 2,
        per_copy: {\"m.neo_hookean.young\": Values([2e3, -1])})},
    materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))})";
    let files = std::collections::BTreeMap::from([("part.ron".to_string(), part.as_bytes().to_vec())]);
    let text = "(duration: 0.1, parts: {\"p\": (scene: \"part.ron\")})";
    let scene = sinew::SceneFile::from_memory("scene.ron", text, files, &[]).unwrap();
    let mut told = scene.diagnostics();
    sinew::scene::validate(&scene, &mut told);
    let told = told.render(false);
    assert!(
        told.contains("copy 1, with p.m.neo_hookean.young = -1") || told.contains("copy 1, with \"p.m\".neo"),
        "{told}"
    );
}
