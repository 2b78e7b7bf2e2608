use super::*;

#[test]
fn declarations_are_found_with_their_places() {
    let text = "// fn no\nstruct Law { mu: f32 }\n@group(0) @binding(0) var<uniform> elastic: Law;\n\
                const a: f32 = max(1.0, 2.0); /* var b */ fn f(x: f32) -> f32 { var y = x; return y; }";
    let found = declared(text);
    let names: Vec<_> = found.iter().map(|d| (d.kind.as_str(), d.name.as_str(), &text[d.at.clone()])).collect();
    let expected = [("struct", "Law"), ("var", "elastic"), ("const", "a"), ("fn", "f")];
    assert_eq!(names, expected.map(|(kind, name)| (kind, name, name)));
    assert_eq!(&text[member(text, &found[0], "mu")], "mu");
}
