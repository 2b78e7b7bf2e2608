//! The viewer takes what the docs show of it.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::process::Command;

#[path = "../../../tests/doc_code/shell.rs"]
mod shell;

/// With `--help` behind them words are read, and no window is opened.
#[test]
fn words_in_the_docs_are_words_of_the_viewer() {
    let through_the_command = shell::calls("sinew").into_iter().filter_map(|(page, mut words)| {
        let is_view = words.first().is_some_and(|word| word == "view");
        is_view.then(|| (page, words.split_off(1)))
    });
    let calls: Vec<_> = shell::calls("sinew-view").into_iter().chain(through_the_command).collect();
    assert!(calls.len() >= 6, "{} commands", calls.len());
    for (page, words) in calls {
        let ended = Command::new(env!("CARGO_BIN_EXE_sinew-view")).args(&words).arg("--help").output().unwrap();
        let told = String::from_utf8_lossy(&ended.stderr);
        assert!(ended.status.success(), "{page}: sinew-view {}: {told}", words.join(" "));
    }
}
