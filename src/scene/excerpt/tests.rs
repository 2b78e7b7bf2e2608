// a place is a range, not its numbers
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::single_range_in_vec_init)]
use super::*;
use codespan_reporting::diagnostic::Diagnostic;
use codespan_reporting::term::{Config, emit_to_string};

fn told(text: &str, marked: impl IntoIterator<Item = Range<usize>>) -> String {
    let mut labels: Vec<Label<usize>> =
        marked.into_iter().map(|range| Label::secondary(0, range).with_message("here")).collect();
    labels[0].style = codespan_reporting::diagnostic::LabelStyle::Primary;
    let excerpts = Excerpts::of(&[("a.ron", text)], &mut labels);
    let mut told = String::new();
    let shown = Diagnostic::error().with_message("wrong").with_labels(labels);
    emit_to_string(&mut told, &Config::default(), &excerpts, &shown).unwrap();
    told
}

/// What is above the marks of the only line that is shown.
fn underlined(told: &str) -> String {
    let lines: Vec<&str> = told.lines().collect();
    let row = lines.iter().position(|line| line.contains('^')).unwrap();
    let marks = lines[row].chars().enumerate().filter(|(_, c)| *c == '^').map(|(column, _)| column);
    marks.map(|column| lines[row - 1].chars().nth(column).unwrap_or(' ')).collect()
}

#[test]
fn a_long_line_is_cut_around_what_is_marked_and_columns_stay_those_of_the_file() {
    let mut seen = Vec::new();
    for (before, after) in [(0, 3000), (10, 3000), (1500, 1500), (3000, 10), (3000, 0), (70, 40)] {
        for filler in ["x", "ü"] {
            let line = format!("{}WRONG{}", filler.repeat(before), filler.repeat(after));
            let start = 6 + filler.len() * before;
            let told = told(&format!("first\n{line}\nlast"), [start..start + 5]);
            assert!(told.contains(&format!("a.ron:2:{}", before + 1)), "{told}");
            assert_eq!(underlined(&told), "WRONG", "{told}");
            assert!(told.lines().all(|line| line.chars().count() < WIDTH + 20), "{told}");
            let long = line.len() > WIDTH;
            assert_eq!(told.contains(LEFT_OUT), long, "{told}");
            if filler == "x" {
                let shown = told.lines().find(|line| line.contains("WRONG")).unwrap();
                seen.push((shown.contains("│ …"), shown.ends_with('…')));
            }
        }
    }
    let (left, both, right, none) = ((true, false), (true, true), (false, true), (false, false));
    assert_eq!(seen, [right, right, both, left, left, none]);
}

#[test]
fn places_far_from_each_other_on_a_line_are_all_shown() {
    let line = format!("ONE{}TWO{}", " ".repeat(2000), " ".repeat(2000));
    let told = told(&line, [2003..2006, 0..3]);
    assert!(told.contains("a.ron:1:2004"), "{told}");
    assert!(told.contains("ONE") && told.matches(LEFT_OUT).count() == 2, "{told}");
    assert_eq!(underlined(&told), "TWO");
}

#[test]
fn of_a_long_place_the_beginning_is_marked() {
    let told = told(&format!("a({})", "b".repeat(3000)), [2..3002]);
    assert!(told.contains("a.ron:1:3"), "{told}");
    let marked = underlined(&told);
    assert!(marked.len() > 60 && marked.len() <= WIDTH && marked.bytes().all(|byte| byte == b'b'), "{told}");
}

#[test]
fn short_lines_are_shown_as_they_are() {
    let text = "one\ntwo\n\nfour\n";
    for (marked, locus) in [(4..7, "2:1"), (8..8, "3:1"), (9..13, "4:1"), (14..14, "5:1"), (0..7, "1:1")] {
        let shown = told(text, [marked.clone()]);
        let mut files = codespan_reporting::files::SimpleFiles::new();
        files.add("a.ron", text);
        let label = Label::primary(0, marked).with_message("here");
        let whole = Diagnostic::error().with_message("wrong").with_labels(vec![label]);
        let mut expected = String::new();
        emit_to_string(&mut expected, &Config::default(), &files, &whole).unwrap();
        assert_eq!(shown, expected);
        assert!(shown.contains(&format!("a.ron:{locus}")), "{shown}");
    }
}
