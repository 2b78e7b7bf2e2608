//! Rust texts as tests of the code's shape read them.

/// Code without comments and without what is for tests alone.
pub fn code(text: &str) -> String {
    let text: String = text.lines().map(|line| line.split("//").next().unwrap()).collect::<Vec<_>>().join("\n");
    let mut parts = text.split("#[cfg(test)]");
    let before = parts.next().unwrap().to_string();
    parts.fold(before, |code, part| code + after_item(part))
}

/// What comes after the first item of a text: behind its semicolon or its last brace.
fn after_item(text: &str) -> &str {
    let mut depth = 0;
    for (at, c) in text.char_indices() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            _ => {}
        }
        if depth == 0 && (c == ';' || c == '}') {
            return &text[at + 1..];
        }
    }
    ""
}

#[test]
fn what_is_for_tests_alone_is_cut_out() {
    let text = "use a; // b\n#[cfg(test)]\nmod tests;\nmod c;\n#[cfg(test)]\nfn d() { if e {} }\nfn f() {}";
    assert_eq!(code(text), "use a; \n\nmod c;\n\nfn f() {}");
}
