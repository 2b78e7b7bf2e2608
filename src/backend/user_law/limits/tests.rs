#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
use super::*;

/// The depth at the word where a text passes the limit, for texts that grow with a number.
fn passes(text: impl Fn(usize) -> String) -> usize {
    (1..=LAW_DEPTH + 1).find(|n| check(&text(*n), "law").is_err()).unwrap_or(usize::MAX)
}

#[test]
fn whatever_is_within_each_other_is_counted() {
    let most = LAW_DEPTH;
    assert_eq!(passes(|n| format!("const a = {}1;", "-".repeat(n))), most, "`=` counts, too");
    assert_eq!(passes(|n| format!("const a = {}1{};", "(".repeat(n), ")".repeat(n))), most / BRACKET + 1);
    assert_eq!(passes(|n| format!("const a = {}1;", "1 + ".repeat(n))), most);
    assert_eq!(passes(|n| format!("const a = b{};", ".x".repeat(n))), most);
    assert_eq!(passes(|n| format!("alias T = {}f32{};", "array<".repeat(n), ", 1>".repeat(n))), most / BRACKET + 1);
    assert_eq!(passes(|n| format!("alias T = {}f32;", "array<1, ".repeat(n))), most / BRACKET + 1);
    // f() { if a { } else if a { } ... : each branch and its block
    assert!(passes(|n| format!("fn f() {{ if a {{ }} {} }}", "else if a { } ".repeat(n))) <= most);
    // operators that are behind a bracket are below what follows
    assert!(passes(|n| format!("const a = {}1{};", "(".repeat(n), " + 1)".repeat(n))) <= most / BRACKET + 1);
}

#[test]
fn what_stands_beside_each_other_is_not() {
    let long = LAW_DEPTH * 2;
    for text in [
        format!("const a = array({});", "-1.5 * 2, ".repeat(long)),
        format!("fn f() {{ {} }}", "q += k.j * 1.5; ".repeat(long)),
        format!("fn f() {{ {} }}", "if a > b { q = 1; } ".repeat(long)),
        format!("fn f() {{ {} }}", "for (var i = 0; i < 8; i++) { q = 1; } ".repeat(long / 4)),
        format!("fn f() {{ switch 3 {{ {} }} }}", "case 1: { q = 1; } ".repeat(long)),
        format!("struct A {{ {} }}", "mu: f32, ".repeat(long)),
        "/*".repeat(long) + &"*/".repeat(long),
    ] {
        assert_eq!(check(&text, "law"), Ok(()), "{text:.80}");
    }
}
