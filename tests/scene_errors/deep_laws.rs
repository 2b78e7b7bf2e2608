//! Laws of one's own that are too deep or too much: told at their place, in no time, and with no stack overflowing. A
//! test thread has two megabytes of stack; the command has eight.

use sinew::systems::Registry;
use sinew::{SceneFile, Simulation};
use std::time::{Duration, Instant};

const LAW: &str = include_str!("../../examples/own_law.wgsl");
/// Where text can be put into a function of the law, and what its first factor is.
const BODY: &str = "let factor = ";

/// The law with statements before its first, and something before its factor.
fn within(statements: &str, factor: &str) -> String {
    assert!(LAW.contains(BODY));
    LAW.replacen(BODY, &format!("{statements} let factor = {factor}"), 1)
}

fn numbered(n: usize, each: impl Fn(usize) -> String) -> String {
    (0..n).map(each).collect()
}

/// Texts that grow with a number, by what is much in them.
fn text(kind: &str, n: usize) -> String {
    let times = |part: &str| part.repeat(n);
    let around = |open: &str, close: &str| format!("{}1.0{}", times(open), times(close));
    match kind {
        "sums" => within("", &format!("{}0.0 + ", times("1.0 + "))),
        "sums of k" => within("", &format!("0.0 * ({}0.0) + ", times("k.j + "))),
        "statements" => within(&format!("var q = 0.0;\n{}", times("q += k.j * 1.5;\n")), "0.0 * q + "),
        "lets" => {
            let lets = numbered(n, |i| format!("let q{} = q{i} * 1.5;\n", i + 1));
            within(&format!("let q0 = k.j;\n{lets}"), &format!("0.0 * q{n} + "))
        }
        "else if" => {
            let branches = numbered(n, |i| format!("else if k.j > {i}.0 {{ q = 2.0; }} "));
            within(&format!("var q = 0.0; if k.j > 1.0 {{ q = 1.0; }} {branches}"), "")
        }
        "minus" => within("", &format!("0.0 * {}1.0 + ", times("- "))),
        "not" => within(&format!("let z = {}true;", times("!")), ""),
        "and" => within(&format!("let z = {}true;", times("true && ")), ""),
        "or of ands" => within(&format!("let z = {}true;", times("k.j > 1.0 && k.j < 2.0 || ")), ""),
        "comparisons" => within(&format!("let z = {}true;", times("true == ")), ""),
        "bits" => within(&format!("let z = {}1;", times("1 ^ ")), ""),
        "calls" => within("", &format!("0.0 * {}k.j{} + ", times("abs("), times(")"))),
        "brackets" => within("", &format!("0.0 * {} + ", around("(", ")"))),
        "open brackets" => within("", &times("(")),
        "indices" => within(&format!("let v = k.green_strain; let z = v{};", times(".diagonal")), ""),
        "brackets of indices" => within(&format!("let v = array(1); let z = v{};", around("[", "]")), ""),
        "references" => within(&format!("var q = 0.0; {}q = 1.0;", times("*&")), ""),
        "arrays" => format!("alias T = {}f32{};\n{LAW}", times("array<"), times(", 1>")),
        "open arrays" => format!("alias T = {}f32;\n{LAW}", times("array<1, ")),
        "aliases" => {
            let aliases = numbered(n, |i| format!("alias T{} = array<T{i}, 1>;\n", i + 1));
            format!("alias T0 = f32;\n{aliases}{LAW}")
        }
        "structs" => {
            let structs = numbered(n, |i| format!("struct A{} {{ x: A{i}, }}\n", i + 1));
            format!("struct A0 {{ x: f32, }}\n{structs}{LAW}")
        }
        "members" => format!("struct A {{ {} }}\n{LAW}", numbered(n, |i| format!("x{i}: f32, "))),
        "functions" => {
            let functions = numbered(n, |i| format!("fn g{}(x: f32) -> f32 {{ return g{i}(x); }}\n", i + 1));
            let law = within(&format!("let zz = g{n}(k.j);"), "0.0 * zz + ");
            format!("fn g0(x: f32) -> f32 {{ return x; }}\n{functions}{law}")
        }
        "twice the functions" => {
            let functions =
                numbered(n, |i| format!("fn g{}(x: f32) -> f32 {{ return g{i}(x) + g{i}(x + 1.0); }}\n", i + 1));
            let law = within(&format!("let zz = g{n}(k.j);"), "0.0 * zz + ");
            format!("fn g0(x: f32) -> f32 {{ return x; }}\n{functions}{law}")
        }
        "constants" => {
            let constants = numbered(n, |i| format!("const c{} = c{i} + 1.0;\n", i + 1));
            format!("const c0 = 1.0;\n{constants}{LAW}")
        }
        // every one twice the one before
        "doubled constants" => {
            let constants = numbered(n, |i| format!("const c{} = array(c{i}, c{i});\n", i + 1));
            let law = within(&format!("let zz = c{n}{};", times("[0]")), "0.0 * zz + ");
            format!("const c0 = 1.0;\n{constants}{law}")
        }
        "doubled values" => {
            let lets = numbered(n, |i| format!("let q{} = array(q{i}, q{i});\n", i + 1));
            within(&format!("let q0 = k.j;\n{lets}"), &format!("0.0 * q{n}{} + ", times("[0]")))
        }
        "variables" => within(&numbered(n, |i| format!("var v{i} = array<f32, 1000>(); ")), ""),
        "branches with variables" => {
            let variables = numbered(n, |i| format!("var v{i} = array<f32, 100>(); "));
            within(&format!("{variables} {}", times("if k.j > 1.0 { v0[1] = 2.0; } ")), "")
        }
        "zeros" => within(&format!("const z = array<f32, {n}000>(); let y = z[5];"), "0.0 * y + "),
        "cases" => {
            let cases = numbered(n, |i| format!("case {i}: {{ q = 1.0; }} "));
            within(&format!("var q = 0.0; switch 3 {{ {cases} default: {{ }} }}"), "")
        }
        "comments" => format!("{}{}\n{LAW}", times("/*"), times("*/")),
        "open comments" => format!("{LAW}{}", times("/*")),
        "lines of comments" => format!("{}{LAW}", times("// ///\n")),
        "ifs" => within(&format!("var q = 0.0; {}q = 1.0;{}", times("if k.j > 1.0 {"), times("}")), ""),
        "blocks" => within(&format!("{}{}", times("{"), times("}")), ""),
        "attributes" => format!("{}{LAW}", times("@const ")),
        "less than" => within(&format!("let z = a{};", times(" < a")), ""),
        "loops" => {
            let loops = times("for (var i = 0; i < 8; i = i + 1) { q += k.j; }\n");
            within(&format!("var q = 0.0; {loops}"), "0.0 * q + ")
        }
        "loops in loops" => {
            let heads = numbered(n, |i| format!("for (var i{i} = 0; i{i} < 2; i{i} = i{i} + 1) {{ "));
            within(&format!("var q = 0.0; {heads}q += k.j;{}", times("}")), "0.0 * q + ")
        }
        "products of matrices" => {
            within(&format!("var q = mat4x4<f32>(); {}", times("q = q * q;\n")), "0.0 * q[0][0] + ")
        }
        "long loops of products" => {
            let head = format!("for (var i = 0; i < {n}; i++) {{ q = q * q; }}\n");
            within(&format!("var q = mat4x4<f32>(); q[0][0] = k.j; {}", head.repeat(50)), "0.0 * q[0][0] + ")
        }
        _ => unreachable!("{kind}"),
    }
}

