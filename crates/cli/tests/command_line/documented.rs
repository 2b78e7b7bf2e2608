//! The command takes what the docs show of it.

use super::sinew::Ended;
use std::collections::BTreeSet;
use std::process::{Command, Stdio};

#[path = "../../../../tests/doc_code/shell.rs"]
mod shell;

fn sinew(words: &[String], more: &[&str]) -> Ended {
    let mut command = Command::new(env!("CARGO_BIN_EXE_sinew"));
    command.args(words).args(more).current_dir(shell::root()).stdin(Stdio::null());
    Ended::of(command.output().unwrap())
}

/// With `--help` behind them words are read, and nothing is done.
#[test]
fn words_in_the_docs_are_words_of_the_command() {
    let calls = shell::calls("sinew");
    assert!(calls.len() > 80, "{} commands", calls.len());
    // the viewer reads its words itself (crates/view/tests/documented.rs)
    let own = |words: &[String]| !words.is_empty() && words[0] != "view" && words[0] != "help";
    for (page, words) in calls.iter().filter(|(_, words)| own(words)) {
        let ended = sinew(words, &["--help"]);
        assert_eq!(ended.status, Some(0), "{page}: sinew {}: {}", words.join(" "), ended.complained);
    }
    let wrong = sinew(&["run".into(), "--thread".into(), "1".into()], &["--help"]);
    assert_eq!(wrong.status, Some(2), "a word that is none is not found");
}

/// With the values that are put into them.
#[test]
fn scenes_in_the_docs_are_there_and_sound() {
    let (mut count, mut checked) = (0, BTreeSet::new());
    for (page, words) in shell::calls("sinew") {
        let Some(scene) = words.iter().find(|word| word.ends_with(".ron") && !word.contains("NAME")) else { continue };
        let is_ours = ["scenes/", "examples/"].iter().any(|folder| scene.starts_with(folder));
        if !is_ours || words[0] == "sweep" {
            continue;
        }
        let sets = words.windows(2).filter(|pair| pair[0] == "--set").flatten();
        let check: Vec<String> = ["check".to_string(), scene.clone()].iter().chain(sets).cloned().collect();
        count += 1;
        if !checked.insert(check.clone()) {
            continue;
        }
        let ended = sinew(&check, &[]);
        assert_eq!(ended.status, Some(0), "{page}: sinew {}: {}", words.join(" "), ended.complained);
    }
    println!("{count} calls, {} of them different", checked.len());
    assert!(count > 20, "{count} scenes");
}
