use super::*;

#[test]
fn constants_stay_without_a_type() {
    let text =
        "const third: f32 = 1.0 / 3f; const v = vec3f(third, 1.0, 2); fn f() -> f32 { const a = 1e3; return a * 2.0; }";
    let twin = Twin::new(text);
    let expected = "const third  = 1.0 / 3.0; const v = vec3<f64>(third, 1.0, 2); fn f() -> f64 { const a = 1e3; return a * 2.0lf; }";
    assert_eq!(twin.text, expected);
}

#[test]
fn calls_of_constants_are_none_and_places_lead_back() {
    let text =
        "const a = abs(-2.0); fn f(x: f32) -> f32 { let b = max (a, -1.0) * x.abs; return maximum(b) + exp(2); }";
    let twin = Twin::unfolded(text);
    let expected = "const a = abs(-2.0); fn f(x: f64) -> f64 { let b = max (one_that_is_not_folded() * a, -1.0lf) * x.abs; \
            return maximum(b) + exp(one_that_is_not_folded() * 2); }";
    assert!(twin.text.starts_with(expected), "{}", twin.text);
    for word in ["const", "let", "max", "a, -", "* x", "maximum(b)", "exp(", "2); }"] {
        let at = twin.text.find(word).unwrap_or(0);
        assert_eq!(&text[twin.original(at..at + word.len())], word);
    }
}

#[test]
fn words_change_and_places_lead_back() {
    let text = "// 1.0 f32\nfn f(x: f32, v: vec3f) -> f32 { let a = 2.5e-3 + 1f; return x * v.x + .5 /* 1.0 */ - f32(3) * b2; }";
    let twin = Twin::new(text);
    let expected = "// 1.0 f32\nfn f(x: f64, v: vec3<f64>) -> f64 { let a = 2.5e-3lf + 1lf; return x * v.x + .5lf /* 1.0 */ - f64(3) * b2; }";
    assert_eq!(twin.text, expected);
    for word in ["return", "b2", "v.x", "let", "-> ", "*/ -", "(3)"] {
        let at = twin.text.find(word).unwrap_or(0);
        assert_eq!(&text[twin.original(at..at + word.len())], word);
    }
    let at = twin.text.find("2.5e-3lf").unwrap_or(0);
    assert_eq!(&text[twin.original(at..at + 8)], "2.5e-3");
}