const KINDS: [&str; 42] = [
    "sums",
    "sums of k",
    "statements",
    "lets",
    "else if",
    "minus",
    "not",
    "and",
    "or of ands",
    "comparisons",
    "bits",
    "calls",
    "brackets",
    "open brackets",
    "indices",
    "brackets of indices",
    "references",
    "arrays",
    "open arrays",
    "aliases",
    "structs",
    "members",
    "functions",
    "twice the functions",
    "constants",
    "doubled constants",
    "doubled values",
    "variables",
    "branches with variables",
    "zeros",
    "cases",
    "comments",
    "open comments",
    "lines of comments",
    "ifs",
    "blocks",
    "attributes",
    "less than",
    "loops",
    "loops in loops",
    "products of matrices",
    "long loops of products",
];

/// What is said of a law, with the time that takes.
fn said(law: &str) -> (Vec<String>, Duration) {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("own.wgsl"), law).unwrap();
    let scene = r#"(duration: 0.1, materials: {"skin": (density: 1000,
law: (file: "own.wgsl", parameters: {"mu": 2000, "b": 2, "bulk": 1e5}))},
bodies: {"cube": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (1, 1, 1)), material: "skin")})"#;
    let scene = SceneFile::from_text("cube.ron", scene, folder.path(), &[]).unwrap();
    let started = Instant::now();
    let found = Simulation::check(&scene, &Registry::default());
    let lines = found.lines().iter().map(ToString::to_string).collect();
    (lines, started.elapsed())
}

/// What grows with the square of a hundred thousand takes minutes; other work on the machine a second.
const BEARABLE: Duration = Duration::from_secs(10);

#[test]
fn whatever_there_is_too_much_of_is_told_at_its_place_in_no_time() {
    assert_eq!(said(LAW).0, Vec::<String>::new());
    let mut wrong = Vec::new();
    for kind in KINDS {
        let mut refused = 0;
        for n in [10, 50, 150, 450, 1000, 6000, 20_000, 100_000] {
            let text = text(kind, n);
            if text.len() > 1 << 20 {
                break;
            }
            let (lines, took) = said(&text);
            println!("{kind} {n}: {took:.2?}, {lines:.1?}");
            refused += usize::from(!lines.is_empty());
            let placed = lines.iter().all(|line| {
                let mut parts = line.split(':');
                let number = |part: Option<&str>| part.and_then(|p| p.parse::<u32>().ok()).is_some_and(|n| n > 0);
                let file = parts.next() == Some("own.wgsl");
                // of these naga itself says no place
                let without = ["type is too large", "internal WGSL front end error"];
                file && (number(parts.next()) && number(parts.next())
                    || without.iter().any(|words| line.contains(words)))
            });
            if took > BEARABLE || !placed {
                wrong.push(format!("{kind}, {n} times: {took:.1?}, {lines:.200?}"));
            }
        }
        // so much that there must be a limit: a million characters of anything but comments; zeros are a single value
        if refused == 0 && !kind.contains("comments") && kind != "zeros" {
            wrong.push(format!("{kind}: no number is too large"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// What a sound law may well be, is.
#[test]
fn what_is_bearable_is_borne() {
    for (kind, n) in [
        ("sums of k", 200),
        ("statements", 2000),
        ("lets", 1000),
        ("minus", 400),
        ("calls", 60),
        ("aliases", 200),
        ("functions", 100),
        ("constants", 400),
        ("comments", 100_000),
        ("lines of comments", 100_000),
        ("loops", 200),
        ("loops in loops", 8),
        ("branches with variables", 20),
    ] {
        assert_eq!(said(&text(kind, n)).0, Vec::<String>::new(), "{kind}, {n} times");
    }
}
