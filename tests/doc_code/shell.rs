//! Commands that the docs show: in blocks of shell, and in the middle of a line.

use std::path::{Path, PathBuf};

/// The repository; tests of crates in `crates` use this file, too.
pub fn root() -> PathBuf {
    let own = Path::new(env!("CARGO_MANIFEST_DIR"));
    own.ancestors().find(|folder| folder.join("docs/SUMMARY.md").exists()).unwrap().to_path_buf()
}

/// What a program is called with, in words, and on which page; each call once.
pub fn calls(program: &str) -> Vec<(String, Vec<String>)> {
    let docs = std::fs::read_dir(root().join("docs")).unwrap().map(|file| file.unwrap().path());
    let pages = docs.filter(|file| file.extension().is_some_and(|ending| ending == "md"));
    let mut all = Vec::new();
    for file in pages.chain([root().join("README.md")]) {
        let (name, text) = (file.file_name().unwrap().display().to_string(), std::fs::read_to_string(&file).unwrap());
        let found = lines(&text).into_iter().filter_map(|line| call(program, &line));
        all.extend(found.map(|words| (name.clone(), words)));
    }
    all.sort_by(|a: &(String, Vec<String>), b| a.1.cmp(&b.1));
    all.dedup_by(|a, b| a.1 == b.1);
    all
}

/// The lines of blocks of shell and text, and code in the middle of a line.
fn lines(page: &str) -> Vec<String> {
    let mut all = Vec::new();
    for (number, part) in page.split("```").enumerate() {
        if number % 2 == 0 {
            all.extend(part.split('`').skip(1).step_by(2).map(|code| code.replace('\n', " ")));
        } else if part.starts_with("sh\n") || part.starts_with("text\n") {
            all.extend(part.lines().skip(1).map(str::to_string));
        }
    }
    all
}

/// What a line calls a program with, at its beginning or behind a pipe.
fn call(program: &str, line: &str) -> Option<Vec<String>> {
    let all = words(line);
    let begins = |place: usize| place == 0 || all[place - 1] == "|";
    let of_cargo = ["cargo", "run", "--release", "--"];
    let after = |place: usize| match &all[place..] {
        [first, ..] if first == program => Some(place + 1),
        [first, ..]
            if first == "cargo" && program == "sinew" && all[place..].starts_with(&of_cargo.map(String::from)) =>
        {
            Some(place + 4)
        }
        _ => None,
    };
    let first = (0..all.len()).filter(|&place| begins(place)).find_map(after)?;
    let ends = |word: &&String| ["|", ">", "&&", "..."].contains(&word.as_str());
    // a part of as many as an array of jobs has
    let filled = |word: &String| word.replace("$SLURM_ARRAY_TASK_ID", "1");
    Some(all[first..].iter().take_while(|word| !ends(word)).map(filled).collect())
}

/// A line as a shell splits it, up to a remark.
fn words(line: &str) -> Vec<String> {
    let (mut words, mut word, mut quote) = (Vec::new(), None::<String>, None::<char>);
    for c in line.chars() {
        match (quote, c) {
            (Some(open), c) if c == open => quote = None,
            (None, '\'' | '"') => {
                quote = Some(c);
                word.get_or_insert_default();
            }
            (None, c) if c.is_whitespace() => words.extend(word.take()),
            (None, '#') if word.is_none() => break,
            (_, c) => word.get_or_insert_default().push(c),
        }
    }
    words.extend(word);
    words
}

#[test]
fn a_line_is_split_as_a_shell_does() {
    let line = "sed s/3/5/ a.ron | sinew run - --set 'a=(1, 2)' -o \"out/b c\" > log # it runs";
    assert_eq!(call("sinew", line).unwrap(), ["run", "-", "--set", "a=(1, 2)", "-o", "out/b c"]);
    assert_eq!(call("sinew", "cargo run --release -- bench").unwrap(), ["bench"]);
    assert_eq!(call("sinew-view", "sinew view"), None);
    assert_eq!(lines("a `b\nc` d\n```sh\ne\n```\n"), ["b c", "e"]);
}
