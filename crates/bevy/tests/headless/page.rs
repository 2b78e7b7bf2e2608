//! The code of docs/bevy.md is that of the game beside the plugin, which takes a newer compiler than tests have.

const PAGE: &str = include_str!("../../../../docs/bevy.md");
const GAME: &str = include_str!("../../game/src/main.rs");
const SCENE: &str = include_str!("../../game/assets/jelly.ron");

/// The first block of a language in the page.
fn block(language: &str) -> &'static str {
    let opening = format!("```{language}\n");
    PAGE.split_once(&opening).and_then(|(_, rest)| rest.split_once("```")).unwrap().0
}

/// From where a function begins to where it ends.
fn function<'a>(program: &'a str, name: &str) -> &'a str {
    let text = &program[program.find(&format!("\nfn {name}(")).unwrap()..];
    &text[..text.find("\n}").unwrap()]
}

#[test]
fn what_the_page_shows_is_the_game() {
    let shown = block("rust,ignore");
    let uses: Vec<&str> = shown.lines().filter(|line| line.starts_with("use ")).collect();
    assert!(!uses.is_empty() && uses.iter().all(|line| GAME.contains(line)), "{uses:?}");
    for name in ["setup", "paint"] {
        assert_eq!(function(shown, name), function(GAME, name));
    }
    assert_eq!(block("ron"), SCENE);
}
