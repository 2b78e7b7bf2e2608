//! What stands in the docs as Rust compiles: each block is, word for word, a part of a file here, with around it what
//! its page takes for granted.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
// what is shown is not run here, and is written as the pages have it
#![allow(dead_code, unused_variables, unused_mut, unused_imports, missing_docs)]
#![allow(clippy::redundant_closure, clippy::let_and_return)]

mod interaction;
mod laws;
mod systems;

/// Pages, and the file of each.
const PAGES: [(&str, &str, &str); 4] = [
    ("README.md", include_str!("../../README.md"), include_str!("systems.rs")),
    ("docs/interaction.md", include_str!("../../docs/interaction.md"), include_str!("interaction.rs")),
    ("docs/laws.md", include_str!("../../docs/laws.md"), include_str!("laws.rs")),
    ("docs/systems.md", include_str!("../../docs/systems.md"), include_str!("systems.rs")),
];
/// Pages whose Rust is tested elsewhere, or not at all, as they say.
const OTHERS: [&str; 1] = ["docs/bevy.md"];

/// Blocks of Rust of a page.
fn blocks(page: &str) -> Vec<&str> {
    let fenced = page.split("```").skip(1).step_by(2).filter_map(|block| block.split_once('\n'));
    fenced.filter(|(language, _)| language.starts_with("rust")).map(|(_, block)| block).collect()
}

/// The lines of a text, without what they are indented by and without empty ones.
fn lines(text: &str) -> String {
    let lines = text.lines().map(str::trim).filter(|line| !line.is_empty());
    lines.fold("\n".into(), |all: String, line| all + line + "\n")
}

#[test]
fn every_block_of_rust_in_the_docs_is_code_that_compiles() {
    let mut count = 0;
    for (name, page, file) in PAGES {
        let file = lines(file);
        // those of the readme that are whole are doc tests of the crate
        let is_whole = |block: &&str| name == "README.md" && block.contains("fn main");
        let of_page = blocks(page).into_iter().filter(|block| !is_whole(block));
        for block in of_page {
            assert!(file.contains(&lines(block)), "{name}: this is not in its file in tests/doc_code:\n{block}");
            count += 1;
        }
    }
    assert!(count >= 15, "{count} blocks");
}

#[test]
fn a_block_that_is_not_there_is_found() {
    let page = "```rust,ignore\nlet a = 1;\n\n    let b = 2;\n```\n```toml\na = 1\n```\n";
    assert_eq!(blocks(page), ["let a = 1;\n\n    let b = 2;\n"]);
    let file = lines("fn f() {\n    let a = 1;\n    let b = 2;\n}\n");
    assert!(file.contains(&lines(blocks(page)[0])) && !file.contains(&lines("let b = 1;")));
}

/// A page that begins to show Rust is tested, too.
#[test]
fn pages_with_rust_are_listed() {
    let docs = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    for file in std::fs::read_dir(docs).unwrap().map(|file| file.unwrap().path()) {
        let Ok(text) = std::fs::read_to_string(&file) else { continue };
        let name = format!("docs/{}", file.file_name().unwrap().display());
        let is_listed = PAGES.iter().any(|(page, ..)| *page == name) || OTHERS.contains(&name.as_str());
        assert!(is_listed || blocks(&text).is_empty(), "{name} has Rust that nothing compiles");
    }
}
